//! The hypersphere test: does the sphere about a point reach a solid?
//!
//! Tatehara, S., Tanaka, N., Tatsumi, S., Tokumasu, S.: *Object-oriented expression for complex 3-D shapes*,
//! where a point is in the solid grown by r if the sphere of radius r about it meets the solid. The surface of
//! the sphere is unrolled to (z, angle); an area halves as long as it is undecided (the spherical quadtree), or
//! random points of it are tried (Monte Carlo).
//!
//! | paper | here | meaning |
//! |---|---|---|
//! | (z, angle) | `Patch` | an area of the unrolled sphere |
//! | in, out, undecided | [`Hypersphere::least`] | the least distance of the sphere's points from the solid |
//! | N random points | [`Test::MonteCarlo`] | the same points about every centre, from a seed |
//!
//! # Departures
//! A solid that lies wholly inside of the sphere does not meet its surface: the paper calls its centre out, and a
//! small solid grown by a large radius comes out hollow. Here one point of every piece of the solid is asked
//! too, whether it lies inside of the sphere; where the surface misses the solid, that decides.
//!
//! The paper asks for a yes or no. Here the least distance itself is sought, by branch and bound, so that the
//! surface between yes and no can be found as that of any other field.

use std::{f64::consts::TAU, sync::Arc};

use glam::DVec3;

use super::{
    Apart, Field, Polyhedral,
    contour::{Level, Look},
    half_diagonal,
};
use crate::geom::{Bounds, Tolerance};

/// How the least distance of a sphere's points is found.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Test {
    /// By the nearest point of the boundary.
    Exact,
    /// By halving areas of the sphere.
    Quadtree,
    /// By random points of the sphere.
    MonteCarlo {
        /// How many.
        n: u32,
        /// Where the random numbers begin.
        seed: u64,
    },
}

/// A part of the unrolled sphere: z from -1 to 1, the angle from 0 to 2 pi.
#[derive(Clone, Debug)]
struct Patch {
    z: [f64; 2],
    angle: [f64; 2],
    /// The random points in it, by their places in the list.
    points: std::ops::Range<usize>,
}

/// A point of the unit sphere.
fn unrolled(z: f64, angle: f64) -> DVec3 {
    let wide = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(wide * libm::cos(angle), wide * libm::sin(angle), z)
}

impl Patch {
    const WHOLE: Patch = Patch { z: [-1.0, 1.0], angle: [0.0, TAU], points: 0..0 };

    fn middle(&self) -> [f64; 2] {
        [(self.z[0] + self.z[1]) / 2.0, (self.angle[0] + self.angle[1]) / 2.0]
    }

    /// How far its points are from its middle at most, on the unit sphere: along the meridian and then along the
    /// circle of latitude.
    fn reach(&self) -> f64 {
        let [z, _] = self.middle();
        let [low, high] = self.z.map(libm::asin);
        let along = (high - libm::asin(z)).max(libm::asin(z) - low);
        let widest =
            if self.z[0] * self.z[1] < 0.0 { 0.0 } else { self.z[0].abs().min(self.z[1].abs()) };
        along + (self.angle[1] - self.angle[0]) / 2.0 * (1.0 - widest * widest).sqrt()
    }

    /// Its two halves, across the longer side. Random points go with the half they lie in.
    fn halves(&self, points: &mut [(f64, f64)]) -> [Patch; 2] {
        let [z, angle] = self.middle();
        let wide = (1.0 - z * z).sqrt() * (self.angle[1] - self.angle[0]);
        let tall = libm::asin(self.z[1]) - libm::asin(self.z[0]);
        let own = &mut points[self.points.clone()];
        let (first, second) = (self.clone(), self.clone());
        if tall >= wide {
            own.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            let cut = self.points.start + own.partition_point(|p| p.0 < z);
            return [
                Patch { z: [self.z[0], z], points: self.points.start..cut, ..first },
                Patch { z: [z, self.z[1]], points: cut..self.points.end, ..second },
            ];
        }
        own.sort_unstable_by(|a, b| a.1.total_cmp(&b.1));
        let cut = self.points.start + own.partition_point(|p| p.1 < angle);
        [
            Patch { angle: [self.angle[0], angle], points: self.points.start..cut, ..first },
            Patch { angle: [angle, self.angle[1]], points: cut..self.points.end, ..second },
        ]
    }
}

/// A node of the quadtree, made once for all centres: the direction of its middle, its reach and its children.
#[derive(Clone, Debug)]
struct Node {
    middle: DVec3,
    reach: f64,
    /// The first of two children; 0 for a leaf.
    children: u32,
    /// The random points of a leaf.
    points: Vec<DVec3>,
}

/// Spheres about points against a solid.
#[derive(Clone, Debug)]
pub struct Hypersphere<'a> {
    solid: &'a Polyhedral,
    /// What the surface is near to in a cell.
    apart: Apart<'a>,
    by: f64,
    test: Test,
    nodes: Arc<[Node]>,
    /// A point of every piece of the boundary.
    pieces: Arc<[DVec3]>,
}

/// Random points that a leaf of the quadtree holds at most.
const FEW: usize = 4;

impl<'a> Hypersphere<'a> {
    /// Spheres whose radius is `by` mm: against the solid for a positive one, against what is not in it for a
    /// negative one. Areas of the sphere are halved until the distance is sure within a part of the tolerance.
    pub fn new(
        solid: &'a Polyhedral,
        by: f64,
        test: Test,
        tolerance: Tolerance,
    ) -> Hypersphere<'a> {
        let mut points = match test {
            Test::MonteCarlo { n, seed } => random_points(n, seed),
            _ => vec![],
        };
        // The distance of the middle of an area is that of its best point within the radius times its reach.
        let least = (tolerance.mm() / (2.0 * by.abs())).clamp(LEAST_REACH, 1.0);
        let fine = |patch: &Patch| match test {
            Test::MonteCarlo { .. } => patch.points.len() <= FEW,
            _ => patch.reach() <= least,
        };
        let mut open = vec![(0usize, Patch { points: 0..points.len(), ..Patch::WHOLE })];
        let mut nodes = vec![node(&open[0].1)];
        while let Some((i, patch)) = open.pop() {
            if fine(&patch) {
                let own = &points[patch.points.clone()];
                nodes[i].points = own.iter().map(|&(z, angle)| unrolled(z, angle)).collect();
                continue;
            }
            nodes[i].children = nodes.len() as u32;
            for half in patch.halves(&mut points) {
                open.push((nodes.len(), half.clone()));
                nodes.push(node(&half));
            }
        }
        let pieces = solid.pieces().into();
        let apart = Apart::new(solid, by);
        Hypersphere { solid, apart, by, test, nodes: nodes.into(), pieces }
    }

    /// The least distance from the solid (for a negative radius from what is not in it) of the points of the
    /// sphere about a centre, negative inside.
    ///
    /// ```
    /// use glam::DVec3;
    /// use katachi::geom::Tolerance;
    /// use katachi::kernel::{brep::primitive::cuboid, field::{Hypersphere, Polyhedral, Test}};
    /// let cube = Polyhedral::new(cuboid(DVec3::ZERO, DVec3::splat(2.0)).mesh()).unwrap();
    /// let sphere = Hypersphere::new(&cube, 1.0, Test::Quadtree, Tolerance::DEFAULT);
    /// assert!((sphere.least(DVec3::new(1.0, 1.0, 5.0)) - 2.0).abs() < 0.05);
    /// ```
    pub fn least(&self, centre: DVec3) -> f64 {
        let (side, radius) = (self.by.signum(), self.by.abs());
        let at = |towards: DVec3| side * self.solid.distance(centre + towards * radius);
        let mut best = f64::INFINITY;
        let mut open = vec![(f64::NEG_INFINITY, 0usize)];
        while let Some((bound, i)) = open.pop() {
            let node = &self.nodes[i];
            if bound >= best {
                continue;
            }
            if node.children == 0 {
                let sampled = node.points.iter().map(|&p| at(p)).fold(f64::INFINITY, f64::min);
                best = best.min(if self.is_random() { sampled } else { at(node.middle) });
                continue;
            }
            let first = node.children as usize;
            let mut pair = [first, first + 1].map(|child| {
                let node = &self.nodes[child];
                (at(node.middle) - radius * node.reach, child)
            });
            pair.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
            open.extend(pair.iter().filter(|p| p.0 < best));
        }
        best
    }

    fn is_random(&self) -> bool {
        matches!(self.test, Test::MonteCarlo { .. })
    }

    /// Whether a piece of the boundary lies inside of the sphere about a centre.
    fn swallows(&self, centre: DVec3) -> bool {
        self.pieces.iter().any(|p| p.distance(centre) <= self.by.abs())
    }
}

/// Areas smaller than this, on the unit sphere, are not halved.
const LEAST_REACH: f64 = 0.01;

fn node(patch: &Patch) -> Node {
    let [z, angle] = patch.middle();
    Node { middle: unrolled(z, angle), reach: patch.reach(), children: 0, points: vec![] }
}

/// Uniform points of the unrolled sphere.
fn random_points(n: u32, seed: u64) -> Vec<(f64, f64)> {
    // SplitMix64: Steele, Lea, Flood, *Fast splittable pseudorandom number generators*, 2014.
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(|_| (2.0 * next() - 1.0, TAU * next())).collect()
}

impl Level for Hypersphere<'_> {
    /// In: as deep as `by` tells. Out farther than the radius: out. Between the two the sphere decides.
    fn value(&self, p: DVec3) -> f64 {
        let (side, radius) = (self.by.signum(), self.by.abs());
        let away = side * self.apart.distance(p);
        if away <= 0.0 || away > radius {
            return side * (away - radius);
        }
        let least = self.least(p);
        let reached = if least > 0.0 && self.swallows(p) { away - radius } else { least };
        side * reached
    }

    fn gradient(&self, p: DVec3) -> DVec3 {
        self.apart.gradient(p)
    }

    fn off(&self, p: DVec3) -> f64 {
        self.value(p).abs()
    }

    fn look(&self, cell: &Bounds) -> Look {
        let away = self.by.signum() * self.apart.distance(cell.center());
        // The least distance found is not below the true one: what is sure inside by the true one is not.
        match self.apart.look(cell) {
            Look::Clear => match away.abs() > half_diagonal(cell) {
                true if away < 0.0 || away - half_diagonal(cell) > self.by.abs() => Look::Clear,
                _ => Look::Sheet,
            },
            look => look,
        }
    }

    fn within(&self, cell: &Bounds) -> Self {
        // Spheres reach out of the cell, and so ask the whole solid.
        Hypersphere { apart: self.apart.within(cell), ..self.clone() }
    }
}
