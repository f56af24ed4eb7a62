//! Numbers as text: the shortest digits that read back as the same `f64`.

use std::fmt::{Display, Formatter, Result};

/// From here on a number is written with an exponent.
const LARGE: f64 = 1e16;
/// Below this a number is written with an exponent.
const SMALL: f64 = 1e-6;
/// Below this the faster way writes an exponent.
const PLAIN: f64 = 1e-5;

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

impl Shortest {
    /// Adds the text to a file.
    pub fn push_to(self, text: &mut Vec<u8>) {
        match digits(&mut zmij::Buffer::new(), self.0 + 0.0) {
            Some(digits) => text.extend(digits.as_bytes()),
            None => text.extend(self.to_string().as_bytes()),
        }
    }
}

impl Display for Shortest {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let x = self.0 + 0.0;
        match digits(&mut zmij::Buffer::new(), x) {
            Some(digits) => f.write_str(digits),
            None if (SMALL..LARGE).contains(&x.abs()) => write!(f, "{x}"),
            None => write!(f, "{x:e}"),
        }
    }
}

/// The shortest digits of a number that the faster of two ways writes without an exponent.
fn digits(buffer: &mut zmij::Buffer, x: f64) -> Option<&str> {
    (x == 0.0 || (PLAIN..LARGE).contains(&x.abs())).then(|| {
        let text = buffer.format_finite(x);
        text.strip_suffix(".0").unwrap_or(text)
    })
}

/// Adds the digits of a number to a file.
pub fn push_count(mut number: usize, text: &mut Vec<u8>) {
    let mut digits = [0; 20];
    let mut start = digits.len();
    loop {
        start -= 1;
        digits[start] = b'0' + (number % 10) as u8;
        number /= 10;
        if number == 0 {
            return text.extend(&digits[start..]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the standard library writes it. Of two shortest texts that are as near, it takes the greater.
    fn plain(x: f64) -> String {
        let size = x.abs();
        if x == 0.0 || (SMALL..1e16).contains(&size) { format!("{x}") } else { format!("{x:e}") }
    }

    #[test]
    fn digits_are_as_few_as_those_of_the_standard_library() {
        let mut state = 1u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            state >> 11
        };
        let ends =
            [0.0, 1e-5, 1e-6, 9.999_999e-6, 1e15, 1e16, 9_007_199_254_740_993.0, 0.1, 5e-324];
        let whole = (0..1000).map(f64::from);
        let spread =
            (0..20_000).map(|_| f64::from_bits(random() << 11 | 1)).filter(|x| x.is_finite());
        let near = (0..20_000).map(|i| (i as f64 - 1e4) / 7.0 * 10f64.powi(i % 22 - 14));
        for x in ends.into_iter().chain(whole).chain(spread).chain(near) {
            let text = Shortest(x).to_string();
            assert_eq!((text.len(), text.parse()), (plain(x).len(), Ok(x)));
            let mut bytes = vec![];
            Shortest(x).push_to(&mut bytes);
            assert_eq!(bytes, text.into_bytes());
        }
    }

    #[test]
    fn counts_are_written_in_full() {
        for number in [0, 7, 10, 1_234_567_890, usize::MAX] {
            let mut text = vec![];
            push_count(number, &mut text);
            assert_eq!(text, number.to_string().into_bytes());
        }
    }

    #[test]
    fn every_number_reads_back_to_the_bit() {
        let numbers = [1.0 / 3.0, 1e-300, 1e300, 123456789.125, -2.5e-7, f64::MIN_POSITIVE, 1e16];
        for x in numbers {
            let back: f64 = Shortest(x).to_string().parse().expect("a number");
            assert_eq!(back.to_bits(), x.to_bits(), "{x}");
        }
    }
}
