//! Signed integers of a fixed number of 64-bit words, on the stack.
//!
//! Exact predicates need a few hundred bits and nothing else: sums, products, a sign. The callers
//! state the bit budget; nothing is checked here at run time, and results that need more than
//! `64 N - 1` bits wrap.

use std::ops::{Add, Mul, Neg, Sub};

/// A signed integer of `64 N` bits, two's complement, least word first.
///
/// ```
/// use katachi::geom::wide::Wide;
/// let big = Wide::<4>::from(i128::MAX) * Wide::from(-3);
/// assert_eq!(big.sign(), -1);
/// assert_eq!((big + Wide::from(i128::MAX) + Wide::from(i128::MAX) + Wide::from(i128::MAX)).sign(), 0);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Wide<const N: usize>([u64; N]);

impl<const N: usize> Wide<N> {
    /// Zero.
    pub const ZERO: Wide<N> = Wide([0; N]);

    /// The same number with another count of words; the value must fit.
    pub fn resize<const M: usize>(self) -> Wide<M> {
        let fill = if self.is_negative() { u64::MAX } else { 0 };
        Wide(std::array::from_fn(|i| if i < N { self.0[i] } else { fill }))
    }

    fn is_negative(self) -> bool {
        (self.0[N - 1] as i64) < 0
    }

    /// -1, 0 or 1.
    pub fn sign(self) -> i32 {
        if self.is_negative() { -1 } else { i32::from(self.0.iter().any(|&word| word != 0)) }
    }

    /// The nearest double but for a relative error of 2^-51.
    pub fn to_f64(self) -> f64 {
        const WORD: f64 = 18_446_744_073_709_551_616.0;
        let size = if self.is_negative() { -self } else { self };
        let top = (0..N).rev().find(|&i| size.0[i] != 0).unwrap_or(0);
        let low = if top > 0 { size.0[top - 1] as f64 } else { 0.0 };
        let mut value = size.0[top] as f64;
        if top > 0 {
            value = value * WORD + low;
        }
        for _ in 1..top {
            value *= WORD;
        }
        if self.is_negative() { -value } else { value }
    }
}

impl<const N: usize> From<i128> for Wide<N> {
    fn from(value: i128) -> Wide<N> {
        let fill = if value < 0 { u64::MAX } else { 0 };
        Wide(std::array::from_fn(|i| match i {
            0 => value as u64,
            1 => (value >> 64) as u64,
            _ => fill,
        }))
    }
}

impl<const N: usize> Add for Wide<N> {
    type Output = Wide<N>;

    fn add(self, other: Wide<N>) -> Wide<N> {
        let mut carry = false;
        Wide(std::array::from_fn(|i| {
            let (sum, first) = self.0[i].overflowing_add(other.0[i]);
            let (sum, second) = sum.overflowing_add(u64::from(carry));
            carry = first || second;
            sum
        }))
    }
}

impl<const N: usize> Neg for Wide<N> {
    type Output = Wide<N>;

    fn neg(self) -> Wide<N> {
        let mut carry = true;
        Wide(std::array::from_fn(|i| {
            let (word, over) = (!self.0[i]).overflowing_add(u64::from(carry));
            carry = over;
            word
        }))
    }
}

impl<const N: usize> Sub for Wide<N> {
    type Output = Wide<N>;

    fn sub(self, other: Wide<N>) -> Wide<N> {
        self + -other
    }
}

impl<const N: usize> Mul for Wide<N> {
    type Output = Wide<N>;

    fn mul(self, other: Wide<N>) -> Wide<N> {
        let mut product = [0u64; N];
        for i in 0..N {
            let mut carry = 0u128;
            for j in 0..N - i {
                let sum = u128::from(self.0[i]) * u128::from(other.0[j])
                    + u128::from(product[i + j])
                    + carry;
                product[i + j] = sum as u64;
                carry = sum >> 64;
            }
        }
        Wide(product)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu::integer::IBig;

    /// A generator of test numbers (SplitMix64).
    fn next(state: &mut u64) -> u64 {
        *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = *state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn sample(state: &mut u64) -> i128 {
        let bits = next(state) % 127;
        let raw = (i128::from(next(state)) << 64 | i128::from(next(state))) >> 1;
        raw >> (126 - bits.min(126))
    }

    fn sign_of(value: &IBig) -> i32 {
        match value.cmp(&IBig::ZERO) {
            std::cmp::Ordering::Less => -1,
            std::cmp::Ordering::Equal => 0,
            std::cmp::Ordering::Greater => 1,
        }
    }

    #[test]
    fn sums_and_products_agree_with_big_integers() {
        let mut state = 7;
        for _ in 0..2000 {
            let v: [i128; 4] = std::array::from_fn(|_| sample(&mut state));
            let [a, b, c, d] = v.map(Wide::<5>::from);
            let [p, q, r, s] = v.map(IBig::from);
            let (wide, big) = (a * b - c * d, p * q - r * s);
            assert_eq!(wide.sign(), sign_of(&big));
            let expected = big.to_f64().value();
            assert!((wide.to_f64() - expected).abs() <= expected.abs() * 1e-15);
            assert_eq!(wide.resize::<7>().resize::<5>(), wide);
        }
    }
}
