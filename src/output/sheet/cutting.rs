//! Cutting planes in the view that a section is taken from (ISO 128-3): a chain line with thick ends, arrows in the
//! direction of sight, and a letter at each.

use glam::{DVec2, dvec2};

use super::{
    lettering::{Anchor, Lettering, write},
    page::{Ink, Mark},
    pen::Layer,
};

/// Between the outline of the view and a thick end, mm.
const GAP: f64 = 3.0;
/// Length of a thick end, mm.
const END: f64 = 6.0;
/// Half the width of an arrow for each length of it.
const SLOPE: f64 = 1.0 / 6.0;
/// Lengths of an arrow and of its head in heights of the text.
const ARROW: f64 = 3.0;
const HEAD: f64 = 1.5;
/// Letters are so much higher than dimensions.
const LETTER: f64 = 1.4;

/// A cutting plane seen along itself.
#[derive(Clone, PartialEq, Debug)]
pub struct CuttingLine {
    /// A point of the line, mm at scale 1.
    pub at: DVec2,
    /// Unit vector in which the section is looked at, across the line.
    pub toward: DVec2,
    /// The letter of the section.
    pub name: String,
}

impl CuttingLine {
    /// What is drawn of it at a scale, `outline` being the box around the view on paper.
    pub fn inks(
        &self,
        scale: f64,
        outline: Option<(DVec2, DVec2)>,
        height: f64,
        lettering: &dyn Lettering,
    ) -> Vec<Ink> {
        let at = self.at * scale;
        let Some(ends) = self.crossed(at, outline.unwrap_or((at, at))) else { return vec![] };
        let along = (ends[1] - ends[0]).normalize_or(self.toward.perp());
        let mut inks =
            vec![Ink::stroke(Layer::Center, ends[0] - along * GAP, ends[1] + along * GAP)];
        for (end, out) in [(ends[0], -along), (ends[1], along)] {
            let (inner, outer) = (end + out * GAP, end + out * (GAP + END));
            inks.push(Ink::stroke(Layer::Cutting, inner, outer));
            let tip = end + out * (GAP + END / 2.0);
            let tail = tip - self.toward * (ARROW * height);
            let neck = tip - self.toward * (HEAD * height);
            let side = out * (HEAD * height * SLOPE);
            inks.push(Ink::stroke(Layer::Dimension, tail, neck));
            let mark = Mark::Area(vec![vec![tip, neck + side, neck - side]]);
            inks.push(Ink { layer: Layer::Dimension, mark, part: None });
            inks.push(self.letter(tail, out, height * LETTER, lettering));
        }
        inks
    }

    /// The letter beside the tail of an arrow, on the side away from the view.
    fn letter(&self, tail: DVec2, out: DVec2, height: f64, lettering: &dyn Lettering) -> Ink {
        let middle = tail + out * height - dvec2(0.0, height / 2.0);
        let place = (middle, Anchor::Middle, 0.0);
        write(lettering, Layer::Dimension, &self.name, height, place)
    }

    /// Where the line enters and leaves a box; its ends run as far where it passes beside it.
    fn crossed(&self, at: DVec2, (min, max): (DVec2, DVec2)) -> Option<[DVec2; 2]> {
        let along = -self.toward.perp();
        let corners = [min, max, dvec2(min.x, max.y), dvec2(max.x, min.y)];
        let places = corners.map(|c| (c - at).dot(along));
        let low = places.into_iter().reduce(f64::min)?;
        let high = places.into_iter().reduce(f64::max)?;
        let straight = along.x == 0.0 || along.y == 0.0;
        if straight {
            return Some([at + along * low, at + along * high]);
        }
        // Between the sides of the box that an inclined line passes.
        let span = |from: f64, to: f64, at: f64, along: f64| {
            let (s, t) = ((from - at) / along, (to - at) / along);
            (s.min(t), s.max(t))
        };
        let (x, y) = (span(min.x, max.x, at.x, along.x), span(min.y, max.y, at.y, along.y));
        let (from, to) = (x.0.max(y.0), x.1.min(y.1));
        let (from, to) = if from < to { (from, to) } else { (low, high) };
        Some([at + along * from, at + along * to])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::sheet::{Unlettered, bounds};

    #[test]
    fn the_line_leaves_the_view_as_far_on_paper_at_any_scale() {
        let line = CuttingLine { at: dvec2(5.0, 2.0), toward: DVec2::Y, name: "A".into() };
        for scale in [1.0, 0.1] {
            let outline = (DVec2::ZERO, dvec2(20.0, 10.0) * scale);
            let inks = line.inks(scale, Some(outline), 3.5, &Unlettered);
            let strokes = inks.iter().filter(|ink| ink.layer == Layer::Cutting);
            let (min, max) = bounds(strokes).expect("ink");
            assert!((min.x + GAP + END).abs() < 1e-12);
            assert!((max - dvec2(20.0 * scale + GAP + END, 2.0 * scale)).length() < 1e-12);
        }
    }

    #[test]
    fn inclined_lines_stay_within_the_view() {
        let toward = dvec2(1.0, 1.0).normalize();
        let line = CuttingLine { at: dvec2(5.0, 5.0), toward, name: "B".into() };
        let ends = line.crossed(line.at, (DVec2::ZERO, dvec2(10.0, 20.0))).expect("a line");
        assert!(
            ends[0].distance(dvec2(0.0, 10.0)) < 1e-12
                || ends[1].distance(dvec2(0.0, 10.0)) < 1e-12
        );
    }
}
