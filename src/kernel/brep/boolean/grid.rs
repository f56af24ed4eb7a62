//! A coarse grid that tells quickly which boxes may meet any of many others.

use super::hierarchy::Bounds;

/// Cells along each axis of a grid: the bits of a word.
const CELLS: usize = 64;

/// A box in cells, some of which are marked.
pub(super) struct Grid {
    bounds: Bounds,
    scale: [f64; 3],
    /// Marks along x, for each z and y.
    rows: Vec<u64>,
}

impl Grid {
    /// A grid over a box, without marks.
    pub fn new(bounds: Bounds) -> Grid {
        let size = |i: usize| f64::from(bounds.max[i]) - f64::from(bounds.min[i]) + 1.0;
        let scale = std::array::from_fn(|i| CELLS as f64 / size(i));
        Grid { bounds, scale, rows: vec![0; CELLS * CELLS] }
    }

    /// The cell of a coordinate; never decreases with it, so boxes that meet share a cell.
    fn cell(&self, axis: usize, coordinate: i32) -> usize {
        let from = f64::from(coordinate) - f64::from(self.bounds.min[axis]);
        ((from * self.scale[axis]) as usize).min(CELLS - 1)
    }

    /// The rows that a box meets, and the bits of its cells in them.
    fn rows(&self, bounds: &Bounds) -> (impl Iterator<Item = usize> + use<>, u64) {
        let [x, y, z] =
            [0, 1, 2].map(|i| [self.cell(i, bounds.min[i]), self.cell(i, bounds.max[i])]);
        let bits = (u64::MAX >> (CELLS - 1 - (x[1] - x[0]))) << x[0];
        ((z[0]..=z[1]).flat_map(move |z| (y[0]..=y[1]).map(move |y| z * CELLS + y)), bits)
    }

    /// Marks the cells that a box meets.
    pub fn mark(&mut self, bounds: &Bounds) {
        let (rows, bits) = self.rows(bounds);
        rows.for_each(|row| self.rows[row] |= bits);
    }

    /// Whether a box meets a marked cell.
    pub fn meets(&self, bounds: &Bounds) -> bool {
        let (mut rows, bits) = self.rows(bounds);
        rows.any(|row| self.rows[row] & bits != 0)
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
