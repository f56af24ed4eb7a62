//! Curves of a plane drawn as chords: how many, and where.
//!
//! The chord error is the distance between a chord and the arc it stands for. For a circle of radius r
//! and an arc of angle a it is r (1 - cos(a / 2)); for a Bezier curve it is at most h^2 M / 8, where h is
//! the step of the parameter and M the largest second derivative.

use glam::DVec2;

use super::{Tolerance, sides};

/// The most chords one curve is drawn with. Who draws a curve that needs more refuses it.
pub const MOST_CHORDS: u32 = 1 << 14;

/// The number of chords an arc of `radius` (mm) over `angle` (radians, any sign) needs: a share of those of
/// the full circle; at least 1, and maybe more than [`MOST_CHORDS`].
pub fn arc_chords(radius: f64, angle: f64, tolerance: Tolerance) -> u32 {
    let whole = f64::from(sides::circle(radius, tolerance));
    // A turn divided evenly must not cost one chord more for the rounding of the angle.
    const SLACK: f64 = 1e-9;
    (whole * angle.abs() / std::f64::consts::TAU - SLACK).ceil().max(1.0) as u32
}

/// A Bezier curve as chords.
#[derive(Clone, PartialEq, Debug)]
pub struct Chords {
    /// The number that the tolerance asks for.
    pub needed: u32,
    /// The corners of the chain, the curve's first point left out; not more than [`MOST_CHORDS`].
    pub points: Vec<DVec2>,
}

/// The chain of chords along a quadratic Bezier curve.
pub fn quadratic(p: [DVec2; 3], tolerance: Tolerance) -> Chords {
    let bend = 2.0 * (p[0] - 2.0 * p[1] + p[2]).length();
    along(bend, tolerance, p[2], |t| p[0].lerp(p[1], t).lerp(p[1].lerp(p[2], t), t))
}

/// The chain of chords along a cubic Bezier curve.
///
/// ```
/// use glam::dvec2;
/// use katachi::geom::{Tolerance, flatten::{MOST_CHORDS, cubic}};
/// let curve = |size: f64| [(0., 0.), (0., 1.), (1., 2.), (2., 2.)].map(|(x, y)| dvec2(x, y) * size);
/// let drawn = cubic(curve(10.0), Tolerance::DEFAULT);
/// assert_eq!((drawn.needed, drawn.points.len()), (13, 13));
/// assert!(cubic(curve(1e9), Tolerance::DEFAULT).needed > MOST_CHORDS);
/// ```
pub fn cubic(p: [DVec2; 4], tolerance: Tolerance) -> Chords {
    let bends = [p[0] - 2.0 * p[1] + p[2], p[1] - 2.0 * p[2] + p[3]];
    let bend = 6.0 * bends[0].length().max(bends[1].length());
    along(bend, tolerance, p[3], |t| {
        let (a, b, c) = (p[0].lerp(p[1], t), p[1].lerp(p[2], t), p[2].lerp(p[3], t));
        a.lerp(b, t).lerp(b.lerp(c, t), t)
    })
}

fn along(bend: f64, tolerance: Tolerance, end: DVec2, at: impl Fn(f64) -> DVec2) -> Chords {
    let needed = libm::sqrt(bend / (8.0 * tolerance.mm())).ceil();
    let needed = needed.clamp(1.0, f64::from(sides::MOST)) as u32;
    let drawn = needed.min(MOST_CHORDS);
    let point = |i| if i == drawn { end } else { at(f64::from(i) / f64::from(drawn)) };
    Chords { needed, points: (1..=drawn).map(point).collect() }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn a_cubic_ends_where_it_ends() {
        let p = [dvec2(0., 0.), dvec2(0., 5.), dvec2(5., 10.), dvec2(10., 10.)];
        let points = cubic(p, Tolerance::DEFAULT).points;
        assert_eq!(points.last(), Some(&p[3]));
        assert!(points.len() > 5 && points.len() < 20);
    }
}
