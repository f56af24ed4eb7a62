//! Lists, records and strings: shared, immutable, counted, and safe to drop at any depth.

use std::{ops::Deref, sync::Arc};

use super::{
    Value,
    function::Function,
    meter::{self, BYTES_A_VALUE},
};
use crate::geom::CurvedGrid;

/// The elements of a list.
#[derive(Debug)]
pub struct List(Vec<Value>);

impl List {
    /// A list of these elements.
    pub fn new(items: Vec<Value>) -> List {
        meter::take(items.len() + 1);
        List(items)
    }
}

impl Deref for List {
    type Target = [Value];
    fn deref(&self) -> &[Value] {
        &self.0
    }
}

/// Keys and values in the order they were written; no key stands twice.
#[derive(Debug)]
pub struct Record(Vec<(Arc<str>, Value)>);

impl Record {
    /// A record of these fields; a later field replaces an earlier one of the same key.
    pub fn new(fields: Vec<(Arc<str>, Value)>) -> Record {
        meter::take(2 * fields.len() + 1);
        Record(fields)
    }

    /// The value behind a key.
    pub fn get(&self, key: &str) -> Option<&Value> {
        self.0.iter().find(|(name, _)| **name == *key).map(|(_, value)| value)
    }

    /// All fields.
    pub fn fields(&self) -> &[(Arc<str>, Value)] {
        &self.0
    }
}

/// The characters of a string.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Text(Box<str>);

impl Text {
    /// A string of these characters.
    pub fn new(text: impl Into<Box<str>>) -> Text {
        let text = text.into();
        meter::take(text.len() / BYTES_A_VALUE + 1);
        Text(text)
    }
}

impl Deref for Text {
    type Target = str;
    fn deref(&self) -> &str {
        &self.0
    }
}

/// A surface given by points in rows.
#[derive(Debug)]
pub struct Surface(Arc<CurvedGrid>);

impl Surface {
    /// A point with its number takes so many times the room of a value.
    pub const VALUES_A_POINT: usize = 2;

    /// A surface with these points.
    pub fn new(grid: CurvedGrid) -> Surface {
        meter::take(grid.points().len() * Surface::VALUES_A_POINT);
        Surface(Arc::new(grid))
    }

    /// Its points.
    pub fn grid(&self) -> &Arc<CurvedGrid> {
        &self.0
    }
}

impl Drop for Surface {
    fn drop(&mut self) {
        meter::give_back(self.0.points().len() * Surface::VALUES_A_POINT);
    }
}

impl Drop for Text {
    fn drop(&mut self) {
        meter::give_back(self.0.len() / BYTES_A_VALUE + 1);
    }
}

impl Drop for List {
    fn drop(&mut self) {
        meter::give_back(self.0.len() + 1);
        drop_flat(self.0.drain(..));
    }
}

impl Drop for Record {
    fn drop(&mut self) {
        meter::give_back(2 * self.0.len() + 1);
        drop_flat(self.0.drain(..).map(|(_, value)| value));
    }
}

/// Drops values with a list of work in place of recursion, so that depth costs no stack.
pub(super) fn drop_flat(values: impl Iterator<Item = Value>) {
    let mut pending: Vec<Value> = values.filter(Value::is_container).collect();
    while let Some(value) = pending.pop() {
        match value {
            Value::List(shared) => {
                if let Some(mut list) = Arc::into_inner(shared) {
                    meter::give_back(list.0.len());
                    pending.extend(list.0.drain(..).filter(Value::is_container));
                }
            }
            Value::Record(shared) => {
                if let Some(mut record) = Arc::into_inner(shared) {
                    meter::give_back(2 * record.0.len());
                    let values = record.0.drain(..).map(|(_, value)| value);
                    pending.extend(values.filter(Value::is_container));
                }
            }
            Value::Function(shared) => {
                if let Some(Function::Closure(mut closure)) = Arc::into_inner(shared) {
                    let captures = closure.take_captures();
                    pending.extend(captures.into_iter().filter(Value::is_container));
                }
            }
            _ => {}
        }
    }
}
