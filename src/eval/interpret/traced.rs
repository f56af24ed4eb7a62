//! Formulas taken down: arithmetic, conditions and functions of numbers that depend on a point.
//!
//! A formula is evaluated once with numbers that are not known. What is computed of them becomes steps of a
//! [`Recording`](crate::geom::formula::Recording); loops, lists and calls run as always. Both branches of an
//! `if` whose condition depends on the point are taken down.

use super::{
    super::{
        builtin::Args,
        dimension::Dimension,
        evaluator::Evaluator,
        failure::{Outcome, fail},
        stack::deep,
        types::shown,
        unit::CodeId,
        value::{Traced, Value},
    },
    Frame,
    arithmetic::{Operands, clash, symbol},
};
use crate::{
    base::{self, Span},
    geom::formula::{Binary, Op, Unary},
    syntax::ast::BinaryOp,
};

/// Steps that all formulas of a model may have.
const MOST_STEPS: u32 = 200_000;

/// A condition: known, or a step of a formula.
pub enum Decision {
    /// True or false.
    Known(bool),
    /// True where the step is not 0.
    Step(u32),
}

/// The step of an operation, if formulas have it.
fn step_of(op: BinaryOp) -> Option<Binary> {
    Some(match op {
        BinaryOp::Add => Binary::Add,
        BinaryOp::Subtract => Binary::Subtract,
        BinaryOp::Multiply => Binary::Multiply,
        BinaryOp::Divide => Binary::Divide,
        BinaryOp::Remainder => Binary::Remainder,
        BinaryOp::Power => Binary::Power,
        BinaryOp::Less | BinaryOp::Greater => Binary::Less,
        BinaryOp::LessEqual | BinaryOp::GreaterEqual => Binary::LessEqual,
        BinaryOp::Equal | BinaryOp::NotEqual => Binary::Equal,
        _ => return None,
    })
}

/// Whether an operation takes a number that is not known, and no list.
pub fn is_traced(left: &Value, right: &Value) -> bool {
    let single = |v: &Value| matches!(v, Value::Traced(_) | Value::Number(..) | Value::Bool(_));
    let open = matches!(left, Value::Traced(_)) || matches!(right, Value::Traced(_));
    open && single(left) && single(right)
}

impl Evaluator<'_> {
    fn step(&mut self, op: Op, at: Span) -> Outcome<u32> {
        self.tick(1, at)?;
        let step = self.recording.step(op);
        if step < MOST_STEPS {
            return Ok(step);
        }
        let words = format!("the formulas of fields have more than {MOST_STEPS} steps");
        fail(base::Code::Limit, self.shown_at(at), words)
    }

    fn constant(&mut self, x: f64, at: Span) -> Outcome<u32> {
        self.step(Op::Constant(x), at)
    }

    /// A coordinate of the point.
    pub(in crate::eval) fn coordinate(&mut self, axis: usize, at: Span) -> Outcome<Value> {
        let step = self.step(Op::Axis(axis), at)?;
        Ok(Value::Traced(Traced { step, dimension: Some(Dimension::LENGTH) }))
    }

    /// A number or truth value as a step.
    pub(in crate::eval) fn as_step(&mut self, value: &Value, at: Span) -> Outcome<Traced> {
        match value {
            Value::Traced(traced) => Ok(*traced),
            Value::Number(x, dimension) => {
                Ok(Traced { step: self.constant(*x, at)?, dimension: Some(*dimension) })
            }
            Value::Bool(truth) => {
                let step = self.constant(f64::from(u8::from(*truth)), at)?;
                Ok(Traced { step, dimension: None })
            }
            other => {
                let words = format!("a field needs numbers, got {}", shown(other));
                fail(base::Code::WrongKind, at, words)
            }
        }
    }

    /// A number as a step, with its dimension.
    fn number_step(&mut self, value: &Value, at: Span) -> Outcome<(u32, Dimension)> {
        match self.as_step(value, at)? {
            Traced { step, dimension: Some(dimension) } => Ok((step, dimension)),
            _ => fail(base::Code::WrongKind, at, format!("needs a number, got {}", shown(value))),
        }
    }

    fn traced(&mut self, op: Op, dimension: Option<Dimension>, at: Span) -> Outcome<Value> {
        Ok(Value::Traced(Traced { step: self.step(op, at)?, dimension }))
    }

    /// An operation on numbers of which at least one depends on the point.
    pub(super) fn traced_binary(
        &mut self,
        op: BinaryOp,
        left: &Value,
        right: &Value,
        at: Operands,
    ) -> Outcome<Value> {
        let Some(step) = step_of(op) else {
            return Err(super::arithmetic::wrong_operands(op, left, right, at));
        };
        let exponent = match right {
            Value::Number(n, Dimension::BARE) => Some(*n),
            _ => None,
        };
        let (mut a, x) = self.number_step(left, at.left)?;
        let (mut b, y) = self.number_step(right, at.right)?;
        let dimension = match op {
            BinaryOp::Multiply => x.times(y),
            BinaryOp::Divide => x.over(y),
            BinaryOp::Power => match exponent {
                Some(n) if n.fract() == 0.0 && n.abs() <= 100.0 => x.power(n as i32),
                Some(n) => x.broken_power(n),
                None => (x == Dimension::BARE && y == Dimension::BARE).then_some(x),
            },
            _ => x.common(y),
        };
        let Some(dimension) = dimension else {
            return Err(clash(x, y, (at.left, at.right), &format!("`{}`", symbol(op))));
        };
        if matches!(op, BinaryOp::Greater | BinaryOp::GreaterEqual) {
            std::mem::swap(&mut a, &mut b);
        }
        let condition = matches!(step, Binary::Less | Binary::LessEqual | Binary::Equal);
        let kind = (!condition).then_some(dimension);
        let found = self.traced(Op::Binary(step, a, b), kind, at.whole)?;
        if op == BinaryOp::NotEqual { self.traced_not(&found, at.whole) } else { Ok(found) }
    }

    /// The opposite of a condition.
    fn traced_not(&mut self, value: &Value, at: Span) -> Outcome<Value> {
        let (one, step) = (self.constant(1.0, at)?, self.as_step(value, at)?.step);
        self.traced(Op::Binary(Binary::Subtract, one, step), None, at)
    }

    /// `-x`.
    pub(super) fn traced_negate(&mut self, x: Traced, at: Span) -> Outcome<Value> {
        match x.dimension {
            Some(_) => self.traced(Op::Unary(Unary::Negate, x.step), x.dimension, at),
            None => fail(base::Code::WrongKind, at, "`-` needs a number, got a condition"),
        }
    }

    /// A condition.
    pub(super) fn decide(&mut self, frame: &Frame, id: CodeId) -> Outcome<Decision> {
        match self.eval(frame, id)? {
            Value::Bool(value) => Ok(Decision::Known(value)),
            Value::Traced(Traced { step, dimension: None }) => Ok(Decision::Step(step)),
            other => {
                let words = format!("needs a truth value, got {}", shown(&other));
                fail(base::Code::WrongKind, frame.unit.span(id), words)
            }
        }
    }

    /// `not`.
    pub(super) fn eval_not(&mut self, frame: &Frame, id: CodeId) -> Outcome<Value> {
        match self.decide(frame, id)? {
            Decision::Known(value) => Ok(Value::Bool(!value)),
            Decision::Step(step) => {
                let value = Value::Traced(Traced { step, dimension: None });
                self.traced_not(&value, frame.unit.span(id))
            }
        }
    }

    /// `and` and `or`: what comes behind the first operand that is `decisive` is not evaluated.
    pub(super) fn truth_of_all(
        &mut self,
        frame: &Frame,
        operands: impl Iterator<Item = CodeId>,
        decisive: bool,
    ) -> Outcome<Value> {
        let mut open: Option<u32> = None;
        for operand in operands {
            match (self.decide(frame, operand)?, open) {
                (Decision::Known(value), _) if value == decisive => return Ok(Value::Bool(value)),
                (Decision::Known(_), _) => {}
                (Decision::Step(step), None) => open = Some(step),
                (Decision::Step(step), Some(before)) => {
                    let op = if decisive { Binary::Max } else { Binary::Min };
                    let at = frame.unit.span(operand);
                    open = Some(self.step(Op::Binary(op, before, step), at)?);
                }
            }
        }
        Ok(match open {
            Some(step) => Value::Traced(Traced { step, dimension: None }),
            None => Value::Bool(!decisive),
        })
    }

    /// `if`.
    pub(super) fn eval_if(
        &mut self,
        frame: &Frame,
        [condition, then]: [CodeId; 2],
        otherwise: Option<CodeId>,
    ) -> Outcome<Value> {
        let told = Err(super::Failure::TOLD);
        match (self.decide(frame, condition)?, otherwise) {
            (Decision::Known(true), _) => self.eval(frame, then),
            (Decision::Known(false), None) | (Decision::Step(_), None) => told,
            (Decision::Known(false), Some(otherwise)) => self.eval(frame, otherwise),
            (Decision::Step(step), Some(otherwise)) => {
                let (a, b) = (self.eval(frame, then)?, self.eval(frame, otherwise)?);
                let at = (frame.unit.span(then), frame.unit.span(otherwise));
                self.choice(step, &a, &b, at)
            }
        }
    }

    /// One of two values, whichever a condition says; lists element by element.
    fn choice(&mut self, condition: u32, a: &Value, b: &Value, at: (Span, Span)) -> Outcome<Value> {
        if let (Value::List(x), Value::List(y)) = (a, b)
            && x.len() == y.len()
        {
            let pairs = x.iter().zip(y.iter());
            let chosen = pairs.map(|(x, y)| deep(|| self.choice(condition, x, y, at)));
            return chosen.collect::<Outcome<Vec<Value>>>().map(Value::list);
        }
        let (x, y) = (self.as_step(a, at.0)?, self.as_step(b, at.1)?);
        let dimension = match (x.dimension, y.dimension) {
            (Some(p), Some(q)) => {
                Some(p.common(q).ok_or_else(|| clash(p, q, at, "the branches of an `if`"))?)
            }
            (None, None) => None,
            _ => {
                let words = "one branch of the `if` is a number, the other a truth value";
                return fail(base::Code::WrongKind, at.1, words);
            }
        };
        self.traced(Op::Choose(condition, x.step, y.step), dimension, at.0)
    }

    /// A function of the library on numbers of which at least one depends on the point; `None` for functions
    /// that do not look at numbers.
    pub(super) fn traced_function(&mut self, name: &str, args: &Args) -> Option<Outcome<Value>> {
        let open = |v: &Value| matches!(v, Value::Traced(_));
        let within = |v: &Value| match v {
            Value::List(list) => list.iter().any(open),
            value => open(value),
        };
        if !args.values.iter().any(within) {
            return None;
        }
        if let Some(op) = unary_of(name).filter(|_| args.values.len() == 1) {
            return Some(self.traced_unary(op, args));
        }
        Some(match name {
            "min" => self.traced_extreme(Binary::Min, args),
            "max" => self.traced_extreme(Binary::Max, args),
            "atan2" | "mod" => self.traced_pair(name, args),
            "clamp" => self.traced_clamp(args),
            "lerp" => self.traced_lerp(args),
            "log" => self.traced_logarithm(args),
            "norm" => self.traced_norm(args.value(0), args.call),
            "dot" => self.traced_dot(args.value(0), args.value(1), args.call),
            "cross" => self.traced_cross(args),
            "distance" => self.traced_distance(args),
            _ => return None,
        })
    }

    fn traced_unary(&mut self, op: Unary, args: &Args) -> Outcome<Value> {
        let (a, x) = self.number_step(args.value(0), args.span(0))?;
        let dimension = match op {
            Unary::Sqrt => x.root(),
            Unary::Asin | Unary::Acos | Unary::Atan => Some(Dimension::ANGLE),
            Unary::Abs | Unary::Floor | Unary::Ceil | Unary::Round => Some(x),
            _ => Some(Dimension::BARE),
        };
        match dimension {
            Some(_) => self.traced(Op::Unary(op, a), dimension, args.call),
            None => {
                args.fail(0, base::Code::Dimension, format!("{} has no square root", x.words()))
            }
        }
    }

    fn traced_extreme(&mut self, op: Binary, args: &Args) -> Outcome<Value> {
        let items = match args.values {
            [list] => self.items(list, args.span(0))?.to_vec(),
            values => values.to_vec(),
        };
        let mut items = items.into_iter();
        let Some(mut best) = items.next() else {
            return args.fail(0, base::Code::OutOfRange, "the list is empty");
        };
        for item in items {
            best = self.traced_step(op, &best, &item, args)?;
        }
        Ok(best)
    }

    /// A step of two numbers of one dimension.
    fn traced_step(&mut self, op: Binary, a: &Value, b: &Value, args: &Args) -> Outcome<Value> {
        let ((a, x), (b, y)) = (self.number_step(a, args.call)?, self.number_step(b, args.call)?);
        match x.common(y) {
            common @ Some(_) => self.traced(Op::Binary(op, a, b), common, args.call),
            None => Err(clash(x, y, (args.call, args.call), "the arguments")),
        }
    }

    fn traced_pair(&mut self, name: &str, args: &Args) -> Outcome<Value> {
        if name == "mod" {
            return self.traced_step(Binary::Modulo, args.value(0), args.value(1), args);
        }
        match self.traced_step(Binary::Atan2, args.value(0), args.value(1), args)? {
            Value::Traced(Traced { step, .. }) => {
                Ok(Value::Traced(Traced { step, dimension: Some(Dimension::ANGLE) }))
            }
            other => Ok(other),
        }
    }

    fn traced_clamp(&mut self, args: &Args) -> Outcome<Value> {
        let held = self.traced_step(Binary::Max, args.value(0), args.value(1), args)?;
        self.traced_step(Binary::Min, &held, args.value(2), args)
    }

    fn traced_lerp(&mut self, args: &Args) -> Outcome<Value> {
        let at = Operands { whole: args.call, left: args.span(0), right: args.span(2) };
        let (a, b, t) = (args.value(0).clone(), args.value(1).clone(), args.value(2).clone());
        let rest = self.binary(BinaryOp::Subtract, Value::bare(1.0), t.clone(), at)?;
        let a = self.binary(BinaryOp::Multiply, a, rest, at)?;
        let b = self.binary(BinaryOp::Multiply, b, t, at)?;
        self.binary(BinaryOp::Add, a, b, at)
    }

    /// The logarithm to base 10, or to a base.
    fn traced_logarithm(&mut self, args: &Args) -> Outcome<Value> {
        let base = if args.values.len() > 1 { args.value(1).clone() } else { Value::bare(10.0) };
        let logarithm = |this: &mut Self, value: &Value| {
            let (step, _) = this.number_step(value, args.call)?;
            this.step(Op::Unary(Unary::Ln, step), args.call)
        };
        let (a, b) = (logarithm(self, args.value(0))?, logarithm(self, &base)?);
        self.traced(Op::Binary(Binary::Divide, a, b), Some(Dimension::BARE), args.call)
    }

    fn traced_norm(&mut self, v: &Value, at: Span) -> Outcome<Value> {
        let square = self.traced_dot(v, v, at)?;
        let (step, dimension) = self.number_step(&square, at)?;
        self.traced(Op::Unary(Unary::Sqrt, step), dimension.root(), at)
    }

    fn traced_dot(&mut self, u: &Value, v: &Value, at: Span) -> Outcome<Value> {
        let places = Operands { whole: at, left: at, right: at };
        let (u, v) = (self.items(u, at)?, self.items(v, at)?);
        if u.len() != v.len() {
            let words = format!("vectors of {} and {} numbers", u.len(), v.len());
            return fail(base::Code::WrongKind, at, words);
        }
        let mut total: Option<Value> = None;
        for (x, y) in u.iter().zip(v.iter()) {
            let product = self.binary(BinaryOp::Multiply, x.clone(), y.clone(), places)?;
            total = Some(match total {
                Some(total) => self.binary(BinaryOp::Add, total, product, places)?,
                None => product,
            });
        }
        Ok(total.unwrap_or(Value::bare(0.0)))
    }

    fn traced_cross(&mut self, args: &Args) -> Outcome<Value> {
        let at = Operands { whole: args.call, left: args.span(0), right: args.span(1) };
        let (u, v) = (self.items(args.value(0), at.left)?, self.items(args.value(1), at.right)?);
        if u.len() != 3 || v.len() != 3 {
            return args.fail(0, base::Code::WrongKind, "the cross product needs two vectors");
        }
        let mut product = vec![];
        for (j, k) in [(1, 2), (2, 0), (0, 1)] {
            let a = self.binary(BinaryOp::Multiply, u[j].clone(), v[k].clone(), at)?;
            let b = self.binary(BinaryOp::Multiply, u[k].clone(), v[j].clone(), at)?;
            product.push(self.binary(BinaryOp::Subtract, a, b, at)?);
        }
        Ok(Value::list(product))
    }

    /// The distance of two points.
    fn traced_distance(&mut self, args: &Args) -> Outcome<Value> {
        let at = Operands { whole: args.call, left: args.span(0), right: args.span(1) };
        let (a, b) = (args.value(0).clone(), args.value(1).clone());
        let apart = self.binary(BinaryOp::Subtract, a, b, at)?;
        self.traced_norm(&apart, args.call)
    }
}

/// The step of a function of one number.
fn unary_of(name: &str) -> Option<Unary> {
    Some(match name {
        "sin" => Unary::Sin,
        "cos" => Unary::Cos,
        "tan" => Unary::Tan,
        "asin" => Unary::Asin,
        "acos" => Unary::Acos,
        "atan" => Unary::Atan,
        "sqrt" => Unary::Sqrt,
        "abs" => Unary::Abs,
        "round" => Unary::Round,
        "floor" => Unary::Floor,
        "ceil" => Unary::Ceil,
        "sign" => Unary::Sign,
        "ln" => Unary::Ln,
        "exp" => Unary::Exp,
        _ => return None,
    })
}
