//! The zeros of functions that are not distances: formulas and charges, by bounds of values and derivatives.

use std::sync::Arc;

use glam::DVec3;

use super::contour::{Level, Look};
use crate::geom::{
    Bounds, Formula,
    formula::{Interval, Jet},
};

/// What rounding may add to bounds, relative to them.
const ROUNDING: f64 = 1e-12;

/// A function of space with bounds over boxes.
pub trait Smooth: Send + Sync + Sized {
    /// Its value, not positive inside; NaN where it has none.
    fn value(&self, p: DVec3) -> f64;

    /// Its derivatives.
    fn gradient(&self, p: DVec3) -> DVec3 {
        DVec3::from(self.over(&Bounds { min: p, max: p }).slope.map(Interval::middle))
    }

    /// What values and derivatives lie between over a box.
    fn over(&self, cell: &Bounds) -> Jet;

    /// A function that gives the same answers for the points of a cell, sooner; `None` for itself.
    fn within(&self, _cell: &Bounds) -> Option<Self> {
        None
    }

    /// What derivatives lie between over a box, apart for functions that it is made of by pieces.
    fn slopes(&self, cell: &Bounds) -> Vec<[Interval; 3]> {
        vec![self.over(cell).slope]
    }
}

impl Smooth for Formula {
    fn value(&self, p: DVec3) -> f64 {
        Formula::value(self, p)
    }

    fn over(&self, cell: &Bounds) -> Jet {
        Formula::over(self, cell)
    }

    fn within(&self, cell: &Bounds) -> Option<Self> {
        Formula::within(self, cell)
    }

    fn slopes(&self, cell: &Bounds) -> Vec<[Interval; 3]> {
        Formula::slopes(self, cell)
    }
}

/// The zeros of a function with bounds. How far a point is from them is told by value and slope there.
#[derive(Debug)]
pub struct Zeros<S>(Arc<S>);

impl<S> Zeros<S> {
    /// The zeros of a function.
    pub fn new(function: S) -> Zeros<S> {
        Zeros(Arc::new(function))
    }
}

impl<S> Clone for Zeros<S> {
    fn clone(&self) -> Self {
        Zeros(self.0.clone())
    }
}

impl<S: Smooth> Level for Zeros<S> {
    fn value(&self, p: DVec3) -> f64 {
        self.0.value(p)
    }

    fn gradient(&self, p: DVec3) -> DVec3 {
        self.0.gradient(p)
    }

    fn look(&self, cell: &Bounds) -> Look {
        let over = self.0.over(cell);
        if sign(over.value) != 0.0 || self.is_clear(cell, &over) {
            return Look::Clear;
        }
        let slopes = self.0.slopes(cell);
        let middle = |slope: &[Interval; 3]| DVec3::from(slope.map(Interval::middle));
        let main = slopes.iter().map(|s| middle(s).normalize_or_zero()).sum::<DVec3>();
        let grows = |slope: &[Interval; 3]| {
            let along = (0..3).map(|i| slope[i] * Interval::point(main[i]));
            along.fold(Interval::ZERO, |sum, part| sum + part).low > 0.0
        };
        if main.is_finite() && slopes.iter().all(grows) { Look::Sheet } else { Look::Unknown }
    }

    fn within(&self, cell: &Bounds) -> Self {
        self.0.within(cell).map_or_else(|| self.clone(), Zeros::new)
    }
}

impl<S: Smooth> Zeros<S> {
    /// Whether derivatives tell that there is no zero.
    fn is_clear(&self, cell: &Bounds, over: &Jet) -> bool {
        // By the mean value theorem from the middle.
        let half = (cell.max - cell.min) / 2.0;
        let change = (0..3).map(|i| over.slope[i] * Interval::new(-half[i], half[i]));
        let middle = Interval::point(self.0.value(cell.center()));
        if sign(change.fold(middle, |sum, part| sum + part)) != 0.0 {
            return true;
        }
        // Where the function grows along an axis, it is least on one face and largest on the other.
        let ends = |least: bool| {
            let mut part = *cell;
            for i in 0..3 {
                let (rises, falls) = (over.slope[i].low > 0.0, over.slope[i].high < 0.0);
                if rises || falls {
                    let at = if rises == least { cell.min[i] } else { cell.max[i] };
                    (part.min[i], part.max[i]) = (at, at);
                }
            }
            if part == *cell { over.value } else { self.0.over(&part).value }
        };
        sign(ends(true)) > 0.0 || sign(ends(false)) < 0.0
    }
}

/// The sign of all numbers of an interval; 0 if they may differ or be 0.
fn sign(v: Interval) -> f64 {
    let slack = ROUNDING * v.size().min(f64::MAX);
    match v {
        Interval { low, .. } if low > slack.min(low.abs() / 2.0) => 1.0,
        Interval { high, .. } if high < -slack.min(high.abs() / 2.0) => -1.0,
        _ => 0.0,
    }
}
