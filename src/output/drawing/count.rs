//! Hidden lines by Nishita's count.
//!
//! T. Nishita's *order of invisibility* is the number of front faces before a point; Appel calls it
//! quantitative invisibility. Along an edge it changes only where the edge's picture crosses an outline of
//! what is in front: by +1 into the picture of the face there, by -1 out of it. Its value at one point comes
//! from a sight line.
//!
//! | paper | here |
//! |---|---|
//! | contour edge | [`Outline`] |
//! | order of invisibility | [`Span::order`] |

use glam::DVec3;

use super::{
    cells::{Cells, Extent, Sieve},
    chain::Chord,
    clip::{Clipper, Piercing},
    field::{Constraint, Field},
    lattice::{Scanline, Sighted},
    links::NONE,
    meet::{Strand, meet, nearer},
    model::{Edge, Model, Outline},
    span::{Span, Step, spans},
};

/// The outlines of a model, ready to be asked.
pub struct Counter<'a> {
    model: &'a Model,
    cells: Cells,
    clipper: &'a Clipper<'a>,
}

/// Storage that is kept from edge to edge.
pub struct Tally {
    sieve: Sieve,
    steps: Vec<Step>,
}

impl<'a> Counter<'a> {
    /// Sorts the outlines into a grid.
    pub fn new(model: &'a Model, clipper: &'a Clipper<'a>) -> Counter<'a> {
        let extent = |i: usize| {
            let Outline { a, b, .. } = model.outlines[i];
            Extent::Segment(model.at[a as usize], model.at[b as usize])
        };
        Counter { model, cells: Cells::new(model.outlines.len(), extent), clipper }
    }

    /// Storage for [`Counter::hide`].
    pub fn tally(&self) -> Tally {
        Tally { sieve: Sieve::new(self.model.outlines.len()), steps: vec![] }
    }

    /// Appends the spans of a straight edge that pierces no face.
    pub fn hide(&self, edge: &Edge, tally: &mut Tally, out: &mut Vec<Span>) {
        let [p, q] = [edge.a, edge.b].map(|i| self.model.at[i as usize]);
        let line = Scanline::new(p, q);
        let Tally { sieve, steps } = tally;
        steps.clear();
        sieve.next_round();
        self.cells.along(p, q, |i| {
            if sieve.passes(i) {
                steps.extend(self.step(edge, &line, &self.model.outlines[i as usize]));
            }
        });
        steps.sort_unstable_by(|a, b| a.at.total_cmp(&b.at));
        let (seed, before) = widest(steps);
        let order = self.clipper.order_at(edge, &line, seed, None);
        spans(steps, order - before, self.model.dust_of(edge) / line.length(), out);
    }

    /// The change of the order where an edge crosses an outline in front of it.
    #[inline]
    fn step(&self, edge: &Edge, line: &Scanline, outline: &Outline) -> Option<Step> {
        let (at, by, sighted) = self.crossing(line, outline)?;
        let facet = &self.model.facets[outline.facet as usize];
        if facet.field != NONE || outline.curve != NONE {
            let (p, _) = self.true_crossing(edge, [edge.a, edge.b], at, outline, sighted)?;
            let at = line.place(self.model.lattice.exact(self.model.camera.image(p).0));
            return Some(Step { at, by });
        }
        let [low, high] = self.model.heights(edge, &facet.plane);
        let height = low + (high - low) * at;
        let gain = self.model.gain[edge.a as usize].min(self.model.gain[edge.b as usize]);
        let behind = if height.abs() > self.model.contact * gain {
            height < 0.0
        } else {
            self.is_passed(edge, at, outline, sighted)
        };
        behind.then_some(Step { at, by })
    }

    /// Whether an outline is nearer to the eye than an edge where they cross; the plane of a facet that is seen nearly
    /// edge-on does not tell.
    #[cold]
    fn is_passed(&self, edge: &Edge, at: f64, outline: &Outline, [a, b]: [Sighted; 2]) -> bool {
        let model = self.model;
        let ends = [outline.a, outline.b];
        if ends.contains(&edge.a) || ends.contains(&edge.b) {
            return false;
        }
        let t = model.place_in_space(ends, a.side / (a.side - b.side));
        let [p, q] = ends.map(|i| model.space[i as usize]);
        nearer(&model.camera, [model.point_on(edge, at), p.lerp(q, t)]) > model.contact
    }

    /// Where an outline crosses a line within 0..1, and the change of the order there.
    #[inline]
    fn crossing(&self, line: &Scanline, outline: &Outline) -> Option<(f64, i32, [Sighted; 2])> {
        let [a, b] = [outline.a, outline.b].map(|i| line.sighted(self.model.at[i as usize]));
        let at = line.crossing(a, b).filter(|t| *t >= 0.0 && *t < 1.0)?;
        // The facet is on the left of the outline: an outline that runs to the left of the edge has it behind.
        Some((at, if b.side > 0.0 { -1 } else { 1 }, [a, b]))
    }

    /// The point of an edge where its true curve crosses that of an outline in front of it, and its place on the chord;
    /// the edge runs between `ends` and its chord crosses at `at`.
    fn true_crossing(
        &self,
        edge: &Edge,
        ends: [u32; 2],
        at: f64,
        outline: &Outline,
        [a, b]: [Sighted; 2],
    ) -> Option<(DVec3, f64)> {
        let model = self.model;
        if ends.contains(&outline.a) || ends.contains(&outline.b) {
            return None;
        }
        let one = Strand::new(model, edge.curve, ends);
        let other = Strand::new(model, outline.curve, [outline.a, outline.b]);
        let s = model.place_in_space(ends, at);
        let t = model.place_in_space([outline.a, outline.b], a.side / (a.side - b.side));
        let points = meet(&model.camera, &one, s, &other, t)?;
        let front = nearer(&model.camera, points) > model.bound * TOUCH;
        front.then(|| (points[0], one.place(points[0])))
    }

    /// The spans of a chain of chords, by chord and place on it, and the true points where they meet. Hidden ones are of
    /// order 1 unless they are `layered`.
    pub fn hide_chain(&self, chain: &[Chord], tally: &mut Tally, layered: bool) -> Vec<Stretch> {
        let Tally { sieve, .. } = tally;
        let mut turns: Vec<Turn> = vec![];
        for (number, chord) in chain.iter().enumerate() {
            let edge = &self.model.edges[chord.edge as usize];
            let [p, q] = chord.ends.map(|i| self.model.at[i as usize]);
            if p == q {
                continue;
            }
            let line = Scanline::new(p, q);
            sieve.next_round();
            self.cells.along(p, q, |i| {
                if sieve.passes(i) {
                    let outline = &self.model.outlines[i as usize];
                    let turn = self.crossing(&line, outline).and_then(|(at, by, sighted)| {
                        let (point, s) =
                            self.true_crossing(edge, chord.ends, at, outline, sighted)?;
                        Some(Turn { at: number as f64 + s, by, point })
                    });
                    turns.extend(turn);
                }
            });
        }
        self.add_piercings(chain, &mut turns);
        self.settle_ends(chain, &mut turns);
        turns.sort_unstable_by(|a, b| a.at.total_cmp(&b.at));
        self.stretches(chain, &turns, layered)
    }

    /// Adds the turns where a chain runs through faces of other bodies that reach into its own.
    fn add_piercings(&self, chain: &[Chord], turns: &mut Vec<Turn>) {
        let model = self.model;
        let first = chain[0].edge as usize;
        let hull = model.hulls.iter().find(|h| h.edges.contains(&first));
        let Some(hull) = hull.filter(|h| h.reached) else { return };
        for (number, chord) in chain.iter().enumerate() {
            let [a, b] = chord.ends;
            let edge = Edge { a, b, ..model.edges[chord.edge as usize] };
            for Piercing { at, by, facet } in self.clipper.piercings(&edge, &hull.facets) {
                let facet = &model.facets[facet as usize];
                let field = model.fields.get(facet.field as usize).copied();
                let surface = Constraint::On(field.unwrap_or(Field::Flat(facet.plane)));
                let strand = Strand::new(model, edge.curve, chord.ends);
                let start = strand.at(&model.camera, model.place_in_space(chord.ends, at));
                let reach = model.space[a as usize].distance(model.space[b as usize]);
                let curve = model.curves.get(edge.curve as usize);
                let point = curve.and_then(|c| c.meeting(surface, &model.camera, start, reach));
                let point = point.unwrap_or(start);
                turns.push(Turn { at: number as f64 + strand.place(point), by, point });
            }
        }
    }

    /// Brings turns that are beyond an end of the chain to the other end, if it is closed, or to that end.
    fn settle_ends(&self, chain: &[Chord], turns: &mut [Turn]) {
        let (end, ends) = (chain.len() as f64, [chain[0].ends[0], chain[chain.len() - 1].ends[1]]);
        for turn in turns.iter_mut().filter(|t| !(0.0..=end).contains(&t.at)) {
            if ends[0] == ends[1] {
                turn.at = turn.at.rem_euclid(end);
            } else {
                let last = turn.at > 0.0;
                turn.at = turn.at.clamp(0.0, end);
                turn.point = self.model.space[ends[usize::from(last)] as usize];
            }
        }
    }

    /// Counts along a chain. The count is kept right by a sight line in each long stretch: chords cross where curves
    /// that touch do not, and a turn missed or met twice must not spoil the rest of the chain.
    fn stretches(&self, chain: &[Chord], turns: &[Turn], layered: bool) -> Vec<Stretch> {
        let end = chain.len() as f64;
        let last = self.model.space[chain[chain.len() - 1].ends[1] as usize];
        let marks = turns.iter().map(|t| (t.at, t.point, t.by)).chain([(end, last, 0)]);
        let mut from = (0.0, self.model.space[chain[0].ends[0] as usize]);
        let (mut parts, mut change): (Vec<(Stretch, i32)>, i32) = (vec![], 0);
        for (at, point, by) in marks {
            let to = (at, point);
            let apart = point.distance(from.1) > self.model.contact || at - from.0 > 1.0;
            if at > from.0 && apart {
                parts.push((Stretch { from, to, order: 0 }, std::mem::take(&mut change)));
                from = to;
            }
            change += by;
        }
        self.count(chain, &mut parts);
        let mut out: Vec<Stretch> = vec![];
        for (mut part, _) in parts {
            part.order = if layered { part.order } else { part.order.min(1) };
            match out.last_mut() {
                Some(last) if last.order == part.order => last.to = part.to,
                _ => out.push(part),
            }
        }
        out
    }

    /// Gives the parts of a chain, each with the change before it, their order.
    fn count(&self, chain: &[Chord], parts: &mut [(Stretch, i32)]) {
        let width = |s: &Stretch| s.to.0 - s.from.0;
        let Some(widest) = parts.iter().map(|p| width(&p.0)).reduce(f64::max) else { return };
        let seen: Vec<Option<i32>> = parts
            .iter()
            .map(|(s, _)| {
                let long = width(s) >= widest.min(SOUND);
                long.then(|| self.order_on(chain, (s.from.0 + s.to.0) / 2.0))
            })
            .collect();
        let first = seen.iter().position(Option::is_some).unwrap_or(0);
        let before: i32 = parts[1..=first].iter().map(|p| p.1).sum();
        let mut order = seen[first].unwrap_or(0) - before;
        for (i, (part, change)) in parts.iter_mut().enumerate() {
            order += if i > 0 { *change } else { 0 };
            order = seen[i].unwrap_or(order);
            part.order = order.max(0) as u32;
        }
    }

    /// The order of a chain at a place, from a sight line.
    fn order_on(&self, chain: &[Chord], at: f64) -> i32 {
        let number = (at as usize).min(chain.len() - 1);
        let chord = chain[number];
        let edge = &self.model.edges[chord.edge as usize];
        let [p, q] = chord.ends.map(|i| self.model.at[i as usize]);
        if p == q {
            return 0;
        }
        let strand = Strand::new(self.model, edge.curve, chord.ends);
        let t = (at - number as f64).clamp(0.0, 1.0);
        let on = strand.at(&self.model.camera, self.model.place_in_space(chord.ends, t));
        self.clipper.order_at(edge, &Scanline::new(p, q), t, Some(on))
    }
}

/// Stretches of so many chords are far enough from their ends for a sight line.
const SOUND: f64 = 1.5;

/// Where the order of a chain changes.
struct Turn {
    at: f64,
    by: i32,
    point: DVec3,
}

/// A part of a chain with the same order.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Stretch {
    /// Where it begins: number of the chord and place on it, and the true point.
    pub from: (f64, DVec3),
    /// Where it ends.
    pub to: (f64, DVec3),
    /// Front faces before it.
    pub order: u32,
}

/// Curves that are nearer to each other than this part of the bound touch where their pictures cross.
const TOUCH: f64 = 0.125;

/// The middle of the widest gap between sorted steps, and the sum of the steps before it.
fn widest(steps: &[Step]) -> (f64, i32) {
    let (mut from, mut sum, mut best) = (0.0, 0, (-1.0, 0.5, 0));
    for &Step { at, by } in steps.iter().chain([&Step { at: 1.0, by: 0 }]) {
        if at - from > best.0 {
            best = (at - from, (from + at) / 2.0, sum);
        }
        (from, sum) = (at, sum + by);
    }
    (best.1, best.2)
}
