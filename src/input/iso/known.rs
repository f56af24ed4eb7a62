//! Points of space that are known, by their place in the picture.

use glam::{DVec2, DVec3};
use rustc_hash::FxHashMap;

use crate::geom::isometric::nearness;

/// A point that is known.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub at: DVec3,
    pub marked: bool,
    /// Whether it counts as a vertex.
    pub registered: bool,
    place: DVec2,
}

/// All points that are known.
pub struct Known {
    pub points: Vec<Point>,
    /// Places nearer than this are one.
    pub near: f64,
    cells: FxHashMap<[i64; 2], Vec<u32>>,
}

impl Known {
    pub fn new(near: f64) -> Known {
        Known { points: vec![], near, cells: FxHashMap::default() }
    }

    fn cell(&self, place: DVec2) -> [i64; 2] {
        (place / self.near).floor().to_array().map(|c| c as i64)
    }

    /// The known points seen at a place: the marked ones first, then those near the eye.
    pub fn seen_at(&self, place: DVec2) -> Vec<u32> {
        let [x, y] = self.cell(place);
        let cells = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [x + i, y + j]));
        let near = |i: &u32| self.points[*i as usize].place.distance(place) <= self.near;
        let mut found: Vec<u32> =
            cells.filter_map(|c| self.cells.get(&c)).flatten().copied().filter(near).collect();
        let point = |i: u32| self.points[i as usize];
        found.sort_by(|&i, &j| {
            let (a, b) = (point(i), point(j));
            let front = nearness(b.at).total_cmp(&nearness(a.at));
            b.marked.cmp(&a.marked).then(front).then(i.cmp(&j))
        });
        found
    }

    /// Points of space nearer than this are one.
    pub fn reach(&self) -> f64 {
        SPREAD * self.near
    }

    /// The known point at a place that is this one.
    pub fn find(&self, at: DVec3, place: DVec2) -> Option<u32> {
        let same = |i: &u32| self.points[*i as usize].at.distance(at) <= self.reach();
        self.seen_at(place).into_iter().find(same)
    }

    /// Notes a point, or what is new of it.
    pub fn add(&mut self, at: DVec3, place: DVec2, marked: bool, registered: bool) -> u32 {
        if let Some(i) = self.find(at, place) {
            let point = &mut self.points[i as usize];
            point.marked |= marked;
            point.registered |= registered;
            return i;
        }
        let number = self.points.len() as u32;
        self.points.push(Point { at, marked, registered, place });
        self.cells.entry(self.cell(place)).or_default().push(number);
        number
    }
}

/// Points of space that are so many times nearer than places that are one are the same.
const SPREAD: f64 = 3.0;
