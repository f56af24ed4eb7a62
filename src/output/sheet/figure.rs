//! A drawing with what is written on it, ready for paper.

use std::sync::Arc;

use glam::DVec2;

use super::{
    dimension::Dimension,
    hatch::{Cut, hatched},
    lettering::Lettering,
    page::{Group, Ink, Mark, Page, bounds, moved, placed},
    pen::{Layer, Style},
};
use crate::output::drawing::{Class, Drawing, Kind, Line, Path};

/// Free paper around a drawing that has a page of its own, mm.
const MARGIN: f64 = 5.0;

/// A drawing and its annotations, mm at scale 1.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Figure {
    /// The lines.
    pub drawing: Drawing,
    /// Names of the bodies that lines belong to, by their number.
    pub parts: Vec<Option<Arc<str>>>,
    /// Cut faces.
    pub cuts: Vec<Cut>,
    /// Dimensions.
    pub dimensions: Vec<Dimension>,
    /// Pens.
    pub style: Style,
}

impl Figure {
    /// What is drawn at a scale, the origin of the drawing at the origin of the paper.
    pub fn inks(&self, scale: f64, lettering: &dyn Lettering) -> Vec<Ink> {
        let mut inks = vec![];
        for cut in &self.cuts {
            let part = self.parts.get(cut.body as usize).cloned().flatten();
            let strokes = hatched(cut, scale, self.style.hatch_pitch);
            inks.extend(strokes.into_iter().map(|[from, to]| Ink {
                part: part.clone(),
                ..Ink::stroke(Layer::Hatch, from, to)
            }));
        }
        for line in &self.drawing.lines {
            self.add_line(line, scale, &mut inks);
        }
        for dimension in &self.dimensions {
            inks.extend(dimension.inks(scale, self.style.text_height, lettering));
        }
        inks
    }

    fn add_line(&self, line: &Line, scale: f64, inks: &mut Vec<Ink>) {
        let part = self.parts.get(line.id as usize).cloned().flatten();
        for (layer, path) in self.layered(line) {
            let mark = Mark::Line(placed(&path, scale, DVec2::ZERO));
            inks.push(Ink { layer, mark, part: part.clone() });
        }
    }

    /// A line by layers: where it runs along a cut face it is the outline of the section.
    fn layered(&self, line: &Line) -> Vec<(Layer, Path)> {
        let layer = layer(line);
        if layer != Layer::Visible || self.cuts.is_empty() {
            return vec![(layer, line.path.clone())];
        }
        let mut runs: Vec<(Layer, Path)> = vec![];
        for (start, segment) in line.path.pieces() {
            let middle = segment.at(start, 0.5);
            let cut = self.cuts.iter().any(|cut| cut.has_on_outline(middle));
            let layer = if cut { Layer::Section } else { Layer::Visible };
            match runs.last_mut() {
                Some((before, path)) if *before == layer => path.segments.push(*segment),
                _ => runs.push((layer, Path::of(start, *segment))),
            }
        }
        runs
    }

    /// A page just large enough.
    pub fn page(&self, title: &str, lettering: &dyn Lettering) -> Page {
        let inks = self.inks(1.0, lettering);
        let (min, max) = bounds(&inks).unwrap_or_default();
        let offset = DVec2::splat(MARGIN) - min;
        let inks = inks.iter().map(|ink| moved(ink, offset)).collect();
        let group = Group { name: title.into(), data: vec![], style: self.style.clone(), inks };
        Page { size: max - min + 2.0 * MARGIN, title: title.into(), groups: vec![group] }
    }
}

fn layer(line: &Line) -> Layer {
    match (line.class, line.kind) {
        (Class::Hidden, _) => Layer::Hidden,
        (Class::Cutting, _) => Layer::Cutting,
        (Class::Centre, _) => Layer::Center,
        (Class::Visible, Kind::Pattern) => Layer::Pattern,
        (Class::Visible, Kind::Free) => Layer::Free,
        (Class::Visible, _) => Layer::Visible,
    }
}
