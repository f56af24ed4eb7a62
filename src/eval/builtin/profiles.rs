//! Plane figures, and solids made of them.

use std::sync::Arc;

use glam::DVec2;

use super::{Args, Native, coordinates, flat};
use crate::{
    base::Code,
    eval::{
        evaluator::Evaluator,
        failure::Outcome,
        value::{Symbol, Value},
    },
    shape::{
        Node,
        node::{HorizontalAlign, TextSpec, VerticalAlign},
    },
};

pub const TABLE: &[(&str, Native)] = &[
    ("profile.rect", rect),
    ("profile.circle.r", |e, a| ellipse(e, a, a.positive(0)?, a.positive(0)?, 1)),
    ("profile.circle.d", |e, a| ellipse(e, a, a.positive(0)? / 2.0, a.positive(0)? / 2.0, 1)),
    ("profile.ellipse", |e, a| ellipse(e, a, a.positive(0)?, a.positive(1)?, 2)),
    ("profile.ngon", ngon),
    ("profile.polygon", polygon),
    ("profile.text", text),
    ("profile.offset", offset),
    ("profile.round", round),
    ("profile.extrude", extrude),
    ("profile.revolve", revolve),
];

fn profile(evaluator: &mut Evaluator, args: &Args, node: Node) -> Outcome<Value> {
    Ok(Value::Profile(evaluator.add_node(node, args.call)))
}

fn rect(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let size = DVec2::new(args.positive(0)?, args.positive(1)?);
    profile(evaluator, args, Node::Rect { size })
}

fn ellipse(evaluator: &mut Evaluator, args: &Args, x: f64, y: f64, sides: usize) -> Outcome<Value> {
    let (radii, sides) = (DVec2::new(x, y), args.sides(sides)?);
    profile(evaluator, args, Node::Ellipse { radii, sides })
}

fn ngon(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    args.count(0, 3)?;
    let (sides, r) = (args.sides(0)?, args.positive(1)?);
    profile(evaluator, args, Node::Ellipse { radii: DVec2::splat(r), sides })
}

fn polygon(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let points = contour(evaluator, args, 0, args.value(0))?;
    let given = evaluator.items(args.value(1), args.span(1))?;
    let mut holes = Vec::with_capacity(given.len());
    for hole in given.iter() {
        holes.push(contour(evaluator, args, 1, hole)?);
    }
    profile(evaluator, args, Node::Polygon { points, holes: holes.into() })
}

fn contour(
    evaluator: &mut Evaluator,
    args: &Args,
    i: usize,
    value: &Value,
) -> Outcome<Arc<[DVec2]>> {
    let items = evaluator.items(value, args.span(i))?;
    let points: Option<Vec<DVec2>> = items.iter().map(|item| coordinates(item).map(flat)).collect();
    let Some(mut points) = points else {
        return args.fail(i, Code::WrongKind, format!("`{}` needs points", args.name(i)));
    };
    points.dedup();
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    if points.len() < 3 {
        let words = format!("a polygon needs at least 3 different points, got {}", points.len());
        return args.fail(i, Code::Degenerate, words);
    }
    let origin = points[0];
    if points.windows(2).all(|pair| (pair[0] - origin).perp_dot(pair[1] - origin) == 0.0) {
        return args.fail(i, Code::Degenerate, "all points of the polygon lie on one line");
    }
    Ok(points.into())
}

fn text(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let text: Arc<str> = args.text(0)?.into();
    let size = args.positive(1)?;
    let font = match args.given(2) {
        true => Some(evaluator.relative(args.caller.unit, args.text(2)?, args.span(2))?),
        false => None,
    };
    let halign = match args.symbol(3)? {
        Symbol::Left => HorizontalAlign::Left,
        Symbol::Center => HorizontalAlign::Center,
        Symbol::Right => HorizontalAlign::Right,
        other => return align(args, 3, other, "LEFT, CENTER or RIGHT"),
    };
    let valign = match args.symbol(4)? {
        Symbol::Top => VerticalAlign::Top,
        Symbol::Center => VerticalAlign::Center,
        Symbol::Baseline => VerticalAlign::Baseline,
        Symbol::Bottom => VerticalAlign::Bottom,
        other => return align(args, 4, other, "TOP, CENTER, BASELINE or BOTTOM"),
    };
    let spec = TextSpec { text, size, font, halign, valign };
    profile(evaluator, args, Node::Text(Arc::new(spec)))
}

fn align<T>(args: &Args, i: usize, got: Symbol, choices: &str) -> Outcome<T> {
    args.fail(i, Code::OutOfRange, format!("`{}` is {choices}, got {got}", args.name(i)))
}

fn offset(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (profile_id, d) = (args.shape(0)?, args.number(1)?);
    if d == 0.0 {
        return Ok(Value::Profile(profile_id));
    }
    profile(evaluator, args, Node::OffsetProfile { profile: profile_id, d })
}

fn round(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (profile_id, r) = (args.shape(0)?, args.not_negative(1)?);
    if r == 0.0 {
        return Ok(Value::Profile(profile_id));
    }
    profile(evaluator, args, Node::RoundProfile { profile: profile_id, r })
}

fn extrude(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (profile, height, twist) = (args.shape(0)?, args.positive(1)?, args.number(2)?);
    let scale = match args.value(3) {
        Value::Number(k, _) => DVec2::splat(*k),
        list => match coordinates(list) {
            Some(point) => flat(point),
            None => return args.fail(3, Code::WrongKind, "`scale` is a number or [x, y]"),
        },
    };
    if scale.min_element() < 0.0 {
        return args.degenerate(3, "must not be negative");
    }
    let node = Node::Extrude { profile, height, twist, scale };
    Ok(Value::Solid(evaluator.add_node(node, args.call)))
}

fn revolve(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (profile, angle, sides) = (args.shape(0)?, args.number(1)?, args.sides(2)?);
    if !(angle > 0.0 && angle <= 360.0) {
        let words = format!("`angle` must be above 0deg and at most 360deg, got {}", args.value(1));
        return args.fail(1, Code::Degenerate, words);
    }
    let node = Node::Revolve { profile, angle, sides };
    Ok(Value::Solid(evaluator.add_node(node, args.call)))
}
