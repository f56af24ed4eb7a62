//! The arena of hash-consed nodes.

use rustc_hash::FxHashMap;

use super::{
    fingerprint::fingerprint,
    node::{Kind, Node, ShapeId},
    stretched,
};
use crate::base::Span;

/// What is known of a node before it is made.
#[derive(Clone, Copy, Debug)]
struct Facts {
    kind: Kind,
    curves: u32,
    level: bool,
}

/// All shapes of one evaluation.
///
/// ```
/// use katachi::shape::{Node, ShapeGraph};
/// use katachi::base::Span;
/// let mut graph = ShapeGraph::default();
/// let ball = Node::Sphere { r: 2.0, sides: None };
/// let a = graph.add(ball.clone(), Span::default());
/// let b = graph.add(ball, Span::default());
/// assert_eq!(a, b);
/// ```
#[derive(Clone, Debug, Default)]
pub struct ShapeGraph {
    nodes: Vec<Node>,
    origins: Vec<Span>,
    facts: Vec<Facts>,
    /// By fingerprint; nodes whose fingerprints collide stand at the next free numbers.
    index: FxHashMap<u64, ShapeId>,
}

impl ShapeGraph {
    /// The node's number: a new one, or that of an equal node added before. `origin` is the call that
    /// made it, for diagnostics; the first one is kept.
    ///
    /// # Panics
    /// When a child's number is not of this graph, or solids and profiles are mixed.
    pub fn add(&mut self, node: Node, origin: Span) -> ShapeId {
        let mut key = fingerprint(&node);
        while let Some(&found) = self.index.get(&key) {
            if *self.node(found) == node {
                return found;
            }
            key = key.wrapping_add(1);
        }
        let facts = Facts {
            kind: self.kind_of(&node),
            curves: stretched::curves(&node, |child| self.curves(child)),
            level: stretched::level(&node, |child| self.is_level(child)),
        };
        let id = ShapeId(self.nodes.len() as u32);
        self.nodes.push(node);
        self.origins.push(origin);
        self.facts.push(facts);
        self.index.insert(key, id);
        id
    }

    /// The node behind a number.
    pub fn node(&self, id: ShapeId) -> &Node {
        &self.nodes[id.0 as usize]
    }

    /// The call that first made it.
    pub fn origin(&self, id: ShapeId) -> Span {
        self.origins[id.0 as usize]
    }

    /// Whether it is a solid or a profile.
    pub fn kind(&self, id: ShapeId) -> Kind {
        self.facts[id.0 as usize].kind
    }

    /// How many things made with the tolerance are in it.
    pub(super) fn curves(&self, id: ShapeId) -> u32 {
        self.facts[id.0 as usize].curves
    }

    /// Whether nothing in it is taken out of planes parallel to xy.
    pub(super) fn is_level(&self, id: ShapeId) -> bool {
        self.facts[id.0 as usize].level
    }

    /// The number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is no node yet.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    fn kind_of(&self, node: &Node) -> Kind {
        match node {
            Node::Empty(kind) => *kind,
            Node::Rect { .. }
            | Node::Ellipse { .. }
            | Node::Polygon { .. }
            | Node::Outline { .. }
            | Node::Text(_)
            | Node::ImportProfile { .. }
            | Node::OffsetProfile { .. }
            | Node::RoundProfile { .. } => Kind::Profile,
            Node::Union(list)
            | Node::Difference(list)
            | Node::Intersection(list)
            | Node::Hull(list) => self.common_kind(list),
            Node::Transform { child, .. }
            | Node::Tag { child, .. }
            | Node::Paint { child, .. }
            | Node::Fillet { child, .. } => self.kind(*child),
            _ => Kind::Solid,
        }
    }

    fn common_kind(&self, list: &[ShapeId]) -> Kind {
        let mut kinds = list.iter().map(|&id| self.kind(id));
        let first = kinds.next().unwrap_or(Kind::Solid);
        assert!(kinds.all(|kind| kind == first), "solids and profiles cannot be mixed");
        first
    }
}
