//! The field of a mesh within a cell.

use super::{Field, Nearest, Polyhedral, near::Near};
use crate::geom::Bounds;
use glam::DVec3;

/// The field of a mesh within a cell: only what can be nearest to its points is looked at.
#[derive(Clone, Debug)]
pub struct Local<'a> {
    whole: &'a Polyhedral,
    /// None while candidates are too many to be listed.
    near: Option<Near>,
}

impl<'a> Local<'a> {
    /// The field of a mesh for the points of a cell.
    ///
    /// ```
    /// use glam::{DVec3, dvec3};
    /// use katachi::{geom::Bounds, kernel::{brep::primitive::cuboid, field::{Local, Polyhedral}}};
    /// let cube = Polyhedral::new(cuboid(DVec3::ZERO, DVec3::splat(8.0)).mesh()).unwrap();
    /// let above = Bounds { min: dvec3(1.0, 1.0, 9.0), max: dvec3(5.0, 5.0, 10.0) };
    /// let local = Local::new(&cube, &above);
    /// assert_eq!(local.candidates(), Some(8)); // of 12: the top and sides
    /// assert_eq!(local.nearest(dvec3(2.0, 3.0, 9.5)).distance, 1.5);
    /// ```
    pub fn new(whole: &'a Polyhedral, cell: &Bounds) -> Local<'a> {
        Local { whole, near: Near::new(whole, cell) }
    }

    /// The field for a cell inside of this one's.
    pub fn within(&self, cell: &Bounds) -> Local<'a> {
        let near = self.near.as_ref().map(|near| near.within(self.whole, cell));
        Local { whole: self.whole, near: near.or_else(|| Near::new(self.whole, cell)) }
    }

    /// The nearest point of the boundary and what it lies on, for a point of the cell.
    pub fn nearest(&self, p: DVec3) -> Nearest {
        match &self.near {
            Some(near) => near.nearest(self.whole, p),
            None => self.whole.nearest(p),
        }
    }

    /// The number of triangles that it looks at; `None` if these are too many to be listed.
    pub fn candidates(&self) -> Option<usize> {
        self.near.as_ref().map(|near| near.list.len())
    }
}

impl Field for Local<'_> {
    fn distance(&self, p: DVec3) -> f64 {
        self.nearest(p).distance
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        self.nearest(p).point
    }

    fn extent(&self) -> Bounds {
        self.whole.extent()
    }

    fn localize<'a>(&'a self, cell: &Bounds) -> Box<dyn Field + 'a> {
        Box::new(self.within(cell))
    }
}
