//! How much a map makes the longest of lengths longer.

use std::f64::consts::SQRT_2;

use glam::{DMat2, DMat3, DVec3};

/// By how much a way of placements stretches at most: the largest singular value of its linear part.
///
/// Kept to 32 bits of the fraction, so that what rounding does to a rotation is not seen: every rigid motion
/// stretches by exactly one. Compared, ordered and hashed by its bits.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Stretch(u64);

/// Bits of a fraction.
const FRACTION: u32 = 52;

/// Bits of a fraction that are rounded away.
const ROUNDED: u32 = 20;

/// The largest stretch that is told apart, and the inverse of the smallest: far beyond all coordinates,
/// and its square is still a number.
const MOST: f64 = 1e150;

/// Rounds of rotations after which a matrix of three rows is diagonal: the rest is squared in each.
const SWEEPS: usize = 8;

impl Stretch {
    /// What leaves lengths as they are.
    pub const ONE: Stretch = Stretch(1.0f64.to_bits());

    /// A stretch by a factor; one that is no number is taken for 1.
    pub fn by(factor: f64) -> Stretch {
        if factor.is_nan() {
            return Stretch::ONE;
        }
        let half = 1 << (ROUNDED - 1);
        let bits = factor.clamp(1.0 / MOST, MOST).to_bits() + half;
        Stretch(bits >> ROUNDED << ROUNDED)
    }

    /// The stretch of a linear map.
    ///
    /// ```
    /// use glam::{DMat3, DVec3};
    /// use katachi::geom::{Stretch, trig};
    /// let turn = DMat3::from_cols(
    ///     DVec3::new(trig::cos_deg(10.0), trig::sin_deg(10.0), 0.0),
    ///     DVec3::new(-trig::sin_deg(10.0), trig::cos_deg(10.0), 0.0),
    ///     DVec3::Z,
    /// );
    /// assert_eq!(Stretch::of(turn), Stretch::ONE);
    /// let wide = DMat3::from_diagonal(DVec3::new(3.0, 1.0, 0.5));
    /// assert_eq!(Stretch::of(turn * wide * turn).factor(), 3.0);
    /// ```
    pub fn of(linear: DMat3) -> Stretch {
        if linear == DMat3::IDENTITY { Stretch::ONE } else { Stretch::by(largest(linear)) }
    }

    /// The stretch of a linear map of a plane.
    pub fn of_plane(linear: DMat2) -> Stretch {
        let [x, y] = [linear.x_axis, linear.y_axis].map(|column| column.extend(0.0));
        Stretch::of(DMat3::from_cols(x, y, DVec3::ZERO))
    }

    /// One stretch after another: at least what both together do.
    pub fn times(self, other: Stretch) -> Stretch {
        match (self, other) {
            (Stretch::ONE, other) => other,
            (this, Stretch::ONE) => this,
            (this, other) => Stretch::by(this.factor() * other.factor()),
        }
    }

    /// The least power of the fourth root of 2 that is not below this: few of them stand for all.
    ///
    /// ```
    /// use katachi::geom::Stretch;
    /// assert_eq!(Stretch::by(3.9).rounded_up().factor(), 4.0);
    /// assert_eq!(Stretch::ONE.rounded_up(), Stretch::ONE);
    /// ```
    pub fn rounded_up(self) -> Stretch {
        const STEPS: [f64; 5] = [1.0, 1.189_207_115_002_721, SQRT_2, 1.681_792_830_507_429, 2.0];
        let whole = f64::from_bits(self.0 >> FRACTION << FRACTION);
        let steps = STEPS.map(|step| Stretch::by(whole * step));
        steps.into_iter().find(|&step| step >= self).unwrap_or(self)
    }

    /// The factor.
    pub fn factor(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// The largest singular value: the root of the largest eigenvalue of the map after its transpose, found with
/// Jacobi's rotations, which are exact to rounding also where eigenvalues are equal.
fn largest(linear: DMat3) -> f64 {
    if !linear.is_finite() {
        return f64::NAN;
    }
    let entries = linear.to_cols_array();
    let size = entries.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if size == 0.0 {
        return 0.0;
    }
    let unit = DMat3::from_cols_array(&entries.map(|x| x / size));
    let mut square = (unit.transpose() * unit).to_cols_array_2d();
    for _ in 0..SWEEPS {
        [(0, 1), (0, 2), (1, 2)].into_iter().for_each(|(p, q)| rotate(&mut square, p, q));
    }
    size * square[0][0].max(square[1][1]).max(square[2][2]).sqrt()
}

/// The rotation in the plane of two axes that makes their entry of a symmetric matrix zero.
fn rotate(m: &mut [[f64; 3]; 3], p: usize, q: usize) {
    if m[p][q] == 0.0 {
        return;
    }
    let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
    let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    let (r, shift) = (3 - p - q, tangent * m[p][q]);
    let (rp, rq) = (m[r][p], m[r][q]);
    m[p][p] -= shift;
    m[q][q] += shift;
    (m[p][q], m[q][p]) = (0.0, 0.0);
    m[r][p] = cosine * rp - sine * rq;
    m[r][q] = sine * rp + cosine * rq;
    (m[p][r], m[q][r]) = (m[r][p], m[r][q]);
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;
    use crate::geom::trig::{cos_deg, sin_deg};

    fn turn(axis: usize, degrees: f64) -> DMat3 {
        let mut columns = [DVec3::X, DVec3::Y, DVec3::Z];
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        let (u, v) = (columns[a], columns[b]);
        columns[a] = u * cos_deg(degrees) + v * sin_deg(degrees);
        columns[b] = v * cos_deg(degrees) - u * sin_deg(degrees);
        DMat3::from_cols(columns[0], columns[1], columns[2])
    }

    #[test]
    fn turns_do_not_stretch() {
        let mut way = DMat3::IDENTITY;
        for i in 0..1000 {
            way = turn(i % 3, 7.7 * i as f64) * way;
            assert_eq!(Stretch::of(way), Stretch::ONE);
            assert_eq!(Stretch::of(-way), Stretch::ONE);
        }
    }

    #[test]
    fn scales_are_found_through_turns() {
        for factor in [1e-9, 0.1, 1.0 / 3.0, 10.0, 25.4, 1e12] {
            for sizes in [dvec3(1.0, 1.0, 1.0), dvec3(1.0, 1.0, 0.2), dvec3(-0.3, 0.9, 1.0)] {
                let scale = DMat3::from_diagonal(factor * sizes);
                let bent = turn(0, 33.0) * turn(1, -71.0) * scale * turn(2, 12.0) * turn(0, 5.0);
                assert_eq!(Stretch::of(bent), Stretch::by(factor), "{factor} {sizes}");
                assert_eq!(Stretch::of(scale), Stretch::by(factor));
            }
        }
    }

    #[test]
    fn rounding_up_is_done_once() {
        for i in -300..300 {
            let stretch = Stretch::by(libm::pow(1.037, f64::from(i)));
            let rounded = stretch.rounded_up();
            assert!(rounded >= stretch && rounded.factor() < 1.19 * stretch.factor());
            assert_eq!(rounded.rounded_up(), rounded);
        }
    }

    #[test]
    fn a_shear_stretches() {
        let shear = DMat3::from_cols(DVec3::X, dvec3(1.0, 1.0, 0.0), DVec3::Z);
        let golden = (1.0 + 5f64.sqrt()) / 2.0;
        assert!((Stretch::of(shear).factor() / golden - 1.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_no_map_does_no_harm() {
        assert_eq!(Stretch::of(DMat3::NAN), Stretch::ONE);
        assert!(Stretch::of(DMat3::ZERO).factor() > 0.0);
        let huge = Stretch::by(f64::INFINITY);
        assert!(huge.times(huge).factor().is_finite());
    }
}
