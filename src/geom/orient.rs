//! Exact orientation of float points, in the plane and in space.
//!
//! A float filter answers nearly always, in space one of twice the precision nearly all of the rest; what they leave
//! open is decided by floating-point expansions
//! (sums of non-overlapping floats, exact). Used by triangulation and the convex hull, whose points are
//! free floats; set operations have lattice predicates of their own.
//!
//! Source: J. R. Shewchuk, *Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
//! Predicates*, 1997. Exact while products of three differences neither overflow nor fall below the
//! normal floats: coordinates zero or between 1e-70 and 1e100 in size.

use glam::{DVec2, DVec3};

/// Half a unit in the last place of 1: the largest relative rounding error.
const EPSILON: f64 = f64::EPSILON / 2.0;
/// Shewchuk's bound for the plane filter, relative to the sum of the two products' sizes.
const BOUND_2D: f64 = (3.0 + 16.0 * EPSILON) * EPSILON;
/// Shewchuk's bound for the space filter, relative to the permanent.
const BOUND_3D: f64 = (7.0 + 56.0 * EPSILON) * EPSILON;
/// 2^27 + 1 splits a float into two halves of 26 bits.
const SPLITTER: f64 = 134_217_729.0;

/// Positive when a, b, c turn counter-clockwise, negative when clockwise, 0 when on one line. The sign
/// is exact; the size is about twice the area of the triangle.
///
/// ```
/// use glam::dvec2;
/// use katachi::geom::orient::orient2d;
/// assert!(orient2d(dvec2(0.1, 0.1), dvec2(0.3, 0.3), dvec2(0.7, 0.7)) == 0.0);
/// ```
#[inline]
pub fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let left = (a.x - c.x) * (b.y - c.y);
    let right = (a.y - c.y) * (b.x - c.x);
    let (det, permanent) = (left - right, left.abs() + right.abs());
    if det.abs() > BOUND_2D * permanent {
        return det;
    }
    // Without terms there is nothing to round: c is one of the others, mostly.
    if permanent == 0.0 { 0.0 } else { exact_2d(a, b, c) }
}

/// Positive when d lies on the side of the plane a, b, c from which they turn clockwise (below, in
/// Shewchuk's convention), negative above, 0 on it. The sign is exact; the size is about six times the
/// volume of the tetrahedron.
///
/// ```
/// use glam::DVec3;
/// use katachi::geom::orient::orient3d;
/// assert!(orient3d(DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z) < 0.0);
/// ```
#[inline]
pub fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let (p, q, r) = (a - d, b - d, c - d);
    let det = p.dot(q.cross(r));
    let (p, q, r) = (p.abs(), q.abs(), r.abs());
    let permanent = p.x * (q.y * r.z + q.z * r.y)
        + p.y * (q.z * r.x + q.x * r.z)
        + p.z * (q.x * r.y + q.y * r.x);
    if det.abs() > BOUND_3D * permanent {
        return det;
    }
    // Without terms there is nothing to round: d is one of the others, mostly.
    if permanent == 0.0 { 0.0 } else { exact_3d(a, b, c, d, permanent) }
}

/// A sum of floats of growing size that do not overlap: an exact number. Zeros are left out.
#[derive(Clone, Copy)]
struct Expansion<const N: usize> {
    terms: [f64; N],
    len: usize,
}

fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let virtual_b = sum - a;
    (sum, (a - (sum - virtual_b)) + (b - virtual_b))
}

fn split(a: f64) -> (f64, f64) {
    let c = SPLITTER * a;
    let high = c - (c - a);
    (high, a - high)
}

fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    let error = ((product - ah * bh) - al * bh) - ah * bl;
    (product, al * bl - error)
}

impl<const N: usize> Expansion<N> {
    const ZERO: Expansion<N> = Expansion { terms: [0.0; N], len: 0 };

    /// a - b, exactly.
    fn difference(a: f64, b: f64) -> Expansion<N> {
        let (sum, rest) = two_sum(a, -b);
        let mut e = Expansion::ZERO;
        e.push(rest);
        e.push(sum);
        e
    }

    fn push(&mut self, term: f64) {
        if term != 0.0 {
            self.terms[self.len] = term;
            self.len += 1;
        }
    }

    fn iter(&self) -> impl Iterator<Item = f64> + '_ {
        self.terms[..self.len].iter().copied()
    }

    /// Adds one float (grow-expansion).
    fn add(&mut self, b: f64) {
        let (mut q, mut out) = (b, 0);
        for i in 0..self.len {
            let (sum, rest) = two_sum(q, self.terms[i]);
            q = sum;
            if rest != 0.0 {
                self.terms[out] = rest;
                out += 1;
            }
        }
        self.len = out;
        self.push(q);
    }

    /// Adds `sign` times the product of two expansions.
    fn add_product<const A: usize, const B: usize>(
        &mut self,
        a: &Expansion<A>,
        b: &Expansion<B>,
        sign: f64,
    ) {
        for x in a.iter() {
            for y in b.iter() {
                let (product, rest) = two_product(sign * x, y);
                self.add(rest);
                self.add(product);
            }
        }
    }

    /// The largest term, which has the sign of the whole.
    fn estimate(&self) -> f64 {
        if self.len == 0 { 0.0 } else { self.terms[self.len - 1] }
    }
}

#[cold]
fn exact_2d(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let diff = Expansion::<2>::difference;
    let mut det = Expansion::<16>::ZERO;
    det.add_product(&diff(a.x, c.x), &diff(b.y, c.y), 1.0);
    det.add_product(&diff(a.y, c.y), &diff(b.x, c.x), -1.0);
    det.estimate()
}

/// A number as the sum of two floats, the second below the last place of the first.
#[derive(Clone, Copy)]
struct Twice(f64, f64);

impl Twice {
    /// a - b, exactly.
    fn difference(a: f64, b: f64) -> Twice {
        let (high, low) = two_sum(a, -b);
        Twice(high, low)
    }

    /// The product, up to 8 times 2^-106 of it.
    fn times(self, other: Twice) -> Twice {
        let (high, low) = two_product(self.0, other.0);
        let (high, low) = two_sum(high, low + (self.0 * other.1 + self.1 * other.0));
        Twice(high, low)
    }

    /// The sum, up to 4 times 2^-106 of both sizes.
    fn plus(self, other: Twice) -> Twice {
        let (high, low) = two_sum(self.0, other.0);
        let (high, low) = two_sum(high, low + (self.1 + other.1));
        Twice(high, low)
    }

    fn minus(self, other: Twice) -> Twice {
        self.plus(Twice(-other.0, -other.1))
    }
}

/// Two products in a row and four sums, each with an error of at most 8 times 2^-106 of the permanent, and ample room
/// for what the permanent is wrong.
const BOUND_TWICE: f64 = 1024.0 * EPSILON * EPSILON;

#[cold]
fn exact_3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3, permanent: f64) -> f64 {
    let [p, q, r] = [a, b, c].map(|p| [0, 1, 2].map(|i| Twice::difference(p[i], d[i])));
    let minor = |j: usize, k: usize| q[j].times(r[k]).minus(q[k].times(r[j]));
    let [x, y, z] = [(0, 1, 2), (1, 2, 0), (2, 0, 1)].map(|(i, j, k)| p[i].times(minor(j, k)));
    let det = x.plus(y).plus(z);
    if det.0.abs() > BOUND_TWICE * permanent { det.0 } else { expanded_3d(a, b, c, d) }
}

fn expanded_3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let rows = [a, b, c].map(|p| [0, 1, 2].map(|i| Expansion::<2>::difference(p[i], d[i])));
    let [p, q, r] = &rows;
    let mut det = Expansion::<192>::ZERO;
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        let mut minor = Expansion::<16>::ZERO;
        minor.add_product(&q[j], &r[k], 1.0);
        minor.add_product(&q[k], &r[j], -1.0);
        det.add_product(&p[i], &minor, 1.0);
    }
    det.estimate()
}

#[cfg(test)]
mod tests {
    use dashu::rational::RBig;
    use glam::{dvec2, dvec3};

    use super::*;

    fn sign(x: f64) -> i32 {
        i32::from(x > 0.0) - i32::from(x < 0.0)
    }

    fn rational(x: f64) -> RBig {
        RBig::try_from(x).expect("finite")
    }

    fn rational_sign(x: &RBig) -> i32 {
        i32::from(*x > RBig::ZERO) - i32::from(*x < RBig::ZERO)
    }

    fn rational_3d([a, b, c, d]: [DVec3; 4]) -> RBig {
        let rows = [a, b, c].map(|p| [0, 1, 2].map(|k| rational(p[k]) - rational(d[k])));
        let [p, q, s] = &rows;
        let minor = |j: usize, k: usize| q[j].clone() * &s[k] - q[k].clone() * &s[j];
        p[0].clone() * minor(1, 2) + p[1].clone() * minor(2, 0) + p[2].clone() * minor(0, 1)
    }

    #[test]
    fn the_plane_sign_is_that_of_rational_arithmetic() {
        for i in 0..400 {
            let step = |k: i32| f64::from(k) * 2f64.powi(-53);
            let a = dvec2(0.5 + step(i % 20), 0.5 + step(i / 20));
            let (b, c) = (dvec2(12.0, 12.0), dvec2(24.0, 24.0 + step(i % 3) * 64.0));
            let r = rational;
            let exact =
                (r(a.x) - r(c.x)) * (r(b.y) - r(c.y)) - (r(a.y) - r(c.y)) * (r(b.x) - r(c.x));
            assert_eq!(sign(orient2d(a, b, c)), rational_sign(&exact));
        }
    }

    #[test]
    fn the_space_sign_is_that_of_rational_arithmetic() {
        for i in 0..400 {
            let step = |k: i32| f64::from(k - 3) * 2f64.powi(-52);
            let d = dvec3(0.1 + step(i % 7), 0.3 + step(i / 7 % 7), 0.7 + step(i / 49));
            let (a, b) = (dvec3(0.2, 0.2, 0.7), dvec3(12.3, 0.4, 0.7));
            let c = dvec3(0.5, 17.9, 0.7 + step(i % 5));
            let exact = rational_3d([a, b, c, d]);
            assert_eq!(sign(orient3d(a, b, c, d)), rational_sign(&exact));
            assert_eq!(sign(expanded_3d(a, b, c, d)), rational_sign(&exact));
        }
    }

    /// Places in a plane that is not one of doubles, so that their heights are of the size of rounding or nothing.
    #[test]
    fn twice_the_precision_tells_the_sign_in_space() {
        let mut certain = 0;
        for i in 0..500u32 {
            let share = |k: u32| f64::from((i * 7919 + k * 104_729) % 1000) / 999.0 - 0.5;
            let on = |k: u32| {
                let (u, v) = (share(k) * 30.0, share(k + 1) * 30.0);
                dvec3(u, v, 0.3 * u - 0.7 * v)
            };
            let [a, b, c, d] = [on(0), on(2), on(4), if i % 5 == 0 { on(2) } else { on(6) }];
            let exact = rational_3d([a, b, c, d]);
            assert_eq!(sign(orient3d(a, b, c, d)), rational_sign(&exact));
            let twice = exact_3d(a, b, c, d, 0.0);
            let wrong = exact - rational(twice);
            assert!(wrong < rational(1e-25) && wrong > rational(-1e-25), "{twice}");
            certain += u32::from(twice.abs() > 1e-20);
        }
        assert!(certain > 250, "{certain}");
    }
}
