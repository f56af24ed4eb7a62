//! The least distance of two curves, by branch and bound.
//!
//! A part of a curve stays near its chord. So two parts are no nearer than their chords are, less how far either may be off
//! its own; the two parts that may be nearest are looked at first, and the one that is farther off is halved.

use std::{cmp::Ordering, collections::BinaryHeap};

use super::{Chord, Curve, Piece};
use crate::geom::{Bounds, bvh::Bvh, nearest::of_segments};

/// Distances that differ by less than this part of the size of both curves are one.
const NEAR: f64 = 1e-9;

/// What rounding makes of distances, relative to coordinates.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Pairs of parts that are halved at most: helices side by side need some hundred thousand.
const MOST: usize = 1_000_000;

/// Pairs of parts of two pieces that are halved after they are known to be near enough.
const FURTHER: u32 = 100;

impl Curve {
    /// The least distance to another curve, mm: that of two points of them, and by no more than 1e-9 of their size above
    /// the least, or by what a million pairs of parts have told; 0 where they meet.
    ///
    /// ```
    /// use glam::dvec3;
    /// use katachi::geom::Curve;
    /// let low = Curve::polyline(&[dvec3(-9., 0., 0.), dvec3(9., 1., 0.)], false).unwrap();
    /// let high = Curve::polyline(&[dvec3(0., -9., 5.), dvec3(1., 9., 5.)], false).unwrap();
    /// assert_eq!(low.distance(&high), 5.0);
    /// ```
    pub fn distance(&self, other: &Curve) -> f64 {
        let boxes = [self, other].map(|curve| curve.pieces.iter().map(Piece::bounds));
        let [own, others] = boxes.map(|boxes| boxes.collect::<Vec<Bounds>>());
        let [own, others] = [Bvh::new(&own), Bvh::new(&others)];
        let all = own.bounds().joined(&others.bounds());
        let far = all.min.abs().max(all.max.abs()).max_element();
        let near = NEAR * (all.max - all.min).length() + ROUNDING * far;
        let mut search = Search { best: f64::INFINITY, near, left: MOST };
        own.nearest_pair(&others, f64::INFINITY, |i, j| {
            search.between(&self.pieces[i as usize], &other.pieces[j as usize]);
            search.best * search.best
        });
        if search.best <= near { 0.0 } else { search.best }
    }
}

/// Two parts, which are no nearer than `bound`.
struct Pair<'a> {
    bound: f64,
    chords: [Chord<'a>; 2],
}

impl PartialEq for Pair<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Pair<'_> {}
impl PartialOrd for Pair<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Pair<'_> {
    /// The nearest is the greatest.
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound)
    }
}

struct Search {
    /// The least distance of two points so far.
    best: f64,
    near: f64,
    /// Pairs that may still be halved.
    left: usize,
}

impl Search {
    /// Looks at two pieces.
    fn between(&mut self, a: &Piece, b: &Piece) {
        let (mut open, mut further) = (BinaryHeap::new(), FURTHER);
        self.look([Chord::of(a), Chord::of(b)], &mut open);
        while let Some(Pair { bound, chords }) = open.pop() {
            // What is near enough is refined a little further: at a plain minimum that squares the error.
            let is_near = bound >= self.best - self.near;
            if self.left == 0 || bound >= self.best || (is_near && further == 0) {
                break;
            }
            self.left -= 1;
            further -= u32::from(is_near);
            let [a, b] = &chords;
            if a.off >= b.off {
                a.halves().into_iter().for_each(|a| self.look([a, b.clone()], &mut open));
            } else {
                b.halves().into_iter().for_each(|b| self.look([a.clone(), b], &mut open));
            }
        }
    }

    fn look<'a>(&mut self, chords: [Chord<'a>; 2], open: &mut BinaryHeap<Pair<'a>>) {
        let [a, b] = &chords;
        let [p, q] = of_segments(a.ends, b.ends);
        self.best = self.best.min(a.at(p).distance(b.at(q)));
        let bound = p.distance(q) - a.off - b.off;
        if bound < self.best {
            open.push(Pair { bound, chords });
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, dvec3};

    use crate::geom::{Curve, curve::Turn};

    fn circle(center: DVec3, x: DVec3, y: DVec3) -> Curve {
        Curve::turn(Turn { center, x, y, rise: DVec3::ZERO, from: 0.0, to: 360.0 })
    }

    fn helix(r: f64, rise: f64, from: f64) -> Curve {
        let (x, y, rise) = (DVec3::X * r, DVec3::Y * r, DVec3::Z * rise);
        let center = -rise * (from / 360.0);
        Curve::turn(Turn { center, x, y, rise, from, to: from + 1080.0 })
    }

    fn line(a: DVec3, b: DVec3) -> Curve {
        Curve::polyline(&[a, b], false).expect("a line")
    }

    #[test]
    fn closed_forms() {
        let flat = circle(DVec3::ZERO, DVec3::X * 3.0, DVec3::Y * 3.0);
        let cases = [
            // Circles one over the other, linked, and one in the other.
            (circle(DVec3::Z * 4.0, DVec3::X * 6.0, DVec3::Y * 6.0), 5.0),
            (circle(DVec3::X * 3.0, DVec3::X * 0.5, DVec3::Z * 0.5), 0.5),
            (circle(DVec3::X, DVec3::X * 0.5, DVec3::Y * 0.5), 1.5),
            // Touching, crossing, the same.
            (circle(DVec3::X * 5.0, DVec3::X * 2.0, DVec3::Y * 2.0), 0.0),
            (circle(DVec3::X * 4.0, DVec3::X * 2.0, DVec3::Y * 2.0), 0.0),
            (flat.clone(), 0.0),
            // Lines beside and along its axis.
            (line(dvec3(5., -9., 1e3), dvec3(5., -9., -1e3)), 106.0f64.sqrt() - 3.0),
            (line(DVec3::NEG_Z, DVec3::Z), 3.0),
        ];
        for (i, (curve, expected)) in cases.iter().enumerate() {
            for found in [flat.distance(curve), curve.distance(&flat)] {
                assert!((found - expected).abs() < 1e-8, "{i}: {found} {expected}");
            }
        }
    }

    #[test]
    fn helices_keep_from_their_axis_and_from_one_another() {
        let own = helix(5.0, 2.0, 0.0);
        assert!((own.distance(&line(DVec3::NEG_Z * 9.0, DVec3::Z * 30.0)) - 5.0).abs() < 1e-8);
        assert!((own.distance(&helix(7.0, 2.0, 0.0)) - 2.0).abs() < 1e-7);
        // Half a turn apart on one cylinder: the least of the distance over the angle between.
        let square = |turn: f64| {
            let (half, rise) = (libm::sin((turn + 0.5) * std::f64::consts::PI), 2.0 * turn);
            100.0 * half * half + rise * rise
        };
        let least = (0..100_000).map(|i| square(f64::from(i) * 1e-5)).fold(f64::INFINITY, f64::min);
        let found = own.distance(&helix(5.0, 2.0, 180.0));
        assert!((found - least.sqrt()).abs() < 1e-6, "{found} {}", least.sqrt());
    }

    #[test]
    fn many_pieces_are_quick() {
        let wave = |y: f64| {
            let points: Vec<DVec3> = (0..20_000)
                .map(|i| {
                    let x = f64::from(i) * 0.01;
                    dvec3(x, y + libm::sin(x), libm::cos(3.0 * x))
                })
                .collect();
            Curve::spline(&points, false, [None; 2]).expect("a wave")
        };
        assert!((wave(0.0).distance(&wave(100.0)) - 98.0).abs() < 0.2);
    }
}
