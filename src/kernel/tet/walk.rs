//! Point location: walking from tetrahedron to tetrahedron.
//!
//! Source: O. Devillers, S. Pion, M. Teillaud, *Walking in a triangulation*, 2002: the visibility walk, which
//! remembers where it came from. Where it meets the boundary before the point, the point may still be inside
//! behind a hollow; then a bounding hierarchy answers.

use glam::DVec3;

use super::complex::{Across, Complex};
use crate::geom::{Bounds, orient::orient3d};

/// Steps after which a walk is given up: one in a mesh that is not Delaunay might go around.
const STEPS: usize = 10_000;

/// Finds points in a complex; those close to the last one soonest.
#[derive(Debug)]
pub struct Walk<'a> {
    complex: &'a Complex,
    last: u32,
}

impl<'a> Walk<'a> {
    /// A walk that starts anywhere.
    pub fn new(complex: &'a Complex) -> Walk<'a> {
        Walk { complex, last: 0 }
    }

    /// A tetrahedron that holds a point (mm), its boundary counted in; `None` outside. Exact.
    pub fn locate(&mut self, point: DVec3) -> Option<u32> {
        if self.complex.mesh().tetrahedra.is_empty() || !point.is_finite() {
            return None;
        }
        let found = self.walk(point).or_else(|| self.search(point));
        self.last = found.unwrap_or(self.last);
        found
    }

    fn walk(&self, point: DVec3) -> Option<u32> {
        let (mut here, mut from) = (self.last, 4);
        for _ in 0..STEPS {
            let beyond =
                (0..4).find(|&corner| corner != from && self.is_beyond(here, corner, point));
            let Some(corner) = beyond else { return self.holds(here, point).then_some(here) };
            match self.complex.across(here, corner) {
                Across::Tetrahedron(there, opposite) => (here, from) = (there, opposite.into()),
                Across::Outside(_) => return None,
            }
        }
        None
    }

    /// Whether a point is strictly beyond the face opposite to a corner.
    fn is_beyond(&self, tetrahedron: u32, corner: usize, point: DVec3) -> bool {
        let points = &self.complex.mesh().points;
        let [a, b, c] = self.complex.face(tetrahedron, corner).map(|i| points[i as usize]);
        orient3d(a, b, c, point) < 0.0
    }

    /// Whether a point is in a tetrahedron or on its boundary.
    fn holds(&self, tetrahedron: u32, point: DVec3) -> bool {
        self.complex.sign_of(tetrahedron as usize) > 0.0
            && !(0..4).any(|corner| self.is_beyond(tetrahedron, corner, point))
    }

    fn search(&self, point: DVec3) -> Option<u32> {
        let near = self.complex.hierarchy().overlapping(&Bounds::of([point]));
        near.into_iter().find(|&t| self.holds(t, point))
    }
}
