//! How much of a drawing's lines lies on others: chords in bins, and nothing of the drawing's own code.

use std::collections::BTreeMap;

use glam::DVec2;

/// Chords that are so near to each other and turned by less than this (its sine) are one line, drawn twice; curves cut
/// into other chords differ by that.
const COINCIDENT: f64 = 2e-4;
const PARALLEL: f64 = 0.02;
/// Width of the bins that chords are sorted into, mm.
const BIN: f64 = 0.1;

/// How much of the lines lies on other lines, or on a far part of their own: its length and a place of it, mm, and the
/// length of all.
pub fn overdraw(lines: &[Vec<DVec2>]) -> (f64, DVec2, f64) {
    Chords::of(lines).drawn_twice()
}

/// The chords of all lines, in bins.
struct Chords {
    /// The line of each, its place there, and its ends.
    list: Vec<(usize, usize, [DVec2; 2])>,
    bins: BTreeMap<[i64; 2], Vec<usize>>,
}

impl Chords {
    fn of(lines: &[Vec<DVec2>]) -> Chords {
        let chords = lines.iter().enumerate().flat_map(|(l, line)| {
            line.windows(2).enumerate().map(move |(i, pair)| (l, i, [pair[0], pair[1]]))
        });
        let mut all = Chords { list: chords.collect(), bins: BTreeMap::new() };
        for (number, (_, _, [p, q])) in all.list.iter().enumerate() {
            let [low, high] = [p.min(*q) - COINCIDENT, p.max(*q) + COINCIDENT].map(Chords::bin);
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    all.bins.entry([x, y]).or_default().push(number);
                }
            }
        }
        all
    }

    fn bin(p: DVec2) -> [i64; 2] {
        [p.x, p.y].map(|x| (x / BIN).floor() as i64)
    }

    /// How much of their length lies on other lines, or on a far part of their own, a place of it, and
    /// the length of all.
    fn drawn_twice(&self) -> (f64, DVec2, f64) {
        let (mut all, mut twice, mut place) = (0.0, 0.0, DVec2::ZERO);
        for &(line, i, [p, q]) in &self.list {
            let (middle, length) = (p.midpoint(q), p.distance(q));
            let along = (q - p).normalize_or_zero();
            all += length;
            let over = self.bins.get(&Chords::bin(middle)).is_some_and(|bin| {
                bin.iter().map(|&c| self.list[c]).any(|(other, k, [a, b])| {
                    let apart = other != line || i.abs_diff(k) > 2;
                    let turn = along.perp_dot((b - a).normalize_or_zero()).abs();
                    apart && turn < PARALLEL && distance(middle, [a, b]) < COINCIDENT
                })
            });
            if over {
                (twice, place) = (twice + length / 2.0, middle);
            }
        }
        (twice, place, all)
    }
}

/// The distance of a place from a chord.
pub fn distance(at: DVec2, [p, q]: [DVec2; 2]) -> f64 {
    let along = q - p;
    let t = (at - p).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
    at.distance(p.lerp(q, t.clamp(0.0, 1.0)))
}
