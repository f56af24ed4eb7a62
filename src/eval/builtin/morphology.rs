//! Shapes grown, shrunk and rounded by distance.

use glam::DVec3;

use super::{Args, Native};
use crate::{
    base::Code,
    eval::{
        dimension::Dimension,
        evaluator::Evaluator,
        failure::Outcome,
        interpret::algebra::SetOperation,
        types::shown,
        value::{Record, Symbol, Value},
    },
    geom::overlay::REACH,
    shape::{Kind, Node, ShapeId, SphereTest},
};

pub const TABLE: &[(&str, Native)] = &[
    ("distance.offset", |e, a| {
        let by = a.number(1)?;
        let test = sphere_test(e, a, 2)?;
        offset(e, a, DVec3::splat(by), test)
    }),
    ("distance.offset.ellipsoid", ellipsoid),
    ("distance.fillet", fillet),
    ("distance.shell", shell),
];

fn offset(evaluator: &mut Evaluator, args: &Args, radii: DVec3, by: SphereTest) -> Outcome<Value> {
    let child = args.shape(0)?;
    reachable(args, 1, radii.abs().max_element())?;
    if radii == DVec3::ZERO || is_empty(evaluator, child) {
        return Ok(Value::Solid(child));
    }
    Ok(Value::Solid(evaluator.add_node(Node::Offset { child, radii, by }, args.call)))
}

/// `by`: a constant, or the record that `monte_carlo` gives.
fn sphere_test(evaluator: &mut Evaluator, args: &Args, i: usize) -> Outcome<SphereTest> {
    let number = |record: &Record, name: &str| match record.get(name) {
        Some(Value::Number(x, Dimension::BARE)) if *x >= 0.0 && x.fract() == 0.0 => Some(*x),
        _ => None,
    };
    match args.value(i) {
        Value::Symbol(Symbol::Exact) => return Ok(SphereTest::Exact),
        Value::Symbol(Symbol::Quadtree) => return Ok(SphereTest::Quadtree),
        Value::Record(record) => {
            if let (Some(n), Some(seed)) = (number(record, "n"), number(record, "seed")) {
                if n == 0.0 || n > MOST_POINTS {
                    let words =
                        format!("`n` is a number of points from 1 to {MOST_POINTS}, got {n}");
                    return args.fail(i, Code::OutOfRange, words);
                }
                evaluator.tick(n as u64, args.call)?;
                return Ok(SphereTest::MonteCarlo { n: n as u32, seed: seed as u64 });
            }
        }
        _ => {}
    }
    let words =
        format!("`by` is EXACT, QUADTREE or monte_carlo(n, seed), got {}", shown(args.value(i)));
    args.fail(i, Code::WrongKind, words)
}

/// Points that a sphere may be tested by.
const MOST_POINTS: f64 = 1e6;

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
    offset(evaluator, args, radii, SphereTest::Exact)
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
        Kind::Solid => Node::Offset { child, radii: DVec3::splat(-t), by: SphereTest::Exact },
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
