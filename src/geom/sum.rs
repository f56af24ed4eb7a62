//! Sums whose error does not grow with their length.

/// A running sum of floats in the order given, with the rounding errors carried along (Neumaier 1974).
///
/// ```
/// use katachi::geom::sum::Sum;
/// let mut sum = Sum::default();
/// [1e100, 1.0, -1e100].map(|x| sum.add(x));
/// assert_eq!(sum.value(), 1.0);
/// ```
#[derive(Clone, Copy, Default, Debug)]
pub struct Sum {
    total: f64,
    lost: f64,
}

impl Sum {
    /// Adds a number.
    pub fn add(&mut self, x: f64) {
        let total = self.total + x;
        self.lost += if self.total.abs() >= x.abs() {
            (self.total - total) + x
        } else {
            (x - total) + self.total
        };
        self.total = total;
    }

    /// The sum so far.
    pub fn value(&self) -> f64 {
        self.total + self.lost
    }
}

impl FromIterator<f64> for Sum {
    fn from_iter<I: IntoIterator<Item = f64>>(numbers: I) -> Sum {
        let mut sum = Sum::default();
        numbers.into_iter().for_each(|x| sum.add(x));
        sum
    }
}
