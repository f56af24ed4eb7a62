//! Functions on numbers and vectors.

use super::{Args, Native, coordinates};
use crate::{
    base::{Code, Span},
    eval::{
        dimension::Dimension,
        evaluator::Evaluator,
        failure::{Outcome, fail},
        interpret::arithmetic::{Operands, clash},
        stack::deep,
        types::shown,
        value::Value,
    },
    geom::trig,
    syntax::ast::BinaryOp,
};

pub const TABLE: &[(&str, Native)] = &[
    ("constant.pi", |_, _| Ok(Value::bare(std::f64::consts::PI))),
    ("constant.tau", |_, _| Ok(Value::bare(std::f64::consts::TAU))),
    ("math.sin", |_, a| Ok(Value::bare(trig::sin_deg(a.number(0)?)))),
    ("math.cos", |_, a| Ok(Value::bare(trig::cos_deg(a.number(0)?)))),
    ("math.tan", tan),
    ("math.asin", |_, a| Ok(angle(trig::asin_deg(unit_interval(a)?)))),
    ("math.acos", |_, a| Ok(angle(trig::acos_deg(unit_interval(a)?)))),
    ("math.atan", |_, a| Ok(angle(trig::atan_deg(a.number(0)?)))),
    ("math.atan2", atan2),
    ("math.sqrt", sqrt),
    ("math.abs", |_, a| keep(a, f64::abs)),
    ("math.round", |_, a| keep(a, f64::round)),
    ("math.floor", |_, a| keep(a, f64::floor)),
    ("math.ceil", |_, a| keep(a, f64::ceil)),
    ("math.sign", |_, a| Ok(Value::bare(sign(a.number(0)?)))),
    ("math.ln", |_, a| Ok(Value::bare(libm::log(above_zero(a, 0)?)))),
    ("math.log", |_, a| Ok(Value::bare(libm::log10(above_zero(a, 0)?)))),
    ("math.log.base", log_base),
    ("math.exp", |_, a| finite(a, libm::exp(a.number(0)?), Dimension::BARE)),
    ("math.min", |e, a| extreme(e, a, BinaryOp::Less)),
    ("math.max", |e, a| extreme(e, a, BinaryOp::Greater)),
    ("math.clamp", clamp),
    ("math.lerp", lerp),
    ("math.mod", modulo),
    ("math.norm", norm),
    ("math.dot", dot),
    ("math.cross", cross),
    ("math.near", near),
];

fn angle(degrees: f64) -> Value {
    Value::Number(degrees, Dimension::ANGLE)
}

fn keep(args: &Args, change: fn(f64) -> f64) -> Outcome<Value> {
    let (value, dimension) = args.quantity(0)?;
    Ok(Value::Number(change(value), dimension))
}

fn finite(args: &Args, value: f64, dimension: Dimension) -> Outcome<Value> {
    if value.is_finite() {
        return Ok(Value::Number(value, dimension));
    }
    fail(Code::Arithmetic, args.call, "the result is too large for a number (infinite)")
}

fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

fn tan(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let degrees = args.number(0)?;
    if trig::cos_deg(degrees) == 0.0 {
        return args.fail(
            0,
            Code::Arithmetic,
            format!("the tangent of {} is infinite", args.value(0)),
        );
    }
    Ok(Value::bare(trig::tan_deg(degrees)))
}

fn unit_interval(args: &Args) -> Outcome<f64> {
    let value = args.number(0)?;
    if (-1.0..=1.0).contains(&value) {
        return Ok(value);
    }
    args.fail(0, Code::Arithmetic, format!("needs a number from -1 to 1, got {}", args.value(0)))
}

fn above_zero(args: &Args, i: usize) -> Outcome<f64> {
    match args.number(i)? {
        value if value > 0.0 => Ok(value),
        _ => args.fail(
            i,
            Code::Arithmetic,
            format!("a logarithm needs a number above 0, got {}", args.value(i)),
        ),
    }
}

fn atan2(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let ((y, a), (x, b)) = (args.quantity(0)?, args.quantity(1)?);
    common(args, a, b)?;
    if x == 0.0 && y == 0.0 {
        return args.fail(0, Code::Arithmetic, "the angle of the zero vector is not defined");
    }
    Ok(angle(trig::atan2_deg(y, x)))
}

fn common(args: &Args, a: Dimension, b: Dimension) -> Outcome<Dimension> {
    let at = (args.span(0), args.span(1));
    a.common(b).ok_or_else(|| clash(a, b, at, "the arguments"))
}

fn sqrt(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (value, dimension) = args.quantity(0)?;
    if value < 0.0 {
        return args.fail(
            0,
            Code::Arithmetic,
            format!("the square root of a negative number: {}", args.value(0)),
        );
    }
    match dimension.root() {
        Some(root) => Ok(Value::Number(value.sqrt(), root)),
        None => args.fail(0, Code::Dimension, format!("{} has no square root", dimension.words())),
    }
}

fn log_base(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (value, base) = (above_zero(args, 0)?, above_zero(args, 1)?);
    if base == 1.0 {
        return args.fail(1, Code::Arithmetic, "there is no logarithm to base 1");
    }
    Ok(Value::bare(libm::log(value) / libm::log(base)))
}

/// The smallest or largest of a list, or of all arguments.
fn extreme(evaluator: &mut Evaluator, args: &Args, op: BinaryOp) -> Outcome<Value> {
    let (items, spans): (Vec<Value>, Vec<Span>) = match args.values {
        [list] => {
            let items = evaluator.items(list, args.span(0))?;
            (items.to_vec(), vec![args.span(0); items.len()])
        }
        values => (values.to_vec(), args.spans.to_vec()),
    };
    evaluator.tick(items.len() as u64, args.call)?;
    let mut pairs = items.into_iter().zip(spans);
    let Some((mut best, mut at)) = pairs.next() else {
        return args.fail(0, Code::OutOfRange, "the list is empty");
    };
    for (item, span) in pairs {
        let places = Operands { whole: args.call, left: span, right: at };
        if let Value::Bool(true) = evaluator.order(op, &item, &best, places)? {
            (best, at) = (carry_dimension(item, &best), span);
        } else {
            best = carry_dimension(best, &item);
        }
    }
    Ok(best)
}

/// A bare number that was compared with a length is a length.
fn carry_dimension(value: Value, beside: &Value) -> Value {
    match (&value, beside) {
        (Value::Number(number, a), Value::Number(_, b)) => match a.common(*b) {
            Some(common) => Value::Number(*number, common),
            None => value,
        },
        _ => value,
    }
}

fn clamp(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let ((x, a), (low, b), (high, c)) = (args.quantity(0)?, args.quantity(1)?, args.quantity(2)?);
    let dimension = common(args, common(args, a, b)?, c)?;
    if low > high {
        let words = format!(
            "the bounds are the wrong way round: {} is above {}",
            args.value(1),
            args.value(2)
        );
        return args.fail(1, Code::OutOfRange, words);
    }
    Ok(Value::Number(x.clamp(low, high), dimension))
}

fn lerp(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let at = Operands { whole: args.call, left: args.span(0), right: args.span(1) };
    let t = args.value(2).clone();
    let (a, b) = (args.value(0).clone(), args.value(1).clone());
    let share = Value::bare(1.0 - args.number(2)?);
    let a = evaluator.binary(BinaryOp::Multiply, a, share, at)?;
    let b = evaluator.binary(BinaryOp::Multiply, b, t, at)?;
    evaluator.binary(BinaryOp::Add, a, b, at)
}

/// The remainder with the sign of the divisor.
fn modulo(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let ((x, a), (y, b)) = (args.quantity(0)?, args.quantity(1)?);
    let dimension = common(args, a, b)?;
    if y == 0.0 {
        return args.fail(1, Code::Arithmetic, "division by zero");
    }
    let rest = x % y;
    let rest = if rest != 0.0 && (rest < 0.0) != (y < 0.0) { rest + y } else { rest };
    Ok(Value::Number(rest, dimension))
}

/// The numbers of a list, all of one dimension.
fn numbers(evaluator: &mut Evaluator, args: &Args, i: usize) -> Outcome<(Vec<f64>, Dimension)> {
    let items = evaluator.items(args.value(i), args.span(i))?;
    let mut dimension = Dimension::BARE;
    let mut numbers = Vec::with_capacity(items.len());
    for item in items.iter() {
        let Value::Number(value, found) = item else {
            let words = format!("`{}` needs numbers, got {}", args.name(i), shown(item));
            return args.fail(i, Code::WrongKind, words);
        };
        let at = (args.span(i), args.span(i));
        dimension = dimension
            .common(*found)
            .or((numbers.is_empty()).then_some(*found))
            .ok_or_else(|| clash(dimension, *found, at, "a vector"))?;
        numbers.push(*value);
    }
    Ok((numbers, dimension))
}

fn norm(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (v, dimension) = numbers(evaluator, args, 0)?;
    let largest = v.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if largest == 0.0 {
        return Ok(Value::Number(0.0, dimension));
    }
    let direct: f64 = v.iter().map(|x| x * x).sum();
    let normal = direct.is_finite() && direct > f64::MIN_POSITIVE;
    let length = if normal {
        direct.sqrt()
    } else {
        largest * v.iter().map(|x| (x / largest) * (x / largest)).sum::<f64>().sqrt()
    };
    finite(args, length, dimension)
}

fn dot(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let ((u, a), (v, b)) = (numbers(evaluator, args, 0)?, numbers(evaluator, args, 1)?);
    if u.len() != v.len() {
        let words = format!("vectors of {} and {} numbers", u.len(), v.len());
        return args.fail(1, Code::WrongKind, words);
    }
    let sum = u.iter().zip(&v).map(|(x, y)| x * y).sum();
    match a.times(b) {
        Some(dimension) => finite(args, sum, dimension),
        None => args.fail(0, Code::Dimension, "the exponent of a dimension is too large"),
    }
}

fn cross(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let dimension = |i: usize| match args.value(i) {
        Value::List(list) => list.iter().find_map(|item| match item {
            Value::Number(_, dimension) if *dimension != Dimension::BARE => Some(*dimension),
            _ => None,
        }),
        _ => None,
    };
    let (u, v) = (coordinates(args.value(0)), coordinates(args.value(1)));
    let (Some(u), Some(v)) = (u, v) else {
        return args.fail(0, Code::WrongKind, "the cross product needs two vectors");
    };
    let (a, b) = (dimension(0).unwrap_or_default(), dimension(1).unwrap_or_default());
    let Some(dimension) = a.times(b) else {
        return args.fail(0, Code::Dimension, "the exponent of a dimension is too large");
    };
    let product = u.cross(v).to_array();
    product.iter().try_for_each(|x| finite(args, *x, dimension).map(|_| ()))?;
    Ok(Value::list(product.map(|x| Value::Number(x, dimension)).to_vec()))
}

fn near(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let tolerance = args.not_negative(2)?;
    is_near(evaluator, args, args.value(0), args.value(1), tolerance).map(Value::Bool)
}

/// Numbers within `tolerance`, relative above 1 and absolute below; lists element by element;
/// other values equal.
fn is_near(
    evaluator: &mut Evaluator,
    args: &Args,
    a: &Value,
    b: &Value,
    tolerance: f64,
) -> Outcome<bool> {
    let at = (args.span(0), args.span(1));
    match (a, b) {
        (Value::Number(a, x), Value::Number(b, y)) => {
            x.common(*y).ok_or_else(|| clash(*x, *y, at, "`near`"))?;
            Ok((a - b).abs() <= tolerance * a.abs().max(b.abs()).max(1.0))
        }
        _ => match (a.count(), b.count()) {
            (Some(n), Some(m)) if n == m => {
                evaluator.tick(n, args.call)?;
                for i in 0..n {
                    let (Some(a), Some(b)) = (a.element(i), b.element(i)) else { return Ok(false) };
                    if !deep(|| is_near(evaluator, args, &a, &b, tolerance))? {
                        return Ok(false);
                    }
                }
                Ok(true)
            }
            (Some(_), Some(_)) => Ok(false),
            _ => {
                let places = Operands { whole: args.call, left: at.0, right: at.1 };
                evaluator.equal(a, b, places)
            }
        },
    }
}
