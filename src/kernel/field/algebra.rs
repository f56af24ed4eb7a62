//! Set operations and offsets of fields, with a record of where their distances are true.

use glam::DVec3;
use thiserror::Error;

use super::{Exact, Field};
use crate::geom::Bounds;

/// An offset was asked of a field that has no true distances where the offset looks.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Error)]
pub enum NotExact {
    /// Growing.
    #[error("growing needs true distances outside of the solid; evaluate its set operation first")]
    Outside,
    /// Shrinking.
    #[error("shrinking needs true distances inside of the solid; evaluate its set operation first")]
    Inside,
}

/// What is in either of two solids. Its distance is true outside only: inside, the boundary of one may lie
/// within the other.
#[derive(Clone, Copy, Debug)]
pub struct Union<A, B>(pub A, pub B);

/// What is in both of two solids. Its distance is true inside only.
#[derive(Clone, Copy, Debug)]
pub struct Intersection<A, B>(pub A, pub B);

/// What is not in a solid.
#[derive(Clone, Copy, Debug)]
pub struct Complement<A>(pub A);

/// A solid grown, or shrunk by a negative amount.
#[derive(Clone, Copy, Debug)]
pub struct Grown<A> {
    of: A,
    by: f64,
}

impl<A: Field> Grown<A> {
    /// The points at most `by` mm from a solid, or for a negative amount those at least so deep inside.
    /// Fails where the field has no true distances on that side.
    ///
    /// ```
    /// use glam::{DVec3, dvec3};
    /// use katachi::kernel::field::{Ball, Cuboid, Field, Grown, NotExact, Union};
    /// let two = Union(Cuboid::new(DVec3::ZERO, DVec3::ONE), Ball::new(DVec3::ZERO, 1.0));
    /// assert_eq!(Grown::new(two, 0.5).unwrap().distance(dvec3(0.0, 0.0, -3.0)), 1.5);
    /// assert_eq!(Grown::new(two, -0.5).unwrap_err(), NotExact::Inside);
    /// ```
    pub fn new(of: A, by: f64) -> Result<Grown<A>, NotExact> {
        match of.exact() {
            Exact { outside: false, .. } if by > 0.0 => Err(NotExact::Outside),
            Exact { inside: false, .. } if by < 0.0 => Err(NotExact::Inside),
            _ => Ok(Grown { of, by }),
        }
    }
}

impl<A: Field, B: Field> Field for Union<A, B> {
    fn distance(&self, p: DVec3) -> f64 {
        self.0.distance(p).min(self.1.distance(p))
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        let nearer = self.0.distance(p) <= self.1.distance(p);
        if nearer { self.0.closest(p) } else { self.1.closest(p) }
    }

    fn extent(&self) -> Bounds {
        self.0.extent().joined(&self.1.extent())
    }

    fn exact(&self) -> Exact {
        Exact { outside: self.0.exact().outside && self.1.exact().outside, inside: false }
    }

    fn localize<'a>(&'a self, cell: &Bounds) -> Box<dyn Field + 'a> {
        let ([a, above_a], [b, above_b]) = (self.0.bound(cell), self.1.bound(cell));
        match () {
            () if above_a < b => self.0.localize(cell),
            () if above_b < a => self.1.localize(cell),
            () => Box::new(Union(self.0.localize(cell), self.1.localize(cell))),
        }
    }
}

impl<A: Field, B: Field> Field for Intersection<A, B> {
    fn distance(&self, p: DVec3) -> f64 {
        self.0.distance(p).max(self.1.distance(p))
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        let first = self.0.distance(p) >= self.1.distance(p);
        if first { self.0.closest(p) } else { self.1.closest(p) }
    }

    fn extent(&self) -> Bounds {
        let (a, b) = (self.0.extent(), self.1.extent());
        Bounds { min: a.min.max(b.min), max: a.max.min(b.max) }
    }

    fn exact(&self) -> Exact {
        Exact { outside: false, inside: self.0.exact().inside && self.1.exact().inside }
    }

    fn localize<'a>(&'a self, cell: &Bounds) -> Box<dyn Field + 'a> {
        let ([a, above_a], [b, above_b]) = (self.0.bound(cell), self.1.bound(cell));
        match () {
            () if a > above_b => self.0.localize(cell),
            () if b > above_a => self.1.localize(cell),
            () => Box::new(Intersection(self.0.localize(cell), self.1.localize(cell))),
        }
    }
}

impl<A: Field> Field for Complement<A> {
    fn distance(&self, p: DVec3) -> f64 {
        -self.0.distance(p)
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        self.0.closest(p)
    }

    fn extent(&self) -> Bounds {
        Bounds { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY }
    }

    fn exact(&self) -> Exact {
        let Exact { outside, inside } = self.0.exact();
        Exact { outside: inside, inside: outside }
    }

    fn localize<'a>(&'a self, cell: &Bounds) -> Box<dyn Field + 'a> {
        Box::new(Complement(self.0.localize(cell)))
    }
}

impl<A: Field> Field for Grown<A> {
    fn distance(&self, p: DVec3) -> f64 {
        self.of.distance(p) - self.by
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        let (foot, d) = (self.of.closest(p), self.of.distance(p));
        if d == 0.0 { p } else { foot + (p - foot) * (self.by / d) }
    }

    fn extent(&self) -> Bounds {
        self.of.extent().grown(self.by)
    }

    /// Grown sets keep their outer distances, shrunk ones their inner ones; on the other side what was the
    /// nearest point may have been covered.
    fn exact(&self) -> Exact {
        let Exact { outside, inside } = self.of.exact();
        Exact { outside: outside && self.by >= 0.0, inside: inside && self.by <= 0.0 }
    }

    fn localize<'a>(&'a self, cell: &Bounds) -> Box<dyn Field + 'a> {
        Box::new(Grown { of: self.of.localize(cell), by: self.by })
    }
}

impl<F: Field + ?Sized> Field for Box<F> {
    fn distance(&self, p: DVec3) -> f64 {
        (**self).distance(p)
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        (**self).closest(p)
    }

    fn extent(&self) -> Bounds {
        (**self).extent()
    }

    fn exact(&self) -> Exact {
        (**self).exact()
    }

    fn bound(&self, cell: &Bounds) -> [f64; 2] {
        (**self).bound(cell)
    }

    fn localize<'a>(&'a self, cell: &Bounds) -> Box<dyn Field + 'a> {
        (**self).localize(cell)
    }
}
