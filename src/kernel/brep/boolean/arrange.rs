//! The arrangement of everything in one plane: facets that lie in it and touch, and the traces of
//! facets that cross it.
//!
//! Segments are split wherever they meet, equal pieces become one edge, the edges around every
//! vertex are sorted by angle, and walking them gives the cells. Which facets cover a cell follows
//! by crossing edges from the unbounded cell inwards. All decisions are exact. Planes in
//! which no new points arise are arranged at the same time.

use super::{
    super::threads,
    cells::Complex,
    facet::Facets,
    graph::Graph,
    hierarchy::{Bounds, Hierarchy},
    intersect::{self, Trace},
    nesting::Cells,
    space::{NONE, Space},
};

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
    bounds: Bounds,
}

/// A piece of a segment between neighbouring points, from the smaller number to the other.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Piece {
    a: u32,
    b: u32,
    segment: u32,
    reversed: bool,
}

/// Arranges plane after plane. What it keeps between them is memory to work in.
#[derive(Default)]
struct Arranger {
    parts: Vec<Part>,
    segments: Vec<Segment>,
    /// The facets to the sides of segments.
    sides: Vec<(u32, i32)>,
    /// Single points.
    points: Vec<u32>,
    /// Points that split segments, as pairs (segment, point).
    splits: Vec<(u32, u32)>,
    /// Points that split two segments but are not known, each by its three planes.
    missing: Vec<((u32, u32), [u32; 3])>,
    stops: Vec<u32>,
    pieces: Vec<Piece>,
    graph: Graph,
    cells: Cells,
    covers: Covers,
}

/// Up to so many segments all are compared with all.
const FEW: usize = 24;

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
    let mut members: Vec<(u32, u32)> = vec![];
    let mut starts: Vec<u32> = Vec::with_capacity(facets.list().len() + 1);
    let mut end = 0;
    for facet in 0..facets.list().len() as u32 {
        starts.push(end);
        let rest = &meetings.traces[end as usize..];
        let count = rest.iter().take_while(|t| t.facet == facet).count();
        end += count as u32;
        if count > 0 || meetings.grouped[facet as usize] {
            facets.find_supports(facet, space);
            members.push((meetings.coplanar.find(facet), facet));
        } else {
            complex.add_whole(facet, facets, space);
        }
    }
    starts.push(end);
    members.sort_unstable();
    let groups: Vec<&Group> = members.chunk_by(|a, b| a.0 == b.0).collect();
    Planes { groups, starts, traces: &meetings.traces, facets, trusted }.cut(space, &mut complex);
    complex.add_patches(patches.iter().copied());
    complex.finish(space.point_count());
    complex
}

/// Facets that are arranged together, each with a number of the group.
type Group = [(u32, u32)];

/// The planes to arrange.
struct Planes<'a> {
    /// The facets in each.
    groups: Vec<&'a Group>,
    /// Where the traces of each facet begin; one more at the end.
    starts: Vec<u32>,
    traces: &'a [Trace],
    facets: &'a Facets,
    trusted: bool,
}

/// What comes of arranging some planes at a time.
#[derive(Default)]
struct Arranged<'g> {
    complex: Complex,
    /// The groups left over.
    left: Vec<&'g Group>,
}

/// Planes that are arranged together by one thread.
const CHUNK: usize = 16;

impl Planes<'_> {
    /// Cuts all facets of all planes: at the same time those in which no new points arise, and then
    /// the others.
    fn cut(&self, space: &mut Space, complex: &mut Complex) {
        let (simple, mut left): (Vec<&Group>, Vec<&Group>) =
            self.groups.iter().partition(|group| self.is_simple(group));
        for part in self.look(&simple, space) {
            complex.append(part.complex);
            left.extend(part.left);
        }
        let mut arranger = Arranger::default();
        for group in left {
            self.gather(group, &mut arranger, space);
            arranger.split(space, self.trusted);
            arranger.find_missing(space);
            arranger.finish(self.facets, space, complex);
        }
    }

    /// Whether one facet is cut by one operand, so that nothing crosses inside of it.
    fn is_simple(&self, group: &Group) -> bool {
        let [(_, facet)] = group else { return false };
        let traces = self.traces_on(*facet);
        self.trusted && traces.iter().all(|trace| trace.owner == traces[0].owner)
    }

    /// The traces on a facet.
    fn traces_on(&self, facet: u32) -> &[Trace] {
        let [from, to] = [0, 1].map(|i| self.starts[facet as usize + i] as usize);
        &self.traces[from..to]
    }

    /// Arranges the planes of groups, as far as all points are known.
    fn look<'g>(&self, groups: &[&'g Group], space: &Space) -> Vec<Arranged<'g>> {
        let look = |chunk: &[&'g Group]| {
            let (mut arranger, mut part) = (Arranger::default(), Arranged::default());
            for &group in chunk {
                self.gather(group, &mut arranger, space);
                arranger.split(space, self.trusted);
                if arranger.missing.is_empty() {
                    arranger.finish(self.facets, space, &mut part.complex);
                } else {
                    part.left.push(group);
                }
            }
            part
        };
        threads::parts(groups, CHUNK, look)
    }

    fn gather(&self, group: &Group, arranger: &mut Arranger, space: &Space) {
        let facets = group.iter().map(|g| g.1);
        let traces = facets.clone().flat_map(|facet| self.traces_on(facet));
        arranger.gather(facets, traces, self.facets, space);
    }
}

impl Arranger {
    /// Collects all segments in the plane of a group of facets, the facets to their sides, and all
    /// single points.
    fn gather<'a>(
        &mut self,
        group: impl Iterator<Item = u32>,
        traces: impl Iterator<Item = &'a Trace>,
        facets: &Facets,
        space: &Space,
    ) {
        self.parts.clear();
        self.points.clear();
        for facet in group {
            let known = facets.known_plane(facet);
            let (plane, turned) = known.expect("a facet that is cut has a known plane");
            self.graph.plane = plane;
            let owner = facets.list()[facet as usize].owner;
            for (a, b, support) in facets.supported_edges(facet) {
                let side = Some((facet, if turned == (a > b) { 1 } else { -1 }));
                self.parts.push(Part { a: a.min(b), b: a.max(b), support, owner, side });
            }
        }
        for &Trace { a, b, support, owner, .. } in traces {
            if a == b {
                self.points.push(a);
            } else {
                self.parts.push(Part { a: a.min(b), b: a.max(b), support, owner, side: None });
            }
        }
        self.points.sort_unstable();
        self.points.dedup();
        self.merge(space);
    }

    /// Makes equal parts one segment.
    fn merge(&mut self, space: &Space) {
        self.parts.sort_unstable();
        self.segments.clear();
        self.sides.clear();
        for equal in self.parts.chunk_by(|p, q| (p.a, p.b) == (q.a, q.b)) {
            let Part { a, b, support, owner, .. } = equal[0];
            let owner = if equal.iter().all(|p| p.owner == owner) { owner } else { NONE };
            let start = self.sides.len() as u32;
            self.sides.extend(equal.iter().filter_map(|p| p.side));
            let sides = (start, self.sides.len() as u32);
            let bounds = space.bounds(a).with(space.bounds(b));
            self.segments.push(Segment { a, b, support, owner, sides, bounds });
        }
    }

    /// Finds the points that split each segment, and the planes of those that are missing.
    fn split(&mut self, space: &Space, trusted: bool) {
        self.splits.clear();
        self.missing.clear();
        let Arranger { segments, splits, missing, graph, points, .. } = self;
        let may_cross = |s: u32, t: u32| {
            let owner = segments[s as usize].owner;
            !trusted || owner == NONE || owner != segments[t as usize].owner
        };
        let mut pair = |s: u32, t: u32| {
            let (first, second) = (&segments[s as usize], &segments[t as usize]);
            if let Some(planes) = split_pair((s, first), (t, second), graph.plane, space, splits) {
                missing.push(((s, t), planes));
            }
        };
        if segments.len() > FEW {
            let tree = Hierarchy::new(segments.iter().map(|s| s.bounds));
            let mut pairs = vec![];
            tree.own_pairs(|s, t| {
                if may_cross(s, t) {
                    pairs.push((s, t));
                }
            });
            pairs.into_iter().for_each(|(s, t)| pair(s, t));
            for &point in &*points {
                tree.overlapping(&space.bounds(point), |s| {
                    split_at(s, &segments[s as usize], point, space, splits);
                });
            }
            return;
        }
        for (s, first) in (0u32..).zip(&*segments) {
            for (t, second) in (0u32..).zip(&*segments).skip(s as usize + 1) {
                if first.bounds.meets(&second.bounds) && may_cross(s, t) {
                    pair(s, t);
                }
            }
        }
        for &point in &*points {
            let bounds = space.bounds(point);
            for (s, segment) in (0u32..).zip(&*segments).filter(|s| s.1.bounds.meets(&bounds)) {
                split_at(s, segment, point, space, splits);
            }
        }
    }

    /// Finds the points that are missing.
    fn find_missing(&mut self, space: &mut Space) {
        for ((s, t), [a, b, c]) in self.missing.drain(..) {
            let point = space.meet(a, b, c).expect("lines that cross meet in one point");
            self.splits.extend([(s, point), (t, point)]);
        }
    }

    /// Makes cells of what is gathered and split, and adds those that are covered.
    fn finish(&mut self, facets: &Facets, space: &Space, complex: &mut Complex) {
        self.connect(space);
        self.cells.of(&self.graph, space);
        self.covers.of(&self.graph, &self.cells);
        self.emit(facets, complex);
    }

    /// Makes the pieces of all segments edges of the graph and links them.
    fn connect(&mut self, space: &Space) {
        self.cut(space);
        let Arranger { pieces, segments, sides, graph, .. } = self;
        graph.start(space);
        for equal in pieces.chunk_by(|p, q| (p.a, p.b) == (q.a, q.b)) {
            let start = graph.crossings.len() as u32;
            for piece in equal {
                let (from, to) = segments[piece.segment as usize].sides;
                let turn = if piece.reversed { -1 } else { 1 };
                let own = &sides[from as usize..to as usize];
                graph.crossings.extend(own.iter().map(|&(facet, side)| (facet, side * turn)));
            }
            let support = segments[equal[0].segment as usize].support;
            graph.add_edge((equal[0].a, equal[0].b), support, start, space);
        }
        graph.sort_fans(space);
        graph.link();
        graph.number_walks();
    }

    /// Cuts segments at the points that split them.
    fn cut(&mut self, space: &Space) {
        let Arranger { segments, splits, stops, pieces, .. } = self;
        splits.sort_unstable();
        splits.dedup();
        pieces.clear();
        let mut rest = &splits[..];
        for (number, segment) in (0u32..).zip(&*segments) {
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
            for &to in &*stops {
                let (a, b) = (from.min(to), from.max(to));
                pieces.push(Piece { a, b, segment: number, reversed: from > to });
                from = to;
            }
        }
        pieces.sort_unstable();
    }

    /// Adds the covered cells to the complex.
    fn emit(&self, facets: &Facets, complex: &mut Complex) {
        let graph = &self.graph;
        for cell in 0..self.cells.count() {
            let cover = self.covers.get(cell);
            if cover.is_empty() {
                continue;
            }
            let signed = cover.iter().map(|&(facet, count)| {
                let turned = facets.known_plane(facet).is_some_and(|p| p.1);
                (facet, if turned { -count } else { count })
            });
            complex.begin_cell(graph.plane, signed);
            for &walk in self.cells.walks(cell) {
                graph.around(walk, |half| {
                    complex.push_half(graph.origin(half), graph.edges[half as usize / 2].support);
                });
                complex.end_loop();
            }
        }
    }
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

/// Splits a segment at a point of the plane if it is on it.
fn split_at(s: u32, segment: &Segment, point: u32, space: &Space, splits: &mut Vec<(u32, u32)>) {
    if space.side(point, segment.support) == 0 && between(segment, point, space) {
        splits.push((s, point));
    }
}

/// Splits two segments where they meet; the planes of their common point where it is not known.
fn split_pair(
    (s, first): (u32, &Segment),
    (t, second): (u32, &Segment),
    plane: u32,
    space: &Space,
    splits: &mut Vec<(u32, u32)>,
) -> Option<[u32; 3]> {
    let (fa, fb) = (side(second, first.a, space), side(second, first.b, space));
    let shares = |p: u32| p == second.a || p == second.b;
    if fa * fb > 0 || (shares(first.a) && fb != 0) || (shares(first.b) && fa != 0) {
        return None;
    }
    let (sa, sb) = (side(first, second.a, space), side(first, second.b, space));
    if sa * sb > 0 {
        return None;
    }
    if (fa == 0 && fb == 0) || (sa == 0 && sb == 0) {
        let on_first = [second.a, second.b].into_iter().filter(|&p| between(first, p, space));
        splits.extend(on_first.map(|p| (s, p)));
        let on_second = [first.a, first.b].into_iter().filter(|&p| between(second, p, space));
        splits.extend(on_second.map(|p| (t, p)));
        return None;
    }
    match (fa == 0, fb == 0, sa * sb < 0) {
        (true, _, true) => splits.push((t, first.a)),
        (_, true, true) => splits.push((t, first.b)),
        (true, _, false) | (_, true, false) => {}
        (false, false, _) if sa == 0 => splits.push((s, second.a)),
        (false, false, _) if sb == 0 => splits.push((s, second.b)),
        (false, false, _) => {
            let planes = [plane, first.support, second.support];
            let Some(point) = space.known_meet(planes) else { return Some(planes) };
            splits.extend([(s, point), (t, point)]);
        }
    }
    None
}

/// What covers each cell of an arrangement: facets, and how often; the unbounded one nothing.
#[derive(Default)]
struct Covers {
    list: Vec<(u32, i32)>,
    ranges: Vec<(u32, u32)>,
    open: Vec<u32>,
}

impl Covers {
    /// What covers a cell.
    fn get(&self, cell: usize) -> &[(u32, i32)] {
        let (from, to) = self.ranges[cell];
        &self.list[from as usize..to as usize]
    }

    /// Finds the covers by crossing edges from the unbounded cell inwards.
    fn of(&mut self, graph: &Graph, cells: &Cells) {
        let Covers { list, ranges, open } = self;
        list.clear();
        ranges.clear();
        ranges.resize(cells.count(), (NONE, NONE));
        ranges[0] = (0, 0);
        open.clear();
        open.push(0);
        while let Some(cell) = open.pop() {
            for &walk in cells.walks(cell as usize) {
                graph.around(walk, |half| {
                    let other = cells.of_half(half ^ 1, graph);
                    if ranges[other as usize].0 == NONE {
                        let start = list.len();
                        let (from, to) = ranges[cell as usize];
                        list.extend_from_within(from as usize..to as usize);
                        graph.cross(half, start, list);
                        ranges[other as usize] = (start as u32, list.len() as u32);
                        open.push(other);
                    }
                });
            }
        }
        // A cell that nothing leads to is covered by nothing.
        ranges.iter_mut().filter(|r| r.0 == NONE).for_each(|r| *r = (0, 0));
    }
}
