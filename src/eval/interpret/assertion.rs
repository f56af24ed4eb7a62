//! `assert`: what must hold, and what is told when it does not.

use super::{
    super::{
        evaluator::Evaluator,
        failure::Outcome,
        unit::{ArgumentCode, AssertCode, Code, CodeId, Unit},
        value::Value,
    },
    Frame,
};
use crate::base::{self, Diagnostic};

/// Values that are shown when an assertion fails.
const SHOWN: usize = 8;

impl Evaluator<'_> {
    pub(in crate::eval) fn assert(&mut self, frame: &Frame, assert: &AssertCode) -> Outcome<()> {
        if self.truth(frame, assert.condition)? {
            return Ok(());
        }
        let span = frame.unit.span(assert.condition);
        let message = match assert.message {
            Some(message) => self.eval(frame, message)?.to_string(),
            None => format!("this does not hold: `{}`", one_line(frame.unit.slice(span))),
        };
        let mut error =
            Diagnostic::error(base::Code::AssertionFailed, message).label(span, "does not hold");
        let mut operands = vec![];
        gather_operands(frame.unit, assert.condition, &mut operands);
        for operand in operands {
            let text = one_line(frame.unit.slice(frame.unit.span(operand)));
            if let Ok(value) = self.eval(frame, operand) {
                let note = format!("{text} = {value}");
                if !error.notes.contains(&note) {
                    error = error.note(note);
                }
            }
        }
        Err(error.into())
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The parts of a condition whose values explain it: operands of comparisons and arguments of calls
/// that are not written-out constants.
fn gather_operands(unit: &Unit, id: CodeId, found: &mut Vec<CodeId>) {
    if found.len() >= SHOWN {
        return;
    }
    match &unit.code[id.0 as usize] {
        Code::And(a, b) | Code::Or(a, b) => {
            gather_operands(unit, *a, found);
            gather_operands(unit, *b, found);
        }
        Code::Chain(chain) => {
            chain.operands().for_each(|operand| gather_operands(unit, operand, found));
        }
        Code::Not(operand) => gather_operands(unit, *operand, found),
        Code::Binary(_, a, b) => [a, b].into_iter().for_each(|id| push_operand(unit, *id, found)),
        Code::Call(call) => gather_arguments(unit, &call.arguments, found),
        Code::Method(call) => {
            push_operand(unit, call.object, found);
            gather_arguments(unit, &call.arguments, found);
        }
        _ => push_operand(unit, id, found),
    }
}

fn gather_arguments(unit: &Unit, arguments: &[ArgumentCode], found: &mut Vec<CodeId>) {
    for argument in arguments {
        match argument {
            ArgumentCode::Positional(id) | ArgumentCode::Named(_, id) => {
                push_operand(unit, *id, found)
            }
            ArgumentCode::Spread(_) => {}
        }
    }
}

fn push_operand(unit: &Unit, id: CodeId, found: &mut Vec<CodeId>) {
    let silent = match &unit.code[id.0 as usize] {
        Code::Constant(value) => !matches!(value, Value::Solid(_)),
        Code::Negate(inner) => matches!(unit.code[inner.0 as usize], Code::Constant(_)),
        Code::Closure(_) | Code::Library(_) => true,
        _ => false,
    };
    if !silent && found.len() < SHOWN {
        found.push(id);
    }
}
