//! Adding a point: find it, take out what its sphere test finds, fill in its star.

use super::{Delaunay, GHOST, Side, of_side, side};
use crate::kernel::tet::complex::FACES;

impl Delaunay {
    /// One tetrahedron of positive volume, and the four outside of it.
    pub(super) fn begin(&mut self, mut first: [u32; 4]) {
        if self.sign([first[0], first[1], first[2]], first[3]) < 0 {
            first.swap(0, 1);
        }
        let inner = self.push(first);
        let outer = FACES.map(|face| {
            let [a, b, c] = face.map(|i| first[i]);
            self.push([a, b, c, GHOST])
        });
        for (corner, &ghost) in outer.iter().enumerate() {
            self.join(side(inner, corner), side(ghost, 3));
            for (other, &second) in outer.iter().enumerate().skip(corner + 1) {
                // Two outer ones share the edge of the corners opposite to neither.
                let (mine, theirs) =
                    (self.place_of(ghost, first[other]), self.place_of(second, first[corner]));
                self.join(side(ghost, mine), side(second, theirs));
            }
        }
        self.last = inner;
    }

    /// Which corner of a tetrahedron a point is.
    ///
    /// # Panics
    /// When it is none.
    pub(in super::super) fn place_of(&self, tetrahedron: u32, point: u32) -> usize {
        self.corners(tetrahedron).iter().position(|&c| c == point).expect("a corner")
    }

    /// Inserts a point that is not yet a corner.
    pub(super) fn insert(&mut self, point: u32) {
        let start = self.locate(point);
        let (cavity, walls) = self.cavity(start, point);
        for &wall in &walls {
            let (tetrahedron, corner) = of_side(wall);
            let mut corners = self.corners(tetrahedron);
            corners[corner] = point;
            let outside = self.across(wall);
            let new = self.push(corners);
            self.join(side(new, corner), outside);
            self.last = new;
        }
        for &wall in &walls {
            self.link(wall);
        }
        cavity.into_iter().for_each(|tetrahedron| self.remove(tetrahedron));
    }

    /// A tetrahedron in whose sphere a point lies: the one that holds it, or one outside a face of the hull that
    /// sees it. Walks from where the last walk ended.
    fn locate(&self, point: u32) -> u32 {
        let mut here = self.last;
        if self.is_ghost(here) {
            here = of_side(self.across(side(here, self.place_of(here, GHOST)))).0;
        }
        let mut from = 4;
        loop {
            let beyond = (0..4).find(|&corner| {
                corner != from && self.sign(self.face(side(here, corner)), point) > 0
            });
            let Some(corner) = beyond else { return here };
            (here, from) = of_side(self.across(side(here, corner)));
            if self.is_ghost(here) {
                return here;
            }
        }
    }

    /// Whether a point is in the sphere of a tetrahedron; outside the hull, whether it sees the hull's face.
    fn conflicts(&self, tetrahedron: u32, point: u32) -> bool {
        let corners = self.corners(tetrahedron);
        let Some(ghost) = corners.iter().position(|&c| c == GHOST) else {
            return self.in_sphere(corners, point);
        };
        let hull = side(tetrahedron, ghost);
        match self.sign(self.face(hull), point) {
            0 => self.in_sphere(self.corners(of_side(self.across(hull)).0), point),
            sign => sign < 0,
        }
    }

    /// The tetrahedra in whose spheres a point lies, and their sides towards the others.
    fn cavity(&mut self, start: u32, point: u32) -> (Vec<u32>, Vec<Side>) {
        self.marks.start(self.corners.len());
        self.marks.set(start);
        let (mut cavity, mut walls, mut next) = (vec![start], vec![], 0);
        while let Some(&here) = cavity.get(next) {
            next += 1;
            for corner in 0..4 {
                let (there, _) = of_side(self.across(side(here, corner)));
                if self.marks.has(there) {
                    continue;
                }
                if self.conflicts(there, point) {
                    self.marks.set(there);
                    cavity.push(there);
                } else {
                    walls.push(side(here, corner));
                }
            }
        }
        (cavity, walls)
    }

    /// Joins the new tetrahedron behind a wall to its neighbours in the star: around each edge of the wall the
    /// cavity is crossed to the next wall.
    fn link(&mut self, wall: Side) {
        let new = self.behind(wall);
        let (tetrahedron, corner) = of_side(wall);
        for third in (0..4).filter(|&i| i != corner) {
            // Around the edge of the other two: left by the side opposite to `out`, which holds `kept`.
            let (mut here, mut out, mut kept) = (tetrahedron, third, corner);
            loop {
                let (there, opposite) = of_side(self.across(side(here, out)));
                if !self.marks.has(there) {
                    break;
                }
                let stays = self.corners(here)[kept];
                (here, out, kept) = (there, self.place_of(there, stays), opposite);
            }
            let neighbour = self.behind(side(here, out));
            self.join(side(new, third), side(neighbour, kept));
        }
    }

    /// The new tetrahedron that stands behind a wall of the cavity.
    fn behind(&self, wall: Side) -> u32 {
        of_side(self.across(self.across(wall))).0
    }
}
