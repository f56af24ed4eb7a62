//! Warnings about shapes that were made but are perhaps not what was meant.

use super::{Realizer, Solid, failure::Made, paint::Paint, structure::operands, unwrap};
use crate::{
    base::{Code, Diagnostic},
    geom::{Placement, Stretch},
    shape::{Node, ShapeGraph, ShapeId, Stretched},
};

use glam::DVec3;

/// Two corners of a box.
type Bounds = [DVec3; 2];

/// How many leaves are looked at to find a box for a warning.
const MOST_STEPS: usize = 1 << 16;

/// What is to be said about a shape that was made.
pub fn warnings(realizer: &Realizer, graph: &ShapeGraph, id: ShapeId) -> Vec<Diagnostic> {
    let Ok(solid) = realizer.solid(graph, id) else { return vec![] };
    let snap = large_snap(realizer, graph, id, &solid);
    let lost = solid.lost.filter(|_| solid.crossing.is_none()).map(|at| too_far(graph, id, at));
    let crossing = solid.crossing.map(|place| crosses(graph, id, place)).or(lost);
    let empty = if solid.polyhedron.is_empty() { empty_cut(realizer, graph, id) } else { None };
    empty.into_iter().chain(snap).chain(crossing).collect()
}

/// The warning for a part that is empty after a cut, with the boxes of what was cut and of what cut it.
/// `None` where it is empty by the modeller's word.
fn empty_cut(realizer: &Realizer, graph: &ShapeGraph, id: ShapeId) -> Option<Diagnostic> {
    let cut = first_cut(graph, id)?;
    if let Node::Offset { child, .. } | Node::Fillet { child, .. } = graph.node(cut) {
        return empty_core(realizer, graph, cut, *child);
    }
    let list = operands(graph.node(cut))?;
    let (first, rest) = list.split_first()?;
    let around = |ids: &[ShapeId]| {
        let boxes = ids.iter().filter_map(|&id| reach(realizer, graph, id).ok().flatten());
        boxes.reduce(joined).map_or_else(|| "nothing".to_string(), words)
    };
    let diagnostic = nothing_left(graph, cut, "part is empty after a cut")
        .note(format!("the first operand lies in {}", around(&[*first])))
        .note(format!("the others lie in {}", around(rest)));
    Some(diagnostic)
}

/// The warning that nothing is left of a shape.
fn nothing_left(graph: &ShapeGraph, id: ShapeId, words: &str) -> Diagnostic {
    Diagnostic::warning(Code::EmptyResult, words).label(graph.origin(id), "nothing is left of this")
}

/// The warning for a shape of which shrinking or rounding leaves nothing, with the box of what it was.
fn empty_core(
    realizer: &Realizer,
    graph: &ShapeGraph,
    id: ShapeId,
    child: ShapeId,
) -> Option<Diagnostic> {
    let before = reach(realizer, graph, child).ok().flatten()?;
    let words = match graph.node(id) {
        Node::Offset { .. } => "part is empty after shrinking",
        _ => "part is empty after rounding",
    };
    Some(nothing_left(graph, id, words).note(format!("the solid lies in {}", self::words(before))))
}

/// The warning for corners that rounding moved by more than the tolerance.
fn large_snap(
    realizer: &Realizer,
    graph: &ShapeGraph,
    id: ShapeId,
    solid: &Solid,
) -> Option<Diagnostic> {
    let tolerance = realizer.tolerance().mm();
    (solid.snap > tolerance).then(|| {
        let words = format!("set operations moved corners by up to {:.3e} mm", solid.snap);
        Diagnostic::warning(Code::Snap, words)
            .label(graph.origin(id), "")
            .note(format!("the tolerance is {tolerance} mm"))
            .help("keep far-away parts out of one set operation, or move the model to the origin")
    })
}

/// The warning for a boundary that rounding has made cross itself.
fn crosses(graph: &ShapeGraph, id: ShapeId, DVec3 { x, y, z }: DVec3) -> Diagnostic {
    let words = "the boundary crosses itself by less than rounding can tell apart";
    Diagnostic::warning(Code::Snap, words)
        .label(graph.origin(id), "")
        .note(format!("near [{x}, {y}, {z}] mm of its set operation"))
        .help("let faces that nearly coincide coincide, or keep them farther apart")
}

/// The warning for a solid whose features are finer than coordinates where it stands.
fn too_far(graph: &ShapeGraph, id: ShapeId, DVec3 { x, y, z }: DVec3) -> Diagnostic {
    let words = "the boundary has features too fine for coordinates where it stands";
    Diagnostic::warning(Code::Snap, words)
        .label(graph.origin(id), "")
        .note(format!("near [{x}, {y}, {z}] mm faces have met or become flat"))
        .help("move the model to the origin, or make it larger")
}

/// The outermost operation of a shape that takes something away.
fn first_cut(graph: &ShapeGraph, id: ShapeId) -> Option<ShapeId> {
    let mut open = vec![id];
    let mut seen = rustc_hash::FxHashSet::default();
    while let Some(id) = open.pop() {
        if !seen.insert(id) {
            continue;
        }
        match graph.node(id) {
            Node::Difference(_)
            | Node::Intersection(_)
            | Node::Offset { .. }
            | Node::Fillet { .. } => return Some(id),
            Node::Union(list) => open.extend(list.iter().rev()),
            node => open.extend(super::structure::wrapped(node)),
        }
    }
    None
}

/// A box that holds a shape, not smaller for what is cut off; `None` if it is empty or has too many
/// copies of its leaves to look at.
fn reach(realizer: &Realizer, graph: &ShapeGraph, id: ShapeId) -> Made<Option<Bounds>> {
    let mut open = vec![(id, Placement::IDENTITY)];
    let mut whole: Option<Bounds> = None;
    for _ in 0..MOST_STEPS {
        let Some((id, outer)) = open.pop() else { return Ok(whole) };
        let found = unwrap(graph, id, Paint::default())?;
        let placement = outer.after(&found.placement);
        match graph.node(found.core) {
            Node::Union(list) => open.extend(list.iter().map(|&id| (id, placement))),
            Node::Difference(list) | Node::Intersection(list) => {
                open.extend(list.first().map(|&id| (id, placement)));
            }
            _ => {
                let stretch = Stretch::of(placement.linear());
                let solid = realizer.solid_under(graph, Stretched { id: found.core, stretch })?;
                let corners = solid.polyhedron.mesh().points.iter().map(|p| placement.point(*p));
                let here = corners.map(|p| [p, p]).reduce(joined);
                whole = whole.into_iter().chain(here).reduce(joined);
            }
        }
    }
    Ok(None)
}

fn joined(a: Bounds, b: Bounds) -> Bounds {
    [a[0].min(b[0]), a[1].max(b[1])]
}

fn words([min, max]: Bounds) -> String {
    let [x, y, z] = [0, 1, 2].map(|axis| format!("{}..{}", short(min[axis]), short(max[axis])));
    format!("x {x}, y {y}, z {z} mm")
}

/// At most four decimals, none that say nothing.
fn short(x: f64) -> String {
    let rounded = (x * 1e4).round() / 1e4;
    format!("{}", rounded + 0.0)
}
