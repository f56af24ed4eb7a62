//! Surfaces: graphs of functions, grids of points, height maps, and solids made of them.

use std::sync::Arc;

use glam::{DVec3, dvec3};

use super::{Args, Native, coordinates};
use crate::{
    base::Code,
    eval::{
        dimension::Dimension,
        evaluator::Evaluator,
        failure::Outcome,
        types::shown,
        value::{Surface, Value, number_text},
    },
    geom::{CurvedGrid, GridError, curved_grid::MOST_POINTS, overlay::REACH},
    shape::Node,
};

pub const TABLE: &[(&str, Native)] = &[
    ("surface.graph", graph),
    ("surface.grid", grid),
    ("surface.heightmap", heightmap),
    ("surface.join", join),
    ("surface.thicken", thicken),
    ("surface.solid", solid),
];

/// A surface through points in rows.
fn surface(
    evaluator: &mut Evaluator,
    args: &Args,
    rows: &[Vec<DVec3>],
    closed: [bool; 2],
) -> Outcome<Value> {
    let made = CurvedGrid::new(rows, closed[0], closed[1]).or_else(|error| {
        let code = match error {
            GridError::Many { .. } => Code::Limit,
            _ => Code::Degenerate,
        };
        args.fail(0, code, error.to_string())
    })?;
    keep(evaluator, args, made)
}

/// The value of a surface; its points count.
pub(super) fn keep(evaluator: &mut Evaluator, args: &Args, grid: CurvedGrid) -> Outcome<Value> {
    let count = grid.points().len();
    evaluator.tick(count as u64, args.call)?;
    evaluator.room(count * Surface::VALUES_A_POINT, args.call)?;
    Ok(Value::Surface(Arc::new(Surface::new(grid))))
}

/// Cells along x and y: one number or two.
fn cells(args: &Args, i: usize) -> Outcome<[usize; 2]> {
    let whole = |value: &Value| match value {
        Value::Number(n, Dimension::BARE) if *n >= 1.0 && n.fract() == 0.0 => Some(*n),
        _ => None,
    };
    let found = match args.value(i) {
        Value::List(list) if list.len() == 2 => whole(&list[0]).zip(whole(&list[1])),
        value => whole(value).map(|n| (n, n)),
    };
    let Some((nx, ny)) = found else {
        let words = format!(
            "`{}` is a whole number of cells, 1 or more, or [nx, ny], got {}",
            args.name(i),
            shown(args.value(i))
        );
        return args.fail(i, Code::OutOfRange, words);
    };
    let count = (nx + 1.0) * (ny + 1.0);
    if count > MOST_POINTS as f64 {
        return many(args, i, count);
    }
    Ok([nx as usize, ny as usize])
}

fn many<T>(args: &Args, i: usize, count: f64) -> Outcome<T> {
    let words = format!("the surface would have {count} points; the limit is {MOST_POINTS}");
    args.fail(i, Code::Limit, words)
}

/// So many equal parts of a way, ends included.
fn parted(from: f64, to: f64, n: usize) -> Vec<f64> {
    let at = |i| if i == n { to } else { from + (to - from) * i as f64 / n as f64 };
    (0..=n).map(at).collect()
}

/// The places of grid lines along an axis.
fn places(args: &Args, i: usize, n: usize) -> Outcome<Vec<f64>> {
    let is_length = |dimension| matches!(dimension, Dimension::BARE | Dimension::LENGTH);
    let ends = match args.value(i) {
        Value::Range(range) if is_length(range.dimension) => {
            if range.explicit && range.count() > MOST_POINTS as u64 {
                return many(args, i, range.count() as f64);
            }
            if range.explicit {
                let elements = (0..range.count()).map(|k| range.element(k));
                let number = |value| match value {
                    Value::Number(number, _) => number,
                    _ => f64::NAN,
                };
                return growing(args, i, elements.map(number).collect());
            }
            Some((range.start, range.end))
        }
        value @ Value::List(list) if list.len() == 2 => coordinates(value).map(|p| (p.x, p.y)),
        _ => None,
    };
    match ends {
        Some((from, to)) => growing(args, i, parted(from, to, n)),
        None => {
            let words = format!(
                "`{}` is a range of lengths such as -10mm..10mm, got {}",
                args.name(i),
                shown(args.value(i))
            );
            args.fail(i, Code::WrongKind, words)
        }
    }
}

/// Places that grow and lie within reach.
fn growing(args: &Args, i: usize, places: Vec<f64>) -> Outcome<Vec<f64>> {
    if places.len() < 2 || !places.windows(2).all(|p| p[0] < p[1]) {
        return args.degenerate(i, "must run from a smaller to a larger length");
    }
    if places.iter().any(|p| p.abs() > REACH) {
        let words = format!("`{}` must lie between -{REACH:e}mm and {REACH:e}mm", args.name(i));
        return args.fail(i, Code::OutOfRange, words);
    }
    Ok(places)
}

/// `f, x, y, n`.
fn graph(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let [nx, ny] = cells(args, 3)?;
    let (x, y) = (places(args, 1, nx)?, places(args, 2, ny)?);
    let count = x.len() as f64 * y.len() as f64;
    if count > MOST_POINTS as f64 {
        return many(args, 1, count);
    }
    evaluator.room(x.len() * y.len() * Surface::VALUES_A_POINT, args.call)?;
    let mut rows = Vec::with_capacity(x.len());
    for &x in &x {
        let mut row = Vec::with_capacity(y.len());
        for &y in &y {
            row.push(dvec3(x, y, height(evaluator, args, x, y)?));
        }
        rows.push(row);
    }
    surface(evaluator, args, &rows, [false; 2])
}

/// What the function of a graph gives at a point.
fn height(evaluator: &mut Evaluator, args: &Args, x: f64, y: f64) -> Outcome<f64> {
    let at = || format!("x = {}mm, y = {}mm", number_text(x), number_text(y));
    let point = [Value::length(x), Value::length(y)];
    let found = evaluator.call_with(args, args.value(0), &point, args.span(0));
    let found = found.map_err(|failure| {
        failure.map(|error| error.note(format!("the function of the graph failed at {}", at())))
    })?;
    match found {
        Value::Number(z, Dimension::BARE | Dimension::LENGTH) if z.abs() <= REACH => Ok(z),
        Value::Number(z, Dimension::BARE | Dimension::LENGTH) => {
            let words = format!(
                "the function gives {}mm at {}; heights lie between -{REACH:e}mm and {REACH:e}mm",
                number_text(z),
                at()
            );
            args.fail(0, Code::OutOfRange, words)
        }
        other => {
            let words = format!(
                "the function of a graph must give a length, got {} at {}",
                shown(&other),
                at()
            );
            args.fail(0, Code::WrongKind, words)
        }
    }
}

/// `a, b, smooth`.
fn join(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (Value::Surface(a), Value::Surface(b)) = (args.value(0), args.value(1)) else {
        return args.wrong(0, "a surface");
    };
    let smooth = matches!(args.value(2), Value::Bool(true));
    match a.grid().joined(b.grid(), smooth) {
        Ok(grid) => keep(evaluator, args, grid),
        Err(error) => args.fail(1, Code::Degenerate, error.to_string()),
    }
}

/// `points, closed_u, closed_v`.
fn grid(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let lists = evaluator.items(args.value(0), args.span(0))?;
    let mut rows: Vec<Vec<DVec3>> = Vec::with_capacity(lists.len());
    for list in lists.iter() {
        let points = evaluator.items(list, args.span(0))?;
        evaluator.tick(points.len() as u64, args.call)?;
        rows.push(points.iter().filter_map(coordinates).collect());
    }
    let closed = [1, 2].map(|i| matches!(args.value(i), Value::Bool(true)));
    surface(evaluator, args, &rows, closed)
}

/// `path, size, n`.
fn heightmap(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let file = evaluator.relative(args.caller.unit, args.text(0)?, args.span(0))?;
    let mut size = args.point(1)?;
    if matches!(args.value(1), Value::List(list) if list.len() == 2) {
        size.z = 1.0;
    }
    if size.min_element() <= 0.0 {
        return args.degenerate(1, "must be greater than 0 along x, y and z");
    }
    let given = if args.given(2) { Some(cells(args, 2)?) } else { None };
    let map = evaluator.ask(args.span(0), |host, _| host.heights(&file))?;
    let [nx, ny] = given.unwrap_or(map.size().map(|n| n - 1));
    let count = (nx + 1) as f64 * (ny + 1) as f64;
    if count > MOST_POINTS as f64 {
        let words = format!(
            "the file holds {count} heights; a surface has at most {MOST_POINTS} points: give `n`"
        );
        return args.fail(0, Code::Limit, words);
    }
    let point = |i: usize, j: usize| {
        let [s, t] = [i as f64 / nx as f64, j as f64 / ny as f64];
        dvec3(size.x * (s - 0.5), size.y * (t - 0.5), size.z * map.at(s, 1.0 - t))
    };
    let row = |i: usize| (0..=ny).map(|j| point(i, j)).collect();
    let rows: Vec<Vec<DVec3>> = (0..=nx).map(row).collect();
    if let Some(p) = rows.iter().flatten().find(|p| p.z.abs() > REACH) {
        let words = format!("the map reaches to z = {}mm, beyond {REACH:e}mm", number_text(p.z));
        return args.fail(0, Code::OutOfRange, words);
    }
    surface(evaluator, args, &rows, [false; 2])
}

fn thicken(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let Value::Surface(surface) = args.value(0) else { return args.wrong(0, "a surface") };
    let (surface, t) = (surface.grid().clone(), args.positive(1)?);
    Ok(Value::Solid(evaluator.add_node(Node::Thickened { surface, t }, args.call)))
}

fn solid(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let Value::Surface(surface) = args.value(0) else { return args.wrong(0, "a surface") };
    let base = if args.given(1) { Some(args.number(1)?) } else { None };
    let node = Node::Filled { surface: surface.grid().clone(), base };
    Ok(Value::Solid(evaluator.add_node(node, args.call)))
}
