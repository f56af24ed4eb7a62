//! How many facets a true curve gets.

use crate::geom::Tolerance;

/// Fewest sides of a circle: below it would not be read as one.
const FEWEST: f64 = 8.0;
/// Most sides: a guard against tolerances far below the size of the model.
const MOST: f64 = 4096.0;

/// Sides of a circle whose chords are at most the tolerance off it, a multiple of four so that its
/// bounding box is exact.
///
/// ```text
/// r (1 - cos(pi / n)) <= tolerance
/// ```
pub(super) fn circle(radius: f64, tolerance: Tolerance) -> u32 {
    let cosine = (1.0 - tolerance.mm() / radius).max(0.0);
    let sides = (std::f64::consts::PI / libm::acos(cosine)).clamp(FEWEST, MOST);
    ((sides / 4.0).ceil() * 4.0) as u32
}

/// Sides of the largest ring of a sphere: its facets bend both ways, so each way gets half.
pub(super) fn sphere(radius: f64, tolerance: Tolerance) -> u32 {
    let half = Tolerance::new(tolerance.mm() / 2.0).unwrap_or(tolerance);
    circle(radius, half)
}

/// Slices of a twisted extrusion whose corners reach `reach` mm from the axis and whose edges are at
/// most `edge` mm long.
///
/// Corners move on helices, so their chords are those of a circle. An edge sweeps a ruled surface, and
/// the two triangles that stand for it between slices an angle t apart are `edge * t / 4` off it.
pub(super) fn twist_slices(reach: f64, edge: f64, twist: f64, tolerance: Tolerance) -> u32 {
    let helices = f64::from(circle(reach, tolerance)) * twist.abs() / 360.0;
    let ruled = edge * twist.abs().to_radians() / (4.0 * tolerance.mm());
    helices.max(ruled).clamp(1.0, MOST).ceil() as u32
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
}
