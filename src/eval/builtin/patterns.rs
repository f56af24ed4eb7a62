//! Figures on faces, and hatching.

use std::sync::Arc;

use super::{Args, Native, coordinates, views::side};
use crate::{
    base::Code,
    eval::{evaluator::Evaluator, failure::Outcome, types::shown, value::Value},
    geom::{Placement, View},
    shape::{
        CurveSpec, Node,
        drawing::{FaceSpec, FiguresSpec, Place},
    },
};

pub const TABLE: &[(&str, Native)] = &[("view.draw_on", draw_on), ("curve.hatch", hatch)];

/// `solid, face, curves`.
fn draw_on(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (child, face) = (args.shape(0)?, face(args)?);
    let mut figures = FiguresSpec {
        face,
        profiles: vec![],
        curves: vec![],
        place: Place(evaluator.shown_at(args.call)),
    };
    let mut pending = vec![args.value(2).clone()];
    while let Some(value) = pending.pop() {
        evaluator.tick(1, args.call)?;
        match value {
            Value::Profile(id) => figures.profiles.push(id),
            Value::Curve(curve) => figures.curves.push(curve),
            Value::List(list) => pending.extend(list.iter().rev().cloned()),
            other => {
                let words =
                    format!("profiles and curves are drawn on a face, got {}", shown(&other));
                return args.fail(2, Code::WrongKind, words);
            }
        }
    }
    let node = Node::Figured { figures: Arc::new(figures), child };
    Ok(Value::Solid(evaluator.add_node(node, args.call)))
}

/// A side, a tag, or a plane.
fn face(args: &Args) -> Outcome<FaceSpec> {
    match args.value(1) {
        Value::Symbol(symbol) => match side(*symbol) {
            None | Some(View::Iso | View::Dimetric) => {}
            Some(side) => return Ok(FaceSpec::Side(side)),
        },
        Value::Text(tag) => return Ok(FaceSpec::Tag((&***tag).into())),
        Value::Record(record) if record.get("normal").is_none() && record.fields().len() == 1 => {
            if let Some(at) = record.get("at").and_then(coordinates) {
                return Ok(FaceSpec::Near(at));
            }
        }
        Value::Record(_) => {
            let (plane, _) = super::views::plane(args, 1)?;
            return Ok(FaceSpec::Plane { at: plane.at, normal: plane.normal });
        }
        _ => {}
    }
    let words = format!(
        "a face is FRONT, BACK, LEFT, RIGHT, TOP or BOTTOM, a tag, {{ at = [x, y, z], normal = [x, y, z] }}, or {{ at = [x, y, z] }}, got {}",
        shown(args.value(1))
    );
    args.fail(1, Code::WrongKind, words)
}

/// `profile, pitch, angle`.
fn hatch(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (profile, pitch, angle) = (args.shape(0)?, args.positive(1)?, args.number(2)?);
    let placement = Placement::IDENTITY;
    Ok(Value::Curve(Arc::new(CurveSpec::Hatch { profile, pitch, angle, placement })))
}
