//! Stippling: equal dots, as many as the tone is dark, spread so that they neither clump nor line up.
//!
//! # Source
//! R. Ulichney, *The void-and-cluster method for dither array generation*, 1993: the cells of a square tile are
//! ranked so that those below any rank are spread evenly.

use glam::{DVec2, dvec2};

use super::{
    average::Average,
    dots::lattice,
    ink::{Ink, Mark},
    picture::Frame,
};
use crate::output::drawing::Window;

/// Cells along a side of the tile.
const SIDE: usize = 48;

/// Cells of the tile.
const CELLS: usize = SIDE * SIDE;

/// The part of the cells that the first pattern fills.
const FIRST: usize = CELLS / 10;

/// How far a dot is felt, in cells: the spread of a bell curve, and where it is cut off.
const SPREAD: f64 = 1.5;
const CUT: i64 = 6;

/// The radius of a dot as a part of the pitch: dots in all cells leave hardly any white.
const RADIUS: f64 = 0.66;

/// Dots a pitch in mm apart at least, spread by a seed.
pub(super) fn stipple(tones: &Average, pitch: f64, seed: u64) -> Vec<Mark> {
    let ranks = Tile::ranks(seed);
    let table = coverage(&ranks);
    let window = tones.frame().window;
    let middle = (window.min + window.max) / 2.0;
    let dot = |center: DVec2| {
        let place = ((center - middle) / pitch).round();
        let cell = [place.y, place.x].map(|c| (c as i64).rem_euclid(SIDE as i64) as usize);
        let part = density(&table, 1.0 - tones.at(center, pitch));
        let is_dot = (ranks[cell[0] * SIDE + cell[1]] as f64 + 0.5) / (CELLS as f64) < part;
        is_dot.then_some(Mark::Dot { center, radius: pitch * RADIUS })
    };
    lattice(tones, pitch, 0.0).filter_map(dot).collect()
}

/// The part of the paper that dots in the first 0, 1/32, 2/32 ... of the cells cover.
fn coverage(ranks: &[u32]) -> Vec<f64> {
    const STEPS: usize = 32;
    let window = Window { min: DVec2::ZERO, max: DVec2::splat(SIDE as f64) };
    let frame = Frame { window, size: [SIDE as u32 * 4; 2] };
    let covered = |step: usize| {
        let mut marks = vec![];
        for (cell, _) in ranks.iter().enumerate().filter(|r| *r.1 as usize * STEPS < step * CELLS) {
            let center = dvec2((cell % SIDE) as f64 + 0.5, (cell / SIDE) as f64 + 0.5);
            // The tile goes on beyond its border.
            for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
                let shift = dvec2(f64::from(dx), f64::from(dy)) * SIDE as f64;
                let center = center + shift;
                if center.cmpge(DVec2::NEG_ONE).all() && center.cmple(window.max + 1.0).all() {
                    marks.push(Mark::Dot { center, radius: RADIUS });
                }
            }
        }
        let shares = Ink { frame, marks }.picture().pixels;
        shares.iter().map(|[white, ..]| 1.0 - f64::from(*white)).sum::<f64>() / shares.len() as f64
    };
    (0..=STEPS).map(covered).collect()
}

/// Which part of the cells covers so much.
fn density(table: &[f64], wanted: f64) -> f64 {
    let steps = (table.len() - 1) as f64;
    let above = table.iter().position(|covered| *covered >= wanted).unwrap_or(table.len() - 1);
    if above == 0 {
        return 0.0;
    }
    let (low, high) = (table[above - 1], table[above]);
    let t = if high > low { ((wanted - low) / (high - low)).clamp(0.0, 1.0) } else { 1.0 };
    ((above - 1) as f64 + t) / steps
}

/// A pattern on a tile that goes on at its borders, and how crowded it is at every cell.
struct Tile {
    filled: Vec<bool>,
    crowd: Vec<f64>,
    bell: Vec<(i64, i64, f64)>,
}

impl Tile {
    /// The rank of every cell.
    fn ranks(seed: u64) -> Vec<u32> {
        let mut tile = Tile::first(seed);
        tile.even_out();
        let start = Tile {
            filled: tile.filled.clone(),
            crowd: tile.crowd.clone(),
            bell: tile.bell.clone(),
        };
        let mut ranks = vec![0; CELLS];
        for rank in (0..FIRST).rev() {
            let cell = tile.tightest();
            tile.set(cell, false);
            ranks[cell] = rank as u32;
        }
        let mut tile = start;
        for rank in FIRST..CELLS {
            let cell = tile.emptiest();
            tile.set(cell, true);
            ranks[cell] = rank as u32;
        }
        ranks
    }

    /// A tenth of the cells, anywhere.
    fn first(seed: u64) -> Tile {
        let bell = (-CUT..=CUT).flat_map(|y| (-CUT..=CUT).map(move |x| (x, y)));
        let felt = |(x, y): (i64, i64)| {
            (x, y, libm::exp(-((x * x + y * y) as f64) / (2.0 * SPREAD * SPREAD)))
        };
        let bell = bell.map(felt).collect();
        let mut tile = Tile { filled: vec![false; CELLS], crowd: vec![0.0; CELLS], bell };
        let mut state = seed ^ 0x9E37_79B9_7F4A_7C15;
        let mut count = 0;
        while count < FIRST {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let cell = (state >> 33) as usize % CELLS;
            if !tile.filled[cell] {
                tile.set(cell, true);
                count += 1;
            }
        }
        tile
    }

    /// Moves the most crowded dot to the largest void until it is the same place.
    fn even_out(&mut self) {
        // Each move makes the pattern more even; the limit is far above what that takes.
        for _ in 0..CELLS {
            let from = self.tightest();
            self.set(from, false);
            let to = self.emptiest();
            self.set(to, true);
            if from == to {
                break;
            }
        }
    }

    fn set(&mut self, cell: usize, filled: bool) {
        self.filled[cell] = filled;
        let sign = if filled { 1.0 } else { -1.0 };
        let (x, y) = ((cell % SIDE) as i64, (cell / SIDE) as i64);
        for &(dx, dy, felt) in &self.bell {
            let at = |c: i64| c.rem_euclid(SIDE as i64) as usize;
            self.crowd[at(y + dy) * SIDE + at(x + dx)] += sign * felt;
        }
    }

    fn tightest(&self) -> usize {
        self.extreme(true, |a, b| a > b)
    }

    fn emptiest(&self) -> usize {
        self.extreme(false, |a, b| a < b)
    }

    fn extreme(&self, filled: bool, better: impl Fn(f64, f64) -> bool) -> usize {
        let mut best = None;
        for (cell, &crowd) in self.crowd.iter().enumerate().filter(|c| self.filled[c.0] == filled) {
            if best.is_none_or(|(_, least)| better(crowd, least)) {
                best = Some((cell, crowd));
            }
        }
        best.map_or(0, |(cell, _)| cell)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_has_a_rank_of_its_own_and_the_first_are_apart() {
        let ranks = Tile::ranks(3);
        let mut sorted = ranks.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(i, &rank)| i == rank as usize));
        let place = |rank: usize| {
            let cell = ranks.iter().position(|&r| r as usize == rank).expect("all ranks");
            ((cell % SIDE) as i64, (cell / SIDE) as i64)
        };
        let gap = |a: i64, b: i64| (a - b).abs().min(SIDE as i64 - (a - b).abs());
        let early: Vec<(i64, i64)> = (0..40).map(place).collect();
        for (i, p) in early.iter().enumerate() {
            for q in &early[..i] {
                let (dx, dy) = (gap(p.0, q.0), gap(p.1, q.1));
                assert!(dx * dx + dy * dy >= 9, "{p:?} {q:?}");
            }
        }
    }
}
