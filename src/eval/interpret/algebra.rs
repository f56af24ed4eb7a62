//! `+ - &` on solids and profiles: nodes of the shape graph.

use super::super::{
    evaluator::Evaluator,
    failure::{Outcome, fail},
    types::{collect_shapes, shown},
    value::Value,
};
use super::arithmetic::{Operands, symbol, wrong_operands};
use crate::{
    base::{Code, Diagnostic, Span},
    shape::{Kind, Node, ShapeId},
    syntax::ast::BinaryOp,
};

/// Operands of a node that a chain `a + b + c` lengthens in place of nesting; beyond it the longer
/// chain holds the shorter one, so that a loop of n additions takes memory in proportion to n.
const LONGEST: usize = 64;

/// The three set operations.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SetOperation {
    Union,
    Difference,
    Intersection,
}

impl Evaluator<'_> {
    pub(super) fn set_operation(
        &mut self,
        op: BinaryOp,
        left: &Value,
        right: &Value,
        at: Operands,
    ) -> Outcome<Value> {
        let (mut a, mut b) = (vec![], vec![]);
        if !collect_shapes(left, &mut a) || !collect_shapes(right, &mut b) {
            return Err(wrong_operands(op, left, right, at));
        }
        let kind = self.common_kind(&mut a, &mut b, op, at)?;
        self.tick((a.len() + b.len()) as u64, at.whole)?;
        let id = match op {
            BinaryOp::Add => {
                a.extend(b);
                self.unite(a, kind, at.whole)
            }
            BinaryOp::Subtract => {
                let minuend = self.unite(a, kind, at.whole);
                self.subtract(minuend, b, at.whole)
            }
            _ => {
                let (a, b) = (self.unite(a, kind, at.whole), self.unite(b, kind, at.whole));
                self.intersect(&[a, b], at.whole)
            }
        };
        Ok(self.shape_value(id))
    }

    /// The kind of all shapes; an `EMPTY` takes the kind of the others.
    fn common_kind(
        &mut self,
        a: &mut [ShapeId],
        b: &mut [ShapeId],
        op: BinaryOp,
        at: Operands,
    ) -> Outcome<Kind> {
        let solid = |ids: &[ShapeId]| self.find_kind(ids, Kind::Solid);
        let flat = |ids: &[ShapeId]| self.find_kind(ids, Kind::Profile);
        if (solid(a) || solid(b)) && (flat(a) || flat(b)) {
            let message = format!("`{}` cannot mix solids and profiles", symbol(op));
            let words = |ids: &[ShapeId]| if solid(ids) { "a solid" } else { "a profile" };
            let error = Diagnostic::error(Code::WrongKind, message)
                .label(at.left, words(a))
                .label(at.right, words(b));
            return Err(error.help("make a solid of the profile with `.extrude(h)`").into());
        }
        let kind = if flat(a) || flat(b) { Kind::Profile } else { Kind::Solid };
        for id in a.iter_mut().chain(b) {
            if self.graph.kind(*id) != kind {
                *id = self.add_node(Node::Empty(kind), at.whole);
            }
        }
        Ok(kind)
    }

    /// Whether a shape of that kind that is not `EMPTY` is among them.
    fn find_kind(&self, ids: &[ShapeId], kind: Kind) -> bool {
        let mut ids = ids.iter();
        ids.any(|id| {
            let empty = matches!(self.graph.node(*id), Node::Empty(Kind::Solid));
            self.graph.kind(*id) == kind && !empty
        })
    }

    /// One union of all, unions among them opened and empty shapes left out.
    pub(in crate::eval) fn unite(&mut self, ids: Vec<ShapeId>, kind: Kind, at: Span) -> ShapeId {
        let mut flat: Vec<ShapeId> = Vec::with_capacity(ids.len());
        for id in ids {
            match self.graph.node(id) {
                Node::Union(inner) if inner.len() <= LONGEST => flat.extend(inner.iter()),
                Node::Empty(_) => {}
                _ => flat.push(id),
            }
        }
        let mut seen = rustc_hash::FxHashSet::default();
        flat.retain(|id| seen.insert(*id));
        match flat[..] {
            [] => self.add_node(Node::Empty(kind), at),
            [one] => one,
            _ => self.add_node(Node::Union(flat.into()), at),
        }
    }

    /// The first less all others; a difference is lengthened in place of nesting.
    pub(in crate::eval) fn subtract(
        &mut self,
        minuend: ShapeId,
        others: Vec<ShapeId>,
        at: Span,
    ) -> ShapeId {
        let (mut list, known) = match self.graph.node(minuend) {
            Node::Difference(inner) if inner.len() <= LONGEST => (inner.to_vec(), inner.len()),
            Node::Empty(_) => return minuend,
            _ => (vec![minuend], 1),
        };
        for id in others {
            match self.graph.node(id) {
                Node::Union(inner) if inner.len() <= LONGEST => list.extend(inner.iter()),
                Node::Empty(_) => {}
                _ => list.push(id),
            }
        }
        let mut seen = rustc_hash::FxHashSet::default();
        let mut index = 0;
        list.retain(|id| {
            index += 1;
            index == 1 || seen.insert(*id)
        });
        if list.len() == known { minuend } else { self.add_node(Node::Difference(list.into()), at) }
    }

    pub(in crate::eval) fn intersect(&mut self, ids: &[ShapeId], at: Span) -> ShapeId {
        let mut flat: Vec<ShapeId> = vec![];
        for &id in ids {
            match self.graph.node(id) {
                Node::Intersection(inner) if inner.len() <= LONGEST => flat.extend(inner.iter()),
                Node::Empty(_) => return id,
                _ => flat.push(id),
            }
        }
        match flat[..] {
            [one] => one,
            _ => self.add_node(Node::Intersection(flat.into()), at),
        }
    }

    /// Adds a node made at `at`.
    pub(in crate::eval) fn add_node(&mut self, node: Node, at: Span) -> ShapeId {
        let at = self.shown_at(at);
        self.graph.add(node, at)
    }

    /// A shape as a value.
    pub(in crate::eval) fn shape_value(&self, id: ShapeId) -> Value {
        match self.graph.kind(id) {
            Kind::Solid => Value::Solid(id),
            Kind::Profile => Value::Profile(id),
        }
    }

    /// Shapes of a list, lists opened at every level; all of one kind.
    pub(in crate::eval) fn shapes_of(
        &mut self,
        value: &Value,
        at: Span,
    ) -> Outcome<(Vec<ShapeId>, Kind)> {
        let mut ids = vec![];
        if !collect_shapes(value, &mut ids) {
            let words = format!("needs solids or profiles, got {}", shown(value));
            return fail(Code::WrongKind, at, words);
        }
        let spans = Operands { whole: at, left: at, right: at };
        let kind = self.common_kind(&mut ids, &mut [], BinaryOp::Add, spans)?;
        Ok((ids, kind))
    }

    /// A set operation on lists, as the functions `union`, `difference`, `intersection` do it.
    pub(in crate::eval) fn combine(
        &mut self,
        operation: SetOperation,
        first: Option<ShapeId>,
        list: &Value,
        at: Span,
    ) -> Outcome<Value> {
        let (mut others, mut kind) = self.shapes_of(list, at)?;
        if let Some(first) = first {
            let spans = Operands { whole: at, left: at, right: at };
            kind = self.common_kind(&mut [first], &mut others, BinaryOp::Subtract, spans)?;
        }
        let id = match (operation, first) {
            (SetOperation::Union, _) => self.unite(others, kind, at),
            (SetOperation::Difference, Some(first)) => self.subtract(first, others, at),
            (SetOperation::Difference, None) => self.unite(others, kind, at),
            (SetOperation::Intersection, _) if others.is_empty() => {
                return fail(Code::OutOfRange, at, "an intersection needs at least one shape");
            }
            (SetOperation::Intersection, _) => self.intersect(&others, at),
        };
        Ok(self.shape_value(id))
    }
}
