//! Numbers as text: the shortest digits that read back as the same `f64`.

use std::fmt::{Display, Formatter, Result};

/// From here on a number is written with an exponent.
const LARGE: f64 = 1e16;
/// Below this a number is written with an exponent.
const SMALL: f64 = 1e-6;

/// Prints shortest round-trip, with an exponent where plain digits would be long. Negative zero is
/// printed as 0. Locale, platform and precision settings have no influence.
///
/// ```
/// use katachi::output::number::Shortest;
/// let text = |x| Shortest(x).to_string();
/// assert_eq!([text(0.1 + 0.2), text(-0.0), text(5.0)], ["0.30000000000000004", "0", "5"]);
/// assert_eq!(text(1.5e-9), "1.5e-9");
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Shortest(
    /// The number.
    pub f64,
);

impl Display for Shortest {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let x = self.0 + 0.0;
        let size = x.abs();
        if x == 0.0 || (SMALL..LARGE).contains(&size) {
            write!(f, "{x}")
        } else {
            write!(f, "{x:e}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Shortest;

    #[test]
    fn every_number_reads_back_to_the_bit() {
        let numbers = [1.0 / 3.0, 1e-300, 1e300, 123456789.125, -2.5e-7, f64::MIN_POSITIVE, 1e16];
        for x in numbers {
            let back: f64 = Shortest(x).to_string().parse().expect("a number");
            assert_eq!(back.to_bits(), x.to_bits(), "{x}");
        }
    }
}
