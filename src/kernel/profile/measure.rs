//! Measures of plane figures: closed forms over the edges.

use glam::{DVec2, dvec2};

use crate::geom::{Contour, Region};

/// Area in mm^2, holes left out.
pub fn area(region: &Region) -> f64 {
    region.area()
}

/// The length of all contours in mm, holes too.
///
/// ```
/// use glam::dvec2;
/// use katachi::kernel::profile::{measure::perimeter, rect};
/// assert_eq!(perimeter(&rect(dvec2(4.0, 3.0)).unwrap()), 14.0);
/// ```
pub fn perimeter(region: &Region) -> f64 {
    region.contours().flat_map(Contour::edges).map(|e| e.from.distance(e.to)).sum()
}

/// The least and the greatest coordinates; `None` for the empty region.
pub fn bounds(region: &Region) -> Option<(DVec2, DVec2)> {
    let mut points = region.contours().flat_map(|c| &c.points);
    let first = *points.next()?;
    Some(points.fold((first, first), |(low, high), &p| (low.min(p), high.max(p))))
}

/// The centre of area; `None` for the empty region.
pub fn centroid(region: &Region) -> Option<DVec2> {
    let base = reference(region)?;
    let mut sum = DVec2::ZERO;
    for e in region.contours().flat_map(Contour::edges) {
        let (p, q) = (e.from - base, e.to - base);
        sum += (p + q) * p.perp_dot(q);
    }
    Some(base + sum / (6.0 * region.area()))
}

/// The second moments of area about the centroid in mm^4.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct SecondMoments {
    /// The integral of x^2.
    pub xx: f64,
    /// The integral of y^2.
    pub yy: f64,
    /// The integral of x y.
    pub xy: f64,
}

/// The second moments about the centroid; `None` for the empty region.
///
/// ```
/// use glam::dvec2;
/// use katachi::kernel::profile::{measure::second_moments, rect};
/// assert_eq!(second_moments(&rect(dvec2(2.0, 6.0)).unwrap()).unwrap().yy, 2.0 * 216.0 / 12.0);
/// ```
pub fn second_moments(region: &Region) -> Option<SecondMoments> {
    let center = centroid(region)?;
    let (mut squares, mut product) = (DVec2::ZERO, 0.0);
    for (p, q) in region.contours().flat_map(Contour::edges).map(|e| (e.from, e.to)) {
        let (p, q) = (p - center, q - center);
        let turn = p.perp_dot(q);
        squares += (p * p + p * q + q * q) * turn;
        product += (p.x * q.y + 2.0 * p.x * p.y + 2.0 * q.x * q.y + q.x * p.y) * turn;
    }
    let squares = squares / 12.0;
    Some(SecondMoments { xx: squares.x, yy: squares.y, xy: product / 24.0 })
}

/// A point near the region, to keep the products small.
fn reference(region: &Region) -> Option<DVec2> {
    let (low, high) = bounds(region)?;
    Some(dvec2((low.x + high.x) / 2.0, (low.y + high.y) / 2.0))
}
