//! The point of one boundary that is farthest from (or deepest in) another, by branch and bound.
//!
//! A piece is a convex polygon cut from a triangle. Over it the distance to the whole boundary is at most the
//! distance to any one triangle, which is convex, so at most its value at one of the piece's corners. The bound
//! is tight where that triangle is the nearest for the whole piece; so a piece is cut along the borders of the
//! part of space over the triangle nearest to its middle, and halved where that does not cut it.

use std::{cmp::Ordering, collections::BinaryHeap};

use glam::DVec3;

use super::{ACCURACY, Boundary};

/// Bounds are not brought nearer than this share of the size of the solids.
const NEGLIGIBLE: f64 = 1e-9;
/// Pieces looked at beyond the triangles given, before the search ends with the bounds it has.
const PIECES: usize = 100_000;

/// A value known by a lower and an upper bound.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Between {
    pub(super) least: f64,
    pub(super) most: f64,
}

impl Between {
    pub(super) fn max(self, other: Between) -> Between {
        Between { least: self.least.max(other.least), most: self.most.max(other.most) }
    }
}

/// A part of the boundary where the largest value may be.
struct Piece {
    corners: Vec<DVec3>,
    /// No point of it has a larger value.
    bound: f64,
    /// The triangle nearest to its middle.
    nearest: u32,
}

impl PartialEq for Piece {
    fn eq(&self, other: &Piece) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Piece {}
impl PartialOrd for Piece {
    fn partial_cmp(&self, other: &Piece) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Piece {
    fn cmp(&self, other: &Piece) -> Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

/// Bounds of the largest `value` on the boundary `of`. The value of a point is told its distance to the
/// boundary `to`; it must change no faster than that and be no larger.
pub(super) fn farthest(of: &Boundary, to: &Boundary, value: impl Fn(DVec3, f64) -> f64) -> Between {
    let size = of.bounds().joined(&to.bounds());
    let small = NEGLIGIBLE * (size.max - size.min).length();
    let mut search = Search { to, value, least: f64::NEG_INFINITY, small, open: BinaryHeap::new() };
    let mut near = 0;
    for triangle in of.triangles() {
        near = search.consider(triangle.to_vec(), near);
    }
    for _ in 0..PIECES {
        let Some(piece) = search.open.pop() else { break };
        if !search.may_hold_more(piece.bound) {
            search.open.push(piece);
            break;
        }
        search.refine(&piece);
    }
    let most = search.open.peek().map_or(search.least, |p| p.bound);
    Between { least: search.least, most: most.max(search.least) }
}

struct Search<'a, F> {
    to: &'a Boundary,
    value: F,
    least: f64,
    small: f64,
    open: BinaryHeap<Piece>,
}

impl<F: Fn(DVec3, f64) -> f64> Search<'_, F> {
    fn may_hold_more(&self, bound: f64) -> bool {
        bound > self.least + self.small.max(ACCURACY * self.least)
    }

    /// Takes in a piece: its middle and the corner that promises most may raise the lower bound; it is kept
    /// if it may hold more. `near` is a triangle likely to be near; gives the nearest.
    fn consider(&mut self, corners: Vec<DVec3>, near: u32) -> u32 {
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let (nearest, distance) = self.to.nearest_from(middle, near);
        let radius = corners.iter().map(|c| c.distance(middle)).fold(0.0, f64::max);
        let height = |c: &DVec3| self.to.distance_squared(nearest, *c);
        let Some(tip) = corners.iter().max_by(|a, b| height(a).total_cmp(&height(b))) else {
            return nearest;
        };
        let convex = height(tip).sqrt();
        if !self.may_hold_more(convex.min(distance + radius)) {
            return nearest;
        }
        let here = (self.value)(middle, distance);
        let there = (self.value)(*tip, self.to.nearest_from(*tip, nearest).1);
        self.least = self.least.max(here).max(there);
        let bound = convex.min(here + radius);
        if self.may_hold_more(bound) {
            self.open.push(Piece { corners, bound, nearest });
        }
        nearest
    }

    fn refine(&mut self, piece: &Piece) {
        let mut rest = piece.corners.clone();
        let [a, b, c] = self.to.triangles()[piece.nearest as usize];
        let normal = (b - a).cross(c - a);
        let mut parts = vec![];
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let inwards = normal.cross(to - from).normalize_or_zero();
            let (inside, outside) = cut(&rest, from, inwards, self.small);
            if inside.len() > 2 && outside.len() > 2 {
                parts.push(outside);
                rest = inside;
            }
        }
        if parts.is_empty() {
            parts.extend(halves(&rest));
        } else {
            parts.push(rest);
        }
        for part in parts {
            self.consider(part, piece.nearest);
        }
    }
}

/// The parts of a convex polygon inside and outside of a half space; corners within `small` of its border are
/// part of both.
fn cut(corners: &[DVec3], base: DVec3, inwards: DVec3, small: f64) -> (Vec<DVec3>, Vec<DVec3>) {
    let height = |p: DVec3| (p - base).dot(inwards);
    let strictly = |sign: f64| corners.iter().any(|p| sign * height(*p) > small);
    if !strictly(1.0) || !strictly(-1.0) {
        return (corners.to_vec(), vec![]);
    }
    let (mut inside, mut outside) = (vec![], vec![]);
    for (i, &p) in corners.iter().enumerate() {
        let q = corners[(i + 1) % corners.len()];
        let (h, k) = (height(p), height(q));
        if h >= -small {
            inside.push(p);
        }
        if h <= small {
            outside.push(p);
        }
        if (h > small && k < -small) || (h < -small && k > small) {
            let crossing = p + (q - p) * (h / (h - k));
            inside.push(crossing);
            outside.push(crossing);
        }
    }
    (inside, outside)
}

/// A convex polygon cut across its longest edge.
fn halves(corners: &[DVec3]) -> [Vec<DVec3>; 2] {
    let n = corners.len();
    let length = |i: usize| corners[i].distance_squared(corners[(i + 1) % n]);
    let longest = (0..n).max_by(|&i, &j| length(i).total_cmp(&length(j))).unwrap_or(0);
    let mut turned = corners.to_vec();
    turned.rotate_left((longest + 1) % n);
    let middle = (turned[0] + turned[n - 1]) / 2.0;
    let opposite = (n - 1).div_ceil(2);
    let mut first = turned[..=opposite].to_vec();
    first.push(middle);
    let mut second = turned[opposite..].to_vec();
    second.push(middle);
    [first, second]
}
