//! `+ - * / % ^ ++` and the unary minus on numbers, lists and strings.

use super::super::{
    dimension::Dimension,
    evaluator::Evaluator,
    failure::{Failure, Outcome, fail},
    stack::deep,
    types::shown,
    unit::{CodeId, Unit},
    value::{Value, meter},
};
use super::traced::is_traced;
use crate::{
    base::{Code, Diagnostic, Span},
    syntax::ast::BinaryOp,
};

/// Characters that are copied for one step.
const BYTES_A_STEP: u64 = 256;

/// The places of an operation and its operands.
#[derive(Clone, Copy)]
pub struct Operands {
    pub whole: Span,
    pub left: Span,
    pub right: Span,
}

impl Operands {
    pub fn new(unit: &Unit, whole: CodeId, left: CodeId, right: CodeId) -> Operands {
        Operands { whole: unit.span(whole), left: unit.span(left), right: unit.span(right) }
    }
}

/// How an operator is written.
pub fn symbol(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::Or => "or",
        BinaryOp::And => "and",
        BinaryOp::Equal => "==",
        BinaryOp::NotEqual => "!=",
        BinaryOp::Less => "<",
        BinaryOp::LessEqual => "<=",
        BinaryOp::Greater => ">",
        BinaryOp::GreaterEqual => ">=",
        BinaryOp::Add => "+",
        BinaryOp::Subtract => "-",
        BinaryOp::Join => "++",
        BinaryOp::Multiply => "*",
        BinaryOp::Divide => "/",
        BinaryOp::Remainder => "%",
        BinaryOp::Intersect => "&",
        BinaryOp::Power => "^",
    }
}

/// The error for two dimensions that do not go together, both operands labelled.
pub fn clash(a: Dimension, b: Dimension, at: (Span, Span), what: &str) -> Failure {
    let message = format!("dimensions differ in {what}: {} and {}", a.words(), b.words());
    Diagnostic::error(Code::Dimension, message).label(at.0, a.words()).label(at.1, b.words()).into()
}

impl Evaluator<'_> {
    pub(in crate::eval) fn binary(
        &mut self,
        op: BinaryOp,
        left: Value,
        right: Value,
        at: Operands,
    ) -> Outcome<Value> {
        use BinaryOp::*;
        match (op, &left, &right) {
            (_, a, b) if is_traced(a, b) => self.traced_binary(op, a, b, at),
            (Equal, a, b) => self.equal(a, b, at).map(Value::Bool),
            (NotEqual, a, b) => self.equal(a, b, at).map(|equal| Value::Bool(!equal)),
            (Less | LessEqual | Greater | GreaterEqual, a, b) => self.order(op, a, b, at),
            (_, &Value::Number(a, x), &Value::Number(b, y)) => self.numbers(op, (a, x), (b, y), at),
            (Join, ..) => self.join(left, right, at),
            (Add | Subtract | Intersect, ..) if is_algebra(&left, &right) => {
                self.set_operation(op, &left, &right, at)
            }
            _ => self.mixed(op, left, right, at),
        }
    }

    #[inline]
    fn numbers(
        &mut self,
        op: BinaryOp,
        (a, x): (f64, Dimension),
        (b, y): (f64, Dimension),
        at: Operands,
    ) -> Outcome<Value> {
        let value = match op {
            BinaryOp::Add => a + b,
            BinaryOp::Subtract => a - b,
            BinaryOp::Multiply => a * b,
            BinaryOp::Divide | BinaryOp::Remainder if b == 0.0 => {
                return Err(Diagnostic::error(Code::Arithmetic, "division by zero")
                    .label(at.right, "this is 0")
                    .label(at.left, "")
                    .into());
            }
            BinaryOp::Divide => a / b,
            BinaryOp::Remainder => a % b,
            BinaryOp::Power => return self.power((a, x), (b, y), at),
            _ => return Err(wrong_operands(op, &Value::Number(a, x), &Value::Number(b, y), at)),
        };
        let dimension = match op {
            BinaryOp::Multiply => x.times(y),
            BinaryOp::Divide => x.over(y),
            _ => x.common(y),
        };
        match dimension {
            Some(dimension) if value.is_finite() => Ok(Value::Number(value, dimension)),
            Some(_) => overflow(at.whole),
            None if matches!(op, BinaryOp::Multiply | BinaryOp::Divide) => {
                fail(Code::Dimension, at.whole, "the exponent of a dimension is too large")
            }
            None => {
                let failure = clash(x, y, (at.left, at.right), &format!("`{}`", symbol(op)));
                Err(failure.map(|error| {
                    let error = self.with_fraction(error, at.left);
                    self.with_fraction(error, at.right)
                }))
            }
        }
    }

    fn power(
        &self,
        (a, x): (f64, Dimension),
        (b, y): (f64, Dimension),
        at: Operands,
    ) -> Outcome<Value> {
        if y != Dimension::BARE {
            let words = format!("an exponent needs a bare number, got {}", y.words());
            return fail(Code::Dimension, at.right, words);
        }
        let whole = b.fract() == 0.0 && b.abs() <= 1e6;
        if !whole && x.broken_power(b).is_none() {
            let words = format!("{} to the power {b} has no dimension", x.words());
            let error = Diagnostic::error(Code::Dimension, words)
                .label(at.right, "")
                .label(at.left, x.words());
            return Err(error.help("the exponents of a dimension are whole numbers").into());
        }
        if a < 0.0 && b.fract() != 0.0 {
            let words = "a negative number has no power with a fraction";
            return fail(Code::Arithmetic, at.left, words);
        }
        if a == 0.0 && b < 0.0 {
            return fail(Code::Arithmetic, at.whole, "division by zero: 0 to a negative power");
        }
        let value =
            if whole && b.abs() <= 64.0 { whole_power(a, b as i32) } else { libm::pow(a, b) };
        match if whole { x.power(b as i32) } else { x.broken_power(b) } {
            Some(dimension) if value.is_finite() => Ok(Value::Number(value, dimension)),
            Some(_) => overflow(at.whole),
            None => fail(Code::Dimension, at.whole, "the exponent of a dimension is too large"),
        }
    }

    /// Operations with at least one list.
    fn mixed(&mut self, op: BinaryOp, left: Value, right: Value, at: Operands) -> Outcome<Value> {
        use BinaryOp::*;
        let lists = (left.count().is_some(), right.count().is_some());
        match (op, lists) {
            (Add | Subtract, (true, true)) => self.elementwise(op, &left, &right, at),
            (Multiply, (true, false)) | (Divide, (true, false)) => {
                self.each(&left, at, |this, item| this.binary(op, item, right.clone(), at))
            }
            (Multiply, (false, true)) => {
                self.each(&right, at, |this, item| this.binary(op, left.clone(), item, at))
            }
            _ => Err(wrong_operands(op, &left, &right, at)),
        }
    }

    fn each(
        &mut self,
        list: &Value,
        at: Operands,
        mut work: impl FnMut(&mut Self, Value) -> Outcome<Value>,
    ) -> Outcome<Value> {
        let items = self.items(list, at.whole)?;
        self.room(items.len(), at.whole)?;
        let mut values = Vec::with_capacity(items.len());
        for item in items.iter() {
            values.push(deep(|| work(self, item.clone()))?);
        }
        Ok(Value::list(values))
    }

    fn elementwise(
        &mut self,
        op: BinaryOp,
        left: &Value,
        right: &Value,
        at: Operands,
    ) -> Outcome<Value> {
        let (a, b) = (self.items(left, at.left)?, self.items(right, at.right)?);
        if a.len() != b.len() {
            let message = format!("lists of {} and {} elements cannot be added", a.len(), b.len());
            let error = Diagnostic::error(Code::WrongKind, message)
                .label(at.left, format!("{} elements", a.len()))
                .label(at.right, format!("{} elements", b.len()));
            return Err(error.help("`++` joins lists").into());
        }
        self.room(a.len(), at.whole)?;
        let mut values = Vec::with_capacity(a.len());
        for (x, y) in a.iter().zip(b.iter()) {
            values.push(deep(|| self.binary(op, x.clone(), y.clone(), at))?);
        }
        Ok(Value::list(values))
    }

    fn join(&mut self, left: Value, right: Value, at: Operands) -> Outcome<Value> {
        match (&left, &right) {
            (Value::Text(a), Value::Text(b)) => {
                self.room((a.len() + b.len()) / meter::BYTES_A_VALUE, at.whole)?;
                self.tick((a.len() + b.len()) as u64 / BYTES_A_STEP, at.whole)?;
                Ok(Value::text([&***a, &***b].concat()))
            }
            (a, b) if a.count().is_some() && b.count().is_some() => {
                let (a, b) = (self.items(a, at.left)?, self.items(b, at.right)?);
                self.room(a.len() + b.len(), at.whole)?;
                self.tick((a.len() + b.len()) as u64 / 16, at.whole)?;
                Ok(Value::list(a.iter().chain(b.iter()).cloned().collect()))
            }
            _ => Err(wrong_operands(BinaryOp::Join, &left, &right, at)),
        }
    }

    pub(in crate::eval) fn negate(&mut self, value: Value, at: Span) -> Outcome<Value> {
        match value {
            Value::Number(number, dimension) => Ok(Value::Number(-number, dimension)),
            Value::Traced(traced) => self.traced_negate(traced, at),
            list @ (Value::List(_) | Value::Range(_)) => {
                let items = self.items(&list, at)?;
                self.room(items.len(), at)?;
                let mut values = Vec::with_capacity(items.len());
                for item in items.iter() {
                    values.push(deep(|| self.negate(item.clone(), at))?);
                }
                Ok(Value::list(values))
            }
            other => {
                let words =
                    format!("`-` needs a number or a list of numbers, got {}", shown(&other));
                fail(Code::WrongKind, at, words)
            }
        }
    }
}

/// a^n by repeated squaring: exact where the result is.
fn whole_power(a: f64, n: i32) -> f64 {
    let (mut base, mut left, mut result) = (a, n.unsigned_abs(), 1.0);
    while left > 0 {
        if left & 1 == 1 {
            result *= base;
        }
        base *= base;
        left >>= 1;
    }
    if n < 0 { 1.0 / result } else { result }
}

fn overflow<T>(at: Span) -> Outcome<T> {
    fail(Code::Arithmetic, at, "the result is too large for a number (infinite)")
}

/// Whether `+ - &` speaks of shapes: one side is a shape or a list that holds one.
fn is_algebra(left: &Value, right: &Value) -> bool {
    holds_shape(left) || holds_shape(right)
}

fn holds_shape(value: &Value) -> bool {
    let mut value = value;
    loop {
        match value {
            Value::Solid(_) | Value::Profile(_) => return true,
            Value::List(list) => match list.iter().find(|v| !is_empty_list(v)) {
                Some(first) => value = first,
                None => return false,
            },
            _ => return false,
        }
    }
}

fn is_empty_list(value: &Value) -> bool {
    matches!(value, Value::List(list) if list.is_empty())
}

pub fn wrong_operands(op: BinaryOp, left: &Value, right: &Value, at: Operands) -> Failure {
    let message = format!("`{}` cannot take {} and {}", symbol(op), left.words(), right.words());
    let error = Diagnostic::error(Code::WrongKind, message)
        .label(at.left, left.words())
        .label(at.right, right.words());
    let texts = matches!(left, Value::Text(_)) || matches!(right, Value::Text(_));
    match op {
        BinaryOp::Add if texts => error.help("`++` joins strings; `\"{x}\"` puts a value into one"),
        _ => error,
    }
    .into()
}
