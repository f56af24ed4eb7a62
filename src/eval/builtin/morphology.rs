//! Shapes grown, shrunk and rounded by distance.

use glam::DVec3;

use super::{Args, Native};
use crate::{
    base::Code,
    eval::{
        evaluator::Evaluator, failure::Outcome, interpret::algebra::SetOperation, value::Value,
    },
    geom::overlay::REACH,
    shape::{Kind, Node, ShapeId},
};

pub const TABLE: &[(&str, Native)] = &[
    ("distance.offset", |e, a| {
        let by = a.number(1)?;
        offset(e, a, DVec3::splat(by))
    }),
    ("distance.offset.ellipsoid", ellipsoid),
    ("distance.fillet", fillet),
    ("distance.shell", shell),
];

fn offset(evaluator: &mut Evaluator, args: &Args, radii: DVec3) -> Outcome<Value> {
    let child = args.shape(0)?;
    reachable(args, 1, radii.abs().max_element())?;
    if radii == DVec3::ZERO || is_empty(evaluator, child) {
        return Ok(Value::Solid(child));
    }
    Ok(Value::Solid(evaluator.add_node(Node::Offset { child, radii }, args.call)))
}

fn ellipsoid(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let radii = args.point(1)?;
    if radii.min_element() <= 0.0 && radii.max_element() >= 0.0 {
        let words = format!(
            "`{}` needs three radii, all above 0mm to grow or all below to shrink, got {}",
            args.name(1),
            args.value(1)
        );
        return args.fail(1, Code::Degenerate, words);
    }
    offset(evaluator, args, radii)
}

fn fillet(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (child, convex, concave) = (args.shape(0)?, args.not_negative(1)?, args.not_negative(2)?);
    reachable(args, 1, convex)?;
    reachable(args, 2, concave)?;
    if (convex == 0.0 && concave == 0.0) || is_empty(evaluator, child) {
        return Ok(evaluator.shape_value(child));
    }
    let id = evaluator.add_node(Node::Fillet { child, convex, concave }, args.call);
    Ok(evaluator.shape_value(id))
}

/// The shape less itself shrunk by the thickness.
fn shell(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (child, t) = (args.shape(0)?, args.positive(1)?);
    reachable(args, 1, t)?;
    if is_empty(evaluator, child) {
        return Ok(evaluator.shape_value(child));
    }
    let core = match evaluator.graph().kind(child) {
        Kind::Solid => Node::Offset { child, radii: DVec3::splat(-t) },
        Kind::Profile => Node::OffsetProfile { profile: child, d: -t },
    };
    let core = evaluator.add_node(core, args.call);
    let core = evaluator.shape_value(core);
    evaluator.combine(SetOperation::Difference, Some(child), &core, args.call)
}

fn is_empty(evaluator: &Evaluator, shape: ShapeId) -> bool {
    matches!(evaluator.graph().node(shape), Node::Empty(_))
}

/// Stops where a radius is no length that geometry can work with.
fn reachable(args: &Args, i: usize, radius: f64) -> Outcome<()> {
    if radius <= REACH {
        return Ok(());
    }
    let words = format!("`{}` is at most {REACH:e}mm, got {}", args.name(i), args.value(i));
    args.fail(i, Code::OutOfRange, words)
}
