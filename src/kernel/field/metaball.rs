//! Metaballs: where the potentials of charges together reach a threshold.
//!
//! Tatehara, S., Tanaka, N., Tatsumi, S., Tokumasu, S.: *Object-oriented expression for complex 3-D shapes*:
//! in where F(P) = sum f_i(|N_i P|) - c is not negative.

use glam::DVec3;

use super::smooth::Smooth;
use crate::geom::{
    Bounds, Charge,
    formula::{Interval, Jet},
};

/// Charges and a threshold. As a function it is the threshold less the potential.
#[derive(Clone, PartialEq, Debug)]
pub struct Metaball {
    charges: Vec<Charge>,
    threshold: f64,
}

impl Metaball {
    /// What charges of any sign bound at a threshold, which must be above 0.
    ///
    /// ```
    /// use glam::DVec3;
    /// use katachi::geom::{Charge, Falloff};
    /// use katachi::kernel::field::{Metaball, smooth::Smooth};
    /// let one = Charge { at: DVec3::ZERO, q: 1.0, falloff: Falloff::Inverse };
    /// let ball = Metaball::new(vec![one], 0.5);
    /// assert_eq!(ball.value(DVec3::X * 2.0), 0.0);
    /// assert_eq!(ball.gradient(DVec3::X * 2.0), DVec3::X * 0.25);
    /// ```
    pub fn new(charges: Vec<Charge>, threshold: f64) -> Metaball {
        Metaball { charges, threshold }
    }

    /// A box that holds it, with room; `None` if no charge is positive.
    pub fn extent(&self) -> Option<Bounds> {
        let drawing = || self.charges.iter().filter(|c| c.q > 0.0);
        let around = Bounds::of(drawing().map(|c| c.at));
        let potential = |r: f64| drawing().map(|c| c.q * c.falloff.at(r * r)[0]).sum::<f64>();
        // Every potential falls: by halves until the threshold, then to within a hundredth.
        let (mut low, mut high) = (0.0, 1.0);
        while potential(high) >= self.threshold && high < f64::MAX / 4.0 {
            (low, high) = (high, high * 2.0);
        }
        while low == 0.0 && high > f64::MIN_POSITIVE && potential(high / 2.0) < self.threshold {
            high /= 2.0;
        }
        /// Halvings of what is between.
        const STEPS: usize = 8;
        for _ in 0..STEPS {
            let middle = (low + high) / 2.0;
            let beyond = potential(middle) < self.threshold;
            (low, high) = if beyond { (low, middle) } else { (middle, high) };
        }
        /// Room around the farthest points.
        const ROOM: f64 = 1.05;
        (!around.is_empty()).then(|| around.grown(high * ROOM))
    }
}

impl Smooth for Metaball {
    fn value(&self, p: DVec3) -> f64 {
        let potential = |c: &Charge| c.q * c.falloff.at(p.distance_squared(c.at))[0];
        self.threshold - self.charges.iter().map(potential).sum::<f64>()
    }

    fn gradient(&self, p: DVec3) -> DVec3 {
        let slope =
            |c: &Charge| (p - c.at) * (2.0 * c.q * c.falloff.at(p.distance_squared(c.at))[1]);
        -self.charges.iter().map(slope).sum::<DVec3>()
    }

    fn over(&self, cell: &Bounds) -> Jet {
        let mut jet = Jet::constant(self.threshold);
        for c in &self.charges {
            let away =
                [0, 1, 2].map(|i| Interval::new(cell.min[i] - c.at[i], cell.max[i] - c.at[i]));
            let square = away.iter().fold(Interval::ZERO, |sum, x| sum + x.square());
            let q = Interval::point(c.q);
            let value = q * square.falling(|s| c.falloff.at(s)[0]);
            let factor = Interval::point(2.0) * q * square.rising(|s| c.falloff.at(s)[1]);
            jet.value = jet.value - value;
            jet.slope = [0, 1, 2].map(|i| jet.slope[i] - factor * away[i]);
        }
        jet
    }
}
