//! How values are written out.

use std::fmt::{self, Write};

use super::Value;

/// Elements of a list or record that are printed before it is cut short.
const SHOWN: usize = 64;
/// Levels of nesting that are printed.
const DEPTH: usize = 8;

/// A float in its shortest form that reads back as the same number; exponent form outside
/// 1e-7..1e17.
///
/// ```
/// use katachi::eval::value::number_text;
/// assert_eq!(number_text(0.1), "0.1");
/// assert_eq!(number_text(-0.0), "0");
/// assert_eq!(number_text(1e20), "1e20");
/// ```
pub fn number_text(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".into()
    } else if (1e-7..1e17).contains(&size) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

impl fmt::Display for Value {
    /// As an interpolation shows it: a string without quotes.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Text(text) => f.write_str(text),
            value => write_value(f, value, DEPTH),
        }
    }
}

fn write_value(f: &mut fmt::Formatter<'_>, value: &Value, depth: usize) -> fmt::Result {
    match value {
        Value::Symbol(symbol) => write!(f, "{symbol}"),
        Value::Bool(value) => write!(f, "{value}"),
        Value::Number(value, dimension) => write!(f, "{}{dimension}", number_text(*value)),
        Value::Text(text) => write_quoted(f, text),
        Value::List(_) | Value::Record(_) if depth == 0 => f.write_str("..."),
        Value::List(list) => write_list(f, list, depth),
        Value::Record(record) => write_record(f, record.fields(), depth),
        Value::Range(range) => {
            let dots = if range.inclusive { ".." } else { "..<" };
            let (unit, end) = (range.dimension, number_text(range.end));
            write!(f, "{}{unit}{dots}{end}{unit}", number_text(range.start))?;
            match range.explicit {
                true => write!(f, " step {}{unit}", number_text(range.step)),
                false => Ok(()),
            }
        }
        Value::Function(function) => match function.name() {
            Some(name) => write!(f, "<function {name}>"),
            None => f.write_str("<function>"),
        },
        Value::Solid(_) => f.write_str("<solid>"),
        Value::Profile(_) => f.write_str("<profile>"),
        Value::Module(_) => f.write_str("<module>"),
    }
}

fn write_quoted(f: &mut fmt::Formatter<'_>, text: &str) -> fmt::Result {
    f.write_char('"')?;
    for c in text.chars() {
        match c {
            '"' | '\\' => write!(f, "\\{c}")?,
            '\n' => f.write_str("\\n")?,
            '\t' => f.write_str("\\t")?,
            c => f.write_char(c)?,
        }
    }
    f.write_char('"')
}

fn write_list(f: &mut fmt::Formatter<'_>, list: &[Value], depth: usize) -> fmt::Result {
    f.write_char('[')?;
    for (i, item) in list.iter().take(SHOWN).enumerate() {
        if i > 0 {
            f.write_str(", ")?;
        }
        write_value(f, item, depth - 1)?;
    }
    f.write_str(if list.len() > SHOWN { ", ...]" } else { "]" })
}

fn write_record(
    f: &mut fmt::Formatter<'_>,
    fields: &[(std::sync::Arc<str>, Value)],
    depth: usize,
) -> fmt::Result {
    f.write_str("{ ")?;
    for (i, (key, value)) in fields.iter().take(SHOWN).enumerate() {
        if i > 0 {
            f.write_str(", ")?;
        }
        write!(f, "{key} = ")?;
        write_value(f, value, depth - 1)?;
    }
    f.write_str(if fields.len() > SHOWN { ", ... }" } else { " }" })
}
