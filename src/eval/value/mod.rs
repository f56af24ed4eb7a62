//! Values: what expressions evaluate to. Immutable; clones share.

pub mod function;
pub mod meter;
mod print;
pub mod range;
pub mod store;
mod symbol;
mod traced;

use std::sync::Arc;

pub use function::{Closure, Function};
pub use print::number_text;
pub use range::Range;
pub use store::{List, Record, Surface, Text};
pub use symbol::Symbol;
pub use traced::Traced;

use super::{dimension::Dimension, instance::InstanceId};
use crate::shape::{CurveSpec, PageSpec, ShadeSpec, ShapeId, ViewSpec};

/// A value of the language, 16 bytes.
#[derive(Clone, Debug)]
pub enum Value {
    /// A constant that stands for itself; `NONE` among them.
    Symbol(Symbol),
    /// A truth value.
    Bool(bool),
    /// A finite number in mm^i deg^j.
    Number(f64, Dimension),
    /// A string.
    Text(Arc<Text>),
    /// A list.
    List(Arc<List>),
    /// A record.
    Record(Arc<Record>),
    /// A range.
    Range(Arc<Range>),
    /// A function.
    Function(Arc<Function>),
    /// A solid.
    Solid(ShapeId),
    /// A plane figure.
    Profile(ShapeId),
    /// A curve in space.
    Curve(Arc<CurveSpec>),
    /// A surface given by points in rows.
    Surface(Arc<Surface>),
    /// The distance from a solid, everywhere.
    Field(ShapeId),
    /// A number or truth value that depends on the point of a field.
    Traced(Traced),
    /// A view of shapes.
    Drawing(Arc<ViewSpec>),
    /// A picture of shapes in the light.
    Picture(Arc<ShadeSpec>),
    /// A page with views on it.
    Page(Arc<PageSpec>),
    /// A file with its parameters set.
    Module(InstanceId),
}

const _: () = assert!(size_of::<Value>() == 16);

impl Value {
    /// `NONE`.
    pub const NONE: Value = Value::Symbol(Symbol::None);

    /// A bare number.
    pub const fn bare(value: f64) -> Value {
        Value::Number(value, Dimension::BARE)
    }

    /// Millimetres.
    pub const fn length(value: f64) -> Value {
        Value::Number(value, Dimension::LENGTH)
    }

    /// A string.
    pub fn text(text: impl Into<Box<str>>) -> Value {
        Value::Text(Arc::new(Text::new(text)))
    }

    /// A list.
    pub fn list(items: Vec<Value>) -> Value {
        Value::List(Arc::new(List::new(items)))
    }

    /// A record of fields with different keys.
    pub fn record(fields: Vec<(Arc<str>, Value)>) -> Value {
        Value::Record(Arc::new(Record::new(fields)))
    }

    /// The kind in plain words with an article, a number's dimension included.
    pub fn words(&self) -> String {
        match self {
            Value::Symbol(symbol) => format!("`{symbol}`"),
            Value::Bool(_) => "a truth value".into(),
            Value::Number(_, dimension) => dimension.words(),
            Value::Text(_) => "a string".into(),
            Value::List(_) => "a list".into(),
            Value::Record(_) => "a record".into(),
            Value::Range(_) => "a range".into(),
            Value::Function(_) => "a function".into(),
            Value::Solid(_) => "a solid".into(),
            Value::Profile(_) => "a profile".into(),
            Value::Curve(_) => "a curve".into(),
            Value::Surface(_) => "a surface".into(),
            Value::Field(_) => "a field".into(),
            Value::Traced(traced) => traced.words(),
            Value::Drawing(_) => "a drawing".into(),
            Value::Picture(_) => "a picture".into(),
            Value::Page(_) => "a page".into(),
            Value::Module(_) => "a module".into(),
        }
    }

    /// Whether dropping it may drop other values.
    pub(super) fn is_container(&self) -> bool {
        matches!(self, Value::List(_) | Value::Record(_) | Value::Function(_))
    }

    /// The shape behind a solid or profile.
    pub fn shape(&self) -> Option<ShapeId> {
        match self {
            Value::Solid(id) | Value::Profile(id) => Some(*id),
            _ => None,
        }
    }

    /// Number of elements of a list or range.
    pub fn count(&self) -> Option<u64> {
        match self {
            Value::List(list) => Some(list.len() as u64),
            Value::Range(range) => Some(range.count()),
            _ => None,
        }
    }

    /// The element of a list or range; `index` must be below its count.
    pub fn element(&self, index: u64) -> Option<Value> {
        match self {
            Value::List(list) => list.get(index as usize).cloned(),
            Value::Range(range) if index < range.count() => Some(range.element(index)),
            _ => None,
        }
    }
}
