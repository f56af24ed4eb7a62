//! Sweeps, lofts and patches.

use std::sync::Arc;

use glam::DVec3;

use super::{
    Args, Native,
    curves::{curve, filled},
    surfaces,
};
use crate::{
    base::Code,
    eval::{
        evaluator::Evaluator,
        failure::Outcome,
        types::shown,
        value::{Symbol, Value},
    },
    geom::{
        Curve,
        sweep::{Corners, Frame, Repair, Stations},
    },
    shape::{CurveSpec, Node, ShapeId, SweepAlong, SweepBetween, SweptSurface},
};

pub const TABLE: &[(&str, Native)] = &[
    ("sweep.along", along),
    ("sweep.between", between),
    ("sweep.loft", loft),
    ("sweep.coons", coons),
    ("sweep.extrude", extrude),
    ("sweep.revolve", revolve),
];

/// A constant of a few.
fn one_of<T: Copy>(args: &Args, i: usize, known: &[(Symbol, T)]) -> Outcome<T> {
    let found = args.symbol(i).ok().and_then(|symbol| known.iter().find(|k| k.0 == symbol));
    match found {
        Some((_, value)) => Ok(*value),
        None => {
            let names: Vec<&str> = known.iter().map(|(symbol, _)| symbol.name()).collect();
            let words = format!(
                "`{}` is one of {}, got {}",
                args.name(i),
                names.join(", "),
                shown(args.value(i))
            );
            args.fail(i, Code::OutOfRange, words)
        }
    }
}

fn repair(args: &Args, i: usize) -> Outcome<Repair> {
    one_of(args, i, &[(Symbol::None, Repair::No), (Symbol::Union, Repair::Union)])
}

fn solid(evaluator: &mut Evaluator, args: &Args, node: Node) -> Outcome<Value> {
    Ok(Value::Solid(evaluator.add_node(node, args.call)))
}

/// `profile, along, twist, scale, frame, corners, repair`.
fn along(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let frames = [
        (Symbol::RotationMinimising, Frame::RotationMinimising),
        (Symbol::Fixed, Frame::Fixed),
        (Symbol::Frenet, Frame::Frenet),
        (Symbol::Upright, Frame::Upright),
    ];
    let corners = [(Symbol::Mitred, Corners::Mitred), (Symbol::Rounded, Corners::Rounded)];
    let sweep = SweepAlong {
        profile: args.shape(0)?,
        path: Arc::new(curve(args, 1)?.clone()),
        twist: args.number(2)?,
        scale: args.positive(3)?,
        frame: one_of(args, 4, &frames)?,
        corners: one_of(args, 5, &corners)?,
        repair: repair(args, 6)?,
    };
    solid(evaluator, args, Node::SweptAlong(Arc::new(sweep)))
}

/// The curves in a list, of a certain number if one is asked for.
fn curves(
    evaluator: &mut Evaluator,
    args: &Args,
    i: usize,
    count: usize,
) -> Outcome<Vec<Arc<Curve>>> {
    let items = evaluator.items(args.value(i), args.span(i))?;
    let found: Vec<Arc<Curve>> = items.iter().filter_map(exact).collect();
    if found.len() != items.len() || found.len() != count {
        let words = format!("`{}` needs {count} curves, got {}", args.name(i), items.len());
        return args.fail(i, Code::WrongKind, words);
    }
    Ok(found)
}

fn exact(value: &Value) -> Option<Arc<Curve>> {
    match value {
        Value::Curve(spec) => match &**spec {
            CurveSpec::Exact(curve) => Some(Arc::new(curve.clone())),
            CurveSpec::Hatch { .. } => None,
        },
        _ => None,
    }
}

/// `rails, sections, stations, repair`: a surface of open sections, a solid of closed ones.
fn between(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let rails: [Arc<Curve>; 2] = match <[_; 2]>::try_from(curves(evaluator, args, 0, 2)?) {
        Ok(rails) => rails,
        Err(_) => return args.wrong(0, "two curves"),
    };
    let rules = [(Symbol::Through, Stations::Through), (Symbol::Mid, Stations::Mid)];
    let (stations, repair) = (one_of(args, 2, &rules)?, repair(args, 3)?);
    let items = evaluator.items(args.value(1), args.span(1))?;
    let (mut open, mut closed): (Vec<Arc<Curve>>, Vec<ShapeId>) = (vec![], vec![]);
    for item in items.iter() {
        match (item, exact(item)) {
            (Value::Profile(id), _) => closed.push(*id),
            (_, Some(curve)) if curve.is_closed() => {
                closed.push(filled(evaluator, args, 1, &curve)?);
            }
            (_, Some(curve)) => open.push(curve),
            _ => {
                let words = format!("a section is a curve or a profile, got {}", shown(item));
                return args.fail(1, Code::WrongKind, words);
            }
        }
    }
    match (open.is_empty(), closed.is_empty()) {
        (false, false) => {
            args.fail(1, Code::WrongKind, "sections are all open curves, or all closed ones")
        }
        (_, true) => {
            surface(evaluator, args, &SweptSurface::Between { rails, sections: open, stations })
        }
        (true, false) => {
            let sweep = SweepBetween { rails, sections: closed.into(), stations, repair };
            solid(evaluator, args, Node::SweptBetween(Arc::new(sweep)))
        }
    }
}

/// `profiles, ruled`.
fn loft(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let items = evaluator.items(args.value(0), args.span(0))?;
    let sections: Arc<[ShapeId]> = items.iter().filter_map(Value::shape).collect();
    let ruled = matches!(args.value(1), Value::Bool(true));
    if sections.len() < 2 {
        let words = format!("a loft needs at least two profiles, got {}", sections.len());
        return args.fail(0, Code::Degenerate, words);
    }
    solid(evaluator, args, Node::Loft { sections, ruled })
}

/// The value of a swept surface.
fn surface(evaluator: &mut Evaluator, args: &Args, surface: &SweptSurface) -> Outcome<Value> {
    let grid = evaluator.ask(args.call, |host, _| host.surface(surface))?;
    surfaces::keep(evaluator, args, grid)
}

fn coons(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    match <[_; 4]>::try_from(curves(evaluator, args, 0, 4)?) {
        Ok(sides) => surface(evaluator, args, &SweptSurface::Patch(sides)),
        Err(_) => args.wrong(0, "four curves"),
    }
}

/// `curve, h`.
fn extrude(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (curve, h) = (Arc::new(curve(args, 0)?.clone()), args.positive(1)?);
    surface(evaluator, args, &SweptSurface::Extruded { curve, by: DVec3::Z * h })
}

/// `curve, angle`.
fn revolve(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (curve, angle) = (Arc::new(curve(args, 0)?.clone()), args.positive(1)?);
    if angle > 360.0 {
        return args.degenerate(1, "is at most a full turn");
    }
    if let Some(p) = curve.vertices().iter().find(|p| p.z != 0.0) {
        let words = format!(
            "a curve that is turned lies in the xy plane; this one has a point at z = {} mm",
            p.z
        );
        return args.fail(0, Code::OutOfRange, words);
    }
    surface(evaluator, args, &SweptSurface::Revolved { curve, angle })
}
