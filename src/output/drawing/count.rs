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

use super::{
    cells::{Cells, Extent, Sieve},
    clip::Clipper,
    lattice::Scanline,
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
    cuts: Vec<f64>,
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
        Tally { sieve: Sieve::new(self.model.outlines.len()), steps: vec![], cuts: vec![] }
    }

    /// Appends the spans of an edge that pierces no face.
    pub fn hide(&self, edge: &Edge, tally: &mut Tally, out: &mut Vec<Span>) {
        let [p, q] = [edge.a, edge.b].map(|i| self.model.at[i as usize]);
        let line = Scanline::new(p, q);
        let Tally { sieve, steps, cuts } = tally;
        steps.clear();
        sieve.next_round();
        self.cells.along(p, q, |i| {
            if sieve.passes(i) {
                steps.extend(self.step(edge, &line, &self.model.outlines[i as usize]));
            }
        });
        steps.sort_unstable_by(|a, b| a.at.total_cmp(&b.at));
        let (seed, before) = widest(steps);
        let order = self.clipper.order_at(edge, &line, seed, cuts) as i32;
        spans(steps, order - before, self.model.dust / line.length(), out);
    }

    /// The change of the order where an edge crosses an outline in front of it.
    #[inline]
    fn step(&self, edge: &Edge, line: &Scanline, outline: &Outline) -> Option<Step> {
        let [a, b] = [outline.a, outline.b].map(|i| line.sighted(self.model.at[i as usize]));
        let at = line.crossing(a, b).filter(|t| *t > 0.0 && *t < 1.0)?;
        let plane = &self.model.facets[outline.facet as usize].plane;
        let [low, high] = self.model.heights(edge, plane);
        // The facet is on the left of the outline: an outline that runs to the left of the edge has it behind.
        let by = if b.side > 0.0 { -1 } else { 1 };
        (low + (high - low) * at < 0.0).then_some(Step { at, by })
    }
}

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
