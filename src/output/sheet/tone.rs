//! Half-tones on paper: black shapes or pixels.

use std::sync::Arc;

use glam::DVec2;

use super::{
    page::{Group, Ink, Page},
    pen::Style,
};
use crate::output::pixels::Pixels;

/// What the tones of a picture are made of, millimetres on the page, y up.
#[derive(Clone, PartialEq, Debug)]
pub enum Tone {
    /// Black discs: centre and radius of each.
    Dots(Vec<(DVec2, f64)>),
    /// Black areas, each bounded by closed polygons (even-odd).
    Areas(Vec<Vec<Vec<DVec2>>>),
    /// Strokes of one pen with blunt ends.
    Strokes {
        /// The corners of each.
        strokes: Vec<Vec<DVec2>>,
        /// Width of the pen.
        width: f64,
    },
    /// Pixels that fill a rectangle.
    Pixels {
        /// Its lower left corner.
        min: DVec2,
        /// Its upper right corner.
        max: DVec2,
        /// What fills it.
        pixels: Arc<Pixels>,
    },
}

impl Tone {
    /// The corners of its shapes, and of boxes around dots.
    pub(super) fn corners(&self) -> Vec<DVec2> {
        match self {
            Tone::Dots(dots) => dots.iter().flat_map(|(p, r)| [*p - *r, *p + *r]).collect(),
            Tone::Areas(areas) => areas.iter().flatten().flatten().copied().collect(),
            Tone::Strokes { strokes, .. } => strokes.iter().flatten().copied().collect(),
            Tone::Pixels { min, max, .. } => vec![*min, *max],
        }
    }

    /// The same elsewhere.
    pub(super) fn moved(&self, offset: DVec2) -> Tone {
        let all = |points: &Vec<DVec2>| points.iter().map(|&p| p + offset).collect::<Vec<_>>();
        match self {
            Tone::Dots(dots) => Tone::Dots(dots.iter().map(|(p, r)| (p + offset, *r)).collect()),
            Tone::Areas(areas) => {
                Tone::Areas(areas.iter().map(|area| area.iter().map(all).collect()).collect())
            }
            Tone::Strokes { strokes, width } => {
                Tone::Strokes { strokes: strokes.iter().map(all).collect(), width: *width }
            }
            Tone::Pixels { min, max, pixels } => {
                let (min, max) = (min + offset, max + offset);
                Tone::Pixels { min, max, pixels: pixels.clone() }
            }
        }
    }
}

/// A picture as ink at its size on paper, its origin at the origin of the paper.
#[derive(Clone, PartialEq, Debug)]
pub struct Print {
    /// Tones, and lines over them.
    pub inks: Vec<Ink>,
    /// The pens of the lines.
    pub style: Style,
    /// Its lower left corner, mm. What is drawn beyond its border is cut off.
    pub min: DVec2,
    /// Its upper right corner, mm.
    pub max: DVec2,
}

impl Print {
    /// A page of its size.
    pub fn page(&self, title: &str) -> Page {
        let size = self.max - self.min;
        let inks = self.inks.iter().map(|ink| super::page::moved(ink, -self.min)).collect();
        let (name, clip) = (title.into(), Some((DVec2::ZERO, size)));
        let group = Group { name, data: vec![], style: self.style.clone(), clip, inks };
        Page { size, title: title.into(), groups: vec![group] }
    }
}
