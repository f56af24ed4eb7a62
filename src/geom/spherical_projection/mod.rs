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
//! | front, back | `View::side` | a face counts positive when Q sees its back |
//! | the sum of all s | [`solid_angle`] | 4 pi inside, 0 outside; decided at 2 pi |
//!
//! # Departures
//! - theta_j comes from atan2 instead of arccos, and carries a sign (corners may be reflex): the excess is
//!   2 pi less the sum of the signed turns, brought into (-2 pi, 2 pi]. So it has the sign of the side
//!   already; the side is asked only where rounding could confuse +2 pi with -2 pi.
//! - Holes are loops of their own that count against the face.
//! - Triangles take the form of A. van Oosterom and J. Strackee, *The Solid Angle of a Plane Triangle*,
//!   1983, which needs one atan2 and is exact for small ones.
//! - The polygon form takes turns from the directions of edges. An edge of the length of rounding has none, a
//!   face bent by rounding has no inside where Q is as near to its plane as it is bent, and a turn of half a
//!   circle has no sign: each can be off by 2 pi. The form is the default all the same, because it is the
//!   paper's and needs no triangulation; faces that are so (`view`) are summed over their
//!   triangles, whose sum is right wherever Q is off the triangles, however they are bent.
//! - [`Projection`] answers many questions about one solid: triangles near Q one by one, the others by a
//!   far-field expansion (G. Barill, N. Dickson, R. Schmidt, D. Levin, A. Jacobson, *Fast Winding Numbers for
//!   Soups and Clouds*, 2018).
//! - A face whose plane holds Q counts 0: then a point on a face sees 2 pi, on an edge the angle of its two
//!   faces (twice the dihedral angle), at a corner the corner's solid angle.
//!   "Holds" means within rounding, [`ON_PLANE`].
//! - [`inside`] counts points of the boundary as inside, so it asks whether one of those faces has Q on it.

mod projection;
mod view;

use std::f64::consts::{PI, TAU};

use glam::DVec3;

pub use projection::Projection;

use self::view::View;
use super::{mesh::PolyMesh, sum::Sum};

/// Distances below this many times the largest coordinate are rounding: four units in the last place
/// for the corners of the plane, as many for the point.
const ON_PLANE: f64 = 8.0 * f64::EPSILON;

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
    mesh.faces().map(|face| View::new(mesh, face, q).area()).collect::<Sum>().value()
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
        let view = View::new(mesh, face, q);
        if view.touches() {
            return true;
        }
        sum.add(view.area());
    }
    sum.value() >= TAU
}

/// Whether a point lies on a triangle, up to rounding of the coordinates.
fn is_on(triangle: [DVec3; 3], q: DVec3) -> bool {
    let reach = triangle.iter().fold(q.abs(), |m, c| m.max(c.abs())).max_element();
    super::nearest::on_triangle(triangle, q).distance(q) <= ON_PLANE * reach
}

/// The signed area of a triangle on the unit sphere about `q`; 0 where its plane holds `q` up to rounding.
fn triangle_area(triangle: [DVec3; 3], q: DVec3) -> f64 {
    let [a, b, c] = triangle;
    let height = (a - q).dot((b - a).cross(c - a).normalize_or_zero());
    if height.abs() <= ON_PLANE * a.abs().max(q.abs()).max_element() {
        return 0.0;
    }
    spherical_triangle(triangle.map(|p| p - q))
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
    excess(corners).0
}

/// The area of [`spherical_polygon`], and the largest turn at a corner, without its sign.
fn excess(corners: &[DVec3]) -> (f64, f64) {
    let n = corners.len();
    let normal = |j: usize| corners[j % n].cross(corners[(j + 1) % n]);
    let (mut turned, mut sharpest, mut before) = (Sum::default(), 0.0f64, normal(n - 1));
    for (j, corner) in corners.iter().enumerate() {
        let after = normal(j);
        if let Some(angle) = turn(before, after, *corner) {
            turned.add(angle);
            sharpest = sharpest.max(angle.abs());
        }
        before = after;
    }
    let area = TAU - turned.value();
    (area - 2.0 * TAU * ((area - TAU) / (2.0 * TAU)).ceil(), sharpest)
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
