//! Surfaces over two parameters, which the faces of sweeps stand for.

use std::{fmt, sync::Arc};

use glam::{DVec2, DVec3, dvec2};

use super::Placement;

/// A surface over two parameters from 0 to 1: u along a profile, v along the way that this is carried.
pub trait Parametric: fmt::Debug + Send + Sync {
    /// The point at two parameters, mm.
    fn at(&self, u: f64, v: f64) -> DVec3;
}

/// A parameter surface, shared by all that know it, and where it stands.
#[derive(Clone, Debug)]
pub struct Form {
    surface: Arc<dyn Parametric>,
    placement: Placement,
}

impl PartialEq for Form {
    /// The same surface at the same place.
    fn eq(&self, other: &Form) -> bool {
        Arc::ptr_eq(&self.surface, &other.surface) && self.placement == other.placement
    }
}

/// The step of differences: their error and what rounding makes of them are both about 1e-10.
const STEP: f64 = 1e-5;

/// Places of each parameter from which the nearest point is looked for.
const STARTS: [u32; 2] = [5, 48];

/// The nearest of them that are refined, and steps of each.
const REFINED: usize = 4;
const STEPS: u32 = 16;

impl Form {
    /// A surface where it is.
    pub fn new(surface: Arc<dyn Parametric>) -> Form {
        Form { surface, placement: Placement::IDENTITY }
    }

    /// The form after a placement.
    pub fn placed(&self, placement: &Placement) -> Form {
        Form { surface: self.surface.clone(), placement: placement.after(&self.placement) }
    }

    /// The point at two parameters, mm.
    pub fn at(&self, u: f64, v: f64) -> DVec3 {
        self.placement.point(self.surface.at(u, v))
    }

    /// The unit normal at two parameters, to the outside of what is swept; zero where there is none, as at the tip of a cone.
    pub fn normal(&self, u: f64, v: f64) -> DVec3 {
        let [along, across] = self.slopes(dvec2(u, v));
        let out = along.cross(across).normalize_or_zero();
        if self.placement.mirrors() { -out } else { out }
    }

    /// The parameters of the point nearest to `p`: the best that Gauss and Newton's method finds from the nearest of some
    /// hundred places.
    pub fn nearest(&self, p: DVec3) -> [f64; 2] {
        let [nu, nv] = STARTS;
        let part = |i: u32, n: u32| f64::from(i) / f64::from(n - 1);
        let far = |at: DVec2| self.at(at.x, at.y).distance_squared(p);
        let starts = (0..nu).flat_map(|i| (0..nv).map(move |j| dvec2(part(i, nu), part(j, nv))));
        let mut starts: Vec<(f64, DVec2)> = starts.map(|at| (far(at), at)).collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let refined = starts.iter().take(REFINED).map(|(_, at)| self.refined(p, *at));
        let best = refined.min_by(|a, b| far(*a).total_cmp(&far(*b)));
        best.unwrap_or(DVec2::ZERO).to_array()
    }

    /// The derivatives by u and v, by differences within the surface.
    fn slopes(&self, at: DVec2) -> [DVec3; 2] {
        [DVec2::X, DVec2::Y].map(|axis| {
            let low = (at - axis * STEP).max(DVec2::ZERO);
            let high = (at + axis * STEP).min(DVec2::ONE);
            (self.at(high.x, high.y) - self.at(low.x, low.y)) / (high - low).dot(axis)
        })
    }

    fn refined(&self, p: DVec3, start: DVec2) -> DVec2 {
        let far = |at: DVec2| self.at(at.x, at.y).distance_squared(p);
        let (mut best, mut least) = (start, far(start));
        let mut at = start;
        for _ in 0..STEPS {
            let [u, v] = self.slopes(at);
            let away = p - self.at(at.x, at.y);
            let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
            let (du, dv) = (u.dot(away), v.dot(away));
            let step = dvec2(du * vv - dv * uv, dv * uu - du * uv) / (uu * vv - uv * uv);
            if !step.is_finite() {
                break;
            }
            at = (at + step).clamp(DVec2::ZERO, DVec2::ONE);
            let found = far(at);
            if found < least {
                (best, least) = (at, found);
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    #[derive(Debug)]
    struct Tube;

    impl Parametric for Tube {
        fn at(&self, u: f64, v: f64) -> DVec3 {
            let (sin, cos) = libm::sincos(u * std::f64::consts::TAU);
            dvec3(2.0 * cos, 2.0 * sin, 10.0 * v)
        }
    }

    #[test]
    fn points_and_normals_follow_placements() {
        let tube = Form::new(Arc::new(Tube));
        let [u, v] = tube.nearest(dvec3(0.0, 5.0, 4.0));
        assert!((u - 0.25).abs() < 1e-9 && (v - 0.4).abs() < 1e-9, "{u} {v}");
        assert!(tube.normal(u, v).distance(DVec3::Y) < 1e-8);
        let moved = tube.placed(&Placement::translation(DVec3::X * 7.0));
        assert!(moved.at(u, v).distance(dvec3(7.0, 2.0, 4.0)) < 1e-8);
        assert!(moved != tube && tube.clone() == tube);
    }
}
