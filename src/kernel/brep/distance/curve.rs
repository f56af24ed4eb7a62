//! The least signed distance of the points of a curve from a solid, by branch and bound.
//!
//! A part of a curve stays near its chord. Where the chord is farther from the boundary than the part may be off it, the part
//! lies on one side; outside, its distance is that of the chord up to so much. Inside, or where it may pass through, no
//! point is deeper than the chord's ends are far from any one triangle, whose distance is convex: that is tight where the
//! triangle is the nearest one.

use std::{cmp::Ordering, collections::BinaryHeap};

use super::{ACCURACY, Boundary};
use crate::{
    geom::{Curve, curve::Chord},
    kernel::brep::Polyhedron,
};

/// Distances that differ by less than this part of the size of curve and solid are one.
const NEAR: f64 = 1e-9;

/// Parts that are halved at most.
const MOST: usize = 300_000;

/// The least distance in mm of a point of a curve from a solid, negative inside: the depth of its deepest point, within
/// [`ACCURACY`]; 0 where it touches the boundary and goes nowhere inside; `None` for the empty solid. Outside it is right to
/// 1e-9 of the size of both, or to what some hundred thousand parts of the curve have told.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::geom::Curve;
/// use katachi::kernel::brep::{distance::curve, primitive::cuboid};
/// let cube = cuboid(DVec3::ZERO, DVec3::splat(2.0));
/// let line = |y: f64| Curve::polyline(&[dvec3(-9., y, 1.), dvec3(9., y, 1.)], false).unwrap();
/// assert_eq!(curve(&cube, &line(5.0)), Some(3.0));
/// assert_eq!(curve(&cube, &line(2.0)), Some(0.0));
/// assert_eq!(curve(&cube, &line(1.5)), Some(-0.5));
/// ```
pub fn curve(solid: &Polyhedron, curve: &Curve) -> Option<f64> {
    if solid.is_empty() {
        return None;
    }
    let boundary = Boundary::new(solid);
    let boxes = curve.pieces().iter().map(|piece| piece.bounds());
    let all = boxes.fold(boundary.bounds(), |all, own| all.joined(&own));
    let near = NEAR * (all.max - all.min).length();
    let mut search = Search { boundary, best: f64::INFINITY, near, open: BinaryHeap::new() };
    curve.pieces().iter().for_each(|piece| search.look(Chord::of(piece)));
    for _ in 0..MOST {
        match search.open.pop().filter(|part| part.bound < search.wanted()) {
            Some(part) => part.chord.halves().into_iter().for_each(|half| search.look(half)),
            None => break,
        }
    }
    Some(if search.best.abs() <= near { 0.0 } else { search.best })
}

/// A part of the curve where no point has a smaller signed distance than `bound`.
struct Part<'a> {
    bound: f64,
    chord: Chord<'a>,
}

impl PartialEq for Part<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Part<'_> {}
impl PartialOrd for Part<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Part<'_> {
    /// The least is the greatest.
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound)
    }
}

struct Search<'a> {
    boundary: Boundary,
    /// No point need be looked for that is not less than this.
    best: f64,
    near: f64,
    open: BinaryHeap<Part<'a>>,
}

impl<'a> Search<'a> {
    /// A part whose bound is not below this has nothing new.
    fn wanted(&self) -> f64 {
        self.best - self.near.max(-self.best * ACCURACY)
    }

    fn look(&mut self, chord: Chord<'a>) {
        let middle = chord.at(chord.ends[0].midpoint(chord.ends[1]));
        let (nearest, distance) = self.boundary.nearest(middle);
        let depth = self.boundary.signed(middle, distance);
        let apart = self.boundary.distance_to_segment(chord.ends);
        self.best = self.best.min(-depth).min(apart + chord.off);
        let bound = match depth < 0.0 && apart > chord.off {
            true => apart - chord.off,
            false => {
                let ends = chord.ends.map(|p| self.boundary.distance_squared(nearest, p).sqrt());
                -(ends[0].max(ends[1]) + chord.off)
            }
        };
        if bound < self.wanted() {
            self.open.push(Part { bound, chord });
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, dvec3};

    use super::*;
    use crate::{geom::curve::Turn, kernel::brep::primitive::cuboid};

    fn turn(r: f64, rise: f64, to: f64) -> Curve {
        let (x, y, rise) = (DVec3::X * r, DVec3::Y * r, DVec3::Z * rise);
        Curve::turn(Turn { center: DVec3::ZERO, x, y, rise, from: 0.0, to })
    }

    #[test]
    fn closed_forms() {
        let cube = cuboid(DVec3::splat(-2.0), DVec3::splat(2.0));
        let diagonal = 8.0f64.sqrt();
        let lifted = |z: f64| {
            turn(1.0, 0.0, 360.0).placed(&crate::geom::Placement::translation(DVec3::Z * z))
        };
        let cases = [
            (turn(10.0, 0.0, 360.0), 10.0 - diagonal),
            (turn(10.0, 1.0, 720.0), 10.0 - diagonal),
            // Touching edges, lying on a face, above one.
            (turn(diagonal, 0.0, 360.0), 0.0),
            (lifted(2.0), 0.0),
            (lifted(5.0), 3.0),
        ];
        for (i, (way, expected)) in cases.iter().enumerate() {
            let found = curve(&cube, way).expect("a solid");
            assert!((found - expected).abs() < 1e-7, "{i}: {found} {expected}");
        }
        // All inside, and one that passes through.
        let inside = curve(&cube, &turn(0.5, 0.0, 360.0)).expect("a solid");
        assert!((inside + 2.0 - 0.125f64.sqrt()).abs() < 2e-3, "{inside}");
        let through =
            Curve::polyline(&[dvec3(-9., 0.5, 0.), dvec3(9., 0.5, 0.)], false).expect("a line");
        assert!((curve(&cube, &through).expect("a solid") + 1.5).abs() < 2e-3);
        assert_eq!(curve(&Polyhedron::empty(), &through), None);
    }
}
