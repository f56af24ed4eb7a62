//! What the graph alone says about the work: which nodes are made into solids of their own, and in
//! which order.
//!
//! A *core* is a node under its placements, tags and colours. The unit of work is a core under a stretch:
//! what placements, and the growing of an extrusion, do to its lengths on the way to the output. A core
//! without curves is one unit under all stretches, and so is any core under all rigid motions. Operands of
//! a set operation that are set operations themselves are taken into one expression, so that a whole
//! subtree is evaluated at once. An inner operation is made first, once, where an operation takes many
//! copies of it, and where the expression would grow too large or too deep. What is made first depends
//! on the operation alone, not on who else asks for its parts.

use std::collections::BTreeMap;

use glam::DMat3;
use rustc_hash::{FxHashMap, FxHashSet};

use super::{Unwrapped, paint::Paint, unwrap};
use crate::{
    geom::Stretch,
    shape::{Kind, Node, ShapeGraph, ShapeId, Stretched},
};

/// Leaves of one set expression. A graph shares nodes, an expression does not: `a + a.move(..)`
/// repeated twenty times has a million leaves. Above this bound inner operations are made first.
const LARGEST_EXPRESSION: u32 = 1 << 12;

/// So many copies of one inner operation are worth making it first. Two are not: a half and its mirror
/// image are better cut in one go.
const MANY_COPIES: usize = 3;

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
    /// Operations and those of their operands that they take many copies of.
    copied: FxHashSet<(ShapeId, ShapeId)>,
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
        Node::Transform { child, .. }
        | Node::Tag { child, .. }
        | Node::Paint { child, .. }
        | Node::Figured { child, .. } => Some(*child),
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

    fn facts_of(&mut self, graph: &ShapeGraph, id: ShapeId) -> Facts {
        let node = graph.node(id);
        if let (Some(child), Kind::Solid) = (wrapped(node), graph.kind(id)) {
            return self.of(child);
        }
        let Some(list) = operands(node) else {
            return Facts { core: id, leaves: 1, depth: 0, inline: false };
        };
        self.note_copies(id, list);
        let taken = |&c: &ShapeId| match self.copied.contains(&(id, self.core(c))) {
            true => (1, 0),
            false => (self.of(c).leaves, self.of(c).depth),
        };
        let leaves = list.iter().map(taken).fold(0u32, |sum, (n, _)| sum.saturating_add(n));
        let depth = 1 + list.iter().map(taken).map(|(_, depth)| depth).max().unwrap_or(0);
        if leaves <= LARGEST_EXPRESSION && depth <= DEEPEST_EXPRESSION {
            return Facts { core: id, leaves, depth, inline: true };
        }
        Facts { core: id, leaves: list.len() as u32, depth: 1, inline: false }
    }

    /// Finds the operations that an operation takes many copies of.
    fn note_copies(&mut self, id: ShapeId, list: &[ShapeId]) {
        let operations = list.iter().map(|&c| self.of(c)).filter(|facts| facts.depth > 0);
        let mut cores: Vec<ShapeId> = operations.map(|facts| facts.core).collect();
        cores.sort_unstable();
        let groups = cores.chunk_by(|a, b| a == b).filter(|group| group.len() >= MANY_COPIES);
        self.copied.extend(groups.map(|group| (id, group[0])));
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
        let facts = self.of(child);
        facts.depth > 0 && self.of(parent).inline && !self.copied.contains(&(parent, child))
    }

    /// The units that must be made before a unit.
    fn needs(&self, graph: &ShapeGraph, unit: Stretched) -> Vec<Stretched> {
        match graph.node(unit.id) {
            Node::Extrude { .. }
            | Node::Revolve { .. }
            | Node::SweptAlong(_)
            | Node::SweptBetween(_)
            | Node::Loft { .. } => figure_parts(graph, unit),
            _ if graph.kind(unit.id) == Kind::Profile => figure_parts(graph, unit),
            Node::Offset { child, .. } | Node::Fillet { child, .. } => {
                unit_of(graph, *child, unit.stretch).into_iter().collect()
            }
            Node::Hull(list) => {
                list.iter().filter_map(|&child| unit_of(graph, child, unit.stretch)).collect()
            }
            _ => self.expression_leaves(graph, unit),
        }
    }

    fn expression_leaves(&self, graph: &ShapeGraph, unit: Stretched) -> Vec<Stretched> {
        let mut found = vec![];
        let mut seen = FxHashSet::default();
        let mut open = vec![(unit.id, DMat3::IDENTITY)];
        while let Some((operation, outer)) = open.pop() {
            for &child in operands(graph.node(operation)).unwrap_or_default() {
                let Ok(inner) = unwrap(graph, child, Paint::default()) else { continue };
                let Unwrapped { core, placement, .. } = inner;
                let linear = match graph.is_curved(core) {
                    true => outer * placement.linear(),
                    false => DMat3::IDENTITY,
                };
                if !seen.insert((core, linear.to_cols_array().map(f64::to_bits))) {
                    continue;
                }
                match self.takes_in(operation, core) {
                    true => open.push((core, linear)),
                    false => found.push(leaf(graph, unit, core, linear)),
                }
            }
        }
        found
    }

    /// The units behind `roots` that are not `made` yet, in waves: each wave needs only those before
    /// it, so that the units of one wave may be made at the same time.
    pub fn plan(
        &self,
        graph: &ShapeGraph,
        roots: impl IntoIterator<Item = Stretched>,
        made: impl Fn(Stretched) -> bool,
    ) -> Vec<Vec<Stretched>> {
        let mut needs = BTreeMap::new();
        let mut open: Vec<Stretched> = roots.into_iter().collect();
        while let Some(unit) = open.pop() {
            if !made(unit) && !needs.contains_key(&unit) {
                let list = self.needs(graph, unit);
                open.extend(&list);
                needs.insert(unit, list);
            }
        }
        let mut levels = FxHashMap::default();
        let mut waves: Vec<Vec<Stretched>> = vec![];
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

/// The unit that a solid is made of under a stretch; `None` where a placement flattens it. A profile is its
/// own unit.
pub fn unit_of(graph: &ShapeGraph, id: ShapeId, outer: Stretch) -> Option<Stretched> {
    if graph.kind(id) == Kind::Profile {
        return Some(graph.stretched(id, outer));
    }
    let found = unwrap(graph, id, Paint::default()).ok()?;
    Some(placed(graph, &found, outer))
}

/// The unit of a solid that was taken out of its wrappers, under a stretch.
pub fn placed(graph: &ShapeGraph, found: &Unwrapped, outer: Stretch) -> Stretched {
    graph.stretched(found.core, outer.times(Stretch::of(found.placement.linear())))
}

/// The unit of a leaf of a set expression, with the linear part of its way to the expression's frame.
pub fn leaf(graph: &ShapeGraph, expression: Stretched, core: ShapeId, linear: DMat3) -> Stretched {
    graph.stretched(core, expression.stretch.times(Stretch::of(linear)))
}

/// The profiles that a profile, an extrusion or a revolution is made from.
pub fn figure_parts(graph: &ShapeGraph, whole: Stretched) -> Vec<Stretched> {
    graph.node(whole.id).children().iter().map(|&child| graph.part(whole, child)).collect()
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

    fn as_is(id: ShapeId) -> Stretched {
        Stretched { id, stretch: Stretch::ONE }
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
        assert_eq!(
            structure.plan(&graph, [as_is(four)], |_| false),
            [vec![as_is(ball)], vec![as_is(four)]]
        );
        assert_eq!(
            structure.plan(&graph, [as_is(four)], |unit| unit.id == ball),
            [vec![as_is(four)]]
        );
    }

    #[test]
    fn many_copies_are_made_once() {
        let mut graph = ShapeGraph::default();
        let ball = add(&mut graph, Node::Sphere { r: 1.0, sides: None });
        let pair = doubled(&mut graph, ball, 1.0);
        let copy = |graph: &mut ShapeGraph, i: u32| {
            let placement = Placement::translation(DVec3::Y * f64::from(i));
            add(graph, Node::Transform { placement, child: pair })
        };
        let copies: Vec<ShapeId> = (0..3).map(|i| copy(&mut graph, i)).collect();
        let all = add(&mut graph, Node::Union(Arc::from(copies)));
        let mut structure = Structure::default();
        structure.extend(&graph);
        let waves = structure.plan(&graph, [as_is(all)], |_| false);
        assert_eq!(waves, [ball, pair, all].map(|id| vec![as_is(id)]));
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
        let waves = structure.plan(&graph, [as_is(shape)], |_| false);
        assert!(waves.len() > 2 && waves.iter().flatten().count() < 10);
    }

    fn scaled(graph: &mut ShapeGraph, child: ShapeId, sizes: DVec3) -> ShapeId {
        let placement = Placement::new(DMat3::from_diagonal(sizes), DVec3::ZERO);
        add(graph, Node::Transform { placement, child })
    }

    /// The stretches that a leaf is made for.
    fn stretches(graph: &ShapeGraph, root: ShapeId, leaf: ShapeId) -> Vec<f64> {
        let mut structure = Structure::default();
        structure.extend(graph);
        let waves = structure.plan(graph, unit_of(graph, root, Stretch::ONE), |_| false);
        let units = waves.into_iter().flatten().filter(|unit| unit.id == leaf);
        units.map(|unit| unit.stretch.factor()).collect()
    }

    #[test]
    fn a_leaf_is_made_once_for_each_stretch() {
        let mut graph = ShapeGraph::default();
        let sizes = [DVec3::ONE, -DVec3::ONE, DVec3::splat(4.0), DVec3::new(0.5, 4.0, 1.0)];
        for (sides, expected) in [(None, vec![2.0, 8.0]), (Some(9), vec![1.0])] {
            let ball = add(&mut graph, Node::Sphere { r: 1.0, sides });
            let copies = sizes.map(|sizes| scaled(&mut graph, ball, sizes));
            let all = add(&mut graph, Node::Union(Arc::new(copies)));
            let whole = scaled(&mut graph, all, DVec3::splat(2.0));
            assert_eq!(stretches(&graph, whole, ball), expected);
        }
    }

    #[test]
    fn what_lies_level_is_not_stretched_upwards() {
        let mut graph = ShapeGraph::default();
        let circle = add(&mut graph, Node::Ellipse { radii: glam::DVec2::ONE, sides: None });
        let profile = scaled(&mut graph, circle, DVec3::new(0.5, 0.25, 1.0));
        let scale = glam::DVec2::new(3.0, 1.0);
        let solid = add(&mut graph, Node::Extrude { profile, height: 1.0, twist: 0.0, scale });
        assert_eq!(stretches(&graph, solid, circle), [1.5]);
    }

    /// Two copies of different size in every step, and no two steps alike.
    #[test]
    fn growth_through_scales_stays_bounded() {
        let mut graph = ShapeGraph::default();
        let ball = add(&mut graph, Node::Sphere { r: 1.0, sides: None });
        let disc = add(&mut graph, Node::Ellipse { radii: glam::DVec2::ONE, sides: None });
        type Make = fn(Arc<[ShapeId]>) -> Node;
        let makers: [(ShapeId, Make); 3] =
            [(ball, Node::Union), (ball, Node::Hull), (disc, Node::Union)];
        for (mut shape, make) in makers {
            for i in 0..30 {
                let sizes = [0.9 + 0.001 * f64::from(i), 1.0 + 0.0017 * f64::from(i)];
                let copies = sizes.map(|size| scaled(&mut graph, shape, DVec3::splat(size)));
                shape = add(&mut graph, make(Arc::new(copies)));
            }
            let mut structure = Structure::default();
            structure.extend(&graph);
            let waves = structure.plan(&graph, [as_is(shape)], |_| false);
            let units = waves.iter().flatten().count();
            assert!(units < 100_000, "{units}");
        }
    }
}
