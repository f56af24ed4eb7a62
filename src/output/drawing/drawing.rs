//! What comes out: lines on paper.

use glam::{DVec2, dvec2};

use super::scene::Kind;

/// How a line is drawn, the most important first: of lines that coincide only the first is kept (ISO 128).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Class {
    /// Nothing is in front of it.
    Visible,
    /// A face is in front of it.
    Hidden,
    /// Where a cutting plane runs; never hidden.
    Cutting,
    /// A centre line; never hidden.
    Centre,
}

/// A piece of a path, from the end of the piece before it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Segment {
    /// A straight line.
    Line {
        /// Its end, mm.
        to: DVec2,
    },
    /// An arc of an ellipse: center + cos(t) major + sin(t) minor.
    Arc {
        /// Centre, mm.
        center: DVec2,
        /// The longer half axis, mm.
        major: DVec2,
        /// The shorter half axis, a quarter turn counter-clockwise from `major`, mm.
        minor: DVec2,
        /// Parameter of its start, radians.
        from: f64,
        /// Parameter of its end, radians; below `from` when it runs clockwise.
        to: f64,
    },
    /// A cubic Bézier curve.
    Cubic {
        /// First handle, mm.
        first: DVec2,
        /// Second handle, mm.
        second: DVec2,
        /// Its end, mm.
        to: DVec2,
    },
}

/// A connected run of segments.
#[derive(Clone, PartialEq, Debug)]
pub struct Path {
    /// Where it begins, mm.
    pub start: DVec2,
    /// Its pieces, at least one.
    pub segments: Vec<Segment>,
}

/// A line of one class.
#[derive(Clone, PartialEq, Debug)]
pub struct Line {
    /// How it is drawn.
    pub class: Class,
    /// What it stands for.
    pub kind: Kind,
    /// The body or stroke it belongs to.
    pub id: u32,
    /// How many front faces are before it; 0 when visible.
    pub order: u32,
    /// Where it runs.
    pub path: Path,
}

/// The lines of a picture, millimetres on paper at scale 1: x to the right, y up, the target at the origin.
///
/// Lengths and the count are taken after merging and before hidden lines are left out, so that they do not
/// depend on which hidden lines are wanted.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Drawing {
    /// The lines in a fixed order.
    pub lines: Vec<Line>,
    /// Length of the visible lines, mm.
    pub visible: f64,
    /// Length of the hidden lines that no visible line covers, mm.
    pub hidden: f64,
    /// The number of segments, visible and hidden.
    pub segments: usize,
}

impl Segment {
    /// Its end, mm.
    pub fn end(&self) -> DVec2 {
        match *self {
            Segment::Line { to } | Segment::Cubic { to, .. } => to,
            Segment::Arc { .. } => self.at(DVec2::ZERO, 1.0),
        }
    }

    /// The point at t in 0..1 of a segment that begins at `start`, mm.
    pub fn at(&self, start: DVec2, t: f64) -> DVec2 {
        match *self {
            Segment::Line { to } => start.lerp(to, t),
            Segment::Arc { center, major, minor, from, to } => {
                let (sin, cos) = libm::sincos(from + (to - from) * t);
                center + major * cos + minor * sin
            }
            Segment::Cubic { first, second, to } => {
                let s = 1.0 - t;
                start * (s * s * s)
                    + first * (3.0 * s * s * t)
                    + second * (3.0 * s * t * t)
                    + to * (t * t * t)
            }
        }
    }

    /// The part between two parameters in 0..1, and where it begins.
    pub fn part(&self, start: DVec2, from: f64, to: f64) -> (DVec2, Segment) {
        let [first, last] = [from, to].map(|t| self.at(start, t));
        let part = match *self {
            Segment::Line { .. } => Segment::Line { to: last },
            Segment::Arc { center, major, minor, from: a, to: b } => {
                let [a, b] = [from, to].map(|t| a + (b - a) * t);
                Segment::Arc { center, major, minor, from: a, to: b }
            }
            Segment::Cubic { .. } => {
                let reach = (to - from) / 3.0;
                let [u, v] = [from, to].map(|t| self.velocity(start, t));
                Segment::Cubic { first: first + u * reach, second: last - v * reach, to: last }
            }
        };
        (first, part)
    }

    /// The derivative of [`Segment::at`].
    fn velocity(&self, start: DVec2, t: f64) -> DVec2 {
        match *self {
            Segment::Line { to } => to - start,
            Segment::Arc { major, minor, from, to, .. } => {
                let (sin, cos) = libm::sincos(from + (to - from) * t);
                (minor * cos - major * sin) * (to - from)
            }
            Segment::Cubic { first, second, to } => {
                let s = 1.0 - t;
                let [a, b, c] = [first - start, second - first, to - second];
                (a * (s * s) + b * (2.0 * s * t) + c * (t * t)) * 3.0
            }
        }
    }

    /// Its length when it begins at `start`, mm: exact for lines and circles, else by Gauss's rule on parts
    /// short enough for nine digits.
    pub fn length(&self, start: DVec2) -> f64 {
        let parts = match *self {
            Segment::Line { to } => return start.distance(to),
            Segment::Arc { major, minor, from, to, .. } if major.length() == minor.length() => {
                return major.length() * (to - from).abs();
            }
            Segment::Arc { from, to, .. } => ((to - from).abs() * 4.0).ceil().max(1.0) as u32,
            Segment::Cubic { .. } => 4,
        };
        (0..parts).map(|i| self.part_length(start, i, parts)).sum()
    }

    fn part_length(&self, start: DVec2, part: u32, parts: u32) -> f64 {
        let width = 1.0 / f64::from(parts);
        let middle = (f64::from(part) + 0.5) * width;
        let points = GAUSS.iter().flat_map(|&(x, w)| [(x, w), (-x, w)]);
        points
            .map(|(x, w)| w * self.velocity(start, middle + x * width / 2.0).length())
            .sum::<f64>()
            * width
            / 2.0
    }
}

/// Places and weights of Gauss's rule with six points on -1..1, the negative places left out.
const GAUSS: [(f64, f64); 3] = [
    (0.238_619_186_083_196_9, 0.467_913_934_572_691_05),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_35),
];

impl Path {
    /// A single segment.
    pub fn of(start: DVec2, segment: Segment) -> Path {
        Path { start, segments: vec![segment] }
    }

    /// Its pieces with their starts.
    pub fn pieces(&self) -> impl Iterator<Item = (DVec2, &Segment)> {
        let mut at = self.start;
        self.segments.iter().map(move |segment| {
            let start = at;
            at = segment.end();
            (start, segment)
        })
    }

    /// Where it ends, mm.
    pub fn end(&self) -> DVec2 {
        self.segments.last().map_or(self.start, Segment::end)
    }

    /// Its length, mm.
    ///
    /// ```
    /// use glam::{DVec2, dvec2};
    /// use katachi::output::drawing::{Path, Segment};
    /// let turn = Segment::Arc { center: DVec2::ZERO, major: DVec2::X, minor: DVec2::Y, from: 0.0, to: 3.0 };
    /// assert_eq!(Path::of(dvec2(1.0, 0.0), turn).length(), 3.0);
    /// ```
    pub fn length(&self) -> f64 {
        self.pieces().map(|(start, segment)| segment.length(start)).sum()
    }
}

impl Drawing {
    /// The corners of the box around all lines, mm; `None` when there are none.
    pub fn bounds(&self) -> Option<(DVec2, DVec2)> {
        let points = self.lines.iter().flat_map(|line| {
            let start = std::iter::once(line.path.start);
            start.chain(
                line.path
                    .pieces()
                    .flat_map(|(p, s)| (1..=8).map(move |i| s.at(p, f64::from(i) / 8.0))),
            )
        });
        let none = dvec2(f64::INFINITY, f64::INFINITY);
        let (min, max) = points.fold((none, -none), |(min, max), p| (min.min(p), max.max(p)));
        (!self.lines.is_empty()).then_some((min, max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_of_curves() {
        let ellipse = Segment::Arc {
            center: dvec2(1.0, 2.0),
            major: dvec2(5.0, 0.0),
            minor: dvec2(0.0, 3.0),
            from: 0.0,
            to: std::f64::consts::TAU,
        };
        // 4 a E(e) with e = 4/5
        assert!((ellipse.length(DVec2::ZERO) - 25.526_998_863_398_124).abs() < 1e-9);
        let straight =
            Segment::Cubic { first: dvec2(1.0, 1.0), second: dvec2(2.0, 2.0), to: dvec2(3.0, 3.0) };
        assert!((straight.length(DVec2::ZERO) - 3.0 * 2.0f64.sqrt()).abs() < 1e-12);
        assert!(ellipse.end().distance(dvec2(6.0, 2.0)) < 1e-12);
    }

    #[test]
    fn paths_go_on_from_piece_to_piece() {
        let corner = [Segment::Line { to: DVec2::X }, Segment::Line { to: DVec2::ONE }];
        let path = Path { start: DVec2::ZERO, segments: corner.to_vec() };
        assert_eq!((path.length(), path.end()), (2.0, DVec2::ONE));
    }
}
