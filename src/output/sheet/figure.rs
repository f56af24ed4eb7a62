//! A drawing with what is written on it, ready for paper.

use std::sync::Arc;

use glam::DVec2;

use super::{
    cutting::CuttingLine,
    dimension::Dimension,
    hatch::{Cut, hatched},
    isometric_grid::IsometricGrid,
    lettering::{Anchor, Lettering, write},
    page::{Group, Ink, Mark, Page, bounds, moved, placed},
    pen::{Layer, Style},
};
use crate::output::drawing::{Class, Drawing, Kind, Line, Path, Segment};

/// Free paper around a drawing that has a page of its own, mm.
const MARGIN: f64 = 5.0;

/// How far centre lines go beyond what they belong to, mm on paper.
const BEYOND: f64 = 3.0;

/// Captions are so much higher than dimensions (ISO 128-3).
const CAPTION: f64 = 1.4;

/// A drawing and its annotations, mm at scale 1.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Figure {
    /// The lines.
    pub drawing: Drawing,
    /// Names of the bodies that lines belong to, by their number.
    pub parts: Vec<Option<Arc<str>>>,
    /// Cut faces.
    pub cuts: Vec<Cut>,
    /// Ends of centre lines: the line goes on a little beyond each, away from the other.
    pub axes: Vec<[DVec2; 2]>,
    /// Where sections are cut.
    pub cuttings: Vec<CuttingLine>,
    /// The guide mesh under it.
    pub grid: Option<IsometricGrid>,
    /// What is written above it; may be empty.
    pub caption: String,
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
        self.lengthen_axes(scale, &mut inks);
        let height = self.style.text_height;
        let outline = bounds(&inks);
        for cutting in &self.cuttings {
            inks.extend(cutting.inks(scale, outline, height, lettering));
        }
        for dimension in &self.dimensions {
            inks.extend(dimension.inks(scale, height, lettering));
        }
        if let Some(grid) = &self.grid {
            inks.extend(grid.inks(scale, bounds(&inks), height, lettering));
        }
        if let Some((min, max)) = bounds(&inks).filter(|_| !self.caption.is_empty()) {
            let at = DVec2::new((min.x + max.x) / 2.0, max.y + height);
            let place = (at, Anchor::Middle, 0.0);
            inks.push(write(lettering, Layer::Dimension, &self.caption, height * CAPTION, place));
        }
        inks
    }

    /// Lets centre lines go on beyond what they belong to, as far on paper at any scale.
    fn lengthen_axes(&self, scale: f64, inks: &mut Vec<Ink>) {
        for [a, b] in &self.axes {
            for (end, other) in [(*a * scale, *b * scale), (*b * scale, *a * scale)] {
                let beyond = end + (end - other).normalize_or_zero() * BEYOND;
                let known = inks.iter_mut().filter(|ink| ink.layer == Layer::Center);
                let mut paths = known.filter_map(|ink| match &mut ink.mark {
                    Mark::Line(path) => Some(path),
                    _ => None,
                });
                if !paths.any(|path| lengthened(path, end, beyond)) && end != beyond {
                    inks.push(Ink::stroke(Layer::Center, end, beyond));
                }
            }
        }
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
            let places = [0.25, 0.5, 0.75].map(|t| segment.at(start, t));
            let on = |cut: &Cut| places.iter().all(|p| cut.has_on_outline(*p));
            let cut = self.cuts.iter().any(on);
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
        let group =
            Group { name: title.into(), data: vec![], style: self.style.clone(), clip: None, inks };
        Page { size: max - min + 2.0 * MARGIN, title: title.into(), groups: vec![group] }
    }
}

/// Moves the end of a straight line that is at a point; whether it is there.
fn lengthened(path: &mut Path, end: DVec2, to: DVec2) -> bool {
    let [Segment::Line { to: last }] = &mut path.segments[..] else { return false };
    for p in [&mut path.start, last] {
        if p.distance(end) <= SAME * (1.0 + end.length()) {
            *p = to;
            return true;
        }
    }
    false
}

/// Ends of lines that differ by less than this part of their coordinates are one: merging rounds them.
const SAME: f64 = 1e-6;

fn layer(line: &Line) -> Layer {
    match (line.class, line.kind) {
        (Class::Hidden, _) => Layer::Hidden,
        (Class::Cutting, _) => Layer::Cutting,
        (Class::Centre, _) => Layer::Center,
        (Class::Visible, Kind::Pattern) => Layer::Pattern,
        (Class::Visible, Kind::Shadow) => Layer::Shadow,
        (Class::Visible, Kind::Free) => Layer::Free,
        (Class::Visible, Kind::Upper) => Layer::Upper,
        (Class::Visible, Kind::Lower) => Layer::Lower,
        (Class::Visible, _) => Layer::Visible,
    }
}
