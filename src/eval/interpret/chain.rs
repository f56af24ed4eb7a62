//! Operators that bind alike, taken from left to right without going deeper.

use super::{
    super::{
        evaluator::Evaluator,
        failure::Outcome,
        unit::{ChainCode, CodeId},
        value::Value,
    },
    Frame,
    arithmetic::Operands,
};
use crate::syntax::ast::BinaryOp;

impl Evaluator<'_> {
    pub(super) fn eval_chain(&mut self, frame: &Frame, chain: &ChainCode) -> Outcome<Value> {
        match chain.links.first() {
            Some((BinaryOp::And, _)) => self.truth_of_all(frame, chain.operands(), false),
            Some((BinaryOp::Or, _)) => self.truth_of_all(frame, chain.operands(), true),
            _ => self.fold_chain(frame, chain),
        }
    }

    fn fold_chain(&mut self, frame: &Frame, chain: &ChainCode) -> Outcome<Value> {
        let unit = frame.unit;
        let mut total = self.eval(frame, chain.first)?;
        let mut left = unit.span(chain.first);
        for &(op, operand) in &chain.links {
            let value = self.eval(frame, operand)?;
            let right = unit.span(operand);
            let whole = left.to(right);
            total = self.binary(op, total, value, Operands { whole, left, right })?;
            left = whole;
        }
        Ok(total)
    }
}

impl ChainCode {
    /// The operands from left to right.
    pub fn operands(&self) -> impl Iterator<Item = CodeId> {
        std::iter::once(self.first).chain(self.links.iter().map(|(_, operand)| *operand))
    }
}
