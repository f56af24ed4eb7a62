//! How many facets a true curve gets: as many as the tolerance asks for, by the same bounds that the
//! kernels keep, so that what OpenSCAD makes of the source has our facets.

use glam::DVec2;

use crate::geom::{Region, Tolerance, region::EdgeCurve};

/// Fewest sides of a circle: below it would not be read as one.
const FEWEST: f64 = 8.0;
/// Most sides of a circle: a guard against tolerances far below the size of the model.
const MOST: f64 = 16_384.0;
/// Most sides of a sphere or torus each way.
const MOST_DOUBLY_CURVED: f64 = 2_048.0;
/// Most slices of a twist.
const MOST_SLICES: f64 = 20_000.0;

/// Sides of a circle whose chords are at most the tolerance off it, a multiple of four so that its
/// bounding box is exact.
///
/// ```text
/// r (1 - cos(pi / n)) <= tolerance
/// ```
pub(super) fn circle(radius: f64, tolerance: Tolerance) -> u32 {
    sides(libm::acos((1.0 - tolerance.mm() / radius).max(0.0)), MOST)
}

/// Sides of the largest ring of a sphere, whose facets fall short between meridians and between rings.
///
/// ```text
/// r (1 - cos^2(pi / n)) <= tolerance
/// ```
pub(super) fn sphere(radius: f64, tolerance: Tolerance) -> u32 {
    sides(libm::asin((tolerance.mm() / radius).min(1.0).sqrt()), MOST_DOUBLY_CURVED)
}

/// Sides of a torus about its axis and about its tube; each spends half of the tolerance.
pub(super) fn torus(major: f64, minor: f64, tolerance: Tolerance) -> (u32, u32) {
    let half = |radius: f64| libm::acos((1.0 - tolerance.mm() / 2.0 / radius).max(0.0));
    (sides(half(major + minor), MOST_DOUBLY_CURVED), sides(half(minor), MOST_DOUBLY_CURVED))
}

/// Sides of a full turn of a region; where its edges are chords of curves, half of the tolerance is
/// theirs.
pub(super) fn turn(region: &Region, tolerance: Tolerance) -> u32 {
    let reach = region.contours().flat_map(|c| &c.points).map(|p| p.x.abs()).fold(0.0, f64::max);
    let curved = region.contours().flat_map(|c| &c.curves).any(|&c| c != EdgeCurve::Line);
    let left = if curved { tolerance.mm() / 2.0 } else { tolerance.mm() };
    circle(reach, Tolerance::new(left).unwrap_or(tolerance))
}

/// The `$fn` for which OpenSCAD makes `count` facets of a part of a turn: it takes the share of `$fn`
/// and rounds down.
pub(super) fn full_turn(count: u32, angle: f64) -> u32 {
    let mut full = (f64::from(count) * 360.0 / angle).floor() as u32;
    while f64::from(full) * angle / 360.0 < f64::from(count) {
        full += 1;
    }
    full
}

/// Slices of a twisted extrusion. Two errors add: corners run along helices (square of the angle
/// between slices), and the two triangles between two skew edges leave the ruled surface by a quarter
/// of the edges' difference (linear).
pub(super) fn slices(region: &Region, twist: f64, scale: DVec2, tolerance: Tolerance) -> u32 {
    let angle = twist.abs().to_radians();
    let grown = scale.max_element().max(1.0);
    let (mut helix, mut skew) = (0.0f64, 0.0f64);
    for contour in region.contours() {
        let next = contour.points.iter().cycle().skip(1);
        for (from, to) in contour.points.iter().zip(next) {
            let along = to - from;
            let length = along.length();
            let shear = (scale.x - scale.y).abs() * (along.x * along.y).abs() / length;
            helix = helix.max(from.length() * grown * angle * angle / 8.0);
            skew = skew.max((length * grown * angle + shear) / 4.0);
        }
    }
    let mm = tolerance.mm();
    let slices = (skew + (skew * skew + 4.0 * mm * helix).sqrt()) / (2.0 * mm);
    slices.ceil().clamp(1.0, MOST_SLICES) as u32
}

/// The least multiple of four for which half a side spans at most `half` radians.
fn sides(half: f64, most: f64) -> u32 {
    let sides = (std::f64::consts::PI / half).clamp(FEWEST, most);
    ((sides / 4.0).ceil() * 4.0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_keep_to_the_tolerance() {
        for radius in [0.01, 1.0, 10.0, 250.0] {
            let n = circle(radius, Tolerance::DEFAULT);
            let sagitta = radius * (1.0 - libm::cos(std::f64::consts::PI / f64::from(n)));
            assert!(sagitta <= Tolerance::DEFAULT.mm() && n.is_multiple_of(4), "{radius}: {n}");
        }
    }

    #[test]
    fn openscad_makes_the_facets_asked_for() {
        for angle in [1.0, 47.0, 60.0, 90.0, 123.4, 270.0, 359.0] {
            for count in [1, 2, 7, 36] {
                let made = f64::from(full_turn(count, angle)) * angle / 360.0;
                assert_eq!(made.floor(), f64::from(count), "{count} of {angle}");
            }
        }
    }
}
