//! Exact signs on a lattice of integer-valued floats: the side of a plane, the side of a sphere.
//!
//! Coordinates stay within 2^51 of the lattice centre, so that differences of 53 bits are exact as floats; what
//! a float filter leaves open is decided by integers on the stack (276 bits at most). Five points on one sphere
//! are told apart by symbolic perturbation: the point of lower number is lifted by infinitely more, which makes
//! the Delaunay tetrahedralisation unique and free of flat tetrahedra.
//!
//! Source: O. Devillers, M. Teillaud, *Perturbations for Delaunay and weighted Delaunay 3D triangulations*,
//! 2011; filters after J. R. Shewchuk, 1997.

use glam::DVec3;

use crate::geom::wide::Wide;

/// The largest relative rounding error.
const EPSILON: f64 = f64::EPSILON / 2.0;
/// Shewchuk's bound for the determinant of three differences, relative to the permanent.
const BOUND_VOLUME: f64 = (7.0 + 56.0 * EPSILON) * EPSILON;
/// Shewchuk's bound for the lifted determinant, relative to the permanent.
const BOUND_SPHERE: f64 = (16.0 + 224.0 * EPSILON) * EPSILON;

/// The sign of the volume of a tetrahedron: 1 when d is on the side of a, b, c from which they turn
/// counter-clockwise, 0 when the four are in one plane.
pub(super) fn volume_sign(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> i32 {
    let rows = [b - a, c - a, d - a];
    let (det, permanent) = determinant(&rows);
    if det.abs() > BOUND_VOLUME * permanent {
        return if det > 0.0 { 1 } else { -1 };
    }
    if permanent == 0.0 { 0 } else { exact_determinant(&rows).sign() }
}

/// The determinant of three rows and the sum of the sizes of its terms.
fn determinant(&[p, q, r]: &[DVec3; 3]) -> (f64, f64) {
    let det = p.dot(q.cross(r));
    let (p, q, r) = (p.abs(), q.abs(), r.abs());
    let permanent = p.x * (q.y * r.z + q.z * r.y)
        + p.y * (q.z * r.x + q.x * r.z)
        + p.z * (q.x * r.y + q.y * r.x);
    (det, permanent)
}

#[cold]
fn exact_determinant(rows: &[DVec3; 3]) -> Wide<3> {
    let [p, q, r] = rows.map(|row| row.to_array().map(|c| i128::from(c as i64)));
    let minor = |j: usize, k: usize| Wide::<3>::from(q[j] * r[k] - q[k] * r[j]);
    Wide::from(p[0]) * minor(1, 2) + Wide::from(p[1]) * minor(2, 0) + Wide::from(p[2]) * minor(0, 1)
}

/// A point and its number, which decides ties.
pub(super) type Numbered = (u32, DVec3);

/// Whether the last point is inside the sphere through the first four, which span a positive volume. Never
/// undecided: ties are broken by the numbers of the points.
pub(super) fn in_sphere(tetrahedron: [Numbered; 4], point: Numbered) -> bool {
    let rows = tetrahedron.map(|(_, p)| p - point.1);
    let [a, b, c, d] = rows;
    let others = [[b, c, d], [a, d, c], [a, b, d], [a, c, b]];
    let (mut sum, mut bound) = (0.0, 0.0);
    for (row, minor) in rows.iter().zip(&others) {
        let (lift, (det, permanent)) = (row.length_squared(), determinant(minor));
        sum += lift * det;
        bound += lift * permanent;
    }
    if sum.abs() > BOUND_SPHERE * bound {
        return sum > 0.0;
    }
    exact_in_sphere(tetrahedron.map(|(number, _)| number), &rows, &others, point.0)
}

#[cold]
fn exact_in_sphere(
    numbers: [u32; 4],
    rows: &[DVec3; 4],
    others: &[[DVec3; 3]; 4],
    point: u32,
) -> bool {
    let minors = others.each_ref().map(exact_determinant);
    let lift =
        |row: &DVec3| row.to_array().iter().map(|&c| (c as i64 as i128).pow(2)).sum::<i128>();
    let sum = rows
        .iter()
        .zip(&minors)
        .fold(Wide::<5>::ZERO, |sum, (row, minor)| sum + Wide::from(lift(row)) * minor.resize());
    match sum.sign() {
        0 => perturbed(numbers, minors.map(Wide::sign), point),
        sign => sign > 0,
    }
}

/// The sign that the largest perturbation gives: the coefficient of the lift of the lowest number that has one.
fn perturbed(numbers: [u32; 4], signs: [i32; 4], point: u32) -> bool {
    let mut lifts = [(point, -1), (0, 0), (0, 0), (0, 0), (0, 0)];
    for i in 0..4 {
        lifts[i + 1] = (numbers[i], signs[i]);
    }
    lifts.sort_unstable();
    lifts.iter().find(|(_, sign)| *sign != 0).is_some_and(|(_, sign)| *sign > 0)
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    const UNIT: f64 = (1u64 << 50) as f64;

    #[test]
    fn signs_of_a_corner() {
        let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p * UNIT);
        let [a, b, c, d] = corner;
        assert_eq!(volume_sign(a, b, c, d), 1);
        assert_eq!(volume_sign(b, a, c, d), -1);
        assert_eq!(volume_sign(a, b, c, b + c + dvec3(0.0, 0.0, 1.0)), 1);
        let at = |p| (9, p);
        let sphere = [(0, a), (1, b), (2, c), (3, d)];
        let far = DVec3::splat(UNIT);
        assert!(in_sphere(sphere, at(far - DVec3::X)) && !in_sphere(sphere, at(far + DVec3::X)));
    }

    #[test]
    fn a_tie_has_one_answer_from_both_sides() {
        let cube: Vec<DVec3> = (0..8)
            .map(|i| dvec3(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * UNIT)
            .collect();
        let numbered = |i: usize| (i as u32, cube[i]);
        // Two tetrahedra over one face: each fifth point is in the other's sphere, or neither is.
        let (first, second) = ([1, 2, 4, 7], [2, 1, 4, 0]);
        let [a, b, c, d] = second.map(numbered);
        assert_eq!(volume_sign(a.1, b.1, c.1, d.1), 1);
        let one = in_sphere(first.map(numbered), numbered(0));
        let other = in_sphere(second.map(numbered), numbered(7));
        assert_eq!(one, other);
    }
}
