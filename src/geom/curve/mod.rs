//! Curves in space: lines, arcs, helices and Bezier curves end to end.
//!
//! # Paper
//! METHODS 4.2 (Nakajima): a smooth curve through the middles of a control polygon.
//!
//! # Departures
//! The paper's conic with weights 1, 1, 2 is a quarter of an ellipse: with t = tan(a / 2) its three terms become
//! 1 - sin a, sin a + cos a - 1 and 1 - cos a. It is kept as that quarter, so that equal steps of its parameter are the
//! equal angles of the paper's sampling.

mod chord;
mod distance;
mod nearest;
mod piece;
mod plane;
mod through;

use std::sync::Arc;

use glam::DVec3;
use thiserror::Error;

pub use self::{
    chord::Chord,
    piece::{Jet, Piece, Turn},
    plane::{Flat, PlaneError},
    through::slopes,
};
use super::{Placement, Tolerance};

/// The most points that a curve may be given by.
pub const MOST_POINTS: usize = 1_000_000;

/// The most control points of one Bezier curve: its degree less one.
pub const MOST_CONTROLS: usize = 100;

/// Pieces end to end, millimetres.
///
/// A place on it is a number of pieces and a part of the next one: 2.5 is the middle of the third piece, by that piece's own
/// parameter.
#[derive(Clone, PartialEq, Debug)]
pub struct Curve {
    pieces: Vec<Piece>,
    /// The length up to the end of each piece.
    lengths: Vec<f64>,
    closed: bool,
    vertices: Vec<DVec3>,
    tag: Option<Arc<str>>,
}

/// Why there is no curve.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum CurveError {
    /// Too few points.
    #[error("{found} points; {needed} are needed")]
    Few {
        /// How many there are.
        found: usize,
        /// How many are needed.
        needed: usize,
    },
    /// Two points that follow one another are the same.
    #[error("point {number} and the one after it are the same, ({}, {}, {})", .at.x, .at.y, .at.z)]
    Coincident {
        /// The number of the first one, from 0.
        number: usize,
        /// Where both are, mm.
        at: DVec3,
    },
    /// More points than are taken.
    #[error("{0} points; the limit is {1}")]
    Many(usize, usize),
    /// Curves that do not meet.
    #[error("curve {number} begins {gap} mm from where the one before ends, at ({}, {}, {})", .at.x, .at.y, .at.z)]
    Gap {
        /// Its number, from 0.
        number: usize,
        /// The distance, mm.
        gap: f64,
        /// Where it begins.
        at: DVec3,
    },
}

/// Ends of curves nearer than this part of their size are one.
const MEETING: f64 = 1e-9;

impl Curve {
    /// A curve of pieces that meet, at least one.
    pub fn of(pieces: Vec<Piece>, closed: bool) -> Curve {
        let mut sum = 0.0;
        let grown = |piece: &Piece| {
            sum += piece.length(1.0);
            sum
        };
        let lengths = pieces.iter().map(grown).collect();
        let last = pieces.last().filter(|_| !closed).map(|piece| piece.at(1.0));
        let vertices = pieces.iter().map(|piece| piece.at(0.0)).chain(last).collect();
        Curve { pieces, lengths, closed, vertices, tag: None }
    }

    /// Straight from point to point. Points that follow one another must differ.
    ///
    /// ```
    /// use glam::dvec3;
    /// use katachi::geom::Curve;
    /// let corner = [dvec3(0., 0., 0.), dvec3(3., 0., 0.), dvec3(3., 4., 0.)];
    /// assert_eq!(Curve::polyline(&corner, false).unwrap().length(), 7.0);
    /// assert_eq!(Curve::polyline(&corner, true).unwrap().length(), 12.0);
    /// ```
    pub fn polyline(points: &[DVec3], closed: bool) -> Result<Curve, CurveError> {
        check(points, 2, closed)?;
        let next = points.iter().skip(1).chain(points.first().filter(|_| closed));
        let pieces = points.iter().zip(next).map(|(a, b)| Piece::Line([*a, *b])).collect();
        Ok(Curve::of(pieces, closed))
    }

    /// One turn, or a part of one, or several with a rise.
    pub fn turn(turn: Turn) -> Curve {
        let closed = turn.rise == DVec3::ZERO && (turn.to - turn.from).abs() == 360.0;
        Curve::of(vec![Piece::Turn(turn)], closed)
    }

    /// The Bezier curve of control points, 2 to [`MOST_CONTROLS`].
    pub fn bezier(points: &[DVec3]) -> Result<Curve, CurveError> {
        if points.len() > MOST_CONTROLS {
            return Err(CurveError::Many(points.len(), MOST_CONTROLS));
        }
        if points.len() < 3 {
            return Curve::polyline(points, false);
        }
        if points.iter().all(|p| *p == points[0]) {
            return Err(CurveError::Coincident { number: 0, at: points[0] });
        }
        Ok(Curve::of(vec![Piece::Bezier(points.to_vec())], points[0] == points[points.len() - 1]))
    }

    /// Its pieces.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Whether it ends where it starts.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// The ends of its pieces, or the points it was told to keep.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// The same curve with vertices of its own.
    pub fn with_vertices(self, vertices: Vec<DVec3>) -> Curve {
        Curve { vertices, ..self }
    }

    /// The name that it was given.
    pub fn tag(&self) -> Option<&Arc<str>> {
        self.tag.as_ref()
    }

    /// The same curve with a name, or without one.
    pub fn tagged(self, tag: Option<Arc<str>>) -> Curve {
        Curve { tag, ..self }
    }

    /// Its length, mm.
    pub fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// The place at a part of the length, 0 to 1.
    ///
    /// ```
    /// use glam::dvec3;
    /// use katachi::geom::Curve;
    /// let corner = [dvec3(0., 0., 0.), dvec3(3., 0., 0.), dvec3(3., 5., 0.)];
    /// let curve = Curve::polyline(&corner, false).unwrap();
    /// assert!(curve.at(curve.place(0.5)).distance(dvec3(3., 1., 0.)) < 1e-12);
    /// ```
    pub fn place(&self, part: f64) -> f64 {
        let wanted = self.length() * part.clamp(0.0, 1.0);
        let last = self.pieces.len() - 1;
        let i = self.lengths.partition_point(|end| *end < wanted).min(last);
        let before = if i == 0 { 0.0 } else { self.lengths[i - 1] };
        i as f64 + self.pieces[i].at_length(wanted - before)
    }

    /// The part of the length up to a place.
    pub fn part(&self, place: f64) -> f64 {
        let (piece, s) = self.piece(place);
        let before = if piece == 0 { 0.0 } else { self.lengths[piece - 1] };
        (before + self.pieces[piece].length(s)) / self.length()
    }

    /// The piece at a place, and its own parameter there; at the joint of two pieces the one that begins.
    fn piece(&self, place: f64) -> (usize, f64) {
        let piece = (place.max(0.0) as usize).min(self.pieces.len() - 1);
        (piece, (place - piece as f64).clamp(0.0, 1.0))
    }

    /// The point at a place, mm.
    pub fn at(&self, place: f64) -> DVec3 {
        let (piece, s) = self.piece(place);
        self.pieces[piece].at(s)
    }

    /// The unit direction at a place; at a joint that of the piece that begins there.
    pub fn tangent(&self, place: f64) -> DVec3 {
        let (piece, s) = self.piece(place);
        self.pieces[piece].tangent(s)
    }

    /// The curvature vector at a place, 1/mm.
    pub fn curvature(&self, place: f64) -> DVec3 {
        let (piece, s) = self.piece(place);
        self.pieces[piece].curvature(s)
    }

    /// Points along it, chords between which keep within the tolerance; a closed curve ends with its first point. Each
    /// piece is cut in equal steps of its parameter: arcs in equal angles.
    pub fn points(&self, tolerance: Tolerance) -> Vec<DVec3> {
        let mut points = vec![self.at(0.0)];
        for piece in &self.pieces {
            let chords = piece.chords(tolerance);
            points.extend((1..=chords).map(|i| piece.at(f64::from(i) / f64::from(chords))));
        }
        points
    }

    /// Places along it, from the first to the last, between which it has no more than [plain](Piece::plain_parts) parts.
    pub fn plain_places(&self) -> Vec<f64> {
        let parts = |(i, piece): (usize, &Piece)| {
            let count = piece.plain_parts();
            (0..count).map(move |k| i as f64 + f64::from(k) / f64::from(count))
        };
        let last = self.pieces.len() as f64;
        self.pieces.iter().enumerate().flat_map(parts).chain([last]).collect()
    }

    /// The chords that [`points`](Curve::points) would make.
    pub fn chords(&self, tolerance: Tolerance) -> u64 {
        self.pieces.iter().map(|piece| u64::from(piece.chords(tolerance))).sum()
    }

    /// The curve after a placement.
    pub fn placed(&self, placement: &Placement) -> Curve {
        let pieces = self.pieces.iter().map(|piece| piece.placed(placement)).collect();
        let vertices = self.vertices.iter().map(|p| placement.point(*p)).collect();
        Curve::of(pieces, self.closed).with_vertices(vertices).tagged(self.tag.clone())
    }

    /// The same curve the other way.
    pub fn reversed(&self) -> Curve {
        let pieces = self.pieces.iter().rev().map(Piece::reversed).collect();
        let vertices = self.vertices.iter().rev().copied().collect();
        Curve::of(pieces, self.closed).with_vertices(vertices).tagged(self.tag.clone())
    }

    /// What is before and after a place; open both. None where one of them would be a point.
    pub fn split(&self, place: f64) -> Option<[Curve; 2]> {
        let (piece, s) = self.piece(place);
        let (mut before, mut after) = (self.pieces[..piece].to_vec(), vec![]);
        if s <= 0.0 || s >= 1.0 {
            before = self.pieces[..piece + usize::from(s >= 1.0)].to_vec();
            after.extend_from_slice(&self.pieces[before.len()..]);
        } else {
            let [left, right] = self.pieces[piece].split(s);
            before.push(left);
            after.push(right);
            after.extend_from_slice(&self.pieces[piece + 1..]);
        }
        let both = !before.is_empty() && !after.is_empty();
        both.then(|| [before, after].map(|pieces| Curve::of(pieces, false)))
    }

    /// One curve of several, each of which begins where the one before ends; closed if the last ends where the first
    /// begins.
    pub fn joined(curves: &[&Curve]) -> Result<Curve, CurveError> {
        let pieces: Vec<Piece> = curves.iter().flat_map(|c| c.pieces.iter().cloned()).collect();
        let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else {
            return Err(CurveError::Few { found: 0, needed: 1 });
        };
        let size = curves.iter().map(|c| c.length()).sum::<f64>();
        for (number, pair) in (1..).zip(curves.windows(2)) {
            let at = pair[1].at(0.0);
            let gap = at.distance(pair[0].at(pair[0].pieces.len() as f64));
            if gap > MEETING * size {
                return Err(CurveError::Gap { number, gap, at });
            }
        }
        let closed = first.at(0.0).distance(last.at(1.0)) <= MEETING * size;
        Ok(Curve::of(pieces, closed))
    }

    /// Whether the pieces before and after the joint with that number run on in one direction, to a part in a million.
    pub fn is_smooth_at(&self, joint: usize) -> bool {
        let count = self.pieces.len();
        if !self.closed && (joint == 0 || joint >= count) {
            return true;
        }
        let before = self.pieces[(joint + count - 1) % count].tangent(1.0);
        let after = self.pieces[joint % count].tangent(0.0);
        before.distance(after) <= SMOOTH
    }
}

/// Directions that differ by less are one: a corner of so few radians shows in no drawing.
const SMOOTH: f64 = 1e-6;

/// Enough points, each different from the next.
fn check(points: &[DVec3], needed: usize, closed: bool) -> Result<(), CurveError> {
    let found = points.len();
    if found < needed {
        return Err(CurveError::Few { found, needed });
    }
    if found > MOST_POINTS {
        return Err(CurveError::Many(found, MOST_POINTS));
    }
    let next = points.iter().skip(1).chain(points.first().filter(|_| closed && found > 1));
    match points.iter().zip(next).position(|(a, b)| a == b) {
        Some(number) => Err(CurveError::Coincident { number, at: points[number] }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests;
