//! Pieces of curves: each has one formula.

use std::f64::consts::PI;

use glam::DVec3;

use super::super::{
    Bounds, Placement, Tolerance,
    flatten::arc_chords,
    trig::{cos_deg, sin_deg},
};

/// A curve with one formula over a parameter s from 0 to 1, millimetres.
#[derive(Clone, PartialEq, Debug)]
pub enum Piece {
    /// Straight from the first point to the second.
    Line([DVec3; 2]),
    /// An arc of an ellipse or of a helix.
    Turn(Turn),
    /// A Bezier curve of at least three control points.
    Bezier(Vec<DVec3>),
}

/// center + cos(a) x + sin(a) y + a / 360 rise: an arc of an ellipse, or of a helix if it rises.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Turn {
    /// Centre.
    pub center: DVec3,
    /// From the centre to the point of angle 0.
    pub x: DVec3,
    /// From the centre to the point of angle 90.
    pub y: DVec3,
    /// What a full turn adds.
    pub rise: DVec3,
    /// Angle of its start, degrees.
    pub from: f64,
    /// Angle of its end, degrees; below `from` when it runs the other way.
    pub to: f64,
}

/// A point of a curve and the first two derivatives there.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Jet {
    /// The point, mm.
    pub point: DVec3,
    /// The first derivative by the parameter.
    pub first: DVec3,
    /// The second derivative.
    pub second: DVec3,
}

impl Turn {
    fn angle(&self, s: f64) -> f64 {
        if s == 1.0 { self.to } else { self.from + (self.to - self.from) * s }
    }

    fn jet(&self, s: f64) -> Jet {
        let angle = self.angle(s);
        let (sin, cos) = (sin_deg(angle), cos_deg(angle));
        let degrees = self.to - self.from;
        let speed = degrees * (PI / 180.0);
        Jet {
            point: self.center + self.x * cos + self.y * sin + self.rise * (angle / 360.0),
            first: (self.y * cos - self.x * sin) * speed + self.rise * (degrees / 360.0),
            second: -(self.x * cos + self.y * sin) * (speed * speed),
        }
    }

    /// Whether it has one radius and rises across its plane, if at all.
    pub fn is_circular(&self) -> bool {
        let (a, b) = (self.x.length_squared(), self.y.length_squared());
        let slack = ROUND * a;
        let across = self.x.dot(self.rise).abs().max(self.y.dot(self.rise).abs());
        (a - b).abs() <= slack && self.x.dot(self.y).abs() <= slack && across <= slack
    }

    /// The largest distance from the centre's line.
    fn reach(&self) -> f64 {
        // The largest singular value of [x y] is at most the root of the sum of squares.
        let (a, b) = (self.x.length(), self.y.length());
        if self.is_circular() { a } else { (a * a + b * b).sqrt() }
    }
}

/// Axes of an arc are those of a circle up to rounding.
const ROUND: f64 = 1e-14;

impl Piece {
    /// Its point and derivatives at s.
    pub fn jet(&self, s: f64) -> Jet {
        match self {
            Piece::Line([a, b]) => Jet {
                point: if s == 1.0 { *b } else { *a + (*b - *a) * s },
                first: *b - *a,
                second: DVec3::ZERO,
            },
            Piece::Turn(turn) => turn.jet(s),
            Piece::Bezier(points) => bezier(points, s),
        }
    }

    /// Its point at s, mm.
    pub fn at(&self, s: f64) -> DVec3 {
        self.jet(s).point
    }

    /// Where it starts and ends.
    pub fn ends(&self) -> [DVec3; 2] {
        [self.at(0.0), self.at(1.0)]
    }

    /// The unit direction at s: where the speed is zero, that of the points nearby; zero if all are one.
    pub fn tangent(&self, s: f64) -> DVec3 {
        let jet = self.jet(s);
        let size = self.size();
        if jet.first.length() > STILL * size {
            return jet.first.normalize();
        }
        let step = if s < 0.5 { NEARBY } else { -NEARBY };
        ((self.at(s + step) - jet.point) * step.signum()).normalize_or_zero()
    }

    /// Curvature vector at s, 1/mm: towards the centre of the circle of curvature, as long as 1 / radius.
    pub fn curvature(&self, s: f64) -> DVec3 {
        let Jet { first, second, .. } = self.jet(s);
        let speed = first.length_squared();
        if speed == 0.0 {
            DVec3::ZERO
        } else {
            (second - first * (second.dot(first) / speed)) / speed
        }
    }

    /// The same curve the other way.
    pub fn reversed(&self) -> Piece {
        match self {
            Piece::Line([a, b]) => Piece::Line([*b, *a]),
            Piece::Turn(turn) => Piece::Turn(Turn { from: turn.to, to: turn.from, ..*turn }),
            Piece::Bezier(points) => Piece::Bezier(points.iter().rev().copied().collect()),
        }
    }

    /// The curve after a placement.
    pub fn placed(&self, placement: &Placement) -> Piece {
        let point = |p: &DVec3| placement.point(*p);
        match self {
            Piece::Line(ends) => Piece::Line([point(&ends[0]), point(&ends[1])]),
            Piece::Turn(turn) => Piece::Turn(Turn {
                center: point(&turn.center),
                x: placement.vector(turn.x),
                y: placement.vector(turn.y),
                rise: placement.vector(turn.rise),
                ..*turn
            }),
            Piece::Bezier(points) => Piece::Bezier(points.iter().map(point).collect()),
        }
    }

    /// Its two parts before and after s.
    pub fn split(&self, s: f64) -> [Piece; 2] {
        match self {
            Piece::Line([a, b]) => {
                let middle = self.at(s);
                [Piece::Line([*a, middle]), Piece::Line([middle, *b])]
            }
            Piece::Turn(turn) => {
                let angle = turn.angle(s);
                [Turn { to: angle, ..*turn }, Turn { from: angle, ..*turn }].map(Piece::Turn)
            }
            Piece::Bezier(points) => {
                let (mut rest, mut left, mut right) = (points.clone(), vec![], vec![]);
                while let [first, .., last] = rest[..] {
                    left.push(first);
                    right.push(last);
                    rest = rest.windows(2).map(|p| p[0].lerp(p[1], s)).collect();
                }
                left.push(rest[0]);
                right.push(rest[0]);
                right.reverse();
                [Piece::Bezier(left), Piece::Bezier(right)]
            }
        }
    }

    /// Chords of equal steps of s that keep within the tolerance: as many as are needed, at least 1.
    pub fn chords(&self, tolerance: Tolerance) -> u32 {
        match self {
            Piece::Line(_) => 1,
            Piece::Turn(turn) => {
                arc_chords(turn.reach(), (turn.to - turn.from).to_radians(), tolerance)
            }
            Piece::Bezier(_) => {
                (self.bend() / (8.0 * tolerance.mm())).sqrt().ceil().clamp(1.0, f64::from(u32::MAX))
                    as u32
            }
        }
    }

    /// A bound of the second derivative by the parameter, mm: a chord across a step h is off by at most an eighth of it times
    /// the square of h.
    pub fn bend(&self) -> f64 {
        match self {
            Piece::Line(_) => 0.0,
            Piece::Turn(turn) => {
                let speed = (turn.to - turn.from).to_radians();
                turn.reach() * speed * speed
            }
            Piece::Bezier(points) => {
                let degree = (points.len() - 1) as f64;
                let bend = points.windows(3).map(|p| (p[0] - 2.0 * p[1] + p[2]).length());
                bend.fold(0.0, f64::max) * degree * (degree - 1.0)
            }
        }
    }

    /// Equal parts of s at whose quarters it is not on the chord across them unless it is straight: of a turn a
    /// quarter at most each. A polynomial of five zeros and a degree below five is none.
    pub fn plain_parts(&self) -> u32 {
        match self {
            Piece::Line(_) => 1,
            Piece::Turn(turn) => ((turn.to - turn.from).abs() / 90.0).ceil().max(1.0) as u32,
            Piece::Bezier(points) if points.len() <= 5 => 1,
            Piece::Bezier(points) => points.len() as u32,
        }
    }

    /// A box that holds it, mm.
    pub fn bounds(&self) -> Bounds {
        match self {
            Piece::Line(ends) => Bounds::of(*ends),
            Piece::Turn(turn) => {
                let reach = (turn.x * turn.x + turn.y * turn.y).map(f64::sqrt);
                let ends = [turn.from, turn.to].map(|a| turn.center + turn.rise * (a / 360.0));
                Bounds::of(ends.into_iter().flat_map(|p| [p - reach, p + reach]))
            }
            Piece::Bezier(points) => Bounds::of(points.iter().copied()),
        }
    }

    /// Its length in mm up to s: closed forms for lines, circles and helices, else by quadrature to 1e-13.
    pub fn length(&self, s: f64) -> f64 {
        self.length_between(0.0, s)
    }

    fn length_between(&self, from: f64, to: f64) -> f64 {
        match self {
            Piece::Line([a, b]) => a.distance(*b) * (to - from),
            Piece::Turn(turn) if turn.is_circular() => turn.jet(0.0).first.length() * (to - from),
            _ => {
                let whole = gauss(self, from, to);
                let enough = LENGTH * whole + NOISE * self.farthest();
                integral(self, [from, to], whole, (enough, DEEPEST))
            }
        }
    }

    /// The s at which it has that length, mm.
    pub fn at_length(&self, wanted: f64) -> f64 {
        let whole = self.length(1.0);
        if wanted <= 0.0 || whole == 0.0 {
            return 0.0;
        }
        if wanted >= whole {
            return 1.0;
        }
        let (mut low, mut high, mut s) = (0.0, 1.0, wanted / whole);
        // The length up to `low`; only what is beyond is measured again.
        let mut below = 0.0;
        let rounding = EXACT * whole + NOISE * self.farthest();
        for _ in 0..MOST_STEPS {
            let found = below + self.length_between(low, s);
            let wrong = found - wanted;
            if wrong.abs() <= rounding {
                break;
            }
            if wrong > 0.0 {
                high = s;
            } else {
                (low, below) = (s, found);
            }
            let step = s - wrong / self.jet(s).first.length();
            s = if step > low && step < high { step } else { (low + high) / 2.0 };
        }
        s
    }

    /// The largest coordinate of its control points, or about that.
    fn farthest(&self) -> f64 {
        let far = |p: &DVec3| p.abs().max_element();
        match self {
            Piece::Line(ends) => ends.iter().map(far).fold(0.0, f64::max),
            Piece::Turn(turn) => far(&turn.center) + self.size(),
            Piece::Bezier(points) => points.iter().map(far).fold(0.0, f64::max),
        }
    }

    /// Points that it does not leave the neighbourhood of: its ends, or its control points.
    fn size(&self) -> f64 {
        match self {
            Piece::Line([a, b]) => a.distance(*b),
            Piece::Turn(turn) => turn.reach() + turn.rise.length(),
            Piece::Bezier(points) => {
                points.iter().map(|p| p.distance(points[0])).fold(0.0, f64::max)
            }
        }
    }
}

/// A speed below this part of the size is none.
const STILL: f64 = 1e-9;
/// A step to a point nearby.
const NEARBY: f64 = 1e-4;
/// Halvings of the parameter in a quadrature at most.
const DEEPEST: u32 = 24;
/// Steps to a length at most, and how near to it is near enough.
const MOST_STEPS: u32 = 60;
const EXACT: f64 = 1e-14;
/// Error of a part of a length, relative to the whole.
const LENGTH: f64 = 1e-13;
/// What rounding of coordinates makes of a length, relative to them: halving makes that no less.
const NOISE: f64 = 16.0 * f64::EPSILON;

/// De Casteljau's algorithm.
fn bezier(points: &[DVec3], s: f64) -> Jet {
    let degree = (points.len() - 1) as f64;
    let mut rest = points.to_vec();
    let (mut first, mut second) = (DVec3::ZERO, DVec3::ZERO);
    while rest.len() > 1 {
        if let [a, b, c] = rest[..] {
            second = (a - 2.0 * b + c) * (degree * (degree - 1.0));
        }
        if let [a, b] = rest[..] {
            first = (b - a) * degree;
        }
        for i in 1..rest.len() {
            rest[i - 1] = rest[i - 1] + (rest[i] - rest[i - 1]) * s;
        }
        rest.pop();
    }
    let point = match (s, points) {
        (1.0, [.., last]) => *last,
        _ => rest[0],
    };
    Jet { point, first, second }
}

/// Abscissas and weights of Gauss and Legendre's rule of eight points, one half of it.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

fn gauss(piece: &Piece, from: f64, to: f64) -> f64 {
    let (middle, half) = ((from + to) / 2.0, (to - from) / 2.0);
    let speed = |x: f64| piece.jet(middle + half * x).first.length();
    GAUSS.iter().map(|(x, weight)| weight * (speed(*x) + speed(-x))).sum::<f64>() * half
}

/// The length between two parameters, halved until the halves agree with the whole to `enough`.
fn integral(piece: &Piece, [from, to]: [f64; 2], whole: f64, (enough, depth): (f64, u32)) -> f64 {
    let middle = (from + to) / 2.0;
    let halves = [gauss(piece, from, middle), gauss(piece, middle, to)];
    let sum = halves[0] + halves[1];
    if depth == 0 || (sum - whole).abs() <= enough {
        return sum;
    }
    let deeper = (enough, depth - 1);
    integral(piece, [from, middle], halves[0], deeper)
        + integral(piece, [middle, to], halves[1], deeper)
}
