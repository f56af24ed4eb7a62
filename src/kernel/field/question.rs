//! A point as boxes of single numbers see it.

use glam::{DVec3, Vec3};

/// How much nearer than measured a box may be, relative to the sum of the sizes of all coordinates: each of some
/// twenty roundings of single numbers is 2^-24 of them at most.
const SLACK: f64 = 32.0 / (1 << 24) as f64;
/// Squares of coordinates beyond this are no single numbers, mm.
const FAR: f64 = 1e18;

/// A point in the frame of boxes, and what is too far from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Question {
    pub at: Vec3,
    slack: f64,
}

impl Question {
    /// A point, among boxes with coordinates up to `reach`.
    #[inline]
    pub fn new(at: DVec3, reach: f64) -> Question {
        Question { at: at.as_vec3(), slack: SLACK * (at.abs().element_sum() + reach) }
    }

    /// Whether distances from boxes can be told by single numbers.
    #[inline]
    pub fn is_near(&self) -> bool {
        self.slack < SLACK * FAR
    }

    /// The square of the distance beyond which a box holds nothing nearer than the square root of `best`.
    #[inline]
    pub fn cut(&self, best: f64) -> f32 {
        if best < 0.0 {
            return -1.0; // nothing is so near
        }
        self.cut_at(best.sqrt())
    }

    /// The same for a distance.
    #[inline]
    pub fn cut_at(&self, apart: f64) -> f32 {
        let far = apart + self.slack;
        // A trifle more than what rounding to a single number and squaring may take away.
        (far * far) as f32 * (1.0 + 4.0 * f32::EPSILON) + f32::MIN_POSITIVE
    }
}
