//! The surface at a distance from a mesh.
//!
//! The distance from a triangle is a convex function. Over a cell it is therefore largest at a corner, and not
//! smaller than its tangent at the middle tells; so bounds over a cell are tight, and exact where the nearest
//! triangle's plane is nearest.

use std::sync::Arc;

use glam::DVec3;

use super::{
    Polyhedral,
    contour::{Level, Look},
    half_diagonal,
};
use crate::geom::Bounds;

/// Slack for rounding, relative to coordinates.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// Cells are asked through the hierarchy of the mesh while more candidates than this are near.
const MANY: usize = 2048;
/// So many of the nearest triangles are tried for the upper bound of a cell.
const TRIED: usize = 6;

/// A triangle as a cell sees it.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    /// Distance from the middle of the cell.
    away: f64,
    /// The direction from it to the middle.
    towards: DVec3,
    triangle: u32,
}

/// The points at a signed distance `by` from a mesh, as the zeros of a function: distance less `by`.
#[derive(Clone, Debug)]
pub struct Apart<'a> {
    whole: &'a Polyhedral,
    by: f64,
    /// The middle of the cell and what can be nearest to its points, nearest first; none for the whole.
    near: Option<(DVec3, Arc<[Candidate]>)>,
}

impl<'a> Apart<'a> {
    /// The points at `by` mm from a mesh, inside for a negative distance.
    pub fn new(whole: &'a Polyhedral, by: f64) -> Apart<'a> {
        Apart { whole, by, near: None }
    }

    /// The signed distance of a point of the cell from the mesh.
    pub(super) fn distance(&self, p: DVec3) -> f64 {
        self.foot(p).1
    }

    /// The point of the boundary nearest to a point of the cell, and the signed distance.
    fn foot(&self, p: DVec3) -> (DVec3, f64) {
        let Some((middle, list)) = &self.near else {
            let found = self.whole.nearest(p);
            return (found.point, found.distance);
        };
        let moved = p.distance(*middle);
        let (mut found, mut square, mut best) = (0, f64::INFINITY, f64::INFINITY);
        for candidate in list.iter() {
            if candidate.away - moved > best {
                break;
            }
            let triangle = &self.whole.triangles[candidate.triangle as usize];
            let apart = triangle.nearest(p).0.distance_squared(p);
            if apart < square {
                (found, square, best) = (candidate.triangle, apart, apart.sqrt());
            }
        }
        let found = self.whole.on_triangle(found, p);
        (found.point, found.distance)
    }

    fn candidate(&self, triangle: u32, middle: DVec3) -> Candidate {
        let foot = self.whole.triangles[triangle as usize].nearest(middle).0;
        let away = foot.distance(middle);
        Candidate { away, towards: (middle - foot) / away.max(f64::MIN_POSITIVE), triangle }
    }

    /// What can be nearest within `reach` of a middle, if it is not too much.
    fn gathered(&self, middle: DVec3, reach: f64) -> Option<Vec<Candidate>> {
        let Some((_, list)) = &self.near else {
            let nearest = self.whole.nearest(middle).distance.abs();
            let near = self.whole.within(middle, widened(nearest + 2.0 * reach, middle));
            let of = |(_, i): &(f64, u32)| self.candidate(*i, middle);
            return (near.len() <= MANY).then(|| near.iter().map(of).collect());
        };
        let mut list: Vec<Candidate> =
            list.iter().map(|c| self.candidate(c.triangle, middle)).collect();
        list.sort_unstable_by(|a, b| a.away.total_cmp(&b.away).then(a.triangle.cmp(&b.triangle)));
        Some(list)
    }

    /// The largest distance from the nearest triangle within a cell, or more.
    fn upper(&self, list: &[Candidate], cell: &Bounds) -> f64 {
        let largest = |c: &Candidate| {
            let triangle = &self.whole.triangles[c.triangle as usize];
            let corner = |k: usize| {
                let p = DVec3::from([0, 1, 2].map(|i| [cell.min, cell.max][k >> i & 1][i]));
                triangle.nearest(p).0.distance_squared(p)
            };
            (0..8).map(corner).fold(0.0, f64::max)
        };
        list.iter().take(TRIED).map(largest).fold(f64::INFINITY, f64::min).sqrt()
    }
}

/// The least distance from a triangle within a cell, or less.
fn lower(c: &Candidate, half: DVec3) -> f64 {
    (c.away - c.towards.abs().dot(half)).max(0.0)
}

fn widened(reach: f64, middle: DVec3) -> f64 {
    reach + ROUNDING * (reach + middle.abs().max_element())
}

impl Level for Apart<'_> {
    fn value(&self, p: DVec3) -> f64 {
        self.foot(p).1 - self.by
    }

    fn gradient(&self, p: DVec3) -> DVec3 {
        let (foot, distance) = self.foot(p);
        (p - foot) / distance
    }

    fn off(&self, p: DVec3) -> f64 {
        self.value(p).abs()
    }

    fn look(&self, cell: &Bounds) -> Look {
        let (middle, half) = (cell.center(), (cell.max - cell.min) / 2.0);
        let (reach, radius) = (half_diagonal(cell), self.by.abs());
        let slack = ROUNDING * (radius + middle.abs().max_element() + reach);
        let side = self.value(middle) + self.by;
        if side * self.by.signum() < -reach - slack {
            return Look::Clear; // on the side of the boundary where the surface is not
        }
        let Some((_, list)) = &self.near else {
            let clear = (side - self.by).abs() > reach + slack;
            return if clear { Look::Clear } else { Look::Unknown };
        };
        let near = || list.iter().filter(|c| lower(c, half) <= radius + slack);
        if near().next().is_none() || self.upper(list, cell) < radius - slack {
            return Look::Clear;
        }
        let main = near().map(|c| c.towards).sum::<DVec3>().normalize_or_zero();
        let along = near().all(|c| c.away * c.towards.dot(main) > reach);
        if along { Look::Sheet } else { Look::Unknown }
    }

    fn within(&self, cell: &Bounds) -> Self {
        let middle = cell.center();
        let Some(mut list) = self.gathered(middle, half_diagonal(cell)) else {
            return self.clone();
        };
        let half = (cell.max - cell.min) / 2.0;
        let most = widened(self.upper(&list, cell), middle);
        list.retain(|c| lower(c, half) <= most);
        Apart { near: Some((middle, list.into())), ..*self }
    }
}
