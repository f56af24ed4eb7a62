//! Values and derivatives over a box.
//!
//! Moore, R. E.: *Interval analysis*, 1966; derivatives by the chain rule, forwards. Where a function may jump
//! within the box nothing is known of its derivatives.

use glam::DVec3;

use super::{super::trig, Binary, Interval, Unary};

/// Degrees to radians.
const RADIANS: f64 = std::f64::consts::PI / 180.0;

/// What a value and its derivatives along x, y and z lie between.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Jet {
    /// The value.
    pub value: Interval,
    /// Its derivatives.
    pub slope: [Interval; 3],
}

impl Jet {
    /// A number.
    pub fn constant(x: f64) -> Jet {
        Jet { value: Interval::point(x), slope: [Interval::ZERO; 3] }
    }

    /// A coordinate.
    pub fn axis(axis: usize, value: Interval) -> Jet {
        let mut slope = [Interval::ZERO; 3];
        slope[axis] = Interval::point(1.0);
        Jet { value, slope }
    }

    /// The same, its value no farther from that in the middle of the box than the derivatives allow (the mean value
    /// theorem): for small boxes that is much closer.
    pub(super) fn around(self, middle: f64, half: DVec3) -> Jet {
        /// What rounding may add, relative to the value.
        const ROUNDING: f64 = 1e-14;
        let spread: f64 = (0..3).map(|i| self.slope[i].size() * half[i]).sum();
        let reach = spread + ROUNDING * (middle.abs() + spread);
        let low = self.value.low.max(middle - reach);
        let high = self.value.high.min(middle + reach);
        let value = if low <= high { Interval { low, high } } else { self.value };
        Jet { value, ..self }
    }

    /// A value whose derivatives are those of an argument times a factor.
    fn chain(&self, value: Interval, factor: Interval) -> Jet {
        Jet { value, slope: self.slope.map(|s| factor * s) }
    }

    /// A value that jumps, unless it is one number alone.
    fn jumping(value: Interval) -> Jet {
        let slope = if value.is_point() { Interval::ZERO } else { Interval::ALL };
        Jet { value, slope: [slope; 3] }
    }

    fn joined(&self, value: Interval, other: &Jet) -> Jet {
        Jet { value, slope: [0, 1, 2].map(|i| self.slope[i].hull(other.slope[i])) }
    }
}

/// A function of one number.
pub(super) fn unary(op: Unary, x: &Jet) -> Jet {
    let v = x.value;
    let one = Interval::point(1.0);
    let step = |f: fn(f64) -> f64| Jet::jumping(v.rising(f));
    match op {
        Unary::Negate => x.chain(-v, Interval::point(-1.0)),
        Unary::Abs => x.chain(v.abs(), v.rising(|x| super::unary(Unary::Sign, x))),
        Unary::Sqrt => {
            let root = v.above(0.0).rising(f64::sqrt);
            x.chain(root, Interval::point(0.5) / root)
        }
        Unary::Sin => x.chain(sine(v), sine(v + Interval::point(90.0)) * Interval::point(RADIANS)),
        Unary::Cos => {
            let turned = sine(v + Interval::point(90.0));
            x.chain(turned, -sine(v) * Interval::point(RADIANS))
        }
        Unary::Tan => {
            let tangent = tangent(v);
            x.chain(tangent, (one + tangent.square()) * Interval::point(RADIANS))
        }
        Unary::Asin | Unary::Acos => {
            let held = Interval { low: v.low.clamp(-1.0, 1.0), high: v.high.clamp(-1.0, 1.0) };
            let root = (one - held.square()).above(0.0).rising(f64::sqrt);
            let slope = Interval::point(1.0 / RADIANS) / root;
            match op {
                Unary::Asin => x.chain(held.rising(trig::asin_deg), slope),
                _ => x.chain(held.falling(trig::acos_deg), -slope),
            }
        }
        Unary::Atan => {
            let slope = Interval::point(1.0 / RADIANS) / (one + v.square());
            x.chain(v.rising(trig::atan_deg), slope)
        }
        Unary::Exp => {
            let value = v.rising(libm::exp);
            x.chain(value, value)
        }
        Unary::Ln => {
            let held = v.above(0.0);
            x.chain(held.rising(libm::log), one / held)
        }
        Unary::Floor => step(f64::floor),
        Unary::Ceil => step(f64::ceil),
        Unary::Round => step(f64::round),
        Unary::Sign => step(|x| super::unary(Unary::Sign, x)),
    }
}

/// The sine of degrees.
fn sine(v: Interval) -> Interval {
    let wide = v.high - v.low;
    if wide.is_nan() || wide >= 360.0 {
        return Interval::new(-1.0, 1.0);
    }
    let reaches = |peak: f64| {
        let next = peak + 360.0 * ((v.low - peak) / 360.0).ceil();
        next <= v.high
    };
    let [a, b] = [v.low, v.high].map(trig::sin_deg);
    let low = if reaches(270.0) { -1.0 } else { a.min(b) };
    Interval::new(low, if reaches(90.0) { 1.0 } else { a.max(b) })
}

/// The tangent of degrees.
fn tangent(v: Interval) -> Interval {
    let pole = 90.0 + 180.0 * ((v.low - 90.0) / 180.0).ceil();
    if pole <= v.high { Interval::ALL } else { v.rising(trig::tan_deg) }
}

/// A function of two numbers.
pub(super) fn binary(op: Binary, a: &Jet, b: &Jet) -> Jet {
    let (x, y) = (a.value, b.value);
    let each =
        |f: &dyn Fn(Interval, Interval) -> Interval| [0, 1, 2].map(|i| f(a.slope[i], b.slope[i]));
    match op {
        Binary::Add => Jet { value: x + y, slope: each(&|s, t| s + t) },
        Binary::Subtract => Jet { value: x - y, slope: each(&|s, t| s - t) },
        Binary::Multiply if a == b => a.chain(x.square(), x + x),
        Binary::Multiply => Jet { value: x * y, slope: each(&|s, t| s * y + x * t) },
        Binary::Divide => {
            let value = x / y;
            Jet { value, slope: each(&|s, t| (s - value * t) / y) }
        }
        Binary::Remainder | Binary::Modulo => rest(op, a, b),
        Binary::Power => power(a, b),
        Binary::Min if x.high < y.low => *a,
        Binary::Min if y.high < x.low => *b,
        Binary::Min => a.joined(Interval::new(x.low.min(y.low), x.high.min(y.high)), b),
        Binary::Max if x.low > y.high => *a,
        Binary::Max if y.low > x.high => *b,
        Binary::Max => a.joined(Interval::new(x.low.max(y.low), x.high.max(y.high)), b),
        Binary::Atan2 => angle(a, b),
        Binary::Less => truth(x.high < y.low, x.low >= y.high),
        Binary::LessEqual => truth(x.high <= y.low, x.low > y.high),
        Binary::Equal => truth(x.is_point() && x == y, x.high < y.low || y.high < x.low),
    }
}

/// A condition that is true, or false, everywhere, or neither.
fn truth(always: bool, never: bool) -> Jet {
    let value = Interval::new(f64::from(u8::from(always)), f64::from(u8::from(!never)));
    Jet::jumping(value)
}

/// One of two values.
pub(super) fn choose(condition: &Jet, then: &Jet, otherwise: &Jet) -> Jet {
    match condition.value {
        Interval { low: 0.0, high: 0.0 } => *otherwise,
        decided if !decided.contains(0.0) => *then,
        _ => Jet { value: then.value.hull(otherwise.value), slope: [Interval::ALL; 3] },
    }
}

/// What division leaves: smooth while the quotient is one whole number and the divisor is fixed.
fn rest(op: Binary, a: &Jet, b: &Jet) -> Jet {
    let quotient = a.value / b.value;
    let whole = match op {
        Binary::Remainder => quotient.rising(f64::trunc),
        _ => quotient.rising(f64::floor),
    };
    if b.value.is_point() && whole.is_point() && whole.low.is_finite() {
        let value = a.value - b.value * whole;
        return Jet { value, slope: a.slope };
    }
    let most = b.value.size();
    Jet { value: Interval::new(-most, most), slope: [Interval::ALL; 3] }
}

/// a^b.
fn power(a: &Jet, b: &Jet) -> Jet {
    let (x, n) = (a.value, b.value);
    if !n.is_point() && x.low < 0.0 {
        // Negative numbers have whole powers only.
        return Jet { value: Interval::ALL, slope: [Interval::ALL; 3] };
    }
    if !n.is_point() {
        let logarithm = unary(Unary::Ln, a);
        return unary(Unary::Exp, &binary(Binary::Multiply, b, &logarithm));
    }
    let slope = Interval::point(n.low) * raised(x, n.low - 1.0);
    a.chain(raised(x, n.low), slope)
}

/// x^n over an interval.
fn raised(x: Interval, n: f64) -> Interval {
    let whole = n.fract() == 0.0;
    match n {
        0.0 => Interval::point(1.0),
        n if n < 0.0 => Interval::point(1.0) / raised(x, -n),
        n if !whole => x.above(0.0).rising(|x| super::power(x, n)),
        n if n % 2.0 == 0.0 => x.abs().rising(|x| super::power(x, n)),
        n => x.rising(|x| super::power(x, n)),
    }
}

/// The angle of a point, degrees; it jumps on the negative x axis.
fn angle(a: &Jet, b: &Jet) -> Jet {
    let (y, x) = (a.value, b.value);
    if x.low <= 0.0 && y.contains(0.0) {
        return Jet { value: Interval::new(-180.0, 180.0), slope: [Interval::ALL; 3] };
    }
    let ends = [(y.low, x.low), (y.low, x.high), (y.high, x.low), (y.high, x.high)];
    let ends = ends.map(|(y, x)| Interval::point(trig::atan2_deg(y, x)));
    let value = ends[1..].iter().fold(ends[0], |all, end| all.hull(*end));
    let square = (x.square() + y.square()) * Interval::point(RADIANS);
    let slope = [0, 1, 2].map(|i| (x * a.slope[i] - y * b.slope[i]) / square);
    Jet { value, slope }
}
