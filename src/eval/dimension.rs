//! Dimensions of numbers: powers of length (millimetres) and of angle (degrees).

use std::fmt;

use crate::syntax::{
    ast::{Unit, UnitName},
    number,
};

/// How far an exponent may be from a whole number and still count as it: 1/3 is not exact in binary.
const WHOLE: f64 = 1e-12;

/// length^i · angle^j. A bare number has both exponents 0.
///
/// ```
/// use katachi::eval::Dimension;
/// assert_eq!(Dimension::LENGTH.times(Dimension::LENGTH), Some(Dimension::AREA));
/// assert_eq!(Dimension::AREA.to_string(), "mm^2");
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Dimension {
    /// Exponent of length.
    pub length: i8,
    /// Exponent of angle.
    pub angle: i8,
}

impl Dimension {
    /// A bare number.
    pub const BARE: Dimension = Dimension::new(0, 0);
    /// Millimetres.
    pub const LENGTH: Dimension = Dimension::new(1, 0);
    /// Degrees.
    pub const ANGLE: Dimension = Dimension::new(0, 1);
    /// Square millimetres.
    pub const AREA: Dimension = Dimension::new(2, 0);
    /// Cubic millimetres.
    pub const VOLUME: Dimension = Dimension::new(3, 0);

    /// length^`length` · angle^`angle`.
    pub const fn new(length: i8, angle: i8) -> Dimension {
        Dimension { length, angle }
    }

    /// Of a product; `None` when an exponent leaves the range -128..127.
    pub fn times(self, other: Dimension) -> Option<Dimension> {
        let length = self.length.checked_add(other.length)?;
        Some(Dimension { length, angle: self.angle.checked_add(other.angle)? })
    }

    /// Of a quotient.
    pub fn over(self, other: Dimension) -> Option<Dimension> {
        let length = self.length.checked_sub(other.length)?;
        Some(Dimension { length, angle: self.angle.checked_sub(other.angle)? })
    }

    /// Of a whole power.
    pub fn power(self, exponent: i32) -> Option<Dimension> {
        let raise = |e: i8| i8::try_from(i32::from(e).checked_mul(exponent)?).ok();
        Some(Dimension { length: raise(self.length)?, angle: raise(self.angle)? })
    }

    /// Of a power with a fraction; `None` when that leaves an exponent that is not whole.
    pub fn broken_power(self, exponent: f64) -> Option<Dimension> {
        let raise = |e: i8| {
            let product = f64::from(e) * exponent;
            let whole = product.round();
            let fits = (product - whole).abs() <= WHOLE && whole.abs() <= f64::from(i8::MAX);
            fits.then_some(whole as i8)
        };
        Some(Dimension { length: raise(self.length)?, angle: raise(self.angle)? })
    }

    /// Of a square root; `None` when an exponent is odd.
    pub fn root(self) -> Option<Dimension> {
        let even = self.length % 2 == 0 && self.angle % 2 == 0;
        even.then(|| Dimension::new(self.length / 2, self.angle / 2))
    }

    /// The dimension in which two numbers can be added or compared: their own when it is the same,
    /// and that of a length or angle beside a bare number.
    pub fn common(self, other: Dimension) -> Option<Dimension> {
        match (self, other) {
            (a, b) if a == b => Some(a),
            (Dimension::BARE, b @ (Dimension::LENGTH | Dimension::ANGLE)) => Some(b),
            (a @ (Dimension::LENGTH | Dimension::ANGLE), Dimension::BARE) => Some(a),
            _ => None,
        }
    }

    /// In plain words with an article: `a length`, `1/length`.
    pub fn words(self) -> String {
        match (self.length, self.angle) {
            (0, 0) => "a bare number".into(),
            (1, 0) => "a length".into(),
            (2, 0) => "an area".into(),
            (3, 0) => "a volume".into(),
            (0, 1) => "an angle".into(),
            (l, a) => fraction(l, a),
        }
    }
}

fn fraction(length: i8, angle: i8) -> String {
    let side = |sign: i8| {
        let power = |name: &str, exponent: i8| match exponent * sign {
            e if e <= 0 => None,
            1 => Some(name.to_string()),
            e => Some(format!("{name}^{e}")),
        };
        let words = [power("length", length.max(-127)), power("angle", angle.max(-127))];
        words.into_iter().flatten().collect::<Vec<_>>().join("*")
    };
    match (side(1), side(-1)) {
        (over, under) if under.is_empty() => over,
        (over, under) if over.is_empty() => format!("1/{under}"),
        (over, under) => format!("{over}/{under}"),
    }
}

impl fmt::Display for Dimension {
    /// The unit behind a number: `mm`, `mm^2`, `mm*deg^-1`; nothing for a bare number.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut first = true;
        for (unit, exponent) in [("mm", self.length), ("deg", self.angle)] {
            if exponent == 0 {
                continue;
            }
            if !first {
                f.write_str("*")?;
            }
            first = false;
            f.write_str(unit)?;
            if exponent != 1 {
                write!(f, "^{exponent}")?;
            }
        }
        Ok(())
    }
}

/// What one of a unit is in millimetres or degrees, and which dimension it has.
pub fn unit_factor(unit: UnitName) -> (f64, Dimension) {
    if let Some(millimetres) = unit.millimetres() {
        return (millimetres, Dimension::LENGTH);
    }
    let degrees = match unit {
        UnitName::Rad => 180.0 / std::f64::consts::PI,
        UnitName::Turn => 360.0,
        _ => 1.0,
    };
    (degrees, Dimension::ANGLE)
}

/// A written number in millimetres and degrees, scaled in decimals; `None` when the exponent of its
/// unit is too large.
pub fn literal(value: f64, unit: Option<&Unit>) -> Option<(f64, Dimension)> {
    let Some(unit) = unit else { return Some((value, Dimension::BARE)) };
    let (factor, dimension) = unit_factor(unit.name);
    let exponent = i32::from(unit.exponent);
    let number = match exponent {
        ..0 => value / libm::pow(factor, f64::from(-exponent)),
        _ => (0..exponent).fold(value, |value, _| number::scaled(value, factor)),
    };
    Some((number, dimension.power(exponent)?))
}

/// A text that is one number, such as `-1.5in`; `None` for anything else.
pub fn quantity(text: &str) -> Option<(f64, Dimension)> {
    let digits = text.strip_prefix('-').unwrap_or(text);
    let whole = digits.starts_with(|c: char| c.is_ascii_digit())
        && number::measure(digits).end == digits.len();
    let (value, unit) = number::read(whole.then_some(digits)?).ok()?;
    let (number, dimension) = literal(value, unit.as_ref())?;
    let sign = if digits.len() < text.len() { -1.0 } else { 1.0 };
    number.is_finite().then_some((sign * number, dimension))
}

/// A unit as it is written.
pub fn unit_text(unit: UnitName) -> &'static str {
    match unit {
        UnitName::Um => "um",
        UnitName::Mm => "mm",
        UnitName::Cm => "cm",
        UnitName::M => "m",
        UnitName::In => "in",
        UnitName::Ft => "ft",
        UnitName::Deg => "deg",
        UnitName::Rad => "rad",
        UnitName::Turn => "turn",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_may_be_a_quantity() {
        assert_eq!(quantity("-1.5in"), Some((-38.1, Dimension::LENGTH)));
        assert_eq!(quantity("100mm^2"), Some((100.0, Dimension::AREA)));
        assert_eq!(quantity("2"), Some((2.0, Dimension::BARE)));
        for bad in ["", "-", "a", "5 mm", "5kg", "mm", "1..2", "5mm "] {
            assert_eq!(quantity(bad), None, "{bad}");
        }
    }

    #[test]
    fn powers_with_a_fraction_need_whole_exponents() {
        assert_eq!(Dimension::AREA.broken_power(0.5), Some(Dimension::LENGTH));
        assert_eq!(Dimension::VOLUME.broken_power(1.0 / 3.0), Some(Dimension::LENGTH));
        assert_eq!(Dimension::VOLUME.broken_power(0.5), None);
        assert_eq!(Dimension::BARE.broken_power(1e300), Some(Dimension::BARE));
    }
}
