//! The lattice on which the octree stands: a brick of cells, none more than twice as long as it is wide.

use glam::DVec3;

use crate::geom::Bounds;

/// Levels of the octree; corners have whole coordinates from 0 to 2^20.
pub(super) const LEVELS: u8 = 20;

/// A corner of the lattice.
pub(super) type Corner = [u32; 3];

/// The lattice over a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    min: DVec3,
    max: DVec3,
    /// One step between corners.
    step: DVec3,
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
        let step = size / DVec3::from(ends.map(f64::from));
        Lattice { min: within.min, max: within.max, step, ends }
    }

    /// Where a corner is; the ends of the box exactly.
    pub fn point(&self, corner: Corner) -> DVec3 {
        let along = |a: usize| match corner[a] == self.ends[a] {
            true => self.max[a],
            false => self.min[a] + f64::from(corner[a]) * self.step[a],
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

    /// Half the diagonal of a cell.
    pub fn reach(&self, level: u8) -> f64 {
        (self.step * f64::from(edge(level))).length() / 2.0
    }

    /// The finest coordinates of the cell around a point.
    pub fn corner_below(&self, p: DVec3) -> Corner {
        let scaled = ((p - self.min) / self.step).to_array();
        [0, 1, 2].map(|a| (scaled[a].max(0.0) as u32).min(self.ends[a] - 1))
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
