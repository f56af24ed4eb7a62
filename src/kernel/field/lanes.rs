//! Eight single numbers side by side, measured at once.

use std::ops::{Add, Mul, Sub};

use glam::Vec4;

/// Numbers in a group.
pub(super) const LANES: usize = 8;

/// Eight bytes, in words of four.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Bytes([u32; 2]);

impl Bytes {
    pub fn set(&mut self, lane: usize, byte: u8) {
        let (word, place) = (&mut self.0[lane / 4], lane % 4 * 8);
        *word = *word & !(0xff << place) | u32::from(byte) << place;
    }
}

/// Eight single numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lanes([Vec4; 2]);

impl Lanes {
    pub const ZERO: Lanes = Lanes::all(0.0);

    /// The same number eight times.
    #[inline]
    pub const fn all(number: f32) -> Lanes {
        Lanes([Vec4::splat(number); 2])
    }

    pub fn set(&mut self, lane: usize, number: f32) {
        self.0[lane / 4][lane % 4] = number;
    }

    /// The numbers of eight bytes.
    #[inline(always)]
    pub fn of(bytes: &Bytes) -> Lanes {
        let word = |k: usize| Vec4::from_array(bytes.0[k].to_le_bytes().map(f32::from));
        Lanes([word(0), word(1)])
    }

    #[inline]
    pub fn abs(self) -> Lanes {
        Lanes(self.0.map(Vec4::abs))
    }

    #[inline]
    pub fn max(self, other: Lanes) -> Lanes {
        Lanes([self.0[0].max(other.0[0]), self.0[1].max(other.0[1])])
    }

    /// The lanes, one bit each, whose numbers are less than this.
    #[inline]
    pub fn below(&self, limit: f32) -> u32 {
        let bits = self.0.map(|half| half.cmplt(Vec4::splat(limit)).bitmask());
        bits[0] | bits[1] << 4
    }

    /// The lane with the least number, the first of them.
    #[inline]
    pub fn least(&self) -> u32 {
        let least = self.0[0].min(self.0[1]).min_element();
        let bits = self.0.map(|half| half.cmple(Vec4::splat(least)).bitmask());
        (bits[0] | bits[1] << 4).trailing_zeros() % LANES as u32
    }
}

impl Add for Lanes {
    type Output = Lanes;
    #[inline]
    fn add(self, other: Lanes) -> Lanes {
        Lanes([self.0[0] + other.0[0], self.0[1] + other.0[1]])
    }
}

impl Sub for Lanes {
    type Output = Lanes;
    #[inline]
    fn sub(self, other: Lanes) -> Lanes {
        Lanes([self.0[0] - other.0[0], self.0[1] - other.0[1]])
    }
}

impl Mul for Lanes {
    type Output = Lanes;
    #[inline]
    fn mul(self, other: Lanes) -> Lanes {
        Lanes([self.0[0] * other.0[0], self.0[1] * other.0[1]])
    }
}
