//! Boxes along the axes.

use glam::DVec3;

use super::{Field, Same};
use crate::geom::Bounds;

/// A box along the axes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Cuboid {
    bounds: Bounds,
}

impl Cuboid {
    /// The box between its smallest and its largest corner, mm.
    pub fn new(min: DVec3, max: DVec3) -> Cuboid {
        Cuboid { bounds: Bounds { min, max } }
    }

    /// Per axis how far a point is beyond the nearer face; negative between the two.
    fn beyond(&self, p: DVec3) -> DVec3 {
        (self.bounds.min - p).max(p - self.bounds.max)
    }
}

impl Field for Cuboid {
    fn distance(&self, p: DVec3) -> f64 {
        let beyond = self.beyond(p);
        beyond.max(DVec3::ZERO).length() + beyond.max_element().min(0.0)
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        let (beyond, Bounds { min, max }) = (self.beyond(p), self.bounds);
        let mut found = p.clamp(min, max);
        if beyond.max_element() <= 0.0 {
            let axis = beyond.max_position();
            found[axis] = if p[axis] - min[axis] <= max[axis] - p[axis] { min } else { max }[axis];
        }
        found
    }

    fn extent(&self) -> Bounds {
        self.bounds
    }

    fn localize<'a>(&'a self, _: &Bounds) -> Box<dyn Field + 'a> {
        Box::new(Same(self))
    }
}
