//! Rounding the corners of plane figures: closing, then opening.

use super::{
    measure::{bounds, perimeter},
    offset,
};
use crate::geom::{Contour, Region, Tolerance};

/// How much less than the radius is taken away where the core of the figure is a line or a point,
/// relative to the size of the figure: far above the rounding of the overlay grid (2^-40), far below
/// anything printed.
const CORE: f64 = 1e-8;

/// `region` with convex and concave corners rounded by the radius `r` (mm): grown by r, shrunk by 2 r,
/// grown by r.
///
/// Sets are closed: what is exactly 2 r wide keeps its middle line, so that a bar of width 2 r becomes
/// a slot with round ends and not nothing. Its arcs are then off by at most 1e-8 of its size. Parts
/// narrower than 2 r vanish, gaps narrower than 2 r are filled. A radius of 0 or less changes nothing.
///
/// ```
/// use glam::dvec2;
/// use katachi::{geom::Tolerance, kernel::profile::{rect, round}};
/// let plate = round(&rect(dvec2(20.0, 10.0)).unwrap(), 2.0, Tolerance::new(1e-5).unwrap());
/// assert!((plate.area() - (200.0 - (4.0 - std::f64::consts::PI) * 4.0)).abs() < 1e-3);
/// ```
pub fn round(region: &Region, r: f64, tolerance: Tolerance) -> Region {
    if r > 0.0 { fillet(region, r, r, tolerance) } else { region.clone() }
}

/// `region` with convex corners rounded by one radius and concave corners by another (mm), either of which
/// may be 0: closed by the second, then opened by the first. As [`round`] otherwise.
///
/// ```
/// use glam::dvec2;
/// use katachi::{geom::Tolerance, kernel::profile::{rect, fillet}};
/// let fine = Tolerance::new(1e-5).unwrap();
/// let plate = fillet(&rect(dvec2(20.0, 10.0)).unwrap(), 2.0, 5.0, fine);
/// assert!((plate.area() - (200.0 - (4.0 - std::f64::consts::PI) * 4.0)).abs() < 1e-3);
/// ```
pub fn fillet(region: &Region, convex: f64, concave: f64, tolerance: Tolerance) -> Region {
    let Some((low, high)) = bounds(region) else { return region.clone() };
    let less = CORE * (convex + (high - low).max_element());
    let closed = offset(region, concave, tolerance);
    let core = offset(&closed, -(convex + concave), tolerance);
    if convex <= 0.0 {
        return core;
    }
    let wider = offset(&closed, -(convex + concave - less), tolerance);
    if holds_all(&core, &wider, less) {
        return offset(&core, convex, tolerance);
    }
    without_short_edges(offset(&wider, convex - less, tolerance), 8.0 * less)
}

/// Whether a core lost no line or point: taking `less` less away adds no contour and no length, but
/// what the corners account for.
fn holds_all(core: &Region, wider: &Region, less: f64) -> bool {
    let corners: usize = wider.contours().map(|c| c.points.len()).sum();
    let margin = less * (100.0 + 4.0 * corners as f64);
    wider.contours().count() == core.contours().count()
        && perimeter(wider) - perimeter(core) <= margin
}

/// Leaves out the corners that end an edge shorter than `least`.
fn without_short_edges(mut region: Region, least: f64) -> Region {
    for piece in &mut region.pieces {
        for contour in std::iter::once(&mut piece.outer).chain(&mut piece.holes) {
            *contour = merged(contour, least);
        }
    }
    region
}

fn merged(contour: &Contour, least: f64) -> Contour {
    let mut kept = Contour::default();
    for (i, &p) in contour.points.iter().enumerate() {
        let near = |q: glam::DVec2| q.distance(p) < least;
        if kept.points.last().is_some_and(|q| near(*q)) {
            // The short edge goes; what leaves the corner now is the next edge.
            *kept.curves.last_mut().expect("as many curves as points") = contour.curves[i];
            continue;
        }
        kept.points.push(p);
        kept.curves.push(contour.curves[i]);
    }
    if kept.points.len() > 3 && kept.points[0].distance(kept.points[kept.points.len() - 1]) < least
    {
        kept.points.pop();
        kept.curves.pop();
    }
    kept
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::dvec2;

    use super::*;
    use crate::{
        geom::EdgeCurve,
        kernel::profile::{difference, placed, rect, union},
    };

    fn fine() -> Tolerance {
        Tolerance::new(1e-6).unwrap()
    }

    #[test]
    fn a_bar_of_twice_the_radius_becomes_a_slot() {
        let slot = round(&rect(dvec2(20., 4.)).unwrap(), 2.0, fine());
        let expected = 16.0 * 4.0 + 4.0 * PI;
        assert!((slot.area() - expected).abs() < 1e-4, "{} {expected}", slot.area());
        let disc = round(&rect(dvec2(4., 4.)).unwrap(), 2.0, fine());
        assert!((disc.area() - 4.0 * PI).abs() < 1e-4, "{}", disc.area());
        assert!(round(&rect(dvec2(3.9, 30.)).unwrap(), 2.0, fine()).is_empty());
    }

    #[test]
    fn a_short_tongue_of_twice_the_radius_stays() {
        for length in [0.3, 0.8, 3.0] {
            let map = glam::DAffine2::from_translation(dvec2(10.0, 0.0));
            let tongue = placed(&rect(dvec2(2.0 * length, 4.0)).unwrap(), &map);
            let figure = union(&[rect(dvec2(20., 20.)).unwrap(), tongue]);
            let high = bounds(&round(&figure, 2.0, Tolerance::DEFAULT)).unwrap().1;
            assert!((high.x - 10.0 - length).abs() < 1e-6, "{length}: {high}");
        }
    }

    #[test]
    fn a_concave_corner_gains() {
        let big = rect(dvec2(20., 20.)).unwrap();
        let map = glam::DAffine2::from_translation(dvec2(10., 10.));
        let cut = crate::kernel::profile::placed(&rect(dvec2(20., 20.)).unwrap(), &map);
        let l = difference(&[big, cut]);
        let area = round(&l, 1.5, fine()).area();
        let expected = 300.0 - 5.0 * (1.0 - PI / 4.0) * 2.25 + (1.0 - PI / 4.0) * 2.25;
        assert!((area - expected).abs() < 1e-4, "{area} {expected}");
    }

    #[test]
    fn rounded_corners_know_their_circles() {
        let plate = round(&rect(dvec2(20., 10.)).unwrap(), 2.0, Tolerance::DEFAULT);
        let outer = &plate.pieces[0].outer;
        let arcs = outer.curves.iter().filter(|c| {
            matches!(c, EdgeCurve::Circle { center, radius }
                if *radius == 2.0 && center.abs() == dvec2(8.0, 3.0))
        });
        assert_eq!(arcs.count() + 4, outer.points.len());
        assert_eq!(bounds(&plate).unwrap(), (dvec2(-10., -5.), dvec2(10., 5.)));
    }
}
