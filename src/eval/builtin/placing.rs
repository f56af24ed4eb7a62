//! Where shapes stand, and what they look like.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::{Args, Native, colors, coordinates, surfaces};
use crate::{
    base::Code,
    eval::{
        evaluator::Evaluator,
        failure::{Outcome, fail},
        nearest::did_you_mean,
        value::{Symbol, Value},
    },
    geom::{Placement, mesh::Color, overlay::REACH, trig},
    shape::{Node, ShapeId},
};

pub const TABLE: &[(&str, Native)] = &[
    ("place.move.by", |e, a| moved(e, a, a.point(1)?)),
    ("place.move.axes", |e, a| moved(e, a, DVec3::new(a.number(1)?, a.number(2)?, a.number(3)?))),
    ("place.rotate.axes", rotate_axes),
    ("place.rotate.axis", rotate_axis),
    ("place.scale.all", |e, a| scaled(e, a, DVec3::splat(a.number(1)?))),
    ("place.scale.axes", |e, a| scaled(e, a, DVec3::new(a.number(1)?, a.number(2)?, a.number(3)?))),
    ("place.mirror", mirror),
    ("place.transform", transform),
    ("place.tag", tag),
    ("place.color", color),
    ("place.direction", direction),
];

/// A shape after a map; maps that follow one another become one.
fn place(evaluator: &mut Evaluator, args: &Args, placement: Placement) -> Outcome<Value> {
    let shape = match args.value(0) {
        Value::Surface(surface) => {
            within_reach(args, &placement)?;
            return surfaces::keep(evaluator, args, surface.grid().placed(&placement));
        }
        Value::Curve(curve) => {
            within_reach(args, &placement)?;
            return Ok(Value::Curve(Arc::new(curve.placed(&placement))));
        }
        _ => args.shape(0)?,
    };
    let id = placed(evaluator, args, shape, placement)?;
    Ok(evaluator.shape_value(id))
}

fn placed(
    evaluator: &mut Evaluator,
    args: &Args,
    shape: ShapeId,
    placement: Placement,
) -> Outcome<ShapeId> {
    let (placement, child) = match evaluator.graph().node(shape) {
        Node::Transform { placement: inner, child } => (placement.after(inner), *child),
        Node::Empty(_) => return Ok(shape),
        _ => (placement, shape),
    };
    if placement.is_identity() {
        return Ok(child);
    }
    within_reach(args, &placement)?;
    Ok(evaluator.add_node(Node::Transform { placement, child }, args.call))
}

fn within_reach(args: &Args, placement: &Placement) -> Outcome<()> {
    let map = [placement.linear().x_axis, placement.linear().y_axis, placement.linear().z_axis];
    let fits = |column: DVec3| column.abs().max_element() <= REACH && column.is_finite();
    if !(map.into_iter().all(fits) && fits(placement.offset())) {
        let words =
            format!("the shape is moved or scaled too far: its map holds numbers beyond {REACH:e}");
        return fail(Code::OutOfRange, args.call, words);
    }
    Ok(())
}

fn moved(evaluator: &mut Evaluator, args: &Args, v: DVec3) -> Outcome<Value> {
    place(evaluator, args, Placement::translation(v))
}

/// About x, then y, then z.
fn rotate_axes(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let about = |i: usize, axis: DVec3| args.number(i).map(|angle| turn(axis, angle));
    let (x, y, z) = (about(1, DVec3::X)?, about(2, DVec3::Y)?, about(3, DVec3::Z)?);
    place(evaluator, args, Placement::new(z * y * x, DVec3::ZERO))
}

fn rotate_axis(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let axis = args.point(1)?;
    if axis == DVec3::ZERO {
        return args.degenerate(1, "must not be the zero vector");
    }
    let matrix = turn(axis / axis.length(), args.number(2)?);
    place(evaluator, args, Placement::new(matrix, DVec3::ZERO))
}

/// The right-handed rotation about a unit axis (Rodrigues), exact at quarter turns about an axis of
/// coordinates.
fn turn(axis: DVec3, degrees: f64) -> DMat3 {
    let (s, c) = (trig::sin_deg(degrees), trig::cos_deg(degrees));
    let row = |i: usize, j: usize| {
        let along = axis[i] * axis[j];
        let cross = match (i, j) {
            (0, 1) => -axis.z,
            (0, 2) => axis.y,
            (1, 0) => axis.z,
            (1, 2) => -axis.x,
            (2, 0) => -axis.y,
            (2, 1) => axis.x,
            _ => return if along == 1.0 { 1.0 } else { along * (1.0 - c) + c },
        };
        along * (1.0 - c) + cross * s
    };
    let column = |j: usize| DVec3::new(row(0, j), row(1, j), row(2, j));
    DMat3::from_cols(column(0), column(1), column(2))
}

fn scaled(evaluator: &mut Evaluator, args: &Args, k: DVec3) -> Outcome<Value> {
    for (i, k) in k.to_array().into_iter().enumerate() {
        if k == 0.0 {
            let argument = if args.params.len() == 2 { 1 } else { i + 1 };
            return args.degenerate(argument, "must not be 0");
        }
    }
    place(evaluator, args, Placement::new(DMat3::from_diagonal(k), DVec3::ZERO))
}

fn mirror(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (n, at) = (args.point(1)?, args.point(2)?);
    if n == DVec3::ZERO {
        return args.degenerate(1, "must not be the zero vector");
    }
    let k = 2.0 / n.length_squared();
    let column = |axis: DVec3| axis - n * (k * n.dot(axis));
    let matrix = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
    place(evaluator, args, Placement::new(matrix, n * (k * n.dot(at))))
}

fn transform(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let rows = evaluator.items(args.value(1), args.span(1))?;
    let mut numbers = [[0.0; 4]; 3];
    let fits = rows.len() == 3 || rows.len() == 4;
    for (row, numbers) in rows.iter().zip(&mut numbers) {
        let row = evaluator.items(row, args.span(1))?;
        for (i, number) in numbers.iter_mut().enumerate() {
            match row.get(i) {
                Some(Value::Number(value, _)) if row.len() == 4 => *number = *value,
                _ => {
                    return args.fail(1, Code::WrongKind, "each row of the matrix needs 4 numbers");
                }
            }
        }
    }
    if !fits {
        return args.fail(
            1,
            Code::WrongKind,
            format!("the matrix needs 3 rows of 4, got {}", rows.len()),
        );
    }
    let column = |j: usize| DVec3::new(numbers[0][j], numbers[1][j], numbers[2][j]);
    let matrix = DMat3::from_cols(column(0), column(1), column(2));
    if matrix.determinant() == 0.0 {
        return args.fail(1, Code::Degenerate, "the matrix flattens space: its determinant is 0");
    }
    place(evaluator, args, Placement::new(matrix, column(3)))
}

fn tag(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (child, name) = (args.shape(0)?, args.text(1)?.into());
    let id = evaluator.add_node(Node::Tag { name, child }, args.call);
    Ok(evaluator.shape_value(id))
}

fn color(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (child, color) = (args.shape(0)?, read_color(args, 1, args.value(1))?);
    let id = evaluator.add_node(Node::Paint { color, child }, args.call);
    Ok(evaluator.shape_value(id))
}

/// The colour that a value names, which stands in argument `i`.
pub(super) fn read_color(args: &Args, i: usize, value: &Value) -> Outcome<Color> {
    match value {
        Value::Text(name) => match colors::named(name) {
            Some(color) => Ok(color),
            None => {
                let message = format!("there is no colour \"{}\"", &***name);
                let near = did_you_mean(name, colors::NAMES.iter().map(|(name, _)| *name));
                let error = crate::base::Diagnostic::error(Code::UnknownName, message);
                let error = error.label(args.span(i), "");
                Err(match near {
                    Some((help, _)) => error.help(help),
                    None => error.help("write a CSS name, \"#rrggbb\", or [r, g, b] from 0 to 1"),
                }
                .into())
            }
        },
        list => match coordinates(list) {
            Some(rgb) if rgb.min_element() >= 0.0 && rgb.max_element() <= 1.0 => {
                Ok(colors::from_unit(rgb.to_array()))
            }
            _ => {
                args.fail(i, Code::OutOfRange, "a colour is a name or [r, g, b], each from 0 to 1")
            }
        },
    }
}

/// The unit vector of a side such as `TOP`.
fn direction(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let direction = match args.symbol(0)? {
        Symbol::Left => DVec3::NEG_X,
        Symbol::Right => DVec3::X,
        Symbol::Front => DVec3::NEG_Y,
        Symbol::Back => DVec3::Y,
        Symbol::Bottom => DVec3::NEG_Z,
        Symbol::Top => DVec3::Z,
        other => {
            let words = format!("a side is LEFT, RIGHT, FRONT, BACK, TOP or BOTTOM, got {other}");
            return args.fail(0, Code::OutOfRange, words);
        }
    };
    Ok(Value::list(direction.to_array().map(Value::bare).to_vec()))
}
