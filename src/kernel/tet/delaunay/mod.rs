//! The Delaunay tetrahedralisation of points, kept while points are added.
//!
//! Points are inserted along a Hilbert curve; each is found by walking from the last one, and the tetrahedra
//! whose spheres hold it are replaced by the star of it (Bowyer, Watson 1981). The outside of the hull is filled
//! with tetrahedra to a point at infinity, [`GHOST`], so that every face has two sides.

mod insert;
mod order;
mod star;

use glam::DVec3;

use super::complex::FACES;
use super::sphere::{Numbered, in_sphere, volume_sign};

/// The point at infinity.
pub(super) const GHOST: u32 = u32::MAX;
/// What stands in the first corner of a place that holds no tetrahedron.
const NOTHING: u32 = u32::MAX - 1;

/// A face of a tetrahedron: four times its number plus the corner opposite.
pub(super) type Side = u32;

/// The side of a tetrahedron opposite to a corner.
pub(super) fn side(tetrahedron: u32, corner: usize) -> Side {
    4 * tetrahedron + corner as u32
}

/// The tetrahedron of a side and the corner opposite.
pub(super) fn of_side(side: Side) -> (u32, usize) {
    (side / 4, (side % 4) as usize)
}

/// Tetrahedra over lattice points that fill the space.
#[derive(Clone, Debug, Default)]
pub(super) struct Delaunay {
    /// Lattice points.
    pub(super) points: Vec<DVec3>,
    corners: Vec<[u32; 4]>,
    across: Vec<[Side; 4]>,
    free: Vec<u32>,
    /// A tetrahedron at each point.
    at: Vec<u32>,
    /// Where the last walk ended.
    last: u32,
    marks: Marks,
}

/// Which tetrahedra a search has seen: numbers of searches, so that nothing need be cleared.
#[derive(Clone, Debug, Default)]
struct Marks {
    seen: Vec<u32>,
    round: u32,
}

impl Marks {
    /// Forgets what was seen.
    fn start(&mut self, count: usize) {
        self.seen.resize(count, 0);
        self.round += 1;
    }

    fn set(&mut self, tetrahedron: u32) {
        self.seen[tetrahedron as usize] = self.round;
    }

    fn has(&self, tetrahedron: u32) -> bool {
        self.seen.get(tetrahedron as usize) == Some(&self.round)
    }

    /// Marks one; whether it was not marked before.
    fn first(&mut self, tetrahedron: u32) -> bool {
        let new = !self.has(tetrahedron);
        self.set(tetrahedron);
        new
    }
}

impl Delaunay {
    /// The tetrahedralisation of different points, `None` when they lie in one plane.
    pub(super) fn new(points: Vec<DVec3>) -> Option<Delaunay> {
        let order = order::hilbert(&points);
        let first = order::spanning(&points, &order)?;
        let mut delaunay =
            Delaunay { at: vec![NOTHING; points.len()], points, ..Delaunay::default() };
        delaunay.begin(first);
        for point in order.into_iter().filter(|i| !first.contains(i)) {
            delaunay.insert(point);
        }
        Some(delaunay)
    }

    /// Adds a lattice point, which is none of the others, and returns its number.
    pub(super) fn add(&mut self, point: DVec3) -> u32 {
        let number = self.points.len() as u32;
        self.points.push(point);
        self.at.push(NOTHING);
        self.insert(number);
        number
    }

    /// The tetrahedra, those outside included, in the order of their numbers.
    pub(super) fn tetrahedra(&self) -> impl Iterator<Item = u32> {
        (0..self.corners.len() as u32).filter(|&t| self.corners[t as usize][0] != NOTHING)
    }

    /// One more than the largest number of a tetrahedron.
    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }

    /// The corners of a tetrahedron.
    pub(super) fn corners(&self, tetrahedron: u32) -> [u32; 4] {
        self.corners[tetrahedron as usize]
    }

    /// The side on the other side of a side.
    pub(super) fn across(&self, side: Side) -> Side {
        self.across[side as usize / 4][side as usize % 4]
    }

    /// The corners of a side, counter-clockwise seen from outside its tetrahedron.
    pub(super) fn face(&self, side: Side) -> [u32; 3] {
        let (tetrahedron, corner) = of_side(side);
        FACES[corner].map(|i| self.corners(tetrahedron)[i])
    }

    /// Whether a tetrahedron is outside the hull.
    pub(super) fn is_ghost(&self, tetrahedron: u32) -> bool {
        self.corners(tetrahedron).contains(&GHOST)
    }

    /// The sign of the volume over a triangle and a point; none is the point at infinity.
    pub(super) fn sign(&self, [a, b, c]: [u32; 3], d: u32) -> i32 {
        let p = |i: u32| self.points[i as usize];
        volume_sign(p(a), p(b), p(c), p(d))
    }

    /// A point with its number.
    pub(super) fn numbered(&self, i: u32) -> Numbered {
        (i, self.points[i as usize])
    }

    /// Whether a point is in the sphere of a tetrahedron of positive volume.
    pub(super) fn in_sphere(&self, corners: [u32; 4], point: u32) -> bool {
        in_sphere(corners.map(|i| self.numbered(i)), self.numbered(point))
    }

    /// Puts a tetrahedron at a free place, without neighbours.
    pub(super) fn push(&mut self, corners: [u32; 4]) -> u32 {
        let place = self.free.pop().unwrap_or(self.corners.len() as u32);
        if place as usize == self.corners.len() {
            self.corners.push(corners);
            self.across.push([0; 4]);
        } else {
            self.corners[place as usize] = corners;
        }
        for corner in corners.into_iter().filter(|&c| c != GHOST) {
            self.at[corner as usize] = place;
        }
        place
    }

    /// Takes a tetrahedron away; its place will be used again.
    pub(super) fn remove(&mut self, tetrahedron: u32) {
        self.corners[tetrahedron as usize][0] = NOTHING;
        self.free.push(tetrahedron);
    }

    /// Joins two sides.
    pub(super) fn join(&mut self, one: Side, other: Side) {
        self.across[one as usize / 4][one as usize % 4] = other;
        self.across[other as usize / 4][other as usize % 4] = one;
    }
}

#[cfg(test)]
mod tests;
