//! Clusters: parts of an operation that are evaluated apart because nothing in them touches.
//!
//! A point outside all leaves is never in the result. So where the leaves of an operation stand in
//! groups whose boxes do not meet, its result is that of each group alone, with no other leaf there,
//! side by side: each on a lattice of its own, as fine as the group allows, and an operand far away
//! coarsens nothing. Leaves that lie where they do not matter (what is subtracted beside the first
//! part, what is intersected with nothing near) are left out before.
//!
//! Groups are found by straight cuts: a group is divided where there is a gap along an axis, and its
//! parts again, until none has a gap. What is left may hang together less than it seems, which costs
//! time and lattice but nothing else.

use glam::DVec3;

use super::{Tree, frame::deeper};
use crate::geom::{Bounds, Placement};

/// Boxes nearer than this share of the size of all are taken to touch: several steps of a lattice
/// over all of them ([`Lattice`](super::lattice::Lattice)), so that snapping closes no gap between
/// groups.
const NEAR: f64 = 1.0 / (1u64 << 26) as f64;

/// The same for the distance from the origin, where doubles themselves are coarse.
const FAR: f64 = 1.0 / (1u64 << 48) as f64;

/// A leaf thinner than this share of its distance from the origin is not taken as it is.
const THIN: f64 = 1.0 / (1u64 << 40) as f64;

/// A group that is still not done after so many rounds of cuts stays as it is.
const ROUNDS: usize = 40;

/// The groups of an operation as operations, in the order of their first leaves. `None` if it is one
/// group that needs all its leaves. `inverse` leads from the operation's frame to the one that boxes
/// are made in.
pub(super) fn apart(tree: &Tree, inverse: &Placement) -> Option<Vec<Tree>> {
    let mut sketch = Sketch { nodes: vec![], margin: 0.0 };
    sketch.add(tree, inverse);
    let all = sketch.nodes.iter().fold(Bounds::EMPTY, |all, node| all.joined(&node.bounds));
    if all.is_empty() || !(all.max - all.min).is_finite() {
        return None;
    }
    sketch.widen(&all);
    sketch.bound(tree, 0);
    let mut needed = vec![];
    sketch.needed(tree, 0, &Bounds { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY }, &mut needed);
    let groups = sketch.groups(needed);
    let taken: usize = groups.iter().map(Vec::len).sum();
    if groups.len() == 1 && taken == sketch.nodes.iter().filter(|n| n.is_leaf).count() {
        return None;
    }
    let alone = |group: &Vec<usize>| sketch.whole(sketch.restricted(tree, 0, group)?, group);
    Some(groups.iter().filter_map(alone).collect())
}

/// The nodes of a tree in the order of the source, each before its parts.
struct Sketch {
    nodes: Vec<Node>,
    /// How far boxes are widened, mm.
    margin: f64,
}

struct Node {
    /// The box of what the node can hold.
    bounds: Bounds,
    /// Where the node after it and its parts is.
    end: usize,
    is_leaf: bool,
}

/// The parts of a tree that is not a leaf.
fn parts(tree: &Tree) -> &[Tree] {
    match tree {
        Tree::Leaf(_) => &[],
        Tree::Placed(_, child) => std::slice::from_ref(child),
        Tree::Union(parts) | Tree::Difference(parts) | Tree::Intersection(parts) => parts,
    }
}

impl Sketch {
    /// Adds a tree that stands at `at`; only leaves have their boxes yet. A leaf that is not finite has
    /// a box without end.
    fn add(&mut self, tree: &Tree, at: &Placement) {
        let number = self.nodes.len();
        let is_leaf = matches!(tree, Tree::Leaf(_));
        self.nodes.push(Node { bounds: Bounds::EMPTY, end: 0, is_leaf });
        match tree {
            Tree::Leaf(solid) => {
                let points = solid.mesh().points.iter().map(|&p| at.point(p));
                let finite = |p: DVec3| if p.is_finite() { p } else { DVec3::INFINITY };
                self.nodes[number].bounds = Bounds::of(points.map(finite));
            }
            Tree::Placed(inner, child) => deeper(|| self.add(child, &at.after(inner))),
            _ => parts(tree).iter().for_each(|part| deeper(|| self.add(part, at))),
        }
        self.nodes[number].end = self.nodes.len();
    }

    fn widen(&mut self, all: &Bounds) {
        let reach = all.min.abs().max(all.max.abs()).max_element();
        self.margin = (all.max - all.min).max_element() * NEAR + reach * FAR;
        let leaves = self.nodes.iter_mut().filter(|n| n.is_leaf && !n.bounds.is_empty());
        leaves.for_each(|node| node.bounds = node.bounds.grown(self.margin));
    }

    /// The numbers of a node's parts.
    fn parts<'a>(&'a self, tree: &Tree, node: usize) -> impl Iterator<Item = usize> + use<'a> {
        let mut next = node + 1;
        (0..parts(tree).len()).map(move |_| {
            let after = self.nodes[next].end;
            std::mem::replace(&mut next, after)
        })
    }

    /// Finds the boxes of operations.
    fn bound(&mut self, tree: &Tree, node: usize) {
        let numbers: Vec<usize> = self.parts(tree, node).collect();
        for (part, &number) in parts(tree).iter().zip(&numbers) {
            deeper(|| self.bound(part, number));
        }
        let mut boxes = numbers.iter().map(|&n| self.nodes[n].bounds);
        let bounds = match tree {
            Tree::Leaf(_) => return,
            Tree::Placed(..) | Tree::Difference(_) => boxes.next(),
            Tree::Union(_) => Some(boxes.fold(Bounds::EMPTY, |all, b| all.joined(&b))),
            Tree::Intersection(_) => boxes.reduce(common),
        };
        self.nodes[node].bounds = bounds.unwrap_or(Bounds::EMPTY);
    }

    /// Collects the leaves of a node that matter if only what lies `within` a box does; says whether the
    /// node can hold anything there.
    fn needed(&self, tree: &Tree, node: usize, within: &Bounds, found: &mut Vec<usize>) -> bool {
        if !self.nodes[node].bounds.meets(within) {
            return false;
        }
        if self.nodes[node].is_leaf {
            found.push(node);
            return true;
        }
        let within = common(*within, self.nodes[node].bounds);
        let (numbers, before) = (self.parts(tree, node), found.len());
        let mut holds = parts(tree)
            .iter()
            .zip(numbers)
            .map(|(part, number)| deeper(|| self.needed(part, number, &within, found)));
        let holds = match tree {
            Tree::Intersection(_) => holds.all(|h| h),
            Tree::Difference(_) => {
                let first = holds.next().unwrap_or(false);
                first && holds.fold(true, |_, _| true)
            }
            _ => holds.fold(false, |any, h| any | h),
        };
        if !holds {
            found.truncate(before);
        }
        holds
    }

    /// Divides leaves into groups, in order.
    fn groups(&self, leaves: Vec<usize>) -> Vec<Vec<usize>> {
        let (mut open, mut done) = (vec![leaves], vec![]);
        for _ in 0..ROUNDS {
            for group in std::mem::take(&mut open) {
                match (0..3).find_map(|axis| self.divided(&group, axis)) {
                    Some(pieces) => open.extend(pieces),
                    None => done.push(group),
                }
            }
        }
        done.extend(open);
        done.iter_mut().for_each(|group| group.sort_unstable());
        done.retain(|group| !group.is_empty());
        done.sort_unstable();
        done
    }

    /// A group cut at all its gaps along an axis; `None` if it has none.
    fn divided(&self, group: &[usize], axis: usize) -> Option<Vec<Vec<usize>>> {
        let bounds = |leaf: usize| &self.nodes[leaf].bounds;
        let mut order = group.to_vec();
        order.sort_by(|&a, &b| bounds(a).min[axis].total_cmp(&bounds(b).min[axis]));
        let (mut pieces, mut reach) = (vec![], f64::INFINITY);
        for leaf in order {
            if pieces.is_empty() || bounds(leaf).min[axis] > reach {
                pieces.push(vec![]);
                reach = f64::NEG_INFINITY;
            }
            reach = reach.max(bounds(leaf).max[axis]);
            pieces.last_mut()?.push(leaf);
        }
        (pieces.len() > 1).then_some(pieces)
    }

    /// A tree as it is, or as an operation if it is a leaf so thin that doubles may not tell its sides apart:
    /// the lattice drops what is flat.
    fn whole(&self, tree: Tree, group: &[usize]) -> Option<Tree> {
        let [leaf] = group else { return Some(tree) };
        let Bounds { min, max } = self.nodes[*leaf].bounds;
        let reach = min.abs().max(max.abs()).max_element();
        let thin = (max - min).min_element() - 2.0 * self.margin <= THIN * reach;
        Some(if thin { Tree::Union(vec![tree]) } else { tree })
    }

    /// What is left of a tree that has no other leaves than those of a group; `None` if it is nothing.
    fn restricted(&self, tree: &Tree, node: usize, group: &[usize]) -> Option<Tree> {
        // Nothing of the group stands in this part of the tree.
        let next = group.partition_point(|&leaf| leaf < node);
        if group.get(next).is_none_or(|&leaf| leaf >= self.nodes[node].end) {
            return None;
        }
        let numbers = self.parts(tree, node);
        let mut list = parts(tree)
            .iter()
            .zip(numbers)
            .map(|(part, number)| deeper(|| self.restricted(part, number, group)));
        let list: Vec<Tree> = match tree {
            Tree::Leaf(_) => return Some(tree.clone()),
            Tree::Placed(placement, _) => {
                return Some(Tree::Placed(*placement, Box::new(list.next()??)));
            }
            Tree::Difference(_) => [list.next()??].into_iter().chain(list.flatten()).collect(),
            Tree::Intersection(_) => list.collect::<Option<_>>()?,
            Tree::Union(_) => list.flatten().collect(),
        };
        Some(match (tree, list.len()) {
            (_, 1) => list.into_iter().next()?,
            (Tree::Difference(_), _) => Tree::Difference(list),
            (Tree::Intersection(_), _) => Tree::Intersection(list),
            _ => Tree::Union(list),
        })
    }
}

/// What two boxes have in common.
fn common(a: Bounds, b: Bounds) -> Bounds {
    Bounds { min: a.min.max(b.min), max: a.max.min(b.max) }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::kernel::brep::{Polyhedron, primitive::cuboid};

    fn cube(x: f64) -> Tree {
        let min = DVec3::new(x, 0.0, 0.0);
        Tree::Leaf(Arc::new(cuboid(min, min + 1.0)))
    }

    fn written(tree: &Tree) -> String {
        let all = |parts: &[Tree], sign: &str| {
            format!("({})", parts.iter().map(written).collect::<Vec<_>>().join(sign))
        };
        match tree {
            Tree::Leaf(solid) => solid.mesh().points[0].x.to_string(),
            Tree::Placed(placement, child) => {
                format!("{}@{}", written(child), placement.offset().x)
            }
            Tree::Union(parts) => all(parts, "+"),
            Tree::Difference(parts) => all(parts, "-"),
            Tree::Intersection(parts) => all(parts, "&"),
        }
    }

    #[test]
    fn a_leaf_that_is_flat_where_it_stands_is_evaluated() {
        let speck = Placement::new(glam::DMat3::from_diagonal(DVec3::splat(1e-12)), DVec3::X * 1e5);
        let speck = Tree::Placed(speck, Box::new(cube(0.0)));
        let found = groups(&Tree::Union(vec![cube(0.0), speck])).expect("groups");
        assert_eq!(found, ["0", "(0@100000)"]);
    }

    fn groups(tree: &Tree) -> Option<Vec<String>> {
        Some(apart(tree, &Placement::IDENTITY)?.iter().map(written).collect())
    }

    #[test]
    fn what_does_not_touch_comes_apart() {
        let pair = Tree::Union(vec![cube(0.0), cube(1.0)]);
        assert_eq!(groups(&pair), None);
        let far = Tree::Placed(Placement::translation(DVec3::X * 9.0), Box::new(pair.clone()));
        let both = Tree::Union(vec![pair.clone(), far, cube(5.0)]);
        assert_eq!(groups(&both).expect("groups"), ["(0+1)", "(0+1)@9", "5"]);
        let cut = Tree::Difference(vec![both, cube(0.5)]);
        assert_eq!(groups(&cut).expect("groups"), ["((0+1)-0.5)", "(0+1)@9", "5"]);
    }

    #[test]
    fn what_does_not_matter_is_left_out() {
        let less = Tree::Difference(vec![cube(0.0), cube(5.0), cube(0.5)]);
        assert_eq!(groups(&less).expect("groups"), ["(0-0.5)"]);
        let beside = Tree::Union(vec![cube(0.5), cube(1.75), cube(3.0)]);
        let within = Tree::Difference(vec![cube(0.0), beside]);
        assert_eq!(groups(&within).expect("groups"), ["(0-0.5)"]);
        let nothing = Tree::Intersection(vec![cube(0.0), cube(1.5), cube(0.75)]);
        assert_eq!(groups(&nothing).expect("groups"), [""; 0]);
        let empty = Tree::Leaf(Arc::new(Polyhedron::empty()));
        assert_eq!(groups(&Tree::Union(vec![cube(0.0), empty])).expect("groups"), ["0"]);
    }

    #[test]
    fn what_only_rounding_keeps_apart_touches() {
        assert_eq!(groups(&Tree::Union(vec![cube(0.0), cube(1.0 + 1e-12)])), None);
        assert_eq!(groups(&Tree::Union(vec![cube(1e6), cube(1e6 + 1.0 + 1e-9)])), None);
        assert!(groups(&Tree::Union(vec![cube(0.0), cube(1.0 + 1e-6)])).is_some());
    }
}
