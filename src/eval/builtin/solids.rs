//! Solids.

use std::sync::Arc;

use glam::DVec3;

use super::{Args, Native, coordinates};
use crate::{
    base::Code,
    eval::{
        evaluator::Evaluator, failure::Outcome, interpret::algebra::SetOperation, types::shown,
        value::Value,
    },
    shape::{Kind, Node},
};

pub const TABLE: &[(&str, Native)] = &[
    ("solid.box.size", box_size),
    ("solid.box.corners", box_corners),
    ("solid.cylinder.r", |e, a| cone(e, a, a.positive(0)?, a.positive(0)?, 1)),
    ("solid.cylinder.d", |e, a| cone(e, a, a.positive(0)? / 2.0, a.positive(0)? / 2.0, 1)),
    ("solid.cone.r", |e, a| cone_ends(e, a, 1.0)),
    ("solid.cone.d", |e, a| cone_ends(e, a, 0.5)),
    ("solid.sphere.r", |e, a| sphere(e, a, a.positive(0)?)),
    ("solid.sphere.d", |e, a| sphere(e, a, a.positive(0)? / 2.0)),
    ("solid.torus", torus),
    ("solid.prism.regular", prism),
    ("solid.polyhedron", polyhedron),
    ("solid.hull", hull),
    ("solid.empty", |e, a| Ok(Value::Solid(e.add_node(Node::Empty(Kind::Solid), a.call)))),
    ("algebra.union", |e, a| e.combine(SetOperation::Union, None, a.value(0), a.span(0))),
    ("algebra.intersection", |e, a| {
        e.combine(SetOperation::Intersection, None, a.value(0), a.span(0))
    }),
    ("algebra.difference", |e, a| {
        let first = a.shape(0)?;
        e.combine(SetOperation::Difference, Some(first), a.value(1), a.span(1))
    }),
];

fn solid(evaluator: &mut Evaluator, args: &Args, node: Node) -> Outcome<Value> {
    Ok(Value::Solid(evaluator.add_node(node, args.call)))
}

fn box_size(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (x, y, z) = (args.positive(0)?, args.positive(1)?, args.positive(2)?);
    let (min, max) = (DVec3::new(-x / 2.0, -y / 2.0, 0.0), DVec3::new(x / 2.0, y / 2.0, z));
    solid(evaluator, args, Node::Box { min, max })
}

fn box_corners(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (a, b) = (args.point(0)?, args.point(1)?);
    let (min, max) = (a.min(b), a.max(b));
    if (max - min).min_element() > 0.0 {
        return solid(evaluator, args, Node::Box { min, max });
    }
    let axis = (max - min).min_position();
    let name = ["x", "y", "z"][axis];
    let message =
        format!("the box has no extent along {name}: both corners are at {}mm", min[axis]);
    args.fail(1, Code::Degenerate, message)
}

fn cone(evaluator: &mut Evaluator, args: &Args, r1: f64, r2: f64, height: usize) -> Outcome<Value> {
    let (h, sides) = (args.positive(height)?, args.sides(height + 1)?);
    solid(evaluator, args, Node::Cone { r1, r2, h, sides })
}

fn cone_ends(evaluator: &mut Evaluator, args: &Args, factor: f64) -> Outcome<Value> {
    let (r1, r2) = (args.not_negative(0)? * factor, args.not_negative(1)? * factor);
    if r1 == 0.0 && r2 == 0.0 {
        return args.degenerate(1, "must be greater than 0 when the other end is 0");
    }
    cone(evaluator, args, r1, r2, 2)
}

fn sphere(evaluator: &mut Evaluator, args: &Args, r: f64) -> Outcome<Value> {
    let sides = args.sides(1)?;
    solid(evaluator, args, Node::Sphere { r, sides })
}

fn torus(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (major, minor, sides) = (args.positive(0)?, args.positive(1)?, args.sides(2)?);
    if minor >= major {
        let message = format!(
            "the tube radius `r` = {} must be below `R` = {}",
            args.value(1),
            args.value(0)
        );
        return args.fail(1, Code::Degenerate, message);
    }
    solid(evaluator, args, Node::Torus { major, minor, sides })
}

fn prism(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (n, r, h) = (args.count(0, 3)?, args.positive(1)?, args.positive(2)?);
    args.sides(0)?;
    solid(evaluator, args, Node::Cone { r1: r, r2: r, h, sides: Some(n) })
}

fn polyhedron(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let points = evaluator.items(args.value(0), args.span(0))?;
    let faces = evaluator.items(args.value(1), args.span(1))?;
    if points.len() < 4 || faces.len() < 4 {
        let message = format!(
            "a polyhedron needs at least 4 points and 4 faces, got {} and {}",
            points.len(),
            faces.len()
        );
        return args.fail(if points.len() < 4 { 0 } else { 1 }, Code::Degenerate, message);
    }
    let corners: Option<Vec<DVec3>> = points.iter().map(coordinates).collect();
    let Some(corners) = corners else { return args.degenerate(0, "must be a list of points") };
    let mut rings: Vec<Arc<[u32]>> = Vec::with_capacity(faces.len());
    for (number, face) in faces.iter().enumerate() {
        rings.push(ring(evaluator, args, number, face, corners.len())?);
    }
    let node = Node::Polyhedron { points: corners.into(), faces: rings.into() };
    solid(evaluator, args, node)
}

fn ring(
    evaluator: &mut Evaluator,
    args: &Args,
    number: usize,
    face: &Value,
    points: usize,
) -> Outcome<Arc<[u32]>> {
    let items = evaluator.items(face, args.span(1))?;
    let mut ring = Vec::with_capacity(items.len());
    for item in items.iter() {
        match item {
            Value::Number(index, _)
                if index.fract() == 0.0 && (0.0..points as f64).contains(index) =>
            {
                ring.push(*index as u32);
            }
            other => {
                let words = format!(
                    "face {number} names the point {}; there are {points}, numbered from 0",
                    shown(other)
                );
                return args.fail(1, Code::OutOfRange, words);
            }
        }
    }
    if ring.len() < 3 {
        let words = format!("face {number} has {} corners; a face needs at least 3", ring.len());
        return args.fail(1, Code::Degenerate, words);
    }
    Ok(ring.into())
}

fn hull(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (shapes, _) = evaluator.shapes_of(args.value(0), args.span(0))?;
    let solid = shapes.iter().any(|id| !matches!(evaluator.graph().node(*id), Node::Empty(_)));
    if !solid {
        return args.fail(0, Code::Degenerate, "the hull of nothing: the list holds no shape");
    }
    let id = evaluator.add_node(Node::Hull(shapes.into()), args.call);
    Ok(evaluator.shape_value(id))
}
