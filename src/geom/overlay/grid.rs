//! The integer grid an overlay is computed on, and the way back from it.

use glam::{DVec2, dvec2};
use i_overlay::i_float::int::point::IntPoint;
use rustc_hash::FxHashMap;

use crate::geom::region::{Contour, EdgeCurve};

/// Grid steps between the origin and the largest coordinate: 2^40. Far finer than what printing or
/// drawing shows, far coarser than the rounding of a chain of placements, so that corners meant to be
/// equal are.
const STEPS: i32 = 40;

/// A point of the grid.
pub(super) type GridPoint = IntPoint<i64>;

/// An edge as given, its ends on the grid.
pub(super) struct Edge {
    /// Its first end on the grid.
    pub a: GridPoint,
    /// Its second end on the grid.
    pub b: GridPoint,
    /// Its first end as given.
    pub from: DVec2,
    /// Its second end as given.
    pub to: DVec2,
    /// The curve it stands for.
    pub curve: EdgeCurve,
}

/// The given edges on the grid.
pub(super) struct Grid {
    /// Millimetres for each step, a power of two.
    step: f64,
    /// The coordinates as given, by grid point.
    given: FxHashMap<(i64, i64), DVec2>,
    /// The grid points in use, in order of x, then y.
    corners: Vec<GridPoint>,
    /// The edges of the subject, then those of the clip.
    pub edges: Vec<Edge>,
    /// The number of the first edge of the clip.
    pub clip_start: usize,
}

impl Grid {
    /// The edges of two sets of contours.
    pub fn new(subject: &[&Contour], clip: &[&Contour]) -> Grid {
        let points = subject.iter().chain(clip).flat_map(|c| &c.points);
        let reach = points.fold(0.0_f64, |most, p| most.max(p.x.abs()).max(p.y.abs()));
        let step = libm::scalbn(1.0, exponent(reach) - STEPS);
        let (given, corners) = (FxHashMap::default(), vec![]);
        let mut grid = Grid { step, given, corners, edges: vec![], clip_start: 0 };
        subject.iter().for_each(|c| grid.push(c));
        grid.clip_start = grid.edges.len();
        clip.iter().for_each(|c| grid.push(c));
        grid.corners = grid.given.keys().map(|&(x, y)| GridPoint { x, y }).collect();
        grid.corners.sort_unstable_by_key(|p| (p.x, p.y));
        grid
    }

    fn push(&mut self, contour: &Contour) {
        let points = &contour.points;
        let places: Vec<GridPoint> = points.iter().map(|&p| self.weld(p)).collect();
        for i in 0..points.len() {
            let next = if i + 1 == points.len() { 0 } else { i + 1 };
            if places[i] != places[next] {
                let (a, b) = (places[i], places[next]);
                let curve = contour.curves[i];
                let (from, to) = (self.given_at(a), self.given_at(b));
                self.edges.push(Edge { a, b, from, to, curve });
            }
        }
    }

    /// The grid point of a given corner: that of an earlier one in a neighbouring cell, if any.
    fn weld(&mut self, p: DVec2) -> GridPoint {
        let (x, y) = ((p.x / self.step).round() as i64, (p.y / self.step).round() as i64);
        const NEAR: [(i64, i64); 9] =
            [(0, 0), (-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (-1, 1), (1, -1), (1, 1)];
        for (dx, dy) in NEAR {
            if self.given.contains_key(&(x + dx, y + dy)) {
                return GridPoint { x: x + dx, y: y + dy };
            }
        }
        self.given.insert((x, y), p);
        GridPoint { x, y }
    }

    /// An edge cut at the corners that lie on it to within one step.
    pub fn parts(&self, edge: &Edge) -> impl Iterator<Item = (GridPoint, GridPoint)> {
        let along = |p: GridPoint| {
            let (dx, dy) = (edge.b.x - edge.a.x, edge.b.y - edge.a.y);
            i128::from(p.x - edge.a.x) * i128::from(dx)
                + i128::from(p.y - edge.a.y) * i128::from(dy)
        };
        let mut stops: Vec<GridPoint> = self.corners_on(edge).collect();
        stops.sort_by_key(|&p| along(p));
        stops.insert(0, edge.a);
        stops.push(edge.b);
        (1..stops.len()).map(move |i| (stops[i - 1], stops[i]))
    }

    fn corners_on(&self, edge: &Edge) -> impl Iterator<Item = GridPoint> {
        let (left, right) = (edge.a.x.min(edge.b.x), edge.a.x.max(edge.b.x));
        let (low, high) = (edge.a.y.min(edge.b.y), edge.a.y.max(edge.b.y));
        let first = self.corners.partition_point(|p| p.x < left - 1);
        let (a, b) = (edge.a, edge.b);
        let inside = move |p: &GridPoint| {
            p.y >= low - 1 && p.y <= high + 1 && *p != a && *p != b && is_on(a, b, *p)
        };
        self.corners[first..].iter().take_while(move |p| p.x <= right + 1).copied().filter(inside)
    }

    /// The coordinates as given of a corner in use.
    fn given_at(&self, p: GridPoint) -> DVec2 {
        self.given[&(p.x, p.y)]
    }

    /// The coordinates of a corner of the result between parts of two given edges.
    pub fn coordinates(&self, p: GridPoint, before: usize, after: usize) -> DVec2 {
        if let Some(&given) = self.given.get(&(p.x, p.y)) {
            return given;
        }
        let rounded = dvec2(p.x as f64, p.y as f64) * self.step;
        let (e, f) = (&self.edges[before], &self.edges[after]);
        match crossing(e, f) {
            Some(exact) if (exact - rounded).abs().max_element() <= 2.0 * self.step => exact,
            _ => rounded,
        }
    }
}

/// The exponent of the power of two at or above `reach`; that of 2^-20 for smaller figures.
fn exponent(reach: f64) -> i32 {
    const LEAST: i32 = -20;
    let (_, exponent) = libm::frexp(reach);
    exponent.max(LEAST)
}

/// Whether `p` is nearer than one step to the segment from `a` to `b`, and between its ends.
fn is_on(a: GridPoint, b: GridPoint, p: GridPoint) -> bool {
    let (dx, dy) = (i128::from(b.x - a.x), i128::from(b.y - a.y));
    let (px, py) = (i128::from(p.x - a.x), i128::from(p.y - a.y));
    let square = dx * dx + dy * dy;
    let along = px * dx + py * dy;
    // The square of a cross product of 41-bit vectors does not fit 128 bits: compared as roots.
    let off = (px * dy - py * dx).abs() as f64;
    along > 0 && along < square && off <= libm::sqrt(square as f64)
}

/// Where the lines of two edges cross; on an edge along an axis that coordinate is the one given.
fn crossing(e: &Edge, f: &Edge) -> Option<DVec2> {
    let (d, g) = (e.to - e.from, f.to - f.from);
    let area = d.perp_dot(g);
    let t = (f.from - e.from).perp_dot(g) / area;
    let mut point = e.from + d * t;
    if g.x == 0.0 {
        point.x = f.from.x;
    }
    if g.y == 0.0 {
        point.y = f.from.y;
    }
    point.is_finite().then_some(point)
}
