//! `golden` and `snapshot`: comparison with a file, in tests.

use std::sync::Arc;

use super::{Args, Native};
use crate::{
    base::{Code, Diagnostic, FileError},
    eval::{
        evaluator::Evaluator,
        failure::{Outcome, fail},
        stack::deep,
        testing::Write,
        value::{Value, number_text},
    },
    shape::{Kind, Measures, Node, ShapeId},
};

pub const TABLE: &[(&str, Native)] =
    &[("reference.golden", golden), ("reference.snapshot", snapshot)];

/// The file, and whether references are to be written.
fn reference(evaluator: &Evaluator, args: &Args) -> Outcome<(Arc<str>, bool)> {
    let Some(running) = &evaluator.test else {
        return fail(Code::BadCall, args.call, "references are compared in tests only");
    };
    let path = evaluator.relative(args.caller.unit, args.text(0)?, args.span(0))?;
    Ok((path, running.update))
}

fn write(evaluator: &mut Evaluator, write: Write) -> Outcome<Value> {
    if let Some(running) = &mut evaluator.test {
        running.writes.push(write);
    }
    Ok(Value::NONE)
}

fn missing<T>(args: &Args, path: &str, error: &FileError) -> Outcome<T> {
    let message = format!("cannot read the reference `{path}`: {error}");
    let error = Diagnostic::error(Code::UnreadableFile, message).label(args.span(0), "");
    Err(error.help("`katachi test --update` writes it").into())
}

fn golden(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (path, update) = reference(evaluator, args)?;
    let shape = args.shape(1)?;
    let (volume, distance) = (args.not_negative(2)?, args.not_negative(3)?);
    match (evaluator.host.read(&path), update) {
        (Ok(_), false) => compare(evaluator, args, path, shape, volume, distance),
        (Ok(_), true) => match compare(evaluator, args, path.clone(), shape, volume, distance) {
            Ok(same) => Ok(same),
            Err(_) => write(evaluator, Write::Mesh { path, shape }),
        },
        (Err(FileError::NotFound), true) => write(evaluator, Write::Mesh { path, shape }),
        (Err(error), _) => missing(args, &path, &error),
    }
}

/// Compares a solid with a mesh file: volumes relative to the larger, boundaries by the Hausdorff
/// distance.
fn compare(
    evaluator: &mut Evaluator,
    args: &Args,
    file: Arc<str>,
    shape: ShapeId,
    volume: f64,
    distance: f64,
) -> Outcome<Value> {
    let reference =
        evaluator.add_node(Node::ImportSolid { file: file.clone(), heal: None }, args.span(0));
    let found = evaluator.ask(args.span(1), |host, graph| host.measures(graph, shape))?.volume;
    let needed = evaluator.ask(args.span(0), |host, graph| host.measures(graph, reference))?.volume;
    let off = (found - needed).abs() / found.abs().max(needed.abs()).max(f64::MIN_POSITIVE);
    if off > volume {
        let message = format!(
            "the volume differs from {file} by {} of it; allowed is {}",
            number_text(off),
            number_text(volume)
        );
        let error = Diagnostic::error(Code::TestFailed, message).label(args.span(1), "");
        return Err(error
            .note(format!("volume here: {}mm^3", number_text(found)))
            .note(format!("volume there: {}mm^3", number_text(needed)))
            .into());
    }
    let apart =
        evaluator.ask(args.span(1), |host, graph| host.hausdorff(graph, shape, reference))?;
    if apart > distance {
        let message = format!(
            "the surface is {}mm away from {file} at most; allowed is {}mm",
            number_text(apart),
            number_text(distance)
        );
        return args.fail(1, Code::TestFailed, message);
    }
    Ok(Value::NONE)
}

fn snapshot(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (path, update) = reference(evaluator, args)?;
    let text = describe(evaluator, args, args.value(1))?;
    let known = match evaluator.host.read(&path) {
        Ok(bytes) => String::from_utf8_lossy(&bytes).replace("\r\n", "\n"),
        Err(FileError::NotFound) if update => String::new(),
        Err(error) => return missing(args, &path, &error),
    };
    if known == text {
        return Ok(Value::NONE);
    }
    if update {
        return write(evaluator, Write::Text { path, text });
    }
    let mut error = Diagnostic::error(Code::TestFailed, format!("this differs from {path}"))
        .label(args.span(1), "");
    for (number, pair) in lines(&known, &text).into_iter().enumerate() {
        if pair.0 != pair.1 {
            error = error.note(format!("line {}: was {:?}, is {:?}", number + 1, pair.0, pair.1));
        }
        /// Differing lines that are shown.
        const SHOWN: usize = 8;
        if error.notes.len() == SHOWN {
            break;
        }
    }
    Err(error.help("`katachi test --update` accepts the change").into())
}

fn lines<'a>(a: &'a str, b: &'a str) -> Vec<(&'a str, &'a str)> {
    let (a, b): (Vec<&str>, Vec<&str>) = (a.lines().collect(), b.lines().collect());
    let line = |lines: &[&'a str], i: usize| lines.get(i).copied().unwrap_or("");
    (0..a.len().max(b.len())).map(|i| (line(&a, i), line(&b, i))).collect()
}

/// What a person can check: measures of a shape, a list or record line by line.
fn describe(evaluator: &mut Evaluator, args: &Args, value: &Value) -> Outcome<String> {
    evaluator.tick(1, args.call)?;
    match value {
        Value::Solid(id) | Value::Profile(id) => describe_shape(evaluator, args, *id),
        Value::List(list) if !list.is_empty() => {
            let mut text = String::new();
            for item in list.iter() {
                text.push_str(&deep(|| describe(evaluator, args, item))?);
            }
            Ok(text)
        }
        Value::Record(record) => {
            let mut text = String::new();
            for (key, value) in record.fields() {
                let inner = deep(|| describe(evaluator, args, value))?;
                match inner.lines().count() {
                    0 | 1 => text.push_str(&format!("{key} = {inner}")),
                    _ => text.push_str(&format!("{key}:\n{inner}")),
                }
            }
            Ok(text)
        }
        value => Ok(format!("{value}\n")),
    }
}

fn describe_shape(evaluator: &mut Evaluator, args: &Args, id: ShapeId) -> Outcome<String> {
    let measures = evaluator.ask(args.span(1), |host, graph| host.measures(graph, id))?;
    Ok(match evaluator.graph().kind(id) {
        Kind::Solid => format!(
            "solid\nvolume {}mm^3\narea {}mm^2\n{}\neuler {}\ngenus {}\nshells {}\n",
            rounded(measures.volume),
            rounded(measures.area),
            bounds(&measures),
            measures.euler,
            measures.genus(),
            measures.shells
        ),
        Kind::Profile => format!(
            "profile\narea {}mm^2\nlength {}mm\n{}\n",
            rounded(measures.area),
            rounded(measures.length),
            bounds(&measures)
        ),
    })
}

fn bounds(measures: &Measures) -> String {
    match measures.bounds {
        None => "empty".into(),
        Some([min, max]) => {
            let point = |p: glam::DVec3| p.to_array().map(rounded).join(", ");
            format!("bbox [{}] to [{}]", point(min), point(max))
        }
    }
}

/// Nine significant digits: what a person compares, steady against the last bits.
fn rounded(value: f64) -> String {
    let digits: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    number_text(digits)
}
