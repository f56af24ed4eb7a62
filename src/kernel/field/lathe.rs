//! Cylinders and cones.

use glam::{DVec2, DVec3, dvec2};

use super::{Field, Same, outline::Outline};
use crate::geom::Bounds;

/// A cone or cylinder that stands on z = 0 about the z axis.
#[derive(Clone, PartialEq, Debug)]
pub struct Lathe {
    /// Its section through the axis, both halves.
    section: Outline,
    extent: Bounds,
}

impl Lathe {
    /// A cone with radius `r1` at z = 0 and `r2` at z = `h`, mm; one of the radii may be 0.
    ///
    /// ```
    /// use glam::dvec3;
    /// use katachi::kernel::field::{Field, Lathe};
    /// let drum = Lathe::new(5.0, 5.0, 10.0);
    /// assert_eq!(drum.distance(dvec3(0.0, 8.0, 14.0)), 5.0);
    /// assert_eq!(drum.distance(dvec3(0.0, 4.0, 5.0)), -1.0);
    /// ```
    pub fn new(r1: f64, r2: f64, h: f64) -> Lathe {
        let corners = [dvec2(-r1, 0.0), dvec2(r1, 0.0), dvec2(r2, h), dvec2(-r2, h)];
        let edges = (0..4).map(|i| [corners[i], corners[(i + 1) % 4]]);
        let section = Outline::new(edges.filter(|[a, b]| a != b).collect());
        let wide = r1.max(r2);
        let extent = Bounds { min: DVec3::new(-wide, -wide, 0.0), max: DVec3::new(wide, wide, h) };
        Lathe { section, extent }
    }

    /// A point in the half plane of its section.
    fn flat(p: DVec3) -> DVec2 {
        dvec2(p.truncate().length(), p.z)
    }
}

impl Field for Lathe {
    fn distance(&self, p: DVec3) -> f64 {
        self.section.nearest(Lathe::flat(p)).0
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        let (_, foot) = self.section.nearest(Lathe::flat(p));
        let out = p.truncate().try_normalize().unwrap_or(DVec2::X);
        (out * foot.x).extend(foot.y)
    }

    fn extent(&self) -> Bounds {
        self.extent
    }

    fn localize<'a>(&'a self, _: &Bounds) -> Box<dyn Field + 'a> {
        Box::new(Same(self))
    }
}
