//! Isometric input: paths of strokes, drawings from files, and solids from edges.

use std::sync::Arc;

use glam::DVec3;

use super::{Args, Native, coordinates, curves, point_value};
use crate::{
    base::{Code, Diagnostic},
    eval::{
        dimension::Dimension,
        evaluator::Evaluator,
        failure::Outcome,
        types::shown,
        value::{Record, Symbol, Value},
    },
    geom::{
        Curve, CurveError,
        curve::Piece,
        isometric::{IsoLine, IsoScale},
        overlay::REACH,
        wireframe::{self, Wireframe, WireframeError},
    },
    shape::{CurveSpec, Node},
};

pub const TABLE: &[(&str, Native)] =
    &[("iso.path", path), ("iso.import", import), ("iso.wireframe", solid), ("iso.faces", faces)];

/// Ends of a path nearer than this part of its length are one: what sums of lengths lose.
const CLOSED: f64 = 1e-12;

/// `start, strokes`.
fn path(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let strokes = evaluator.items(args.value(1), args.span(1))?;
    evaluator.tick(strokes.len() as u64, args.call)?;
    let (mut points, mut marks) = (vec![args.point(0)?], vec![]);
    for (number, stroke) in strokes.iter().enumerate() {
        let last = points[points.len() - 1];
        match stroke {
            Value::Symbol(Symbol::Mark) => {
                if marks.last() != Some(&last) {
                    marks.push(last);
                }
            }
            _ => points.push(stroked(args, number, stroke, last)?),
        }
    }
    if points.len() < 2 {
        return args.fail(1, Code::Degenerate, "a path needs at least one stroke");
    }
    let curve = closed(points).or_else(|error| {
        args.fail(1, Code::Degenerate, format!("the strokes make no path: {error}"))
    })?;
    Ok(curves::value(if marks.is_empty() { curve } else { curve.with_vertices(marks) }))
}

/// Where a stroke leads.
fn stroked(args: &Args, number: usize, stroke: &Value, from: DVec3) -> Outcome<DVec3> {
    let to = match stroke {
        Value::Record(record) => along(record).map(|step| from + step),
        value => coordinates(value),
    };
    let Some(to) = to else {
        let words = format!(
            "stroke {number} is none of dx(a), dy(a), dz(a), MARK and a point, got {}",
            shown(stroke)
        );
        return args.fail(1, Code::WrongKind, words);
    };
    if to == from {
        let words = format!("stroke {number} has no length: the pen stays at {}", point_value(to));
        return args.fail(1, Code::Degenerate, words);
    }
    if to.abs().max_element() > REACH {
        let words = format!("stroke {number} leads beyond {REACH:e}mm");
        return args.fail(1, Code::OutOfRange, words);
    }
    Ok(to)
}

/// The way of `{ dx = a }`, `{ dy = a }` or `{ dz = a }`.
fn along(record: &Record) -> Option<DVec3> {
    let [(name, Value::Number(a, Dimension::LENGTH | Dimension::BARE))] = record.fields() else {
        return None;
    };
    let axis = ["dx", "dy", "dz"].iter().position(|known| **known == **name)?;
    Some(DVec3::AXES[axis] * *a)
}

/// Lines from point to point, closed if they end where they start.
fn closed(mut points: Vec<DVec3>) -> Result<Curve, CurveError> {
    let length: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let gap = points[0].distance(points[points.len() - 1]);
    let is_closed = points.len() > 3 && gap <= CLOSED * length;
    if is_closed {
        points.pop();
    }
    Curve::polyline(&points, is_closed)
}

/// `path, origin, unit, snap`.
fn import(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let file = evaluator.relative(args.caller.unit, args.text(0)?, args.span(0))?;
    let given = |i: usize| if args.given(i) { args.positive(i).map(Some) } else { Ok(None) };
    let scale = IsoScale { origin: args.point(1)?, unit: given(2)?, snap: given(3)? };
    let drawing = evaluator.ask(args.span(0), |host, _| host.isometric(&file, &scale))?;
    let count =
        drawing.vertices.len() + drawing.lines.iter().map(|l| l.points.len()).sum::<usize>();
    evaluator.tick(count as u64, args.call)?;
    evaluator.room(4 * count, args.call)?;
    let mut points = drawing.lines.iter().flat_map(|line| &line.points);
    if let Some(far) = points.find(|p| p.abs().max_element() > REACH) {
        let words = format!("the drawing has a point at {}, beyond {REACH:e}mm", point_value(*far));
        return args.fail(0, Code::OutOfRange, words);
    }
    let (mut edges, mut named): (Vec<Value>, Vec<(Arc<str>, Value)>) = (vec![], vec![]);
    for line in &drawing.lines {
        let curve = drawn(args, line)?;
        if line.is_edge {
            edges.push(curve.clone());
        }
        let new = |name: &&String| named.iter().all(|(known, _)| **known != ***name);
        if let Some(name) = line.name.as_ref().filter(new) {
            named.push((name.as_str().into(), curve));
        }
    }
    let vertices = drawing.vertices.iter().map(|p| point_value(*p)).collect();
    let notes = drawing.notes.iter().map(|note| Value::text(note.as_str())).collect();
    let field = |name: &str, value: Value| (name.into(), value);
    Ok(Value::record(vec![
        field("vertices", Value::list(vertices)),
        field("edges", Value::list(edges)),
        field("named", Value::record(named)),
        field("notes", Value::list(notes)),
    ]))
}

/// A line of a drawing as a curve.
fn drawn(args: &Args, line: &IsoLine) -> Outcome<Value> {
    match Curve::polyline(&line.points, line.closed) {
        Ok(curve) => Ok(curves::value(curve.with_vertices(line.marks.clone()))),
        Err(error) => args.fail(0, Code::BadFile, format!("a line of the drawing has {error}")),
    }
}

/// The straight edges of argument 0.
fn edges(evaluator: &mut Evaluator, args: &Args) -> Outcome<Vec<[DVec3; 2]>> {
    let (mut edges, mut pending) = (vec![], vec![args.value(0).clone()]);
    while let Some(value) = pending.pop() {
        evaluator.tick(1, args.call)?;
        match &value {
            Value::Curve(curve) => straight(evaluator, args, curve, &mut edges)?,
            Value::List(list) => {
                let points: Option<Vec<DVec3>> = list.iter().map(coordinates).collect();
                match points.filter(|points| points.len() > 1) {
                    Some(points) => edges.extend(points.windows(2).map(|pair| [pair[0], pair[1]])),
                    None => pending.extend(list.iter().rev().cloned()),
                }
            }
            other => {
                let words = format!(
                    "edges are pairs of points, lists of points and curves of straight pieces, got {}",
                    shown(other)
                );
                return args.fail(0, Code::WrongKind, words);
            }
        }
        if edges.len() > MOST_GIVEN {
            let words = format!("a wireframe is given by at most {MOST_GIVEN} edges");
            return args.fail(0, Code::Limit, words);
        }
    }
    Ok(edges)
}

/// Edges that are looked at, those that are the same counted each time.
const MOST_GIVEN: usize = 100_000;

fn straight(
    evaluator: &mut Evaluator,
    args: &Args,
    curve: &CurveSpec,
    edges: &mut Vec<[DVec3; 2]>,
) -> Outcome<()> {
    let CurveSpec::Exact(curve) = curve else {
        return args.fail(0, Code::WrongKind, "a hatching is no edge");
    };
    evaluator.tick(curve.pieces().len() as u64, args.call)?;
    for piece in curve.pieces() {
        let Piece::Line(ends) = piece else {
            let [a, b] = [0.0, 1.0].map(|s| point_value(piece.at(s)));
            let words =
                format!("an edge from {a} to {b} is curved; a wireframe has straight edges");
            return args.fail(0, Code::WrongKind, words);
        };
        edges.push(*ends);
    }
    Ok(())
}

fn closing(evaluator: &mut Evaluator, args: &Args) -> Outcome<Wireframe> {
    let edges = edges(evaluator, args)?;
    wireframe::faces(&edges).map_err(|error| {
        let code = match error {
            WireframeError::Many { .. }
            | WireframeError::Planes(_)
            | WireframeError::Undecided(_) => Code::Limit,
            WireframeError::Few(_) | WireframeError::NotFinite(_) => Code::Degenerate,
            _ => Code::OpenMesh,
        };
        let words = format!("the wireframe does not close: {error}");
        Diagnostic::error(code, words).label(args.span(0), "").into()
    })
}

/// `edges`: the solid.
fn solid(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let found = closing(evaluator, args)?;
    let faces = found.rings().into_iter().map(Arc::from).collect();
    let node = Node::Polyhedron { points: found.points.into(), faces };
    Ok(Value::Solid(evaluator.add_node(node, args.call)))
}

/// `edges`: the loops of the faces as points.
fn faces(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let found = closing(evaluator, args)?;
    let corners = found.faces.iter().flatten().map(Vec::len).sum::<usize>();
    evaluator.room(4 * corners, args.call)?;
    let point = |i: &u32| point_value(found.points[*i as usize]);
    let ring = |ring: &Vec<u32>| Value::list(ring.iter().map(point).collect());
    let face = |face: &Vec<Vec<u32>>| Value::list(face.iter().map(ring).collect());
    Ok(Value::list(found.faces.iter().map(face).collect()))
}
