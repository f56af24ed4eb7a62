//! `for`.

use super::{
    super::{
        evaluator::Evaluator,
        failure::{Outcome, fail},
        stack::deep,
        types::shown,
        unit::{Code, CodeId, ForCode},
        value::Value,
    },
    Frame,
};
use crate::base::{self, Span};

/// How many elements a loop may gather before it looks at the limit again.
const LOOK: usize = 1024;

impl Evaluator<'_> {
    #[inline(never)]
    pub(super) fn eval_for(&mut self, frame: &Frame, code: &ForCode, span: Span) -> Outcome<Value> {
        let mut gathered = vec![];
        self.run_binder(frame, code, 0, span, &mut gathered)?;
        self.room(gathered.len(), span)?;
        Ok(Value::list(gathered))
    }

    fn run_binder(
        &mut self,
        frame: &Frame,
        code: &ForCode,
        level: usize,
        span: Span,
        gathered: &mut Vec<Value>,
    ) -> Outcome<()> {
        let Some(binder) = code.binders.get(level) else {
            return self.run_body(frame, code, span, gathered);
        };
        let at = frame.unit.span(binder.source);
        let mut source = self.eval(frame, binder.source)?;
        if let Value::Text(text) = &source {
            source = Value::list(text.chars().map(|c| Value::text(c.to_string())).collect());
        }
        let Some(count) = source.count() else {
            let words = format!("`for` runs over a list or range, got {}", shown(&source));
            return fail(base::Code::WrongKind, at, words);
        };
        for i in 0..count {
            self.tick(1, span)?;
            let Some(element) = source.element(i) else { break };
            self.stack[frame.base + binder.slot as usize] = element;
            if let Some(index) = binder.index {
                self.stack[frame.base + index as usize] = Value::bare(i as f64);
            }
            match level + 1 == code.binders.len() {
                true => self.run_body(frame, code, span, gathered)?,
                false => deep(|| self.run_binder(frame, code, level + 1, span, gathered))?,
            }
        }
        Ok(())
    }

    fn run_body(
        &mut self,
        frame: &Frame,
        code: &ForCode,
        span: Span,
        gathered: &mut Vec<Value>,
    ) -> Outcome<()> {
        if let Some(condition) = code.condition
            && !self.truth(frame, condition)?
        {
            return Ok(());
        }
        if let Some(value) = self.eval_element(frame, code.body)? {
            gathered.push(value);
            if gathered.len().is_multiple_of(LOOK) {
                self.room(gathered.len(), span)?;
            }
        }
        Ok(())
    }

    /// The value of a `for` body, or `None` where an `if` without `else` drops the element.
    fn eval_element(&mut self, frame: &Frame, id: CodeId) -> Outcome<Option<Value>> {
        match &frame.unit.code[id.0 as usize] {
            Code::If { condition, then, otherwise } => {
                let branch = if self.truth(frame, *condition)? { Some(*then) } else { *otherwise };
                branch.map_or(Ok(None), |branch| deep(|| self.eval_element(frame, branch)))
            }
            Code::Block(steps, value) => {
                self.run_steps(frame, steps)?;
                deep(|| self.eval_element(frame, *value))
            }
            _ => self.eval(frame, id).map(Some),
        }
    }
}
