//! The upper envelope of segments: a polyline with gaps, kept exactly.

use glam::DVec2;

/// A piece of the envelope, from left to right.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Reach {
    from: DVec2,
    to: DVec2,
}

/// A part of a segment that is above the envelope, as parameters in 0..1.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Rise {
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Whether the envelope is below it, rather than nothing.
    pub over_something: bool,
}

/// The highest of all segments raised so far over each place.
#[derive(Clone, Debug, Default)]
pub struct Envelope {
    /// Pieces that do not overlap, from left to right.
    reaches: Vec<Reach>,
    /// Storage kept from one raise to the next.
    spare: Vec<Reach>,
}

/// Heights that differ by less than this part of a picture's coordinates are the same.
const SAME: f64 = 1e-12;

impl Reach {
    fn at(&self, x: f64) -> f64 {
        let width = self.to.x - self.from.x;
        if width == 0.0 {
            return self.from.y.max(self.to.y);
        }
        let t = ((x - self.from.x) / width).clamp(0.0, 1.0);
        self.from.y * (1.0 - t) + self.to.y * t
    }

    /// The part between two places.
    fn part(&self, from: f64, to: f64) -> Reach {
        let end = |x: f64, of: DVec2| if x == of.x { of } else { DVec2::new(x, self.at(x)) };
        Reach { from: end(from, self.from), to: end(to, self.to) }
    }
}

impl Envelope {
    /// The pieces that meet an interval with an inner point.
    fn range(&self, from: f64, to: f64) -> std::ops::Range<usize> {
        let first = self.reaches.partition_point(|r| r.to.x <= from);
        let count = self.reaches[first..].partition_point(|r| r.from.x < to);
        first..first + count
    }

    /// The height over a place from either side; `None` over a gap.
    fn height(&self, x: f64) -> Option<f64> {
        let first = self.reaches.partition_point(|r| r.to.x < x);
        let here = self.reaches[first..].iter().take_while(|r| r.from.x <= x);
        here.map(|r| r.at(x)).reduce(f64::max)
    }

    /// Calls with the parts of a segment above the envelope or over a gap.
    pub fn above(&self, p: DVec2, q: DVec2, mut found: impl FnMut(Rise)) {
        if p.x == q.x {
            return self.above_upright(p, q, found);
        }
        let parameter = |x: f64| ((x - p.x) / (q.x - p.x)).clamp(0.0, 1.0);
        let mut last: Option<(f64, f64, bool)> = None;
        let mut tell = |(from, to, over_something): (f64, f64, bool)| {
            let (s, t) = (parameter(from), parameter(to));
            let (from, to) = if s < t { (s, t) } else { (t, s) };
            if to > from {
                found(Rise { from, to, over_something });
            }
        };
        let mut rise = |from: f64, to: f64, over: bool| match &mut last {
            Some(l) if l.1 == from && l.2 == over => l.1 = to,
            _ => last.replace((from, to, over)).into_iter().for_each(&mut tell),
        };
        let new = sorted(p, q);
        let mut at = new.from.x;
        for old in &self.reaches[self.range(new.from.x, new.to.x)] {
            if old.from.x > at {
                rise(at, old.from.x, false);
            }
            let (low, high) = (old.from.x.max(new.from.x), old.to.x.min(new.to.x));
            if let Some((from, to)) = higher(&new, old, low, high) {
                rise(from, to, true);
            }
            at = high;
        }
        if at < new.to.x {
            rise(at, new.to.x, false);
        }
        last.into_iter().for_each(tell);
    }

    /// The part of an upright segment above the envelope.
    fn above_upright(&self, p: DVec2, q: DVec2, mut found: impl FnMut(Rise)) {
        let Some(height) = self.height(p.x) else {
            return found(Rise { from: 0.0, to: 1.0, over_something: false });
        };
        let t = ((height - p.y) / (q.y - p.y)).clamp(0.0, 1.0);
        let (from, to) = if q.y > p.y { (t, 1.0) } else { (0.0, t) };
        if from < to && p.y.max(q.y) > height + SAME * height.abs() {
            found(Rise { from, to, over_something: true });
        }
    }

    /// Raises the envelope to a segment.
    pub fn raise(&mut self, p: DVec2, q: DVec2) {
        if p.x == q.x {
            return;
        }
        let new = sorted(p, q);
        let range = self.range(new.from.x, new.to.x);
        let mut raised = Raised { new, open: None, pieces: std::mem::take(&mut self.spare) };
        let mut at = new.from.x;
        for old in &self.reaches[range.clone()] {
            if old.from.x > at {
                raised.rise(at, old.from.x);
            }
            let (low, high) = (old.from.x.max(new.from.x), old.to.x.min(new.to.x));
            match higher(&new, old, low, high) {
                Some((from, to)) => {
                    raised.keep(old, old.from.x, from);
                    raised.rise(from, to);
                    raised.keep(old, to, old.to.x);
                }
                None => raised.keep(old, old.from.x, old.to.x),
            }
            at = high;
        }
        if at < new.to.x {
            raised.rise(at, new.to.x);
        }
        raised.close();
        self.reaches.splice(range, raised.pieces.drain(..));
        self.spare = raised.pieces;
    }
}

/// A stretch of the envelope while it is raised.
struct Raised {
    new: Reach,
    /// The part of the new segment that is being lengthened.
    open: Option<(f64, f64)>,
    pieces: Vec<Reach>,
}

impl Raised {
    /// Keeps a part of an old piece.
    fn keep(&mut self, old: &Reach, from: f64, to: f64) {
        if from < to {
            self.close();
            self.pieces.push(old.part(from, to));
        }
    }

    /// Takes a part of the new segment.
    fn rise(&mut self, from: f64, to: f64) {
        match &mut self.open {
            Some(open) if open.1 == from => open.1 = to,
            _ => {
                self.close();
                self.open = Some((from, to));
            }
        }
    }

    fn close(&mut self) {
        if let Some((from, to)) = self.open.take().filter(|o| o.0 < o.1) {
            self.pieces.push(self.new.part(from, to));
        }
    }
}

/// A segment from left to right.
fn sorted(p: DVec2, q: DVec2) -> Reach {
    if p.x < q.x { Reach { from: p, to: q } } else { Reach { from: q, to: p } }
}

/// Where a piece is higher than another between two places.
fn higher(new: &Reach, old: &Reach, low: f64, high: f64) -> Option<(f64, f64)> {
    let gap = |x: f64| {
        let (a, b) = (new.at(x), old.at(x));
        if (a - b).abs() <= SAME * a.abs().max(b.abs()) { 0.0 } else { a - b }
    };
    let (s, t) = (gap(low), gap(high));
    let crossing = || low + (high - low) * (s / (s - t));
    match (s > 0.0, t > 0.0) {
        (true, true) => Some((low, high)),
        (true, false) if t == 0.0 => Some((low, high)),
        (false, true) if s == 0.0 => Some((low, high)),
        (true, false) => Some((low, crossing())),
        (false, true) => Some((crossing(), high)),
        (false, false) => None,
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn the_higher_hides_the_lower() {
        let mut envelope = Envelope::default();
        envelope.raise(dvec2(0.0, 0.0), dvec2(4.0, 0.0));
        envelope.raise(dvec2(3.0, 1.0), dvec2(1.0, -1.0));
        let rises = |p, q| {
            let mut all = vec![];
            envelope.above(p, q, |r| all.push((r.from, r.to, r.over_something)));
            all
        };
        assert_eq!(envelope.height(2.5), Some(0.5));
        let level = rises(dvec2(-1.0, 0.5), dvec2(4.0, 0.5));
        // Beside the envelope, over it up to x = 2.5, and from 3 on.
        assert!((level.iter().map(|r| r.1 - r.0).sum::<f64>() - 4.5 / 5.0).abs() < 1e-12);
        assert_eq!(rises(dvec2(-1.0, -1.0), dvec2(3.0, -1.0)), [(0.0, 0.25, false)]);
        assert_eq!(rises(dvec2(1.0, -1.0), dvec2(1.0, 3.0)), [(0.25, 1.0, true)]);
        assert_eq!(rises(dvec2(4.0, 0.0), dvec2(0.0, 0.0)), []);
    }

    #[test]
    fn random_segments_leave_their_maximum() {
        let mut state = 5u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / (1 << 24) as f64
        };
        let segments: Vec<[DVec2; 2]> =
            (0..60).map(|_| [0, 1].map(|_| dvec2(next() * 10.0, next()))).collect();
        let mut envelope = Envelope::default();
        segments.iter().for_each(|[p, q]| envelope.raise(*p, *q));
        for i in 0..1000 {
            let x = f64::from(i) / 100.0 + 0.003;
            let over = segments.iter().map(|[p, q]| sorted(*p, *q));
            let over = over.filter(|s| s.from.x <= x && x <= s.to.x).map(|s| s.at(x));
            let highest = over.reduce(f64::max);
            match (highest, envelope.height(x)) {
                (Some(a), Some(b)) => assert!((a - b).abs() < 1e-9, "{a} {b} at {x}"),
                (a, b) => assert_eq!(a, b),
            }
        }
    }
}
