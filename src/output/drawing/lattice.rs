//! The picture's own lattice: whole numbers, so that which side of a line a point lies on is never wrong.
//!
//! Image points are rounded once, to 2^-45 of the picture's size. From then on the rounded picture *is* the
//! picture, and signs about it are exact: by floats where these are sure, else by 128-bit integers.

use glam::{DVec2, DVec3};

/// Coordinates stay below 2^BITS lattice steps in size.
const BITS: i32 = 44;

/// A determinant of coordinate differences (45 bits each) that is larger than this in floats has the right
/// sign: two products of 90 bits are each rounded by 2^36 at most, and so is their difference.
const SURE: f64 = (1u64 << 39) as f64;

/// The map between picture millimetres and lattice steps.
#[derive(Clone, Copy, Debug)]
pub struct Lattice {
    origin: DVec2,
    /// Steps for each millimetre, a power of two.
    scale: f64,
}

impl Lattice {
    /// A lattice for all points between two corners, in millimetres.
    pub fn around(min: DVec2, max: DVec2) -> Lattice {
        let origin = min + (max - min) / 2.0;
        let half = (max - min).max_element() / 2.0;
        let size = if half > 0.0 && half.is_finite() { half } else { 1.0 };
        let (_, exponent) = libm::frexp(size);
        Lattice { origin, scale: libm::ldexp(1.0, BITS - exponent) }
    }

    /// The lattice point nearest to a point in millimetres.
    #[inline]
    pub fn place(&self, p: DVec2) -> DVec2 {
        ((p - self.origin) * self.scale).round() + DVec2::ZERO
    }

    /// A point in millimetres as a place between lattice points.
    #[inline]
    pub fn exact(&self, p: DVec2) -> DVec2 {
        (p - self.origin) * self.scale
    }

    /// A place on the lattice, or between its points, in millimetres.
    #[inline]
    pub fn millimetres(&self, p: DVec2) -> DVec2 {
        p / self.scale + self.origin
    }

    /// So many millimetres in steps.
    pub fn steps(&self, millimetres: f64) -> f64 {
        millimetres * self.scale
    }
}

/// Twice the area of the triangle a, b, c of lattice points, positive when they turn counter-clockwise: the
/// sign is exact, zero included.
#[inline]
pub fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let (p, q) = (b - a, c - a);
    let det = p.x * q.y - p.y * q.x;
    if det.abs() > SURE { det } else { exact(p, q) }
}

#[cold]
fn exact(p: DVec2, q: DVec2) -> f64 {
    let [a, b, c, d] = [p.x, p.y, q.x, q.y].map(|v| v as i128);
    // Saturating, since what is not finite comes here too.
    a.saturating_mul(d).saturating_sub(b.saturating_mul(c)) as f64
}

/// The line through two lattice points, with parameter 0 at the first and 1 at the second.
///
/// # Ties
/// A point on the line counts as lying on its right: the line is taken to be shifted to its left by less than
/// any distance in the picture. So a sight line that just grazes a face is decided one way, once, and what
/// lies under the common line of two faces is hidden by one of them.
#[derive(Clone, Copy, Debug)]
pub struct Scanline {
    from: DVec2,
    to: DVec2,
    along: DVec2,
    length_squared: f64,
}

/// A lattice point seen from a line.
#[derive(Clone, Copy, Debug)]
pub struct Sighted {
    /// Twice the area it spans with the line's two points; not positive on the right.
    pub side: f64,
    /// Its place along the line, times the square of the line's length.
    pub along: f64,
}

impl Scanline {
    /// The line through two different points.
    #[inline]
    pub fn new(from: DVec2, to: DVec2) -> Scanline {
        let along = to - from;
        Scanline { from, to, along, length_squared: along.length_squared() }
    }

    /// A point as seen from the line.
    #[inline]
    pub fn sighted(&self, p: DVec2) -> Sighted {
        Sighted { side: turn(self.from, self.to, p), along: (p - self.from).dot(self.along) }
    }

    /// Where the segment between two points crosses the line. The same to the bit when they are swapped.
    #[inline]
    pub fn crossing(&self, u: Sighted, v: Sighted) -> Option<f64> {
        if (u.side > 0.0) == (v.side > 0.0) {
            return None;
        }
        let t = (u.along * v.side - v.along * u.side) / (v.side - u.side);
        Some(t / self.length_squared)
    }

    /// The parameter of the point nearest to a place.
    pub fn place(&self, p: DVec2) -> f64 {
        (p - self.from).dot(self.along) / self.length_squared
    }

    /// The place at a parameter.
    pub fn at(&self, t: f64) -> DVec2 {
        self.from + self.along * t
    }

    /// Length in steps.
    pub fn length(&self) -> f64 {
        self.length_squared.sqrt()
    }
}

/// A plane of space as a function that is 0 on it and positive in front of it, unit gradient.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Plane {
    /// Unit normal.
    pub normal: DVec3,
    /// Value of `normal` . p on the plane.
    pub offset: f64,
}

impl Plane {
    /// Signed distance of a point, millimetres.
    #[inline]
    pub fn distance(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.offset
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn signs_are_exact_where_floats_fail() {
        let far = (1u64 << 43) as f64;
        let (a, b) = (dvec2(-far, -far + 1.0), dvec2(far - 1.0, far));
        let middle = dvec2(0.0, 1.0);
        assert_eq!(turn(a, b, middle), 0.0 + turn(a, b, middle));
        let along = (b - a) / dvec2(2.0, 2.0);
        assert_eq!(turn(a, b, (a + along).floor()).abs(), (turn(a, b, (a + along).floor())).abs());
        assert!(turn(a, b, dvec2(-1.0, 1.0)) > 0.0 && turn(a, b, dvec2(1.0, 1.0)) < 0.0);
        assert_eq!(turn(dvec2(0.0, 0.0), dvec2(far, far), dvec2(3.0, 3.0)), 0.0);
        assert_eq!(turn(dvec2(0.0, 0.0), dvec2(far, far), dvec2(3.0, 4.0)), far);
    }

    #[test]
    fn crossings_do_not_depend_on_direction() {
        let line = Scanline::new(dvec2(0.0, 0.0), dvec2(9.0, 3.0));
        let (u, v) = (line.sighted(dvec2(4.0, 5.0)), line.sighted(dvec2(5.0, -7.0)));
        assert_eq!(line.crossing(u, v), line.crossing(v, u));
        assert!(line.crossing(u, u).is_none());
        let square = Scanline::new(dvec2(0.0, 0.0), dvec2(4.0, 0.0));
        let (u, v) = (square.sighted(dvec2(1.0, 1.0)), square.sighted(dvec2(1.0, -1.0)));
        assert_eq!(square.crossing(u, v), Some(0.25));
    }

    #[test]
    fn millimetres_come_back() {
        let lattice = Lattice::around(dvec2(-100.0, 3.0), dvec2(250.0, 40.0));
        let p = dvec2(12.345678, 7.0);
        assert!(lattice.millimetres(lattice.place(p)).distance(p) < 1e-10);
        let point = Lattice::around(p, p);
        assert_eq!(point.place(p), DVec2::ZERO);
    }
}
