//! `== != < <= > >=`.

use std::sync::Arc;

use super::super::{
    dimension::Dimension,
    evaluator::Evaluator,
    failure::{Failure, Outcome},
    stack::deep,
    value::Value,
};
use super::arithmetic::{Operands, clash, symbol, wrong_operands};
use crate::{base::Span, syntax::ast::BinaryOp};

/// Elements that may be compared for one step: a comparison is much cheaper than a call.
const COMPARISONS_A_STEP: u64 = 8;

/// Why two values cannot be compared.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Incomparable {
    /// Numbers of these dimensions.
    Dimensions(Dimension, Dimension),
    /// The comparison took more steps than allowed.
    TooLong,
}

/// Structural equality; values of different kinds are unequal. Numbers whose dimensions cannot be
/// compared are an error. `steps` is what the comparison may take.
pub fn equal(a: &Value, b: &Value, steps: &mut u64) -> Result<bool, Incomparable> {
    *steps = steps.checked_sub(1).ok_or(Incomparable::TooLong)?;
    match (a, b) {
        (Value::Number(a, x), Value::Number(b, y)) => match x.common(*y) {
            Some(_) => Ok(a == b),
            None => Err(Incomparable::Dimensions(*x, *y)),
        },
        (Value::Symbol(a), Value::Symbol(b)) => Ok(a == b),
        (Value::Bool(a), Value::Bool(b)) => Ok(a == b),
        (Value::Text(a), Value::Text(b)) => Ok(a == b),
        (Value::Solid(a), Value::Solid(b)) | (Value::Profile(a), Value::Profile(b)) => Ok(a == b),
        (Value::Curve(a), Value::Curve(b)) => Ok(a == b),
        (Value::Surface(a), Value::Surface(b)) => Ok(a.grid() == b.grid()),
        (Value::Drawing(a), Value::Drawing(b)) => Ok(a == b),
        (Value::Picture(a), Value::Picture(b)) => Ok(a == b),
        (Value::Page(a), Value::Page(b)) => Ok(a == b),
        (Value::Module(a), Value::Module(b)) => Ok(a == b),
        (Value::Field(a), Value::Field(b)) => Ok(a == b),
        (Value::Traced(a), Value::Traced(b)) => Ok(a == b),
        (Value::Function(a), Value::Function(b)) => Ok(Arc::ptr_eq(a, b)),
        (Value::Record(a), Value::Record(b)) => {
            if a.fields().len() != b.fields().len() {
                return Ok(false);
            }
            for (name, left) in a.fields() {
                let Some(right) = b.get(name) else { return Ok(false) };
                if !deep(|| equal(left, right, steps))? {
                    return Ok(false);
                }
            }
            Ok(true)
        }
        (Value::List(a), Value::List(b)) if Arc::ptr_eq(a, b) => Ok(true),
        _ => match (a.count(), b.count()) {
            (Some(n), Some(m)) => Ok(n == m && equal_items(a, b, n, steps)?),
            _ => Ok(false),
        },
    }
}

fn equal_items(a: &Value, b: &Value, count: u64, steps: &mut u64) -> Result<bool, Incomparable> {
    if let (Value::Range(a), Value::Range(b)) = (a, b) {
        let (x, y) = (a.dimension, b.dimension);
        x.common(y).ok_or(Incomparable::Dimensions(x, y))?;
        return Ok(a.start == b.start && (count < 2 || a.step == b.step));
    }
    for i in 0..count {
        let (Some(a), Some(b)) = (a.element(i), b.element(i)) else { return Ok(false) };
        if !deep(|| equal(&a, &b, steps))? {
            return Ok(false);
        }
    }
    Ok(true)
}

impl Evaluator<'_> {
    pub(in crate::eval) fn equal(&mut self, a: &Value, b: &Value, at: Operands) -> Outcome<bool> {
        self.compared(at, "`==`", |steps| equal(a, b, steps))
    }

    /// Runs a comparison with the steps that are left, and counts those it takes.
    pub(in crate::eval) fn compared<T>(
        &mut self,
        at: Operands,
        what: &str,
        comparison: impl FnOnce(&mut u64) -> Result<T, Incomparable>,
    ) -> Outcome<T> {
        let allowed = self.steps_left();
        let mut left = allowed;
        let result = comparison(&mut left);
        self.steps_taken += (allowed - left) / COMPARISONS_A_STEP;
        match result {
            Ok(result) => Ok(result),
            Err(Incomparable::Dimensions(x, y)) => Err(self.differ(what, x, y, at)),
            Err(Incomparable::TooLong) => self.tick(u64::MAX, at.whole).and(Err(Failure::TOLD)),
        }
    }

    /// Equality in look-ups, where numbers of another dimension are just different.
    pub(in crate::eval) fn same(&mut self, a: &Value, b: &Value, at: Span) -> Outcome<bool> {
        let places = Operands { whole: at, left: at, right: at };
        self.compared(places, "`==`", |steps| match equal(a, b, steps) {
            Err(Incomparable::Dimensions(..)) => Ok(false),
            result => result,
        })
    }

    fn differ(&self, what: &str, x: Dimension, y: Dimension, at: Operands) -> Failure {
        let failure = clash(x, y, (at.left, at.right), what);
        failure.map(|error| {
            let error = self.with_fraction(error, at.left);
            self.with_fraction(error, at.right)
        })
    }

    pub(in crate::eval) fn order(
        &mut self,
        op: BinaryOp,
        a: &Value,
        b: &Value,
        at: Operands,
    ) -> Outcome<Value> {
        let order = match (a, b) {
            (Value::Number(a, x), Value::Number(b, y)) => match x.common(*y) {
                Some(_) => a.partial_cmp(b),
                None => return Err(self.differ(&format!("`{}`", symbol(op)), *x, *y, at)),
            },
            (Value::Text(a), Value::Text(b)) => Some(a.cmp(b)),
            _ => return Err(wrong_operands(op, a, b, at)),
        };
        Ok(Value::Bool(order.is_some_and(|order| match op {
            BinaryOp::Less => order.is_lt(),
            BinaryOp::LessEqual => order.is_le(),
            BinaryOp::Greater => order.is_gt(),
            _ => order.is_ge(),
        })))
    }
}
