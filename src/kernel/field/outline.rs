//! Plane polygons by distance, and the prisms over them.

use glam::{DVec2, DVec3};

use super::{Field, Same, half_diagonal};
use crate::geom::{Bounds, Region};

/// Straight edges of closed contours, the inside to their left.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Outline {
    edges: Vec<[DVec2; 2]>,
}

impl Outline {
    pub fn new(edges: Vec<[DVec2; 2]>) -> Outline {
        Outline { edges }
    }

    /// The signed distance of a point, and the nearest point.
    pub fn nearest(&self, p: DVec2) -> (f64, DVec2) {
        let (mut best, mut found, mut inside) = (f64::INFINITY, p, false);
        for &[a, b] in &self.edges {
            let q = on_edge(a, b, p);
            if q.distance_squared(p) < best {
                (best, found) = (q.distance_squared(p), q);
            }
            let level = (a.y <= p.y) != (b.y <= p.y);
            inside ^= level && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
        }
        (if inside { -best.sqrt() } else { best.sqrt() }, found)
    }

    fn edges_near(&self, p: DVec2, reach: f64) -> bool {
        self.edges.iter().any(|&[a, b]| on_edge(a, b, p).distance(p) <= reach)
    }
}

fn on_edge(a: DVec2, b: DVec2, p: DVec2) -> DVec2 {
    let along = b - a;
    a + along * ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0)
}

/// A polygon with holes, extruded from z = 0.
#[derive(Clone, PartialEq, Debug)]
pub struct Prism {
    outline: Outline,
    height: f64,
    extent: Bounds,
}

impl Prism {
    /// The prism over a region from z = 0 to `height` mm. Curves of the region count as their chords.
    ///
    /// ```
    /// use glam::{dvec2, dvec3};
    /// use katachi::kernel::{field::{Field, Prism}, profile::rect};
    /// let block = Prism::new(&rect(dvec2(4.0, 6.0)).unwrap(), 5.0);
    /// assert_eq!(block.distance(dvec3(5.0, 0.0, 9.0)), 5.0);
    /// assert_eq!(block.distance(dvec3(1.0, 0.0, 2.5)), -1.0);
    /// ```
    pub fn new(region: &Region, height: f64) -> Prism {
        let edges = region.contours().flat_map(|c| c.edges()).map(|e| [e.from, e.to]);
        let edges: Vec<[DVec2; 2]> = edges.filter(|[a, b]| a != b).collect();
        let flat = Bounds::of(edges.iter().map(|e| e[0].extend(0.0)));
        let extent = Bounds { min: flat.min, max: flat.max.with_z(height) };
        Prism { outline: Outline::new(edges), height, extent }
    }

    /// How far a height is above or below the slab, and its nearer end.
    fn slab(&self, z: f64) -> (f64, f64) {
        if z < self.height / 2.0 { (-z, 0.0) } else { (z - self.height, self.height) }
    }
}

impl Field for Prism {
    fn distance(&self, p: DVec3) -> f64 {
        let (across, _) = self.outline.nearest(p.truncate());
        let (along, _) = self.slab(p.z);
        DVec2::new(across, along).max(DVec2::ZERO).length() + across.max(along).min(0.0)
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        let (across, foot) = self.outline.nearest(p.truncate());
        let (along, end) = self.slab(p.z);
        match (across > 0.0, along > 0.0) {
            (true, _) => foot.extend(p.z.clamp(0.0, self.height)),
            (false, true) => p.with_z(end),
            (false, false) if across >= along => foot.extend(p.z),
            (false, false) => p.with_z(end),
        }
    }

    fn extent(&self) -> Bounds {
        self.extent
    }

    fn localize<'a>(&'a self, cell: &Bounds) -> Box<dyn Field + 'a> {
        let (middle, reach) = (cell.center(), half_diagonal(cell));
        let (across, _) = self.outline.nearest(middle.truncate());
        let near = across.abs() + 2.0 * reach;
        if !self.outline.edges_near(middle.truncate(), near) || across.abs() <= reach {
            return Box::new(Same(self));
        }
        // The outline does not cross the cell, so which side the cell is on is known.
        let edges = self.outline.edges.iter().copied();
        let close = edges
            .filter(|&[a, b]| on_edge(a, b, middle.truncate()).distance(middle.truncate()) <= near);
        Box::new(OneSided { prism: self, edges: close.collect(), side: across.signum() })
    }
}

/// A prism in a cell that its side faces do not cross.
struct OneSided<'a> {
    prism: &'a Prism,
    edges: Vec<[DVec2; 2]>,
    side: f64,
}

impl Field for OneSided<'_> {
    fn distance(&self, p: DVec3) -> f64 {
        let flat = p.truncate();
        let squares = self.edges.iter().map(|&[a, b]| on_edge(a, b, flat).distance_squared(flat));
        let across = self.side * squares.fold(f64::INFINITY, f64::min).sqrt();
        let (along, _) = self.prism.slab(p.z);
        DVec2::new(across, along).max(DVec2::ZERO).length() + across.max(along).min(0.0)
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        self.prism.closest(p)
    }

    fn extent(&self) -> Bounds {
        self.prism.extent
    }

    fn localize<'a>(&'a self, cell: &Bounds) -> Box<dyn Field + 'a> {
        self.prism.localize(cell)
    }
}
