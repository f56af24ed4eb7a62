//! Exact signs about integer planes and the points where three of them meet.
//!
//! Everything here is integer arithmetic, so a sign is never wrong; filters in floating point are
//! the business of callers, who know the ranges.
//!
//! # Bit budget
//! Lattice coordinates stay within [`RANGE`] = 2^29 of the lattice centre.
//!
//! | quantity | bits |
//! |---|---|
//! | difference of two lattice points | 30 |
//! | plane normal, component | 61 |
//! | plane offset | 93 |
//! | cross product of two normals, component | 123 |
//! | point of three planes: common denominator | 187 |
//! | point of three planes: numerator | 219 |
//! | side of such a point to a plane | 282 (`Wide<5>`) |
//! | comparison of two such points along an axis | 407 (`Wide<7>`) |

use std::cmp::Ordering;

use super::wide::Wide;

/// Largest distance of a lattice coordinate from the lattice centre, in steps.
pub const RANGE: i64 = 1 << 29;

/// A vector of integers.
pub type Int3 = [i64; 3];

/// The plane of all points p with `normal` . p = `offset`.
///
/// ```
/// use katachi::geom::predicates::Plane;
/// let (plane, turned) = Plane::through([0, 0, -6], [1, 2, 3]).unwrap();
/// assert_eq!((plane.normal, plane.offset, turned), ([0, 0, 1], 3, true));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Plane {
    /// Primitive normal: no common divisor, first component that is not zero positive.
    pub normal: Int3,
    /// The value of `normal` . p on the plane.
    pub offset: i128,
}

impl Plane {
    /// The plane through a point across a direction, and whether its normal points against that
    /// direction. `None` when the direction is zero, or too long to belong to lattice points.
    pub fn through(direction: [i128; 3], point: Int3) -> Option<(Plane, bool)> {
        let size = direction.map(i128::unsigned_abs);
        let divisor = gcd(gcd(size[0], size[1]), size[2]);
        let first = direction.iter().find(|&&c| c != 0)?;
        let divisor = i128::try_from(divisor).ok()? * first.signum();
        let mut normal = [0; 3];
        for axis in 0..3 {
            normal[axis] = i64::try_from(direction[axis] / divisor).ok()?;
        }
        Some((Plane { normal, offset: dot(normal, point) }, *first < 0))
    }

    /// The plane through a lattice point across a vector between lattice points that is not zero. Its
    /// normal is that vector; it is not reduced, so equal planes may differ.
    pub fn across(normal: Int3, point: Int3) -> Plane {
        Plane { normal, offset: dot(normal, point) }
    }

    /// The sign of a lattice point: 1 where the normal points, 0 on the plane, else -1.
    pub fn side(&self, point: Int3) -> i32 {
        (dot(self.normal, point) - self.offset).signum() as i32
    }

    /// The sign of a point of three planes.
    pub fn side_of(&self, point: &Meet) -> i32 {
        let offset: Wide<5> = Wide::from(self.offset) * point.w.resize();
        let mut sum = -offset;
        for axis in 0..3 {
            let normal: Wide<5> = Wide::from(i128::from(self.normal[axis]));
            sum = sum + normal * point.x[axis].resize();
        }
        sum.sign()
    }
}

/// A point with rational coordinates `x / w`, `w` positive.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Meet {
    /// Numerators.
    pub x: [Wide<4>; 3],
    /// Common denominator.
    pub w: Wide<4>,
}

impl Meet {
    /// The point where three planes meet; `None` unless it is one point.
    pub fn of(a: &Plane, b: &Plane, c: &Plane) -> Option<Meet> {
        let (bc, ca, ab) =
            (cross(b.normal, c.normal), cross(c.normal, a.normal), cross(a.normal, b.normal));
        let wide = |v: i128| Wide::<4>::from(v);
        let w = (0..3)
            .fold(Wide::ZERO, |sum, axis| sum + wide(i128::from(a.normal[axis])) * wide(bc[axis]));
        let x = std::array::from_fn(|axis| {
            wide(a.offset) * wide(bc[axis])
                + wide(b.offset) * wide(ca[axis])
                + wide(c.offset) * wide(ab[axis])
        });
        match w.sign() {
            0 => None,
            1 => Some(Meet { x, w }),
            _ => Some(Meet { x: x.map(|v| -v), w: -w }),
        }
    }

    /// A lattice point.
    pub fn lattice(point: Int3) -> Meet {
        Meet { x: point.map(|c| Wide::from(i128::from(c))), w: Wide::from(1) }
    }

    /// Coordinates as doubles, each within 2^-50 of its size.
    pub fn approximate(&self) -> [f64; 3] {
        let w = self.w.to_f64();
        self.x.map(|x| x.to_f64() / w)
    }

    /// Whether a coordinate is exactly this integer.
    pub fn is_at(&self, axis: usize, value: i64) -> bool {
        (self.x[axis].resize::<5>() - Wide::from(i128::from(value)) * self.w.resize()).sign() == 0
    }

    /// Compares one coordinate of two points.
    pub fn compare(&self, other: &Meet, axis: usize) -> Ordering {
        let left: Wide<7> = self.x[axis].resize() * other.w.resize();
        let right: Wide<7> = other.x[axis].resize() * self.w.resize();
        (left - right).sign().cmp(&0)
    }
}

/// The scalar product.
pub fn dot(a: Int3, b: Int3) -> i128 {
    (0..3).map(|i| i128::from(a[i]) * i128::from(b[i])).sum()
}

/// The vector product.
pub fn cross(a: Int3, b: Int3) -> [i128; 3] {
    let [a, b] = [a, b].map(|v| v.map(i128::from));
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The difference a - b.
pub fn minus(a: Int3, b: Int3) -> Int3 {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Greatest common divisor; of 0 and b it is b.
fn gcd(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        if let (Ok(x), Ok(y)) = (u64::try_from(a), u64::try_from(b)) {
            return u128::from(gcd_short(x, y));
        }
        (a, b) = (b, a % b);
    }
    a
}

/// The binary algorithm (Stein 1967).
fn gcd_short(mut a: u64, mut b: u64) -> u64 {
    if a == 0 || b == 0 {
        return a | b;
    }
    let shift = (a | b).trailing_zeros();
    a >>= a.trailing_zeros();
    while b != 0 {
        b >>= b.trailing_zeros();
        (a, b) = (a.min(b), a.abs_diff(b));
    }
    a << shift
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(direction: [i128; 3], point: Int3) -> Plane {
        Plane::through(direction, point).expect("a direction").0
    }

    #[test]
    fn three_planes_meet_in_the_expected_point() {
        let a = plane([2, 0, 0], [3, 0, 0]);
        let b = plane([0, 1, 0], [0, -4, 0]);
        let c = plane([1, 1, 3], [0, 0, 1]);
        let meet = Meet::of(&a, &b, &c).expect("one point");
        assert_eq!(meet.approximate(), [3.0, -4.0, 4.0 / 3.0]);
        assert!(meet.is_at(1, -4) && !meet.is_at(2, 1));
        assert_eq!(c.side_of(&meet), 0);
        assert_eq!(plane([0, 0, 1], [0, 0, 1]).side_of(&meet), 1);
        assert_eq!(meet.compare(&Meet::lattice([3, 0, 2]), 2), Ordering::Less);
        assert_eq!(Meet::of(&a, &b, &plane([1, 1, 0], [0, 0, 0])), None);
    }

    #[test]
    fn the_largest_planes_stay_inside_the_budget() {
        let r = RANGE;
        let corner = |x: i64, y: i64, z: i64| [x * r, y * r, z * r];
        let big = |a: Int3, b: Int3, c: Int3| {
            let (p, q) = (minus(b, a), minus(c, a));
            plane(cross([p[0] - 1, p[1], p[2] - 3], [q[0], q[1] - 5, q[2] - 7]), a)
        };
        let a = big(corner(-1, -1, -1), corner(1, 1, -1), corner(1, -1, 1));
        let b = big(corner(1, -1, 1), corner(-1, 1, 1), corner(1, 1, -1));
        let c = big(corner(-1, 1, 1), corner(1, 1, 1), corner(-1, -1, -1));
        let meet = Meet::of(&a, &b, &c).expect("one point");
        for p in [a, b, c] {
            assert_eq!(p.side_of(&meet), 0);
        }
        assert_eq!(meet.compare(&meet, 0), Ordering::Equal);
    }

    #[test]
    fn divisors() {
        assert_eq!(gcd(0, 5), 5);
        assert_eq!(gcd(84, 36), 12);
        assert_eq!(gcd(1 << 100, 3 << 98), 1 << 98);
    }
}
