//! Functions on strings.

use super::{Args, Native};
use crate::{
    base::Code,
    eval::{
        evaluator::Evaluator,
        failure::Outcome,
        value::{Value, meter},
    },
};

pub const TABLE: &[(&str, Native)] = &[
    ("string.len", |_, a| Ok(Value::bare(a.text(0)?.chars().count() as f64))),
    ("string.join", join),
    ("string.split", split),
    ("string.upper", |_, a| Ok(Value::text(a.text(0)?.to_uppercase()))),
    ("string.lower", |_, a| Ok(Value::text(a.text(0)?.to_lowercase()))),
    ("string.contains", |_, a| Ok(Value::Bool(a.text(0)?.contains(a.text(1)?)))),
    ("string.replace", replace),
    ("string.trim", |_, a| Ok(Value::text(a.text(0)?.trim()))),
    ("string.number", number),
    ("string.string", |_, a| Ok(Value::text(a.value(0).to_string()))),
    ("string.reverse", |_, a| Ok(Value::text(a.text(0)?.chars().rev().collect::<String>()))),
];

fn join(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    use std::fmt::Write;
    let (items, separator) = (evaluator.items(args.value(0), args.span(0))?, args.text(1)?);
    let mut text = String::new();
    for (i, item) in items.iter().enumerate() {
        if i > 0 {
            text.push_str(separator);
        }
        let _ = write!(text, "{item}");
        evaluator.room(text.len() / meter::BYTES_A_VALUE, args.call)?;
    }
    Ok(Value::text(text))
}

/// Between separators; into characters when the separator is empty.
fn split(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (text, separator) = (args.text(0)?, args.text(1)?);
    evaluator.room(text.len(), args.call)?;
    let pieces: Vec<Value> = match separator {
        "" => text.chars().map(|c| Value::text(c.to_string())).collect(),
        separator => text.split(separator).map(Value::text).collect(),
    };
    Ok(Value::list(pieces))
}

fn replace(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (text, old, new) = (args.text(0)?, args.text(1)?, args.text(2)?);
    if old.is_empty() {
        return args.fail(1, Code::OutOfRange, "the text to replace is empty");
    }
    let found = text.matches(old).count();
    evaluator.room((text.len() + found * new.len()) / meter::BYTES_A_VALUE, args.call)?;
    Ok(Value::text(text.replace(old, new)))
}

/// The number that a string holds.
fn number(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let text = args.text(0)?.trim();
    let plain = text.chars().all(|c| c.is_ascii_digit() || "+-.eE".contains(c));
    match text.parse::<f64>() {
        Ok(value) if plain && value.is_finite() => Ok(Value::bare(value)),
        _ => args.fail(0, Code::OutOfRange, format!("{text:?} is not a number")),
    }
}
