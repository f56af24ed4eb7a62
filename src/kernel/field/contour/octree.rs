//! The octree: cells are halved until each is clear of the surface or holds one sheet of it.

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::{
    ContourError, Level, Look,
    lattice::{Corner, Lattice, edge, key},
};
use crate::geom::Bounds;

/// Cells that an octree may have: about 2 GB with the triangles that those at the surface remember.
pub(super) const CELLS: usize = 4_000_000;
/// Cells along the longest side before the surface is looked at.
const START: u8 = 3;

/// A cell. The children of a cell have consecutive numbers, along x first.
#[derive(Clone, Debug)]
pub(super) struct Cell<L> {
    pub at: Corner,
    pub level: u8,
    /// The first child; 0 for a leaf.
    pub children: u32,
    pub look: Look,
    /// The level that answers for its points.
    pub field: L,
}

/// Cells, the root first, and the values at the corners of leaves.
#[derive(Debug)]
pub(super) struct Octree<L> {
    pub lattice: Lattice,
    pub cells: Vec<Cell<L>>,
    values: FxHashMap<u64, f64>,
    /// The level of the whole, which stands in where a cell needs none of its own.
    whole: L,
    /// The level beyond which nothing is sought.
    finest: u8,
    tolerance: f64,
}

impl<L: Level> Octree<L> {
    pub fn new(field: L, within: &Bounds, tolerance: f64) -> Result<Octree<L>, ContourError> {
        let lattice = Lattice::new(within);
        let seen = (0..=super::lattice::LEVELS).find(|&l| lattice.reach(l) <= tolerance);
        let Some(finest) = seen else {
            let least = lattice.reach(super::lattice::LEVELS);
            return Err(ContourError::too_fine(CELLS as f64 * least / tolerance, tolerance, least));
        };
        let (whole, values) = (field.clone(), FxHashMap::default());
        let root = Cell { at: [0; 3], level: 0, children: 0, look: Look::Unknown, field };
        let mut tree = Octree { lattice, cells: vec![root], values, whole, finest, tolerance };
        tree.grow(vec![0])?;
        Ok(tree)
    }

    /// The value at a corner of a leaf; outside of the box it is infinite.
    pub fn value(&self, corner: Corner) -> f64 {
        self.values.get(&key(corner)).copied().unwrap_or(f64::INFINITY)
    }

    pub fn bounds(&self, cell: u32) -> Bounds {
        let cell = &self.cells[cell as usize];
        self.lattice.bounds(cell.at, cell.level)
    }

    /// Whether a cell may be halved for accuracy's sake.
    pub fn may_split(&self, cell: u32) -> bool {
        self.cells[cell as usize].level < self.finest
    }

    /// Halves cells, and what comes of them until the surface is told apart. Cells that are halved already are
    /// left alone.
    pub fn split(&mut self, cells: impl IntoIterator<Item = u32>) -> Result<(), ContourError> {
        let leaves: Vec<u32> =
            cells.into_iter().filter(|&c| self.cells[c as usize].children == 0).collect();
        let made = self.halve(&leaves)?;
        self.grow(made)
    }

    /// Halves what must be halved among some leaves, wave by wave.
    fn grow(&mut self, mut wave: Vec<u32>) -> Result<(), ContourError> {
        loop {
            self.evaluate(&wave)?;
            let coarse: Vec<u32> = wave.into_iter().filter(|&c| self.is_coarse(c)).collect();
            if coarse.is_empty() {
                return Ok(());
            }
            self.check_room(&coarse)?;
            wave = self.halve(&coarse)?;
        }
    }

    fn is_coarse(&self, cell: u32) -> bool {
        let cell = &self.cells[cell as usize];
        if self.lattice.is_beyond(cell.at) || cell.look == Look::Clear {
            return false;
        }
        let partly = !self.lattice.is_within(cell.at, cell.level);
        partly || cell.level < START || (cell.look == Look::Unknown && cell.level < self.finest)
    }

    /// Stops before there are too many cells. Cells along a surface become four times as many with each halving.
    fn check_room(&self, coarse: &[u32]) -> Result<(), ContourError> {
        if self.cells.len() + 8 * coarse.len() <= CELLS {
            return Ok(());
        }
        let level = coarse.iter().map(|&c| self.cells[c as usize].level).min().unwrap_or(0);
        let ahead = f64::from(1u32 << (2 * (self.finest - level.min(self.finest)).min(15)));
        let found = (self.cells.len() + 8 * coarse.len()) as f64 * ahead;
        let fitting = self.tolerance * (found / CELLS as f64).sqrt();
        Err(ContourError::too_fine(found, self.tolerance, fitting))
    }

    fn halve(&mut self, cells: &[u32]) -> Result<Vec<u32>, ContourError> {
        self.check_room(cells)?;
        let lattice = self.lattice;
        let child = |&(cell, k): &(u32, u32)| {
            let parent = &self.cells[cell as usize];
            let half = edge(parent.level + 1);
            let at = [0, 1, 2].map(|a| parent.at[a] + (k >> a & 1) * half);
            let level = parent.level + 1;
            if lattice.is_beyond(at) {
                let field = self.whole.clone();
                return Cell { at, level, children: 0, look: Look::Clear, field };
            }
            let bounds = lattice.bounds(at, level);
            let field = parent.field.within(&bounds);
            let look = field.look(&bounds);
            let field = if look == Look::Clear { self.whole.clone() } else { field };
            Cell { at, level, children: 0, look, field }
        };
        let wanted: Vec<(u32, u32)> =
            cells.iter().flat_map(|&c| (0..8).map(move |k| (c, k))).collect();
        let made: Vec<Cell<L>> = wanted.par_iter().map(child).collect();
        let first = self.cells.len() as u32;
        for (i, &cell) in cells.iter().enumerate() {
            self.cells[cell as usize].children = first + 8 * i as u32;
            self.cells[cell as usize].field = self.whole.clone();
        }
        self.cells.extend(made);
        Ok((first..self.cells.len() as u32).collect())
    }

    /// The values at the corners of some cells.
    fn evaluate(&mut self, cells: &[u32]) -> Result<(), ContourError> {
        let mut wanted: Vec<(u64, Corner, u32)> = vec![];
        for &number in cells {
            let cell = &self.cells[number as usize];
            if !self.lattice.is_within(cell.at, cell.level) {
                continue;
            }
            for k in 0..8 {
                let corner = [0, 1, 2].map(|a| cell.at[a] + (k >> a & 1) * edge(cell.level));
                let needed = cell.look != Look::Clear || self.lattice.is_border(corner);
                if needed && !self.values.contains_key(&key(corner)) {
                    wanted.push((key(corner), corner, number));
                }
            }
        }
        wanted.sort_unstable();
        wanted.dedup_by_key(|w| w.0);
        let value = |&(_, corner, cell): &(u64, Corner, u32)| {
            self.cells[cell as usize].field.value(self.lattice.point(corner))
        };
        let values: Vec<f64> = wanted.par_iter().map(value).collect();
        for ((key, corner, _), value) in wanted.into_iter().zip(values) {
            let at = self.lattice.point(corner);
            match value {
                v if v.is_nan() => return Err(ContourError::NotANumber { at }),
                v if v <= 0.0 && self.lattice.is_border(corner) => {
                    return Err(ContourError::Unbounded { at });
                }
                _ => self.values.insert(key, value),
            };
        }
        Ok(())
    }

    /// How far a point is from the surface.
    pub fn off(&self, p: DVec3) -> f64 {
        self.cells[self.leaf(p) as usize].field.off(p)
    }

    /// The leaf around a point.
    pub fn leaf(&self, p: DVec3) -> u32 {
        let at = self.lattice.corner_below(p);
        let mut cell = 0;
        loop {
            let Cell { children, level, .. } = self.cells[cell as usize];
            if children == 0 {
                return cell;
            }
            let half = edge(level + 1);
            let side = |a: usize| u32::from(at[a] & half != 0) << a;
            cell = children + side(0) + side(1) + side(2);
        }
    }
}
