//! Round surfaces laid flat: a plane figure put on a cylinder, a cone, a sphere or a torus.
//!
//! A point of the surface is the origin; the plane touches the surface there, x to the right and y upwards seen from
//! outside. Lengths are kept on cylinders and cones, which are unrolled, and on spheres along lines through the origin;
//! on a torus along the two circles through it.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, dvec2};

use super::Surface;

/// A surface and the plane that touches it at a point.
#[derive(Clone, Copy, Debug)]
pub struct Development {
    surface: Surface,
    origin: DVec3,
    right: DVec3,
    up: DVec3,
    /// Away from the axis at the origin, and around it.
    out: DVec3,
    around: DVec3,
}

/// Normals are upright when the part of them across the z axis is smaller than this: rounding has no direction.
const UPRIGHT: f64 = 1e-7;

/// To the right and upwards on a face with this normal, seen from outside: level and as far up as can be, along x and y on
/// a level face.
pub fn directions(normal: DVec3) -> (DVec3, DVec3) {
    let level = DVec3::Z.cross(normal);
    let right = if level.length() > UPRIGHT { level.normalize() } else { DVec3::X };
    (right, normal.cross(right))
}

impl Development {
    /// The plane that touches a surface at its point nearest to `at`, seen from the side of `outside`, mm. `None` for
    /// surfaces without a closed form, and where nothing tells what is around, as on an axis.
    ///
    /// ```
    /// use glam::{DVec3, dvec2, dvec3};
    /// use katachi::geom::{Surface, development::Development};
    /// let rod = Surface::Cylinder { point: DVec3::ZERO, axis: DVec3::Z, radius: 2.0 };
    /// let sheet = Development::new(rod, dvec3(0.0, -2.0, 5.0), DVec3::NEG_Y).unwrap();
    /// // A quarter of the way around, and one up.
    /// let p = sheet.lay(dvec2(std::f64::consts::PI, 1.0));
    /// assert!(p.distance(dvec3(2.0, 0.0, 6.0)) < 1e-12);
    /// ```
    pub fn new(surface: Surface, at: DVec3, outside: DVec3) -> Option<Development> {
        let (center, axis) = match surface {
            Surface::Cylinder { point, axis, .. } => (point, axis),
            Surface::Cone { apex, axis, .. } => (apex, axis),
            Surface::Torus { center, axis, .. } => (center, axis),
            Surface::Sphere { center, .. } => (center, DVec3::Z),
            Surface::Plane | Surface::Smooth | Surface::Facets => return None,
        };
        let radial = (at - center).reject_from_normalized(axis).try_normalize();
        let sphere = matches!(surface, Surface::Sphere { .. });
        let out = radial.or_else(|| sphere.then_some(DVec3::X))?;
        let (right, up) = (DVec3::X, DVec3::Y);
        let mut plane =
            Development { surface, origin: at, right, up, out, around: axis.cross(out) };
        plane.origin = plane.nearest(at)?;
        let normal = plane.normal(plane.origin);
        (plane.right, plane.up) = directions(normal * normal.dot(outside).signum());
        Some(plane)
    }

    /// The point of the surface nearest to one in the half plane through the axis and the origin.
    fn nearest(&self, at: DVec3) -> Option<DVec3> {
        Some(match self.surface {
            Surface::Cylinder { point, axis, radius } => {
                point + axis * axis.dot(at - point) + self.out * radius
            }
            Surface::Cone { apex, axis, slope } => {
                let along = (axis + self.out * slope).normalize();
                let far = along.dot(at - apex);
                if far <= 0.0 {
                    return None;
                }
                apex + along * far
            }
            Surface::Sphere { center, radius } => center + (at - center).try_normalize()? * radius,
            Surface::Torus { center, major, minor, .. } => {
                let tube = center + self.out * major;
                tube + (at - tube).try_normalize()? * minor
            }
            Surface::Plane | Surface::Smooth | Surface::Facets => at,
        })
    }

    /// The unit normal of the surface at a point of it, away from its axis, centre or tube.
    pub fn normal(&self, p: DVec3) -> DVec3 {
        let radial = |center: DVec3, axis: DVec3| {
            (p - center).reject_from_normalized(axis).normalize_or(self.out)
        };
        match self.surface {
            Surface::Cylinder { point, axis, .. } => radial(point, axis),
            Surface::Cone { apex, axis, slope } => (radial(apex, axis) - axis * slope).normalize(),
            Surface::Sphere { center, .. } => (p - center).normalize_or(self.out),
            Surface::Torus { center, axis, major, .. } => {
                (p - center - radial(center, axis) * major).normalize_or(self.out)
            }
            Surface::Plane | Surface::Smooth | Surface::Facets => self.right.cross(self.up),
        }
    }

    /// The direction away from the axis, turned around it by an angle in radians from the origin.
    fn turned(&self, angle: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(angle);
        self.out * cos + self.around * sin
    }

    /// The angle around an axis from the origin, radians.
    fn angle(&self, v: DVec3) -> f64 {
        libm::atan2(v.dot(self.around), v.dot(self.out))
    }

    /// The point of the surface where a point of the plane comes to lie, mm.
    pub fn lay(&self, p: DVec2) -> DVec3 {
        let v = self.right * p.x + self.up * p.y;
        match self.surface {
            Surface::Cylinder { point, axis, radius } => {
                let foot = point + axis * axis.dot(self.origin - point + v);
                foot + self.turned(v.dot(self.around) / radius) * radius
            }
            Surface::Cone { apex, axis, slope } => {
                let along = axis + self.out * slope;
                let secant = along.length();
                let far = apex.distance(self.origin) + v.dot(along) / secant;
                let side = v.dot(self.around);
                let (s, angle) = (libm::hypot(far, side), libm::atan2(side, far));
                apex + (axis + self.turned(angle * secant / slope) * slope) * (s / secant)
            }
            Surface::Sphere { center, radius } => {
                let Some(along) = v.try_normalize() else { return self.origin };
                let (sin, cos) = libm::sincos(v.length() / radius);
                center + (self.origin - center) * cos + along * (sin * radius)
            }
            Surface::Torus { center, axis, major, minor } => {
                let tube = (self.origin - center - self.out * major) / minor;
                let rising = axis * tube.dot(self.out) - self.out * tube.dot(axis);
                let reach = major + minor * tube.dot(self.out);
                let (sin, cos) = libm::sincos(v.dot(rising) / minor);
                let (x, z) = (
                    tube.dot(self.out) * cos + rising.dot(self.out) * sin,
                    tube.dot(axis) * cos + rising.dot(axis) * sin,
                );
                let out = self.turned(v.dot(self.around) / reach);
                center + out * (major + minor * x) + axis * (minor * z)
            }
            Surface::Plane | Surface::Smooth | Surface::Facets => self.origin + v,
        }
    }

    /// The point of the plane that comes to lie on a point of the surface, on the same way around as another one, mm.
    pub fn unroll(&self, p: DVec3, beside: DVec3) -> DVec2 {
        let near = |angle: f64, other: f64| angle + TAU * ((other - angle) / TAU).round();
        let around = |center: DVec3| near(self.angle(p - center), self.angle(beside - center));
        let v = match self.surface {
            Surface::Cylinder { point, axis, radius } => {
                axis * axis.dot(p - self.origin) + self.around * (around(point) * radius)
            }
            Surface::Cone { apex, axis, slope } => {
                let along = (axis + self.out * slope).normalize();
                let (sin, cos) = libm::sincos(around(apex) * slope / (1.0 + slope * slope).sqrt());
                let s = apex.distance(p);
                along * (s * cos - apex.distance(self.origin)) + self.around * (s * sin)
            }
            Surface::Sphere { center, radius } => {
                let from = (self.origin - center) / radius;
                let to = p - center;
                let aside = to - from * from.dot(to);
                let angle = libm::atan2(aside.length(), from.dot(to));
                aside.normalize_or_zero() * (angle * radius)
            }
            Surface::Torus { center, axis, major, minor } => {
                let tube = (self.origin - center - self.out * major) / minor;
                let rising = axis * tube.dot(self.out) - self.out * tube.dot(axis);
                let across = |p: DVec3| {
                    let height = axis.dot(p - center);
                    let q =
                        self.out * ((p - center - axis * height).length() - major) + axis * height;
                    libm::atan2(q.dot(rising), q.dot(tube))
                };
                let reach = major + minor * tube.dot(self.out);
                self.around * (around(center) * reach)
                    + rising * (near(across(p), across(beside)) * minor)
            }
            Surface::Plane | Surface::Smooth | Surface::Facets => p - self.origin,
        };
        dvec2(v.dot(self.right), v.dot(self.up))
    }

    /// How far from the origin the plane can be laid without meeting itself, mm.
    pub fn reach(&self) -> f64 {
        match self.surface {
            Surface::Sphere { radius, .. } => radius * PI,
            _ => f64::INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    #[test]
    fn what_is_laid_on_a_surface_is_unrolled_from_it() {
        let (center, axis) = (dvec3(1.0, 2.0, 3.0), dvec3(0.6, 0.0, 0.8));
        let at = center + dvec3(4.0, -3.0, 5.0);
        for surface in [
            Surface::Cylinder { point: center, axis, radius: 4.0 },
            Surface::Cone { apex: center, axis, slope: 0.5 },
            Surface::Sphere { center, radius: 6.0 },
            Surface::Torus { center, axis, major: 5.0, minor: 1.5 },
        ] {
            let plane = Development::new(surface, at, at - center).expect("a round surface");
            for (x, y) in [(0.0, 0.0), (1.0, 0.5), (-2.0, 1.0), (0.5, -1.5)] {
                let p = plane.lay(dvec2(x, y));
                assert!(plane.unroll(p, plane.origin).distance(dvec2(x, y)) < 1e-12, "{surface:?}");
            }
            // Near the origin lengths are kept.
            let [p, q] = [dvec2(1e-4, 0.0), dvec2(0.0, 1e-4)].map(|v| plane.lay(v));
            assert!((p.distance(plane.origin) - 1e-4).abs() < 1e-8);
            assert!((p.distance(q) - 1e-4 * 2f64.sqrt()).abs() < 1e-8);
            assert!((q - plane.origin).dot(plane.normal(plane.origin)).abs() < 1e-8);
        }
    }
}
