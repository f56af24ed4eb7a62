//! An even grid over the picture: which boxes or segments may meet a segment.

use glam::{DVec2, dvec2};

/// Most cells each way: beyond that, walking them costs more than what they keep apart.
const MOST: f64 = 512.0;
/// Cells an item stands in on average, at most.
const FILLING: f64 = 32.0;
/// Ranges of cells are wider than computed by this part of a cell, far more than their rounding.
const SLACK: f64 = 1e-6;

/// A grid of cells and the items in each.
#[derive(Clone, Debug)]
pub struct Cells {
    min: DVec2,
    /// Cells for each step.
    scale: DVec2,
    size: [i32; 2],
    /// Where each cell's items begin; one more at the end.
    starts: Vec<u32>,
    items: Vec<u32>,
}

/// What stands in a grid.
#[derive(Clone, Copy, Debug)]
pub enum Extent {
    /// Everything between two corners.
    Box(DVec2, DVec2),
    /// A segment.
    Segment(DVec2, DVec2),
}

impl Extent {
    fn corners(self) -> (DVec2, DVec2) {
        match self {
            Extent::Box(min, max) => (min, max),
            Extent::Segment(p, q) => (p.min(q), p.max(q)),
        }
    }
}

impl Cells {
    /// A grid with about one cell an item.
    pub fn new(count: usize, extent: impl Fn(usize) -> Extent) -> Cells {
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut covered = 0.0;
        for i in 0..count {
            let (low, high) = extent(i).corners();
            (min, max) = (min.min(low), max.max(high));
            covered += (high.x - low.x) * (high.y - low.y);
        }
        // Items that cover the picture many times over get few cells, or each would stand in all of them.
        let layers = covered / ((max - min).max(DVec2::ONE).element_product());
        let wanted = (count as f64).min(FILLING * count as f64 / layers.max(1.0));
        let mut cells = Cells::sized(min, max, wanted as usize);
        cells.fill(count, extent);
        cells
    }

    fn sized(min: DVec2, max: DVec2, count: usize) -> Cells {
        let some = min.x <= max.x;
        let extent = if some { (max - min).max(DVec2::ONE) } else { DVec2::ONE };
        let each = (extent.x * extent.y / (count.max(1) as f64)).sqrt();
        let size = (extent / each).ceil().clamp(DVec2::ONE, DVec2::splat(MOST));
        let min = if some { min } else { DVec2::ZERO };
        Cells {
            min,
            scale: size / extent,
            size: [size.x as i32, size.y as i32],
            starts: vec![],
            items: vec![],
        }
    }

    fn fill(&mut self, count: usize, extent: impl Fn(usize) -> Extent) {
        let mut starts = vec![0u32; (self.size[0] * self.size[1]) as usize + 2];
        for i in 0..count {
            self.rows(extent(i), |cells| cells.for_each(|c| starts[c + 2] += 1));
        }
        (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
        let mut items = vec![0; starts[starts.len() - 1] as usize];
        for i in 0..count {
            self.rows(extent(i), |cells| {
                for cell in cells {
                    let place = &mut starts[cell + 1];
                    items[*place as usize] = i as u32;
                    *place += 1;
                }
            });
        }
        starts.pop();
        (self.starts, self.items) = (starts, items);
    }

    fn clamped(&self, place: f64, axis: usize) -> i32 {
        (place as i32).clamp(0, self.size[axis] - 1)
    }

    /// Calls with the runs of cells, row by row, that something covers. What leaves the grid is counted to
    /// its border cells.
    fn rows(&self, extent: Extent, mut found: impl FnMut(std::ops::Range<usize>)) {
        let (p, q) = match extent {
            Extent::Box(p, q) | Extent::Segment(p, q) => {
                ((p - self.min) * self.scale, (q - self.min) * self.scale)
            }
        };
        let (low, high) = if p.y <= q.y { (p, q) } else { (q, p) };
        let first = self.clamped(low.y - SLACK, 1);
        let last = self.clamped(high.y + SLACK, 1);
        let slope = (high.x - low.x) / (high.y - low.y);
        // A level segment on the border of two rows is in both, all along.
        let inclined = matches!(extent, Extent::Segment(..)) && first < last && low.y < high.y;
        for row in first..=last {
            let (a, b) = if inclined {
                let at = |y: f64| low.x + (y.clamp(low.y, high.y) - low.y) * slope;
                (at(f64::from(row) - SLACK), at(f64::from(row + 1) + SLACK))
            } else {
                (low.x, high.x)
            };
            let from = self.clamped(a.min(b) - SLACK, 0);
            let to = self.clamped(a.max(b) + SLACK, 0);
            let base = row * self.size[0];
            found((base + from) as usize..(base + to) as usize + 1);
        }
    }

    /// Calls with the items in the cells that a segment runs through; an item may come more than once.
    #[inline]
    pub fn along(&self, p: DVec2, q: DVec2, mut found: impl FnMut(u32)) {
        self.rows(Extent::Segment(p, q), |cells| {
            let range = self.starts[cells.start] as usize..self.starts[cells.end] as usize;
            self.items[range].iter().for_each(|&i| found(i));
        });
    }

    /// Calls with the items in the cell of a point, each once.
    pub fn at(&self, p: DVec2, mut found: impl FnMut(u32)) {
        let q = (p - self.min) * self.scale;
        let cell = self.clamped(q.y, 1) * self.size[0] + self.clamped(q.x, 0);
        let range = self.starts[cell as usize] as usize..self.starts[cell as usize + 1] as usize;
        self.items[range].iter().for_each(|&i| found(i));
    }
}

/// Lets each item pass once a round.
#[derive(Clone, Debug)]
pub struct Sieve {
    round: u32,
    seen: Vec<u32>,
}

impl Sieve {
    /// A sieve for so many items.
    pub fn new(items: usize) -> Sieve {
        Sieve { round: 0, seen: vec![0; items] }
    }

    /// Starts a round.
    pub fn next_round(&mut self) {
        self.round += 1;
    }

    /// Whether the item comes for the first time this round.
    #[inline]
    pub fn passes(&mut self, item: u32) -> bool {
        let seen = &mut self.seen[item as usize];
        let first = *seen != self.round;
        *seen = self.round;
        first
    }
}

/// The corners of the box around some points.
pub fn around(points: impl Iterator<Item = DVec2>) -> (DVec2, DVec2) {
    points.fold((dvec2(f64::INFINITY, f64::INFINITY), DVec2::NEG_INFINITY), |(min, max), p| {
        (min.min(p), max.max(p))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_finds_every_box_it_meets() {
        let center = |i: usize| dvec2((i % 20) as f64, (i / 20) as f64) * 1000.0;
        let half = DVec2::splat(300.0);
        let cells = Cells::new(400, |i| Extent::Box(center(i) - half, center(i) + half));
        let (p, q) = (dvec2(-200.0, 100.0), dvec2(19_100.0, 12_500.0));
        let mut found = vec![false; 400];
        cells.along(p, q, |i| found[i as usize] = true);
        for (i, found) in found.iter().enumerate() {
            let samples = (0..=4000).map(|k| p.lerp(q, f64::from(k) / 4000.0));
            let met = samples.into_iter().any(|s| (s - center(i)).abs().cmple(half).all());
            assert!(!met || *found, "box {i}");
        }
        assert!(found.iter().filter(|f| **f).count() < 150);
        let mut here = vec![];
        cells.at(center(57), |i| here.push(i));
        assert!(here.contains(&57) && here.len() < 10);
    }

    #[test]
    fn level_segments_on_a_border_of_cells_find_what_is_on_both_sides() {
        let corner = |i: usize| dvec2(0.0, 16.0 * i as f64);
        let cells = Cells::new(64, |i| Extent::Box(corner(i), corner(i) + dvec2(1024.0, 16.0)));
        let border = cells.min.y + 4.0 / cells.scale.y;
        let mut found = vec![];
        cells.along(dvec2(900.0, border), dvec2(1000.0, border), |i| found.push(i));
        let here = (border / 16.0) as u32;
        assert!(found.contains(&here) && found.contains(&(here - 1)), "{here}: {found:?}");
    }

    #[test]
    fn an_empty_grid_has_nothing() {
        let cells = Cells::new(0, |_| Extent::Box(DVec2::ZERO, DVec2::ZERO));
        cells.along(DVec2::ZERO, DVec2::ONE, |_| panic!("nothing is there"));
    }
}
