//! How a profile stands along a path.
//!
//! # Sources
//! W. Wang, B. Jüttler, D. Zheng, Y. Liu: *Computation of rotation minimizing frames*, 2008: two reflections carry a frame
//! from point to point with an error of the fourth power of the step.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::SweepError;
use crate::geom::{
    Curve,
    curve::Piece,
    sweep::Frame,
    trig::{atan2_deg, cos_deg, sin_deg},
};

/// Where the plane of a profile stands: its x and y, and the direction of the path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stand {
    pub origin: DVec3,
    pub x: DVec3,
    pub y: DVec3,
    pub tangent: DVec3,
}

impl Stand {
    pub fn place(&self, p: DVec2) -> DVec3 {
        self.origin + self.x * p.x + self.y * p.y
    }

    /// The stand turned about its normal, counter-clockwise.
    pub fn turned(&self, degrees: f64) -> Stand {
        if degrees == 0.0 {
            return *self;
        }
        let (s, c) = (sin_deg(degrees), cos_deg(degrees));
        Stand { x: self.x * c + self.y * s, y: self.y * c - self.x * s, ..*self }
    }

    /// The stand after the smallest turn to another direction.
    fn towards(&self, tangent: DVec3) -> Stand {
        let turn = |v: DVec3| smallest_turn(self.tangent, tangent, v);
        Stand { x: turn(self.x), y: turn(self.y), tangent, ..*self }
    }

    /// The stand carried to a point nearby by two reflections.
    fn carried(&self, origin: DVec3, tangent: DVec3) -> Stand {
        let step = origin - self.origin;
        let square = step.length_squared();
        if square == 0.0 {
            return self.towards(tangent);
        }
        let first = |v: DVec3| v - step * (2.0 * step.dot(v) / square);
        let (x, along) = (first(self.x), first(self.tangent));
        let second = tangent - along;
        let square = second.length_squared();
        let x = if square == 0.0 { x } else { x - second * (2.0 * second.dot(x) / square) };
        let x = (x - tangent * x.dot(tangent)).normalize();
        Stand { origin, x, y: tangent.cross(x), tangent }
    }
}

/// A vector after the smallest turn that takes one unit direction to another; about any axis across for opposite ones.
pub(super) fn smallest_turn(from: DVec3, to: DVec3, v: DVec3) -> DVec3 {
    let (axis, cosine) = (from.cross(to), from.dot(to));
    if cosine <= -1.0 + OPPOSITE {
        let axis = from.any_orthonormal_vector();
        return axis * (2.0 * axis.dot(v)) - v;
    }
    v * cosine + axis.cross(v) + axis * (axis.dot(v) / (1.0 + cosine))
}

/// Directions are opposite when the cosine between them is so near to -1.
const OPPOSITE: f64 = 1e-12;

/// A path has no direction of its own where a part so small of a vector is left.
const NONE: f64 = 1e-9;

/// Steps of a Bezier curve, and degrees of a step on an arc.
const STEPS: u32 = 48;
const STEP: f64 = 5.0;

/// The stands along a path.
#[derive(Debug)]
pub(super) struct Frames {
    path: Arc<Curve>,
    frame: Frame,
    /// Of each piece the stands at equal steps.
    known: Vec<Vec<Stand>>,
    /// What a closed path turns the profile by, degrees, which is taken back on the way.
    excess: f64,
}

impl Frames {
    pub fn new(path: &Curve, frame: Frame) -> Result<Frames, SweepError> {
        let own = Arc::new(path.clone());
        let mut frames = Frames { path: own, frame, known: vec![], excess: 0.0 };
        let tangent = direction(&path.pieces()[0], 0.0)?;
        let start = upright(path.at(0.0), tangent).unwrap_or_else(|| level(path.at(0.0), tangent));
        let mut stand = start;
        for piece in path.pieces() {
            stand = stand.towards(direction(piece, 0.0)?);
            stand.origin = piece.at(0.0);
            let mut stands = vec![stand];
            let steps = steps(piece);
            for i in 1..=steps {
                let s = f64::from(i) / f64::from(steps);
                stand = stand.carried(piece.at(s), direction(piece, s)?);
                stands.push(stand);
            }
            frames.known.push(stands);
        }
        if path.is_closed() {
            let end = stand.towards(tangent);
            frames.excess = atan2_deg(end.x.dot(start.y), end.x.dot(start.x));
            if frames.excess.abs() < NONE {
                frames.excess = 0.0;
            }
        }
        Ok(frames)
    }

    /// Whether the profile is not turned about the path on straight pieces.
    pub fn is_still(&self) -> bool {
        self.excess == 0.0 || self.frame != Frame::RotationMinimising
    }

    /// The stand on a piece, s from 0 to 1.
    pub fn at(&self, piece: usize, s: f64) -> Result<Stand, SweepError> {
        let stands = &self.known[piece];
        let along = s * (stands.len() - 1) as f64;
        let base = stands[along as usize];
        let carried = if along.fract() == 0.0 {
            base
        } else {
            let curve = &self.path.pieces()[piece];
            base.carried(curve.at(s), direction(curve, s)?)
        };
        let Stand { origin, tangent, .. } = carried;
        match self.frame {
            Frame::RotationMinimising => {
                let part = (piece as f64 + s) / self.known.len() as f64;
                Ok(carried.turned(-self.excess * part))
            }
            Frame::Fixed => {
                let Stand { x, y, tangent: along, .. } = self.known[0][0];
                if along.dot(tangent) <= NONE {
                    return Err(SweepError::Along(origin));
                }
                Ok(Stand { origin, x, y, tangent })
            }
            Frame::Frenet => {
                let inwards = self.path.pieces()[piece].curvature(s).try_normalize();
                let x = inwards.ok_or(SweepError::Frameless { what: "straight", at: origin })?;
                Ok(Stand { origin, x, y: tangent.cross(x), tangent })
            }
            Frame::Upright => upright(origin, tangent)
                .ok_or(SweepError::Frameless { what: "upright", at: origin }),
        }
    }
}

/// Frames with a twist and a scale.
#[derive(Debug)]
pub(super) struct Course {
    pub frames: Frames,
    /// Degrees over the whole path.
    pub twist: f64,
    /// Size at the end.
    pub scale: f64,
}

impl Course {
    /// Where the profile stands on a piece, s from 0 to 1, and its size there.
    pub fn stand(&self, piece: usize, s: f64) -> Result<(Stand, f64), SweepError> {
        let stand = self.frames.at(piece, s)?;
        if self.twist == 0.0 && self.scale == 1.0 {
            return Ok((stand, 1.0));
        }
        let part = self.frames.path.part(piece as f64 + s);
        Ok((stand.turned(self.twist * part), 1.0 + (self.scale - 1.0) * part))
    }
}

fn steps(piece: &Piece) -> u32 {
    match piece {
        Piece::Line(_) => 1,
        Piece::Turn(turn) => ((turn.to - turn.from).abs() / STEP).ceil().max(1.0) as u32,
        Piece::Bezier(_) => STEPS,
    }
}

fn direction(piece: &Piece, s: f64) -> Result<DVec3, SweepError> {
    let tangent = piece.tangent(s);
    if tangent == DVec3::ZERO || !tangent.is_finite() {
        return Err(SweepError::Cusp(piece.at(s)));
    }
    Ok(tangent)
}

/// The stand whose y is as near to +z as it can be; none on an upright path.
fn upright(origin: DVec3, tangent: DVec3) -> Option<Stand> {
    let up = DVec3::Z - tangent * tangent.z;
    let y = (up.length() > NONE).then(|| up.normalize())?;
    Some(Stand { origin, x: y.cross(tangent), y, tangent })
}

/// The stand on an upright path: x stays x.
fn level(origin: DVec3, tangent: DVec3) -> Stand {
    let x = (DVec3::X - tangent * tangent.x).normalize();
    Stand { origin, x, y: tangent.cross(x), tangent }
}
