//! The one home of small numbers.

use super::Stretch;

/// The chord error the modeller allows, in millimetres: no point of a mesh is farther than this from
/// the true surface. Built once, in `session`, and passed down by value. Exact kernels take none.
#[derive(Clone, Copy, PartialEq, PartialOrd, Debug)]
pub struct Tolerance(f64);

impl Tolerance {
    /// What holds when the model says nothing: 0.05 mm.
    pub const DEFAULT: Tolerance = Tolerance(0.05);

    /// A tolerance of `mm` millimetres; `None` unless finite and positive.
    pub fn new(mm: f64) -> Option<Tolerance> {
        (mm.is_finite() && mm > 0.0).then_some(Tolerance(mm))
    }

    /// Half of it, where two errors add.
    pub fn half(self) -> Tolerance {
        Tolerance((self.0 / 2.0).max(f64::MIN_POSITIVE))
    }

    /// What is allowed before a stretch so that this is kept after it.
    ///
    /// ```
    /// use katachi::geom::{Stretch, Tolerance};
    /// assert_eq!(Tolerance::DEFAULT.before(Stretch::by(10.0)).mm(), 0.005);
    /// ```
    pub fn before(self, stretch: Stretch) -> Tolerance {
        Tolerance((self.0 / stretch.factor()).clamp(f64::MIN_POSITIVE, f64::MAX))
    }

    /// The allowed chord error in millimetres.
    pub const fn mm(self) -> f64 {
        self.0
    }
}

impl Default for Tolerance {
    fn default() -> Tolerance {
        Tolerance::DEFAULT
    }
}
