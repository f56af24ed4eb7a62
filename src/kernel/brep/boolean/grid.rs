//! A coarse grid that tells quickly which boxes may meet any of many others.

use super::hierarchy::Bounds;

/// Cells along each axis of a grid: the bits of a word.
const CELLS: usize = 64;

/// Cells per length, times this power of two.
const SHIFT: u32 = 32;

/// A box in cells, some of which are marked.
pub(super) struct Grid {
    bounds: Bounds,
    scale: [u64; 3],
    /// Marks along x, for each z and y.
    rows: Vec<u64>,
}

impl Grid {
    /// A grid over a box, without marks.
    pub fn new(bounds: Bounds) -> Grid {
        let size =
            |i: usize| (i64::from(bounds.max[i]) - i64::from(bounds.min[i]) + 1).max(1) as u64;
        let scale = std::array::from_fn(|i| ((CELLS as u64) << SHIFT) / size(i));
        Grid { bounds, scale, rows: vec![0; CELLS * CELLS] }
    }

    /// The cell of a coordinate; never decreases with it, so boxes that meet share a cell.
    #[inline]
    fn cell(&self, axis: usize, coordinate: i32) -> usize {
        let (low, high) = (self.bounds.min[axis], self.bounds.max[axis]);
        let from = i64::from(coordinate.min(high).max(low)) - i64::from(low);
        ((from as u64 * self.scale[axis]) >> SHIFT) as usize
    }

    /// The cells that a box meets: z, y, and the bits along x.
    #[inline]
    fn cells(&self, bounds: &Bounds) -> ([usize; 2], [usize; 2], u64) {
        let [x, y, z] =
            [0, 1, 2].map(|i| [self.cell(i, bounds.min[i]), self.cell(i, bounds.max[i])]);
        (z, y, (u64::MAX >> (CELLS - 1 - (x[1] - x[0]))) << x[0])
    }

    /// Marks the cells that a box meets.
    pub fn mark(&mut self, bounds: &Bounds) {
        let (z, y, bits) = self.cells(bounds);
        for z in z[0]..=z[1] {
            self.rows[z * CELLS..][y[0]..=y[1]].iter_mut().for_each(|row| *row |= bits);
        }
    }

    /// Whether a box meets a marked cell.
    pub fn meets(&self, bounds: &Bounds) -> bool {
        let (z, y, bits) = self.cells(bounds);
        (z[0]..=z[1]).any(|z| self.rows[z * CELLS..][y[0]..=y[1]].iter().any(|row| row & bits != 0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_that_meet_share_a_cell() {
        let cube = |low: i32, high: i32| Bounds { min: [low; 3], max: [high; 3] };
        let mut grid = Grid::new(cube(-1000, 1000));
        grid.mark(&cube(-2000, -500));
        assert!(grid.meets(&cube(-500, 900)));
        assert!(!grid.meets(&cube(-400, 2000)));
    }
}
