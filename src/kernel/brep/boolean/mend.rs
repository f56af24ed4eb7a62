//! Results with features finer than the lattice, which rounding has made flat or made cross each other.
//!
//! Such a result is a solid like any other: it is put on the lattice with all its corners, so that those nearer
//! to each other than a step become one, and what it then winds around is arranged anew. Corners that stay keep
//! their places.

use std::sync::Arc;

use super::{
    Evaluated, arranged,
    expression::Expression,
    frame::{Leaf, Plan},
};
use crate::{
    geom::Placement,
    kernel::brep::{
        Polyhedron,
        measure::{area, volume},
    },
};

/// By how many grades the lattice is made coarser, one round after the other: features of a few steps become one
/// step, or none. The last is 40 times as coarse as the first, a ten-millionth of the size.
pub(super) const GRADES: [u32; 5] = [0, 0, 1, 3, 5];

/// How far the boundary may move by that, in steps: corners move by less than one, corners that are cut anew
/// where faces meet at small angles by a few.
const SLACK: f64 = 4.0;

/// The result without what made it cross itself; as it is, and saying so, where that does not help.
pub(super) fn mended(plan: &Plan, found: Evaluated) -> Evaluated {
    let Some(local) = plan.frame.inverse() else { return found };
    let (volume_before, area) = (volume(&found.solid), area(&found.solid));
    let mut solid = found.solid.clone();
    for grades in GRADES {
        let Some(next) = again(plan, solid, local, grades) else { break };
        let off = volume(&next.solid) - volume_before;
        if off.abs() > SLACK * area * found.step.max(next.step) {
            break;
        }
        if next.crossing.is_none() {
            let (snap, step) = (found.snap.max(next.snap), found.step.max(next.step));
            return Evaluated { snap, step, ..next };
        }
        solid = next.solid;
    }
    found
}

/// What a result winds around, in the frame in which it came about, on a lattice so much coarser.
fn again(plan: &Plan, solid: Polyhedron, local: Placement, grades: u32) -> Option<Evaluated> {
    let leaf = Leaf { solid: Arc::new(solid), local, full: Placement::IDENTITY };
    let expression = Expression::Union(vec![Expression::Leaf(0)]);
    let leaves = vec![leaf];
    let (frame, snap) = (plan.frame, plan.snap);
    let plan = Plan { leaves, expression, frame, snap, mending: Some(grades) };
    arranged(&plan, false, false).ok().flatten()
}
