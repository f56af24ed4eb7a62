//! Many questions about one solid.
//!
//! | paper (Barill et al. 2018) | here |
//! |---|---|
//! | w(q), the winding number | solid angle / 4 pi |
//! | p~, r | `Far::middle`, `Far::radius` |
//! | sum a n (first order) | `Far::dipole` |
//! | sum (p - p~) (x) a n (second order) | `Far::quadrupole` |
//! | beta | [`FAR`] |
//!
//! # Departures
//! - No third-order term: [`inside`](Projection::inside) needs a whole number, and sums one by one where the
//!   expansion is not near to one.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};

use super::{ON_PLANE, is_on, triangle_area};
use crate::geom::{Bounds, bvh::Bvh, mesh::PolyMesh, sum::Sum, triangulate::triangulate};

/// A group is far when it is so many of its radii away.
const FAR: f64 = 2.5;

/// Winding numbers this near to a whole one are taken as it; the others are summed triangle by triangle.
const WHOLE: f64 = 0.1;

/// The boundary of a solid, made ready for many questions.
///
/// ```
/// use glam::dvec3;
/// use katachi::{geom::spherical_projection::Projection, kernel::brep::primitive::sphere};
/// let ball = Projection::new(sphere(5.0, 100).mesh());
/// assert!(ball.inside(dvec3(0.0, 3.0, -3.9)) && !ball.inside(dvec3(0.0, 3.1, 4.0)));
/// ```
#[derive(Clone, Debug)]
pub struct Projection {
    triangles: Vec<[DVec3; 3]>,
    tree: Bvh,
    /// For each box of the tree.
    far: Vec<Far>,
}

/// Triangles as seen from afar.
#[derive(Clone, Copy, Default, Debug)]
struct Far {
    /// Their area, mm^2.
    area: f64,
    /// Their centroid.
    middle: DVec3,
    /// Area vectors.
    dipole: DVec3,
    /// Centroids from the middle times area vectors.
    quadrupole: DMat3,
}

impl Far {
    fn of(triangle: &[DVec3; 3]) -> Far {
        let [a, b, c] = *triangle;
        let dipole = (b - a).cross(c - a) / 2.0;
        let middle = a + ((b - a) + (c - a)) / 3.0;
        Far { area: dipole.length(), middle, dipole, quadrupole: DMat3::ZERO }
    }

    fn joined(&self, other: &Far) -> Far {
        let area = self.area + other.area;
        let share = if area > 0.0 { other.area / area } else { 0.5 };
        let middle = self.middle.lerp(other.middle, share);
        let about = |far: &Far| far.quadrupole + outer(far.middle - middle, far.dipole);
        let quadrupole = about(self) + about(other);
        Far { area, middle, dipole: self.dipole + other.dipole, quadrupole }
    }

    /// The solid angle under which `q` sees them, if they are far.
    fn area_from(&self, q: DVec3, within: &Bounds) -> Option<f64> {
        let r = self.middle - q;
        let reach = (self.middle - within.min).max(within.max - self.middle);
        let square = r.length_squared();
        if square <= FAR * FAR * reach.length_squared() {
            return None;
        }
        let cube = square * square.sqrt();
        let trace = self.quadrupole.x_axis.x + self.quadrupole.y_axis.y + self.quadrupole.z_axis.z;
        let second = trace - 3.0 * r.dot(self.quadrupole * r) / square;
        Some((self.dipole.dot(r) + second) / cube)
    }
}

/// The matrix a b^T.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

impl Projection {
    /// Prepares a closed mesh. Takes as long as triangulating it.
    pub fn new(mesh: &PolyMesh) -> Projection {
        let corners = triangulate(mesh).corners;
        let triangles: Vec<[DVec3; 3]> =
            corners.iter().map(|t| t.map(|c| mesh.points[c as usize])).collect();
        let boxes: Vec<Bounds> = triangles.iter().map(|t| Bounds::of(*t)).collect();
        let tree = Bvh::new(&boxes);
        let far = tree.gathered(|i| Far::of(&triangles[i as usize]), Far::joined);
        Projection { triangles, tree, far }
    }

    /// Whether a point is in the solid, points of the boundary within rounding included.
    pub fn inside(&self, q: DVec3) -> bool {
        let bounds = self.tree.bounds();
        let reach = bounds.min.abs().max(bounds.max.abs()).max(q.abs()).max_element();
        let spot = Bounds::of([q]).grown(ON_PLANE * reach);
        if !bounds.meets(&spot) {
            return false;
        }
        let mut touches = false;
        self.tree.visit(&spot, |t| touches |= is_on(self.triangles[t as usize], q));
        touches || self.nearly(q).unwrap_or_else(|| self.exactly(q)) >= TAU
    }

    /// The solid angle by the expansion, unless it is not near to a multiple of 4 pi.
    fn nearly(&self, q: DVec3) -> Option<f64> {
        let mut sum = 0.0;
        let mut one_by_one = 0.0;
        self.tree.descend(
            |node, within| {
                let area = self.far[node].area_from(q, within);
                sum += area.unwrap_or(0.0);
                area.is_some()
            },
            |t| one_by_one += triangle_area(self.triangles[t as usize], q),
        );
        let winding = (sum + one_by_one) / (2.0 * TAU);
        ((winding - winding.round()).abs() < WHOLE).then_some(sum + one_by_one)
    }

    fn exactly(&self, q: DVec3) -> f64 {
        self.triangles.iter().map(|t| triangle_area(*t, q)).collect::<Sum>().value()
    }
}
