//! Traced curves that run along other lines are drawn once: the most important class wins (ISO 128).
//!
//! Both sides of a symmetric body have the same outline, and so have all turns of a thread; traced over different facets
//! they differ by less than a pen tells. Where a curve is so near to a line of its class or a more important one, and runs
//! the same way, it is left out.

use glam::DVec2;
use rustc_hash::FxHashMap;

use super::{
    drawing::{Class, Path, Segment},
    join::Drawn,
};

/// Lines run the same way when the sine of the angle between them is below this.
const PARALLEL: f64 = 0.1;

/// Chords are this part of the distance off their curve, at most.
const CHORDS: f64 = 0.125;

/// A curve segment is cut into so many chords, at least and at most.
const FEWEST: f64 = 2.0;
const MOST: f64 = 64.0;

/// A curve may cover a part of itself that is so many times the distance further on.
const FURTHER: f64 = 16.0;

/// Cells that the largest line reaches over each way.
const CELLS: f64 = 256.0;

/// A chord: its ends, and how its line is drawn.
type Chord = (DVec2, DVec2, Class);

/// Lines that are drawn, in cells.
struct Cover {
    near: f64,
    cell: f64,
    chords: Vec<Chord>,
    cells: FxHashMap<[i64; 2], Vec<u32>>,
}

/// The curves as far as they are farther than `near` mm from each other and from the lines that are `drawn`.
pub fn uncovered(mut curves: Vec<Drawn>, drawn: &[Drawn], near: f64) -> Vec<Drawn> {
    if curves.is_empty() {
        return curves;
    }
    let mut cover = Cover::new(curves.iter().chain(drawn), near);
    for (path, mark) in drawn {
        for (start, segment) in path.pieces() {
            let chords = cover.chords(start, segment);
            chords.into_iter().for_each(|(_, [p, q])| cover.add((p, q, mark.class)));
        }
    }
    curves.sort_by_key(|(_, mark)| *mark);
    let mut out = vec![];
    for (path, mark) in curves {
        cover.keep(&path, mark.class, |kept| out.push((kept, mark)));
    }
    out
}

impl Cover {
    fn new<'a>(lines: impl Iterator<Item = &'a Drawn>, near: f64) -> Cover {
        let ends = lines.flat_map(|(path, _)| [path.start, path.end()]);
        let (min, max) = ends.fold((DVec2::MAX, DVec2::MIN), |(a, b), p| (a.min(p), b.max(p)));
        let cell = ((max - min).max_element() / CELLS).max(8.0 * near);
        Cover { near, cell, chords: vec![], cells: FxHashMap::default() }
    }

    /// The chords of a segment with their places on it.
    fn chords(&self, start: DVec2, segment: &Segment) -> Vec<([f64; 2], [DVec2; 2])> {
        let count = match segment {
            Segment::Line { .. } => 1.0,
            _ => {
                let [p, q] = [0.0, 1.0].map(|t| segment.at(start, t));
                let off = [0.25, 0.5, 0.75].map(|t| segment.at(start, t).distance(p.lerp(q, t)));
                let off = off.into_iter().fold(0.0, f64::max);
                let wanted = (off / (self.near * CHORDS)).sqrt().max(p.distance(q) / self.cell);
                wanted.ceil().clamp(FEWEST, MOST)
            }
        };
        let ends = (0..count as u32).map(|i| [i, i + 1].map(|k| f64::from(k) / count));
        ends.map(|ends| (ends, ends.map(|t| segment.at(start, t)))).collect()
    }

    fn place(&self, p: DVec2) -> [i64; 2] {
        [p.x, p.y].map(|x| (x / self.cell).floor() as i64)
    }

    /// Adds a chord, in parts of a cell's size.
    fn add(&mut self, (p, q, class): Chord) {
        let count = (p.distance(q) / self.cell).ceil().max(1.0);
        for i in 0..count as u32 {
            let [a, b] = [i, i + 1].map(|k| p.lerp(q, f64::from(k) / count));
            let [low, high] = [a.min(b) - self.near, a.max(b) + self.near].map(|p| self.place(p));
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    self.cells.entry([x, y]).or_default().push(self.chords.len() as u32);
                }
            }
            self.chords.push((a, b, class));
        }
    }

    /// Whether a point of a line with a direction is on a line of its class or a more important one.
    fn is_on(&self, at: DVec2, along: DVec2, class: Class) -> bool {
        let Some(cell) = self.cells.get(&self.place(at)) else { return false };
        cell.iter().map(|&i| self.chords[i as usize]).any(|(p, q, other)| {
            let way = q - p;
            let t =
                ((at - p).dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            other <= class
                && at.distance(p.lerp(q, t)) <= self.near
                && way.normalize_or_zero().perp_dot(along).abs() < PARALLEL
        })
    }

    /// Calls with the parts of a path that are not covered, and covers them for what comes after.
    fn keep(&mut self, path: &Path, class: Class, mut found: impl FnMut(Path)) {
        let mut kept: Option<Path> = None;
        let mut waiting: Vec<Chord> = vec![];
        for (start, segment) in path.pieces() {
            let mut from = None;
            for ([s, t], [p, q]) in self.chords(start, segment) {
                let along = (q - p).normalize_or_zero();
                let covered = [p, p.midpoint(q), q].iter().all(|at| self.is_on(*at, along, class));
                if covered {
                    from.take()
                        .into_iter()
                        .for_each(|f| lengthen(&mut kept, start, segment, [f, s]));
                    kept.take().into_iter().for_each(&mut found);
                } else {
                    from = from.or(Some(s));
                    waiting.push((p, q, class));
                    self.settle(&mut waiting, q);
                }
                if t == 1.0 {
                    from.take()
                        .into_iter()
                        .for_each(|f| lengthen(&mut kept, start, segment, [f, t]));
                }
            }
        }
        kept.into_iter().for_each(found);
        waiting.into_iter().for_each(|chord| self.add(chord));
    }

    /// Adds the chords that are far enough before a place.
    fn settle(&mut self, waiting: &mut Vec<Chord>, at: DVec2) {
        let far = |chord: &Chord| chord.1.distance(at) > FURTHER * self.near;
        let count = waiting.iter().take_while(|chord| far(chord)).count();
        let ready: Vec<Chord> = waiting.drain(..count).collect();
        ready.into_iter().for_each(|chord| self.add(chord));
    }
}

/// Appends a part of a segment to a path, or begins one.
fn lengthen(path: &mut Option<Path>, start: DVec2, segment: &Segment, [from, to]: [f64; 2]) {
    let whole = [from, to] == [0.0, 1.0];
    let (start, segment) = if whole { (start, *segment) } else { segment.part(start, from, to) };
    match path {
        Some(path) => path.segments.push(segment),
        None => *path = Some(Path::of(start, segment)),
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::output::drawing::{Kind, merge::Mark};

    #[test]
    fn what_lies_under_a_line_is_left_out() {
        let mark = |class| Mark { class, order: 0, kind: Kind::Contour, id: 0 };
        let bow = |from: DVec2, to: DVec2| {
            let up = dvec2(0.0, 1e-4);
            let [first, second] = [1.0, 2.0].map(|k| from.lerp(to, k / 3.0) + up);
            Path::of(from, Segment::Cubic { first, second, to })
        };
        let line = Path::of(DVec2::ZERO, Segment::Line { to: dvec2(10.0, 0.0) });
        let drawn = [(line, mark(Class::Visible))];
        let curves = vec![
            (bow(dvec2(6.0, 0.0), dvec2(14.0, 0.0)), mark(Class::Hidden)),
            (bow(dvec2(13.0, 1e-5), dvec2(18.0, 0.0)), mark(Class::Hidden)),
            (bow(dvec2(5.0, -2.0), dvec2(5.0, 2.0)), mark(Class::Visible)),
        ];
        let kept = uncovered(curves, &drawn, 1e-3);
        let length = |class| -> f64 {
            kept.iter().filter(|k| k.1.class == class).map(|k| k.0.length()).sum()
        };
        assert!((length(Class::Visible) - 4.0).abs() < 1e-3);
        assert!((length(Class::Hidden) - 8.0).abs() < 0.3, "{}", length(Class::Hidden));
    }
}
