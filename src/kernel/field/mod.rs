//! Distance fields: solids that know how far every point is from their boundary.
//!
//! Tatehara, S., Tanaka, N., Tatsumi, S., Tokumasu, S.: *Object-oriented expression for complex 3-D shapes*
//! (distance-field objects).
//!
//! | paper | here | meaning |
//! |---|---|---|
//! | in or out, distance | [`Field::distance`] | one number: negative inside |
//! | nearest point of the boundary | [`Field::closest`] | a point at that distance |
//! | G grown by r | [`Grown`] | distance less r |
//! | complement | [`Complement`] | distance with the other sign |
//!
//! Growing a solid by r takes every point whose distance is at most r, and so needs true distances outside
//! of it; shrinking needs them inside. A least distance of several solids is a true one outside of their
//! union only, a greatest one inside of their intersection only. [`Exact`] tells the two sides apart, and
//! [`Grown`] refuses what it has no true distances for: then the set operation is evaluated first and
//! distance is measured to its boundary ([`Polyhedral`]).
//!
//! # Departures
//! The paper grows by a bound and asks the hypersphere where it does not decide. Here distances that feed an
//! offset are true ones; [`Hypersphere`] is there to be asked for, and covers a hole of the paper's test.

mod algebra;
mod apart;
mod block;
pub mod contour;
mod hypersphere;
mod lanes;
mod lathe;
mod local;
mod metaball;
mod near;
mod oriented;
mod outline;
mod pieces;
mod polyhedral;
mod prism;
mod question;
mod round;
pub mod smooth;
mod tree;
mod triangle;

use glam::DVec3;

pub use self::{
    algebra::{Complement, Grown, Intersection, NotExact, Union},
    apart::Apart,
    block::Cuboid,
    hypersphere::{Hypersphere, Test},
    lathe::Lathe,
    local::Local,
    metaball::Metaball,
    outline::Prism,
    polyhedral::{Nearest, Polyhedral},
    round::{Ball, Ring},
    smooth::Zeros,
    triangle::Feature,
};
use crate::geom::Bounds;

/// Where a field gives true distances; elsewhere what it gives is at most the true one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Exact {
    /// Outside of the solid: it may be grown.
    pub outside: bool,
    /// Inside of the solid: it may be shrunk.
    pub inside: bool,
}

impl Exact {
    /// True distances everywhere.
    pub const BOTH: Exact = Exact { outside: true, inside: true };
}

/// A solid by the distance to its boundary, millimetres.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::kernel::field::{Cuboid, Field};
/// let cube = Cuboid::new(DVec3::ZERO, DVec3::splat(2.0));
/// assert_eq!(cube.distance(dvec3(5.0, 6.0, 1.0)), 5.0);
/// assert_eq!(cube.distance(dvec3(0.5, 1.0, 1.0)), -0.5);
/// assert_eq!(cube.closest(dvec3(0.5, 1.0, 1.0)), dvec3(0.0, 1.0, 1.0));
/// ```
pub trait Field: Sync {
    /// The distance to the boundary, negative inside. It changes no faster than the point moves.
    fn distance(&self, p: DVec3) -> f64;

    /// A point of the boundary at that distance, where the field is [exact](Field::exact).
    fn closest(&self, p: DVec3) -> DVec3;

    /// A box that holds the solid; empty for the empty solid.
    fn extent(&self) -> Bounds;

    /// Where its distances are true.
    fn exact(&self) -> Exact {
        Exact::BOTH
    }

    /// The least and the largest distance of the points of a cell, or less and more than they.
    fn bound(&self, cell: &Bounds) -> [f64; 2] {
        let (middle, reach) = (self.distance(cell.center()), half_diagonal(cell));
        [middle - reach, middle + reach]
    }

    /// A field that gives the same answers for the points of a cell, sooner.
    fn localize<'a>(&'a self, cell: &Bounds) -> Box<dyn Field + 'a>;
}

/// The distance from the middle of a cell to its corners.
pub fn half_diagonal(cell: &Bounds) -> f64 {
    (cell.max - cell.min).length() / 2.0
}

/// A field that is no simpler in a cell: answers are passed on.
struct Same<'a, F: ?Sized>(&'a F);

impl<F: Field + ?Sized> Field for Same<'_, F> {
    fn distance(&self, p: DVec3) -> f64 {
        self.0.distance(p)
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        self.0.closest(p)
    }

    fn extent(&self) -> Bounds {
        self.0.extent()
    }

    fn exact(&self) -> Exact {
        self.0.exact()
    }

    fn localize<'a>(&'a self, cell: &Bounds) -> Box<dyn Field + 'a> {
        self.0.localize(cell)
    }
}

#[cfg(test)]
mod tests;
