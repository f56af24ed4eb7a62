//! What the graph alone says about the work: which nodes are made into solids of their own, and in
//! which order.
//!
//! A *core* is a node under its placements, tags and colours. The unit of work is a core. Operands of
//! a set operation that are set operations themselves are taken into one expression, so that a whole
//! subtree is evaluated at once; only where that expression would grow too large or too deep are its
//! inner operations made first, each once.

use rustc_hash::FxHashSet;

use crate::shape::{Kind, Node, ShapeGraph, ShapeId};

/// Leaves of one set expression. A graph shares nodes, an expression does not: `a + a.move(..)`
/// repeated twenty times has a million leaves. Above this bound inner operations are made first.
const LARGEST_EXPRESSION: u32 = 1 << 14;

/// Set operations inside one another in one expression; bounds the recursion over it.
const DEEPEST_EXPRESSION: u32 = 500;

/// What is kept for each node.
#[derive(Clone, Copy, Debug)]
struct Facts {
    /// The node under all wrappers.
    core: ShapeId,
    /// Leaves of its expression.
    leaves: u32,
    /// Nested set operations of its expression; 0 for a leaf.
    depth: u32,
    /// Whether inner set operations are taken into its expression.
    inline: bool,
}

/// Facts about the nodes of one graph, filled from the first node on as the graph grows.
#[derive(Debug, Default)]
pub struct Structure {
    facts: Vec<Facts>,
}

/// The operands of a set operation on solids; `None` for other nodes.
pub fn operands(node: &Node) -> Option<&[ShapeId]> {
    match node {
        Node::Union(list) | Node::Difference(list) | Node::Intersection(list) => Some(list),
        _ => None,
    }
}

/// What stands under a wrapper, if the node is one.
pub fn wrapped(node: &Node) -> Option<ShapeId> {
    match node {
        Node::Transform { child, .. } | Node::Tag { child, .. } | Node::Paint { child, .. } => {
            Some(*child)
        }
        _ => None,
    }
}

impl Structure {
    /// Takes in the nodes that the graph got since the last call. Children come before parents.
    pub fn extend(&mut self, graph: &ShapeGraph) {
        for index in self.facts.len()..graph.len() {
            let facts = self.facts_of(graph, ShapeId(index as u32));
            self.facts.push(facts);
        }
    }

    fn facts_of(&self, graph: &ShapeGraph, id: ShapeId) -> Facts {
        let node = graph.node(id);
        if let (Some(child), Kind::Solid) = (wrapped(node), graph.kind(id)) {
            return self.of(child);
        }
        let Some(list) = operands(node) else {
            return Facts { core: id, leaves: 1, depth: 0, inline: false };
        };
        let leaves = list.iter().fold(0u32, |sum, &c| sum.saturating_add(self.of(c).leaves));
        let depth = 1 + list.iter().map(|&c| self.of(c).depth).max().unwrap_or(0);
        if leaves <= LARGEST_EXPRESSION && depth <= DEEPEST_EXPRESSION {
            return Facts { core: id, leaves, depth, inline: true };
        }
        Facts { core: id, leaves: list.len() as u32, depth: 1, inline: false }
    }

    fn of(&self, id: ShapeId) -> Facts {
        self.facts[id.0 as usize]
    }

    /// The node under all placements, tags and colours of a solid; a profile is its own core.
    pub fn core(&self, id: ShapeId) -> ShapeId {
        self.of(id).core
    }

    /// Whether the set operation `parent` takes the operation `child` (a core) into its expression.
    pub fn takes_in(&self, parent: ShapeId, child: ShapeId) -> bool {
        self.of(parent).inline && self.of(child).depth > 0
    }

    /// The units that must be made before a unit.
    pub fn needs(&self, graph: &ShapeGraph, unit: ShapeId) -> Vec<ShapeId> {
        match graph.node(unit) {
            node if graph.kind(unit) == Kind::Profile => figure_parts(node),
            Node::Extrude { profile, .. } | Node::Revolve { profile, .. } => vec![*profile],
            Node::Hull(list) => list.iter().map(|&child| self.core(child)).collect(),
            _ => self.expression_leaves(graph, unit),
        }
    }

    fn expression_leaves(&self, graph: &ShapeGraph, unit: ShapeId) -> Vec<ShapeId> {
        let mut found = vec![];
        let mut seen = FxHashSet::default();
        let mut open = vec![unit];
        while let Some(operation) = open.pop() {
            for &child in operands(graph.node(operation)).unwrap_or_default() {
                let core = self.core(child);
                if !seen.insert(core) {
                    continue;
                }
                let list = if self.takes_in(operation, core) { &mut open } else { &mut found };
                list.push(core);
            }
        }
        found
    }

    /// The units behind `roots` that are not `made` yet, in waves: each wave needs only those before
    /// it, so that the units of one wave may be made at the same time.
    pub fn plan(
        &self,
        graph: &ShapeGraph,
        roots: &[ShapeId],
        made: impl Fn(ShapeId) -> bool,
    ) -> Vec<Vec<ShapeId>> {
        let mut needs = std::collections::BTreeMap::new();
        let mut open: Vec<ShapeId> = roots.iter().map(|&root| self.core(root)).collect();
        while let Some(unit) = open.pop() {
            if !made(unit) && !needs.contains_key(&unit) {
                let list = self.needs(graph, unit);
                open.extend(&list);
                needs.insert(unit, list);
            }
        }
        let mut levels = rustc_hash::FxHashMap::default();
        let mut waves: Vec<Vec<ShapeId>> = vec![];
        for (&unit, list) in &needs {
            let level =
                list.iter().filter_map(|n| levels.get(n)).max().map_or(0, |l: &usize| l + 1);
            levels.insert(unit, level);
            waves.resize_with(waves.len().max(level + 1), Vec::new);
            waves[level].push(unit);
        }
        waves
    }
}

/// The profiles a profile is made from.
fn figure_parts(node: &Node) -> Vec<ShapeId> {
    match node {
        Node::Union(list)
        | Node::Difference(list)
        | Node::Intersection(list)
        | Node::Hull(list) => list.to_vec(),
        Node::OffsetProfile { profile, .. } | Node::RoundProfile { profile, .. } => vec![*profile],
        node => wrapped(node).into_iter().collect(),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;

    use super::*;
    use crate::{base::Span, geom::Placement};

    fn add(graph: &mut ShapeGraph, node: Node) -> ShapeId {
        graph.add(node, Span::default())
    }

    fn doubled(graph: &mut ShapeGraph, child: ShapeId, step: f64) -> ShapeId {
        let placement = Placement::translation(DVec3::X * step);
        let moved = add(graph, Node::Transform { placement, child });
        add(graph, Node::Union(Arc::from([child, moved])))
    }

    #[test]
    fn a_small_expression_is_one_unit() {
        let mut graph = ShapeGraph::default();
        let ball = add(&mut graph, Node::Sphere { r: 1.0, sides: None });
        let two = doubled(&mut graph, ball, 1.0);
        let four = doubled(&mut graph, two, 2.0);
        let mut structure = Structure::default();
        structure.extend(&graph);
        assert_eq!(structure.plan(&graph, &[four], |_| false), [vec![ball], vec![four]]);
        assert_eq!(structure.plan(&graph, &[four], |id| id == ball), [vec![four]]);
    }

    #[test]
    fn shared_growth_stays_bounded() {
        let mut graph = ShapeGraph::default();
        let mut shape = add(&mut graph, Node::Sphere { r: 1.0, sides: None });
        for i in 0..60 {
            shape = doubled(&mut graph, shape, 3.0 * f64::from(i));
        }
        let mut structure = Structure::default();
        structure.extend(&graph);
        let waves = structure.plan(&graph, &[shape], |_| false);
        assert!(waves.len() > 2 && waves.iter().flatten().count() < 10);
    }
}
