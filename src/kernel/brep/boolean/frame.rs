//! Hoisting: in which frame an operation is evaluated, and which leaves take part.
//!
//! A set operation commutes with every placement. So placements are moved out of it as far as that
//! helps exactness: the operation is evaluated in the frame whose linear part most of its leaves
//! share, where their faces are what the modeller wrote, and the result is placed afterwards.
//! Nested operations that stand to that frame by a translation, a quarter turn or an axis mirror
//! join the same arrangement; one that stands otherwise is evaluated first, in its own frame. So are
//! parts that stand alike, but otherwise than the frame, and touch: where they are flush their faces
//! meet exactly there, and here snapping would bend them apart.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use rustc_hash::FxHashMap;

use super::{BooleanError, Evaluated, Tree, clusters, evaluate_operation, expression::Expression};
use crate::{geom::Placement, kernel::brep::Polyhedron};

/// How far a relative linear part, a product of a matrix and an inverse, may be from a signed axis
/// permutation and still mean one: rotations by odd angles differ from it by far more, rounding by
/// far less.
const PERMUTATION: f64 = 1e-13;

/// A solid that takes part in an operation.
pub(super) struct Leaf {
    /// The solid in its own frame.
    pub solid: Arc<Polyhedron>,
    /// From its own frame to the frame of the operation.
    pub local: Placement,
    /// From its own frame to where the result stands.
    pub full: Placement,
}

/// An operation made flat: one arrangement of many leaves.
pub(super) struct Plan {
    /// The leaves, in the order of the source.
    pub leaves: Vec<Leaf>,
    /// What the operation says about them.
    pub expression: Expression,
    /// From the frame of the operation to where the result stands.
    pub frame: Placement,
    /// Largest movement of a corner in operations evaluated on the way, mm where the result stands.
    pub snap: f64,
    /// For a result that is [mended](super::mend), by how many grades the lattice is coarser than it could be;
    /// every face of what comes out is tested.
    pub mending: Option<u32>,
}

impl Plan {
    /// The result and how far corners were moved, given in the frame of the operation.
    pub fn evaluated(
        &self,
        solid: Polyhedron,
        crossing: Option<DVec3>,
        (snap, step): (f64, f64),
    ) -> Evaluated {
        let stretch = stretch(&self.frame);
        Evaluated { solid, snap: self.snap.max(snap * stretch), step: step * stretch, crossing }
    }
}

/// How much longer a placement makes the axes.
fn stretch(placement: &Placement) -> f64 {
    let linear = placement.linear();
    [linear.x_axis, linear.y_axis, linear.z_axis].map(DVec3::length).into_iter().fold(0.0, f64::max)
}

/// From the frame of an operation to the one it is evaluated in.
pub(super) fn inverse(tree: &Tree) -> Placement {
    let common = Placement::new(common_linear(tree), DVec3::ZERO);
    common.inverse().unwrap_or(Placement::IDENTITY)
}

/// Flattens an operation node that stands at `outer`.
pub(super) fn plan(tree: &Tree, outer: &Placement) -> Result<Plan, BooleanError> {
    let linear = common_linear(tree);
    let (linear, inverse) = match Placement::new(linear, DVec3::ZERO).inverse() {
        Some(inverse) => (linear, inverse),
        None => (DMat3::IDENTITY, Placement::IDENTITY),
    };
    let here = Placement::new(linear, DVec3::ZERO);
    let mut walk = Walk { inverse, outer: *outer, leaves: vec![], snap: 0.0 };
    let expression = walk.operation(tree, &Placement::IDENTITY)?;
    let Walk { leaves, snap, .. } = walk;
    Ok(Plan { leaves, expression, frame: outer.after(&here), snap, mending: None })
}

/// The linear part that most leaves share, the first of them when several do.
fn common_linear(tree: &Tree) -> DMat3 {
    let mut found: Vec<(DMat3, usize)> = vec![];
    tally(tree, &Placement::IDENTITY, &mut found);
    let most = found.iter().map(|f| f.1).max().unwrap_or(0);
    found.iter().find(|f| f.1 == most).map_or(DMat3::IDENTITY, |f| f.0)
}

fn tally(tree: &Tree, placement: &Placement, found: &mut Vec<(DMat3, usize)>) {
    deeper(|| match tree {
        Tree::Leaf(_) => match found.iter_mut().find(|f| f.0 == placement.linear()) {
            Some(entry) => entry.1 += 1,
            None => found.push((placement.linear(), 1)),
        },
        Tree::Placed(inner, child) => tally(child, &placement.after(inner), found),
        Tree::Union(parts) | Tree::Difference(parts) | Tree::Intersection(parts) => {
            parts.iter().for_each(|part| tally(part, placement, found));
        }
    });
}

/// Calls a step of a recursion with enough stack for it, however deep the tree.
pub(super) fn deeper<T>(step: impl FnOnce() -> T) -> T {
    const RESERVE: usize = 128 << 10;
    const SEGMENT: usize = 4 << 20;
    stacker::maybe_grow(RESERVE, SEGMENT, step)
}

/// The walk that collects leaves.
struct Walk {
    /// From the frame of the operation node to the frame of evaluation.
    inverse: Placement,
    outer: Placement,
    leaves: Vec<Leaf>,
    snap: f64,
}

impl Walk {
    fn operation(&mut self, tree: &Tree, at: &Placement) -> Result<Expression, BooleanError> {
        Ok(match tree {
            Tree::Leaf(solid) => self.leaf(solid.clone(), at),
            Tree::Placed(inner, child) => self.part(child, &at.after(inner))?,
            Tree::Union(parts) => Expression::Union(self.any(parts, at)?),
            Tree::Intersection(parts) => Expression::Intersection(self.parts(parts, at)?),
            Tree::Difference(parts) => {
                let (first, rest) = parts.split_at(parts.len().min(1));
                let mut all = self.parts(first, at)?;
                all.extend(self.any(rest, at)?);
                Expression::Difference(all)
            }
        })
    }

    /// Parts that are united or subtracted: those that stand alike and touch are united first.
    fn any(&mut self, parts: &[Tree], at: &Placement) -> Result<Vec<Expression>, BooleanError> {
        let mut found = Vec::with_capacity(parts.len());
        for alike in self.alike(parts, at) {
            if let [part] = alike[..] {
                found.push(self.part(part, at)?);
                continue;
            }
            let together = Tree::Union(alike.into_iter().cloned().collect());
            let touching = clusters::apart(&together, &inverse(&together));
            for group in touching.unwrap_or_else(|| vec![together]) {
                found.push(match group {
                    Tree::Leaf(_) | Tree::Placed(..) => self.part(&group, at)?,
                    operation => self.evaluated(&operation, at)?,
                });
            }
        }
        Ok(found)
    }

    /// The parts, those together that stand alike but otherwise than the frame of evaluation, unless all do.
    fn alike<'t>(&self, parts: &'t [Tree], at: &Placement) -> Vec<Vec<&'t Tree>> {
        let mut groups: Vec<Vec<&Tree>> = vec![];
        let mut known: FxHashMap<[u64; 9], usize> = FxHashMap::default();
        for part in parts {
            let (mut stands, mut inner) = (*at, part);
            while let Tree::Placed(placement, child) = inner {
                (stands, inner) = (stands.after(placement), child);
            }
            let linear = self.local(&stands).linear();
            let number = groups.len();
            let number = match is_permutation(&linear) {
                true => number,
                false => *known.entry(linear.to_cols_array().map(f64::to_bits)).or_insert(number),
            };
            match groups.get_mut(number) {
                Some(group) => group.push(part),
                None => groups.push(vec![part]),
            }
        }
        if groups.len() == 1 { parts.iter().map(|part| vec![part]).collect() } else { groups }
    }

    fn parts(&mut self, parts: &[Tree], at: &Placement) -> Result<Vec<Expression>, BooleanError> {
        parts.iter().map(|part| self.part(part, at)).collect()
    }

    /// A part that stands at `at`: joined in if that keeps the lattice, else evaluated on its own.
    fn part(&mut self, tree: &Tree, at: &Placement) -> Result<Expression, BooleanError> {
        let whole = matches!(tree, Tree::Leaf(_) | Tree::Placed(..));
        if whole || keeps_lattice(&self.local(at)) {
            return deeper(|| self.operation(tree, at));
        }
        self.evaluated(tree, at)
    }

    /// A part that stands at `at`, evaluated on its own.
    fn evaluated(&mut self, tree: &Tree, at: &Placement) -> Result<Expression, BooleanError> {
        let evaluated = deeper(|| evaluate_operation(tree, &Placement::IDENTITY))?;
        self.snap = self.snap.max(evaluated.snap * stretch(&self.outer.after(at)));
        Ok(self.leaf(Arc::new(evaluated.solid), at))
    }

    fn leaf(&mut self, solid: Arc<Polyhedron>, at: &Placement) -> Expression {
        let (local, full) = (self.local(at), self.outer.after(at));
        self.leaves.push(Leaf { solid, local, full });
        Expression::Leaf(self.leaves.len() as u32 - 1)
    }

    fn local(&self, at: &Placement) -> Placement {
        if self.inverse.is_identity() {
            return *at;
        }
        cleaned(&self.inverse.after(at))
    }
}

/// The placement with a linear part that is nearly a signed axis permutation made exactly one.
fn cleaned(placement: &Placement) -> Placement {
    let linear = placement.linear().to_cols_array();
    let near = linear.map(f64::round);
    let close = linear.iter().zip(near).all(|(a, b)| (a - b).abs() <= PERMUTATION);
    let rounded = DMat3::from_cols_array(&near);
    if close && is_permutation(&rounded) {
        Placement::new(rounded, placement.offset())
    } else {
        *placement
    }
}

fn keeps_lattice(placement: &Placement) -> bool {
    is_permutation(&placement.linear())
}

fn is_permutation(linear: &DMat3) -> bool {
    let ones = |v: DVec3| v.to_array().iter().filter(|c| c.abs() == 1.0).count();
    let zeros = |v: DVec3| v.to_array().iter().filter(|&&c| c == 0.0).count();
    let single = |v: DVec3| ones(v) == 1 && zeros(v) == 2;
    let rows = linear.transpose();
    [linear.x_axis, linear.y_axis, linear.z_axis, rows.x_axis, rows.y_axis, rows.z_axis]
        .into_iter()
        .all(single)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_and_mirrors_keep_the_lattice() {
        let turn = DMat3::from_cols(DVec3::Y, -DVec3::X, DVec3::Z);
        assert!(is_permutation(&turn));
        assert!(is_permutation(&DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0))));
        assert!(!is_permutation(&DMat3::from_diagonal(DVec3::new(1.0, 2.0, 1.0))));
        assert!(!is_permutation(&DMat3::from_cols(DVec3::X, DVec3::X, DVec3::Z)));
    }

    #[test]
    fn a_deep_tree_is_no_danger() {
        let mut tree = Tree::Leaf(Arc::new(Polyhedron::empty()));
        for _ in 0..10_000 {
            let leaf = Tree::Leaf(Arc::new(Polyhedron::empty()));
            tree = Tree::Difference(vec![tree, leaf]);
        }
        let plan = plan(&tree, &Placement::IDENTITY).expect("a plan");
        assert_eq!(plan.leaves.len(), 10_001);
        super::super::expression::State::new(&plan.expression, plan.leaves.len());
    }

    #[test]
    fn nested_operations_under_translations_are_flattened() {
        let leaf = || Tree::Leaf(Arc::new(Polyhedron::empty()));
        let inner = Tree::Union(vec![leaf(), leaf()]);
        let moved = Tree::Placed(Placement::translation(DVec3::X), Box::new(inner));
        let tree = Tree::Difference(vec![leaf(), moved]);
        let plan = plan(&tree, &Placement::IDENTITY).expect("a plan");
        assert_eq!(plan.leaves.len(), 3);
        assert_eq!(plan.leaves[2].local.offset(), DVec3::X);
    }
}
