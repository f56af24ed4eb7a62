//! The part of a mesh that can be nearest to the points of a cell.
//!
//! If the nearest triangle is d from the middle of a cell whose corners are h away, no point of the cell has
//! a nearest triangle farther than d + 2 h from the middle. The candidates stand in the order of their
//! distance from the middle, so that a question ends as soon as the rest must be farther.

use glam::DVec3;

use super::{Field, Nearest, Polyhedral, half_diagonal, triangle::Triangle};
use crate::geom::Bounds;

/// Slack for rounding in the choice of candidates, relative to the coordinates.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The field of a mesh within a cell.
#[derive(Clone, Debug)]
pub struct Local<'a> {
    whole: &'a Polyhedral,
    middle: DVec3,
    /// Distance from the middle, place in the whole, and the triangle; nearest first.
    candidates: Vec<(f64, u32, Triangle)>,
}

impl<'a> Local<'a> {
    /// The field of a mesh for the points of a cell.
    pub fn new(whole: &'a Polyhedral, cell: &Bounds) -> Local<'a> {
        let (middle, reach) = (cell.center(), half_diagonal(cell));
        let nearest = whole.nearest(middle).distance.abs();
        let near = whole.within(middle, widened(nearest + 2.0 * reach, middle));
        let of = |(d, i): (f64, u32)| (d, i, whole.triangles[i as usize]);
        Local { whole, middle, candidates: near.into_iter().map(of).collect() }
    }

    /// The field for a cell inside of this one's.
    pub fn within(&self, cell: &Bounds) -> Local<'a> {
        let (middle, reach) = (cell.center(), half_diagonal(cell));
        let away = |t: &Triangle| t.nearest(middle).0.distance(middle);
        let mut candidates: Vec<(f64, u32, Triangle)> =
            self.candidates.iter().map(|(_, i, t)| (away(t), *i, *t)).collect();
        let nearest = candidates.iter().map(|c| c.0).fold(f64::INFINITY, f64::min);
        candidates.retain(|c| c.0 <= widened(nearest + 2.0 * reach, middle));
        candidates.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Local { whole: self.whole, middle, candidates }
    }

    /// The nearest point of the boundary and what it lies on, for a point of the cell.
    pub fn nearest(&self, p: DVec3) -> Nearest {
        let moved = p.distance(self.middle);
        let (mut found, mut square, mut best) =
            (self.candidates[0].1, f64::INFINITY, f64::INFINITY);
        for (away, i, triangle) in &self.candidates {
            if away - moved > best {
                break;
            }
            let apart = triangle.nearest(p).0.distance_squared(p);
            if apart < square {
                (found, square, best) = (*i, apart, apart.sqrt());
            }
        }
        self.whole.on_triangle(found, p)
    }

    /// The number of triangles that it looks at.
    pub fn candidates(&self) -> usize {
        self.candidates.len()
    }
}

fn widened(reach: f64, middle: DVec3) -> f64 {
    reach + ROUNDING * (reach + middle.abs().max_element())
}

impl Field for Local<'_> {
    fn distance(&self, p: DVec3) -> f64 {
        self.nearest(p).distance
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        self.nearest(p).point
    }

    fn extent(&self) -> Bounds {
        self.whole.extent()
    }

    fn localize<'a>(&'a self, cell: &Bounds) -> Box<dyn Field + 'a> {
        Box::new(self.within(cell))
    }
}
