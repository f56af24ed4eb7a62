//! Surfaces as functions of space, and points that lie on several of them.

use glam::{DMat3, DVec3};

use super::{Camera, lattice::Plane};
use crate::geom::{Surface, surface::around_axis};

/// A surface as its signed distance: 0 on it, gradient of length 1.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Field {
    /// A plane.
    Flat(Plane),
    /// A round surface, which has a closed form and is no plane.
    Round(Surface),
}

/// The normal of a field at a point, and how it bends there.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    /// Unit normal, towards larger values.
    pub normal: DVec3,
    /// Two orthogonal directions across the normal with the curvatures along them, 1/mm.
    bends: [(DVec3, f64); 2],
}

impl Local {
    fn flat(normal: DVec3) -> Local {
        Local { normal, bends: [(DVec3::ZERO, 0.0); 2] }
    }

    /// The derivative of the normal along a vector.
    pub fn bend(&self, v: DVec3) -> DVec3 {
        self.bends.iter().map(|(d, k)| *d * (d.dot(v) * k)).sum()
    }

    /// The smallest radius of curvature, mm; infinite for a plane.
    pub fn radius(&self) -> f64 {
        let most = self.bends[0].1.abs().max(self.bends[1].1.abs());
        if most > 0.0 { 1.0 / most } else { f64::INFINITY }
    }

    /// How much the surface bends along a direction, times the square of its length.
    pub fn bend_along(&self, v: DVec3) -> f64 {
        v.dot(self.bend(v))
    }
}

/// A curvature 1 / r that stays finite.
fn inverse(r: f64) -> f64 {
    if r.abs() > f64::MIN_POSITIVE { 1.0 / r } else { 0.0 }
}

impl Field {
    /// Where a cone ends in a point, which is turned every way.
    pub fn apex(&self) -> Option<DVec3> {
        match *self {
            Field::Round(Surface::Cone { apex, .. }) => Some(apex),
            _ => None,
        }
    }

    /// Whether it is a plane.
    pub fn is_flat(&self) -> bool {
        matches!(self, Field::Flat(_))
    }

    /// The field at a point.
    pub fn local(&self, p: DVec3) -> Local {
        match self {
            Field::Flat(plane) => Local::flat(plane.normal),
            Field::Round(surface) => {
                let (_, normal) = surface.slope(p);
                Local { normal, bends: bends(surface, p, normal) }
            }
        }
    }

    /// Signed distance, mm, and unit normal at a point.
    #[inline]
    pub fn slope(&self, p: DVec3) -> (f64, DVec3) {
        match self {
            Field::Flat(plane) => (plane.distance(p), plane.normal),
            Field::Round(surface) => surface.slope(p),
        }
    }
}

/// Two orthogonal directions across the normal of a round surface, and the curvatures along them, 1/mm.
fn bends(surface: &Surface, p: DVec3, normal: DVec3) -> [(DVec3, f64); 2] {
    let none = (DVec3::ZERO, 0.0);
    match *surface {
        Surface::Cylinder { point, axis, .. } => {
            let (_, r, out) = around_axis(p - point, axis);
            [(axis.cross(out), inverse(r)), none]
        }
        Surface::Cone { apex, axis, slope } => {
            let (_, r, out) = around_axis(p - apex, axis);
            [(axis.cross(out), inverse(r * (1.0 + slope * slope).sqrt())), none]
        }
        Surface::Sphere { center, .. } => {
            let (s, t) = normal.any_orthonormal_pair();
            [s, t].map(|d| (d, inverse((p - center).length())))
        }
        Surface::Torus { center, axis, major, .. } => {
            let (h, r, out) = around_axis(p - center, axis);
            let (along, q) = (axis.cross(out), (out * (r - major) + axis * h).length());
            [(along, normal.dot(out) * inverse(r)), (along.cross(normal), inverse(q))]
        }
        Surface::Plane | Surface::Smooth | Surface::Facets => [none; 2],
    }
}

/// What a point of a curve fulfils.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Constraint {
    /// It lies on a surface.
    On(Field),
    /// The surface is seen edge-on there.
    Contour(Field),
}

impl Constraint {
    /// A function that is 0 where it holds, and its gradient.
    fn value(&self, camera: &Camera, p: DVec3) -> (f64, DVec3) {
        match self {
            Constraint::On(field) => field.slope(p),
            Constraint::Contour(field) => {
                let local = field.local(p);
                let sight = camera.sight(p);
                let length = sight.length();
                let moved = if camera.is_perspective() { local.normal } else { DVec3::ZERO };
                (local.normal.dot(sight) / length, (local.bend(sight) - moved) / length)
            }
        }
    }
}

/// Steps of Newton's method at most; from a chord it takes three or four.
const STEPS: usize = 20;

/// The point where three functions, given with their gradients, are 0.
fn newton(start: DVec3, reach: f64, values: impl Fn(DVec3) -> [(f64, DVec3); 3]) -> Option<DVec3> {
    let mut p = start;
    for _ in 0..STEPS {
        let [(f, df), (g, dg), (h, dh)] = values(p);
        let matrix = DMat3::from_cols(df, dg, dh).transpose();
        if matrix.determinant() == 0.0 {
            return None;
        }
        let step = matrix.inverse() * DVec3::new(f, g, h);
        p -= step;
        let within = p.distance(start) <= reach;
        if !within {
            return None;
        }
        if step.length() <= 4.0 * f64::EPSILON * p.abs().max_element().max(reach) {
            break;
        }
    }
    // The last digits of a nearly tangent pair do not settle; what was reached is as good as it gets.
    Some(p)
}

/// A curve in space: what two constraints have in common.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Curve(pub [Constraint; 2]);

impl Curve {
    /// The point of the curve in the plane through `start` across `along`; `None` if Newton's method does not come to
    /// rest within `reach` mm of the start.
    pub fn near(&self, camera: &Camera, start: DVec3, along: DVec3, reach: f64) -> Option<DVec3> {
        let [one, other] = self.0;
        newton(start, reach, |p| {
            let plane = (along.dot(p - start), along);
            [one.value(camera, p), other.value(camera, p), plane]
        })
    }

    /// The point of the curve where a third constraint holds, as [`Curve::near`] finds it.
    pub fn meeting(
        &self,
        third: Constraint,
        camera: &Camera,
        start: DVec3,
        reach: f64,
    ) -> Option<DVec3> {
        let [one, other] = self.0;
        newton(start, reach, |p| [one, other, third].map(|c| c.value(camera, p)))
    }

    /// Whether it is a contour of a surface.
    pub fn is_contour_of(&self, surface: &Field) -> bool {
        self.0.contains(&Constraint::Contour(*surface))
    }

    /// Whether two curves lie on a common round surface.
    pub fn shares_surface(&self, other: &Curve) -> bool {
        let round = |c: &&Constraint| matches!(c, Constraint::On(Field::Round(_)));
        self.0.iter().filter(round).any(|c| other.0.contains(c))
    }

    /// The direction of the curve at one of its points, not a unit vector.
    pub fn tangent(&self, camera: &Camera, p: DVec3) -> DVec3 {
        let [(_, df), (_, dg)] = self.0.map(|c| c.value(camera, p));
        df.cross(dg)
    }
}

/// How strongly a projection onto several surfaces is held back where they are tangent to each other.
const DAMPING: f64 = 1e-12;

/// The point nearest to `start`, nearly, that lies on all fields.
pub fn on_all(fields: &[Field], start: DVec3) -> DVec3 {
    let mut p = start;
    for _ in 0..STEPS {
        let (mut square, mut side) = (DMat3::from_diagonal(DVec3::splat(DAMPING)), DVec3::ZERO);
        for field in fields {
            let (value, normal) = field.slope(p);
            square += DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
            side += normal * value;
        }
        if side.abs().max_element() <= f64::EPSILON * p.abs().max_element() {
            break;
        }
        let step = square.inverse() * side;
        if !step.is_finite() {
            return start;
        }
        p -= step;
        if step.length() <= 4.0 * f64::EPSILON * p.abs().max_element() {
            break;
        }
    }
    p
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    const AXIS: DVec3 = DVec3::new(0.6, 0.0, 0.8);

    fn surfaces() -> [Surface; 4] {
        let center = dvec3(1.0, 2.0, 3.0);
        [
            Surface::Cylinder { point: center, axis: AXIS, radius: 2.0 },
            Surface::Cone { apex: center, axis: AXIS, slope: 0.5 },
            Surface::Sphere { center, radius: 4.0 },
            Surface::Torus { center, axis: AXIS, major: 5.0, minor: 1.5 },
        ]
    }

    #[test]
    fn derivatives_are_those_of_the_distance() {
        let p = dvec3(3.0, -1.0, 4.5);
        let small = 1e-6;
        for surface in surfaces() {
            let field = Field::Round(surface);
            let here = field.local(p);
            assert!((here.normal.length() - 1.0).abs() < 1e-12);
            for v in [DVec3::X, DVec3::Y, DVec3::Z] {
                let (before, after) = (field.local(p - v * small), field.local(p + v * small));
                let [low, high] = [p - v * small, p + v * small].map(|p| field.slope(p).0);
                let slope = (high - low) / (2.0 * small);
                assert!((slope - here.normal.dot(v)).abs() < 1e-8, "{surface:?}");
                let turn = (after.normal - before.normal) / (2.0 * small);
                assert!(turn.distance(here.bend(v)) < 1e-8, "{surface:?}");
            }
        }
    }

    #[test]
    fn newton_lands_on_the_curve() {
        let camera = Camera::perspective(dvec3(40.0, -30.0, 20.0), DVec3::ZERO).expect("apart");
        for surface in surfaces() {
            let field = Field::Round(surface);
            let curve = Curve([Constraint::On(field), Constraint::Contour(field)]);
            let start = on_all(&[field], dvec3(4.0, 3.0, 4.0));
            for along in DVec3::AXES {
                let Some(p) = curve.near(&camera, start, along, 10.0) else { continue };
                let local = field.local(p);
                assert!(field.slope(p).0.abs() < 1e-12 && along.dot(p - start).abs() < 1e-12);
                assert!(local.normal.dot(camera.sight(p)).abs() < 1e-10);
            }
        }
    }

    #[test]
    fn corners_lie_on_all_surfaces() {
        let [a, _, c, _] = surfaces().map(Field::Round);
        let plane = Field::Flat(Plane { normal: DVec3::Y, offset: 3.0 });
        let p = on_all(&[a, c, plane], dvec3(3.0, 3.2, 6.0));
        assert!([a, c, plane].iter().all(|f| f.slope(p).0.abs() < 1e-11));
    }
}
