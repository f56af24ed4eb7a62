//! Hidden lines by clipping every edge against every facet in front of it.
//!
//! A facet hides of an edge what lies within its picture and behind its plane. Its sides cut the line of the
//! edge in an even number of places, between which the edge runs in and out; the plane cuts it once.

use super::{
    cells::{Cells, Extent, Sieve},
    lattice::Scanline,
    model::{Edge, Facet, Model},
    span::{Span, Step, spans},
};

/// The facets of a model, ready to be asked.
pub struct Clipper<'a> {
    model: &'a Model,
    cells: Cells,
}

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
        Clipper { model, cells: Cells::new(model.facets.len(), extent) }
    }

    /// Storage for [`Clipper::hide`].
    pub fn desk(&self) -> Desk {
        Desk { sieve: Sieve::new(self.model.facets.len()), cuts: vec![], steps: vec![] }
    }

    /// Appends the spans of an edge.
    pub fn hide(&self, edge: &Edge, desk: &mut Desk, out: &mut Vec<Span>) {
        let [p, q] = [edge.a, edge.b].map(|i| self.model.at[i as usize]);
        let line = Scanline::new(p, q);
        let (min, max) = (p.min(q), p.max(q));
        let Desk { sieve, cuts, steps } = desk;
        steps.clear();
        sieve.next_round();
        self.cells.along(p, q, |i| {
            let facet = &self.model.facets[i as usize];
            let apart = facet.min.cmpgt(max) | min.cmpgt(facet.max);
            if !apart.any() && sieve.passes(i) {
                self.cut(edge, &line, facet, cuts, steps);
            }
        });
        spans(steps, 0, self.model.dust / line.length(), out);
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

    /// How many facets are in front of an edge at t; the edge runs along `line`.
    pub fn order_at(&self, edge: &Edge, line: &Scanline, t: f64, cuts: &mut Vec<f64>) -> u32 {
        let [p, q] = [edge.a, edge.b].map(|i| self.model.at[i as usize]);
        let at = p.lerp(q, t);
        let mut order = 0;
        self.cells.at(at, |i| {
            let facet = &self.model.facets[i as usize];
            let apart = (facet.min - 1.0).cmpgt(at) | (at - 1.0).cmpgt(facet.max);
            if apart.any() {
                return;
            }
            let [a, b] = self.model.heights(edge, &facet.plane);
            if a + (b - a) * t < 0.0 {
                crossings(self.model, line, facet, cuts);
                order += cuts.iter().filter(|&&c| c < t).count() as u32 & 1;
            }
        });
        order
    }
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
