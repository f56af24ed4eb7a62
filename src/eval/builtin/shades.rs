//! Half-tones: what is lit, by which light, and what its tones are made of.

use std::sync::Arc;

use glam::DVec3;

use super::{
    Args, Native, coordinates, point_value,
    views::{projection, style, subjects, window},
};
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
        DotShape, Screen,
        light::{HORIZON, SUNS},
    },
    shape::drawing::{Place, StyleSpec},
    shape::halftone::{ScreenSpec, ShadeSpec, SunSpec},
};

pub const TABLE: &[(&str, Native)] = &[("shade.of", shade), ("shade.sun", sun)];

/// `shapes, from, eye, target, fov, window, light, shadow, screen, lines, dpi`.
fn shade(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let subjects = subjects(evaluator, args)?;
    if !subjects.profiles.is_empty() || !subjects.curves.is_empty() {
        let words =
            "lines and plane figures have no light and shade; a picture needs solids and surfaces";
        return args.fail(0, Code::WrongKind, words);
    }
    let target = args.point(3)?;
    let suns = suns(args, 6)?;
    let spec = ShadeSpec {
        shapes: subjects.shapes,
        surfaces: subjects.surfaces,
        projection: projection(args, target)?,
        target,
        window: window(args)?,
        ground: ground(args, (6, 7), &suns)?,
        suns,
        screen: screen(args)?,
        lines: lines(args)?,
        dpi: args.positive(10)?,
        place: Place(evaluator.shown_at(args.call)),
    };
    Ok(Value::Picture(Arc::new(spec)))
}

/// `NONE`, or a style.
fn lines(args: &Args) -> Outcome<Option<StyleSpec>> {
    match args.value(9) {
        Value::Symbol(Symbol::None) => Ok(None),
        Value::Record(_) => style(args, 9).map(Some),
        other => {
            let words = format!("`lines` is a style such as {{}} or NONE, got {}", shown(other));
            args.fail(9, Code::WrongKind, words)
        }
    }
}

/// `toward, ambient, strength`.
fn sun(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let toward = args.point(0)?;
    if toward == DVec3::ZERO {
        return args.degenerate(0, "must not be the zero vector");
    }
    let ambient = args.number(1)?;
    if !(0.0..=1.0).contains(&ambient) {
        let words = format!("the ambient light is a share from 0 to 1, got {ambient}");
        return args.fail(1, Code::OutOfRange, words);
    }
    let strength = args.positive(2)?;
    let field = |name: &str, value: Value| (name.into(), value);
    Ok(Value::record(vec![
        field("sun", point_value(toward)),
        field("ambient", Value::bare(ambient)),
        field("strength", Value::bare(strength)),
    ]))
}

/// A light or a list of them.
pub(super) fn suns(args: &Args, i: usize) -> Outcome<Vec<SunSpec>> {
    let given: Vec<&Value> = match args.value(i) {
        Value::List(list) => list.iter().collect(),
        one => vec![one],
    };
    if given.is_empty() || given.len() > SUNS {
        let words = format!("a picture has 1 to {SUNS} lights, got {}", given.len());
        return args.fail(i, Code::OutOfRange, words);
    }
    let read = |value: &&Value| match sun_of(value) {
        Some(sun) => Ok(sun),
        None => {
            let words = format!("`light` is sun(d) or a list of such, got {}", shown(value));
            args.fail(i, Code::WrongKind, words)
        }
    };
    given.iter().map(read).collect()
}

fn sun_of(value: &Value) -> Option<SunSpec> {
    let Value::Record(record) = value else { return None };
    let number = |key: &str| match record.get(key) {
        Some(Value::Number(number, Dimension::BARE)) => Some(*number),
        _ => None,
    };
    let toward = record.get("sun").and_then(coordinates).filter(|d| *d != DVec3::ZERO)?;
    let ambient = number("ambient").filter(|share| (0.0..=1.0).contains(share))?;
    let strength = number("strength").filter(|strength| *strength > 0.0)?;
    Some(SunSpec { toward, ambient, strength })
}

/// `NONE`, or `ground(z)`: AUTO is the ground at 0 if the suns are above it.
pub(super) fn ground(
    args: &Args,
    (light, shadow): (usize, usize),
    suns: &[SunSpec],
) -> Outcome<Option<f64>> {
    let low = suns.iter().find(|sun| sun.toward.normalize().z <= HORIZON);
    match args.value(shadow) {
        Value::Symbol(Symbol::None) => return Ok(None),
        Value::Symbol(Symbol::Auto) => return Ok(Some(0.0).filter(|_| low.is_none())),
        Value::Record(record) => {
            if let Some(Value::Number(z, _)) = record.get("ground") {
                return match low {
                    None => Ok(Some(*z)),
                    Some(sun) => no_shadow(args, light, sun),
                };
            }
        }
        _ => {}
    }
    let words = format!("`shadow` is ground(z) or NONE, got {}", shown(args.value(shadow)));
    args.fail(shadow, Code::WrongKind, words)
}

fn no_shadow(args: &Args, light: usize, sun: &SunSpec) -> Outcome<Option<f64>> {
    let how = if sun.toward.normalize().z < -HORIZON { "from below" } else { "parallel to" };
    let d = Value::list(sun.toward.to_array().map(Value::bare).to_vec());
    let words = format!("the light from {d} comes {how} the ground; it casts no shadow there");
    let error = Diagnostic::error(Code::Degenerate, words).label(args.span(light), "");
    let help =
        "give the sun a direction with a z above 0, or leave the ground out: `shadow = NONE`";
    Err(error.help(help).into())
}

/// `GREY`, or a record that says which screen it is.
fn screen(args: &Args) -> Outcome<ScreenSpec> {
    let found = match args.value(8) {
        Value::Symbol(Symbol::Grey) => Some(ScreenSpec::Grey),
        Value::Record(record) => {
            if let Some(Value::Number(pitch, _)) = record.get("pitch")
                && *pitch <= 0.0
            {
                let words = format!("the pitch of the screen must be greater than 0, got {pitch}");
                return args.fail(8, Code::Degenerate, words);
            }
            screen_of(record)
        }
        _ => None,
    };
    if let Some(screen) = found {
        return Ok(screen);
    }
    let words = format!(
        "`screen` is GREY, dots(), lines(), hatch(), stipple(), diffusion() or overstrike(), got {}",
        shown(args.value(8))
    );
    args.fail(8, Code::WrongKind, words)
}

fn screen_of(record: &Record) -> Option<ScreenSpec> {
    let number = |key: &str| match record.get(key) {
        Some(Value::Number(number, _)) => Some(*number),
        _ => None,
    };
    let Some(Value::Text(name)) = record.get("screen") else { return None };
    if &***name == "overstrike" {
        return number("levels").map(|levels| ScreenSpec::Overstrike { levels: levels as u32 });
    }
    let pitch = number("pitch")?;
    Some(ScreenSpec::Ink(match &***name {
        "dots" => {
            let shape = dot_shape(record.get("shape"))?;
            Screen::Dots { pitch, angle: number("angle")?, shape }
        }
        "lines" => Screen::Lines { pitch, angle: number("angle")? },
        "hatch" => Screen::Hatch { pitch, angle: number("angle")? },
        "stipple" => Screen::Stipple { pitch, seed: number("seed")? as u64 },
        "diffusion" => {
            let atkinson = matches!(record.get("atkinson"), Some(Value::Bool(true)));
            Screen::Diffusion { side: pitch, atkinson }
        }
        _ => return None,
    }))
}

fn dot_shape(value: Option<&Value>) -> Option<DotShape> {
    let Some(Value::Symbol(symbol)) = value else { return None };
    Some(match symbol {
        Symbol::Round => DotShape::Round,
        Symbol::Ellipse => DotShape::Ellipse,
        Symbol::Square => DotShape::Square,
        Symbol::Diamond => DotShape::Diamond,
        Symbol::Line => DotShape::Line,
        _ => return None,
    })
}
