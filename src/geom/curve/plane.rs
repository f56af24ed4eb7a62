//! Curves in a plane: which plane, rounded corners, and parallels.

use glam::{DMat3, DVec3};
use thiserror::Error;

use super::{Curve, Piece, Turn};
use crate::geom::{
    Placement, Tolerance,
    trig::{acos_deg, atan2_deg, cos_deg, tan_deg},
};

/// Whether a curve lies in a plane.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Flat {
    /// On one line, or in no plane.
    No,
    /// In the image of the xy plane under this placement, around whose normal it runs counter-clockwise if it is closed;
    /// the identity where that is the xy plane itself.
    In(Placement),
}

/// Why a curve in a plane has no round corners or no parallel.
#[derive(Clone, Copy, PartialEq, Debug, Error)]
pub enum PlaneError {
    /// A corner between pieces that are not both straight.
    #[error("the corner at ({}, {}, {}) is not between two straight lines", .0.x, .0.y, .0.z)]
    Bent(DVec3),
    /// A corner whose arc does not fit.
    #[error("an arc of {r} mm does not fit into the corner at ({}, {}, {}); {fits} mm would", .at.x, .at.y, .at.z)]
    Tight {
        /// The radius, mm.
        r: f64,
        /// The largest that fits.
        fits: f64,
        /// The corner.
        at: DVec3,
    },
    /// A curve in no plane.
    #[error("the curve lies in no plane")]
    NotFlat,
    /// A bend towards the parallel that is too narrow for it.
    #[error("the curve bends with a radius of {radius} mm at ({}, {}, {}), too narrow for a distance of {d} mm", .at.x, .at.y, .at.z)]
    Narrow {
        /// The distance, mm.
        d: f64,
        /// The radius there, mm.
        radius: f64,
        /// The place.
        at: DVec3,
    },
}

/// A curve lies in a plane when no point of it is farther off than this part of its size.
const FLAT: f64 = 1e-9;

/// Parts of a piece that are looked at.
const PARTS: u32 = 16;

/// A parallel keeps its distance to this part of the curve's size.
const EXACT: f64 = 1e-7;

/// Halvings of a piece for a parallel at most.
const DEEPEST: u32 = 12;

impl Curve {
    /// The plane that it lies in, by points of it close together.
    ///
    /// ```
    /// use glam::dvec3;
    /// use katachi::geom::{Curve, Placement, curve::Flat};
    /// let corners = [dvec3(0., 0., 0.), dvec3(3., 0., 0.), dvec3(3., 4., 0.)];
    /// let flat = Curve::polyline(&corners, true).unwrap().flat();
    /// assert_eq!(flat, Flat::In(Placement::IDENTITY));
    /// ```
    pub fn flat(&self) -> Flat {
        let parts = self.pieces().len() as u32 * PARTS;
        let points: Vec<DVec3> =
            (0..=parts).map(|i| self.at(f64::from(i) / f64::from(PARTS))).collect();
        let base = points[0];
        let size = points.iter().map(|p| p.distance(base)).fold(0.0, f64::max);
        let area: DVec3 = points.windows(2).map(|p| (p[0] - base).cross(p[1] - base)).sum();
        let across = || {
            let far = points.iter().max_by(|a, b| a.distance(base).total_cmp(&b.distance(base)))?;
            let normals = points.iter().map(|p| (*far - base).cross(*p - base));
            normals.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
        };
        let found = if self.is_closed() { Some(area) } else { across() };
        let normal = found.unwrap_or(DVec3::ZERO);
        if normal.length() <= FLAT * size * size {
            return Flat::No;
        }
        let normal = normal.normalize();
        if points.iter().any(|p| (*p - base).dot(normal).abs() > FLAT * size) {
            return Flat::No;
        }
        if points.iter().all(|p| p.z == 0.0) {
            return Flat::In(Placement::IDENTITY);
        }
        let x = match normal.cross(DVec3::Z).try_normalize() {
            Some(level) => -level,
            None => DVec3::X,
        };
        Flat::In(Placement::new(DMat3::from_cols(x, normal.cross(x), normal), base))
    }

    /// The curve with its corners between straight lines rounded by arcs of a radius, mm. Fails where an arc does not fit,
    /// or a corner is not between straight lines.
    ///
    /// ```
    /// use glam::dvec3;
    /// use katachi::geom::Curve;
    /// let corner = [dvec3(0., 0., 0.), dvec3(5., 0., 0.), dvec3(5., 5., 0.)];
    /// let curve = Curve::polyline(&corner, false).unwrap().rounded(2.0).unwrap();
    /// assert!((curve.length() - (6.0 + std::f64::consts::PI)).abs() < 1e-12);
    /// ```
    pub fn rounded(&self, r: f64) -> Result<Curve, PlaneError> {
        self.rounded_by(|_| r)
    }

    /// The same with a radius for each corner, which is told by the number of the piece that begins there.
    pub fn rounded_by(&self, radius: impl Fn(usize) -> f64) -> Result<Curve, PlaneError> {
        let count = self.pieces().len();
        let joints = if self.is_closed() { 0..count } else { 1..count };
        let mut arcs: Vec<Option<(Turn, f64)>> = vec![None; count];
        for joint in joints.filter(|&joint| !self.is_smooth_at(joint)) {
            let before = (joint + count - 1) % count;
            let (Piece::Line(a), Piece::Line(b)) = (&self.pieces()[before], &self.pieces()[joint])
            else {
                return Err(PlaneError::Bent(self.at(joint as f64)));
            };
            arcs[joint] = Some(corner(*a, *b, radius(joint)));
        }
        let mut pieces = vec![];
        for (i, piece) in self.pieces().iter().enumerate() {
            let next = (i + 1) % count;
            let [start, end] = [arcs[i], arcs[next].filter(|_| self.is_closed() || next > 0)];
            let Piece::Line([a, b]) = piece else {
                pieces.push(piece.clone());
                continue;
            };
            let (length, taken) =
                (a.distance(*b), [start, end].map(|arc| arc.map_or(0.0, |arc| arc.1)));
            let left = length - taken[0] - taken[1];
            if left < -FLAT * length {
                let joint = if taken[0] > taken[1] { i } else { next };
                let r = radius(joint);
                let fits = r * length / (taken[0] + taken[1]);
                return Err(PlaneError::Tight { r, fits, at: self.at(joint as f64) });
            }
            let along = (*b - *a) / length;
            pieces.extend(start.map(|(turn, _)| Piece::Turn(turn)));
            if left > FLAT * length {
                pieces.push(Piece::Line([*a + along * taken[0], *b - along * taken[1]]));
            }
        }
        Ok(Curve::of(pieces, self.is_closed()))
    }

    /// The curve at a distance d (mm) to its right, seen against the normal of its plane; of one that runs
    /// counter-clockwise in xy the outside. Corners are rounded outside and cut inside. Fails in no plane, and where the
    /// curve bends too sharply.
    pub fn offset(&self, d: f64) -> Result<Curve, PlaneError> {
        let Flat::In(plane) = self.flat() else { return Err(PlaneError::NotFlat) };
        let normal = plane.vector(DVec3::Z);
        let size = self.length();
        let mut runs: Vec<Vec<Piece>> = vec![];
        for piece in self.pieces() {
            let mut parts = vec![];
            parallel(piece, normal, d, EXACT * size, DEEPEST, &mut parts)?;
            runs.push(parts);
        }
        let count = runs.len();
        let joints: Vec<usize> =
            if self.is_closed() { (0..count).collect() } else { (1..count).collect() };
        let mut arcs: Vec<Option<Piece>> = vec![None; count];
        for joint in joints.into_iter().filter(|&joint| !self.is_smooth_at(joint)) {
            let before = (joint + count - 1) % count;
            let at = self.at(joint as f64);
            let [t0, t1] = [self.pieces()[before].tangent(1.0), self.pieces()[joint].tangent(0.0)];
            if t0.cross(t1).dot(normal) * d > 0.0 {
                arcs[joint] = Some(around(at, normal, d, [t0, t1]));
            } else {
                cut(&mut runs, before, joint, at, normal, d)?;
            }
        }
        let pieces = arcs.into_iter().zip(runs).flat_map(|(arc, run)| arc.into_iter().chain(run));
        Ok(Curve::of(pieces.collect(), self.is_closed()))
    }
}

/// The arc that rounds the corner between two lines, and what it takes of each.
fn corner([a, at]: [DVec3; 2], [_, b]: [DVec3; 2], r: f64) -> (Turn, f64) {
    let (back, on) = ((a - at).normalize(), (b - at).normalize());
    let half = acos_deg(back.dot(on).clamp(-1.0, 1.0)) / 2.0;
    let taken = r / tan_deg(half);
    let start = at + back * taken;
    let inwards = (back + on).normalize_or_zero();
    let center = at + inwards * (taken / cos_deg(half));
    let turn = Turn {
        center,
        x: start - center,
        y: -back * r,
        rise: DVec3::ZERO,
        from: 0.0,
        to: 180.0 - 2.0 * half,
    };
    (turn, taken)
}

/// The arc about a corner from one direction to the other.
fn around(center: DVec3, normal: DVec3, d: f64, [t0, t1]: [DVec3; 2]) -> Piece {
    let out = |t: DVec3| t.cross(normal) * d;
    let angle = atan2_deg(t0.cross(t1).dot(normal), t0.dot(t1));
    let (x, y) = (out(t0), normal.cross(out(t0)));
    Piece::Turn(Turn { center, x, y, rise: DVec3::ZERO, from: 0.0, to: angle })
}

/// The parallel of a piece: lines and circles themselves, of others cubics that are halved until they keep the distance.
fn parallel(
    piece: &Piece,
    normal: DVec3,
    d: f64,
    exact: f64,
    depth: u32,
    found: &mut Vec<Piece>,
) -> Result<(), PlaneError> {
    let out = |s: f64| piece.tangent(s).cross(normal) * d;
    // How much of the speed is left; none or less where the bend is too narrow.
    let left = |s: f64| 1.0 + piece.curvature(s).dot(piece.tangent(s).cross(normal)) * -d;
    for i in 0..=PARTS {
        let s = f64::from(i) / f64::from(PARTS);
        if left(s) <= 0.0 {
            let radius = 1.0 / piece.curvature(s).length();
            return Err(PlaneError::Narrow { d, radius, at: piece.at(s) });
        }
    }
    match piece {
        Piece::Line([a, b]) => found.push(Piece::Line([*a + out(0.0), *b + out(1.0)])),
        Piece::Turn(turn) if turn.is_circular() && turn.rise == DVec3::ZERO => {
            let factor =
                1.0 + (out(0.0).dot(piece.at(0.0) - turn.center)) / turn.x.length_squared();
            found.push(Piece::Turn(Turn { x: turn.x * factor, y: turn.y * factor, ..*turn }));
        }
        _ => {
            let ends = [0.0, 1.0].map(|s| piece.at(s) + out(s));
            let arms = [0.0, 1.0].map(|s| piece.jet(s).first * (left(s) / 3.0));
            let cubic = Piece::Bezier(vec![ends[0], ends[0] + arms[0], ends[1] - arms[1], ends[1]]);
            let off = [0.25, 0.5, 0.75].map(|s| cubic.at(s).distance(piece.at(s) + out(s)));
            if depth == 0 || off.into_iter().all(|off| off <= exact) {
                found.push(cubic);
            } else {
                for half in piece.split(0.5) {
                    parallel(&half, normal, d, exact, depth - 1, found)?;
                }
            }
        }
    }
    Ok(())
}

/// Cuts the parallels before and after an inner corner where they cross.
fn cut(
    runs: &mut [Vec<Piece>],
    before: usize,
    after: usize,
    at: DVec3,
    normal: DVec3,
    d: f64,
) -> Result<(), PlaneError> {
    let fine = Tolerance::new(d.abs() * EXACT).unwrap_or_default();
    let left = Curve::of(runs[before].clone(), false);
    let right = Curve::of(runs[after].clone(), false);
    let narrow = PlaneError::Narrow { d, radius: 0.0, at };
    let [p, q] = crossing(&left, &right, normal, fine).ok_or(narrow)?;
    let [kept, _] = left.split(p).ok_or(narrow)?;
    let [_, rest] = right.split(q).ok_or(narrow)?;
    runs[before] = kept.pieces().to_vec();
    runs[after] = rest.pieces().to_vec();
    Ok(())
}

/// Where two curves of one plane cross: the places on both, by Newton's method from the chords that do.
fn crossing(a: &Curve, b: &Curve, normal: DVec3, fine: Tolerance) -> Option<[f64; 2]> {
    const CHORDS: usize = 64;
    let chords = |curve: &Curve| -> Vec<f64> {
        let count = curve.pieces().len() * CHORDS;
        (0..=count).map(|i| i as f64 / CHORDS as f64).collect()
    };
    let (on_a, on_b) = (chords(a), chords(b));
    let side = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).dot(normal);
    for s in on_a.windows(2).rev() {
        let [p, q] = [a.at(s[0]), a.at(s[1])];
        for t in on_b.windows(2) {
            let [u, v] = [b.at(t[0]), b.at(t[1])];
            let crosses =
                side(p, q, u) * side(p, q, v) <= 0.0 && side(u, v, p) * side(u, v, q) <= 0.0;
            if crosses {
                return Some(refined(a, b, normal, [s[0], t[0]], fine));
            }
        }
    }
    None
}

fn refined(a: &Curve, b: &Curve, normal: DVec3, mut at: [f64; 2], fine: Tolerance) -> [f64; 2] {
    const STEPS: usize = 30;
    for _ in 0..STEPS {
        let gap = b.at(at[1]) - a.at(at[0]);
        if gap.length() <= fine.mm() * EXACT {
            break;
        }
        let speed = |curve: &Curve, place: f64| {
            let (piece, s) = curve.piece(place);
            curve.pieces()[piece].jet(s).first
        };
        let (u, v) = (speed(a, at[0]), speed(b, at[1]));
        let area = u.cross(v).dot(normal);
        if area == 0.0 {
            break;
        }
        at = [at[0] + gap.cross(v).dot(normal) / area, at[1] + gap.cross(u).dot(normal) / area];
    }
    at
}
