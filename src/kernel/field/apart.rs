//! The surface at a distance from a mesh.
//!
//! Bounds over a cell are tight ([`Near`]), and exact where the nearest triangle's plane is nearest.

use glam::DVec3;

use super::{
    Nearest, Polyhedral,
    contour::{Level, Look},
    half_diagonal,
    near::{Near, ROUNDING},
};
use crate::geom::Bounds;

/// The points at a signed distance `by` from a mesh, as the zeros of a function: distance less `by`.
#[derive(Clone, Debug)]
pub struct Apart<'a> {
    whole: &'a Polyhedral,
    by: f64,
    /// What can be nearest to the points of the cell; none for the whole.
    near: Option<Near>,
}

impl<'a> Apart<'a> {
    /// The points at `by` mm from a mesh, inside for a negative distance.
    pub fn new(whole: &'a Polyhedral, by: f64) -> Apart<'a> {
        Apart { whole, by, near: None }
    }

    /// The signed distance of a point of the cell from the mesh.
    pub(super) fn distance(&self, p: DVec3) -> f64 {
        self.foot(p).distance
    }

    /// The point of the boundary nearest to a point of the cell.
    fn foot(&self, p: DVec3) -> Nearest {
        match &self.near {
            Some(near) => near.nearest(self.whole, p),
            None => self.whole.nearest(p),
        }
    }
}

impl Level for Apart<'_> {
    fn value(&self, p: DVec3) -> f64 {
        self.foot(p).distance - self.by
    }

    fn gradient(&self, p: DVec3) -> DVec3 {
        let foot = self.foot(p);
        (p - foot.point) / foot.distance
    }

    fn off(&self, p: DVec3) -> f64 {
        self.value(p).abs()
    }

    fn look(&self, cell: &Bounds) -> Look {
        let (middle, half) = (cell.center(), (cell.max - cell.min) / 2.0);
        let (reach, radius) = (half_diagonal(cell), self.by.abs());
        let slack = ROUNDING * (radius + middle.abs().max_element() + reach);
        let side = self.value(middle) + self.by;
        if side * self.by.signum() < -reach - slack {
            return Look::Clear; // on the side of the boundary where the surface is not
        }
        let Some(candidates) = &self.near else {
            let clear = (side - self.by).abs() > reach + slack;
            return if clear { Look::Clear } else { Look::Unknown };
        };
        let near = || candidates.list.iter().filter(|c| c.lower(half) <= radius + slack);
        if near().next().is_none() || candidates.upper(self.whole, cell) < radius - slack {
            return Look::Clear;
        }
        let main = near().map(|c| c.towards).sum::<DVec3>().normalize_or_zero();
        let along = near().all(|c| c.away * c.towards.dot(main) > reach);
        if along { Look::Sheet } else { Look::Unknown }
    }

    fn within(&self, cell: &Bounds) -> Self {
        let near = self.near.as_ref().map(|near| near.within(self.whole, cell));
        Apart { near: near.or_else(|| Near::new(self.whole, cell)), ..*self }
    }
}
