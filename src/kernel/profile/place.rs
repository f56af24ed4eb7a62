//! Affine maps of plane figures.

use glam::{DAffine2, DMat2, DVec2};

use crate::geom::{Contour, EdgeCurve, Region};

/// An affine map of the plane: 2 x 2 linear part and translation in millimetres.
pub type Affine = DAffine2;

/// How far a linear map may be from a similarity, relative to its scale, and still map circles to
/// circles: products of rotations stay within a few units of 1e-16.
const SIMILARITY: f64 = 1e-9;

/// The region after `map`. A mirroring map turns the contours over, so that outlines still run
/// counter-clockwise; one that is no similarity turns circles into smooth curves. A map that flattens
/// the plane leaves nothing.
///
/// ```
/// use glam::{DAffine2, dvec2};
/// use katachi::kernel::profile::{placed, rect};
/// let mirrored = placed(&rect(dvec2(2.0, 3.0)).unwrap(), &DAffine2::from_scale(dvec2(-1.0, 2.0)));
/// assert_eq!(mirrored.area(), 12.0);
/// ```
pub fn placed(region: &Region, map: &Affine) -> Region {
    let determinant = map.matrix2.determinant();
    if determinant == 0.0 || !determinant.is_finite() {
        return Region::default();
    }
    let factor = similarity(map.matrix2);
    let smooth = region.contours().flat_map(|c| &c.curves).map(|curve| match curve {
        EdgeCurve::Smooth(number) => number + 1,
        _ => 0,
    });
    let mut free = smooth.max().unwrap_or(0);
    let mut result = region.clone();
    for piece in &mut result.pieces {
        for contour in std::iter::once(&mut piece.outer).chain(&mut piece.holes) {
            place(contour, map, factor, &mut free);
            if determinant < 0.0 {
                turn_over(contour);
            }
        }
    }
    result
}

fn place(contour: &mut Contour, map: &Affine, factor: Option<f64>, free: &mut u32) {
    for p in &mut contour.points {
        *p = point(map, *p);
    }
    let mut before: Option<(EdgeCurve, EdgeCurve)> = None;
    for curve in &mut contour.curves {
        let EdgeCurve::Circle { center, radius } = *curve else { continue };
        let image = match (factor, before) {
            (Some(factor), _) => {
                EdgeCurve::Circle { center: point(map, center), radius: radius * factor }
            }
            (None, Some((same, image))) if same == *curve => image,
            (None, _) => {
                *free += 1;
                EdgeCurve::Smooth(*free - 1)
            }
        };
        before = Some((*curve, image));
        *curve = image;
    }
}

/// The image of a point; a pure translation does not touch it with products.
fn point(map: &Affine, p: DVec2) -> DVec2 {
    if map.matrix2 == DMat2::IDENTITY { p + map.translation } else { map.transform_point2(p) }
}

/// Reverses a contour about its first corner; each edge keeps its curve.
fn turn_over(contour: &mut Contour) {
    contour.points[1..].reverse();
    contour.curves.reverse();
}

fn similarity(m: DMat2) -> Option<f64> {
    let square = m.x_axis.length_squared();
    let near = (m.y_axis.length_squared() - square).abs() <= SIMILARITY * square
        && m.x_axis.dot(m.y_axis).abs() <= SIMILARITY * square;
    near.then(|| libm::sqrt(square))
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::{
        geom::Tolerance,
        kernel::profile::{circle, difference, rect, union},
    };

    fn plate() -> Region {
        let hole = circle(1.0, None, Tolerance::DEFAULT).unwrap();
        difference(&[rect(dvec2(6.0, 4.0)).unwrap(), hole])
    }

    #[test]
    fn mirroring_keeps_outlines_counter_clockwise() {
        let region = placed(&plate(), &Affine::from_scale(dvec2(-2.0, 2.0)));
        let piece = &region.pieces[0];
        assert!(piece.outer.area() > 0.0 && piece.holes[0].area() < 0.0);
        let circle = EdgeCurve::Circle { center: DVec2::ZERO, radius: 2.0 };
        assert!(piece.holes[0].curves.iter().all(|c| *c == circle));
        assert!((region.area() - 4.0 * plate().area()).abs() < 1e-12);
    }

    #[test]
    fn an_uneven_scale_makes_a_circle_a_smooth_curve() {
        let region = placed(&plate(), &Affine::from_scale(dvec2(2.0, 1.0)));
        let curves = &region.pieces[0].holes[0].curves;
        assert!(curves.iter().all(|c| *c == EdgeCurve::Smooth(0)));
        assert!(placed(&plate(), &Affine::from_scale(dvec2(0.0, 1.0))).is_empty());
    }

    #[test]
    fn union_keeps_smooth_curves_apart() {
        let one = placed(&plate(), &Affine::from_scale(dvec2(2.0, 1.0)));
        let two = placed(&one, &Affine::from_translation(dvec2(30.0, 0.0)));
        let both = union(&[one, two]);
        let numbers: Vec<EdgeCurve> = both.pieces.iter().map(|p| p.holes[0].curves[0]).collect();
        assert_eq!(numbers, [EdgeCurve::Smooth(0), EdgeCurve::Smooth(1)]);
    }
}
