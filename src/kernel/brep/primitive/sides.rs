//! How many sides keep a round solid within tolerance of the true surface.

use crate::geom::{
    Tolerance,
    trig::{acos_deg, cos_deg},
};

/// The most sides a circle gets; a radius above 2.7e7 tolerances is cut coarser than asked.
pub const MAX_CIRCLE_SIDES: u32 = 16_384;
/// The most sides a sphere or a torus gets each way (four million triangles); a radius above 4e5
/// tolerances is cut coarser than asked.
pub const MAX_SPHERE_SIDES: u32 = 2_048;

/// Fewer sides do not look round.
const FEWEST: u32 = 8;
/// Sides come in multiples of this, so that a circle keeps its extremes on both axes.
const STEP: u32 = 4;

/// The smallest allowed number of sides for which `near(180 / sides)`, the share of the radius that the
/// facets' middles keep, loses at most `error` of the radius `r`.
fn fewest_sides(r: f64, error: f64, most: u32, near: impl Fn(f64) -> f64) -> u32 {
    let fits = |n: u32| r * (1.0 - near(180.0 / f64::from(n))) <= error;
    let half = acos_deg((1.0 - error / r).clamp(-1.0, 1.0));
    let guess = (180.0 / half.max(180.0 / f64::from(most))) as u32;
    let mut sides = (guess / STEP * STEP).clamp(FEWEST, most);
    while sides > FEWEST && fits(sides - STEP) {
        sides -= STEP;
    }
    while sides < most && !fits(sides) {
        sides += STEP;
    }
    sides
}

/// Sides of the inscribed polygon whose edges stay within tolerance of the circle of radius `r`: a
/// multiple of 4, from 8 to [`MAX_CIRCLE_SIDES`].
///
/// ```
/// use katachi::{geom::Tolerance, kernel::brep::primitive::circle_sides};
/// assert_eq!(circle_sides(5.0, Tolerance::DEFAULT), 24);
/// ```
pub fn circle_sides(r: f64, tolerance: Tolerance) -> u32 {
    fewest_sides(r, tolerance.mm(), MAX_CIRCLE_SIDES, cos_deg)
}

/// Sides of a [`sphere`](super::sphere) all of whose facets stay within tolerance of the ball of radius
/// `r`: a multiple of 4, from 8 to [`MAX_SPHERE_SIDES`].
///
/// A facet falls short twice, between its meridians and between its rings; the middle of a facet at the
/// equator keeps cos^2(180 / n) of the radius, and no point less.
pub fn sphere_sides(r: f64, tolerance: Tolerance) -> u32 {
    let near = |angle: f64| cos_deg(angle) * cos_deg(angle);
    fewest_sides(r, tolerance.mm(), MAX_SPHERE_SIDES, near)
}

/// Sides around the axis and around the tube that keep a torus within tolerance, each spending half of
/// it: multiples of 4, from 8 to [`MAX_SPHERE_SIDES`].
pub fn torus_sides(major: f64, minor: f64, tolerance: Tolerance) -> (u32, u32) {
    let share = tolerance.mm() / 2.0;
    let sides = |r: f64| fewest_sides(r, share, MAX_SPHERE_SIDES, cos_deg);
    (sides(major + minor), sides(minor))
}
