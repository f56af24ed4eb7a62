//! `== != < <= > >=`.

use super::super::{
    dimension::Dimension,
    evaluator::Evaluator,
    failure::{Failure, Outcome},
    stack::deep,
    value::Value,
};
use super::arithmetic::{Operands, clash, symbol, wrong_operands};
use crate::syntax::ast::BinaryOp;

/// Structural equality; values of different kinds are unequal. Numbers whose dimensions cannot be
/// compared are an error, given as the two dimensions.
pub fn equal(a: &Value, b: &Value) -> Result<bool, (Dimension, Dimension)> {
    match (a, b) {
        (Value::Number(a, x), Value::Number(b, y)) => x.common(*y).map(|_| a == b).ok_or((*x, *y)),
        (Value::Symbol(a), Value::Symbol(b)) => Ok(a == b),
        (Value::Bool(a), Value::Bool(b)) => Ok(a == b),
        (Value::Text(a), Value::Text(b)) => Ok(a == b),
        (Value::Solid(a), Value::Solid(b)) | (Value::Profile(a), Value::Profile(b)) => Ok(a == b),
        (Value::Module(a), Value::Module(b)) => Ok(a == b),
        (Value::Function(a), Value::Function(b)) => Ok(std::sync::Arc::ptr_eq(a, b)),
        (Value::Record(a), Value::Record(b)) => {
            if a.fields().len() != b.fields().len() {
                return Ok(false);
            }
            for (name, left) in a.fields() {
                let Some(right) = b.get(name) else { return Ok(false) };
                if !deep(|| equal(left, right))? {
                    return Ok(false);
                }
            }
            Ok(true)
        }
        _ => match (a.count(), b.count()) {
            (Some(n), Some(m)) => Ok(n == m && equal_items(a, b, n)?),
            _ => Ok(false),
        },
    }
}

fn equal_items(a: &Value, b: &Value, count: u64) -> Result<bool, (Dimension, Dimension)> {
    if let (Value::Range(a), Value::Range(b)) = (a, b) {
        a.dimension.common(b.dimension).ok_or((a.dimension, b.dimension))?;
        return Ok(a.start == b.start && (count < 2 || a.step == b.step));
    }
    for i in 0..count {
        let (Some(a), Some(b)) = (a.element(i), b.element(i)) else { return Ok(false) };
        if !deep(|| equal(&a, &b))? {
            return Ok(false);
        }
    }
    Ok(true)
}

impl Evaluator<'_> {
    pub(in crate::eval) fn equal(&mut self, a: &Value, b: &Value, at: Operands) -> Outcome<bool> {
        equal(a, b).map_err(|(x, y)| self.differ(BinaryOp::Equal, x, y, at))
    }

    fn differ(&self, op: BinaryOp, x: Dimension, y: Dimension, at: Operands) -> Failure {
        let failure = clash(x, y, (at.left, at.right), &format!("`{}`", symbol(op)));
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
                None => return Err(self.differ(op, *x, *y, at)),
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
