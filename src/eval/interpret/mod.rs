//! Evaluation of resolved code.

mod access;
pub mod algebra;
pub mod arithmetic;
mod assertion;
mod bind;
mod call;
mod chain;
pub mod compare;
mod control;
mod global;
mod sequence;
mod traced;

use std::sync::Arc;

pub use bind::Call;
pub use global::type_of;

use super::{
    evaluator::Evaluator,
    failure::{Failure, Outcome, fail},
    instance::InstanceId,
    library::LIBRARY,
    stack::deep,
    types::{Type, shown},
    unit::{Code, CodeId, RecordPart, Step, TextPart, Unit},
    value::{Function, Range, Symbol, Value, meter},
};
use crate::base::{self, Diagnostic, Span};

/// Values that a node of the shape graph counts for: it takes about 400 bytes with its index.
const VALUES_A_NODE: u64 = 24;

/// Where code runs: its unit and instance, the slots of its frame, and what it captured.
#[derive(Clone, Copy)]
pub struct Frame<'u> {
    pub unit: &'u Arc<Unit>,
    pub instance: InstanceId,
    pub base: usize,
    pub captures: &'u [Value],
    pub myself: Option<&'u Arc<Function>>,
}

impl Evaluator<'_> {
    /// The value of an expression.
    pub(super) fn eval(&mut self, frame: &Frame, id: CodeId) -> Outcome<Value> {
        match &frame.unit.code[id.0 as usize] {
            Code::Constant(value) => Ok(value.clone()),
            Code::Local(slot) => Ok(self.stack[frame.base + *slot as usize].clone()),
            Code::Captured(index) => Ok(frame.captures[*index as usize].clone()),
            Code::Global(global) => self.global(frame.instance, *global, frame.unit.span(id)),
            Code::Library(number) => self.library_value(*number),
            Code::Broken => Err(Failure::TOLD),
            _ => deep(|| self.eval_inner(frame, id)),
        }
    }

    fn eval_inner(&mut self, frame: &Frame, id: CodeId) -> Outcome<Value> {
        let unit = frame.unit;
        match &unit.code[id.0 as usize] {
            Code::Binary(op, left, right) => {
                let (a, b) = (self.eval(frame, *left)?, self.eval(frame, *right)?);
                let spans = arithmetic::Operands::new(unit, id, *left, *right);
                self.binary(*op, a, b, spans)
            }
            Code::Chain(chain) => self.eval_chain(frame, chain),
            Code::Call(call) => self.eval_call(frame, id, call),
            Code::Method(call) => self.eval_method(frame, id, call),
            Code::If { condition, then, otherwise } => {
                self.eval_if(frame, [*condition, *then], *otherwise)
            }
            Code::Block(steps, value) => {
                self.run_steps(frame, steps)?;
                self.eval(frame, *value)
            }
            Code::And(a, b) => self.truth_of_all(frame, [*a, *b].into_iter(), false),
            Code::Or(a, b) => self.truth_of_all(frame, [*a, *b].into_iter(), true),
            Code::Not(operand) => self.eval_not(frame, *operand),
            Code::Negate(operand) => {
                let value = self.eval(frame, *operand)?;
                self.negate(value, unit.span(*operand))
            }
            Code::For(code) => self.eval_for(frame, code, unit.span(id)),
            Code::Index(object, index) => self.eval_index(frame, *object, *index),
            Code::Member(object, name) => {
                let value = self.eval(frame, *object)?;
                self.member(value, unit.span(*object), name)
            }
            _ => self.eval_rare(frame, id),
        }
    }

    /// The kinds of code that make a value of their own; apart, so that the common path keeps a
    /// small stack frame.
    #[inline(never)]
    fn eval_rare(&mut self, frame: &Frame, id: CodeId) -> Outcome<Value> {
        let span = frame.unit.span(id);
        match &frame.unit.code[id.0 as usize] {
            Code::List(items) => {
                self.room(items.len(), span)?;
                let mut values = Vec::with_capacity(items.len());
                for item in items {
                    values.push(self.eval(frame, *item)?);
                }
                Ok(Value::list(values))
            }
            Code::Record(parts) => self.eval_record(frame, parts),
            Code::Text(parts) => self.eval_text(frame, parts, span),
            Code::Range(code) => self.eval_range(frame, code, span),
            Code::Closure(index) => Ok(self.closure(frame, *index)),
            Code::Again(arguments) => self.again(frame, arguments, span),
            Code::Native(native) => self.native_constant(frame, *native, span),
            Code::Myself => frame.myself.cloned().map(Value::Function).ok_or(Failure::TOLD),
            _ => Err(Failure::TOLD),
        }
    }

    fn run_steps(&mut self, frame: &Frame, steps: &[Step]) -> Outcome<()> {
        for step in steps {
            match step {
                Step::Bind { slot, value, ty } => {
                    let span = frame.unit.span(*value);
                    let value = self.eval(frame, *value)?;
                    let value = self.typed(value, ty.as_ref(), span)?;
                    self.stack[frame.base + *slot as usize] = value;
                }
                Step::Assert(assert) => self.assert(frame, assert)?,
                Step::Drop(code) => {
                    let value = self.eval(frame, *code)?;
                    self.warn_unused(&value, frame.unit.span(*code));
                }
            }
        }
        Ok(())
    }

    /// Warns of a value that is computed and dropped in a block.
    fn warn_unused(&mut self, value: &Value, span: Span) {
        if matches!(value, Value::Symbol(Symbol::None)) || span.source == LIBRARY {
            return;
        }
        let warning =
            Diagnostic::warning(base::Code::Unused, "this value is not used").label(span, "");
        let help = match value.shape() {
            Some(_) => "only the last value of a block counts: join the shapes with `+`",
            None => "give it a name or remove it",
        };
        self.record(warning.help(help));
    }

    /// A value checked against a written type.
    pub(super) fn typed(&mut self, value: Value, ty: Option<&Type>, span: Span) -> Outcome<Value> {
        let Some(ty) = ty else { return Ok(value) };
        match ty.check(&self.graph, &value) {
            Ok(()) => Ok(ty.convert(&mut self.graph, value)),
            Err(misfit) => {
                let error = Diagnostic::error(misfit.code, misfit.words).label(span, "");
                Err(self.with_fraction(error, span).into())
            }
        }
    }

    /// Adds `did you mean `0.25in`?` where a quotient such as `1/4in` stands.
    pub(super) fn with_fraction(&self, error: Diagnostic, span: Span) -> Diagnostic {
        let mut fractions = self.units.values().flatten().flat_map(|unit| &unit.fractions);
        match fractions.find(|(at, _)| *at == span) {
            Some((_, meant)) => error.help(format!("did you mean `{meant}`?")).fix(span, &**meant),
            None => error,
        }
    }

    pub(super) fn truth(&mut self, frame: &Frame, id: CodeId) -> Outcome<bool> {
        match self.eval(frame, id)? {
            Value::Bool(value) => Ok(value),
            other => {
                let words = format!("needs a truth value, got {}", shown(&other));
                fail(base::Code::WrongKind, frame.unit.span(id), words)
            }
        }
    }

    fn eval_record(&mut self, frame: &Frame, parts: &[RecordPart]) -> Outcome<Value> {
        let mut fields: Vec<(Arc<str>, Value)> = Vec::with_capacity(parts.len());
        let mut set = |name: &Arc<str>, value: Value| match fields.iter_mut().find(|f| f.0 == *name)
        {
            Some(field) => field.1 = value,
            None => fields.push((name.clone(), value)),
        };
        for part in parts {
            match part {
                RecordPart::Field(name, code) => set(name, self.eval(frame, *code)?),
                RecordPart::Spread(code) => match self.eval(frame, *code)? {
                    Value::Record(record) => {
                        record.fields().iter().for_each(|(name, value)| set(name, value.clone()));
                    }
                    other => {
                        let words =
                            format!("only a record can be spread here, got {}", shown(&other));
                        return fail(base::Code::WrongKind, frame.unit.span(*code), words);
                    }
                },
            }
        }
        Ok(Value::record(fields))
    }

    fn eval_text(&mut self, frame: &Frame, parts: &[TextPart], span: Span) -> Outcome<Value> {
        use std::fmt::Write;
        let mut text = String::new();
        for part in parts {
            match part {
                TextPart::Literal(literal) => text.push_str(literal),
                TextPart::Value(code) => {
                    let value = self.eval(frame, *code)?;
                    let _ = write!(text, "{value}");
                    self.room(text.len() / meter::BYTES_A_VALUE, span)?;
                }
            }
        }
        Ok(Value::text(text))
    }

    fn eval_range(
        &mut self,
        frame: &Frame,
        code: &super::unit::RangeCode,
        span: Span,
    ) -> Outcome<Value> {
        let (start, dimension) = self.number(frame, code.start)?;
        let (end, end_dimension) = self.number(frame, code.end)?;
        let step = code.step.map(|step| self.number(frame, step)).transpose()?;
        let spans = |other| (frame.unit.span(code.start), frame.unit.span(other));
        let joined = dimension.common(end_dimension);
        let clash = |a, b, other| arithmetic::clash(a, b, spans(other), "the bounds of a range");
        let mut common = joined.ok_or_else(|| clash(dimension, end_dimension, code.end))?;
        if let (Some((_, step_dimension)), Some(at)) = (step, code.step) {
            let joined = common.common(step_dimension);
            common = joined.ok_or_else(|| clash(common, step_dimension, at))?;
        }
        if step.is_some_and(|(step, _)| step == 0.0) {
            let at = code.step.map_or(span, |step| frame.unit.span(step));
            return fail(base::Code::OutOfRange, at, "the step of a range cannot be 0");
        }
        let step = step.map(|(step, _)| step);
        let range = Range::new(start, end, step, code.unit, code.inclusive);
        Ok(Value::Range(Arc::new(range.of(common))))
    }

    fn number(&mut self, frame: &Frame, id: CodeId) -> Outcome<(f64, super::Dimension)> {
        match self.eval(frame, id)? {
            Value::Number(value, dimension) => Ok((value, dimension)),
            other => {
                let words = format!("needs a number, got {}", shown(&other));
                fail(base::Code::WrongKind, frame.unit.span(id), words)
            }
        }
    }

    /// Counts `count` steps of work.
    pub(super) fn tick(&mut self, count: u64, span: Span) -> Outcome<()> {
        self.steps_taken = self.steps_taken.saturating_add(count);
        if self.steps_taken <= self.limits.steps {
            return Ok(());
        }
        let message = format!("the model takes more than {} steps", self.limits.steps);
        fail(base::Code::Limit, self.shown_at(span), message)
    }

    /// Steps until the limit.
    pub(super) fn steps_left(&self) -> u64 {
        self.limits.steps.saturating_sub(self.steps_taken)
    }

    /// Makes sure that `count` more values may be kept.
    pub(super) fn room(&mut self, count: usize, span: Span) -> Outcome<()> {
        let built = self.graph.len() as u64 * VALUES_A_NODE + self.cells_made;
        let alive = meter::live().saturating_add(count as u64).saturating_add(built);
        if alive <= self.limits.values {
            return Ok(());
        }
        let message = format!("the model keeps more than {} values at a time", self.limits.values);
        fail(base::Code::Limit, self.shown_at(span), message)
    }

    /// A place the modeller can see: library code is shown at the call that led into it.
    pub(super) fn shown_at(&self, span: Span) -> Span {
        if span.source == LIBRARY { self.library_call } else { span }
    }
}
