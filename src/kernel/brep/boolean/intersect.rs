//! Where facets meet: the traces that they leave on each other.
//!
//! Two facets in crossing planes P and Q meet along the line of both planes. Each facet covers some
//! intervals of it; their common part is the trace. Facets in one plane leave no trace: they are
//! arranged together (see `arrange`).

use std::cmp::Ordering;

use super::{
    super::threads,
    facet::Facets,
    hierarchy::Hierarchy,
    rim::Rim,
    space::{NEAR, NONE, Offset, Space, main_axis},
    union_find::Sets,
};

/// A segment, or a single point when both ends are the same, that a facet carries.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Trace {
    /// The facet that carries it.
    pub facet: u32,
    /// One end.
    pub a: u32,
    /// The other end.
    pub b: u32,
    /// The plane that cuts the facet's plane in it.
    pub support: u32,
    /// The operand that left it.
    pub owner: u32,
}

/// What the facets do to each other.
pub(super) struct Meetings {
    /// All traces, by facet.
    pub traces: Vec<Trace>,
    /// Facets that lie in one plane and touch are in one set.
    pub coplanar: Sets,
    /// Whether a facet shares its set.
    pub grouped: Vec<bool>,
}

/// Finds all traces that the given pairs of facets leave on each other. The planes of all facets in
/// pairs are known afterwards.
pub(super) fn meetings(facets: &mut Facets, pairs: &[(u32, u32)], space: &mut Space) -> Meetings {
    facets.find_planes(pairs.iter().flat_map(|&(f, g)| [f, g]), space);
    let count = facets.list().len();
    let mut meetings =
        Meetings { traces: vec![], coplanar: Sets::new(count), grouped: vec![false; count] };
    let mut events = [vec![], vec![]];
    for (pair, finding) in findings(pairs, facets, space) {
        let (f, g) = pairs[pair as usize];
        meetings.add((f, g), finding, facets, space, &mut events);
    }
    extra_points(facets, &mut meetings.traces);
    meetings.traces.sort_unstable();
    meetings.traces.dedup();
    meetings
}

/// What two facets whose boxes touch do to each other.
enum Finding {
    /// They lie in one plane.
    Coplanar,
    /// They have a segment in common, which ends at these crossings; whether of the first facet.
    Segment([(bool, Crossing); 2]),
    /// They may have more in common, which follows from where each meets the line.
    Involved(Box<Involved>),
}

/// Where two facets meet the line of their planes.
struct Involved {
    /// The axis along which the line runs most.
    axis: usize,
    /// Where the first facet meets it, and where the second.
    crossings: [Vec<Crossing>; 2],
}

/// Pairs that are looked at together by one thread.
const CHUNK: usize = 128;

/// What pairs of facets do to each other, where they do; nothing is changed by looking.
fn findings(pairs: &[(u32, u32)], facets: &Facets, space: &Space) -> Vec<(u32, Finding)> {
    let look = |part: &[(u32, &(u32, u32))]| {
        let (mut scratch, mut found) = (Scratch::default(), vec![]);
        for &(number, &pair) in part {
            if let Some(finding) = finding(pair, facets, space, &mut scratch) {
                found.push((number, finding));
            }
        }
        found
    };
    let numbered: Vec<(u32, &(u32, u32))> = (0u32..).zip(pairs).collect();
    threads::parts(&numbered, CHUNK, look).into_iter().flatten().collect()
}

/// Pairs of facets whose boxes touch, in a fixed order. Facets of one operand are compared only if
/// operands are not trusted to be free of self-intersections.
pub(super) fn candidates(facets: &Facets, trusted: bool) -> Vec<(u32, u32)> {
    let mut pairs = vec![];
    let ranges: Vec<_> = (0..facets.owner_count()).map(|owner| facets.of_owner(owner)).collect();
    let owners = Hierarchy::new(facets.owner_bounds());
    let mut owner_pairs = vec![];
    owners.own_pairs(|a, b| owner_pairs.push((a as usize, b as usize)));
    if !trusted {
        owner_pairs.extend((0..ranges.len()).map(|owner| (owner, owner)));
    }
    owner_pairs.sort_unstable();
    let mut is_met = vec![false; ranges.len()];
    owner_pairs.iter().for_each(|&(a, b)| (is_met[a], is_met[b]) = (true, true));
    let tree = |&(range, is_met): &(&std::ops::Range<usize>, &bool)| {
        let bounds = facets.list()[range.clone()].iter().map(|f| f.bounds);
        is_met.then(|| Hierarchy::new(bounds))
    };
    let list: Vec<_> = ranges.iter().zip(&is_met).collect();
    let trees: Vec<Option<Hierarchy>> = match facets.list().len() > LARGE {
        true => threads::each(&list, tree),
        false => list.iter().map(tree).collect(),
    };
    for (a, b) in owner_pairs {
        let (Some(first), Some(second)) = (&trees[a], &trees[b]) else { continue };
        let (start, other) = (ranges[a].start as u32, ranges[b].start as u32);
        first.pairs(second, |f, g| {
            if a != b || f < g {
                pairs.push((start + f, other + g));
            }
        });
    }
    pairs
}

/// So many facets are worth a second thread.
const LARGE: usize = 2000;

/// Corners of dropped facets that lie on edges of others are single points there.
fn extra_points(facets: &Facets, traces: &mut Vec<Trace>) {
    if facets.extra.is_empty() {
        return;
    }
    for facet in 0..facets.list().len() as u32 {
        let owner = facets.list()[facet as usize].owner;
        for (a, b) in facets.edges(facet) {
            let points = facets.extra.get(&(a.min(b), a.max(b)));
            for &p in points.into_iter().flatten() {
                traces.push(Trace { facet, a: p, b: p, support: NONE, owner });
            }
        }
    }
}

/// Reused lists.
#[derive(Default)]
struct Scratch {
    offsets: [Vec<Offset>; 2],
    crossings: [Vec<Crossing>; 2],
}

/// Where a facet's boundary meets a line, not yet found: at a corner, or inside an edge.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    /// The corner, or the ends of the edge.
    ends: (u32, u32),
    /// The support of the edge.
    support: u32,
    /// Between which coordinates along the main axis of the line it is.
    range: (f64, f64),
    /// What changes beyond it.
    above: bool,
    below: bool,
}

/// A point where a facet's boundary meets a line, and what changes beyond it.
#[derive(Clone, Copy, Debug)]
struct Event {
    point: u32,
    /// The facet begins or ends just above the line (on the positive side of the other plane).
    above: bool,
    /// The same just below it.
    below: bool,
}

/// What two facets do to each other.
fn finding(
    (f, g): (u32, u32),
    facets: &Facets,
    space: &Space,
    scratch: &mut Scratch,
) -> Option<Finding> {
    let (p, q) = (known_plane(f, facets), known_plane(g, facets));
    if p == q {
        return Some(Finding::Coplanar);
    }
    let axis = scratch.cross((f, g), facets, space)?;
    let [crossings_f, crossings_g] = &scratch.crossings;
    let hull = |crossings: &[Crossing]| {
        let ranges = crossings.iter().map(|c| c.range);
        ranges.reduce(|all, range| (all.0.min(range.0), all.1.max(range.1))).unwrap_or((1.0, 0.0))
    };
    let (hull_f, hull_g) = (hull(crossings_f), hull(crossings_g));
    if hull_f.1 < hull_g.0 || hull_g.1 < hull_f.0 {
        return None;
    }
    Some(match between(crossings_f, crossings_g) {
        Some(ends) => Finding::Segment(ends),
        None => {
            let crossings = scratch.crossings.clone();
            Finding::Involved(Box::new(Involved { axis, crossings }))
        }
    })
}

fn known_plane(facet: u32, facets: &Facets) -> u32 {
    facets.known_plane(facet).expect("planes of facets in pairs were asked for").0
}

impl Scratch {
    /// Finds where the boundaries of two facets in different planes meet the planes' line; the axis
    /// along which it runs most. `None` where they do not, or where there is no line.
    fn cross(&mut self, (f, g): (u32, u32), facets: &Facets, space: &Space) -> Option<usize> {
        let (p, q) = (known_plane(f, facets), known_plane(g, facets));
        let [offsets_f, offsets_g] = &mut self.offsets;
        if !straddles(f, q, facets, space, offsets_f) || !straddles(g, p, facets, space, offsets_g)
        {
            return None;
        }
        if let (Some(first), Some(second)) =
            (Rim::of(f, facets, offsets_f), Rim::of(g, facets, offsets_g))
            && first.shares_all(second, space)
        {
            return None;
        }
        let line = space.line(p, q);
        if line == [0; 3] {
            return None;
        }
        let axis = main_axis(line);
        let [crossings_f, crossings_g] = &mut self.crossings;
        collect(f, axis, facets, space, offsets_f, crossings_f);
        collect(g, axis, facets, space, offsets_g, crossings_g);
        Some(axis)
    }
}

impl Meetings {
    /// Adds what two facets do to each other.
    fn add(
        &mut self,
        (f, g): (u32, u32),
        finding: Finding,
        facets: &Facets,
        space: &mut Space,
        events_of: &mut [Vec<Event>; 2],
    ) {
        let (p, q) = (known_plane(f, facets), known_plane(g, facets));
        match finding {
            Finding::Coplanar => {
                self.coplanar.join(f, g);
                self.grouped[f as usize] = true;
                self.grouped[g as usize] = true;
            }
            Finding::Segment(ends) => {
                let [a, b] = ends.map(|(of_first, crossing)| {
                    let (own, other) = if of_first { (p, q) } else { (q, p) };
                    crossing.point(own, other, space)
                });
                self.leave((f, g), (p, q), (a, b), facets);
            }
            Finding::Involved(involved) => {
                let Involved { axis, crossings: [crossings_f, crossings_g] } = &*involved;
                let (axis, [events_f, events_g]) = (*axis, events_of);
                events(crossings_f, (p, q), axis, space, events_f);
                events(crossings_g, (q, p), axis, space, events_g);
                overlay(events_f, events_g, axis, space, |a, b| {
                    self.leave((f, g), (p, q), (a, b), facets);
                });
            }
        }
    }

    /// Adds a trace that two facets in two planes leave on each other.
    fn leave(
        &mut self,
        (f, g): (u32, u32),
        (p, q): (u32, u32),
        (a, b): (u32, u32),
        facets: &Facets,
    ) {
        let owner = |facet: u32| facets.list()[facet as usize].owner;
        self.traces.push(Trace { facet: f, a, b, support: q, owner: owner(g) });
        self.traces.push(Trace { facet: g, a, b, support: p, owner: owner(f) });
    }
}

/// Fills in how far a facet's corners are from a plane; whether the plane meets the facet.
fn straddles(
    facet: u32,
    plane: u32,
    facets: &Facets,
    space: &Space,
    offsets: &mut Vec<Offset>,
) -> bool {
    offsets.clear();
    let corners = facets.loops(facet).flatten();
    offsets.extend(corners.map(|&corner| space.offset(corner, plane)));
    !(offsets.iter().all(|o| o.sign > 0) || offsets.iter().all(|o| o.sign < 0))
}

/// Finds where a facet's boundary meets a plane, given how far its corners are from it.
fn collect(
    facet: u32,
    axis: usize,
    facets: &Facets,
    space: &Space,
    offsets: &[Offset],
    crossings: &mut Vec<Crossing>,
) {
    crossings.clear();
    let mut start = 0;
    for (corners, supports) in facets.supported_loops(facet) {
        let count = corners.len();
        for k in 0..count {
            let next = (k + 1) % count;
            let (a, b) = (corners[k], corners[next]);
            let (s, t) = (offsets[start + k], offsets[start + next]);
            let at = |corner: u32, above, below| {
                let here = space.near(corner)[axis];
                let range = (here - NEAR, here + NEAR);
                Crossing { ends: (corner, corner), support: NONE, range, above, below }
            };
            if s.sign == 0 {
                crossings.push(at(a, false, false));
            }
            let (above, below) = ((s.sign > 0) != (t.sign > 0), (s.sign < 0) != (t.sign < 0));
            if !above && !below {
                continue;
            }
            crossings.push(match (s.sign, t.sign) {
                (0, _) => at(a, above, below),
                (_, 0) => at(b, above, below),
                _ => {
                    let range = pierced((space.near(a)[axis], s), (space.near(b)[axis], t));
                    Crossing { ends: (a, b), support: supports[k], range, above, below }
                }
            });
        }
        start += count;
    }
}

/// Between which coordinates an edge meets a plane, given a coordinate of each end and how far the
/// ends, on different sides, are from the plane.
fn pierced((a, s): (f64, Offset), (b, t): (f64, Offset)) -> (f64, f64) {
    let (height, error) = ((s.value - t.value).abs(), s.error + t.error);
    if height <= 4.0 * error {
        return (a.min(b) - NEAR, a.max(b) + NEAR);
    }
    let at = a + (b - a) * (s.value / (s.value - t.value));
    let margin = (b - a).abs() * (2.0 * error / height) + 4.0 * NEAR;
    (at - margin, at + margin)
}

/// The common part of two facets on their line, if each runs through from one crossing to another
/// and their order is certain: its ends, each with whether it is a crossing of the first facet.
fn between(f: &[Crossing], g: &[Crossing]) -> Option<[(bool, Crossing); 2]> {
    let ends = |crossings: &[Crossing]| match *crossings {
        [a, b] if a.above && a.below && b.above && b.below => {
            let (low, high) = if a.range.0 < b.range.0 { (a, b) } else { (b, a) };
            (low.range.1 < high.range.0).then_some((low, high))
        }
        _ => None,
    };
    let ((f_low, f_high), (g_low, g_high)) = (ends(f)?, ends(g)?);
    let before = |a: Crossing, b: Crossing| {
        let certain = a.range.1 < b.range.0 || b.range.1 < a.range.0;
        certain.then_some(a.range.0 < b.range.0)
    };
    let from = if before(f_low, g_low)? { (false, g_low) } else { (true, f_low) };
    let to = if before(f_high, g_high)? { (true, f_high) } else { (false, g_high) };
    (from.1.range.1 < to.1.range.0).then_some([from, to])
}

impl Crossing {
    /// The point where it is, on a facet in the plane `own` and on the plane `other`.
    fn point(&self, own: u32, other: u32, space: &mut Space) -> u32 {
        let (a, b) = self.ends;
        if a == b { a } else { space.pierce((a, b), (own, self.support), other) }
    }
}

/// The points of crossings on a facet in the first plane with the second one, in order along an axis.
fn events(
    crossings: &[Crossing],
    (own, other): (u32, u32),
    axis: usize,
    space: &mut Space,
    events: &mut Vec<Event>,
) {
    events.clear();
    events.extend(crossings.iter().map(|crossing| {
        let &Crossing { above, below, .. } = crossing;
        Event { point: crossing.point(own, other, space), above, below }
    }));
    sort(events, axis, space);
}

/// Sorts events along an axis and makes one of all at the same point.
fn sort(events: &mut Vec<Event>, axis: usize, space: &Space) {
    events.sort_by(|x, y| space.compare(x.point, y.point, axis));
    events.dedup_by(|later, kept| {
        let same = later.point == kept.point;
        if same {
            kept.above ^= later.above;
            kept.below ^= later.below;
        }
        same
    });
}

/// Where along the line one facet is.
struct Cursor<'a> {
    events: &'a [Event],
    above: bool,
    below: bool,
}

impl Cursor<'_> {
    fn inside(&self) -> bool {
        self.above || self.below
    }

    /// Moves over a point; whether the facet holds the point.
    fn pass(&mut self, point: u32) -> bool {
        match self.events.first() {
            Some(event) if event.point == point => {
                self.above ^= event.above;
                self.below ^= event.below;
                self.events = &self.events[1..];
                true
            }
            _ => self.inside(),
        }
    }
}

/// Calls `found` with every segment, and every single point, that two facets have in common.
fn overlay(f: &[Event], g: &[Event], axis: usize, space: &Space, mut found: impl FnMut(u32, u32)) {
    let mut f = Cursor { events: f, above: false, below: false };
    let mut g = Cursor { events: g, above: false, below: false };
    let mut open: Option<u32> = None;
    loop {
        let point = match (f.events.first(), g.events.first()) {
            (Some(x), Some(y)) => match space.compare(x.point, y.point, axis) {
                Ordering::Greater => y.point,
                _ => x.point,
            },
            _ if open.is_none() => return,
            (Some(x), None) => x.point,
            (None, Some(y)) => y.point,
            (None, None) => return,
        };
        let before = open.take();
        let common = f.pass(point) & g.pass(point);
        if let Some(before) = before {
            found(before, point);
        }
        if f.inside() && g.inside() {
            open = Some(point);
        } else if common && before.is_none() {
            found(point, point);
        }
    }
}
