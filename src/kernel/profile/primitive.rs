//! Rectangles, circles, ellipses and regular polygons.

use glam::{DVec2, dvec2};

use super::ProfileError;
use crate::geom::{Contour, EdgeCurve, Piece, Region, Tolerance, sides as count, trig};

/// The most sides a regular polygon may have.
pub const MOST_SIDES: u32 = 1 << 20;

/// A rectangle of `size` (mm) about the origin.
///
/// ```
/// use glam::dvec2;
/// let region = katachi::kernel::profile::rect(dvec2(4.0, 3.0)).unwrap();
/// assert_eq!(region.area(), 12.0);
/// ```
pub fn rect(size: DVec2) -> Result<Region, ProfileError> {
    let half = dvec2(length("the width", size.x)?, length("the depth", size.y)?) / 2.0;
    let corners = [-half, dvec2(half.x, -half.y), half, dvec2(-half.x, half.y)];
    Ok(single(Contour::polygon(corners.to_vec())))
}

/// A circle of `radius` (mm) about the origin: [`ellipse`] with equal radii.
pub fn circle(
    radius: f64,
    sides: Option<u32>,
    tolerance: Tolerance,
) -> Result<Region, ProfileError> {
    ellipse(dvec2(radius, radius), sides, tolerance)
}

/// The regular polygon of `sides` corners on the circle of `radius` (mm), one of them on +x.
pub fn ngon(sides: u32, radius: f64) -> Result<Region, ProfileError> {
    circle(radius, Some(sides), Tolerance::DEFAULT)
}

/// An ellipse about the origin with `radii` (mm) along x and y, as an inscribed polygon whose first
/// corner is on +x.
///
/// With `sides` it is an honest polygon of straight edges. Without, `tolerance` says how many sides it
/// needs (a multiple of four), and the edges stand for the curve. Mirror images of corners are mirror
/// images to the bit.
pub fn ellipse(
    radii: DVec2,
    sides: Option<u32>,
    tolerance: Tolerance,
) -> Result<Region, ProfileError> {
    let (rx, ry) = (length("the radius", radii.x)?, length("the radius", radii.y)?);
    let chords = sides.unwrap_or_else(|| count::circle(rx.max(ry), tolerance));
    if !(3..=MOST_SIDES).contains(&chords) {
        return Err(ProfileError::Sides { sides: chords });
    }
    let curve = match sides {
        Some(_) => EdgeCurve::Line,
        None if rx == ry => EdgeCurve::Circle { center: DVec2::ZERO, radius: rx },
        None => EdgeCurve::Smooth(0),
    };
    let points = (0..chords).map(|i| trig::unit_circle(chords, i) * radii).collect();
    Ok(single(Contour { points, curves: vec![curve; chords as usize] }))
}

/// A region of one piece without holes.
pub(super) fn single(outer: Contour) -> Region {
    Region { pieces: vec![Piece { outer, holes: vec![] }] }
}

fn length(what: &'static str, value: f64) -> Result<f64, ProfileError> {
    let fits = value > 0.0 && value <= crate::geom::overlay::REACH;
    fits.then_some(value).ok_or(ProfileError::Size { what, value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_symmetric_and_starts_on_x() {
        let region = circle(7.3, None, Tolerance::DEFAULT).unwrap();
        let points = &region.pieces[0].outer.points;
        assert_eq!(points[0], dvec2(7.3, 0.0));
        let n = points.len();
        assert_eq!(n % 4, 0);
        for i in 1..n {
            assert_eq!(points[i], points[n - i] * dvec2(1.0, -1.0));
            assert_eq!(points[i].x, -points[(n / 2 + n - i) % n].x);
        }
    }

    #[test]
    fn an_ngon_has_the_area_of_its_triangles() {
        let region = ngon(6, 2.0).unwrap();
        assert!((region.area() - 6.0 * libm::sqrt(3.0)).abs() < 1e-12);
        assert!(region.pieces[0].outer.curves.iter().all(|c| *c == EdgeCurve::Line));
        assert_eq!(ngon(2, 1.0), Err(ProfileError::Sides { sides: 2 }));
    }

    #[test]
    fn sizes_that_enclose_nothing_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(rect(dvec2(bad, 1.0)).is_err());
            assert!(circle(bad, None, Tolerance::DEFAULT).is_err());
        }
    }
}
