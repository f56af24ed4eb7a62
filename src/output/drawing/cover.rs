//! Lines that are known by facets alone and run along other lines are drawn once: the most important class wins (ISO 128).
//!
//! Both sides of a symmetric body have the same outline, and so have all turns of a thread; traced over different facets
//! they differ by less than a pen tells. Where a line is so near to a line of its class or a more important one, and runs
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
#[derive(Clone, Copy, Debug)]
struct Chord {
    ends: [DVec2; 2],
    class: Class,
}

/// Lines that are drawn, in cells.
struct Cover {
    /// The largest distance that is asked for, mm.
    near: f64,
    cell: f64,
    chords: Vec<Chord>,
    cells: FxHashMap<[i64; 2], Vec<u32>>,
    /// Places along the line at hand that are covered.
    covered: Vec<[f64; 2]>,
}

/// The lines as far as they are farther from each other, and from the lines that are `drawn`, than the distance that comes
/// with each, mm.
pub fn uncovered(mut lines: Vec<(Drawn, f64)>, drawn: &[Drawn]) -> Vec<Drawn> {
    let Some(near) = lines.iter().map(|line| line.1).reduce(f64::max) else { return vec![] };
    let mut cover = Cover::new(lines.iter().map(|l| &l.0).chain(drawn), near);
    for (path, mark) in drawn {
        for (start, segment) in path.pieces() {
            let chords = cover.chords(start, segment, near);
            chords.into_iter().for_each(|(_, ends)| cover.add(Chord { ends, class: mark.class }));
        }
    }
    // Longer lines first: they stay whole.
    let mut order: Vec<(usize, f64)> =
        lines.iter().map(|((path, _), _)| path.length()).enumerate().collect();
    order.sort_by(|&(i, a), &(k, b)| {
        let marks = [i, k].map(|i| lines[i].0.1);
        marks[0].cmp(&marks[1]).then(b.total_cmp(&a))
    });
    let mut out = vec![];
    for (i, _) in order {
        let ((path, mark), near) = &mut lines[i];
        cover.keep(path, mark.class, *near, |kept| out.push((kept, *mark)));
    }
    out
}

impl Cover {
    fn new<'a>(lines: impl Iterator<Item = &'a Drawn>, near: f64) -> Cover {
        let ends = lines.flat_map(|(path, _)| [path.start, path.end()]);
        let (min, max) = ends.fold((DVec2::MAX, DVec2::MIN), |(a, b), p| (a.min(p), b.max(p)));
        let cell = ((max - min).max_element() / CELLS).max(8.0 * near);
        Cover { near, cell, chords: vec![], cells: FxHashMap::default(), covered: vec![] }
    }

    /// The chords of a segment with their places on it, as near to it as lines that are `near` to each other ask for.
    fn chords(&self, start: DVec2, segment: &Segment, near: f64) -> Vec<([f64; 2], [DVec2; 2])> {
        let count = match segment {
            Segment::Line { .. } => 1.0,
            _ => {
                let [p, q] = [0.0, 1.0].map(|t| segment.at(start, t));
                let off = [0.25, 0.5, 0.75].map(|t| segment.at(start, t).distance(p.lerp(q, t)));
                let off = off.into_iter().fold(0.0, f64::max);
                let wanted = (off / (near * CHORDS)).sqrt().max(p.distance(q) / self.cell);
                wanted.ceil().clamp(FEWEST, MOST)
            }
        };
        let ends = (0..count as u32).map(|i| [i, i + 1].map(|k| f64::from(k) / count));
        ends.map(|ends| (ends, ends.map(|t| segment.at(start, t)))).collect()
    }

    /// Calls with the cells that are no farther than `near` from a line, and a few others.
    fn each_cell(&self, [p, q]: [DVec2; 2], near: f64, mut found: impl FnMut([i64; 2])) {
        let place = |p: DVec2| [p.x, p.y].map(|x| (x / self.cell).floor() as i64);
        let count = (p.distance(q) / self.cell).ceil().max(1.0);
        for i in 0..count as u32 {
            let [a, b] = [i, i + 1].map(|k| p.lerp(q, f64::from(k) / count));
            let [low, high] = [place(a.min(b) - near), place(a.max(b) + near)];
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    found([x, y]);
                }
            }
        }
    }

    fn add(&mut self, chord: Chord) {
        let number = self.chords.len() as u32;
        let mut cells = std::mem::take(&mut self.cells);
        self.each_cell(chord.ends, self.near, |cell| {
            let list = cells.entry(cell).or_default();
            if list.last() != Some(&number) {
                list.push(number);
            }
        });
        self.cells = cells;
        self.chords.push(chord);
    }

    /// Finds the places 0 to 1 of a line of a class that run along lines of that class or a more important one.
    fn find(&mut self, ends: [DVec2; 2], class: Class, near: f64) {
        let mut covered = std::mem::take(&mut self.covered);
        covered.clear();
        self.each_cell(ends, 0.0, |cell| {
            let list = self.cells.get(&cell).into_iter().flatten();
            let chords = list.map(|&i| &self.chords[i as usize]).filter(|c| c.class <= class);
            covered.extend(chords.filter_map(|chord| along(ends, chord.ends, near)));
        });
        covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
        self.covered = covered;
    }

    /// Calls with the parts of a path that are not covered, and covers them for what comes after.
    fn keep(&mut self, path: &Path, class: Class, near: f64, mut found: impl FnMut(Path)) {
        let mut free: Vec<[f64; 2]> = vec![];
        let mut waiting: Vec<Chord> = vec![];
        for (i, (start, segment)) in path.pieces().enumerate() {
            for ([s, t], ends) in self.chords(start, segment, near) {
                self.find(ends, class, near);
                let mut at = 0.0;
                let place = |x: f64| i as f64 + if x == 1.0 { t } else { s + (t - s) * x };
                for &[from, to] in self.covered.iter().chain([&[1.0, 1.0]]) {
                    if from > at {
                        lengthen(&mut free, [place(at), place(from)]);
                        let [p, q] = [at, from].map(|x| ends[0].lerp(ends[1], x));
                        waiting.push(Chord { ends: [p, q], class });
                    }
                    at = at.max(to);
                }
                self.settle(&mut waiting, ends[1]);
            }
        }
        waiting.into_iter().for_each(|chord| self.add(chord));
        let whole = [0.0, path.segments.len() as f64];
        for part in free {
            let kept = cut(path, part);
            if part == whole || kept.length() > near {
                found(kept);
            }
        }
    }

    /// Adds the chords that are far enough before a place.
    fn settle(&mut self, waiting: &mut Vec<Chord>, at: DVec2) {
        let far = |chord: &Chord| chord.ends[1].distance(at) > FURTHER * self.near;
        let count = waiting.iter().take_while(|chord| far(chord)).count();
        let ready: Vec<Chord> = waiting.drain(..count).collect();
        ready.into_iter().for_each(|chord| self.add(chord));
    }
}

/// The places 0 to 1 of a line that are no farther than `near` from another one that runs the same way. Lines shorter than
/// that have no way of their own.
fn along([p, q]: [DVec2; 2], [a, b]: [DVec2; 2], near: f64) -> Option<[f64; 2]> {
    let (length, other) = (p.distance(q), a.distance(b));
    if length <= near {
        let is_on = |at: DVec2| distance(at, [a, b]) <= near;
        return (is_on(p) && is_on(q)).then_some([0.0, 1.0]);
    }
    let way = (q - p) / length;
    let [h, k] = [a, b].map(|c| way.perp_dot(c - p));
    if other > near && (k - h).abs() > PARALLEL * other {
        return None;
    }
    let reach = |height: f64| ((height - h) / (k - h)).clamp(0.0, 1.0);
    let part = match k - h {
        0.0 if h.abs() > near => return None,
        0.0 => [0.0, 1.0],
        _ => [reach(-near), reach(near)],
    };
    let [s, t] = part.map(|x| way.dot(a.lerp(b, x) - p) / length);
    let (from, to) = (s.min(t).max(0.0), s.max(t).min(1.0));
    (from < to && part[0] != part[1]).then_some([from, to])
}

/// The distance of a point from a chord.
fn distance(at: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let way = b - a;
    let t = (at - a).dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
    at.distance(a.lerp(b, t.clamp(0.0, 1.0)))
}

/// Adds a part of a path to the parts before it.
fn lengthen(parts: &mut Vec<[f64; 2]>, [from, to]: [f64; 2]) {
    match parts.last_mut() {
        Some(last) if last[1] == from => last[1] = to,
        _ => parts.push([from, to]),
    }
}

/// The part of a path between two places, each the number of a segment and a place on it.
fn cut(path: &Path, [from, to]: [f64; 2]) -> Path {
    let (mut begin, mut segments) = (path.start, vec![]);
    for (i, (start, segment)) in path.pieces().enumerate() {
        let [s, t] = [from, to].map(|at| (at - i as f64).clamp(0.0, 1.0));
        if s >= t {
            continue;
        }
        let (start, part) =
            if [s, t] == [0.0, 1.0] { (start, *segment) } else { segment.part(start, s, t) };
        if segments.is_empty() {
            begin = start;
        }
        segments.push(part);
    }
    Path { start: begin, segments }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::output::drawing::{Kind, merge::Mark};

    #[test]
    fn what_lies_under_a_line_is_left_out() {
        let mark = |class| Mark { class, order: 0, kind: Kind::Contour, id: 0, loose: true };
        let bow = |from: DVec2, to: DVec2| {
            let up = dvec2(0.0, 1e-4);
            let [first, second] = [1.0, 2.0].map(|k| from.lerp(to, k / 3.0) + up);
            Path::of(from, Segment::Cubic { first, second, to })
        };
        let line = Path::of(DVec2::ZERO, Segment::Line { to: dvec2(10.0, 0.0) });
        let drawn = [(line, mark(Class::Visible))];
        let curves = [
            (bow(dvec2(6.0, 0.0), dvec2(14.0, 0.0)), mark(Class::Hidden)),
            (bow(dvec2(13.0, 1e-5), dvec2(18.0, 0.0)), mark(Class::Hidden)),
            (bow(dvec2(5.0, -2.0), dvec2(5.0, 2.0)), mark(Class::Visible)),
        ];
        let kept = uncovered(curves.map(|line| (line, 1e-3)).to_vec(), &drawn);
        let length = |class| -> f64 {
            kept.iter().filter(|k| k.1.class == class).map(|k| k.0.length()).sum()
        };
        assert!((length(Class::Visible) - 4.0).abs() < 1e-3);
        assert!((length(Class::Hidden) - 8.0).abs() < 0.3, "{}", length(Class::Hidden));
    }
}
