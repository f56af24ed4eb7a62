//! Hidden lines by clipping every edge against every facet in front of it.
//!
//! A facet hides of an edge what lies within its picture and behind its plane. Its sides cut the line of the
//! edge in an even number of places, between which the edge runs in and out; the plane cuts it once.

use std::{collections::BTreeMap, ops::Range};

use glam::DVec3;

use super::{
    cells::{Cells, Extent, Sieve},
    field::Field,
    lattice::{Plane, Scanline},
    links::NONE,
    model::{Edge, Facet, Model},
    span::{Span, Step, spans},
    strips::Strips,
};

/// The facets of a model, ready to be asked.
pub struct Clipper<'a> {
    model: &'a Model,
    cells: Cells,
    /// Facets of many sides, by strips.
    strips: Vec<Option<Strips>>,
}

/// A place where an edge runs through a facet.
#[derive(Clone, Copy, Debug)]
pub struct Piercing {
    /// The number of the facet.
    pub facet: u32,
    /// The place along the edge.
    pub at: f64,
    /// The change of the order: 1 where the edge goes behind the facet.
    pub by: i32,
}

/// Facets of more sides than this are kept in strips.
const MANY: usize = 64;

/// Storage that is kept from edge to edge.
pub struct Desk {
    sieve: Sieve,
    cuts: Vec<f64>,
    steps: Vec<Step>,
}

impl<'a> Clipper<'a> {
    /// Sorts the facets into a grid.
    pub fn new(model: &'a Model) -> Clipper<'a> {
        let extent = |i: usize| Extent::Box(model.facets[i].min, model.facets[i].max);
        let strips = |f: &Facet| {
            let sides = &model.sides[f.sides[0] as usize..f.sides[1] as usize];
            (sides.len() > MANY).then(|| Strips::new(model, sides, f.min.y, f.max.y))
        };
        let strips = model.facets.iter().map(strips).collect();
        Clipper { model, cells: Cells::new(model.facets.len(), extent), strips }
    }

    /// Storage for [`Clipper::hide`].
    pub fn desk(&self) -> Desk {
        Desk { sieve: Sieve::new(self.model.facets.len()), cuts: vec![], steps: vec![] }
    }

    /// Appends the spans of an edge.
    pub fn hide(&self, edge: &Edge, desk: &mut Desk, out: &mut Vec<Span>) {
        self.hide_but(edge, desk, |_| false, out);
    }

    /// Appends the spans of an edge that some facets do not hide.
    pub fn hide_but(
        &self,
        edge: &Edge,
        desk: &mut Desk,
        spared: impl Fn(u32) -> bool,
        out: &mut Vec<Span>,
    ) {
        let [p, q] = [edge.a, edge.b].map(|i| self.model.at[i as usize]);
        let line = Scanline::new(p, q);
        let (min, max) = (p.min(q), p.max(q));
        let Desk { sieve, cuts, steps } = desk;
        steps.clear();
        sieve.next_round();
        self.cells.along(p, q, |i| {
            let facet = &self.model.facets[i as usize];
            let apart = facet.min.cmpgt(max) | min.cmpgt(facet.max);
            if !apart.any() && sieve.passes(i) && !spared(i) {
                self.cut(edge, &line, facet, cuts, steps);
            }
        });
        spans(steps, 0, self.model.dust_of(edge) / line.length(), out);
    }

    /// Adds the steps of one facet.
    fn cut(
        &self,
        edge: &Edge,
        line: &Scanline,
        facet: &Facet,
        cuts: &mut Vec<f64>,
        steps: &mut Vec<Step>,
    ) {
        let Some((low, high)) = behind(self.model.heights(edge, &facet.plane)) else { return };
        crossings(self.model, line, facet, cuts);
        for pair in cuts.chunks_exact(2) {
            let (from, to) = (pair[0].max(low), pair[1].min(high));
            if from < to {
                steps.extend([Step { at: from, by: 1 }, Step { at: to, by: -1 }]);
            }
        }
    }

    /// Where an edge runs through facets, those of a range left out.
    pub fn piercings(&self, edge: &Edge, own: &Range<usize>) -> Vec<Piercing> {
        let [p, q] = [edge.a, edge.b].map(|i| self.model.at[i as usize]);
        let mut found: Vec<Piercing> = vec![];
        if p == q {
            return found;
        }
        let line = Scanline::new(p, q);
        self.cells.along(p, q, |i| {
            let facet = &self.model.facets[i as usize];
            let [a, b] = self.model.heights(edge, &facet.plane);
            if own.contains(&(i as usize)) || (a < 0.0) == (b < 0.0) {
                return;
            }
            let at = a / (a - b);
            if self.winding(facet, &line, at) != 0 {
                found.push(Piercing { facet: i, at, by: if b < 0.0 { 1 } else { -1 } });
            }
        });
        found.sort_unstable_by_key(|f| f.facet);
        found.dedup_by_key(|f| f.facet);
        found
    }

    /// How many facets are in front of an edge at t; the edge runs along `line`. `on` is the true point there if the
    /// edge is a chord.
    pub fn order_at(&self, edge: &Edge, line: &Scanline, t: f64, on: Option<DVec3>) -> i32 {
        let (mut order, mut folded) = (0, false);
        self.each_before(edge, (line, t), on, |_, winding| {
            order += winding;
            folded |= winding < 0;
        });
        if folded { self.order_of_surfaces(edge, (line, t), on) } else { order }
    }

    /// The same where facets are turned over: they lie over neighbours of which one may be before the edge and the other
    /// not, by less than they are off. But no surface lies over a point less than not at all.
    #[cold]
    fn order_of_surfaces(&self, edge: &Edge, place: (&Scanline, f64), on: Option<DVec3>) -> i32 {
        let mut surfaces: BTreeMap<(u32, bool), i32> = BTreeMap::new();
        self.each_before(edge, place, on, |facet, winding| {
            *surfaces.entry((facet.field, facet.loose)).or_default() += winding;
        });
        surfaces.values().map(|order| (*order).max(0)).sum()
    }

    /// Calls with the facets in front of an edge at a place of its line, and how often each lies over it.
    fn each_before(
        &self,
        edge: &Edge,
        (line, t): (&Scanline, f64),
        on: Option<DVec3>,
        mut found: impl FnMut(&Facet, i32),
    ) {
        let at = line.at(t);
        self.cells.at(at, |i| {
            let facet = &self.model.facets[i as usize];
            let apart = (facet.min - 1.0).cmpgt(at) | (at - 1.0).cmpgt(facet.max);
            if !apart.any() {
                let flat = facet.field == NONE;
                if flat && !self.hides(facet, edge, t, on) {
                    return;
                }
                let winding = match &self.strips[i as usize] {
                    Some(strips) if on.is_some() => strips.winding(self.model, at),
                    _ => self.winding(facet, line, t),
                };
                if winding != 0 && (flat || self.hides(facet, edge, t, on)) {
                    found(facet, winding);
                }
            }
        });
    }

    /// How often a facet lies over the point of a line at t: once or not at all, unless it folds over itself; less than
    /// not at all where its neighbours lie over each other instead.
    fn winding(&self, facet: &Facet, line: &Scanline, t: f64) -> i32 {
        let mut winding = 0;
        for &[a, b] in &self.model.sides[facet.sides[0] as usize..facet.sides[1] as usize] {
            let [a, b] = [a, b].map(|i| line.sighted(self.model.at[i as usize]));
            if line.crossing(a, b).is_some_and(|c| c < t) {
                winding += if a.side > 0.0 { 1 } else { -1 };
            }
        }
        winding
    }

    /// Whether the surface of a facet is in front of an edge at t.
    fn hides(&self, facet: &Facet, edge: &Edge, t: f64, on: Option<DVec3>) -> bool {
        if facet.field == NONE && on.is_none() {
            let [a, b] = self.model.heights(edge, &facet.plane);
            return a + (b - a) * t < 0.0;
        }
        let p = on.unwrap_or_else(|| self.model.point_on(edge, t));
        let Some(field) = self.model.fields.get(facet.field as usize) else {
            return facet.plane.distance(p) < -self.model.contact;
        };
        let sight = self.model.camera.sight(p).normalize_or_zero();
        let curve = self.model.curves.get(edge.curve as usize);
        let own = curve.is_some_and(|c| c.is_contour_of(field));
        let contact = if own { field.local(p).radius() * OWN } else { self.model.bound };
        let corner = self.model.space[facet.corner as usize];
        ahead(field, &facet.plane, corner, p, sight) > contact
    }
}

/// On its own surface, what is nearer than this part of the radius does not hide a point of a contour, whose
/// sight line touches the surface.
const OWN: f64 = 1.0 / 256.0;

/// Newton's steps along a sight line, at most.
const STEPS: usize = 64;

/// Facets seen at a smaller angle than this (its sine) do not tell where their plane is met.
const STEEP: f64 = 0.05;

/// How far along a sight line from `p` it meets the front of a surface near a facet, given by its plane and a
/// corner, mm.
fn ahead(field: &Field, plane: &Plane, corner: DVec3, p: DVec3, sight: DVec3) -> f64 {
    let slope = plane.normal.dot(sight);
    let steep = slope.abs() < STEEP;
    let guess = if steep { (corner - p).dot(sight) } else { -plane.distance(p) / slope };
    let there = field.local(corner);
    let reach = there.radius() / 2.0;
    let outward = there.normal.dot(plane.normal).signum();
    // Newton's method may find where the sight line leaves the surface again; the front is nearer to the eye.
    let starts = [0.0, 1.0, 2.0, 4.0].map(|k| guess + k * reach);
    let front = starts.into_iter().map(|start| met(field, p, sight, start, reach)).find(|s| {
        let (_, normal) = field.slope(p + sight * s);
        outward * normal.dot(sight) > -TOUCHING
    });
    front.unwrap_or(guess)
}

/// Where a sight line touches a surface the sine of the angle between them is below this, after Newton's method has
/// found half the digits of the place.
const TOUCHING: f64 = 1e-4;

/// The place along a sight line where it meets a surface near a place, in steps of `reach` mm at most.
fn met(field: &Field, p: DVec3, sight: DVec3, start: f64, reach: f64) -> f64 {
    let mut s = start;
    for _ in 0..STEPS {
        let (value, normal) = field.slope(p + sight * s);
        let step = (value / normal.dot(sight)).clamp(-reach, reach);
        if step.is_nan() {
            return s;
        }
        s -= step;
        if step.abs() <= f64::EPSILON * (s.abs() + reach) {
            break;
        }
    }
    s
}

/// The part of an edge, within 0..1, that is behind a plane, from the heights of its ends.
#[inline]
pub fn behind([a, b]: [f64; 2]) -> Option<(f64, f64)> {
    match (a < 0.0, b < 0.0) {
        (false, false) => None,
        (true, true) => Some((0.0, 1.0)),
        (true, false) => Some((0.0, a / (a - b))),
        (false, true) => Some((a / (a - b), 1.0)),
    }
}

/// Where the sides of a facet cross a line, in order.
#[inline]
fn crossings(model: &Model, line: &Scanline, facet: &Facet, cuts: &mut Vec<f64>) {
    cuts.clear();
    let sides = &model.sides[facet.sides[0] as usize..facet.sides[1] as usize];
    let mut end = u32::MAX;
    let mut seen = line.sighted(model.at[sides[0][0] as usize]);
    for &[a, b] in sides {
        let before = if a == end { seen } else { line.sighted(model.at[a as usize]) };
        seen = line.sighted(model.at[b as usize]);
        end = b;
        cuts.extend(line.crossing(before, seen));
    }
    if cuts.len() == 2 {
        if cuts[0] > cuts[1] {
            cuts.swap(0, 1);
        }
    } else {
        cuts.sort_unstable_by(f64::total_cmp);
    }
}
