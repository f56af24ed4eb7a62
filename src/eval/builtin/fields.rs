//! Solids of formulas and charges, and distances as fields.

use glam::DVec3;

use super::{Args, Native, coordinates};
use crate::{
    base::Code,
    eval::{
        dimension::Dimension,
        evaluator::Evaluator,
        failure::Outcome,
        types::shown,
        value::{Record, Symbol, Value, number_text},
    },
    geom::{Charge, Falloff, overlay::REACH},
    shape::Node,
};

pub const TABLE: &[(&str, Native)] = &[
    ("field.formula", formula),
    ("field.solid", |_, a| a.shape(0).map(Value::Field)),
    ("field.at", at),
    ("field.metaball", metaball),
];

/// `f, within`.
fn formula(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let within = corners(evaluator, args)?;
    let point = (0..3).map(|axis| evaluator.coordinate(axis, args.call));
    let point = Value::list(point.collect::<Outcome<Vec<Value>>>()?);
    evaluator.tracing += 1;
    let found = evaluator.call_with(args, args.value(0), &[point], args.span(0));
    evaluator.tracing -= 1;
    let found = found?;
    if matches!(found, Value::Bool(_)) {
        return not_a_number(args, &found);
    }
    let result = match evaluator.as_step(&found, args.span(0)) {
        Ok(traced) if traced.dimension.is_some() => traced.step,
        _ => return not_a_number(args, &found),
    };
    let formula = evaluator.recording.formula(result).into();
    Ok(Value::Solid(evaluator.add_node(Node::Formula { formula, within }, args.call)))
}

fn not_a_number<T>(args: &Args, found: &Value) -> Outcome<T> {
    let words = format!("the function of a field must give a number, got {}", shown(found));
    args.fail(0, Code::WrongKind, words)
}

/// The smallest and the largest corner of a box with room inside.
fn corners(evaluator: &mut Evaluator, args: &Args) -> Outcome<[DVec3; 2]> {
    let list = evaluator.items(args.value(1), args.span(1))?;
    let points: Vec<DVec3> = list.iter().filter_map(coordinates).collect();
    match points[..] {
        [min, max] if min.cmplt(max).all() => Ok([min, max]),
        _ => {
            let words = format!(
                "`{}` is a box [[x, y, z], [x, y, z]], its smallest corner first, got {}",
                args.name(1),
                shown(args.value(1))
            );
            args.fail(1, Code::Degenerate, words)
        }
    }
}

fn at(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let Value::Field(shape) = *args.value(0) else { return args.wrong(0, "a field") };
    let point = args.point(1)?;
    let answer =
        evaluator.ask(args.call, |host, graph| host.distance_to_point(graph, shape, point));
    answer.map(Value::length)
}

/// `charges, threshold`.
fn metaball(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (list, threshold) = (evaluator.items(args.value(0), args.span(0))?, args.positive(1)?);
    let mut charges = Vec::with_capacity(list.len());
    for (i, item) in list.iter().enumerate() {
        let Value::Record(record) = item else {
            return wrong_charge(args, i, &format!("must be a record, got {}", shown(item)));
        };
        charges.push(charge(args, i, record)?);
    }
    let node = Node::Metaball { charges: charges.into(), threshold };
    Ok(Value::Solid(evaluator.add_node(node, args.call)))
}

fn wrong_charge<T>(args: &Args, i: usize, words: &str) -> Outcome<T> {
    args.fail(0, Code::WrongKind, format!("charge {i} {words}"))
}

/// `{ at = [x, y, z], q = 1, falloff = INVERSE, r }`.
fn charge(args: &Args, i: usize, record: &Record) -> Outcome<Charge> {
    const KEYS: [&str; 4] = ["at", "q", "falloff", "r"];
    if let Some((key, _)) = record.fields().iter().find(|(key, _)| !KEYS.contains(&&**key)) {
        return wrong_charge(args, i, &format!("has a key `{key}`; it takes {}", KEYS.join(", ")));
    }
    let Some(at) =
        record.get("at").and_then(coordinates).filter(|p| p.abs().max_element() <= REACH)
    else {
        return wrong_charge(args, i, "needs a point `at = [x, y, z]`");
    };
    let q = match record.get("q") {
        None => 1.0,
        Some(Value::Number(q, Dimension::BARE)) => *q,
        Some(other) => return wrong_charge(args, i, &format!("has `q` {}", shown(other))),
    };
    Ok(Charge { at, q, falloff: falloff(args, i, record)? })
}

fn falloff(args: &Args, i: usize, record: &Record) -> Outcome<Falloff> {
    let radius = || match record.get("r") {
        Some(Value::Number(r, Dimension::BARE | Dimension::LENGTH)) if *r > 0.0 && *r <= REACH => {
            Ok(*r)
        }
        Some(Value::Number(r, _)) => wrong_charge(
            args,
            i,
            &format!("has `r` {}; it needs a length above 0mm", number_text(*r)),
        ),
        _ => wrong_charge(args, i, "needs a length `r`, as WYVILL and BLINN do"),
    };
    match record.get("falloff") {
        None | Some(Value::Symbol(Symbol::Inverse)) => Ok(Falloff::Inverse),
        Some(Value::Symbol(Symbol::InverseSquare)) => Ok(Falloff::InverseSquare),
        Some(Value::Symbol(Symbol::Wyvill)) => Ok(Falloff::Wyvill { r: radius()? }),
        Some(Value::Symbol(Symbol::Blinn)) => Ok(Falloff::Blinn { r: radius()? }),
        Some(other) => {
            let words = format!(
                "has `falloff` {}; it is INVERSE, INVERSE_SQUARE, WYVILL or BLINN",
                shown(other)
            );
            wrong_charge(args, i, &words)
        }
    }
}
