//! From the engine's edges back to contours: simple loops, nested, in a fixed order.

use i_overlay::vector::edge::{DataVectorEdge, DataVectorShape};
use rustc_hash::FxHashMap;

use super::{
    Source,
    grid::{Grid, GridPoint},
};
use crate::geom::region::{Contour, EdgeCurve, Piece, Region};

/// A corner of a loop and the number of the given edge that the edge leaving it is a part of.
#[derive(Clone, Copy)]
struct Corner {
    at: GridPoint,
    source: usize,
}

type Loop = Vec<Corner>;

/// The region the engine's shapes describe.
pub(super) fn region(grid: &Grid, shapes: Vec<DataVectorShape<i64, Source>>) -> Region {
    let mut pieces: Vec<Piece> =
        shapes.iter().flat_map(|shape| shape_pieces(grid, shape)).collect();
    pieces.sort_by(|p, q| order(&p.outer, &q.outer));
    Region { pieces }
}

fn shape_pieces(grid: &Grid, shape: &[Vec<DataVectorEdge<i64, Source>>]) -> Vec<Piece> {
    let loops = shape.iter().flat_map(|edges| simple_loops(edges));
    let loops = loops.map(|l| straightened(grid, l)).filter(is_wide);
    let (outers, holes): (Vec<Loop>, Vec<Loop>) = loops.partition(|l| double_area(l) > 0);
    let contour = |l: &Loop| contour(grid, l);
    let mut pieces: Vec<Piece> =
        outers.iter().map(|l| Piece { outer: contour(l), holes: vec![] }).collect();
    for hole in &holes {
        if let Some(home) = home(&outers, hole) {
            pieces[home].holes.push(contour(hole));
        }
    }
    for piece in &mut pieces {
        piece.holes.sort_by(order);
    }
    pieces
}

/// Cuts a closed walk at the corners it visits twice.
fn simple_loops(edges: &[DataVectorEdge<i64, Source>]) -> Vec<Loop> {
    let (mut loops, mut open): (Vec<Loop>, Loop) = (vec![], vec![]);
    let mut visited: FxHashMap<(i64, i64), usize> = FxHashMap::default();
    for edge in edges {
        let at = edge.a;
        if let Some(&start) = visited.get(&(at.x, at.y)) {
            let closed: Loop = open.drain(start..).collect();
            for corner in &closed[1..] {
                visited.remove(&(corner.at.x, corner.at.y));
            }
            loops.push(closed);
        }
        visited.insert((at.x, at.y), open.len());
        open.push(Corner { at, source: edge.data.0 as usize });
    }
    loops.push(open);
    loops
}

/// Leaves out the corners within one given edge, and those in a straight line of straight edges.
fn straightened(grid: &Grid, mut corners: Loop) -> Loop {
    let is_line = |c: Corner| grid.edges[c.source].curve == EdgeCurve::Line;
    let mut kept: Loop = Vec::with_capacity(corners.len());
    corners.push(corners[0]);
    corners.push(corners[1 % corners.len()]);
    let through = |a: Corner, b: Corner, next: GridPoint| {
        let straight = cross(a.at, b.at, next) == 0 && is_line(a) && is_line(b);
        (a.source == b.source || straight) && dot(a.at, b.at, next) > 0
    };
    for i in 0..corners.len() - 2 {
        let (here, next) = (corners[i], corners[i + 1]);
        let before = kept.last().copied().unwrap_or(corners[corners.len() - 3]);
        if before.at == here.at || !through(before, here, next.at) {
            kept.push(here);
        }
    }
    kept
}

/// Whether a loop is more than a sliver as thin as the grid.
fn is_wide(corners: &Loop) -> bool {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let length: i128 = edges
        .map(|(p, q)| i128::from((p.at.x - q.at.x).abs()) + i128::from((p.at.y - q.at.y).abs()))
        .sum();
    corners.len() >= 3 && double_area(corners).abs() > length
}

fn contour(grid: &Grid, corners: &Loop) -> Contour {
    let n = corners.len();
    let start = (0..n).min_by_key(|&i| (corners[i].at.x, corners[i].at.y)).unwrap_or(0);
    let turn = (0..n).map(|i| (start + i) % n);
    let point = |i: usize| {
        let before = corners[(i + n - 1) % n].source;
        grid.coordinates(corners[i].at, before, corners[i].source)
    };
    Contour {
        points: turn.clone().map(point).collect(),
        curves: turn.map(|i| grid.edges[corners[i].source].curve).collect(),
    }
}

/// The outer loop that a hole lies in.
fn home(outers: &[Loop], hole: &Loop) -> Option<usize> {
    if outers.len() == 1 {
        return Some(0);
    }
    // Twice the middle of an edge: no other loop passes through it.
    let (a, b) = (hole[0].at, hole[1].at);
    let middle = GridPoint { x: a.x + b.x, y: a.y + b.y };
    let inside = (0..outers.len()).filter(|&i| encloses(&outers[i], middle));
    inside.min_by_key(|&i| double_area(&outers[i]))
}

/// Whether half of `doubled` lies in a loop, by the parity of a ray to the right.
fn encloses(corners: &Loop, doubled: GridPoint) -> bool {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let twice = |p: GridPoint| GridPoint { x: 2 * p.x, y: 2 * p.y };
    let crossed = edges.map(|(p, q)| (twice(p.at), twice(q.at))).filter(|&(p, q)| {
        let (low, high) = if p.y < q.y { (p, q) } else { (q, p) };
        low.y <= doubled.y && doubled.y < high.y && cross(low, high, doubled) > 0
    });
    crossed.count() % 2 == 1
}

fn double_area(corners: &Loop) -> i128 {
    let base = corners[0].at;
    corners.windows(2).map(|w| cross(base, w[0].at, w[1].at)).sum()
}

/// Twice the area of the triangle a b c.
fn cross(a: GridPoint, b: GridPoint, c: GridPoint) -> i128 {
    i128::from(b.x - a.x) * i128::from(c.y - a.y) - i128::from(b.y - a.y) * i128::from(c.x - a.x)
}

/// Positive if the way from `a` over `b` to `c` does not turn back.
fn dot(a: GridPoint, b: GridPoint, c: GridPoint) -> i128 {
    i128::from(b.x - a.x) * i128::from(c.x - b.x) + i128::from(b.y - a.y) * i128::from(c.y - b.y)
}

/// By the coordinates of the corners.
fn order(a: &Contour, b: &Contour) -> std::cmp::Ordering {
    let key = |c: &Contour| c.points.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>();
    key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal)
}
