//! Arithmetic progressions.

use super::Value;
use crate::eval::dimension::Dimension;

/// How far a quotient may be from a whole number and still count as it, relative to its size: a
/// step such as 0.1 is not exact in binary, and a range of a million steps must still end where
/// it says.
const WHOLE: f64 = 1e-9;

/// `start..end step step`: element i is start + i * step.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Range {
    /// The first element.
    pub start: f64,
    /// The bound.
    pub end: f64,
    /// From one element to the next; not 0.
    pub step: f64,
    /// Whether the bound belongs to it.
    pub inclusive: bool,
    /// Whether `step` was written.
    pub explicit: bool,
    /// The dimension of start, end and step.
    pub dimension: Dimension,
    count: u64,
}

impl Range {
    /// The range; `step` must not be 0 and all numbers finite.
    pub fn new(start: f64, end: f64, step: Option<f64>, unit: f64, inclusive: bool) -> Range {
        let explicit = step.is_some();
        let step = step.unwrap_or(unit);
        let count = count((end - start) / step, inclusive);
        Range { start, end, step, inclusive, explicit, dimension: Dimension::BARE, count }
    }

    /// The same numbers in another dimension.
    pub fn of(self, dimension: Dimension) -> Range {
        Range { dimension, ..self }
    }

    /// How many elements it has.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The element at an index below [`count`](Range::count). The last one of a range that reaches its
    /// bound is the bound itself, not what the steps have drifted to.
    pub fn element(&self, index: u64) -> Value {
        let number = self.start + index as f64 * self.step;
        let last = self.inclusive && index + 1 == self.count;
        let at_end =
            last && (number - self.end).abs() <= WHOLE * self.step.abs() * self.count as f64;
        Value::Number(if at_end { self.end } else { number }, self.dimension)
    }

    /// Whether `x` lies between the bounds, and on a step where one is written.
    pub fn admits(&self, x: f64) -> bool {
        let (low, high) = (self.start.min(self.end), self.start.max(self.end));
        let slack = WHOLE * low.abs().max(high.abs());
        let at_end = x == self.end && !self.inclusive;
        x >= low - slack && x <= high + slack && !at_end && (!self.explicit || self.on_step(x))
    }

    fn on_step(&self, x: f64) -> bool {
        let steps = (x - self.start) / self.step;
        (steps - steps.round()).abs() <= WHOLE * steps.abs().max(1.0)
    }
}

fn count(steps: f64, inclusive: bool) -> u64 {
    if steps.is_nan() || steps < -WHOLE {
        return 0;
    }
    let whole = steps.round();
    let exact = (steps - whole).abs() <= WHOLE * steps.abs().max(1.0);
    match (exact, inclusive) {
        (true, true) => (whole as u64).saturating_add(1),
        (true, false) => whole as u64,
        (false, _) => (steps.floor() as u64).saturating_add(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_do_not_drift() {
        assert_eq!(Range::new(0.0, 0.3, Some(0.1), 1.0, true).count(), 4);
        assert_eq!(Range::new(0.0, 0.3, Some(0.1), 1.0, false).count(), 3);
        assert_eq!(Range::new(0.0, 1e6, Some(0.1), 1.0, true).count(), 10_000_001);
        assert_eq!(Range::new(5.0, 0.0, None, 1.0, true).count(), 0);
        assert_eq!(Range::new(5.0, 0.0, Some(-1.0), 1.0, true).count(), 6);
        assert_eq!(Range::new(0.0, 0.0, None, 1.0, false).count(), 0);
        assert_eq!(Range::new(0.0, 2.5, None, 1.0, true).count(), 3);
        assert_eq!(Range::new(-1e308, 1e308, None, 1.0, true).count(), u64::MAX);
    }

    #[test]
    fn the_last_element_is_the_bound() {
        let last = |end: f64, step: f64| {
            let range = Range::new(0.0, end, Some(step), 1.0, true);
            match range.element(range.count() - 1) {
                Value::Number(number, _) => number,
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(last(0.3, 0.1), 0.3);
        assert_eq!(last(-0.3, -0.1), -0.3);
        assert_eq!(last(1.0, 0.3), 0.3 * 3.0);
    }

    #[test]
    fn a_domain_knows_its_steps() {
        let domain = Range::new(20.0, 120.0, Some(1.0), 1.0, true);
        assert!(domain.admits(120.0) && domain.admits(60.0));
        assert!(!domain.admits(60.5) && !domain.admits(19.0) && !domain.admits(121.0));
    }
}
