//! Trigonometry in degrees, the same on every machine and exact where the result is rational.
//!
//! Angles are folded into one eighth of a turn before libm sees them. Folding is exact (remainders and
//! differences of nearby floats), so symmetric angles give symmetric values to the bit.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use glam::{DVec2, dvec2};

/// 1 / sqrt 3, the tangent of 30 degrees.
const TAN_30: f64 = 0.577_350_269_189_625_8;
/// sqrt 3 / 2, the sine of 60 degrees.
const SIN_60: f64 = 0.866_025_403_784_438_6;
/// One unit in the last place of a number in [0.5, 1): a value this near to an irrational one
/// (a tangent, a sine) is that value rounded.
const ULP: f64 = 1.2e-16;

/// Sine of an angle in [0, 45] degrees.
fn small_sine(a: f64) -> f64 {
    match a {
        30.0 => 0.5,
        45.0 => FRAC_1_SQRT_2,
        _ => libm::sin(a * (PI / 180.0)),
    }
}

/// Cosine of an angle in [0, 45] degrees.
fn small_cosine(a: f64) -> f64 {
    match a {
        30.0 => SIN_60,
        45.0 => FRAC_1_SQRT_2,
        _ => libm::cos(a * (PI / 180.0)),
    }
}

/// Sine of an angle in [0, 90] degrees.
fn quarter_sine(a: f64) -> f64 {
    if a <= 45.0 { small_sine(a) } else { small_cosine(90.0 - a) }
}

/// Sine of an angle in degrees; exact at multiples of 30 and 90. NaN for what is not finite.
///
/// ```
/// use katachi::geom::trig::sin_deg;
/// assert_eq!(sin_deg(30.0), 0.5);
/// assert_eq!(sin_deg(-450.0), -1.0);
/// ```
pub fn sin_deg(degrees: f64) -> f64 {
    let (mut a, mut sign) = (degrees.abs() % 360.0, degrees.signum());
    if a >= 180.0 {
        (a, sign) = (a - 180.0, -sign);
    }
    let sine = quarter_sine(if a > 90.0 { 180.0 - a } else { a });
    if sine == 0.0 { 0.0 } else { sign * sine }
}

/// Cosine of an angle in degrees; exact at multiples of 60 and 90. NaN for what is not finite.
///
/// ```
/// use katachi::geom::trig::cos_deg;
/// assert_eq!((cos_deg(120.0), cos_deg(270.0)), (-0.5, 0.0));
/// ```
pub fn cos_deg(degrees: f64) -> f64 {
    let a = degrees.abs() % 360.0;
    let a = if a > 180.0 { 360.0 - a } else { a };
    if a > 90.0 { 0.0 - quarter_sine(a - 90.0) } else { quarter_sine(90.0 - a) }
}

/// Tangent of an angle in degrees; exact at multiples of 45, infinite at odd quarter turns.
///
/// ```
/// use katachi::geom::trig::tan_deg;
/// assert_eq!((tan_deg(45.0), tan_deg(135.0)), (1.0, -1.0));
/// ```
pub fn tan_deg(degrees: f64) -> f64 {
    sin_deg(degrees) / cos_deg(degrees)
}

/// Arc sine in degrees, from -90 to 90; NaN beyond [-1, 1].
///
/// ```
/// use katachi::geom::trig::asin_deg;
/// assert_eq!((asin_deg(0.5), asin_deg(-1.0)), (30.0, -90.0));
/// ```
pub fn asin_deg(x: f64) -> f64 {
    let a = x.abs();
    let known = [(0.0, 0.0), (0.5, 30.0), (FRAC_1_SQRT_2, 45.0), (SIN_60, 60.0), (1.0, 90.0)];
    let exact = known.iter().find(|(sine, _)| (a - sine).abs() < ULP * sine);
    let angle = exact.map_or_else(|| libm::asin(a) * (180.0 / PI), |(_, angle)| *angle);
    if angle == 0.0 { 0.0 } else { angle * x.signum() }
}

/// Arc cosine in degrees, from 0 to 180; NaN beyond [-1, 1].
///
/// ```
/// use katachi::geom::trig::acos_deg;
/// assert_eq!((acos_deg(0.5), acos_deg(-1.0)), (60.0, 180.0));
/// ```
pub fn acos_deg(x: f64) -> f64 {
    if x.abs() > 0.9 && x.abs() < 1.0 {
        let angle = libm::acos(x.abs()) * (180.0 / PI);
        return if x < 0.0 { 180.0 - angle } else { angle };
    }
    90.0 - asin_deg(x)
}

/// Direction of (x, y) in degrees, counter-clockwise from +x, in (-180, 180]; 0 for the origin. Exact
/// at multiples of 30 and 45.
///
/// ```
/// use katachi::geom::trig::atan2_deg;
/// assert_eq!((atan2_deg(1.0, -1.0), atan2_deg(0.0, -2.0)), (135.0, 180.0));
/// ```
pub fn atan2_deg(y: f64, x: f64) -> f64 {
    let (ay, ax) = (y.abs(), x.abs());
    let angle = if ay <= ax { eighth_angle(ay, ax) } else { 90.0 - eighth_angle(ax, ay) };
    let angle = if x < 0.0 { 180.0 - angle } else { angle };
    if y < 0.0 { -angle } else { angle }
}

/// Arc tangent in degrees, from -90 to 90; exact at multiples of 30 and 45.
pub fn atan_deg(x: f64) -> f64 {
    atan2_deg(x, 1.0)
}

/// The angle of (run, rise), 0 <= rise <= run, in [0, 45] degrees.
fn eighth_angle(rise: f64, run: f64) -> f64 {
    if rise == 0.0 {
        return 0.0;
    }
    if rise == run {
        return 45.0;
    }
    let slope = rise / run;
    if (slope - TAN_30).abs() < ULP { 30.0 } else { libm::atan(slope) * (180.0 / PI) }
}

/// Corner `i` of the regular `n`-gon in the unit circle, corner 0 on +x, counter-clockwise. Corners
/// that mirror each other about an axis or a diagonal do so to the bit.
///
/// ```
/// use glam::dvec2;
/// use katachi::geom::trig::unit_circle;
/// assert_eq!(unit_circle(4, 3), dvec2(0.0, -1.0));
/// ```
pub fn unit_circle(n: u32, i: u32) -> DVec2 {
    let n = u64::from(n.max(1));
    let mut k = u64::from(i) % n;
    // The angle is k / n turns, then k / 2n, then k / 4n, folded at each step.
    let below = 2 * k > n;
    k = if below { n - k } else { k };
    let left = 4 * k > n;
    k = if left { n - 2 * k } else { 2 * k };
    let steep = 4 * k > n;
    k = if steep { n - 2 * k } else { 2 * k };
    let angle = 90.0 * k as f64 / n as f64;
    let (mut x, mut y) = (small_cosine(angle), small_sine(angle));
    if steep {
        (x, y) = (y, x);
    }
    dvec2(if left { -x } else { x }, if below { -y } else { y }) + DVec2::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rational_results_are_exact() {
        let sines = [0.0, 0.5, 1.0, 0.5, 0.0, -0.5, -1.0, -0.5, 0.0];
        let angles = [0.0, 30.0, 90.0, 150.0, 180.0, 210.0, 270.0, 330.0, 360.0];
        for (angle, sine) in angles.into_iter().zip(sines) {
            assert_eq!(sin_deg(angle), sine);
            assert_eq!(sin_deg(angle + 3600.0), sine);
            assert_eq!(sin_deg(-angle), -sine);
            assert_eq!(cos_deg(angle - 90.0), sine);
        }
        assert_eq!(tan_deg(90.0), f64::INFINITY);
        assert_eq!(tan_deg(225.0), 1.0);
    }

    #[test]
    fn symmetric_to_the_bit_and_right() {
        for i in 0..2000 {
            let x = f64::from(i) * 0.28125;
            assert_eq!(sin_deg(180.0 - x), sin_deg(x), "{x}");
            assert_eq!(cos_deg(x), sin_deg(90.0 - x), "{x}");
            assert!((sin_deg(x) - libm::sin(x.to_radians())).abs() < 3e-15);
        }
    }

    #[test]
    fn inverses_come_back() {
        for angle in [0.0, 30.0, 45.0, 60.0, 90.0] {
            assert_eq!(asin_deg(sin_deg(angle)), angle);
            assert_eq!(acos_deg(cos_deg(angle)), angle);
            assert_eq!(acos_deg(-cos_deg(angle)), 180.0 - angle);
        }
        for i in -17..=18 {
            let angle = f64::from(i) * 10.0;
            let back = atan2_deg(sin_deg(angle), cos_deg(angle));
            assert!((back - angle).abs() < 1e-13);
            assert!(i % 3 != 0 || back == angle, "{angle} came back as {back}");
        }
        assert!(asin_deg(1.5).is_nan() && acos_deg(-1.5).is_nan());
    }

    #[test]
    fn polygons_are_symmetric() {
        for n in [3, 4, 5, 6, 7, 8, 12, 30, 31, 64, 100] {
            for i in 0..n {
                let p = unit_circle(n, i);
                assert_eq!(unit_circle(n, n - i), dvec2(p.x, 0.0 - p.y));
                if n % 2 == 0 {
                    assert_eq!(unit_circle(n, i + n / 2), DVec2::ZERO - p);
                }
                if n % 4 == 0 {
                    assert_eq!(unit_circle(n, i + n / 4), dvec2(0.0 - p.y, p.x));
                }
                let angle = 360.0 * f64::from(i) / f64::from(n);
                assert!((p - dvec2(cos_deg(angle), sin_deg(angle))).length() < 1e-15);
            }
        }
    }
}
