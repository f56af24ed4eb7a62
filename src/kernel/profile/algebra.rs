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
