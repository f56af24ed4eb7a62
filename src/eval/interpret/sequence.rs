//! Lists and ranges: their elements, and `a[i]`.

use std::sync::Arc;

use super::{
    super::{
        dimension::Dimension,
        evaluator::Evaluator,
        failure::{Outcome, fail},
        nearest::did_you_mean,
        types::shown,
        unit::CodeId,
        value::{List, Record, Value},
    },
    Frame,
};
use crate::base::{Code, Diagnostic, Span};

impl Evaluator<'_> {
    /// The elements of a list or range, those of a range counted before they are made.
    pub(in crate::eval) fn items(&mut self, value: &Value, at: Span) -> Outcome<Arc<List>> {
        match value {
            Value::List(list) => Ok(list.clone()),
            Value::Range(range) => {
                self.tick(range.count(), at)?;
                self.room(usize::try_from(range.count()).unwrap_or(usize::MAX), at)?;
                let items = (0..range.count()).map(|i| range.element(i)).collect();
                Ok(Arc::new(List::new(items)))
            }
            other => fail(Code::WrongKind, at, format!("needs a list, got {}", shown(other))),
        }
    }

    pub(super) fn eval_index(
        &mut self,
        frame: &Frame,
        object: CodeId,
        index: CodeId,
    ) -> Outcome<Value> {
        let value = self.eval(frame, object)?;
        let key = self.eval(frame, index)?;
        let at = (frame.unit.span(object), frame.unit.span(index));
        match (&value, &key) {
            (Value::Record(record), Value::Text(key)) => {
                record.get(key).cloned().ok_or_else(|| missing_key(record, key, at.1).into())
            }
            (
                Value::List(_) | Value::Range(_) | Value::Text(_),
                Value::Number(number, dimension),
            ) => {
                if *dimension != Dimension::BARE || number.fract() != 0.0 {
                    let words = format!("an index is a whole bare number, got `{key}`");
                    return fail(Code::OutOfRange, at.1, words);
                }
                pick(&value, *number, at)
            }
            (Value::List(_) | Value::Range(_) | Value::Text(_), other) => fail(
                Code::WrongKind,
                at.1,
                format!("an index is a whole number, got {}", shown(other)),
            ),
            (other, _) => fail(Code::WrongKind, at.0, format!("{} has no elements", other.words())),
        }
    }
}

fn pick(value: &Value, index: f64, at: (Span, Span)) -> Outcome<Value> {
    let count = match value {
        Value::Text(text) => text.chars().count() as u64,
        value => value.count().unwrap_or(0),
    };
    let from_start = if index < 0.0 { index + count as f64 } else { index };
    let found = (from_start >= 0.0 && from_start < count as f64).then_some(from_start as u64);
    let element = found.and_then(|i| match value {
        Value::Text(text) => text.chars().nth(i as usize).map(|c| Value::text(c.to_string())),
        value => value.element(i),
    });
    element.ok_or_else(|| {
        let bounds = match count {
            0 => "the list is empty".to_string(),
            n => format!("it has {n} elements: 0 to {}, or -{n} to -1 from the end", n - 1),
        };
        Diagnostic::error(Code::OutOfRange, format!("index {index} is out of range"))
            .label(at.1, "")
            .label(at.0, bounds)
            .into()
    })
}

/// The error for a key that a record does not have.
pub fn missing_key(record: &Record, key: &str, at: Span) -> Diagnostic {
    let keys = || record.fields().iter().map(|(key, _)| &**key);
    let error =
        Diagnostic::error(Code::MissingKey, format!("the record has no `{key}`")).label(at, "");
    match did_you_mean(key, keys()) {
        Some((help, _)) => error.help(help),
        None if record.fields().is_empty() => error.help("the record is empty"),
        None => {
            let list: Vec<String> = keys().take(20).map(|key| format!("`{key}`")).collect();
            error.help(format!("it has {}", list.join(", ")))
        }
    }
}
