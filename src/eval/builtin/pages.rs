//! Pages: sheets of paper with views on them.

use std::sync::Arc;

use glam::{DVec2, dvec2};

use super::{Args, Native, coordinates, flat};
use crate::{
    base::{Code, Diagnostic},
    eval::{
        evaluator::Evaluator,
        failure::Outcome,
        types::shown,
        value::{Symbol, Value},
    },
    shape::{
        PageSpec,
        drawing::{Place, Placed, Position, Subject, TitleSpec},
    },
};

pub const TABLE: &[(&str, Native)] = &[
    ("page.new", page),
    ("page.place.at", place_at),
    ("page.place.beside", place_beside),
    ("page.title", title),
];

/// Paper sizes of ISO 216, upright, mm.
const SIZES: [(Symbol, [f64; 2]); 5] = [
    (Symbol::A0, [841.0, 1189.0]),
    (Symbol::A1, [594.0, 841.0]),
    (Symbol::A2, [420.0, 594.0]),
    (Symbol::A3, [297.0, 420.0]),
    (Symbol::A4, [210.0, 297.0]),
];

/// `size, landscape, scale, projection, frame`.
fn page(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (mut size, name) = size(args)?;
    if matches!(args.value(1), Value::Bool(true)) {
        size = dvec2(size.max_element(), size.min_element());
    }
    let first_angle = match args.value(3) {
        Value::Symbol(Symbol::FirstAngle) => true,
        Value::Symbol(Symbol::ThirdAngle) => false,
        other => {
            let words = format!("`projection` is FIRST_ANGLE or THIRD_ANGLE, got {}", shown(other));
            return args.fail(3, Code::WrongKind, words);
        }
    };
    let page = PageSpec {
        size,
        name,
        scale: args.positive(2)?,
        first_angle,
        frame: matches!(args.value(4), Value::Bool(true)),
        title: None,
        views: vec![],
        place: Place(evaluator.shown_at(args.call)),
    };
    Ok(Value::Page(Arc::new(page)))
}

fn size(args: &Args) -> Outcome<(DVec2, Option<Arc<str>>)> {
    if let Value::Symbol(symbol) = args.value(0)
        && let Some((symbol, size)) = SIZES.iter().find(|(known, _)| known == symbol)
    {
        return Ok((DVec2::from(*size), Some(symbol.name().into())));
    }
    match (args.value(0), coordinates(args.value(0))) {
        (Value::List(list), Some(size)) if list.len() == 2 && size.x > 0.0 && size.y > 0.0 => {
            Ok((flat(size), None))
        }
        (other, _) => {
            let words = format!("a page is A0 to A4 or [width, height], got {}", shown(other));
            args.fail(0, Code::WrongKind, words)
        }
    }
}

/// The page of the first argument, changed. The copy is counted.
fn changed(
    evaluator: &mut Evaluator,
    args: &Args,
    change: impl FnOnce(&mut PageSpec),
) -> Outcome<Value> {
    let Value::Page(page) = args.value(0) else { return args.wrong(0, "a page") };
    evaluator.tick(page.views.len() as u64, args.call)?;
    let mut page = PageSpec::clone(page);
    change(&mut page);
    Ok(Value::Page(Arc::new(page)))
}

fn subject(args: &Args, i: usize) -> Outcome<Subject> {
    match args.value(i) {
        Value::Drawing(view) => Ok(Subject::View(view.clone())),
        Value::Picture(shade) => Ok(Subject::Shade(shade.clone())),
        _ => args.wrong(i, "a drawing or a picture"),
    }
}

/// `page, view, at, scale`.
fn place_at(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let position = Position::At(flat(args.point(2)?));
    place(evaluator, args, position, 3)
}

/// `page, view, beside, gap`.
fn place_beside(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let Value::Page(page) = args.value(0) else { return args.wrong(0, "a page") };
    let other = subject(args, 2)?;
    let Some(other) = page.views.iter().position(|placed| placed.subject == other) else {
        let words = "the view beside which this one is placed is not on the page";
        let error = Diagnostic::error(Code::BadCall, words).label(args.span(2), "");
        return Err(error.help("place that one before").into());
    };
    place(evaluator, args, Position::Beside { other, gap: args.not_negative(3)? }, 4)
}

fn place(
    evaluator: &mut Evaluator,
    args: &Args,
    position: Position,
    scale: usize,
) -> Outcome<Value> {
    let subject = subject(args, 1)?;
    let scale = match position {
        Position::At(_) if args.given(scale) => Some(args.positive(scale)?),
        _ => None,
    };
    let place = Place(evaluator.shown_at(args.span(1)));
    changed(evaluator, args, |page| page.views.push(Placed { subject, position, scale, place }))
}

/// `page, title, fields`.
fn title(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let title = args.text(1)?.into();
    let Value::Record(record) = args.value(2) else { return args.wrong(2, "a record") };
    let fields = record.fields().iter();
    let fields = fields.map(|(key, value)| (key.clone(), value.to_string().into())).collect();
    changed(evaluator, args, |page| page.title = Some(TitleSpec { title, fields }))
}
