//! The triangles of a mesh that can be nearest to the points of a cell.
//!
//! The distance from a triangle is a convex function. Over a cell it is therefore largest at a corner, and not
//! smaller than its tangent at the middle tells. A triangle that is never nearer than another one always is, is
//! no candidate. Candidates stand in the order of their distance from the middle, so that a question ends as
//! soon as the rest must be farther.

use std::sync::Arc;

use glam::DVec3;

use super::{Nearest, Polyhedral, half_diagonal, lanes::LANES, polyhedral::Visited, prism::Framed};
use crate::geom::Bounds;

/// Slack for rounding, relative to coordinates.
pub(super) const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// Cells are asked through the hierarchy of the mesh while more candidates than this are near.
const MANY: usize = 2048;
/// So many of the nearest triangles are tried for the upper bound of a cell.
const TRIED: usize = 6;
/// Candidates that are measured one by one, without a look at their prisms: so many cells of an octree have no
/// more that prisms would need most of its memory.
const FEW: usize = 24;

/// A triangle as a cell sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Distance from the middle of the cell.
    pub away: f64,
    /// The direction from it to the middle.
    pub towards: DVec3,
    pub triangle: u32,
}

impl Candidate {
    fn new(whole: &Polyhedral, triangle: u32, middle: DVec3) -> Candidate {
        let foot = whole.triangle(triangle).nearest(middle).0;
        let away = foot.distance(middle);
        Candidate { away, towards: (middle - foot) / away.max(f64::MIN_POSITIVE), triangle }
    }

    /// The least distance from the triangle within a cell, or less.
    pub fn lower(&self, half: DVec3) -> f64 {
        (self.away - self.towards.abs().dot(half)).max(0.0)
    }
}

/// The candidates of a cell.
#[derive(Clone, Debug)]
pub(super) struct Near {
    middle: DVec3,
    pub list: Arc<[Candidate]>,
    /// Prisms around the candidates, if these are many.
    prisms: Option<Arc<Framed>>,
}

impl Near {
    /// The candidates of a cell among all triangles; `None` if there are too many to be listed.
    pub fn new(whole: &Polyhedral, cell: &Bounds) -> Option<Near> {
        let (middle, reach) = (cell.center(), half_diagonal(cell));
        let nearest = whole.nearest(middle).distance.abs();
        let near = whole.within(middle, widened(nearest + 2.0 * reach, middle), MANY)?;
        let of = |i: u32| Candidate::new(whole, i, middle);
        Some(Near::chosen(whole, cell, near.into_iter().map(of).collect()))
    }

    /// The candidates of a cell inside of this one's.
    pub fn within(&self, whole: &Polyhedral, cell: &Bounds) -> Near {
        let middle = cell.center();
        let of = |c: &Candidate| Candidate::new(whole, c.triangle, middle);
        Near::chosen(whole, cell, self.list.iter().map(of).collect())
    }

    fn chosen(whole: &Polyhedral, cell: &Bounds, mut list: Vec<Candidate>) -> Near {
        let (middle, half) = (cell.center(), (cell.max - cell.min) / 2.0);
        let least = list.iter().map(|c| c.away).fold(f64::INFINITY, f64::min);
        let reach = widened(least + 2.0 * half.length(), middle);
        list.retain(|c| c.lower(half) <= reach);
        list.sort_unstable_by(|a, b| a.away.total_cmp(&b.away).then(a.triangle.cmp(&b.triangle)));
        let most = widened(upper(whole, &list, cell), middle);
        list.retain(|c| c.lower(half) <= most);
        let prisms = || {
            let triangles = list.iter().map(|c| whole.places(c.triangle));
            Arc::new(Framed::new(middle, whole.triangle(list[0].triangle).normal(), triangles))
        };
        let prisms = (list.len() > FEW).then(prisms);
        Near { middle, list: list.into(), prisms }
    }

    /// The largest distance of a point of the cell, or more.
    pub fn upper(&self, whole: &Polyhedral, cell: &Bounds) -> f64 {
        upper(whole, &self.list, cell)
    }

    /// The nearest point of the boundary, for a point of the cell.
    #[inline]
    pub fn nearest(&self, whole: &Polyhedral, p: DVec3) -> Nearest {
        let moved = p.distance(self.middle);
        let mut best = Visited::none_but(self.list[0].triangle);
        let mut apart = f64::INFINITY;
        let framed = self.prisms.as_ref().map(|prisms| (prisms, prisms.question(p)));
        let Some((prisms, question)) = framed.filter(|(_, question)| question.is_near()) else {
            for candidate in self.list.iter() {
                if candidate.away - moved > apart {
                    break;
                }
                apart = best.visit(whole, candidate.triangle, p);
            }
            return whole.at_visited(&best, p);
        };
        let mut cut = f32::INFINITY;
        for (prisms, list) in prisms.eights.iter().zip(self.list.chunks(LANES)) {
            if list[0].away - moved > apart {
                break;
            }
            let squares = prisms.away(question.at);
            let (mut left, mut lane) = (squares.below(cut), squares.least());
            while left >> lane & 1 == 1 {
                apart = best.visit(whole, list[lane as usize].triangle, p);
                cut = question.cut_at(apart);
                left &= squares.below(cut) & !(1 << lane);
                lane = left.trailing_zeros() % LANES as u32;
            }
        }
        whole.at_visited(&best, p)
    }
}

/// The largest distance from the nearest triangle within a cell, or more.
fn upper(whole: &Polyhedral, list: &[Candidate], cell: &Bounds) -> f64 {
    let largest = |c: &Candidate| {
        let triangle = whole.triangle(c.triangle);
        let corner = |k: usize| {
            let p = DVec3::from([0, 1, 2].map(|i| [cell.min, cell.max][k >> i & 1][i]));
            triangle.nearest(p).0.distance_squared(p)
        };
        (0..8).map(corner).fold(0.0, f64::max)
    };
    list.iter().take(TRIED).map(largest).fold(f64::INFINITY, f64::min).sqrt()
}

fn widened(reach: f64, middle: DVec3) -> f64 {
    reach + ROUNDING * (reach + middle.abs().max_element())
}
