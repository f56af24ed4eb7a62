//! Lines on curved grids: grid lines and contours, hidden chord by chord.
//!
//! Facets near a contour may lie over each other by as much as they are off the surface. So a line is not hidden by the
//! facets around it that are turned as it is; and where it passes a contour, what goes away from the eye there is hidden.

use std::collections::BTreeMap;

use glam::DVec3;
use rustc_hash::FxHashSet;

use super::{
    clip::{Clipper, Desk},
    drawing::Path,
    fit::{Node, Shape, cubic, through},
    folded::Folded,
    links::NONE,
    model::{Edge, Model},
    pieces::{Side, Sides, continues},
    scene::Kind,
    span::{self, Span},
};

/// A line on a curved grid.
#[derive(Clone, Debug)]
pub struct Thread {
    /// What it is drawn as.
    pub kind: Kind,
    /// The caller's number of its grid.
    pub id: u32,
    /// Its points.
    knots: Vec<Knot>,
    /// Its chords, one less than points.
    chords: Vec<Chord>,
}

/// A point of a thread.
#[derive(Clone, Copy, Debug)]
pub struct Knot {
    /// Its number in the model.
    pub point: u32,
    /// Where it is drawn if not where facets of its surface hide it: at the next point of the model.
    pub drawn: Option<DVec3>,
    /// A vector whose image runs along the line.
    pub tangent: DVec3,
    /// Whether curves are fitted up to here only: the same lines of two sides are cut alike.
    pub stops: bool,
    /// Whether the line ends here in a cusp.
    pub cusp: bool,
}

/// What lies beside a chord.
#[derive(Clone, Copy, Debug)]
struct Chord {
    /// Its triangles.
    homes: [u32; 2],
    /// Which facets around it do not hide it: those of the back, those of the front.
    spared: [bool; 2],
    /// Whether it goes away from the eye, behind what is in front, from a contour at its ends.
    sinks: [bool; 2],
}

/// Chords from a cusp on that are hidden like the next one.
const BLUNT: usize = 2;

/// The grid lines and contours of a grid whose points and triangles begin at some numbers.
pub fn threads(folded: &mut Folded, sides: &Sides, id: u32, starts: [u32; 2]) -> Vec<Thread> {
    let mut loom = Loom { folded, sides, id, starts, threads: vec![], drawn: FxHashSet::default() };
    let cells = loom.folded.grid.cells();
    for way in [1, 0] {
        let other = 1 - way;
        let twice = loom.folded.is_round(other);
        for number in 0..=cells[other] - usize::from(twice) {
            loom.add_grid_line(way, number);
        }
    }
    loom.add_contours();
    loom.threads
}

struct Loom<'a, 'b> {
    folded: &'a mut Folded<'b>,
    sides: &'a Sides,
    id: u32,
    starts: [u32; 2],
    threads: Vec<Thread>,
    /// Sides that are on grid lines.
    drawn: FxHashSet<[u32; 2]>,
}

impl Loom<'_, '_> {
    /// Adds a grid line along a way, from the number of a point on the other one.
    fn add_grid_line(&mut self, way: usize, number: usize) {
        let cells = self.folded.grid.cells();
        let mut line: Vec<Knot> = vec![];
        for i in 0..cells[way] {
            let beside = number.min(cells[1 - way] - 1);
            let cell = if way == 0 { [i, beside] } else { [beside, i] };
            self.add_cell(way, cell, usize::from(number > beside), &mut line);
            if self.folded.surface.is_folded(way, i + 1) {
                self.add_runs(&std::mem::take(&mut line));
            }
        }
        self.add_runs(&line);
    }

    /// Appends the points on a side of a cell.
    fn add_cell(&mut self, way: usize, cell: [usize; 2], far: usize, line: &mut Vec<Knot>) {
        let count = self.folded.steps(way, cell[way]);
        let other = far * self.folded.steps(1 - way, cell[1 - way]);
        let turn = |along, across| if way == 0 { [along, across] } else { [across, along] };
        let knot = |folded: &Folded, point: u32, along: f64| {
            let place = if way == 0 { [along, far as f64] } else { [far as f64, along] };
            let spot = folded.surface.spot(cell, place);
            let tangent = if way == 0 { spot.along_s } else { spot.along_t };
            Knot { point, drawn: None, tangent, stops: false, cusp: false }
        };
        for k in 0..=count {
            let point = self.folded.point(cell, turn(k, other));
            if let Some(last) = line.last().map(|l| l.point) {
                let mut splits: Vec<(f64, u32)> =
                    self.folded.splits(last, point).iter().map(|s| (s.at, s.point)).collect();
                if last > point {
                    splits.iter_mut().for_each(|s| s.0 = 1.0 - s.0);
                    splits.reverse();
                }
                for (at, split) in splits {
                    let along = (k as f64 - 1.0 + at) / count as f64;
                    line.push(knot(self.folded, split, along));
                }
                if last == point {
                    continue;
                }
            }
            let stops = k == 0 || k == count;
            line.push(Knot { stops, ..knot(self.folded, point, k as f64 / count as f64) });
        }
    }

    /// Adds the runs of a line that are of one kind and before the eye.
    fn add_runs(&mut self, line: &[Knot]) {
        let mut open = false;
        for pair in line.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let Some((kind, chord)) = self.chord(a.point, b.point) else {
                open = false;
                continue;
            };
            self.drawn.insert([a.point.min(b.point), a.point.max(b.point)]);
            self.add_chord([a, b], kind, chord, open);
            open = true;
        }
    }

    /// Lengthens the last thread, if it is `open` and of the same kind, or begins another one.
    fn add_chord(&mut self, [a, b]: [Knot; 2], kind: Kind, chord: Chord, open: bool) {
        let base = self.starts[0];
        let moved = |knot: Knot| Knot { point: base + knot.point, ..knot };
        match self.threads.last_mut().filter(|t| open && t.kind == kind) {
            Some(thread) => {
                thread.knots.push(moved(b));
                thread.chords.push(chord);
            }
            None => {
                let (id, knots) = (self.id, vec![moved(a), moved(b)]);
                self.threads.push(Thread { kind, id, knots, chords: vec![chord] });
            }
        }
    }

    /// What lies beside a chord, and what a grid line is drawn as there; `None` where nothing does.
    fn chord(&self, a: u32, b: u32) -> Option<(Kind, Chord)> {
        let beside = self.sides.at(a, b);
        let pieces: Vec<(u32, bool)> = beside
            .iter()
            .map(|s| &self.folded.pieces[s.1 as usize])
            .map(|p| (self.starts[1] + p.home, p.front))
            .collect();
        let (&first, &last) = (pieces.first()?, pieces.last()?);
        let has = |front: bool| pieces.iter().any(|p| p.1 == front);
        let whole = self.folded.grid.closed() == [true; 2];
        let kind = if self.turns(beside) {
            Kind::Contour
        } else if pieces.len() == 1 {
            Kind::Border
        } else if whole || has(true) {
            Kind::Upper
        } else {
            Kind::Lower
        };
        let homes = [first.0, last.0];
        let mut chord = Chord { homes, spared: [has(false), has(true)], sinks: [false; 2] };
        if kind != Kind::Contour {
            for (end, point) in [a, b].into_iter().enumerate() {
                match self.folded.turning.get(&point) {
                    Some(front_is_nearer) if *front_is_nearer == has(true) => {
                        chord.spared = [true; 2]
                    }
                    Some(_) => chord.sinks[end] = true,
                    None => {}
                }
            }
        }
        Some((kind, chord))
    }

    /// Whether a contour runs along a side: one side of it is in front and the other behind.
    fn turns(&self, beside: &[Side]) -> bool {
        let goes_on = |a: &Side, b: &Side| continues(&self.folded.pieces, a, b);
        beside.len() > 1 && !beside[1..].iter().any(|b| goes_on(&beside[0], b))
    }

    /// Adds the contours that are not on grid lines.
    fn add_contours(&mut self) {
        let mut beside: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for side in self.sides.each() {
            let [a, b] = side[0].0;
            if self.turns(side) && !self.drawn.contains(&[a, b]) {
                beside.entry(a).or_default().push(b);
                beside.entry(b).or_default().push(a);
            }
        }
        let stops: Vec<u32> = beside
            .iter()
            .filter(|(point, next)| next.len() != 2 || self.is_end(**point))
            .map(|(point, _)| *point)
            .collect();
        for start in stops {
            while let Some(next) = beside.get_mut(&start).and_then(Vec::pop) {
                self.add_contour(&mut beside, start, next);
            }
        }
        while let Some((&start, next)) = beside.iter_mut().find(|(_, next)| !next.is_empty()) {
            let next = next.pop().expect("not empty");
            self.add_contour(&mut beside, start, next);
        }
    }

    /// Whether a contour ends at a point although it may go on.
    fn is_end(&self, point: u32) -> bool {
        self.folded.cusps.contains(&point) || self.folded.is_tip(point)
    }

    /// Adds the contour from a point over the next one to where it ends.
    fn add_contour(&mut self, beside: &mut BTreeMap<u32, Vec<u32>>, start: u32, next: u32) {
        let mut points = vec![start, next];
        let leave = |beside: &mut BTreeMap<u32, Vec<u32>>, from: u32, to: u32| {
            let ways = beside.entry(from).or_default();
            ways.iter().position(|p| *p == to).map(|place| ways.swap_remove(place));
        };
        leave(beside, next, start);
        leave(beside, start, next);
        loop {
            let here = points[points.len() - 1];
            let ways = beside.entry(here).or_default();
            if here == start || ways.len() != 1 || self.is_end(here) {
                break;
            }
            let to = ways.pop().expect("one way");
            leave(beside, to, here);
            points.push(to);
        }
        let knot = |point: u32| {
            let [at, normal] =
                [&self.folded.points, &self.folded.normals].map(|l| l[point as usize]);
            let tangent = normal.cross(self.folded.sight(at));
            let cusp = self.folded.cusps.contains(&point);
            Knot { point, drawn: None, tangent, stops: false, cusp }
        };
        let knots: Vec<Knot> = points.into_iter().map(knot).collect();
        self.add_runs(&knots);
    }
}

impl Thread {
    /// A line through points of the model, which all facets hide. `sinks` tells of each chord whether it is behind what is
    /// in front at its ends.
    pub fn free(kind: Kind, id: u32, knots: Vec<Knot>, sinks: &[bool]) -> Thread {
        let chord = |&sinks| Chord { homes: [NONE; 2], spared: [false; 2], sinks: [sinks; 2] };
        let chords = sinks.iter().map(chord).collect();
        Thread { kind, id, knots, chords }
    }

    /// Whether it was traced over facets.
    pub fn is_traced(&self) -> bool {
        self.knots.iter().any(|knot| knot.drawn.is_some())
    }

    /// Calls with the shapes on paper of its parts, each with the faces before it; `layered` tells hidden parts apart.
    pub fn hide(
        &self,
        model: &Model,
        clipper: &Clipper,
        desk: &mut Desk,
        layered: bool,
        tolerance: f64,
        mut found: impl FnMut(u32, Shape),
    ) {
        let nodes = self.nodes(model);
        let runs = self.runs(model, clipper, desk, layered);
        for (from, to, order) in tidy(runs, |from, to| length(&nodes, from, to), model.bound) {
            let mut open: Option<Path> = None;
            for part in self.parts(&nodes, from, to) {
                through(&part, tolerance, |shape| match (shape, &mut open) {
                    (Shape::Curve(next), Some(path)) => path.segments.extend(next.segments),
                    (Shape::Curve(next), None) => open = Some(next),
                    (shape, _) => {
                        open.take().into_iter().for_each(|p| found(order, Shape::Curve(p)));
                        found(order, shape);
                    }
                });
            }
            open.into_iter().for_each(|p| found(order, Shape::Curve(p)));
        }
    }

    /// The points on paper with the directions of the line.
    fn nodes(&self, model: &Model) -> Vec<Node> {
        let at = |i: usize| match self.knots[i].drawn {
            Some(p) => model.camera.image(p).0,
            None => model.lattice.millimetres(model.at[self.knots[i].point as usize]),
        };
        let last = self.knots.len() - 1;
        let node = |i: usize| {
            let knot = self.knots[i];
            let way = model.camera.image_velocity(model.space[knot.point as usize], knot.tangent);
            let chord = at((i + 1).min(last)) - at(i.saturating_sub(1));
            let straight = chord.normalize_or_zero();
            let tangent = way.try_normalize().filter(|_| !knot.cusp).unwrap_or(straight);
            Node { at: at(i), tangent: if tangent.dot(chord) < 0.0 { -tangent } else { tangent } }
        };
        (0..=last).map(node).collect()
    }

    /// Parts of the line by the faces before them: from and to as the number of a chord and the place on it.
    fn runs(
        &self,
        model: &Model,
        clipper: &Clipper,
        desk: &mut Desk,
        layered: bool,
    ) -> Vec<(f64, f64, u32)> {
        let mut all: Vec<Vec<Span>> = vec![];
        for i in 0..self.chords.len() {
            all.push(self.spans(model, clipper, desk, i));
        }
        self.sharpen(&mut all);
        let mut runs: Vec<(f64, f64, u32)> = vec![];
        for (i, spans) in all.iter().enumerate() {
            for span in spans {
                let order = if layered { span.order } else { span.order.min(1) };
                let [from, to] = [span.from, span.to].map(|t| i as f64 + t);
                match runs.last_mut() {
                    Some(last) if last.2 == order => last.1 = to,
                    _ => runs.push((from, to, order)),
                }
            }
        }
        runs
    }

    /// The spans of a chord.
    fn spans(&self, model: &Model, clipper: &Clipper, desk: &mut Desk, number: usize) -> Vec<Span> {
        let chord = self.chords[number];
        let [a, b] = [number, number + 1].map(|i| self.knots[i].point);
        let whole = Span { from: 0.0, to: 1.0, order: 0 };
        if model.at[a as usize] == model.at[b as usize] {
            return vec![Span { order: u32::from(chord.sinks.contains(&true)), ..whole }];
        }
        let edge = Edge {
            a,
            b,
            kind: self.kind,
            id: self.id,
            curve: NONE,
            back: false,
            loose: self.is_traced(),
        };
        let spared = |facet: u32| {
            model.homes.of(facet).is_some_and(|(home, front)| {
                chord.spared[usize::from(front)]
                    && chord.homes.iter().any(|&own| model.homes.touch(own, home))
            })
        };
        let mut spans = vec![];
        if edge.loose {
            let is_loose = |facet: u32| model.facets[facet as usize].loose;
            clipper.hide_but(&edge, desk, |facet| !is_loose(facet), &mut spans);
            let mut others = vec![];
            let place = Edge { a: a + 1, b: b + 1, ..edge };
            clipper.hide_but(&place, desk, is_loose, &mut others);
            let mut spans = span::sum(&spans, &others);
            if chord.sinks == [true; 2] {
                spans.iter_mut().for_each(|span| span.order = span.order.max(1));
            }
            return spans;
        }
        clipper.hide_but(&edge, desk, spared, &mut spans);
        for (end, _) in chord.sinks.iter().enumerate().filter(|(_, sinks)| **sinks) {
            let last = spans.len() - 1;
            let [outer, inner] = if end == 0 { [0, 1] } else { [last, last.wrapping_sub(1)] };
            if spans[outer].order == 0 {
                spans[outer].order = spans.get(inner).map_or(1, |s| s.order.max(1));
            }
        }
        spans
    }

    /// Hides the first chords from a cusp on like the next ones: facets around a contour do not tell there.
    fn sharpen(&self, all: &mut [Vec<Span>]) {
        let count = all.len();
        if count <= 2 * BLUNT {
            return;
        }
        let [first, last] =
            [all[BLUNT][0].order, all[count - 1 - BLUNT].last().map_or(0, |s| s.order)];
        let mut follow = |chords: std::ops::Range<usize>, order: u32| {
            chords.for_each(|i| all[i] = vec![Span { from: 0.0, to: 1.0, order }]);
        };
        if self.knots[0].cusp {
            follow(0..BLUNT, first);
        }
        if self.knots[count].cusp {
            follow(count - BLUNT..count, last);
        }
    }

    /// The nodes of a part of the line, cut where curves stop.
    fn parts(&self, nodes: &[Node], from: f64, to: f64) -> Vec<Vec<Node>> {
        let mut parts = vec![vec![node_at(nodes, from)]];
        let inner = self.knots.iter().zip(nodes).enumerate().skip(from.floor() as usize + 1);
        for (_, (knot, node)) in inner.take_while(|(i, _)| (*i as f64) < to) {
            parts.last_mut().expect("there is one").push(*node);
            if knot.stops {
                parts.push(vec![*node]);
            }
        }
        parts.last_mut().expect("there is one").push(node_at(nodes, to));
        parts
    }
}

/// The node at the number of a chord and a place on it.
fn node_at(nodes: &[Node], at: f64) -> Node {
    let i = (at as usize).min(nodes.len() - 1);
    let t = at - i as f64;
    match nodes.get(i + 1) {
        Some(next) if t > 0.0 => {
            let (on, rest) = cubic(&nodes[i], next).part(nodes[i].at, t, 1.0);
            let ahead = rest.at(on, 1e-3) - on;
            Node { at: on, tangent: ahead.normalize_or_zero() }
        }
        _ => nodes[i],
    }
}

/// The length on paper between two places, nearly.
fn length(nodes: &[Node], from: f64, to: f64) -> f64 {
    let inner = (from.floor() as usize + 1..nodes.len()).take_while(|i| (*i as f64) < to);
    let mut last = node_at(nodes, from).at;
    let mut sum = 0.0;
    for at in inner.map(|i| nodes[i].at).chain([node_at(nodes, to).at]) {
        sum += last.distance(at);
        last = at;
    }
    sum
}

/// Runs without those shorter than `least`, which are hidden like what is before them or, at the start, after them.
fn tidy(
    runs: Vec<(f64, f64, u32)>,
    length: impl Fn(f64, f64) -> f64,
    least: f64,
) -> Vec<(f64, f64, u32)> {
    let mut out: Vec<(f64, f64, u32)> = vec![];
    let mut start = None;
    for (from, to, order) in runs {
        let short = length(from, to) < least;
        match out.last_mut() {
            Some(last) if short || last.2 == order => last.1 = to,
            None if short => start = start.or(Some(from)),
            _ => out.push((start.take().unwrap_or(from), to, order)),
        }
    }
    out
}
