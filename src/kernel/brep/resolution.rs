//! Whether doubles can hold a solid where it stands.
//!
//! Far from the origin neighbouring doubles are far apart: at 200 m, with millimetres for units, 3e-11 mm. A
//! solid that is placed there loses what is finer: faces meet, triangles become flat.

use glam::DVec3;

use super::{
    Polyhedron,
    crossing::{crossings, is_hollow},
};
use crate::geom::{Bounds, PolyMesh, triangulate::triangulate};

/// A solid so many times nearer to the origin than this, measured by its size, keeps even what is 2^-28 of its
/// size, the step of a lattice, to 2^-16 of that.
const NEAR: f64 = (1u64 << 8) as f64;

/// At so many times its size a solid may lose what is 2^-28 of its size: there it is looked at closely.
const FAR: f64 = (1u64 << 18) as f64;

/// An edge of so many units in the last place of the largest coordinate keeps its direction.
const COARSE: f64 = 64.0;

/// A triangle may be as high as this many units in the last place of its coordinates by rounding alone.
const FLAT: f64 = 2.0;

/// A place in mm where a solid crosses itself, lies on itself, has lost a triangle or its inside, as one that was sound does
/// when it is placed where coordinates cannot tell its features apart; `None` if it does nowhere, or stands so
/// near the origin that it cannot.
///
/// ```
/// use glam::DVec3;
/// use katachi::{geom::Placement, kernel::brep::{primitive::cuboid, resolution::lost}};
/// let plate = cuboid(DVec3::ZERO, DVec3::new(1.0, 1.0, 1e-9));
/// assert!(lost(&plate).is_none());
/// assert!(lost(&plate.placed(&Placement::translation(DVec3::splat(1e8)))).is_some());
/// ```
pub fn lost(solid: &Polyhedron) -> Option<DVec3> {
    let mesh = solid.mesh();
    if mesh.is_empty() {
        return None;
    }
    let Bounds { min, max } = Bounds::of(mesh.points.iter().copied());
    let (reach, size) = (min.abs().max(max.abs()).max_element(), (max - min).max_element());
    let is_near = reach <= NEAR * size;
    let unit = f64::EPSILON * reach;
    if is_near || (reach <= FAR * size && !has_edge_below(mesh, COARSE * unit)) {
        return None;
    }
    let place = crossings(mesh).first().copied().or_else(|| flat_triangle(mesh, FLAT * unit));
    place.or_else(|| is_hollow(solid).then(|| (min + max) / 2.0))
}

fn has_edge_below(mesh: &PolyMesh, length: f64) -> bool {
    let at = |corner: u32| mesh.points[corner as usize];
    let is_short = |a: u32, b: u32| at(a).distance_squared(at(b)) < length * length;
    let mut loops = mesh.faces().flat_map(|face| face.loops());
    loops.any(|corners| {
        let next = corners.iter().cycle().skip(1);
        corners.iter().zip(next).any(|(&a, &b)| is_short(a, b))
    })
}

/// A corner of a triangle that is not higher than this.
fn flat_triangle(mesh: &PolyMesh, height: f64) -> Option<DVec3> {
    let is_flat = |&[a, b, c]: &[DVec3; 3]| {
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        (b - a).cross(c - a).length() <= longest * height
    };
    let corners = triangulate(mesh).corners;
    corners.iter().map(|t| t.map(|c| mesh.points[c as usize])).find(is_flat).map(|t| t[0])
}
