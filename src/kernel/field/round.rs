//! Balls and rings.

use glam::DVec3;

use super::{Field, Same};
use crate::geom::Bounds;

/// A ball.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Ball {
    center: DVec3,
    radius: f64,
}

impl Ball {
    /// The ball about a point, radius in mm.
    pub fn new(center: DVec3, radius: f64) -> Ball {
        Ball { center, radius }
    }
}

impl Field for Ball {
    fn distance(&self, p: DVec3) -> f64 {
        p.distance(self.center) - self.radius
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        self.center + (p - self.center).try_normalize().unwrap_or(DVec3::X) * self.radius
    }

    fn extent(&self) -> Bounds {
        Bounds::of([self.center]).grown(self.radius)
    }

    fn localize<'a>(&'a self, _: &Bounds) -> Box<dyn Field + 'a> {
        Box::new(Same(self))
    }
}

/// A torus about the z axis through the origin.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Ring {
    major: f64,
    minor: f64,
}

impl Ring {
    /// The torus whose tube of radius `minor` runs at radius `major` (mm), which must not be smaller.
    ///
    /// ```
    /// use glam::{DVec3, dvec3};
    /// use katachi::kernel::field::{Field, Ring};
    /// let ring = Ring::new(10.0, 3.0);
    /// assert_eq!(ring.distance(DVec3::ZERO), 7.0);
    /// assert_eq!(ring.closest(dvec3(0.0, 12.0, 0.0)), dvec3(0.0, 13.0, 0.0));
    /// ```
    pub fn new(major: f64, minor: f64) -> Ring {
        Ring { major, minor }
    }

    /// The middle of the tube nearest to a point.
    fn core(&self, p: DVec3) -> DVec3 {
        p.with_z(0.0).try_normalize().unwrap_or(DVec3::X) * self.major
    }
}

impl Field for Ring {
    fn distance(&self, p: DVec3) -> f64 {
        p.distance(self.core(p)) - self.minor
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        let core = self.core(p);
        core + (p - core).try_normalize().unwrap_or(DVec3::Z) * self.minor
    }

    fn extent(&self) -> Bounds {
        let reach = DVec3::new(self.major, self.major, 0.0) + self.minor;
        Bounds { min: -reach, max: reach }
    }

    fn localize<'a>(&'a self, _: &Bounds) -> Box<dyn Field + 'a> {
        Box::new(Same(self))
    }
}
