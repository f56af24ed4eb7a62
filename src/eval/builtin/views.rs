//! Views: what is drawn, from where, and what is written on it.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{Args, Native, coordinates, flat, placing::read_color, shades};
use crate::{
    base::{Code, Diagnostic},
    eval::{
        dimension::Dimension,
        evaluator::Evaluator,
        failure::{Outcome, fail},
        nearest::did_you_mean,
        types::shown,
        value::{Record, Symbol, Value},
    },
    geom::{CurvedGrid, Hidden, Method, View},
    shape::{
        CurveSpec, ShapeId, ViewSpec,
        drawing::{
            CastSpec, CutPlane, CuttingSpec, DimSpec, Measured, PenName, PenSpec, Place,
            Projection, StyleSpec,
        },
        halftone::SunSpec,
    },
};

pub const TABLE: &[(&str, Native)] = &[
    ("view.of", view),
    ("view.section", section_of_shapes),
    ("view.cut", section_of_view),
    ("view.center_lines", center_lines),
    ("view.dim.linear", dim_linear),
    ("view.dim.chain", dim_chain),
    ("view.dim.radius", |e, a| dim_round(e, a, false)),
    ("view.dim.diameter", |e, a| dim_round(e, a, true)),
    ("view.dim.angle", dim_angle),
    ("view.cutting_line", cutting_line),
    ("view.caption", caption),
    ("view.mesh", mesh),
];

/// `shapes, from, eye, target, fov, window, hidden, style, method, light, shadow, grid`.
fn view(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let subjects = subjects(evaluator, args)?;
    let target = args.point(3)?;
    let projection = projection(args, target)?;
    let spec = ViewSpec {
        target,
        window: window(args)?,
        hidden: hidden(args, 6)?,
        method: method(args)?,
        style: style(args, 7)?,
        shadow: cast(args)?,
        grid: grid(args, projection)?,
        ..plain(evaluator, args, subjects, projection)
    };
    Ok(Value::Drawing(Arc::new(spec)))
}

/// Shadows of one sun, if a light or the ground is given.
fn cast(args: &Args) -> Outcome<Option<CastSpec>> {
    if !args.given(9) && !args.given(10) {
        return Ok(None);
    }
    let suns = match args.given(9) {
        true => shades::suns(args, 9)?,
        false => vec![SunSpec::DEFAULT],
    };
    let [sun] = suns[..] else {
        return args.fail(9, Code::OutOfRange, "the shadows of a view are those of one sun");
    };
    let ground = shades::ground(args, (9, 10), &suns)?;
    Ok(Some(CastSpec { toward: sun.toward, ground }))
}

/// The field of a record that holds the pitch of a guide mesh.
const MESH: &str = "iso";

/// `pitch`: the guide mesh of isometric paper.
fn mesh(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    args.positive(0)?;
    Ok(Value::record(vec![(MESH.into(), args.value(0).clone())]))
}

/// The pitch of the guide mesh, mm.
fn grid(args: &Args, projection: Projection) -> Outcome<Option<f64>> {
    if !args.given(11) {
        return Ok(None);
    }
    let pitch = match args.value(11) {
        Value::Record(record) => record.get(MESH),
        Value::Symbol(Symbol::Iso) => {
            let words = "the isometric grid needs a pitch: `grid = ISO(5mm)`";
            return args.fail(11, Code::MissingArgument, words);
        }
        _ => None,
    };
    let Some(pitch) = pitch else {
        let words = format!("`grid` is ISO(pitch), got {}", shown(args.value(11)));
        return args.fail(11, Code::WrongKind, words);
    };
    if projection != Projection::Side(View::Iso) {
        let words = "an isometric grid needs a view from ISO";
        return args.fail(11, Code::BadCall, words);
    }
    positive(args, 11, "pitch", pitch, Dimension::LENGTH).map(Some)
}

/// A view of subjects with nothing else said of it.
fn plain(
    evaluator: &Evaluator,
    args: &Args,
    subjects: Subjects,
    projection: Projection,
) -> ViewSpec {
    ViewSpec {
        shapes: subjects.shapes,
        surfaces: subjects.surfaces,
        profiles: subjects.profiles,
        curves: subjects.curves,
        projection,
        target: DVec3::ZERO,
        window: None,
        hidden: Hidden::Off,
        method: Method::Auto,
        style: StyleSpec::default(),
        shadow: None,
        section: None,
        center_lines: false,
        dims: vec![],
        cuttings: vec![],
        grid: None,
        caption: None,
        place: Place(evaluator.shown_at(args.call)),
    }
}

/// Why a surface is not cut.
const OPEN: &str =
    "a section cuts solids, not surfaces; make a solid with `.thicken(t)` or `.solid(base = ...)`";

/// What a view shows.
#[derive(Default)]
pub(super) struct Subjects {
    pub shapes: Vec<ShapeId>,
    pub profiles: Vec<ShapeId>,
    pub surfaces: Vec<Arc<CurvedGrid>>,
    pub curves: Vec<Arc<CurveSpec>>,
}

/// What the first argument holds, lists opened at every level.
pub(super) fn subjects(evaluator: &mut Evaluator, args: &Args) -> Outcome<Subjects> {
    let mut found = Subjects::default();
    let mut pending = vec![args.value(0).clone()];
    while let Some(value) = pending.pop() {
        evaluator.tick(1, args.call)?;
        match value {
            Value::Solid(id) => found.shapes.push(id),
            Value::Profile(id) => found.profiles.push(id),
            Value::Surface(surface) => found.surfaces.push(surface.grid().clone()),
            Value::Curve(curve) => found.curves.push(curve),
            Value::List(list) => pending.extend(list.iter().rev().cloned()),
            other => {
                let words = format!(
                    "a view needs solids, surfaces, profiles and curves, got {}",
                    shown(&other)
                );
                return args.fail(0, Code::WrongKind, words);
            }
        }
    }
    Ok(found)
}

pub(super) fn side(symbol: Symbol) -> Option<View> {
    Some(match symbol {
        Symbol::Front => View::Front,
        Symbol::Back => View::Back,
        Symbol::Left => View::Left,
        Symbol::Right => View::Right,
        Symbol::Top => View::Top,
        Symbol::Bottom => View::Bottom,
        Symbol::Iso => View::Iso,
        Symbol::Dimetric => View::Dimetric,
        _ => return None,
    })
}

pub(super) fn projection(args: &Args, target: DVec3) -> Outcome<Projection> {
    if args.given(2) {
        return perspective(args, target);
    }
    if args.given(4) {
        let words = "`fov` needs an `eye`: a parallel projection has no field of view";
        return args.fail(4, Code::BadCall, words);
    }
    if !args.given(1) {
        return Ok(Projection::Side(View::Iso));
    }
    match (args.value(1), coordinates(args.value(1))) {
        (_, Some(DVec3::ZERO)) => args.degenerate(1, "must not be the zero vector"),
        (_, Some(direction)) => Ok(Projection::Direction(direction)),
        (Value::Symbol(symbol), _) if side(*symbol).is_some() => {
            Ok(Projection::Side(side(*symbol).unwrap_or(View::Iso)))
        }
        (other, _) => {
            let words = format!("a view is from a side or a direction, got {}", shown(other));
            let sides = "the sides are FRONT, BACK, LEFT, RIGHT, TOP, BOTTOM, ISO and DIMETRIC; \
                         a direction is [x, y, z] towards the eye";
            let error = Diagnostic::error(Code::WrongKind, words).label(args.span(1), "");
            Err(error.help(sides).into())
        }
    }
}

fn perspective(args: &Args, target: DVec3) -> Outcome<Projection> {
    if args.given(1) {
        return args.fail(1, Code::BadCall, "`from` is parallel and `eye` perspective; give one");
    }
    let eye = args.point(2)?;
    if eye == target {
        let words = format!("the eye is at the target, {}", args.value(2));
        let error = Diagnostic::error(Code::Degenerate, words).label(args.span(2), "");
        return Err(error.help("the view is from `eye` towards `target`; move one of them").into());
    }
    let fov = if args.given(4) { Some(args.number(4)?) } else { None };
    if let Some(fov) = fov.filter(|fov| !(*fov > 0.0 && *fov < 180.0)) {
        let words =
            format!("the field of view is {fov}deg; it must be above 0deg and below 180deg");
        return args.fail(4, Code::OutOfRange, words);
    }
    if fov.is_some() && args.given(5) {
        return args.fail(5, Code::BadCall, "`fov` and `window` both bound the picture; give one");
    }
    Ok(Projection::Perspective { eye, fov })
}

/// `[width, height]` about the target, or two corners.
pub(super) fn window(args: &Args) -> Outcome<Option<[DVec2; 2]>> {
    if !args.given(5) {
        return Ok(None);
    }
    let corners = match (args.value(5), coordinates(args.value(5))) {
        (Value::List(list), Some(size)) if list.len() == 2 => {
            Some([-flat(size) / 2.0, flat(size) / 2.0])
        }
        (Value::List(list), _) if list.len() == 2 => {
            let corners = [coordinates(&list[0]), coordinates(&list[1])];
            corners[0].zip(corners[1]).map(|(a, b)| [flat(a.min(b)), flat(a.max(b))])
        }
        _ => None,
    };
    let Some([min, max]) = corners else {
        let words = format!(
            "a window is [width, height] or two corners [[x, y], [x, y]], got {}",
            shown(args.value(5))
        );
        return args.fail(5, Code::WrongKind, words);
    };
    if (max - min).min_element() > 0.0 {
        return Ok(Some([min, max]));
    }
    args.degenerate(5, "needs a width and a height above 0")
}

fn hidden(args: &Args, i: usize) -> Outcome<Hidden> {
    match args.value(i) {
        Value::Symbol(Symbol::Off) => return Ok(Hidden::Off),
        Value::Symbol(Symbol::Dashed) => return Ok(Hidden::Dashed),
        Value::Record(record) => {
            if let Some(Value::Number(k, Dimension::BARE)) = record.get("depth") {
                return Ok(Hidden::Depth(*k as u32));
            }
        }
        _ => {}
    }
    let words = format!("`hidden` is OFF, DASHED or depth(k), got {}", shown(args.value(i)));
    args.fail(i, Code::WrongKind, words)
}

fn method(args: &Args) -> Outcome<Method> {
    match args.value(8) {
        Value::Symbol(Symbol::Auto) => Ok(Method::Auto),
        Value::Symbol(Symbol::Count) => Ok(Method::Count),
        Value::Symbol(Symbol::Clip) => Ok(Method::Clip),
        other => {
            let words = format!("`method` is AUTO, COUNT or CLIP, got {}", shown(other));
            args.fail(8, Code::WrongKind, words)
        }
    }
}

/// What a style may set beside its pens.
const SETTINGS: [&str; 3] = ["crease", "hatch_pitch", "text_height"];

pub(super) fn style(args: &Args, i: usize) -> Outcome<StyleSpec> {
    let mut style = StyleSpec::default();
    let Value::Record(record) = args.value(i) else { return Ok(style) };
    for (key, value) in record.fields() {
        if let Some((pen, _)) = PenName::ALL.iter().find(|(_, name)| **name == **key) {
            let Value::Record(fields) = value else {
                let words = format!(
                    "the style `{key}` is a record such as {{ width = 0.5mm }}, got {}",
                    shown(value)
                );
                return args.fail(i, Code::WrongKind, words);
            };
            style.pens.push((*pen, read_pen(args, i, key, fields)?));
            continue;
        }
        match &**key {
            "crease" => style.crease = Some(positive(args, i, key, value, Dimension::ANGLE)?),
            "hatch_pitch" => {
                style.hatch_pitch = Some(positive(args, i, key, value, Dimension::LENGTH)?);
            }
            "text_height" => {
                style.text_height = Some(positive(args, i, key, value, Dimension::LENGTH)?);
            }
            _ => {
                let names = PenName::ALL.iter().map(|(_, name)| *name).chain(SETTINGS);
                return unknown_key(args, i, "a style", key, names);
            }
        }
    }
    Ok(style)
}

fn read_pen(args: &Args, i: usize, name: &str, fields: &Record) -> Outcome<PenSpec> {
    let mut pen = PenSpec::default();
    for (key, value) in fields.fields() {
        match &**key {
            "width" => pen.width = Some(positive(args, i, key, value, Dimension::LENGTH)?),
            "color" => pen.color = Some(read_color(args, i, value)?),
            "dash" => {
                let Value::List(list) = value else {
                    let words = format!("`dash` is a list of lengths, got {}", shown(value));
                    return args.fail(i, Code::WrongKind, words);
                };
                let lengths =
                    list.iter().map(|value| positive(args, i, key, value, Dimension::LENGTH));
                pen.dash = Some(lengths.collect::<Outcome<_>>()?);
            }
            _ => {
                let what = format!("the pen `{name}`");
                return unknown_key(args, i, &what, key, ["width", "dash", "color"].into_iter());
            }
        }
    }
    Ok(pen)
}

fn unknown_key<'a, T>(
    args: &Args,
    i: usize,
    what: &str,
    key: &str,
    names: impl Iterator<Item = &'a str> + Clone,
) -> Outcome<T> {
    let words = format!("{what} has no `{key}`");
    let error = Diagnostic::error(Code::UnknownArgument, words).label(args.span(i), "");
    let all = || format!("it has {}", names.clone().collect::<Vec<_>>().join(", "));
    Err(match did_you_mean(key, names.clone()) {
        Some((help, _)) => error.help(help),
        None => error.help(all()),
    }
    .into())
}

/// A number above 0 of a dimension, in mm or degrees.
fn positive(args: &Args, i: usize, key: &str, value: &Value, unit: Dimension) -> Outcome<f64> {
    match value {
        Value::Number(number, dimension)
            if *number > 0.0 && (*dimension == unit || *dimension == Dimension::BARE) =>
        {
            Ok(*number)
        }
        other => {
            let words = format!("`{key}` needs {} above 0, got {}", unit.words(), shown(other));
            args.fail(i, Code::WrongKind, words)
        }
    }
}

/// The plane of an argument: a side such as FRONT, or `{ at = ..., normal = ... }`.
pub(super) fn plane(args: &Args, i: usize) -> Outcome<(CutPlane, Option<View>)> {
    let through_origin = |normal| CutPlane { at: DVec3::ZERO, normal };
    let facing = |side: View| {
        let across = !matches!(side, View::Iso | View::Dimetric);
        across.then(|| through_origin(side.direction()))
    };
    match args.value(i) {
        Value::Symbol(symbol) => {
            if let Some((plane, side)) = side(*symbol).and_then(|s| Some((facing(s)?, s))) {
                return Ok((plane, Some(side)));
            }
        }
        Value::Record(record) => {
            let at = record.get("at").map_or(Some(DVec3::ZERO), coordinates);
            let side = match record.get("normal") {
                Some(Value::Symbol(symbol)) => side(*symbol),
                _ => None,
            };
            let normal = side.and_then(facing).map(|plane| plane.normal);
            let normal = normal.or_else(|| record.get("normal").and_then(coordinates));
            let keys = record.fields().iter().all(|(key, _)| matches!(&**key, "at" | "normal"));
            if let (Some(at), Some(normal), true) = (at, normal, keys) {
                if normal == DVec3::ZERO {
                    return args.degenerate(i, "needs a normal that is not zero");
                }
                return Ok((CutPlane { at, normal }, side));
            }
        }
        _ => {}
    }
    let words = format!(
        "a section plane is FRONT, BACK, LEFT, RIGHT, TOP or BOTTOM through the origin, or \
         {{ at = [x, y, z], normal = [x, y, z] }}, got {}",
        shown(args.value(i))
    );
    args.fail(i, Code::WrongKind, words)
}

/// `shapes, plane, hidden, style`: the cut, seen against the normal of the plane.
fn section_of_shapes(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let subjects = subjects(evaluator, args)?;
    if !subjects.surfaces.is_empty() {
        return args.fail(0, Code::WrongKind, OPEN);
    }
    let (plane, side) = plane(args, 1)?;
    let projection = side.map_or(Projection::Direction(plane.normal), Projection::Side);
    let spec = ViewSpec {
        hidden: hidden(args, 2)?,
        style: style(args, 3)?,
        section: Some(plane),
        ..plain(evaluator, args, subjects, projection)
    };
    Ok(Value::Drawing(Arc::new(spec)))
}

/// A view with a change. The copy is counted, so that a long chain of changes has its limit.
fn changed(
    evaluator: &mut Evaluator,
    args: &Args,
    change: impl FnOnce(&mut ViewSpec),
) -> Outcome<Value> {
    let Value::Drawing(view) = args.value(0) else { return args.wrong(0, "a drawing") };
    let copied = view.shapes.len()
        + view.surfaces.len()
        + view.curves.len()
        + view.dims.len()
        + view.cuttings.len();
    evaluator.tick(copied as u64, args.call)?;
    let mut view = ViewSpec::clone(view);
    change(&mut view);
    Ok(Value::Drawing(Arc::new(view)))
}

fn section_of_view(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (plane, _) = plane(args, 1)?;
    if let Value::Drawing(view) = args.value(0) {
        if view.section.is_some() {
            return args.fail(0, Code::BadCall, "the view is a section already");
        }
        if !view.surfaces.is_empty() {
            return args.fail(0, Code::WrongKind, OPEN);
        }
    }
    changed(evaluator, args, |view| view.section = Some(plane))
}

fn center_lines(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    changed(evaluator, args, |view| view.center_lines = true)
}

/// `view, plane, name`.
fn cutting_line(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let ((plane, _), name) = (plane(args, 1)?, args.text(2)?.into());
    let place = Place(evaluator.shown_at(args.call));
    changed(evaluator, args, |view| view.cuttings.push(CuttingSpec { plane, name, place }))
}

/// `view, text`.
fn caption(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let text = args.text(1)?.into();
    changed(evaluator, args, |view| view.caption = Some(text))
}

/// A view with one dimension more, whose text is argument `text`.
fn dimensioned(
    evaluator: &mut Evaluator,
    args: &Args,
    text: usize,
    measured: Measured,
) -> Outcome<Value> {
    let text = if args.given(text) { Some(args.text(text)?.into()) } else { None };
    let place = Place(evaluator.shown_at(args.call));
    changed(evaluator, args, |view| view.dims.push(DimSpec { measured, text, place }))
}

/// `view, from, to, offset, along, text`.
fn dim_linear(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let points = vec![args.point(1)?, args.point(2)?];
    linear(evaluator, args, points, 3)
}

/// `view, chain, offset, along, text`.
fn dim_chain(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let items = evaluator.items(args.value(1), args.span(1))?;
    linear(evaluator, args, items.iter().filter_map(coordinates).collect(), 2)
}

fn linear(
    evaluator: &mut Evaluator,
    args: &Args,
    points: Vec<DVec3>,
    offset: usize,
) -> Outcome<Value> {
    if points.len() < 2 || points.windows(2).any(|pair| pair[0] == pair[1]) {
        return fail(
            Code::Degenerate,
            args.span(offset - 1),
            "a dimension needs points that differ",
        );
    }
    let along = if args.given(offset + 1) { Some(args.point(offset + 1)?) } else { None };
    if along == Some(DVec3::ZERO) {
        return args.degenerate(offset + 1, "must not be the zero vector");
    }
    let measured = Measured::Linear { points, along, offset: args.number(offset)? };
    dimensioned(evaluator, args, offset + 2, measured)
}

/// `view, radius or diameter, center, angle, text`.
fn dim_round(evaluator: &mut Evaluator, args: &Args, diameter: bool) -> Outcome<Value> {
    let r = args.positive(1)? / if diameter { 2.0 } else { 1.0 };
    let (center, angle) = (args.point(2)?, args.number(3)?);
    dimensioned(evaluator, args, 4, Measured::Round { center, r, diameter, angle })
}

/// `view, apex, from, to, r, text`.
fn dim_angle(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (apex, from, to) = (args.point(1)?, args.point(2)?, args.point(3)?);
    if from == apex || to == apex {
        return args.fail(1, Code::Degenerate, "an angle needs legs that leave its apex");
    }
    let r = args.positive(4)?;
    dimensioned(evaluator, args, 5, Measured::Angle { apex, from, to, r })
}
