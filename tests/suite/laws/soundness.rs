//! What every result of a set operation must be: closed, without flat triangles, and nowhere through itself.

use glam::DVec3;
use katachi::{
    geom::triangulate::triangulate,
    kernel::brep::{Polyhedron, crossing::crossings},
};

/// What is wrong with a solid, or nothing.
pub fn fault(solid: &Polyhedron) -> Option<String> {
    crossing_or_gap(solid).or(flat_triangle(solid))
}

/// Where a solid is open or crosses itself.
pub fn crossing_or_gap(solid: &Polyhedron) -> Option<String> {
    let mesh = solid.mesh();
    if let Err(defect) = Polyhedron::new(mesh.clone()) {
        return Some(format!("not closed: {defect}"));
    }
    let crossings = crossings(mesh);
    let first = crossings.first()?;
    Some(format!("{} pairs of triangles cross, the first at {first}", crossings.len()))
}

/// A triangle without area.
pub fn flat_triangle(solid: &Polyhedron) -> Option<String> {
    let mesh = solid.mesh();
    let corners = triangulate(mesh).corners;
    let flat = corners.iter().map(|t| t.map(|c| mesh.points[c as usize])).find(is_flat)?;
    Some(format!("a flat triangle: {flat:?}"))
}

/// Whether a triangle has no area, up to the rounding of its corners.
fn is_flat(&[a, b, c]: &[DVec3; 3]) -> bool {
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    let size = a.length().max(b.length()).max(c.length());
    (b - a).cross(c - a).length() <= longest * size * f64::EPSILON
}
