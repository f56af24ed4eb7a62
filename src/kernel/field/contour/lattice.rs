//! The lattice on which the octree stands: a brick of cells, none more than twice as long as it is wide.
//!
//! Cells are a little smaller at one end of the box than at the other, so that faces of models, which lie at round
//! numbers, seldom lie on faces of cells.

use glam::DVec3;

use crate::geom::Bounds;

/// Levels of the octree; corners have whole coordinates from 0 to 2^20.
pub(super) const LEVELS: u8 = 20;

/// How much the size of cells changes along x, y and z.
const SLANT: DVec3 = DVec3::new(0.031, 0.037, 0.041);

/// A corner of the lattice.
pub(super) type Corner = [u32; 3];

/// The lattice over a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    min: DVec3,
    max: DVec3,
    /// The largest coordinates within the box.
    ends: Corner,
}

impl Lattice {
    /// The lattice over a box with room inside. Along each axis the root covers the box a whole number of
    /// times, a power of two; what is beyond the box stays empty.
    pub fn new(within: &Bounds) -> Lattice {
        let size = within.max - within.min;
        let longest = size.max_element();
        let halvings = |s: f64| libm::round(libm::log2(longest / s)).clamp(0.0, 12.0) as u32;
        let ends = size.to_array().map(|s| 1u32 << (u32::from(LEVELS) - halvings(s)));
        Lattice { min: within.min, max: within.max, ends }
    }

    /// Where a corner is; the ends of the box exactly.
    pub fn point(&self, corner: Corner) -> DVec3 {
        let along = |a: usize| {
            let t = f64::from(corner[a]) / f64::from(self.ends[a]);
            let slanted = t + SLANT[a] * t * (1.0 - t);
            if t == 1.0 { self.max[a] } else { self.min[a] + slanted * (self.max[a] - self.min[a]) }
        };
        DVec3::new(along(0), along(1), along(2))
    }

    /// The box of a cell.
    pub fn bounds(&self, at: Corner, level: u8) -> Bounds {
        let size = edge(level);
        Bounds { min: self.point(at), max: self.point(at.map(|x| x + size)) }
    }

    /// Whether a cell lies beyond the box.
    pub fn is_beyond(&self, at: Corner) -> bool {
        (0..3).any(|a| at[a] >= self.ends[a])
    }

    /// Whether a cell lies within the box.
    pub fn is_within(&self, at: Corner, level: u8) -> bool {
        (0..3).all(|a| at[a] + edge(level) <= self.ends[a])
    }

    /// Whether a corner lies on the faces of the box.
    pub fn is_border(&self, corner: Corner) -> bool {
        (0..3).any(|a| corner[a] == 0 || corner[a] == self.ends[a])
    }

    /// Half the diagonal of the largest cell of a level.
    pub fn reach(&self, level: u8) -> f64 {
        let steps = DVec3::from(self.ends.map(f64::from)) / f64::from(edge(level));
        ((self.max - self.min) * (1.0 + SLANT) / steps).length() / 2.0
    }

    /// The finest coordinates of the cell around a point.
    pub fn corner_below(&self, p: DVec3) -> Corner {
        let share = (p - self.min) / (self.max - self.min);
        [0, 1, 2].map(|a| {
            let slant = SLANT[a];
            let square = (1.0 + slant) * (1.0 + slant) - 4.0 * slant * share[a];
            let t = (1.0 + slant - square.max(0.0).sqrt()) / (2.0 * slant);
            ((t * f64::from(self.ends[a])).max(0.0) as u32).min(self.ends[a] - 1)
        })
    }
}

/// The edge of a cell in steps.
pub(super) fn edge(level: u8) -> u32 {
    1 << (LEVELS - level)
}

/// One number for a corner.
pub(super) fn key(corner: Corner) -> u64 {
    corner.iter().fold(0, |key, &x| key << 21 | u64::from(x))
}
