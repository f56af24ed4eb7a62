//! The arrangement of everything in one plane: facets that lie in it and touch, and the traces of
//! facets that cross it.
//!
//! Segments are split wherever they meet, equal pieces become one edge, the edges around every
//! vertex are sorted by angle, and walking them gives the cells. Which facets cover a cell follows
//! by crossing edges from the unbounded cell inwards. All decisions are exact.

use std::cmp::Ordering;

use super::{
    cells::Complex,
    facet::Facets,
    hierarchy::Hierarchy,
    intersect::{self, Trace},
    nesting,
    space::{NONE, Space, main_axis},
};
use crate::geom::wide::Wide;

/// A part of a boundary or a trace, from the point with the smaller number to the other.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Part {
    a: u32,
    b: u32,
    /// The plane that cuts the plane of the arrangement in it.
    support: u32,
    /// The operand it comes from.
    owner: u32,
    /// The facet on its left (1) or right (-1), when it is part of a facet's boundary.
    side: Option<(u32, i32)>,
}

/// Equal parts: one segment.
struct Segment {
    a: u32,
    b: u32,
    support: u32,
    /// The operand that all parts come from, [`NONE`] for several.
    owner: u32,
    /// Facets to its sides: a range of a list.
    sides: (u32, u32),
}

/// An edge of the arrangement, from the point with the smaller number to the other.
pub(super) struct Edge {
    pub a: u32,
    pub b: u32,
    pub support: u32,
    /// Whether a to b runs along the cross product of the normals of the plane and the support.
    pub along: bool,
    /// Facets on its left (1) and right (-1): a range of `crossings`.
    crossings: (u32, u32),
    /// Its direction, in the plane's two coordinates.
    direction: [i128; 2],
    near: [f64; 2],
}

/// A plane's arrangement: half-edge 2 e runs from a to b of edge e, 2 e + 1 back.
pub(super) struct Graph {
    /// The plane.
    pub plane: u32,
    /// The two axes that are the plane's coordinates, in right-handed order.
    pub axes: [usize; 2],
    pub edges: Vec<Edge>,
    crossings: Vec<(u32, i32)>,
    /// The half-edge that follows around the cell on the left.
    pub next: Vec<u32>,
    /// The boundary walk that a half-edge belongs to.
    pub walk: Vec<u32>,
    /// A half-edge of every walk.
    pub walks: Vec<u32>,
    /// The points met, sorted by number; `fans[fan_ends[i-1]..fan_ends[i]]` leave point i.
    pub points: Vec<u32>,
    fans: Vec<u32>,
    fan_ends: Vec<u32>,
}

impl Graph {
    /// Where a half-edge starts.
    pub fn origin(&self, half: u32) -> u32 {
        let edge = &self.edges[half as usize / 2];
        if half & 1 == 0 { edge.a } else { edge.b }
    }

    /// The half-edges that leave a point, by its place in `points`, by angle from -90 degrees.
    pub fn fan(&self, place: usize) -> &[u32] {
        let start = if place == 0 { 0 } else { self.fan_ends[place - 1] };
        &self.fans[start as usize..self.fan_ends[place] as usize]
    }

    /// The place of a point in `points`.
    pub fn place(&self, point: u32) -> usize {
        self.points.binary_search(&point).expect("a point of this arrangement")
    }

    /// What covers the cell right of a half-edge, given what covers the cell left of it.
    fn cross(&self, half: u32, cover: &[(u32, i32)]) -> Vec<(u32, i32)> {
        let (start, end) = self.edges[half as usize / 2].crossings;
        let mut other = cover.to_vec();
        let turn = if half & 1 == 0 { -1 } else { 1 };
        for &(facet, left) in &self.crossings[start as usize..end as usize] {
            match other.binary_search_by_key(&facet, |c| c.0) {
                Ok(i) if other[i].1 + left * turn == 0 => drop(other.remove(i)),
                Ok(i) => other[i].1 += left * turn,
                Err(i) => other.insert(i, (facet, left * turn)),
            }
        }
        other
    }
}

/// Cuts all facets into cells, given the pairs of those whose boxes touch. Patches are given each by
/// a facet of its operand.
pub(super) fn complex(
    facets: &mut Facets,
    pairs: &[(u32, u32)],
    patches: &[u32],
    space: &mut Space,
    trusted: bool,
) -> Complex {
    let mut meetings = intersect::meetings(facets, pairs, space);
    let mut complex = Complex::default();
    let mut groups: Vec<(u32, u32)> = vec![];
    let mut traces = &meetings.traces[..];
    for facet in 0..facets.list().len() as u32 {
        let count = traces.iter().take_while(|t| t.facet == facet).count();
        traces = &traces[count..];
        if count > 0 || meetings.grouped[facet as usize] {
            groups.push((meetings.coplanar.find(facet), facet));
        } else {
            complex.add_whole(facet, facets);
        }
    }
    groups.sort_unstable();
    for group in groups.chunk_by(|a, b| a.0 == b.0) {
        let members: Vec<u32> = group.iter().map(|g| g.1).collect();
        let range = |facet: &u32| {
            let start = meetings.traces.partition_point(|t| t.facet < *facet);
            let end = meetings.traces.partition_point(|t| t.facet <= *facet);
            &meetings.traces[start..end]
        };
        let traces: Vec<_> = members.iter().flat_map(range).copied().collect();
        arrange(&members, &traces, facets, space, trusted, &mut complex);
    }
    complex.add_patches(patches.iter().copied());
    complex.finish(space.point_count());
    complex
}

/// Arranges a set of facets of one plane with the traces on them, and adds the covered cells to the
/// complex.
fn arrange(
    group: &[u32],
    traces: &[Trace],
    facets: &mut Facets,
    space: &mut Space,
    trusted: bool,
    complex: &mut Complex,
) {
    let (plane, _) = facets.plane(group[0], space);
    let gathered = gather(group, traces, plane, facets, space);
    let splits = split(&gathered.segments, &gathered.points, plane, space, trusted);
    let graph = Graph::of(plane, &gathered, splits, space);
    let cells = nesting::cells(&graph, space);
    let covers = covers(&graph, &cells);
    emit(&graph, &cells, &covers, facets, complex);
}

/// All segments in the plane, the facets to their sides, and all single points.
struct Gathered {
    segments: Vec<Segment>,
    sides: Vec<(u32, i32)>,
    points: Vec<u32>,
}

fn gather(
    group: &[u32],
    traces: &[Trace],
    plane: u32,
    facets: &mut Facets,
    space: &mut Space,
) -> Gathered {
    let (mut parts, mut points) = (vec![], vec![]);
    for &facet in group {
        let (_, turned) = facets.plane(facet, space);
        let owner = facets.list()[facet as usize].owner;
        for (a, b, support) in facets.supported_edges(facet) {
            let support = if support == NONE { space.support(a, b, plane) } else { support };
            let side = Some((facet, if turned == (a > b) { 1 } else { -1 }));
            parts.push(Part { a: a.min(b), b: a.max(b), support, owner, side });
        }
    }
    for &Trace { a, b, support, owner, .. } in traces {
        if a == b {
            points.push(a);
        } else {
            parts.push(Part { a: a.min(b), b: a.max(b), support, owner, side: None });
        }
    }
    points.sort_unstable();
    points.dedup();
    let (segments, sides) = merged(parts);
    Gathered { segments, sides, points }
}

/// Equal parts made one segment.
fn merged(mut parts: Vec<Part>) -> (Vec<Segment>, Vec<(u32, i32)>) {
    parts.sort_unstable();
    let (mut segments, mut sides) = (vec![], vec![]);
    for equal in parts.chunk_by(|p, q| (p.a, p.b) == (q.a, q.b)) {
        let Part { a, b, support, owner, .. } = equal[0];
        let owner = if equal.iter().all(|p| p.owner == owner) { owner } else { NONE };
        let start = sides.len() as u32;
        sides.extend(equal.iter().filter_map(|p| p.side));
        segments.push(Segment { a, b, support, owner, sides: (start, sides.len() as u32) });
    }
    (segments, sides)
}

/// The points that split each segment, as pairs (segment, point).
fn split(
    segments: &[Segment],
    points: &[u32],
    plane: u32,
    space: &mut Space,
    trusted: bool,
) -> Vec<(u32, u32)> {
    let mut splits = vec![];
    let tree = Hierarchy::new(segments.iter().map(|s| space.bounds(s.a).with(space.bounds(s.b))));
    let mut pairs = vec![];
    tree.own_pairs(|s, t| {
        let owner = segments[s as usize].owner;
        if !trusted || owner == NONE || owner != segments[t as usize].owner {
            pairs.push((s, t));
        }
    });
    for (s, t) in pairs {
        let (first, second) = (&segments[s as usize], &segments[t as usize]);
        split_pair((s, first), (t, second), plane, space, &mut splits);
    }
    for &point in points {
        tree.overlapping(&space.bounds(point), |s| {
            let segment = &segments[s as usize];
            if space.side(point, segment.support) == 0 && between(segment, point, space) {
                splits.push((s, point));
            }
        });
    }
    splits
}

/// The side of a point to a segment's support, 0 at once for its ends.
fn side(segment: &Segment, point: u32, space: &Space) -> i32 {
    if point == segment.a || point == segment.b { 0 } else { space.side(point, segment.support) }
}

/// Whether a point on a segment's line lies strictly between its ends.
fn between(segment: &Segment, point: u32, space: &Space) -> bool {
    if point == segment.a || point == segment.b {
        return false;
    }
    let (axis, sign) = space.direction(segment.a, segment.b);
    let order = |x: u32, y: u32| space.compare(x, y, axis) as i32 * sign;
    order(segment.a, point) < 0 && order(point, segment.b) < 0
}

fn split_pair(
    (s, first): (u32, &Segment),
    (t, second): (u32, &Segment),
    plane: u32,
    space: &mut Space,
    splits: &mut Vec<(u32, u32)>,
) {
    let (fa, fb) = (side(second, first.a, space), side(second, first.b, space));
    let shares = |p: u32| p == second.a || p == second.b;
    if fa * fb > 0 || (shares(first.a) && fb != 0) || (shares(first.b) && fa != 0) {
        return;
    }
    let (sa, sb) = (side(first, second.a, space), side(first, second.b, space));
    if sa * sb > 0 {
        return;
    }
    if (fa == 0 && fb == 0) || (sa == 0 && sb == 0) {
        let on_first = [second.a, second.b].into_iter().filter(|&p| between(first, p, space));
        splits.extend(on_first.map(|p| (s, p)));
        let on_second = [first.a, first.b].into_iter().filter(|&p| between(second, p, space));
        splits.extend(on_second.map(|p| (t, p)));
        return;
    }
    match (fa == 0, fb == 0, sa * sb < 0) {
        (true, _, true) => splits.push((t, first.a)),
        (_, true, true) => splits.push((t, first.b)),
        (true, _, false) | (_, true, false) => {}
        (false, false, _) if sa == 0 => splits.push((s, second.a)),
        (false, false, _) if sb == 0 => splits.push((s, second.b)),
        (false, false, _) => {
            let meet = space.meet(plane, first.support, second.support);
            let point = meet.expect("lines that cross meet in one point");
            splits.extend([(s, point), (t, point)]);
        }
    }
}

/// A piece of a segment between neighbouring points, from the smaller number to the other.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Piece {
    a: u32,
    b: u32,
    segment: u32,
    reversed: bool,
}

fn pieces(segments: &[Segment], mut splits: Vec<(u32, u32)>, space: &Space) -> Vec<Piece> {
    splits.sort_unstable();
    splits.dedup();
    let mut pieces = Vec::with_capacity(segments.len() + splits.len());
    let (mut rest, mut stops) = (&splits[..], vec![]);
    for (number, segment) in (0u32..).zip(segments) {
        let count = rest.iter().take_while(|s| s.0 == number).count();
        stops.clear();
        stops.extend(rest[..count].iter().map(|s| s.1));
        rest = &rest[count..];
        if count > 1 {
            let (axis, sign) = space.direction(segment.a, segment.b);
            stops.sort_by(|&x, &y| {
                let order = space.compare(x, y, axis);
                if sign < 0 { order.reverse() } else { order }
            });
        }
        stops.push(segment.b);
        let mut from = segment.a;
        for &to in &stops {
            let (a, b) = (from.min(to), from.max(to));
            pieces.push(Piece { a, b, segment: number, reversed: from > to });
            from = to;
        }
    }
    pieces.sort_unstable();
    pieces
}

impl Graph {
    fn of(plane: u32, gathered: &Gathered, splits: Vec<(u32, u32)>, space: &Space) -> Graph {
        let normal = space.plane(plane).normal;
        let main = main_axis(normal.map(i128::from));
        let axes = [(main + 1) % 3, (main + 2) % 3];
        let axes = if normal[main] < 0 { [axes[1], axes[0]] } else { axes };
        let (edges, crossings) = edges(plane, axes, gathered, splits, space);
        let mut graph = Graph {
            plane,
            axes,
            edges,
            crossings,
            next: vec![],
            walk: vec![],
            walks: vec![],
            points: vec![],
            fans: vec![],
            fan_ends: vec![],
        };
        graph.sort_fans();
        graph.link();
        graph.number_walks();
        graph
    }

    /// Sorts the half-edges that leave each point by angle.
    fn sort_fans(&mut self) {
        let halves = 0..2 * self.edges.len() as u32;
        self.points = halves.clone().map(|h| self.origin(h)).collect();
        self.points.sort_unstable();
        self.points.dedup();
        let places: Vec<usize> = halves.clone().map(|h| self.place(self.origin(h))).collect();
        let mut ends = vec![0u32; self.points.len()];
        places.iter().for_each(|&p| ends[p] += 1);
        let mut sum = 0;
        for end in &mut ends {
            sum += *end;
            *end = sum;
        }
        let mut fill: Vec<u32> =
            (0..ends.len()).map(|i| if i == 0 { 0 } else { ends[i - 1] }).collect();
        let mut fans = vec![0; places.len()];
        for half in halves {
            let slot = &mut fill[places[half as usize]];
            fans[*slot as usize] = half;
            *slot += 1;
        }
        let mut start = 0;
        for &end in &ends {
            fans[start..end as usize].sort_by(|&g, &h| self.by_angle(g, h));
            start = end as usize;
        }
        (self.fans, self.fan_ends) = (fans, ends);
    }

    /// Orders half-edges that leave one point by angle, from just above -90 degrees.
    fn by_angle(&self, g: u32, h: u32) -> Ordering {
        let (d, e) = (self.direction(g), self.direction(h));
        let left = |d: [i128; 2]| d[0] < 0 || (d[0] == 0 && d[1] < 0);
        left(d).cmp(&left(e)).then_with(|| {
            let (p, q) = (self.near(g), self.near(h));
            let (x, y) = (p[0] * q[1], p[1] * q[0]);
            let value = x - y;
            if value.abs() > (x.abs() + y.abs()) * CROSS_ERROR {
                return 0.0.partial_cmp(&value).unwrap_or(Ordering::Equal);
            }
            let wide = |v: i128| Wide::<4>::from(v);
            0.cmp(&(wide(d[0]) * wide(e[1]) - wide(d[1]) * wide(e[0])).sign())
        })
    }

    fn direction(&self, half: u32) -> [i128; 2] {
        let d = self.edges[half as usize / 2].direction;
        if half & 1 == 0 { d } else { [-d[0], -d[1]] }
    }

    fn near(&self, half: u32) -> [f64; 2] {
        let d = self.edges[half as usize / 2].near;
        if half & 1 == 0 { d } else { [-d[0], -d[1]] }
    }

    /// Around the cell on its left, a half-edge is followed by the one that leaves its end next in
    /// clockwise order from its way back.
    fn link(&mut self) {
        let mut next = vec![0; self.fans.len()];
        for place in 0..self.points.len() {
            let fan = self.fan(place);
            for (i, &back) in fan.iter().enumerate() {
                next[back as usize ^ 1] = fan[(i + fan.len() - 1) % fan.len()];
            }
        }
        self.next = next;
    }

    fn number_walks(&mut self) {
        self.walk = vec![u32::MAX; self.next.len()];
        for start in 0..self.next.len() as u32 {
            if self.walk[start as usize] != u32::MAX {
                continue;
            }
            let mut half = start;
            while self.walk[half as usize] == u32::MAX {
                self.walk[half as usize] = self.walks.len() as u32;
                half = self.next[half as usize];
            }
            self.walks.push(start);
        }
    }
}

/// Relative error of a cross product of directions that were rounded to doubles.
const CROSS_ERROR: f64 = 8.0 * f64::EPSILON;

/// Equal pieces made one edge each, with the facets to their sides.
fn edges(
    plane: u32,
    axes: [usize; 2],
    Gathered { segments, sides, .. }: &Gathered,
    splits: Vec<(u32, u32)>,
    space: &Space,
) -> (Vec<Edge>, Vec<(u32, i32)>) {
    let pieces = pieces(segments, splits, space);
    let (mut edges, mut crossings) = (vec![], vec![]);
    for equal in pieces.chunk_by(|p, q| (p.a, p.b) == (q.a, q.b)) {
        let (a, b) = (equal[0].a, equal[0].b);
        let support = segments[equal[0].segment as usize].support;
        let start = crossings.len() as u32;
        for piece in equal {
            let (from, to) = segments[piece.segment as usize].sides;
            let turn = if piece.reversed { -1 } else { 1 };
            let own = &sides[from as usize..to as usize];
            crossings.extend(own.iter().map(|&(facet, side)| (facet, side * turn)));
        }
        let line = space.line(plane, support);
        let axis = main_axis(line);
        let along = (space.compare(b, a, axis) as i128) * line[axis].signum() > 0;
        let line = if along { line } else { line.map(|c| -c) };
        let direction = [line[axes[0]], line[axes[1]]];
        let crossings = (start, crossings.len() as u32);
        let near = direction.map(|c| c as f64);
        edges.push(Edge { a, b, support, along, crossings, direction, near });
    }
    (edges, crossings)
}

/// What covers each cell; the first cell is the unbounded one, covered by nothing.
fn covers(graph: &Graph, cells: &nesting::Cells) -> Vec<Vec<(u32, i32)>> {
    let mut covers: Vec<Option<Vec<(u32, i32)>>> = vec![None; cells.walks.len()];
    covers[0] = Some(vec![]);
    let mut open = vec![0];
    while let Some(cell) = open.pop() {
        for half in cells.halves(cell, graph) {
            let other = cells.of_walk[graph.walk[half as usize ^ 1] as usize] as usize;
            if covers[other].is_none() {
                let here = covers[cell].as_deref().unwrap_or(&[]);
                covers[other] = Some(graph.cross(half, here));
                open.push(other);
            }
        }
    }
    covers.into_iter().map(Option::unwrap_or_default).collect()
}

/// Adds the covered cells to the complex.
fn emit(
    graph: &Graph,
    cells: &nesting::Cells,
    covers: &[Vec<(u32, i32)>],
    facets: &mut Facets,
    complex: &mut Complex,
) {
    for (cell, cover) in covers.iter().enumerate().filter(|c| !c.1.is_empty()) {
        let signed = cover.iter().map(|&(facet, count)| {
            let turned = facets.known_plane(facet).is_some_and(|p| p.1);
            (facet, if turned { -count } else { count })
        });
        complex.begin_cell(graph.plane, signed);
        for &walk in &cells.walks[cell] {
            let start = graph.walks[walk as usize];
            let mut half = start;
            loop {
                complex.push_half(graph.origin(half), graph.edges[half as usize / 2].support);
                half = graph.next[half as usize];
                if half == start {
                    break;
                }
            }
            complex.end_loop();
        }
    }
}
