//! Half-tones made, and what they are written as.

use std::sync::Arc;

use glam::DVec2;

use super::{
    ink::{Ink, Mark, line_outlines},
    overstrike::Overstrike,
    picture::Picture,
    png::{pixels, png},
};
use crate::output::{
    drawing::{Path, Segment},
    sheet::{self, Layer, Print, Style, Tone},
};

/// The formats that hold pictures only. As drawings they are written from their [`Print`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum PictureFormat {
    /// Pixels.
    Png,
    /// Text to be struck line by line, several times.
    Txt,
}

/// A picture made: tones, and lines over them.
#[derive(Clone, PartialEq, Debug)]
pub struct Halftone {
    /// What its tones are made of.
    pub tones: Tones,
    /// The lines, millimetres on paper.
    pub lines: Vec<sheet::Ink>,
    /// The pens of the lines.
    pub style: Style,
}

/// What the tones of a picture are made of.
#[derive(Clone, PartialEq, Debug)]
pub enum Tones {
    /// Of grey or coloured pixels.
    Pixels(Picture),
    /// Of black shapes.
    Ink(Ink),
    /// Of struck signs.
    Text(Overstrike),
}

impl PictureFormat {
    /// The format of a name or extension, in upper or lower case.
    ///
    /// ```
    /// use katachi::output::halftone::PictureFormat;
    /// assert_eq!(PictureFormat::from_name("PNG"), Some(PictureFormat::Png));
    /// ```
    pub fn from_name(name: &str) -> Option<PictureFormat> {
        let all = [PictureFormat::Png, PictureFormat::Txt];
        all.into_iter().find(|format| name.eq_ignore_ascii_case(format.name()))
    }

    /// Its name, which is the extension of its files.
    pub fn name(self) -> &'static str {
        match self {
            PictureFormat::Png => "png",
            PictureFormat::Txt => "txt",
        }
    }

    /// The bytes of a picture; `None` where only struck signs are text.
    pub fn write(self, halftone: &Halftone) -> Option<Vec<u8>> {
        match (self, &halftone.tones) {
            (PictureFormat::Txt, Tones::Text(struck)) => Some(struck.text().into_bytes()),
            (PictureFormat::Txt, _) => None,
            (PictureFormat::Png, _) => Some(png(&halftone.picture())),
        }
    }
}

impl Halftone {
    /// Tones and lines as ink for a page.
    pub fn print(&self) -> Print {
        let (tones, frame) = match &self.tones {
            Tones::Pixels(picture) => {
                let (window, pixels) = (picture.frame.window, Arc::new(pixels(picture)));
                let tone = Tone::Pixels { min: window.min, max: window.max, pixels };
                (vec![tone], picture.frame)
            }
            Tones::Ink(ink) | Tones::Text(Overstrike { ink, .. }) => (tones(&ink.marks), ink.frame),
        };
        let ink =
            |tone| sheet::Ink { layer: Layer::Tone, mark: sheet::Mark::Tone(tone), part: None };
        let inks = tones.into_iter().map(ink).chain(self.lines.iter().cloned()).collect();
        Print { inks, style: self.style.clone(), min: frame.window.min, max: frame.window.max }
    }

    /// Tones and lines as pixels.
    pub fn picture(&self) -> Picture {
        let outline = |ink: &sheet::Ink| {
            let sheet::Mark::Line(path) = &ink.mark else { return vec![] };
            line_outlines(&points(path), self.style.pen(ink.layer).width)
        };
        let lines: Vec<Vec<DVec2>> = self.lines.iter().flat_map(outline).collect();
        match &self.tones {
            Tones::Pixels(picture) => picture.covered_by(&lines),
            Tones::Ink(ink) | Tones::Text(Overstrike { ink, .. }) => {
                ink.picture().covered_by(&lines)
            }
        }
    }
}

/// Marks sorted by what they are; strokes have one pen.
fn tones(marks: &[Mark]) -> Vec<Tone> {
    let (mut dots, mut areas, mut strokes, mut pen) = (vec![], vec![], vec![], 0.0);
    for mark in marks {
        match mark {
            Mark::Dot { center, radius } => dots.push((*center, *radius)),
            Mark::Area(rings) => areas.push(rings.clone()),
            Mark::Stroke { points, width } => {
                strokes.push(points.clone());
                pen = *width;
            }
        }
    }
    let mut tones = vec![];
    if !dots.is_empty() {
        tones.push(Tone::Dots(dots));
    }
    if !areas.is_empty() {
        tones.push(Tone::Areas(areas));
    }
    if !strokes.is_empty() {
        tones.push(Tone::Strokes { strokes, width: pen });
    }
    tones
}

/// Chords of a curved line to a millimetre.
const CHORDS: f64 = 4.0;

/// Chords of one curved piece of a line at least.
const LEAST: f64 = 8.0;

/// The corners of a path; chords of its curves.
fn points(path: &Path) -> Vec<DVec2> {
    let mut points = vec![path.start];
    for (start, segment) in path.pieces() {
        let count = match segment {
            Segment::Line { .. } => 1.0,
            _ => (segment.length(start) * CHORDS).ceil().max(LEAST),
        };
        points.extend((1..=count as u32).map(|i| segment.at(start, f64::from(i) / count)));
    }
    points
}
