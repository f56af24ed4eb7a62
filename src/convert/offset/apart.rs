//! Offsets by contouring the distance.

use glam::DVec3;

use super::OffsetError;
use crate::{
    convert::contour::level_set,
    geom::{Origin, PolyMesh, Surface, Tolerance},
    kernel::{
        brep::Polyhedron,
        field::{Apart, Field, Hypersphere, Polyhedral, Test, contour::Level},
    },
};

/// Room around the result, relative to its size.
const ROOM: f64 = 0.03;

/// The points at most `by` mm from a solid, or for a negative `by` those so deep inside, found by a hypersphere
/// test. [`Test::Exact`] gives what [`offset`](super::offset) gives, built of its pieces. The others contour the
/// solid; random points make it smaller by as much as they leave out of the sphere, about 2 |by| / n where it is
/// flat.
///
/// ```
/// use glam::DVec3;
/// use katachi::{convert::offset::tested, geom::Tolerance, kernel::field::Test};
/// use katachi::kernel::brep::{measure::volume, primitive::cuboid};
/// let grain = cuboid(DVec3::ZERO, DVec3::splat(0.5));
/// let coarse = Tolerance::new(0.2).unwrap();
/// let grown = tested(&grain, 5.0, Test::Quadtree, coarse).unwrap();
/// assert!((volume(&grown) / 649.0335 - 1.0).abs() < 0.1); // the area times the tolerance is a ninth of it
/// ```
pub fn tested(
    solid: &Polyhedron,
    by: f64,
    test: Test,
    tolerance: Tolerance,
) -> Result<Polyhedron, OffsetError> {
    if test == Test::Exact || by == 0.0 || !by.is_finite() || solid.is_empty() {
        return super::offset(solid, by, tolerance);
    }
    let field = field_of(solid);
    let sphere = Hypersphere::new(&field, by, test, tolerance);
    contoured(solid.mesh(), &field, by, tolerance, sphere)
}

/// The points at most `by` mm from a solid that is not empty, or for a negative `by` those so deep inside.
/// Faces have the tags and the colour of the face that they are nearest to.
pub(super) fn apart(
    solid: &Polyhedron,
    by: f64,
    tolerance: Tolerance,
) -> Result<Polyhedron, OffsetError> {
    let field = field_of(solid);
    contoured(solid.mesh(), &field, by, tolerance, Apart::new(&field, by))
}

/// What a function of the distance bounds around a solid. Faces are those that they are nearest to.
fn contoured<L: Level>(
    mesh: &PolyMesh,
    field: &Polyhedral,
    by: f64,
    tolerance: Tolerance,
    level: L,
) -> Result<Polyhedron, OffsetError> {
    let reach = field.extent().grown(by.max(0.0));
    let within = reach.grown(ROOM * (reach.max - reach.min).max_element());
    let faceted = |o: &Origin| Origin { surface: Surface::Facets, form: None, ..o.clone() };
    let origins: Vec<Origin> = mesh.origins().iter().map(faceted).collect();
    let origin = |p: DVec3| mesh.face(field.nearest(p).face as usize).origin_index();
    Ok(level_set(level, &within, tolerance, &origins, origin)?)
}

/// The field of a solid.
fn field_of(solid: &Polyhedron) -> Polyhedral {
    Polyhedral::new(solid.mesh()).expect("a solid that is not empty has a face")
}
