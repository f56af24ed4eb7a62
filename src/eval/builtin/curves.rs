//! Curves in space.

use std::sync::Arc;

use glam::DVec3;

use super::{Args, Native, coordinates, point_value};
use crate::{
    base::Code,
    eval::{
        dimension::Dimension,
        evaluator::Evaluator,
        failure::Outcome,
        value::{Value, number_text},
    },
    geom::{
        Curve, CurveError, Placement,
        curve::{Flat, Turn},
    },
    shape::{CurveSpec, Node, ShapeId},
};

pub const TABLE: &[(&str, Native)] = &[
    ("curve.polyline", polyline),
    ("curve.arc", arc),
    ("curve.smooth", smooth),
    ("curve.spline", spline),
    ("curve.bezier", bezier),
    ("curve.helix", helix),
    ("curve.length", |_, a| Ok(Value::length(curve(a, 0)?.length()))),
    ("curve.at", |_, a| Ok(point_value(place(a, |curve, at| curve.at(at))?))),
    ("curve.tangent", tangent),
    ("curve.curvature", curvature),
    ("curve.nearest", nearest),
    ("curve.distance", distance),
    ("curve.distance.curves", distance_of_curves),
    ("curve.distance.solid", distance_from_solid),
    ("curve.points", points),
    ("curve.reverse", |_, a| Ok(value(curve(a, 0)?.reversed()))),
    ("curve.split", split),
    ("curve.join", join),
    ("curve.round", round),
    ("curve.offset", offset),
    ("curve.profile", profile),
    ("curve.tag", tag),
];

/// The value of a curve.
pub(super) fn value(curve: Curve) -> Value {
    Value::Curve(Arc::new(CurveSpec::Exact(curve)))
}

/// The curve in an argument.
pub(super) fn curve<'a>(args: &'a Args, i: usize) -> Outcome<&'a Curve> {
    match args.value(i) {
        Value::Curve(found) => match &**found {
            CurveSpec::Exact(curve) => Ok(curve),
            CurveSpec::Hatch { .. } => {
                args.fail(i, Code::WrongKind, "a hatching is many lines; this needs one curve")
            }
        },
        _ => args.wrong(i, "a curve"),
    }
}

/// The points of an argument, which count.
fn control(evaluator: &mut Evaluator, args: &Args) -> Outcome<Vec<DVec3>> {
    let items = evaluator.items(args.value(0), args.span(0))?;
    evaluator.tick(items.len() as u64, args.call)?;
    Ok(items.iter().filter_map(coordinates).collect())
}

fn made(args: &Args, curve: Result<Curve, CurveError>) -> Outcome<Value> {
    match curve {
        Ok(curve) => Ok(value(curve)),
        Err(error) => {
            let code = match error {
                CurveError::Many(..) => Code::Limit,
                _ => Code::Degenerate,
            };
            args.fail(0, code, error.to_string())
        }
    }
}

fn polyline(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let mut points = control(evaluator, args)?;
    points.dedup();
    let closed = matches!(args.value(1), Value::Bool(true));
    if closed && points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    if points.len() < 2 {
        return args.degenerate(0, "needs at least two points that differ");
    }
    made(args, Curve::polyline(&points, closed))
}

fn smooth(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let points = control(evaluator, args)?;
    made(args, Curve::smooth(&points, matches!(args.value(1), Value::Bool(true))))
}

fn spline(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let points = control(evaluator, args)?;
    let closed = matches!(args.value(1), Value::Bool(true));
    let mut ends = [None; 2];
    for (i, end) in (2..).zip(&mut ends) {
        if args.given(i) {
            let direction = args.point(i)?;
            if direction == DVec3::ZERO {
                return args.degenerate(i, "must not be the zero vector");
            }
            *end = Some(direction);
        }
    }
    if closed && ends.iter().any(Option::is_some) {
        return args.fail(2, Code::OutOfRange, "a closed spline has no ends to give directions to");
    }
    made(args, Curve::spline(&points, closed, ends))
}

fn bezier(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let points = control(evaluator, args)?;
    made(args, Curve::bezier(&points))
}

fn arc(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (center, r) = (args.point(0)?, args.positive(1)?);
    let (from, to) = (args.number(2)?, args.number(3)?);
    if from == to {
        return args.degenerate(3, "must differ from `from`");
    }
    if (to - from).abs() > 360.0 {
        return args.degenerate(3, "must be within a full turn of `from`");
    }
    let (x, y) = (DVec3::X * r, DVec3::Y * r);
    Ok(value(Curve::turn(Turn { center, x, y, rise: DVec3::ZERO, from, to })))
}

/// Turns of one helix at most.
const MOST_TURNS: f64 = 100_000.0;

/// `r, pitch, turns`.
fn helix(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (r, pitch, turns) = (args.positive(0)?, args.number(1)?, args.positive(2)?);
    if pitch == 0.0 && turns > 1.0 {
        return args.degenerate(1, "must not be 0 for more than one turn");
    }
    if turns > MOST_TURNS {
        let words = format!("`turns` is at most {MOST_TURNS}, got {}", number_text(turns));
        return args.fail(2, Code::Limit, words);
    }
    let (x, y, rise) = (DVec3::X * r, DVec3::Y * r, DVec3::Z * pitch);
    let turn = Turn { center: DVec3::ZERO, x, y, rise, from: 0.0, to: 360.0 * turns };
    Ok(value(Curve::turn(turn)))
}

/// What is at the part of a curve's length in argument 1.
fn place<T>(args: &Args, find: impl Fn(&Curve, f64) -> T) -> Outcome<T> {
    let (curve, part) = (curve(args, 0)?, args.number(1)?);
    if !(0.0..=1.0).contains(&part) {
        let words = format!("`{}` runs from 0 to 1, got {}", args.name(1), number_text(part));
        return args.fail(1, Code::OutOfRange, words);
    }
    Ok(find(curve, curve.place(part)))
}

fn tangent(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let direction = place(args, |curve, at| curve.tangent(at))?;
    Ok(Value::list(direction.to_array().map(Value::bare).to_vec()))
}

fn curvature(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let curvature = place(args, |curve, at| curve.curvature(at).length())?;
    Ok(Value::Number(curvature, Dimension::new(-1, 0)))
}

fn nearest(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (curve, p) = (curve(args, 0)?, args.point(1)?);
    Ok(point_value(curve.at(curve.nearest(p))))
}

/// The distance of a point and a curve, in either order.
fn distance(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let i = usize::from(!matches!(args.value(0), Value::Curve(_)));
    let (curve, p) = (curve(args, i)?, args.point(1 - i)?);
    Ok(Value::length(curve.at(curve.nearest(p)).distance(p)))
}

fn distance_of_curves(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (a, b) = (curve(args, 0)?, curve(args, 1)?);
    evaluator.tick((a.pieces().len() + b.pieces().len()) as u64, args.call)?;
    Ok(Value::length(a.distance(b)))
}

/// The distance of a curve and a solid, in either order.
fn distance_from_solid(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let i = usize::from(!matches!(args.value(0), Value::Curve(_)));
    let (curve, shape) = (curve(args, i)?, args.shape(1 - i)?);
    let answer =
        evaluator.ask(args.call, |host, graph| host.distance_to_curve(graph, shape, curve));
    answer.map(Value::length)
}

/// `curve, n`: n equal steps of the parameter of each piece.
fn points(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (curve, n) = (curve(args, 0)?, args.count(1, 1)?);
    let parts = curve.pieces().len() as u64 * u64::from(n);
    evaluator.tick(parts, args.call)?;
    evaluator.room(4 * parts as usize, args.call)?;
    let last = parts + u64::from(!curve.is_closed());
    let at = |i: u64| point_value(curve.at(i as f64 / f64::from(n)));
    Ok(Value::list((0..last).map(at).collect()))
}

fn split(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    match place(args, Curve::split)? {
        Some(parts) => Ok(Value::list(parts.map(value).to_vec())),
        None => args.degenerate(1, "must be inside the curve, above 0 and below 1"),
    }
}

fn join(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let items = evaluator.items(args.value(0), args.span(0))?;
    let curves: Vec<&Curve> = items
        .iter()
        .filter_map(|item| match item {
            Value::Curve(found) => match &**found {
                CurveSpec::Exact(curve) => Some(curve),
                CurveSpec::Hatch { .. } => None,
            },
            _ => None,
        })
        .collect();
    if curves.len() < items.len() {
        return args.fail(0, Code::WrongKind, "a hatching cannot be joined");
    }
    made(args, Curve::joined(&curves))
}

fn round(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (curve, r) = (curve(args, 0)?, args.positive(1)?);
    match curve.rounded(r) {
        Ok(curve) => Ok(value(curve)),
        Err(error) => args.fail(1, Code::Degenerate, error.to_string()),
    }
}

fn offset(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (curve, d) = (curve(args, 0)?, args.number(1)?);
    match curve.offset(d) {
        Ok(curve) => Ok(value(curve)),
        Err(error) => args.fail(1, Code::Degenerate, error.to_string()),
    }
}

/// What a closed curve in a plane encloses.
fn profile(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let curve = curve(args, 0)?;
    if !curve.is_closed() {
        let [a, b] = [curve.at(0.0), curve.at(curve.pieces().len() as f64)].map(point_value);
        let words = format!("a profile needs a closed curve; this one runs from {a} to {b}");
        return args.fail(0, Code::WrongKind, words);
    }
    Ok(Value::Profile(filled(evaluator, args, 0, curve)?))
}

fn tag(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (curve, name) = (curve(args, 0)?, args.text(1)?);
    Ok(value(curve.clone().tagged(Some(name.into()))))
}

/// The profile that a closed curve in an argument bounds, in its plane.
pub(super) fn filled(
    evaluator: &mut Evaluator,
    args: &Args,
    i: usize,
    curve: &Curve,
) -> Outcome<ShapeId> {
    let Flat::In(plane) = curve.flat() else {
        let words = "a profile needs a curve in a plane that encloses an area";
        return args.fail(i, Code::Degenerate, words);
    };
    if plane.is_identity() {
        let curve = Arc::new(curve.clone());
        return Ok(evaluator.add_node(Node::Outline { curve }, args.call));
    }
    let back = plane.inverse().unwrap_or(Placement::IDENTITY);
    let curve = Arc::new(curve.placed(&back));
    let child = evaluator.add_node(Node::Outline { curve }, args.call);
    Ok(evaluator.add_node(Node::Transform { placement: plane, child }, args.call))
}
