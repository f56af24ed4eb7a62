//! What stands around a point or an edge.

use super::{Delaunay, Side, of_side, side};

impl Delaunay {
    /// A tetrahedron with these corners besides `at`, if there is one.
    pub(in super::super) fn with_corners(&mut self, at: u32, others: &[u32]) -> Option<u32> {
        let start = self.at[at as usize];
        self.marks.start(self.corners.len());
        self.marks.set(start);
        let mut open = vec![start];
        while let Some(here) = open.pop() {
            let corners = self.corners(here);
            if others.iter().all(|other| corners.contains(other)) {
                return Some(here);
            }
            for corner in (0..4).filter(|&i| corners[i] != at) {
                let (there, _) = of_side(self.across(side(here, corner)));
                if self.marks.first(there) {
                    open.push(there);
                }
            }
        }
        None
    }

    /// The side of a tetrahedron that has these corners, in any order.
    pub(in super::super) fn side_with(&mut self, [a, b, c]: [u32; 3]) -> Option<Side> {
        let tetrahedron = self.with_corners(a, &[b, c])?;
        let opposite = self.corners(tetrahedron).iter().position(|i| ![a, b, c].contains(i))?;
        Some(side(tetrahedron, opposite))
    }

    /// The tetrahedra at a point, those outside the hull included.
    pub(in super::super) fn star(&mut self, at: u32) -> Vec<u32> {
        let start = self.at[at as usize];
        self.marks.start(self.corners.len());
        self.marks.set(start);
        let (mut star, mut next) = (vec![start], 0);
        while let Some(&here) = star.get(next) {
            next += 1;
            let corners = self.corners(here);
            for corner in (0..4).filter(|&i| corners[i] != at) {
                let (there, _) = of_side(self.across(side(here, corner)));
                if self.marks.first(there) {
                    star.push(there);
                }
            }
        }
        star
    }

    /// The tetrahedra around an edge of one of them.
    pub(in super::super) fn around(&self, tetrahedron: u32, [a, b]: [u32; 2]) -> Vec<u32> {
        let others = |t: u32| {
            let corners = self.corners(t);
            let mut places = (0..4).filter(|&i| corners[i] != a && corners[i] != b);
            [places.next(), places.next()].map(|place| place.unwrap_or(0))
        };
        let mut around = vec![tetrahedron];
        let [mut out, stays] = others(tetrahedron);
        let (mut here, mut kept) = (tetrahedron, self.corners(tetrahedron)[stays]);
        loop {
            let (there, opposite) = of_side(self.across(side(here, out)));
            if there == tetrahedron {
                return around;
            }
            around.push(there);
            (here, out) = (there, self.place_of(there, kept));
            kept = self.corners(there)[opposite];
        }
    }
}
