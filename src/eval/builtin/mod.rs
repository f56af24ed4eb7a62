//! What the library declares in Katachi and does in Rust: `= builtin("solid.box.size")`.
//!
//! Each function here gets arguments that fit the declared types.

mod colors;
mod constants;
mod curves;
mod fields;
mod files;
mod isometric;
mod lists;
mod mathematics;
mod measures;
mod morphology;
mod pages;
mod patterns;
mod placing;
mod profiles;
mod random;
mod references;
mod shades;
mod solids;
mod strings;
mod surfaces;
mod sweeps;
mod views;

pub use files::data_value;

use glam::{DVec2, DVec3};

use super::{
    dimension::Dimension,
    evaluator::Evaluator,
    failure::{Outcome, fail},
    interpret::Frame,
    types::shown,
    unit::Parameter,
    value::{Symbol, Value, number_text},
};
use crate::{
    base::{Code, Span},
    geom::overlay::REACH,
    shape::ShapeId,
};

/// A function of the library in Rust.
pub type Native = fn(&mut Evaluator, &Args) -> Outcome<Value>;

/// The Rust function of a name in `builtin("...")`.
pub fn find(name: &str) -> Option<Native> {
    let tables = [
        constants::TABLE,
        curves::TABLE,
        lists::TABLE,
        fields::TABLE,
        files::TABLE,
        isometric::TABLE,
        mathematics::TABLE,
        measures::TABLE,
        morphology::TABLE,
        pages::TABLE,
        patterns::TABLE,
        placing::TABLE,
        profiles::TABLE,
        random::TABLE,
        references::TABLE,
        shades::TABLE,
        solids::TABLE,
        strings::TABLE,
        surfaces::TABLE,
        sweeps::TABLE,
        views::TABLE,
    ];
    let mut entries = tables.into_iter().flatten();
    entries.find(|(known, _)| *known == name).map(|(_, native)| *native)
}

/// Arguments of a call of the library, one for each parameter.
pub struct Args<'a> {
    pub values: &'a [Value],
    /// Where each was written; the call where a default was taken.
    pub spans: &'a [Span],
    pub params: &'a [Parameter],
    /// The whole call.
    pub call: Span,
    /// Where the call stands.
    pub caller: &'a Frame<'a>,
}

impl Args<'_> {
    pub fn value(&self, i: usize) -> &Value {
        self.values.get(i).unwrap_or(&Value::NONE)
    }

    pub fn span(&self, i: usize) -> Span {
        self.spans.get(i).copied().unwrap_or(self.call)
    }

    pub fn name(&self, i: usize) -> &str {
        self.params.get(i).map_or("?", |param| &param.name)
    }

    /// Whether an optional argument was given.
    pub fn given(&self, i: usize) -> bool {
        !matches!(self.value(i), Value::Symbol(Symbol::None))
    }

    /// Stops with an error at an argument.
    pub fn fail<T>(&self, i: usize, code: Code, message: impl Into<String>) -> Outcome<T> {
        fail(code, self.span(i), message)
    }

    /// Stops because an argument is of the wrong kind.
    pub fn wrong<T>(&self, i: usize, needed: &str) -> Outcome<T> {
        let words = format!("`{}` needs {needed}, got {}", self.name(i), shown(self.value(i)));
        self.fail(i, Code::WrongKind, words)
    }

    /// A number and its dimension.
    pub fn quantity(&self, i: usize) -> Outcome<(f64, Dimension)> {
        match self.value(i) {
            Value::Number(value, dimension) => Ok((*value, *dimension)),
            _ => self.wrong(i, "a number"),
        }
    }

    /// A number without its dimension: mm, degrees or bare as declared.
    pub fn number(&self, i: usize) -> Outcome<f64> {
        self.quantity(i).map(|(value, _)| value)
    }

    /// Stops where a length or a coordinate is larger than geometry can work with.
    pub fn within_reach(&self) -> Outcome<()> {
        for (i, param) in self.params.iter().enumerate() {
            let far = param.ty.as_ref().and_then(|ty| ty.beyond(self.value(i), REACH));
            if let Some(found) = far {
                let message = format!(
                    "`{}` holds {}mm; lengths and coordinates lie between -{REACH:e}mm and {REACH:e}mm",
                    self.name(i),
                    number_text(found)
                );
                return self.fail(i, Code::OutOfRange, message);
            }
        }
        Ok(())
    }

    /// A number above 0.
    pub fn positive(&self, i: usize) -> Outcome<f64> {
        match self.number(i)? {
            value if value > 0.0 => Ok(value),
            _ => self.degenerate(i, "must be greater than 0"),
        }
    }

    /// A number not below 0.
    pub fn not_negative(&self, i: usize) -> Outcome<f64> {
        match self.number(i)? {
            value if value >= 0.0 => Ok(value),
            _ => self.degenerate(i, "must not be negative"),
        }
    }

    /// Stops because a size leaves no shape.
    pub fn degenerate<T>(&self, i: usize, needed: &str) -> Outcome<T> {
        let message = format!("`{}` {needed}, got {}", self.name(i), self.value(i));
        self.fail(i, Code::Degenerate, message)
    }

    /// A whole number of at least `least`; the largest of 32 bits for all above it.
    pub fn count(&self, i: usize, least: u32) -> Outcome<u32> {
        let value = self.number(i)?;
        if value < f64::from(least) {
            let message = format!("`{}` must be at least {least}, got {value}", self.name(i));
            return self.fail(i, Code::OutOfRange, message);
        }
        Ok(value as u32)
    }

    /// The optional `sides`, at least 3.
    pub fn sides(&self, i: usize) -> Outcome<Option<u32>> {
        /// More sides than this would hit the triangle limit alone.
        const MOST: u32 = 100_000;
        if !self.given(i) {
            return Ok(None);
        }
        let sides = self.count(i, 3)?;
        if sides > MOST {
            let message = format!(
                "`{}` is at most {MOST}, got {}",
                self.name(i),
                number_text(self.number(i)?)
            );
            return self.fail(i, Code::Limit, message);
        }
        Ok(Some(sides))
    }

    pub fn text(&self, i: usize) -> Outcome<&str> {
        match self.value(i) {
            Value::Text(text) => Ok(text),
            _ => self.wrong(i, "a string"),
        }
    }

    pub fn shape(&self, i: usize) -> Outcome<ShapeId> {
        self.value(i).shape().map_or_else(|| self.wrong(i, "a solid or profile"), Ok)
    }

    pub fn symbol(&self, i: usize) -> Outcome<Symbol> {
        match self.value(i) {
            Value::Symbol(symbol) => Ok(*symbol),
            _ => self.wrong(i, "a constant"),
        }
    }

    /// Two or three numbers as they stand; z is 0 when left out.
    pub fn point(&self, i: usize) -> Outcome<DVec3> {
        match coordinates(self.value(i)) {
            Some(point) => Ok(point),
            None => self.wrong(i, "a point"),
        }
    }
}

/// Two or three numbers as a point.
pub fn coordinates(value: &Value) -> Option<DVec3> {
    let Value::List(list) = value else { return None };
    let number = |i: usize| match list.get(i) {
        Some(Value::Number(value, _)) => Some(*value),
        _ => None,
    };
    let z = if list.len() == 3 { number(2)? } else { 0.0 };
    matches!(list.len(), 2 | 3).then_some(())?;
    Some(DVec3::new(number(0)?, number(1)?, z))
}

/// The first two coordinates of a point.
pub fn flat(point: DVec3) -> DVec2 {
    point.truncate()
}

/// A point as a list of lengths.
pub fn point_value(point: DVec3) -> Value {
    Value::list(point.to_array().map(Value::length).to_vec())
}
