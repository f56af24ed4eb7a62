//! Straight lines that coincide are drawn once: the most important class wins (ISO 128).

use std::cmp::Ordering;

use glam::DVec2;

use super::{drawing::Class, scene::Kind};

/// Directions that differ by more than this are not compared: coincident pieces of a thousandth of the
/// picture's size whose ends are a tolerance off differ by less.
const TURN: f64 = 1e-5;

/// A straight piece of a line, millimetres.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Piece {
    /// Where it begins.
    pub from: DVec2,
    /// Where it ends.
    pub to: DVec2,
    /// How it is drawn and whose it is.
    pub mark: Mark,
}

/// How a line is drawn and whose it is; the smaller is the more important.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Mark {
    /// How it is drawn.
    pub class: Class,
    /// How many front faces are before it.
    pub order: u32,
    /// What it stands for.
    pub kind: Kind,
    /// The body or stroke it belongs to.
    pub id: u32,
    /// Whether it is known no better than chords may be off: see [`super::model::Edge::loose`].
    pub loose: bool,
}

/// A direction as a number in (-1, 1] that grows with its angle, opposite directions alike.
fn slope(d: DVec2) -> f64 {
    let d = if d.x < 0.0 || d.x == 0.0 && d.y < 0.0 { -d } else { d };
    let s = d.y / (d.x + d.y.abs());
    // Downwards and upwards are one direction.
    if s < TURN - 1.0 { s + 2.0 } else { s }
}

/// How near to each other lines coincide.
#[derive(Clone, Debug)]
pub struct Nearness {
    /// Distance, mm.
    pub tolerance: f64,
    /// The larger distance of lines of the bodies `rough`, mm.
    pub loose: f64,
    /// Numbers of bodies whose faces are not exact, in order.
    pub rough: Vec<u32>,
}

impl Nearness {
    /// How near two pieces coincide.
    fn between(&self, a: &Piece, b: &Piece) -> f64 {
        let rough = |p: &Piece| self.rough.binary_search(&p.mark.id).is_ok();
        if !self.rough.is_empty() && rough(a) && rough(b) { self.loose } else { self.tolerance }
    }

    fn most(&self) -> f64 {
        if self.rough.is_empty() { self.tolerance } else { self.loose }
    }
}

/// The pieces without overlaps: pieces that lie on one line, nearly, are cut at each other's
/// ends, the most important is kept of each part, and equal neighbours are joined.
pub fn merged(pieces: &[Piece], tolerance: &Nearness) -> Vec<Piece> {
    let mut order: Vec<(f64, u32)> =
        pieces.iter().zip(0..).map(|(p, i)| (slope(p.to - p.from), i)).collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut out = Vec::with_capacity(pieces.len());
    each_direction(&order, TURN, &mut |parallel| {
        merge_parallel(pieces, parallel, tolerance, &mut out);
    });
    out
}

/// Pieces of so many directions in a row are many lines with little between them, not one line.
const CROWD: usize = 512;

/// Calls with runs of nearly one direction: where the next is farther than `turn`, a run ends; crowds are parted at
/// smaller gaps.
fn each_direction(order: &[(f64, u32)], turn: f64, found: &mut impl FnMut(&[(f64, u32)])) {
    for run in order.chunk_by(|a, b| b.0 - a.0 <= turn) {
        let spread = run[run.len() - 1].0 - run[0].0;
        if run.len() > CROWD && spread > 4.0 * turn {
            each_direction(run, turn / 8.0, found);
        } else {
            found(run);
        }
    }
}

/// Merges pieces of nearly one direction.
fn merge_parallel(
    pieces: &[Piece],
    parallel: &[(f64, u32)],
    tolerance: &Nearness,
    out: &mut Vec<Piece>,
) {
    if let &[(_, only)] = parallel {
        return out.push(pieces[only as usize]);
    }
    let longest = parallel
        .iter()
        .map(|&(_, i)| &pieces[i as usize])
        .max_by(|a, b| length_squared(a).total_cmp(&length_squared(b)))
        .expect("a chunk has a piece");
    let along = (longest.to - longest.from).normalize();
    let spread = |p: &Piece| {
        let [a, b] = [p.from, p.to].map(|q| along.perp_dot(q - longest.from));
        (a.min(b), a.max(b))
    };
    let mut bands: Vec<(f64, f64, u32)> = parallel
        .iter()
        .map(|&(_, i)| {
            let (low, high) = spread(&pieces[i as usize]);
            (low, high, i)
        })
        .collect();
    bands.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
    for group in lines(pieces, &bands, tolerance) {
        merge_line(pieces, &group, out);
    }
}

fn length_squared(p: &Piece) -> f64 {
    p.from.distance_squared(p.to)
}

/// Groups of pieces on one line.
fn lines(pieces: &[Piece], bands: &[(f64, f64, u32)], tolerance: &Nearness) -> Vec<Vec<u32>> {
    let mut group: Vec<usize> = (0..bands.len()).collect();
    for (i, &(_, high, one)) in bands.iter().enumerate() {
        let near = bands[i + 1..].iter().take_while(|b| b.0 <= high + tolerance.most());
        for (k, &(.., other)) in near.enumerate() {
            let (p, q) = (&pieces[one as usize], &pieces[other as usize]);
            if coincide(p, q, tolerance.between(p, q)) {
                let (a, b) = (root(&mut group, i), root(&mut group, i + 1 + k));
                group[a.max(b)] = a.min(b);
            }
        }
    }
    let mut groups: Vec<Vec<u32>> = vec![vec![]; bands.len()];
    for (i, band) in bands.iter().enumerate() {
        groups[root(&mut group, i)].push(band.2);
    }
    groups.retain(|g| !g.is_empty());
    groups
}

fn root(group: &mut [usize], mut i: usize) -> usize {
    while group[i] != i {
        group[i] = group[group[i]];
        i = group[i];
    }
    i
}

/// Whether two pieces touch or overlap on one line.
fn coincide(a: &Piece, b: &Piece, tolerance: f64) -> bool {
    let (long, short) = if length_squared(a) < length_squared(b) { (b, a) } else { (a, b) };
    let along = (long.to - long.from).normalize();
    let [p, q] = [short.from, short.to].map(|p| p - long.from);
    let on = along.perp_dot(p).abs() <= tolerance && along.perp_dot(q).abs() <= tolerance;
    let (s, t) = (along.dot(p), along.dot(q));
    let end = length_squared(long).sqrt();
    on && s.max(t) >= -tolerance && s.min(t) <= end + tolerance
}

/// Merges the pieces of one line.
fn merge_line(pieces: &[Piece], group: &[u32], out: &mut Vec<Piece>) {
    if let &[only] = group {
        return out.push(pieces[only as usize]);
    }
    let longest = group.iter().map(|&i| &pieces[i as usize]).max_by(by_length).expect("not empty");
    let (base, along) = (longest.from, (longest.to - longest.from).normalize());
    let mut events: Vec<(f64, bool, u32)> = vec![];
    for &i in group {
        let [s, t] = [pieces[i as usize].from, pieces[i as usize].to].map(|p| along.dot(p - base));
        events.extend([(s.min(t), false, i), (s.max(t), true, i)]);
    }
    events.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    // Lines end where they ended before, to the bit, so that they go on into others.
    let end = |(_, ends, i): (f64, bool, u32)| {
        let Piece { from, to, .. } = pieces[i as usize];
        if (along.dot(to - from) > 0.0) == ends { to } else { from }
    };
    let mut run = Run { from: base, to: base, best: None };
    let mut active: Vec<u32> = vec![];
    let mut before = (f64::NEG_INFINITY, base);
    for event in events {
        let (at, ends, i) = event;
        if at > before.0 {
            let best = run.best_of(active.iter().map(|&k| &pieces[k as usize]));
            let here = end(event);
            run.go_on(before.1, here, best, out);
            before = (at, here);
        }
        if ends { active.retain(|&k| k != i) } else { active.push(i) }
    }
    run.finish(out);
}

fn by_length(a: &&Piece, b: &&Piece) -> Ordering {
    length_squared(a).total_cmp(&length_squared(b))
}

/// The piece that is being lengthened on a line.
struct Run<'a> {
    from: DVec2,
    to: DVec2,
    best: Option<&'a Piece>,
}

impl<'a> Run<'a> {
    /// The most important piece; of two that are drawn alike, the one that is being lengthened.
    fn best_of(&self, active: impl Iterator<Item = &'a Piece> + Clone) -> Option<&'a Piece> {
        let best = active.clone().min_by_key(|p| p.mark)?;
        let alike = |mark: Mark| (mark.class, mark.order) == (best.mark.class, best.mark.order);
        let goes_on = self.best.filter(|p| alike(p.mark));
        let goes_on = goes_on.and_then(|p| active.into_iter().find(|q| q.mark == p.mark));
        Some(goes_on.unwrap_or(best))
    }

    /// Lengthens the piece up to a place, or begins another one.
    fn go_on(&mut self, from: DVec2, to: DVec2, best: Option<&'a Piece>, out: &mut Vec<Piece>) {
        let same = match (self.best, best) {
            (Some(a), Some(b)) => a.mark == b.mark,
            (None, None) => true,
            _ => false,
        };
        if !same {
            self.finish(out);
            (self.from, self.best) = (from, best);
        }
        self.to = to;
    }

    /// Gives the piece away.
    fn finish(&mut self, out: &mut Vec<Piece>) {
        if let Some(best) = self.best.take() {
            out.push(Piece { from: self.from, to: self.to, ..*best });
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    const NEAR: Nearness = Nearness { tolerance: 1e-9, loose: 1e-6, rough: vec![] };

    fn piece(from: [f64; 2], to: [f64; 2], class: Class) -> Piece {
        let order = u32::from(class == Class::Hidden);
        let mark = Mark { class, order, kind: Kind::Sharp, id: 0, loose: false };
        Piece { from: from.into(), to: to.into(), mark }
    }

    fn length(pieces: &[Piece], class: Class) -> f64 {
        pieces.iter().filter(|p| p.mark.class == class).map(|p| length_squared(p).sqrt()).sum()
    }

    #[test]
    fn the_visible_covers_the_hidden() {
        for up in [dvec2(1.0, 0.0), dvec2(0.0, 1.0), dvec2(0.6, -0.8)] {
            let at = |t: f64| (up * t + dvec2(3.0, 1.0)).to_array();
            let all = [
                piece(at(0.0), at(10.0), Class::Hidden),
                piece(at(6.0), at(2.0), Class::Visible),
                piece(at(5.0), at(7.0), Class::Visible),
                piece(at(-5.0), at(20.0), Class::Centre),
            ];
            let out = merged(&all, &NEAR);
            assert!((length(&out, Class::Visible) - 5.0).abs() < 1e-12);
            assert!((length(&out, Class::Hidden) - 5.0).abs() < 1e-12);
            assert!((length(&out, Class::Centre) - 15.0).abs() < 1e-12);
            assert_eq!(out.len(), 5);
        }
    }

    #[test]
    fn what_is_drawn_alike_stays_whole() {
        let mut all = [0.0, 4.0].map(|x| piece([x, 0.0], [10.0 - x, 0.0], Class::Visible));
        all[0].mark.kind = Kind::Contour;
        let out = merged(&all, &NEAR);
        assert_eq!((out.len(), length(&out, Class::Visible)), (1, 10.0));
    }

    #[test]
    fn parallel_lines_stay_apart() {
        let all = [
            piece([0.0, 0.0], [1.0, 0.0], Class::Visible),
            piece([0.0, 1e-3], [1.0, 1e-3], Class::Visible),
            piece([2.0, 0.0], [3.0, 0.0], Class::Visible),
            piece([1.0, 0.0], [2.0, 1e-12], Class::Visible),
        ];
        let out = merged(&all, &NEAR);
        assert_eq!(out.len(), 2);
        assert!((length(&out, Class::Visible) - 4.0).abs() < 1e-9);
    }
}
