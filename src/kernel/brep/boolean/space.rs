//! The planes and points of one operation, each known by one number.
//!
//! Equal planes have equal numbers, equal points have equal numbers, whatever they were found from:
//! coplanarity and coincidence are integer comparisons everywhere else. A point is a lattice point
//! or the point where three planes meet; it is never rounded here.

use std::cmp::Ordering;

use rustc_hash::FxHashMap;

use super::hierarchy::Bounds;
use crate::geom::predicates::{Int3, Meet, Plane, cross, minus};

/// The number of no plane.
pub(super) const NONE: u32 = u32::MAX;

/// A plane with its doubles, for filters.
#[derive(Clone)]
struct Stored {
    plane: Plane,
    normal: [f64; 3],
    offset: f64,
}

/// A point: where it is, nearly, and the three planes that define it ([`NONE`] for lattice points).
#[derive(Clone)]
struct Point {
    near: [f64; 3],
    planes: [u32; 3],
    /// The point stored before it in the same cell of the grid, or [`NONE`].
    before: u32,
}

/// How far `near` may be from the point, in steps: numerators and denominators are converted with a
/// relative error of 2^-51 and divided, coordinates are below 2^29, so 2^-20 is ample.
pub(super) const NEAR: f64 = 1.0 / (1u64 << 20) as f64;

/// Relative error of the doubles in a plane equation, with room for the sums.
const PLANE_ERROR: f64 = 8.0 * f64::EPSILON;

/// Shift of the grid that points are looked up in, so that whole coordinates, the most frequent
/// ones, are far from the borders of cells.
const GRID_SHIFT: f64 = 0.3;

/// How far a point is from a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Offset {
    /// 1 where the normal points, 0 on the plane, else -1; exactly.
    pub sign: i32,
    /// The value of the plane's equation, nearly.
    pub value: f64,
    /// How wrong the value may be.
    pub error: f64,
}

/// All planes and points of an operation.
#[derive(Clone, Default)]
pub(super) struct Space {
    planes: Vec<Stored>,
    plane_numbers: FxHashMap<Plane, u32>,
    points: Vec<Point>,
    lattice: FxHashMap<[i32; 3], u32>,
    meets: FxHashMap<[u32; 3], u32>,
    /// The last point of three planes in each cell of a grid.
    cells: FxHashMap<[i32; 3], u32>,
    edges: FxHashMap<(u32, u32), [u32; 2]>,
    /// The points where edges, known by their ends, meet planes.
    pierced: FxHashMap<(u32, u32, u32), u32>,
}

impl Space {
    /// The number of a plane.
    pub fn add_plane(&mut self, plane: Plane) -> u32 {
        if let Some(&known) = self.plane_numbers.get(&plane) {
            return known;
        }
        let number = self.store_plane(plane);
        self.plane_numbers.insert(plane, number);
        number
    }

    fn store_plane(&mut self, plane: Plane) -> u32 {
        let (normal, offset) = (plane.normal.map(|c| c as f64), plane.offset as f64);
        self.planes.push(Stored { plane, normal, offset });
        self.planes.len() as u32 - 1
    }

    /// The plane of a number.
    pub fn plane(&self, plane: u32) -> &Plane {
        &self.planes[plane as usize].plane
    }

    /// The number of planes so far.
    pub fn plane_count(&self) -> usize {
        self.planes.len()
    }

    /// The number of points so far.
    pub fn point_count(&self) -> usize {
        self.points.len()
    }

    /// The number of a lattice point.
    pub fn add_lattice_point(&mut self, at: Int3) -> u32 {
        let points = &mut self.points;
        *self.lattice.entry(at.map(|c| c as i32)).or_insert_with(|| {
            points.push(Point { near: at.map(|c| c as f64), planes: [NONE; 3], before: NONE });
            points.len() as u32 - 1
        })
    }

    /// The coordinates of a point if it was added as a lattice point.
    pub fn lattice_point(&self, point: u32) -> Option<Int3> {
        let point = &self.points[point as usize];
        (point.planes[0] == NONE).then(|| point.near.map(|c| c as i64))
    }

    /// Whether all coordinates of a point are whole, however it was found.
    pub fn is_on_lattice(&self, point: u32) -> bool {
        self.near(point).into_iter().all(is_whole)
    }

    /// The coordinates of a point in steps, with an error far below one step; whole numbers exactly.
    pub fn near(&self, point: u32) -> [f64; 3] {
        self.points[point as usize].near
    }

    /// The exact coordinates of a point.
    pub fn exact(&self, point: u32) -> Meet {
        let point = &self.points[point as usize];
        if point.planes[0] == NONE {
            return Meet::lattice(point.near.map(|c| c as i64));
        }
        let [a, b, c] = point.planes.map(|p| self.plane(p));
        Meet::of(a, b, c).expect("a stored point is defined by independent planes")
    }

    /// The number of the point where three planes meet; `None` if they do not meet in one point.
    pub fn meet(&mut self, a: u32, b: u32, c: u32) -> Option<u32> {
        let mut planes = [a, b, c];
        planes.sort_unstable();
        if let Some(&point) = self.meets.get(&planes) {
            return Some(point);
        }
        let point = self.met(planes)?;
        self.meets.insert(planes, point);
        Some(point)
    }

    /// The point where three planes meet, if it was [met](Space::meet) before.
    pub fn known_meet(&self, mut planes: [u32; 3]) -> Option<u32> {
        planes.sort_unstable();
        self.meets.get(&planes).copied()
    }

    fn met(&mut self, planes: [u32; 3]) -> Option<u32> {
        let [a, b, c] = planes.map(|plane| self.plane(plane));
        let exact = Meet::of(a, b, c)?;
        let mut near = exact.approximate();
        for (axis, c) in near.iter_mut().enumerate() {
            let whole = whole(*c + 0.5);
            if (*c - whole).abs() > NEAR {
                continue;
            }
            if exact.is_at(axis, whole as i64) {
                *c = whole;
            } else if *c == whole {
                // Only coordinates that are whole look so.
                *c = c.next_up();
            }
        }
        Some(self.known_at(near, planes).unwrap_or_else(|| self.store(near, planes)))
    }

    /// The stored point that lies on all three planes, among those near the place.
    fn known_at(&self, near: [f64; 3], planes: [u32; 3]) -> Option<u32> {
        let same = |point: u32| {
            let there = self.points[point as usize].near;
            (0..3).all(|i| (there[i] - near[i]).abs() <= 2.0 * NEAR)
                && planes.iter().all(|&p| self.side(point, p) == 0)
        };
        if near.iter().all(|&c| is_whole(c)) {
            let found = self.lattice.get(&near.map(|c| c as i32)).copied();
            if found.is_some_and(same) {
                return found;
            }
        }
        let low = near.map(|c| cell(c - 2.0 * NEAR));
        let high = near.map(|c| cell(c + 2.0 * NEAR));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let mut next = self.cells.get(&[x, y, z]).copied().unwrap_or(NONE);
                    while next != NONE {
                        if same(next) {
                            return Some(next);
                        }
                        next = self.points[next as usize].before;
                    }
                }
            }
        }
        None
    }

    fn store(&mut self, near: [f64; 3], planes: [u32; 3]) -> u32 {
        let point = self.points.len() as u32;
        let before = self.cells.insert(near.map(cell), point).unwrap_or(NONE);
        self.points.push(Point { near, planes, before });
        point
    }

    /// The planes that define a point, [`NONE`] for a lattice point.
    pub fn planes_of(&self, point: u32) -> [u32; 3] {
        self.points[point as usize].planes
    }

    /// The number here of a plane of another space.
    pub fn adopt_plane(&mut self, plane: u32, from: &Space) -> u32 {
        let exact = *from.plane(plane);
        let is_looked_up = from.plane_numbers.get(&exact) == Some(&plane);
        if is_looked_up { self.add_plane(exact) } else { self.store_plane(exact) }
    }

    /// The number here of a point of another space, given the numbers here of the planes that define it.
    pub fn adopt_point(&mut self, point: u32, planes: [u32; 3], from: &Space) -> u32 {
        if let Some(at) = from.lattice_point(point) {
            return self.add_lattice_point(at);
        }
        let near = from.near(point);
        self.known_at(near, planes).unwrap_or_else(|| self.store(near, planes))
    }

    /// The sign of a point to a plane: 1 where its normal points, 0 on it, else -1.
    pub fn side(&self, point: u32, plane: u32) -> i32 {
        self.offset(point, plane).sign
    }

    /// How far, in lengths of its normal, a point is from a plane.
    pub fn offset(&self, point: u32, plane: u32) -> Offset {
        let (p, stored) = (&self.points[point as usize], &self.planes[plane as usize]);
        if p.planes.contains(&plane) {
            return Offset { sign: 0, value: 0.0, error: 0.0 };
        }
        let (mut value, mut size, mut slope) = (-stored.offset, stored.offset.abs(), 0.0);
        for axis in 0..3 {
            let term = stored.normal[axis] * p.near[axis];
            value += term;
            size += term.abs();
            slope += stored.normal[axis].abs();
        }
        let error = size * PLANE_ERROR + slope * NEAR;
        if value.abs() > error {
            return Offset { sign: if value > 0.0 { 1 } else { -1 }, value, error };
        }
        let sign = if p.planes[0] == NONE {
            stored.plane.side(p.near.map(|c| c as i64))
        } else {
            stored.plane.side_of(&self.exact(point))
        };
        Offset { sign, value, error }
    }

    /// Compares one coordinate of two points.
    pub fn compare(&self, a: u32, b: u32, axis: usize) -> Ordering {
        let (p, q) = (&self.points[a as usize], &self.points[b as usize]);
        let difference = p.near[axis] - q.near[axis];
        let whole = is_whole(p.near[axis]) && is_whole(q.near[axis]);
        if a == b {
            Ordering::Equal
        } else if whole || difference.abs() > 2.0 * NEAR {
            difference.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
        } else {
            self.exact(a).compare(&self.exact(b), axis)
        }
    }

    /// An axis along which two different points differ, and the sign of `b` - `a` along it.
    pub fn direction(&self, a: u32, b: u32) -> (usize, i32) {
        let (p, q) = (self.near(a), self.near(b));
        let size = |axis: usize| (q[axis] - p[axis]).abs();
        let mut axes = [0, 1, 2];
        axes.sort_by(|&i, &j| size(j).total_cmp(&size(i)));
        for axis in axes {
            match self.compare(a, b, axis) {
                Ordering::Less => return (axis, 1),
                Ordering::Greater => return (axis, -1),
                Ordering::Equal => {}
            }
        }
        (0, 0)
    }

    /// Two planes, each along an axis, that meet in the line through two lattice points.
    fn edge_planes(&mut self, a: u32, b: u32) -> [u32; 2] {
        let key = (a.min(b), a.max(b));
        if let Some(&planes) = self.edges.get(&key) {
            return planes;
        }
        let [p, q] = [key.0, key.1].map(|i| self.points[i as usize].near.map(|c| c as i64));
        let d = minus(q, p);
        let main = (0..3).max_by_key(|&i| (d[i].abs(), 2 - i)).unwrap_or(0);
        let planes = [(main + 1) % 3, (main + 2) % 3].map(|other| {
            let mut normal = [0; 3];
            (normal[other], normal[main]) = (d[main], -d[other]);
            // Not reduced and not looked up: nobody asks whether it is a facet's plane.
            self.store_plane(Plane::across(normal, p))
        });
        self.edges.insert(key, planes);
        planes
    }

    /// The plane along an axis that cuts `plane` best in the line through two lattice points.
    pub fn support(&mut self, a: u32, b: u32, plane: u32) -> u32 {
        let [first, second] = self.edge_planes(a, b);
        let tilt = |other: u32| {
            let (m, n) = (&self.planes[plane as usize].normal, &self.planes[other as usize].normal);
            let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            dot(m, n).powi(2) / dot(n, n)
        };
        if tilt(second) < tilt(first) { second } else { first }
    }

    /// The point where an edge meets a plane that its ends are on different sides of. The edge is in
    /// `own` and `support`; without a support its ends are lattice points.
    pub fn pierce(&mut self, (a, b): (u32, u32), (own, support): (u32, u32), plane: u32) -> u32 {
        let key = (a.min(b), a.max(b), plane);
        if let Some(&point) = self.pierced.get(&key) {
            return point;
        }
        let [first, second] = if support == NONE { self.edge_planes(a, b) } else { [own, support] };
        let point = self.met([first, second, plane]);
        let point = point.expect("an edge that changes sides meets the plane");
        self.pierced.insert(key, point);
        point
    }

    /// The direction of the line in which two planes meet.
    pub fn line(&self, p: u32, q: u32) -> [i128; 3] {
        cross(self.plane(p).normal, self.plane(q).normal)
    }

    /// A box of lattice points around a point; just the point if it is one.
    pub fn bounds(&self, point: u32) -> Bounds {
        let Point { near, planes, .. } = &self.points[point as usize];
        if planes[0] == NONE {
            let at = near.map(|c| c as i32);
            return Bounds { min: at, max: at };
        }
        let [min, max] = [-NEAR, NEAR].map(|margin| near.map(|c| c + margin));
        Bounds { min: min.map(|c| whole(c) as i32), max: max.map(|c| -whole(-c) as i32) }
    }
}

/// The index of the axis with the largest component.
pub(super) fn main_axis(v: [i128; 3]) -> usize {
    (0..3).max_by_key(|&i| (v[i].unsigned_abs(), 2 - i)).unwrap_or(0)
}

fn cell(coordinate: f64) -> i32 {
    whole(coordinate + GRID_SHIFT) as i32
}

/// The greatest whole number that is not greater than a coordinate. Coordinates fit into an integer,
/// which is found faster than by rounding.
fn whole(coordinate: f64) -> f64 {
    let cut = coordinate as i64 as f64;
    if cut > coordinate { cut - 1.0 } else { cut }
}

/// Whether a coordinate is a whole number; stored coordinates only look whole if they are.
fn is_whole(coordinate: f64) -> bool {
    coordinate as i64 as f64 == coordinate
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(space: &mut Space, normal: [i128; 3], point: Int3) -> u32 {
        space.add_plane(Plane::through(normal, point).expect("a direction").0)
    }

    #[test]
    fn the_same_point_from_other_planes_has_the_same_number() {
        let mut space = Space::default();
        let x = plane(&mut space, [2, 1, 0], [1, 0, 0]);
        let y = plane(&mut space, [-1, 3, 0], [0, 0, 0]);
        let z = plane(&mut space, [0, 0, 1], [0, 0, 5]);
        let point = space.meet(x, y, z).expect("one point");
        assert!((space.near(point)[0] - 6.0 / 7.0).abs() < 1e-12);
        // x = 6/7, y = 2/7: on x - 3y = 0 and on x + 4y = 2.
        let other = plane(&mut space, [1, 4, 0], [2, 0, 9]);
        assert_eq!(space.meet(other, z, x), Some(point));
        assert_eq!(space.meet(x, y, x), None);
    }

    #[test]
    fn a_meet_on_a_known_lattice_point_is_that_point() {
        let mut space = Space::default();
        let corner = space.add_lattice_point([3, 4, 5]);
        let planes = [[1, 0, 0], [1, 1, 0], [7, -2, 9]].map(|n| plane(&mut space, n, [3, 4, 5]));
        assert_eq!(space.meet(planes[0], planes[1], planes[2]), Some(corner));
        assert_eq!(space.side(corner, planes[2]), 0);
    }

    #[test]
    fn supports_hold_their_edge() {
        let mut space = Space::default();
        let a = space.add_lattice_point([0, 0, 0]);
        let b = space.add_lattice_point([4, -6, 2]);
        let floor = plane(&mut space, [6, 4, 0], [0, 0, 0]);
        let support = space.support(a, b, floor);
        assert_ne!(support, floor);
        assert_eq!((space.side(a, support), space.side(b, support)), (0, 0));
        assert_eq!(space.direction(a, b), (1, -1));
    }
}
