//! Hidden lines of convex polyhedra, body against body.
//!
//! The contour of a convex body is a convex polygon in the picture, so two bodies stand in one of three relations,
//! told by the signs f_ij of the side on which point j of one contour lies of edge i of the other. What a convex body
//! hides of an edge is one piece: within its contour and behind all its front faces.
//!
//! | paper | here |
//! |---|---|
//! | f_ij <= 0 for all j and one i | [`Relation::Separated`]: nothing is hidden |
//! | f_ij >= 0 for all i and j | [`Relation::Surrounding`]: if the outer body is nearer, all of the inner is hidden |
//! | otherwise | [`Relation::Crossing`]: the nearer hides a part of each edge that runs behind it |
//!
//! # Departures
//! The paper counts signed crossings of contours. Here each edge is cut by the contour and the planes directly, so
//! that bodies may also reach into each other.

use glam::DVec3;

use super::{
    clip::behind,
    lattice::{Scanline, turn},
    model::{Edge, Hull, Model},
    span::{Span, Step, spans},
};
use crate::geom::{Bounds, bvh::Bvh};

/// How two contours lie to each other.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Relation {
    /// They have no common inner point.
    Separated,
    /// The second lies within the first.
    Surrounding,
    /// They overlap.
    Crossing,
}

/// The relation of the contour of `b` to the contour of `a`.
pub fn relation(model: &Model, a: &Hull, b: &Hull) -> Relation {
    let mut within = true;
    for edge in &model.outlines[a.outlines.clone()] {
        let [p, q] = [edge.a, edge.b].map(|i| model.at[i as usize]);
        let mut outside = true;
        for other in &model.outlines[b.outlines.clone()] {
            let side = turn(p, q, model.at[other.a as usize]);
            outside &= side <= 0.0;
            within &= side >= 0.0;
        }
        if outside {
            return Relation::Separated;
        }
    }
    if within { Relation::Surrounding } else { Relation::Crossing }
}

/// Which bodies may hide which.
pub struct Bodies<'a> {
    model: &'a Model,
    /// The bodies that may hide each body, and whether they hide all of it.
    before: Vec<Vec<(u32, bool)>>,
}

impl<'a> Bodies<'a> {
    /// Compares all bodies whose pictures are near each other.
    pub fn new(model: &'a Model) -> Bodies<'a> {
        let boxes: Vec<Bounds> = model
            .hulls
            .iter()
            .map(|h| Bounds { min: h.min.extend(0.0), max: h.max.extend(0.0) })
            .collect();
        let mut bodies = Bodies { model, before: vec![vec![]; boxes.len()] };
        Bvh::new(&boxes).self_pairs(|a, b| {
            bodies.compare(a, b);
        });
        bodies.before.iter_mut().for_each(|list| list.sort_unstable());
        bodies
    }

    fn compare(&mut self, a: u32, b: u32) {
        let [one, other] = [a, b].map(|i| &self.model.hulls[i as usize]);
        let back = relation(self.model, other, one);
        let there = relation(self.model, one, other);
        if back == Relation::Separated || there == Relation::Separated {
            return;
        }
        // Bodies that lie all before each other's front faces do not hide each other.
        let [over_b, over_a] = [self.depth(one, other), self.depth(other, one)];
        if over_b != Depth::Before {
            let whole = there == Relation::Surrounding && over_b == Depth::Behind;
            self.before[b as usize].push((a, whole));
        }
        if over_a != Depth::Before {
            let whole = back == Relation::Surrounding && over_a == Depth::Behind;
            self.before[a as usize].push((b, whole));
        }
    }

    /// Where a body lies to the front faces of another.
    fn depth(&self, front: &Hull, body: &Hull) -> Depth {
        let points = &self.model.space[body.points.clone()];
        let mut behind = true;
        for facet in &self.model.facets[front.facets.clone()] {
            let height = |p: &DVec3| facet.plane.distance(*p);
            if points.iter().all(|p| height(p) >= -self.model.contact) {
                return Depth::Before;
            }
            behind &= points.iter().all(|p| height(p) < -self.model.contact);
        }
        if behind { Depth::Behind } else { Depth::Partly }
    }

    /// Appends the spans of an edge of a body.
    pub fn hide(&self, body: usize, edge: &Edge, steps: &mut Vec<Step>, out: &mut Vec<Span>) {
        let [p, q] = [edge.a, edge.b].map(|i| self.model.at[i as usize]);
        let (line, min, max) = (Scanline::new(p, q), p.min(q), p.max(q));
        steps.clear();
        let mut order = i32::from(edge.back);
        for &(other, whole) in &self.before[body] {
            let hull = &self.model.hulls[other as usize];
            if whole {
                order += 1;
            } else if !(hull.min.cmpgt(max) | min.cmpgt(hull.max)).any() {
                steps.extend(self.hidden(edge, &line, hull).into_iter().flatten());
            }
        }
        spans(steps, order, self.model.dust / line.length(), out);
    }

    /// Where a body begins and ends to hide an edge.
    fn hidden(&self, edge: &Edge, line: &Scanline, hull: &Hull) -> Option<[Step; 2]> {
        let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
        for side in &self.model.outlines[hull.outlines.clone()] {
            let [a, b] = [side.a, side.b].map(|i| line.sighted(self.model.at[i as usize]));
            if let Some(t) = line.crossing(a, b) {
                (from, to) = (from.min(t), to.max(t));
            }
        }
        (from, to) = (from.max(0.0), to.min(1.0));
        for facet in &self.model.facets[hull.facets.clone()] {
            if from >= to {
                return None;
            }
            let (low, high) = behind(self.model.heights(edge, &facet.plane))?;
            (from, to) = (from.max(low), to.min(high));
        }
        (from < to).then_some([Step { at: from, by: 1 }, Step { at: to, by: -1 }])
    }
}

/// Where a body lies to front faces.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Depth {
    /// All of it before one of them.
    Before,
    /// All of it behind all of them.
    Behind,
    /// Something else.
    Partly,
}
