//! Is a point in a solid? Project every face onto the unit sphere about the point and add the areas.
//!
//! Nagashima, S.: *A Spatial Inclusion Test for Polyhedra Using a Spherical Projection*, Transactions of
//! the Information Processing Society of Japan, short note, received 1985, accepted 1986 (長島 忍,
//! 球面投影による多面体の内外判定方法).
//!
//! | paper | here | meaning |
//! |---|---|---|
//! | Q | `q` | the given point |
//! | P_j | `corners[j] - q` | corner j of a face, seen from Q |
//! | n_j | `n` in [`spherical_polygon`] | normal of the plane through Q, P_j, P_j+1 |
//! | theta_j | pi - [`turn`] | angle of the spherical polygon at P_j |
//! | s | [`spherical_polygon`] | area of the spherical polygon: sum of theta_j - (n - 2) pi |
//! | front, back | [`side`] | a face counts positive when Q sees its back |
//! | the sum of all s | [`solid_angle`] | 4 pi inside, 0 outside; decided at 2 pi |
//!
//! # Departures
//! - theta_j comes from atan2 instead of arccos, and carries a sign (corners may be reflex): the excess is
//!   2 pi less the sum of the signed turns, brought into (-2 pi, 2 pi]. So it has the sign of the side
//!   already; the side is asked only where rounding could confuse +2 pi with -2 pi.
//! - Holes are loops of their own that count against the face.
//! - Triangles take the form of A. van Oosterom and J. Strackee, *The Solid Angle of a Plane Triangle*,
//!   1983, which needs one atan2 and is exact for small ones.
//! - A face whose plane holds Q counts 0: then a point on a face sees 2 pi, on an edge the angle of its two
//!   faces (twice the dihedral angle), at a corner the corner's solid angle.
//!   "Holds" means within rounding, [`ON_PLANE`].
//! - [`inside`] counts points of the boundary as inside, so it asks whether one of those faces has Q on it.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::{
    mesh::{FaceRef, PolyMesh},
    sum::Sum,
    triangulate::triangulate_face,
};

/// Distances below this many times the largest coordinate are rounding: four units in the last place
/// for the corners of the plane, as many for the point.
const ON_PLANE: f64 = 8.0 * f64::EPSILON;

/// Areas this near to 2 pi take their sign from the side of the face: far above the rounding of a sum of
/// angles, far below what a point off the plane can be mistaken by.
const NEAR_HALF: f64 = 1e-6;

/// The solid angle in steradians under which the boundary is seen from a point, faces counting positive
/// from behind: 4 pi inside a closed mesh and 0 outside, 2 pi on a face. A mesh that is not closed gives
/// its generalised winding number times 4 pi.
///
/// ```
/// use glam::dvec3;
/// use katachi::{geom::spherical_projection::solid_angle, kernel::brep::primitive::cuboid};
/// let cube = cuboid(dvec3(-1., -1., -1.), dvec3(1., 1., 1.)).into_mesh();
/// let pi = std::f64::consts::PI;
/// assert!((solid_angle(&cube, dvec3(0.3, 0.2, 0.1)) - 4.0 * pi).abs() < 1e-12);
/// assert!((solid_angle(&cube, dvec3(1.0, 1.0, 1.0)) - 0.5 * pi).abs() < 1e-12);
/// ```
pub fn solid_angle(mesh: &PolyMesh, q: DVec3) -> f64 {
    mesh.faces().map(|face| face_area(mesh, face, q)).collect::<Sum>().value()
}

/// Whether a point is in the solid that a closed mesh bounds; points of the boundary, up to rounding of
/// its coordinates, count as inside.
///
/// ```
/// use glam::dvec3;
/// use katachi::{geom::spherical_projection::inside, kernel::brep::primitive::cuboid};
/// let cube = cuboid(dvec3(-1., -1., -1.), dvec3(1., 1., 1.)).into_mesh();
/// assert!(inside(&cube, dvec3(1.0, 0.5, 1.0)));
/// assert!(!inside(&cube, dvec3(1.0, 0.5, 1.0 + 1e-12)));
/// ```
pub fn inside(mesh: &PolyMesh, q: DVec3) -> bool {
    let mut sum = Sum::default();
    for face in mesh.faces() {
        if side(mesh, face, q) == 0.0 && touches(mesh, face, q) {
            return true;
        }
        sum.add(face_area(mesh, face, q));
    }
    sum.value() >= TAU
}

/// The signed area of one face on the unit sphere about `q`.
fn face_area(mesh: &PolyMesh, face: FaceRef, q: DVec3) -> f64 {
    let side = side(mesh, face, q);
    if side == 0.0 {
        return 0.0;
    }
    let seen = |&c: &u32| mesh.points[c as usize] - q;
    if let [a, b, c] = face.outer()
        && face.loops().len() == 1
    {
        return spherical_triangle([a, b, c].map(seen));
    }
    let mut corners = vec![];
    let areas = face.loops().enumerate().map(|(i, indices)| {
        corners.clear();
        corners.extend(indices.iter().map(seen));
        let area = spherical_polygon(&corners);
        let sign = if i == 0 { side.signum() } else { -side.signum() };
        if area.abs() > TAU - NEAR_HALF { sign * area.abs() } else { area }
    });
    areas.sum()
}

/// Height of the face's plane over `q`, positive when Q sees the back; 0 within rounding.
fn side(mesh: &PolyMesh, face: FaceRef, q: DVec3) -> f64 {
    let base = mesh.points[face.outer()[0] as usize];
    let normal = face.area_vector().normalize_or_zero();
    let height = (base - q).dot(normal);
    let reach = base.abs().max(q.abs()).max_element();
    if height.abs() <= ON_PLANE * reach { 0.0 } else { height }
}

/// Whether `q` lies on a face within rounding.
fn touches(mesh: &PolyMesh, face: FaceRef, q: DVec3) -> bool {
    let loops: Vec<&[u32]> = face.loops().collect();
    let mut triangles = vec![];
    triangulate_face(&mesh.points, &loops, &mut triangles);
    triangles.iter().any(|t| {
        let corners = t.map(|c| mesh.points[c as usize]);
        let reach = corners.iter().fold(q.abs(), |m, c| m.max(c.abs())).max_element();
        super::nearest::on_triangle(corners, q).distance(q) <= ON_PLANE * reach
    })
}

/// The signed area of a spherical polygon, given its corners as seen from the centre (not on the sphere
/// yet: only their directions count). Positive when they turn counter-clockwise seen from outside the
/// sphere; in (-2 pi, 2 pi]. The corners must lie on one side of a plane through the centre.
///
/// ```
/// use glam::DVec3;
/// use katachi::geom::spherical_projection::spherical_polygon;
/// let octant = [DVec3::X, DVec3::Y, DVec3::Z];
/// assert!((spherical_polygon(&octant) - std::f64::consts::PI / 2.0).abs() < 1e-15);
/// ```
pub fn spherical_polygon(corners: &[DVec3]) -> f64 {
    let n = corners.len();
    let normal = |j: usize| corners[j % n].cross(corners[(j + 1) % n]);
    let mut before = normal(n - 1);
    let turns = (0..n).map(|j| {
        let after = normal(j);
        let angle = turn(before, after, corners[j]);
        before = after;
        angle
    });
    let area = TAU - turns.flatten().collect::<Sum>().value();
    area - 2.0 * TAU * ((area - TAU) / (2.0 * TAU)).ceil()
}

/// The signed turn at a corner: the angle between the planes before and after it. `None` where an edge
/// points at the centre, which no point off the face's plane sees.
fn turn(before: DVec3, after: DVec3, corner: DVec3) -> Option<f64> {
    let sine = before.cross(after).dot(corner) / corner.length();
    let cosine = before.dot(after);
    (sine != 0.0 || cosine != 0.0).then(|| libm::atan2(sine, cosine))
}

/// The signed area of a spherical triangle, given its corners as seen from the centre (van Oosterom and
/// Strackee); in (-2 pi, 2 pi].
///
/// ```
/// use glam::DVec3;
/// use katachi::geom::spherical_projection::spherical_triangle;
/// let octant = [DVec3::Y, DVec3::X, DVec3::Z];
/// assert_eq!(spherical_triangle(octant), -std::f64::consts::PI / 2.0);
/// ```
pub fn spherical_triangle([a, b, c]: [DVec3; 3]) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let triple = a.dot(b.cross(c));
    let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    if triple == 0.0 && below == 0.0 { PI } else { 2.0 * libm::atan2(triple, below) }
}

#[cfg(test)]
mod tests;
