//! How many facets stand for a true curve: as many as the tolerance asks for.
//!
//! The one home of these counts: kernels make what they say, and OpenSCAD source asks for the same. They are
//! multiples of four, so that a circle keeps its extremes on both axes, and at least 8, below which nothing
//! looks round. They are not capped where anyone could use them ([`MOST`]): who makes facets refuses too
//! many, and no mesh is silently coarser than asked.

use glam::DVec2;

use super::{Contour, Region, Tolerance, region::EdgeCurve};

/// Fewest sides.
const FEWEST: f64 = 8.0;

/// Counts end here, far above what any mesh can have.
pub const MOST: u32 = 1 << 30;

/// Sides of the inscribed polygon whose edges stay within tolerance of the circle of radius `radius` (mm).
///
/// ```text
/// r (1 - cos(pi / n)) <= tolerance
/// ```
///
/// ```
/// use katachi::geom::{Tolerance, sides};
/// assert_eq!(sides::circle(5.0, Tolerance::DEFAULT), 24);
/// assert_eq!(sides::circle(10.0, Tolerance::DEFAULT), 32);
/// ```
pub fn circle(radius: f64, tolerance: Tolerance) -> u32 {
    // 1 - cos(a) = 2 sin(a / 2)^2
    sides(2.0 * libm::asin((tolerance.mm() / radius.abs() / 2.0).min(0.5).sqrt()))
}

/// Sides of a sphere of radius `radius` (mm), all of whose facets stay within tolerance. A facet falls short
/// twice, between its meridians and between its rings; the middle of a facet at the equator keeps
/// cos^2(pi / n) of the radius, and no point less.
///
/// ```text
/// r (1 - cos^2(pi / n)) <= tolerance
/// ```
pub fn sphere(radius: f64, tolerance: Tolerance) -> u32 {
    sides(libm::asin((tolerance.mm() / radius).min(1.0).sqrt()))
}

/// Sides of a torus about its axis and about its tube; each spends half of the tolerance.
pub fn torus(major: f64, minor: f64, tolerance: Tolerance) -> (u32, u32) {
    let half = tolerance.half();
    (circle(major + minor, half), circle(minor, half))
}

/// Sides of a full turn of a region about the y axis; where its edges are chords of curves, half of the
/// tolerance is theirs.
fn turn(region: &Region, tolerance: Tolerance) -> u32 {
    let reach = region.contours().flat_map(|c| &c.points).map(|p| p.x.abs()).fold(0.0, f64::max);
    let curved = region.contours().flat_map(|c| &c.curves).any(|&c| c != EdgeCurve::Line);
    circle(reach, if curved { tolerance.half() } else { tolerance })
}

/// Facets of a region's turn by `angle` degrees, with so many `sides` in a full turn or as many as the
/// tolerance asks for. Each turns less than half a turn, or nothing would be enclosed.
pub fn turned(region: &Region, angle: f64, sides: Option<u32>, tolerance: Tolerance) -> u32 {
    let full = sides.unwrap_or_else(|| turn(region, tolerance));
    if angle == 360.0 {
        return full;
    }
    let part = match sides {
        Some(_) => share(full, angle),
        None => (f64::from(full) * angle / 360.0).ceil() as u32,
    };
    part.max((angle / 180.0) as u32 + 1)
}

/// Facets of a part of a full turn of `full` sides, `angle` in degrees: OpenSCAD's expression, evaluated in
/// its order.
///
/// ```
/// assert_eq!(katachi::geom::sides::share(100, 49.0 * 3.6), 49);
/// ```
pub fn share(full: u32, angle: f64) -> u32 {
    (f64::from(full) * angle / 360.0).floor() as u32
}

/// The `$fn` for which OpenSCAD makes `count` facets of a part of a turn: the least whose [`share`] it is.
pub fn full_turn(count: u32, angle: f64) -> u32 {
    let full = (f64::from(count) * 360.0 / angle).floor() as u32;
    (full..).find(|&n| share(n, angle) >= count).unwrap_or(u32::MAX)
}

/// Slices of an extrusion that turns by `twist` degrees and is scaled by `scale`; a whole number, at least
/// 1, maybe beyond any use. Two errors add: corners run along helices (square of the angle between slices),
/// and a facet between two skew edges is split into two triangles that leave the ruled surface by a
/// quarter of the edges' difference across (linear).
pub fn slices(region: &Region, twist: f64, scale: DVec2, tolerance: Tolerance) -> f64 {
    let angle = twist.abs().to_radians();
    let grown = scale.max_element().max(1.0);
    let (mut helix, mut skew) = (0.0f64, 0.0f64);
    for edge in region.contours().flat_map(Contour::edges) {
        let along = edge.to - edge.from;
        let length = along.length();
        let shear = (scale.x - scale.y).abs() * (along.x * along.y).abs() / length;
        helix = helix.max(edge.from.length() * grown * angle * angle / 8.0);
        skew = skew.max((length * grown * angle + shear) / 4.0);
    }
    let mm = tolerance.mm();
    ((skew + (skew * skew + 4.0 * mm * helix).sqrt()) / (2.0 * mm)).ceil().max(1.0)
}

/// The least multiple of four for which half a side spans at most `half` radians.
fn sides(half: f64) -> u32 {
    let sides = (std::f64::consts::PI / half).clamp(FEWEST, f64::from(MOST));
    ((sides / 4.0).ceil() * 4.0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_count_that_keeps_to_the_tolerance() {
        for radius in [0.01, 1.0, 10.0, 250.0, 1e5] {
            let sagitta = |n: u32| radius * (1.0 - libm::cos(std::f64::consts::PI / f64::from(n)));
            let n = circle(radius, Tolerance::DEFAULT);
            assert!(sagitta(n) <= Tolerance::DEFAULT.mm() && n.is_multiple_of(4), "{radius}: {n}");
            assert!(n == 8 || sagitta(n - 4) > Tolerance::DEFAULT.mm(), "{radius}: {n}");
        }
    }

    #[test]
    fn counts_beyond_any_use_end() {
        let fine = Tolerance::new(1e-300).expect("positive");
        assert_eq!((circle(1e12, fine), sphere(1e12, fine)), (MOST, MOST));
        assert_eq!(circle(0.0, fine), 8);
    }

    #[test]
    fn openscad_makes_the_facets_asked_for() {
        for angle in [1.0, 47.0, 60.0, 90.0, 123.4, 270.0, 359.0] {
            for count in [1, 2, 7, 36] {
                assert_eq!(share(full_turn(count, angle), angle), count, "{count} of {angle}");
            }
        }
    }
}
