//! Measures: what geometry answers.

use std::sync::Arc;

use glam::DVec3;

use super::{Args, Native, point_value};
use crate::{
    base::Code,
    eval::{
        dimension::Dimension,
        evaluator::Evaluator,
        failure::Outcome,
        value::{Symbol, Value},
    },
    shape::{Kind, Measures, geometry::InsideMethod},
};

pub const TABLE: &[(&str, Native)] = &[
    ("measure.volume", |e, a| Ok(number(measures(e, a, 0)?.volume, Dimension::VOLUME))),
    ("measure.area", |e, a| Ok(number(measures(e, a, 0)?.area, Dimension::AREA))),
    ("measure.length", |e, a| Ok(Value::length(measures(e, a, 0)?.length))),
    ("measure.centroid", centroid),
    ("measure.genus", |e, a| Ok(Value::bare(measures(e, a, 0)?.genus() as f64))),
    ("measure.shells", |e, a| Ok(Value::bare(measures(e, a, 0)?.shells as f64))),
    ("measure.closed", |e, a| Ok(Value::Bool(measures(e, a, 0)?.closed))),
    ("measure.bbox", bbox),
    ("measure.inertia", inertia),
    ("measure.inside", inside),
    ("measure.solid_angle", solid_angle),
    ("measure.tetrahedra", tetrahedra),
    ("measure.distance.points", distance_points),
    ("measure.distance.point", |e, a| distance_point(e, a, 0, 1)),
    ("measure.distance.to_point", |e, a| distance_point(e, a, 1, 0)),
    ("measure.distance.solids", distance_solids),
    ("measure.hausdorff", hausdorff),
    ("measure.overlap", overlap),
];

fn number(value: f64, dimension: Dimension) -> Value {
    Value::Number(value, dimension)
}

fn measures(evaluator: &mut Evaluator, args: &Args, i: usize) -> Outcome<Arc<Measures>> {
    let shape = args.shape(i)?;
    evaluator.ask(args.call, |host, graph| host.measures(graph, shape))
}

fn centroid(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let measures = measures(evaluator, args, 0)?;
    match measures.bounds {
        Some(_) => Ok(point_value(measures.centroid)),
        None => args.fail(0, Code::Degenerate, "an empty shape has no centroid"),
    }
}

fn bbox(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let measures = measures(evaluator, args, 0)?;
    let Some([min, max]) = measures.bounds else {
        return args.fail(0, Code::Degenerate, "an empty shape has no bounding box");
    };
    let field = |name: &str, point: DVec3| (name.into(), point_value(point));
    Ok(Value::record(vec![
        field("min", min),
        field("max", max),
        field("size", max - min),
        field("center", (min + max) / 2.0),
    ]))
}

fn inertia(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let inertia = measures(evaluator, args, 0)?.inertia;
    let row = |i: usize| {
        let numbers = inertia.row(i).to_array();
        Value::list(numbers.map(|x| Value::Number(x, Dimension::new(5, 0))).to_vec())
    };
    Ok(Value::list((0..3).map(row).collect()))
}

fn inside(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (shape, point) = (args.shape(0)?, args.point(1)?);
    let by = match args.symbol(2)? {
        Symbol::Sphere => InsideMethod::Sphere,
        Symbol::Field => InsideMethod::Field,
        Symbol::Tet => InsideMethod::Tetrahedra,
        other => {
            let words = format!("`by` is SPHERE, FIELD or TET, got {other}");
            return args.fail(2, Code::OutOfRange, words);
        }
    };
    let inside = evaluator.ask(args.call, |host, graph| host.inside(graph, shape, point, by))?;
    Ok(Value::Bool(inside))
}

fn solid_angle(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (shape, point) = (args.shape(0)?, args.point(1)?);
    evaluator.ask(args.call, |host, graph| host.solid_angle(graph, shape, point)).map(Value::bare)
}

fn tetrahedra(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let shape = args.shape(0)?;
    let found = evaluator.ask(args.call, |host, graph| host.tetrahedra(graph, shape))?;
    let count = |n: usize| Value::bare(n as f64);
    let angle = |degrees: f64| number(degrees, Dimension::ANGLE);
    let quality = Value::record(vec![
        ("smallest".into(), angle(found.smallest)),
        ("largest".into(), angle(found.largest)),
        ("histogram".into(), Value::list(found.histogram.into_iter().map(count).collect())),
    ]);
    Ok(Value::record(vec![
        ("count".into(), count(found.count)),
        ("flat".into(), count(found.flat)),
        ("quality".into(), quality),
    ]))
}

fn distance_points(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    Ok(Value::length((args.point(0)? - args.point(1)?).length()))
}

fn distance_point(
    evaluator: &mut Evaluator,
    args: &Args,
    shape: usize,
    point: usize,
) -> Outcome<Value> {
    let (shape, point) = (args.shape(shape)?, args.point(point)?);
    let answer =
        evaluator.ask(args.call, |host, graph| host.distance_to_point(graph, shape, point));
    answer.map(Value::length)
}

fn distance_solids(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (a, b) = (args.shape(0)?, args.shape(1)?);
    evaluator.ask(args.call, |host, graph| host.distance(graph, a, b)).map(Value::length)
}

fn hausdorff(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (a, b) = (args.shape(0)?, args.shape(1)?);
    evaluator.ask(args.call, |host, graph| host.hausdorff(graph, a, b)).map(Value::length)
}

/// The volume, or for profiles the area, of what two shapes have in common.
fn overlap(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let common = evaluator.intersect(&[args.shape(0)?, args.shape(1)?], args.call);
    let measures = evaluator.ask(args.call, |host, graph| host.measures(graph, common))?;
    match evaluator.graph().kind(common) {
        Kind::Solid => Ok(number(measures.volume, Dimension::VOLUME)),
        Kind::Profile => Ok(number(measures.area, Dimension::AREA)),
    }
}
