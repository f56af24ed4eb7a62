//! Rounded edges: closing, then opening.
//!
//! Tatehara et al. grow by the concave radius, grow the complement by the sum of both, and grow its complement
//! by the convex radius.
//!
//! # Departures
//! The first step leaves convex edges sharp: they are sharp again after the second. It differs from balls
//! only where a concave edge ends in a convex one, or lies within the radius of one: there the ball would
//! roll over the edge and dip into the fillet, here the fillet ends flush with the face.
//!
//! Sets are closed: a core that has shrunk to a face, a line or a point still carries its ball. As a mesh it
//! would be nothing, so where something would be lost the middle step is shorter by a trifle, and the last one
//! too.

use super::{OffsetError, extended, offset, offset_before};
use crate::{
    geom::Tolerance,
    kernel::{
        brep::{Polyhedron, measure},
        field::{Field, Polyhedral},
    },
};

/// How much shorter the middle step is where a core would vanish, relative to the size of the solid: far above
/// the lattice of set operations, far below anything printed.
const LESS: f64 = 1e-6;
/// Corners move this many times farther than faces at most, before they count as lost.
const SHARPEST: f64 = 100.0;

/// A solid with its convex edges rounded by one radius and its concave edges by another, mm; either may be 0.
/// Ribs thinner than twice the convex radius and gaps narrower than twice the concave radius vanish.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::{convert::offset::fillet, geom::Tolerance};
/// use katachi::kernel::brep::{measure::volume, primitive::cuboid};
/// let block = cuboid(DVec3::ZERO, dvec3(10.0, 20.0, 30.0));
/// let round = fillet(&block, 2.0, 0.0, Tolerance::new(0.005).unwrap()).unwrap();
/// assert!((volume(&round) - 5804.696).abs() < 3.0);
/// ```
pub fn fillet(
    solid: &Polyhedron,
    convex: f64,
    concave: f64,
    tolerance: Tolerance,
) -> Result<Polyhedron, OffsetError> {
    let closed = extended(solid, concave, tolerance)?;
    // What chords of the middle step are off shows in the volume of concave fillets, whose radius is what is left
    // of its own after the last step.
    let fine = if concave > 0.0 && convex > 0.0 { tolerance.half().half() } else { tolerance };
    let core = offset_before(&closed, -(convex + concave), convex, fine)?;
    let Some([low, high]) = measure::bounds(&closed).filter(|_| convex > 0.0) else {
        return Ok(core);
    };
    let less = (LESS * (high - low).max_element()).min(convex / 2.0);
    let wider = offset_before(&closed, less - (convex + concave), convex - less, fine)?;
    if holds_all(&core, &wider, less) {
        return offset(&core, convex, tolerance);
    }
    offset(&wider, convex - less, tolerance)
}

/// Whether a core has lost nothing: every corner of the wider one is near it.
fn holds_all(core: &Polyhedron, wider: &Polyhedron, less: f64) -> bool {
    match Polyhedral::new(core.mesh()) {
        None => wider.is_empty(),
        Some(field) => wider.mesh().points.iter().all(|p| field.distance(*p) <= SHARPEST * less),
    }
}
