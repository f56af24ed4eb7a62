//! The exact sign of the area of a triangle in the plane.

use std::cmp::Ordering;

use glam::DVec2;

/// Bound of the relative rounding error of the plain determinant (Shewchuk, Adaptive Precision
/// Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997): (3 + 16 e) e, e = 2^-53.
const ROUNDING: f64 = 3.3306690738754716e-16;

/// `Greater` if a, b, c turn counter-clockwise, `Less` if clockwise, `Equal` if they lie on a line.
/// Exact for coordinates between 1e-100 and 1e100 in size.
///
/// ```
/// use glam::dvec2;
/// use katachi::kernel::profile::orientation::orientation;
/// let turn = orientation(dvec2(0.0, 0.0), dvec2(0.1, 0.1), dvec2(0.1 + 0.2, 0.3));
/// assert_eq!(turn, std::cmp::Ordering::Less); // 0.1 + 0.2 is more than 0.3
/// ```
pub fn orientation(a: DVec2, b: DVec2, c: DVec2) -> Ordering {
    let left = (a.x - c.x) * (b.y - c.y);
    let right = (a.y - c.y) * (b.x - c.x);
    let determinant = left - right;
    if determinant.abs() > ROUNDING * (left.abs() + right.abs()) {
        return determinant.total_cmp(&0.0);
    }
    exact(a, b, c)
}

/// The sign of ax by - ay bx + bx cy - by cx + cx ay - cy ax, summed without rounding.
fn exact(a: DVec2, b: DVec2, c: DVec2) -> Ordering {
    let mut sum = Expansion::default();
    for (p, q) in [(a, b), (b, c), (c, a)] {
        sum.add_product(p.x, q.y);
        sum.add_product(-p.y, q.x);
    }
    sum.sign()
}

/// A number as a sum of floats that do not overlap, least first.
#[derive(Default)]
struct Expansion {
    terms: Vec<f64>,
}

impl Expansion {
    fn add_product(&mut self, x: f64, y: f64) {
        let product = x * y;
        self.add(libm::fma(x, y, -product));
        self.add(product);
    }

    fn add(&mut self, value: f64) {
        let mut carry = value;
        for term in &mut self.terms {
            let sum = carry + *term;
            let part = sum - carry;
            *term = (carry - (sum - part)) + (*term - part);
            carry = sum;
        }
        self.terms.push(carry);
    }

    fn sign(&self) -> Ordering {
        let lead = self.terms.iter().rev().find(|t| **t != 0.0);
        lead.map_or(Ordering::Equal, |t| t.total_cmp(&0.0))
    }
}
