//! Numbers and their units: `1.5in`, `100mm^2`, `2e-3`.

use super::ast::{Unit, UnitName};

/// The units by name, in the order messages list them.
pub const UNITS: &[(&str, UnitName)] = &[
    ("um", UnitName::Um),
    ("mm", UnitName::Mm),
    ("cm", UnitName::Cm),
    ("m", UnitName::M),
    ("in", UnitName::In),
    ("ft", UnitName::Ft),
    ("deg", UnitName::Deg),
    ("rad", UnitName::Rad),
    ("turn", UnitName::Turn),
];

/// `value * factor` as if the decimals of both were multiplied before the one rounding: 1.5 inches are
/// 38.1 mm, where the product of the two binary numbers is 38.099999999999994.
///
/// ```
/// assert_eq!(katachi::syntax::number::scaled(1.5, 25.4), 38.1);
/// ```
pub fn scaled(value: f64, factor: f64) -> f64 {
    if factor == 1.0 {
        return value;
    }
    let exact = |number: f64| {
        let text = format!("{number:e}");
        let (digits, exponent) = text.split_once('e')?;
        let fraction = digits.split_once('.').map_or(0, |(_, fraction)| fraction.len());
        let whole: i128 = digits.replace('.', "").parse().ok()?;
        Some((whole, exponent.parse::<i32>().ok()? - i32::try_from(fraction).ok()?))
    };
    let product = || {
        let ((a, p), (b, q)) = (exact(value)?, exact(factor)?);
        format!("{}e{}", a.checked_mul(b)?, p + q).parse().ok()
    };
    product().unwrap_or(value * factor)
}

/// What is wrong with a number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum NumberFault {
    /// The letters behind the digits are no unit.
    UnknownUnit,
    /// The exponent of the unit does not lie in -9..=9.
    LargeExponent,
    /// The exponent of the unit has a fraction.
    BrokenExponent,
    /// The value is larger than a 64-bit float.
    TooLarge,
}

/// A number cut into its parts; all are ranges of bytes from its first digit.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct NumberParts {
    /// Where the digits end.
    pub digits: usize,
    /// Where the letters of the unit end; equal to `digits` without a unit.
    pub unit: usize,
    /// Where the whole number ends.
    pub end: usize,
}

/// Cuts the number at the start of `text`, which begins with a digit.
pub fn measure(text: &str) -> NumberParts {
    let bytes = text.as_bytes();
    let digits = digits_end(bytes);
    let unit = digits + word_length(&text[digits..]);
    let end = if unit > digits { exponent_end(bytes, unit) } else { unit };
    NumberParts { digits, unit, end }
}

fn digits_end(bytes: &[u8]) -> usize {
    let mut end = skip_digits(bytes, 0);
    if bytes.get(end) == Some(&b'.') && is_digit(bytes, end + 1) {
        end = skip_digits(bytes, end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        if is_digit(bytes, end + 1 + sign) {
            end = skip_digits(bytes, end + 1 + sign);
        }
    }
    end
}

/// Behind a unit, `^` with digits belongs to the number.
fn exponent_end(bytes: &[u8], unit: usize) -> usize {
    let minus = usize::from(bytes.get(unit + 1) == Some(&b'-'));
    if bytes.get(unit) != Some(&b'^') || !is_digit(bytes, unit + 1 + minus) {
        return unit;
    }
    let end = skip_digits(bytes, unit + 1 + minus);
    if bytes.get(end) == Some(&b'.') && is_digit(bytes, end + 1) {
        return skip_digits(bytes, end + 1);
    }
    end
}

fn is_digit(bytes: &[u8], at: usize) -> bool {
    bytes.get(at).is_some_and(u8::is_ascii_digit)
}

fn skip_digits(bytes: &[u8], from: usize) -> usize {
    from + bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count()
}

fn word_length(text: &str) -> usize {
    let is_letter = |c: char| c.is_alphanumeric() || c == '_' || c == '°' || c == 'µ';
    text.find(|c| !is_letter(c)).unwrap_or(text.len())
}

/// What is wrong with a number that [`measure`] has cut, if anything: what [`read`] would say, but
/// without taking the trouble to read digits that are in range by their number alone.
pub fn check(text: &str, parts: NumberParts) -> Result<(), NumberFault> {
    /// So many digits without an exponent are less than 1e300.
    const SAFE: usize = 300;
    let digits = &text.as_bytes()[..parts.digits];
    let plain = digits.len() <= SAFE && !digits.iter().any(|byte| matches!(byte, b'e' | b'E'));
    if !plain {
        return read(&text[..parts.end]).map(|_| ());
    }
    unit(text, parts).map(|_| ())
}

/// The value and unit of a number that [`measure`] has cut.
pub fn read(text: &str) -> Result<(f64, Option<Unit>), NumberFault> {
    let parts = measure(text);
    let value: f64 = text[..parts.digits].parse().map_err(|_| NumberFault::TooLarge)?;
    if !value.is_finite() {
        return Err(NumberFault::TooLarge);
    }
    Ok((value, unit(text, parts)?))
}

fn unit(text: &str, parts: NumberParts) -> Result<Option<Unit>, NumberFault> {
    let word = &text[parts.digits..parts.unit];
    if word.is_empty() {
        return Ok(None);
    }
    let found = UNITS.iter().find(|(name, _)| *name == word);
    let (_, name) = *found.ok_or(NumberFault::UnknownUnit)?;
    let exponent = exponent(&text[parts.unit..parts.end])?;
    Ok(Some(Unit { name, exponent }))
}

fn exponent(text: &str) -> Result<i8, NumberFault> {
    let Some(digits) = text.strip_prefix('^') else { return Ok(1) };
    if digits.contains('.') {
        return Err(NumberFault::BrokenExponent);
    }
    let value = digits.parse::<i8>().ok();
    value.filter(|n| (-9..=9).contains(n)).ok_or(NumberFault::LargeExponent)
}

/// The unit that `word` was probably meant to be.
pub fn nearest_unit(word: &str) -> Option<&'static str> {
    const HABITS: &[(&str, &str)] = &[
        ("inch", "in"),
        ("inches", "in"),
        ("foot", "ft"),
        ("feet", "ft"),
        ("degree", "deg"),
        ("degrees", "deg"),
        ("°", "deg"),
        ("radians", "rad"),
        ("turns", "turn"),
        ("rev", "turn"),
        ("millimeter", "mm"),
        ("millimetre", "mm"),
        ("micron", "um"),
        ("µm", "um"),
        ("μm", "um"),
        ("meter", "m"),
        ("metre", "m"),
    ];
    let lower = word.to_lowercase();
    let habit = HABITS.iter().find(|(name, _)| *name == lower).map(|(_, unit)| *unit);
    habit.or_else(|| UNITS.iter().map(|(name, _)| *name).find(|name| *name == lower))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(text: &str) -> (f64, Option<(UnitName, i8)>) {
        let (value, unit) = read(text).unwrap();
        (value, unit.map(|u| (u.name, u.exponent)))
    }

    #[test]
    fn numbers_end_where_they_should() {
        for (text, end) in [
            ("0..5", 1),
            ("1.5in+2", 5),
            ("5.add()", 1),
            ("1e3mm", 5),
            ("1e-3", 4),
            ("2E+2)", 4),
            ("100mm^2", 7),
            ("10mm^-2*3", 7),
            ("10mm^n", 4),
            ("10mm^(2)", 4),
            ("10^2", 2),
            ("5kg", 3),
            ("3.x", 1),
            ("40mm..60mm", 4),
        ] {
            assert_eq!(measure(text).end, end, "{text}");
        }
    }

    #[test]
    fn units_are_multiplied_in_decimals() {
        for (value, factor, product) in [
            (1.5, 25.4, 38.1),
            (0.07, 1000.0, 70.0),
            (1.1, 10.0, 11.0),
            (0.3, 360.0, 108.0),
            (2.5, 25.4 * 25.4, 1612.9),
            (7.0, 0.001, 0.007),
            (0.0, 25.4, 0.0),
            (1e308, 1e3, f64::INFINITY),
            (1e-300, 0.001, 1e-303),
        ] {
            assert_eq!(scaled(value, factor), product, "{value} * {factor}");
        }
        assert!(scaled(2.0, f64::NAN).is_nan());
    }

    #[test]
    fn values_and_units() {
        assert_eq!(unit("1.5in"), (1.5, Some((UnitName::In, 1))));
        assert_eq!(unit("100mm^2"), (100.0, Some((UnitName::Mm, 2))));
        assert_eq!(unit("10mm^-2"), (10.0, Some((UnitName::Mm, -2))));
        assert_eq!(unit("2e3"), (2000.0, None));
        assert_eq!(read("5kg"), Err(NumberFault::UnknownUnit));
        assert_eq!(read("5mm^2.5"), Err(NumberFault::BrokenExponent));
        assert_eq!(read("5mm^99"), Err(NumberFault::LargeExponent));
        assert_eq!(read("1e999"), Err(NumberFault::TooLarge));
        assert_eq!(nearest_unit("inch"), Some("in"));
        assert_eq!(nearest_unit("MM"), Some("mm"));
    }
}
