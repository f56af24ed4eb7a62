//! The convex hull of points of the plane.

use std::cmp::Ordering;

use glam::DVec2;

use super::{ProfileError, orientation::orientation, primitive::single};
use crate::geom::{Contour, Region};

/// The smallest convex region that holds all `points` (mm): Andrew's monotone chain with exact
/// signs; points on its straight edges are left out.
///
/// # Errors
/// When all points lie on one line.
///
/// ```
/// use glam::dvec2;
/// let points = [dvec2(0., 0.), dvec2(2., 0.), dvec2(1., 0.), dvec2(0., 2.), dvec2(0.5, 0.5)];
/// assert_eq!(katachi::kernel::profile::hull(&points).unwrap().area(), 2.0);
/// ```
pub fn hull(points: &[DVec2]) -> Result<Region, ProfileError> {
    if let Some(index) = points.iter().position(|p| !p.is_finite()) {
        return Err(ProfileError::Coordinate { contour: 0, index, at: points[index] });
    }
    let mut sorted = points.to_vec();
    sorted.sort_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
    sorted.dedup();
    let mut corners = chain(sorted.iter().copied());
    let upper = chain(sorted.iter().rev().copied());
    corners.pop();
    corners.extend_from_slice(&upper[..upper.len().saturating_sub(1)]);
    if corners.len() < 3 {
        return Err(ProfileError::FlatHull { count: points.len() });
    }
    Ok(single(Contour::polygon(corners)))
}

/// The corners of a chain that only turns left.
fn chain(points: impl Iterator<Item = DVec2>) -> Vec<DVec2> {
    let mut kept: Vec<DVec2> = vec![];
    for p in points {
        while kept.len() >= 2
            && orientation(kept[kept.len() - 2], kept[kept.len() - 1], p) != Ordering::Greater
        {
            kept.pop();
        }
        kept.push(p);
    }
    kept
}
