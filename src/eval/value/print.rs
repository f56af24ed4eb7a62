//! How values are written out.

use std::fmt::{self, Write};

use super::{Range, Value};

/// Elements of lists and records that are printed before the text is cut short: a list that holds
/// itself many times over would print without end.
const SHOWN: usize = 1000;
/// Levels of nesting that are printed.
const DEPTH: usize = 16;

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
            value => Printer { f, left: SHOWN }.value(value, DEPTH),
        }
    }
}

impl Value {
    /// As it is written in the language: a string in quotes.
    pub fn literal(&self) -> impl fmt::Display + '_ {
        Literal(self)
    }
}

struct Literal<'a>(&'a Value);

impl fmt::Display for Literal<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Printer { f, left: SHOWN }.value(self.0, DEPTH)
    }
}

struct Printer<'a, 'b> {
    f: &'a mut fmt::Formatter<'b>,
    /// Elements that may still be printed.
    left: usize,
}

impl Printer<'_, '_> {
    fn value(&mut self, value: &Value, depth: usize) -> fmt::Result {
        match value {
            Value::Symbol(symbol) => write!(self.f, "{symbol}"),
            Value::Bool(value) => write!(self.f, "{value}"),
            Value::Number(value, dimension) => {
                write!(self.f, "{}{dimension}", number_text(*value))
            }
            Value::Text(text) => self.quoted(text),
            Value::List(_) | Value::Record(_) if depth == 0 => self.f.write_str("..."),
            Value::List(list) => {
                let items = list.iter().map(|item| (None, item));
                self.elements("[", items, "]", depth)
            }
            Value::Record(record) => {
                let fields = record.fields().iter().map(|(key, value)| (Some(&**key), value));
                self.elements("{ ", fields, " }", depth)
            }
            Value::Range(range) => self.range(range),
            Value::Function(function) => match function.name() {
                Some(name) => write!(self.f, "<function {name}>"),
                None => self.f.write_str("<function>"),
            },
            Value::Solid(_) => self.f.write_str("<solid>"),
            Value::Profile(_) => self.f.write_str("<profile>"),
            Value::Curve(_) => self.f.write_str("<curve>"),
            Value::Surface(_) => self.f.write_str("<surface>"),
            Value::Field(_) => self.f.write_str("<field>"),
            Value::Traced(_) => self.f.write_str("<formula>"),
            Value::Drawing(_) => self.f.write_str("<drawing>"),
            Value::Picture(_) => self.f.write_str("<picture>"),
            Value::Page(_) => self.f.write_str("<page>"),
            Value::Module(_) => self.f.write_str("<module>"),
        }
    }

    fn elements<'v>(
        &mut self,
        open: &str,
        items: impl Iterator<Item = (Option<&'v str>, &'v Value)>,
        close: &str,
        depth: usize,
    ) -> fmt::Result {
        self.f.write_str(open)?;
        for (i, (key, item)) in items.enumerate() {
            if i > 0 {
                self.f.write_str(", ")?;
            }
            let Some(left) = self.left.checked_sub(1) else {
                self.f.write_str("...")?;
                break;
            };
            self.left = left;
            if let Some(key) = key {
                write!(self.f, "{key} = ")?;
            }
            self.value(item, depth - 1)?;
        }
        self.f.write_str(close)
    }

    fn range(&mut self, range: &Range) -> fmt::Result {
        let dots = if range.inclusive { ".." } else { "..<" };
        let (unit, end) = (range.dimension, number_text(range.end));
        write!(self.f, "{}{unit}{dots}{end}{unit}", number_text(range.start))?;
        match range.explicit {
            true => write!(self.f, " step {}{unit}", number_text(range.step)),
            false => Ok(()),
        }
    }

    fn quoted(&mut self, text: &str) -> fmt::Result {
        self.f.write_char('"')?;
        for c in text.chars() {
            match c {
                '"' | '\\' => write!(self.f, "\\{c}")?,
                '\n' => self.f.write_str("\\n")?,
                '\t' => self.f.write_str("\\t")?,
                c => self.f.write_char(c)?,
            }
        }
        self.f.write_char('"')
    }
}
