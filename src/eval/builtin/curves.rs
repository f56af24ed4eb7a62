//! Curves in space.

use std::sync::Arc;

use glam::DVec3;

use super::{Args, Native, coordinates};
use crate::{
    eval::{evaluator::Evaluator, failure::Outcome, value::Value},
    shape::CurveSpec,
};

pub const TABLE: &[(&str, Native)] = &[("curve.polyline", polyline), ("curve.arc", arc)];

fn polyline(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let items = evaluator.items(args.value(0), args.span(0))?;
    let points: Vec<DVec3> = items.iter().filter_map(coordinates).collect();
    let apart = points.iter().any(|p| *p != points[0]);
    if !apart {
        return args.degenerate(0, "needs at least two points that differ");
    }
    let closed = matches!(args.value(1), Value::Bool(true));
    Ok(Value::Curve(Arc::new(CurveSpec::Polyline { points, closed })))
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
    Ok(Value::Curve(Arc::new(CurveSpec::Arc { center, x, y, from, to })))
}
