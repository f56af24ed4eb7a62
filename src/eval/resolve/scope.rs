//! Scopes of one function: names to slots of its frame, and captures from around it.

use std::sync::Arc;

use crate::{base::Span, eval::unit::Capture};

/// A name bound to a slot.
pub struct Local {
    pub name: Arc<str>,
    pub slot: u32,
    pub span: Span,
}

/// The names a function sees, its own and those it captures.
#[derive(Default)]
pub struct Scope {
    locals: Vec<Local>,
    /// For each open block the number of locals before it.
    blocks: Vec<usize>,
    next: u32,
    /// Slots the frame needs.
    pub frame: u32,
    pub captures: Vec<(Arc<str>, Capture)>,
    /// The function's own name, which its body may call.
    pub myself: Option<Arc<str>>,
}

/// Where a name was found within one function.
pub enum Found {
    Local(u32),
    Captured(u32),
    Myself,
}

impl Scope {
    pub fn open(&mut self) {
        self.blocks.push(self.locals.len());
    }

    pub fn close(&mut self) {
        let start = self.blocks.pop().unwrap_or(0);
        self.next -= (self.locals.len() - start) as u32;
        self.locals.truncate(start);
    }

    /// The same name bound in the innermost block, if any.
    pub fn bound_here(&self, name: &str) -> Option<&Local> {
        let start = self.blocks.last().copied().unwrap_or(0);
        self.locals[start..].iter().rev().find(|local| *local.name == *name)
    }

    pub fn bind(&mut self, name: Arc<str>, span: Span) -> u32 {
        let slot = self.next;
        self.next += 1;
        self.frame = self.frame.max(self.next);
        self.locals.push(Local { name, slot, span });
        slot
    }

    pub fn find(&self, name: &str) -> Option<Found> {
        if let Some(local) = self.locals.iter().rev().find(|local| *local.name == *name) {
            return Some(Found::Local(local.slot));
        }
        if self.myself.as_deref() == Some(name) {
            return Some(Found::Myself);
        }
        let captured = self.captures.iter().position(|(captured, _)| **captured == *name);
        captured.map(|index| Found::Captured(index as u32))
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.locals.iter().map(|local| &*local.name).chain(self.myself.as_deref())
    }
}
