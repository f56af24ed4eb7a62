//! Instances: a file with its parameters set, its names evaluated when they are asked for.

use std::sync::Arc;

use super::{failure::Failure, unit::Unit, value::Value};
use crate::base::Span;

/// Names one instance of one file.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct InstanceId(pub(super) u32);

impl InstanceId {
    /// Library code, which has no parameters and no top-level values.
    pub(super) const LIBRARY: InstanceId = InstanceId(u32::MAX);
}

/// How far a top-level name has come.
#[derive(Clone, Debug)]
pub enum Cell {
    Todo,
    /// Being evaluated: whoever needs it now is part of a cycle.
    Busy,
    Done(Value),
    Failed(Failure),
}

/// A parameter's value given from outside.
#[derive(Clone, Debug)]
pub struct Given {
    pub name: Arc<str>,
    pub value: Value,
    /// Where it was given; `None` for `-D`.
    pub span: Option<Span>,
}

#[derive(Debug)]
pub struct Instance {
    pub unit: Arc<Unit>,
    pub cells: Vec<Cell>,
    pub given: Vec<Given>,
    /// The seed that the file sets.
    pub seed: Cell,
    /// Set when a parameter or a top-level assert refuses the instance.
    pub refused: Option<Failure>,
    /// Whether its asserts were checked with geometry.
    pub proved: bool,
}

impl Instance {
    pub fn new(unit: Arc<Unit>, given: Vec<Given>) -> Instance {
        let cells = vec![Cell::Todo; unit.globals.len()];
        Instance { unit, cells, given, seed: Cell::Todo, refused: None, proved: false }
    }

    pub fn given(&self, name: &str) -> Option<&Given> {
        self.given.iter().find(|given| *given.name == *name)
    }
}
