//! Triangulation by one sweep from left to right.
//!
//! Source: S. Hertel and K. Mehlhorn, *Fast Triangulation of Simple Polygons*, 1983. Along the sweep line
//! lie the edges it crosses, in pairs with the inside between them. Each such interval keeps the chain of
//! corners to its left that still want triangles; the chain bulges to the right everywhere, so a new
//! corner sees a run of it.
//!
//! Points are ordered by x, then y: a sweep line leaning by an infinitely small angle, so that vertical
//! edges are ordinary. Corners at one place are taken in the order of [`Event`].
//!
//! # Departures
//! Edges on the sweep line stand in a sorted array instead of a tree (found by bisection, n log n
//! decisions); corners may coincide.

use std::cmp::Ordering;

use glam::DVec2;

use super::PlaneFace;

/// What happens at a corner; those at one place happen in this order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Event {
    /// Both edges lie to the left, the inside between them.
    End,
    /// The inside is above: the edge that comes in gives way to the one that goes out.
    Lower,
    /// The inside is below.
    Upper,
    /// Both edges lie to the left, the outside between them.
    Merge,
    /// Both edges lie to the right, the outside between them.
    Split,
    /// Both edges lie to the right, the inside between them.
    Start,
}

const NONE: u32 = u32::MAX;

/// Room for so many edges and intervals on the sweep line saves most faces from asking for more.
const SOME: usize = 8;

/// A corner in a chain.
#[derive(Clone, Copy)]
struct Link {
    corner: u32,
    up: u32,
    down: u32,
}

/// The inside between two neighbouring edges on the sweep line. Edges are named by their first corner.
#[derive(Clone, Copy)]
struct Interval {
    upper_edge: u32,
    /// Ends of the chain, and the link added last, which every point of the interval sees.
    bottom: u32,
    top: u32,
    latest: u32,
}

struct Sweep<'a> {
    face: &'a PlaneFace,
    /// Edges on the sweep line from below.
    status: Vec<u32>,
    /// For each edge on the sweep line its interval.
    interval_of: Vec<u32>,
    intervals: Vec<Interval>,
    links: Vec<Link>,
    triangles: Vec<[u32; 3]>,
}

/// The triangles over corner numbers; `None` when the face is not valid.
pub(super) fn triangles(face: &PlaneFace) -> Option<Vec<[u32; 3]>> {
    let mut order = Vec::with_capacity(face.len());
    for (corner, &place) in (0..).zip(&face.plane) {
        order.push((place, event(face, corner)?, corner));
    }
    order.sort_unstable_by(|a, b| lexical(a.0, b.0).then_with(|| (a.1, a.2).cmp(&(b.1, b.2))));
    let mut sweep = Sweep {
        face,
        status: Vec::with_capacity(SOME),
        interval_of: vec![NONE; face.len()],
        intervals: Vec::with_capacity(SOME),
        links: Vec::with_capacity(2 * face.len()),
        triangles: Vec::with_capacity(face.len() + 2 * face.starts.len()),
    };
    for (_, event, corner) in order {
        sweep.step(event, corner)?;
    }
    sweep.status.is_empty().then_some(sweep.triangles)
}

fn lexical(a: DVec2, b: DVec2) -> Ordering {
    let order = |p: f64, q: f64| p.partial_cmp(&q).unwrap_or(Ordering::Equal);
    order(a.x, b.x).then_with(|| order(a.y, b.y))
}

fn event(face: &PlaneFace, corner: u32) -> Option<Event> {
    let (prev, next) = (face.prev[corner as usize], face.next[corner as usize]);
    let here = face.plane[corner as usize];
    let from = lexical(face.plane[prev as usize], here);
    let to = lexical(face.plane[next as usize], here);
    let convex = || face.turn(prev, corner, next) > 0.0;
    match (from, to) {
        (Ordering::Equal, _) | (_, Ordering::Equal) => None,
        (Ordering::Less, Ordering::Greater) => Some(Event::Lower),
        (Ordering::Greater, Ordering::Less) => Some(Event::Upper),
        (Ordering::Less, Ordering::Less) => Some(if convex() { Event::End } else { Event::Merge }),
        (Ordering::Greater, Ordering::Greater) => {
            Some(if convex() { Event::Start } else { Event::Split })
        }
    }
}

impl Sweep<'_> {
    /// Takes one corner; `None` when the sweep line is not as a valid face leaves it.
    fn step(&mut self, event: Event, corner: u32) -> Option<()> {
        let (incoming, outgoing) = (self.face.prev[corner as usize], corner);
        match event {
            Event::Start => self.start(corner, outgoing, incoming),
            Event::Split => self.split(corner, incoming, outgoing),
            Event::Lower => self.replace(corner, incoming, outgoing, Sweep::add_below),
            Event::Upper => self.replace(corner, outgoing, incoming, Sweep::add_above),
            Event::Merge => self.merge(corner, outgoing, incoming),
            Event::End => self.end(corner, incoming, outgoing),
        }
    }

    /// On which side of an edge on the sweep line a point lies: greater is above.
    fn side(&self, edge: u32, p: DVec2) -> Ordering {
        let (a, b) = self.ends(edge);
        super::orient2d(a, b, p).partial_cmp(&0.0).unwrap_or(Ordering::Equal)
    }

    /// The ends of an edge, left one first.
    fn ends(&self, edge: u32) -> (DVec2, DVec2) {
        let a = self.face.plane[edge as usize];
        let b = self.face.plane[self.face.next[edge as usize] as usize];
        if lexical(a, b) == Ordering::Less { (a, b) } else { (b, a) }
    }

    /// The edges on the sweep line that run through a point, as a range of places.
    fn through(&self, p: DVec2) -> std::ops::Range<usize> {
        let low = self.status.partition_point(|&e| self.side(e, p) == Ordering::Greater);
        let count = self.status[low..].iter().take_while(|&&e| self.side(e, p).is_eq()).count();
        low..low + count
    }

    /// Where an edge that ends at a corner stands.
    fn place_of(&self, edge: u32, corner: u32) -> Option<usize> {
        let range = self.through(self.face.plane[corner as usize]);
        let start = range.start;
        self.status[range].iter().position(|&e| e == edge).map(|i| start + i)
    }

    /// Where an edge that leaves a corner to the right belongs.
    fn place_for(&self, edge: u32, corner: u32) -> usize {
        let range = self.through(self.face.plane[corner as usize]);
        let (_, far) = self.ends(edge);
        let below = |&e: &u32| self.side(e, far) == Ordering::Greater;
        range.start + self.status[range].partition_point(below)
    }

    fn start(&mut self, corner: u32, lower: u32, upper: u32) -> Option<()> {
        let place = self.place_for(lower, corner);
        if !place.is_multiple_of(2) {
            return None;
        }
        self.status.splice(place..place, [lower, upper]);
        let link = self.link(corner, NONE, NONE);
        let interval = Interval { upper_edge: upper, bottom: link, top: link, latest: link };
        self.open(interval, lower);
        Some(())
    }

    /// Registers an interval over its lower edge.
    fn open(&mut self, interval: Interval, lower: u32) {
        let number = self.intervals.len() as u32;
        self.interval_of[lower as usize] = number;
        self.interval_of[interval.upper_edge as usize] = number;
        self.intervals.push(interval);
    }

    fn split(&mut self, corner: u32, upper: u32, lower: u32) -> Option<()> {
        let place = self.place_for(upper, corner);
        if place % 2 != 1 {
            return None;
        }
        let below = self.interval_of[self.status[place - 1] as usize];
        self.status.splice(place..place, [upper, lower]);
        let old = self.intervals[below as usize];
        let mut above = self.cover_up(old.latest, corner);
        let mut under = self.cover_down(old.latest, corner);
        if above == under {
            let link = self.links[above as usize];
            above = self.link(link.corner, link.up, NONE);
            under = self.link(link.corner, NONE, link.down);
        }
        let top_of_lower = self.link(corner, NONE, under);
        let bottom_of_upper = self.link(corner, above, NONE);
        let end = |old: u32, cut: u32, kept: u32| if old == cut { kept } else { old };
        let (top, bottom) = (end(old.top, old.latest, above), end(old.bottom, old.latest, under));
        self.intervals[below as usize] =
            Interval { upper_edge: upper, bottom, top: top_of_lower, latest: top_of_lower };
        self.interval_of[upper as usize] = below;
        let upper_part = Interval { bottom: bottom_of_upper, top, latest: bottom_of_upper, ..old };
        self.open(upper_part, lower);
        Some(())
    }

    fn replace(
        &mut self,
        corner: u32,
        old: u32,
        new: u32,
        add: fn(&mut Self, u32, u32),
    ) -> Option<()> {
        let place = self.place_of(old, corner)?;
        self.status[place] = new;
        let number = self.interval_of[old as usize];
        self.interval_of[new as usize] = number;
        let interval = &mut self.intervals[number as usize];
        if interval.upper_edge == old {
            interval.upper_edge = new;
        }
        add(self, number, corner);
        Some(())
    }

    fn merge(&mut self, corner: u32, upper_of_lower: u32, lower_of_upper: u32) -> Option<()> {
        let place = self.place_of(upper_of_lower, corner)?;
        if self.status.get(place + 1) != Some(&lower_of_upper) || place % 2 != 1 {
            return None;
        }
        self.status.drain(place..place + 2);
        let below = self.interval_of[upper_of_lower as usize];
        let above = self.interval_of[lower_of_upper as usize];
        if below == above {
            return None;
        }
        self.add_above(below, corner);
        self.add_below(above, corner);
        let upper = self.intervals[above as usize];
        let seam = self.intervals[below as usize].top;
        let first = self.links[upper.bottom as usize].up;
        self.links[seam as usize].up = first;
        self.links[first as usize].down = seam;
        let interval = &mut self.intervals[below as usize];
        (interval.top, interval.latest) = (upper.top, seam);
        interval.upper_edge = upper.upper_edge;
        self.interval_of[upper.upper_edge as usize] = below;
        Some(())
    }

    fn end(&mut self, corner: u32, lower: u32, upper: u32) -> Option<()> {
        let place = self.place_of(lower, corner)?;
        if self.status.get(place + 1) != Some(&upper) || !place.is_multiple_of(2) {
            return None;
        }
        self.status.drain(place..place + 2);
        let interval = self.intervals[self.interval_of[lower as usize] as usize];
        (self.cover_up(interval.bottom, corner) == interval.top).then_some(())
    }

    fn link(&mut self, corner: u32, up: u32, down: u32) -> u32 {
        let number = self.links.len() as u32;
        self.links.push(Link { corner, up, down });
        if up != NONE {
            self.links[up as usize].down = number;
        }
        if down != NONE {
            self.links[down as usize].up = number;
        }
        number
    }

    /// Puts a corner below the chain, over all it sees.
    fn add_below(&mut self, interval: u32, corner: u32) {
        let last = self.cover_up(self.intervals[interval as usize].bottom, corner);
        let link = self.link(corner, last, NONE);
        let interval = &mut self.intervals[interval as usize];
        (interval.bottom, interval.latest) = (link, link);
    }

    /// Puts a corner above the chain, over all it sees.
    fn add_above(&mut self, interval: u32, corner: u32) {
        let last = self.cover_down(self.intervals[interval as usize].top, corner);
        let link = self.link(corner, NONE, last);
        let interval = &mut self.intervals[interval as usize];
        (interval.top, interval.latest) = (link, link);
    }

    /// Makes triangles of a corner and the chain upwards of a link while it sees it; gives the last link
    /// it sees.
    fn cover_up(&mut self, from: u32, corner: u32) -> u32 {
        let mut here = from;
        loop {
            let up = self.links[here as usize].up;
            if up == NONE || !self.make(here, corner, up) {
                return here;
            }
            here = up;
        }
    }

    /// The same downwards.
    fn cover_down(&mut self, from: u32, corner: u32) -> u32 {
        let mut here = from;
        loop {
            let down = self.links[here as usize].down;
            if down == NONE || !self.make(down, corner, here) {
                return here;
            }
            here = down;
        }
    }

    /// Makes a triangle of two neighbouring links and a corner to the right if the corner sees them.
    /// Coincident corners leave no choice: the triangle without area joins their loops.
    fn make(&mut self, low: u32, corner: u32, high: u32) -> bool {
        let (low, high) = (self.links[low as usize].corner, self.links[high as usize].corner);
        let [a, b, c] = [low, corner, high].map(|k| self.face.plane[k as usize]);
        let made = super::orient2d(a, b, c) > 0.0 || a == b || b == c || a == c;
        if made {
            self.triangles.push([low, corner, high]);
        }
        made
    }
}
