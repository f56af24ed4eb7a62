//! Where facets meet: the traces that they leave on each other.
//!
//! Two facets in crossing planes P and Q meet along the line of both planes. Each facet covers some
//! intervals of it; their common part is the trace. Facets in one plane leave no trace: they are
//! arranged together (see `arrange`).

use std::cmp::Ordering;

use super::{
    facet::Facets,
    hierarchy::{Bounds, Hierarchy},
    space::{NONE, Space, main_axis},
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

/// Finds all traces that the given pairs of facets leave on each other.
pub(super) fn meetings(facets: &mut Facets, pairs: &[(u32, u32)], space: &mut Space) -> Meetings {
    let count = facets.list().len();
    let mut meetings =
        Meetings { traces: vec![], coplanar: Sets::new(count), grouped: vec![false; count] };
    let mut scratch = Scratch::default();
    for &(f, g) in pairs {
        compare(f, g, facets, space, &mut meetings, &mut scratch);
    }
    extra_points(facets, &mut meetings.traces);
    meetings.traces.sort_unstable();
    meetings.traces.dedup();
    meetings
}

/// Pairs of facets whose boxes touch, in a fixed order. Facets of one operand are compared only if
/// operands are not trusted to be free of self-intersections.
pub(super) fn candidates(facets: &Facets, trusted: bool) -> Vec<(u32, u32)> {
    let mut pairs = vec![];
    let ranges: Vec<_> = (0..facets.owner_count()).map(|owner| facets.of_owner(owner)).collect();
    let bounds = |range: &std::ops::Range<usize>| {
        let list = &facets.list()[range.clone()];
        list.iter().fold(Bounds::EMPTY, |all, f| all.with(f.bounds))
    };
    let owners = Hierarchy::new(ranges.iter().map(bounds));
    let mut trees: Vec<Option<Hierarchy>> = ranges.iter().map(|_| None).collect();
    let tree = |owner: usize| {
        Hierarchy::new(facets.list()[ranges[owner].clone()].iter().map(|f| f.bounds))
    };
    let mut owner_pairs = vec![];
    owners.own_pairs(|a, b| owner_pairs.push((a as usize, b as usize)));
    if !trusted {
        owner_pairs.extend((0..ranges.len()).map(|owner| (owner, owner)));
    }
    owner_pairs.sort_unstable();
    for (a, b) in owner_pairs {
        for owner in [a, b] {
            trees[owner].get_or_insert_with(|| tree(owner));
        }
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
    sides: [Vec<i32>; 2],
    events: [Vec<Event>; 2],
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

fn compare(
    f: u32,
    g: u32,
    facets: &mut Facets,
    space: &mut Space,
    meetings: &mut Meetings,
    scratch: &mut Scratch,
) {
    let (p, _) = facets.plane(f, space);
    let (q, _) = facets.plane(g, space);
    if p == q {
        meetings.coplanar.join(f, g);
        meetings.grouped[f as usize] = true;
        meetings.grouped[g as usize] = true;
        return;
    }
    let [sides_f, sides_g] = &mut scratch.sides;
    if !straddles(f, q, facets, space, sides_f) || !straddles(g, p, facets, space, sides_g) {
        return;
    }
    let line = space.line(p, q);
    if line == [0; 3] {
        return;
    }
    let axis = main_axis(line);
    let [events_f, events_g] = &mut scratch.events;
    collect(f, q, facets, space, sides_f, events_f);
    collect(g, p, facets, space, sides_g, events_g);
    sort(events_f, axis, space);
    sort(events_g, axis, space);
    let (owner_f, owner_g) = (facets.list()[f as usize].owner, facets.list()[g as usize].owner);
    overlay(events_f, events_g, axis, space, |a, b| {
        meetings.traces.push(Trace { facet: f, a, b, support: q, owner: owner_g });
        meetings.traces.push(Trace { facet: g, a, b, support: p, owner: owner_f });
    });
}

/// Fills in the sides of a facet's corners to a plane; whether the plane meets the facet.
fn straddles(facet: u32, plane: u32, facets: &Facets, space: &Space, sides: &mut Vec<i32>) -> bool {
    sides.clear();
    let corners = facets.loops(facet).flatten();
    sides.extend(corners.map(|&corner| space.side(corner, plane)));
    !(sides.iter().all(|&s| s > 0) || sides.iter().all(|&s| s < 0))
}

/// The points where a facet's boundary meets a plane.
fn collect(
    facet: u32,
    plane: u32,
    facets: &Facets,
    space: &mut Space,
    sides: &[i32],
    events: &mut Vec<Event>,
) {
    events.clear();
    let mut start = 0;
    let own = facets.known_plane(facet).map_or(NONE, |known| known.0);
    for (corners, supports) in facets.supported_loops(facet) {
        let count = corners.len();
        for k in 0..count {
            let next = (k + 1) % count;
            let (a, b) = (corners[k], corners[next]);
            let (s, t) = (sides[start + k], sides[start + next]);
            if s == 0 {
                events.push(Event { point: a, above: false, below: false });
            }
            let (above, below) = ((s > 0) != (t > 0), (s < 0) != (t < 0));
            if !above && !below {
                continue;
            }
            let point = match (s, t) {
                (0, _) => a,
                (_, 0) => b,
                _ => space.pierce((a, b), (own, supports[k]), plane),
            };
            events.push(Event { point, above, below });
        }
        start += count;
    }
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
