//! Union, difference and intersection of plane figures.

use crate::geom::{
    Contour, EdgeCurve, Region,
    overlay::{Fill, Rule, overlay},
};

/// What lies in at least one of `regions`.
///
/// ```
/// use glam::dvec2;
/// use katachi::kernel::profile::{rect, union};
/// let cross = union(&[rect(dvec2(6.0, 2.0)).unwrap(), rect(dvec2(2.0, 6.0)).unwrap()]);
/// assert_eq!(cross.area(), 20.0);
/// ```
pub fn union(regions: &[Region]) -> Region {
    let apart = numbered_apart(regions);
    overlay(contours(&apart), [], Rule::Union, Fill::NonZero)
}

/// What lies in the first region and in none of the others; nothing of nothing.
pub fn difference(regions: &[Region]) -> Region {
    let apart = numbered_apart(regions);
    let Some((first, rest)) = apart.split_first() else { return Region::default() };
    overlay(first.contours(), contours(rest), Rule::Difference, Fill::NonZero)
}

/// What lies in all of `regions`; nothing of nothing.
pub fn intersection(regions: &[Region]) -> Region {
    let mut apart = numbered_apart(regions).into_iter();
    let first = apart.next().unwrap_or_default();
    apart.fold(first, |common, next| {
        overlay(common.contours(), next.contours(), Rule::Intersection, Fill::NonZero)
    })
}

fn contours(regions: &[Region]) -> impl Iterator<Item = &Contour> {
    regions.iter().flat_map(Region::contours)
}

/// The regions with the numbers of their smooth curves shifted, so that no two share one.
fn numbered_apart(regions: &[Region]) -> Vec<Region> {
    let mut free = 0;
    let shifted = regions.iter().map(|region| {
        let shift = free;
        free += region.contours().flat_map(|c| &c.curves).map(|c| past(*c)).max().unwrap_or(0);
        renumbered(region, shift)
    });
    shifted.collect()
}

fn past(curve: EdgeCurve) -> u32 {
    if let EdgeCurve::Smooth(number) = curve { number + 1 } else { 0 }
}

fn renumbered(region: &Region, shift: u32) -> Region {
    let mut region = region.clone();
    for piece in &mut region.pieces {
        for contour in std::iter::once(&mut piece.outer).chain(&mut piece.holes) {
            for curve in &mut contour.curves {
                if let EdgeCurve::Smooth(number) = curve {
                    *number += shift;
                }
            }
        }
    }
    region
}

#[cfg(test)]
mod tests {
    use glam::{DAffine2, dvec2};

    use super::*;
    use crate::{
        geom::Tolerance,
        kernel::profile::{circle, offset, placed, rect, round},
    };

    #[test]
    fn order_does_not_matter_to_a_union() {
        let at = |x: f64, y: f64| {
            let disc = circle(3.0, None, Tolerance::DEFAULT).unwrap();
            placed(&disc, &DAffine2::from_translation(dvec2(x, y)))
        };
        let discs = [at(0., 0.), at(2.5, 1.0), at(9.0, 0.3), at(4.0, 7.1)];
        let mut back = discs.clone();
        back.reverse();
        let (one, two) = (union(&discs), union(&back));
        assert_eq!(one.pieces.len(), 3);
        assert!((one.area() - two.area()).abs() < 1e-12);
        assert_eq!(union(&discs), one);
    }

    #[test]
    fn nothing_of_nothing() {
        assert!(
            union(&[]).is_empty() && difference(&[]).is_empty() && intersection(&[]).is_empty()
        );
        let square = rect(dvec2(2.0, 2.0)).unwrap();
        assert!(difference(&[square.clone(), square.clone()]).is_empty());
        assert_eq!(intersection(&[square.clone(), square.clone()]), square);
        assert_eq!(union(std::slice::from_ref(&square)), square);
    }

    #[test]
    fn a_plate_of_a_thousand_holes() {
        let holes = (0..1000).map(|i| {
            let disc = circle(1.0, Some(32), Tolerance::DEFAULT).unwrap();
            let at = dvec2(f64::from(i % 40), f64::from(i / 40)) * 3.0;
            placed(&disc, &DAffine2::from_translation(at))
        });
        let plate = placed(
            &rect(dvec2(130., 90.)).unwrap(),
            &DAffine2::from_translation(dvec2(58.5, 36.0)),
        );
        let all: Vec<Region> = std::iter::once(plate).chain(holes).collect();
        let result = difference(&all);
        assert_eq!(result.pieces[0].holes.len(), 1000);
        let shrunk = offset(&result, -0.2, Tolerance::DEFAULT);
        assert_eq!(shrunk.pieces[0].holes.len(), 1000);
        assert_eq!(round(&result, 0.3, Tolerance::DEFAULT).pieces[0].holes.len(), 1000);
    }
}
