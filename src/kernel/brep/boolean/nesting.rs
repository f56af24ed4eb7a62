//! Which boundary walks of a plane's arrangement bound the same cell.
//!
//! Every connected part of the arrangement has one walk around its outside; it bounds the cell that
//! the part lies in. That cell is found straight below the part's first point.

use std::cmp::Ordering;

use super::{
    graph::{Edge, Graph},
    hierarchy::{Bounds, Hierarchy},
    space::Space,
    union_find::Sets,
};

/// The cells of an arrangement; number 0 is the unbounded one.
#[derive(Default)]
pub(super) struct Cells {
    /// The cell of each walk.
    of_walk: Vec<u32>,
    /// The walks that bound each cell: one past the last of those before it and its own.
    walks: Vec<u32>,
    ends: Vec<u32>,
}

impl Cells {
    /// The number of cells.
    pub fn count(&self) -> usize {
        self.ends.len() - 1
    }

    /// The walks that bound a cell.
    pub fn walks(&self, cell: usize) -> &[u32] {
        &self.walks[self.ends[cell] as usize..self.ends[cell + 1] as usize]
    }

    /// The cell on the left of a half-edge.
    pub fn of_half(&self, half: u32, graph: &Graph) -> u32 {
        self.of_walk[graph.walk[half as usize] as usize]
    }

    /// Groups the walks of an arrangement into cells.
    pub fn of(&mut self, graph: &Graph, space: &Space) {
        let parts = parts(graph, space);
        let Cells { of_walk, walks, ends } = self;
        of_walk.clear();
        of_walk.resize(graph.walks.len(), u32::MAX);
        parts.iter().for_each(|part| of_walk[part.outside as usize] = 0);
        let mut count = 1;
        for cell in of_walk.iter_mut().filter(|c| **c == u32::MAX) {
            *cell = count;
            count += 1;
        }
        if parts.len() > 1 {
            nest(parts, of_walk, graph, space);
        }
        ends.clear();
        ends.resize(count as usize + 2, 0);
        of_walk.iter().for_each(|&cell| ends[cell as usize + 2] += 1);
        (2..ends.len()).for_each(|i| ends[i] += ends[i - 1]);
        walks.clear();
        walks.resize(of_walk.len(), 0);
        for (walk, &cell) in (0u32..).zip(&*of_walk) {
            let slot = &mut ends[cell as usize + 1];
            walks[*slot as usize] = walk;
            *slot += 1;
        }
        ends.pop();
    }
}

/// A connected part of the arrangement.
struct Part {
    /// Its first point, left to right, then upwards.
    first: u32,
    /// The walk around its outside.
    outside: u32,
}

/// Finds in which cell each part lies.
fn nest(mut parts: Vec<Part>, of_walk: &mut [u32], graph: &Graph, space: &Space) {
    parts.sort_by(|p, q| order(p.first, q.first, graph, space));
    let below = Below::new(graph, space);
    for part in &parts {
        let around = below.walk(part.first, graph, space);
        of_walk[part.outside as usize] = around.map_or(0, |walk| of_walk[walk as usize]);
    }
}

/// The order of points from left to right, then upwards.
fn order(p: u32, q: u32, graph: &Graph, space: &Space) -> Ordering {
    let [x, y] = graph.axes;
    space.compare(p, q, x).then_with(|| space.compare(p, q, y))
}

/// The connected parts. By Euler's formula there are half as many as points and walks exceed edges.
fn parts(graph: &Graph, space: &Space) -> Vec<Part> {
    let count = (graph.points.len() + graph.walks.len() - graph.edges.len()) / 2;
    let least = |p: u32, q: u32| if order(p, q, graph, space).is_lt() { p } else { q };
    if count == 1 {
        let first = graph.points.iter().copied().reduce(least);
        return first.map(|first| Part::from(first, graph, space)).into_iter().collect();
    }
    let mut sets = Sets::new(graph.points.len());
    for edge in &graph.edges {
        sets.join(graph.place(edge.a) as u32, graph.place(edge.b) as u32);
    }
    let mut first: Vec<Option<u32>> = vec![None; graph.points.len()];
    for (place, &point) in (0u32..).zip(&graph.points) {
        let slot = &mut first[sets.find(place) as usize];
        *slot = Some(slot.map_or(point, |best| least(best, point)));
    }
    first.into_iter().flatten().map(|first| Part::from(first, graph, space)).collect()
}

impl Part {
    /// The part with this first point. All edges there lead to the right; left of the steepest one is
    /// the outside.
    fn from(first: u32, graph: &Graph, space: &Space) -> Part {
        let fan = graph.fan(graph.place(first));
        let steepest = fan.max_by(|&g, &h| graph.by_angle(g, h, space));
        let outside = graph.walk[steepest.expect("a point has edges") as usize];
        Part { first, outside }
    }
}

/// Finds what lies straight below a point.
struct Below {
    tree: Hierarchy,
}

impl Below {
    fn new(graph: &Graph, space: &Space) -> Below {
        Below {
            tree: Hierarchy::new(
                graph.edges.iter().map(|e| space.bounds(e.a).with(space.bounds(e.b))),
            ),
        }
    }

    /// The walk above the nearest edge straight below a point, not counting edges through it.
    fn walk(&self, point: u32, graph: &Graph, space: &Space) -> Option<u32> {
        let mut bounds = space.bounds(point);
        let [x, y] = graph.axes;
        let across = 3 - x - y;
        bounds = Bounds {
            min: std::array::from_fn(|i| if i == x { bounds.min[i] } else { i32::MIN }),
            max: std::array::from_fn(|i| if i == across { i32::MAX } else { bounds.max[i] }),
        };
        let mut best: Option<Span> = None;
        self.tree.overlapping(&bounds, |edge| {
            let Some(span) = Span::of(edge, graph, space) else { return };
            if span.covers(point, graph, space)
                && span.is_below(point, graph, space)
                && best.as_ref().is_none_or(|b| span.is_above(b, graph, space))
            {
                best = Some(span);
            }
        });
        best.map(|span| graph.walk[span.half as usize])
    }
}

/// An edge seen from left to right.
struct Span {
    half: u32,
    left: u32,
    right: u32,
}

impl Span {
    /// `None` for an upright edge.
    fn of(edge: u32, graph: &Graph, space: &Space) -> Option<Span> {
        let &Edge { a, b, .. } = &graph.edges[edge as usize];
        match space.compare(a, b, graph.axes[0]) {
            Ordering::Less => Some(Span { half: 2 * edge, left: a, right: b }),
            Ordering::Greater => Some(Span { half: 2 * edge + 1, left: b, right: a }),
            Ordering::Equal => None,
        }
    }

    fn covers(&self, point: u32, graph: &Graph, space: &Space) -> bool {
        let x = graph.axes[0];
        space.compare(self.left, point, x) != Ordering::Greater
            && space.compare(point, self.right, x) == Ordering::Less
    }

    /// 1 for a point above the line of the edge, -1 below. Left of a line along n x m, where n is
    /// the plane's normal and m the support's, is where m points away from.
    fn side(&self, point: u32, graph: &Graph, space: &Space) -> i32 {
        let edge = &graph.edges[self.half as usize / 2];
        let along = graph.is_along(edge, space) == (self.half & 1 == 0);
        let side =
            if point == edge.a || point == edge.b { 0 } else { space.side(point, edge.support) };
        if along { -side } else { side }
    }

    fn is_below(&self, point: u32, graph: &Graph, space: &Space) -> bool {
        self.side(point, graph, space) > 0
    }

    /// Whether it runs above another edge, where both cover one place and do not cross.
    fn is_above(&self, other: &Span, graph: &Graph, space: &Space) -> bool {
        let x = graph.axes[0];
        if space.compare(self.left, other.left, x) == Ordering::Less {
            return !other.is_above(self, graph, space);
        }
        match other.side(self.left, graph, space) {
            0 => {}
            side => return side > 0,
        }
        if space.compare(self.right, other.right, x) == Ordering::Greater {
            self.side(other.right, graph, space) < 0
        } else {
            other.side(self.right, graph, space) > 0
        }
    }
}
