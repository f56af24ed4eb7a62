//! Numbers that lie between two others.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// All numbers from one to another; either may be infinite. What rounding adds is not counted: users leave slack.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Interval {
    /// The smallest.
    pub low: f64,
    /// The largest.
    pub high: f64,
}

impl Interval {
    /// All numbers: nothing is known.
    pub const ALL: Interval = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };
    /// Zero alone.
    pub const ZERO: Interval = Interval { low: 0.0, high: 0.0 };

    /// From one number to another; all numbers where either is NaN.
    pub fn new(low: f64, high: f64) -> Interval {
        if low.is_nan() || high.is_nan() { Interval::ALL } else { Interval { low, high } }
    }

    /// One number alone.
    pub fn point(x: f64) -> Interval {
        Interval::new(x, x)
    }

    /// The smallest interval around both.
    pub fn hull(self, other: Interval) -> Interval {
        Interval { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Whether a number is in it.
    pub fn contains(self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// Whether it is one number alone.
    pub fn is_point(self) -> bool {
        self.low == self.high
    }

    /// A number in its middle; NaN where it is not bounded.
    pub fn middle(self) -> f64 {
        if self.is_point() { self.low } else { self.low / 2.0 + self.high / 2.0 }
    }

    /// The largest absolute value.
    pub fn size(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// The image under a function that grows.
    pub fn rising(self, f: impl Fn(f64) -> f64) -> Interval {
        Interval::new(f(self.low), f(self.high))
    }

    /// The image under a function that falls.
    pub fn falling(self, f: impl Fn(f64) -> f64) -> Interval {
        Interval::new(f(self.high), f(self.low))
    }

    /// The image under |x|.
    pub fn abs(self) -> Interval {
        match self {
            Interval { low, .. } if low >= 0.0 => self,
            Interval { high, .. } if high <= 0.0 => -self,
            _ => Interval::new(0.0, self.size()),
        }
    }

    /// The image under x^2.
    pub fn square(self) -> Interval {
        self.abs().rising(|x| x * x)
    }

    /// The part not below a number; the number alone if there is none.
    pub fn above(self, least: f64) -> Interval {
        Interval { low: self.low.max(least), high: self.high.max(least) }
    }
}

impl Neg for Interval {
    type Output = Interval;
    fn neg(self) -> Interval {
        Interval { low: -self.high, high: -self.low }
    }
}

impl Add for Interval {
    type Output = Interval;
    fn add(self, o: Interval) -> Interval {
        Interval::new(self.low + o.low, self.high + o.high)
    }
}

impl Sub for Interval {
    type Output = Interval;
    fn sub(self, o: Interval) -> Interval {
        self + -o
    }
}

impl Mul for Interval {
    type Output = Interval;
    fn mul(self, o: Interval) -> Interval {
        // An end that is 0 stays 0 beside an infinite one, which stands for large numbers.
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let ends = [
            product(self.low, o.low),
            product(self.low, o.high),
            product(self.high, o.low),
            product(self.high, o.high),
        ];
        let low = ends.iter().copied().fold(f64::INFINITY, f64::min);
        Interval::new(low, ends.iter().copied().fold(f64::NEG_INFINITY, f64::max))
    }
}

impl Div for Interval {
    type Output = Interval;
    fn div(self, o: Interval) -> Interval {
        let inverse = match o {
            Interval { low, high } if low > 0.0 || high < 0.0 => o.falling(|x| 1.0 / x),
            Interval { low: 0.0, high } if high > 0.0 => Interval::new(1.0 / high, f64::INFINITY),
            Interval { low, high: 0.0 } if low < 0.0 => Interval::new(f64::NEG_INFINITY, 1.0 / low),
            _ => return Interval::ALL,
        };
        self * inverse
    }
}
