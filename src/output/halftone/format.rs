//! What half-tones are written as.

use glam::DVec2;

use super::{
    ink::{Ink, Mark},
    overstrike::Overstrike,
    picture::Picture,
    png::png,
    vector::{svg, svg_of_picture},
};
use crate::output::drawing::{Class, Drawing, Path, Segment};

/// The formats of pictures.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum PictureFormat {
    /// Pixels.
    Png,
    /// Shapes of ink in millimetres; pixels where there are none.
    Svg,
    /// Text to be struck line by line, several times.
    Txt,
}

/// A picture made: tones, and lines over them.
#[derive(Clone, PartialEq, Debug)]
pub struct Halftone {
    /// What its tones are made of.
    pub tones: Tones,
    /// The lines.
    pub lines: Vec<Mark>,
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
        let all = [PictureFormat::Png, PictureFormat::Svg, PictureFormat::Txt];
        all.into_iter().find(|format| name.eq_ignore_ascii_case(format.name()))
    }

    /// Its name, which is the extension of its files.
    pub fn name(self) -> &'static str {
        match self {
            PictureFormat::Png => "png",
            PictureFormat::Svg => "svg",
            PictureFormat::Txt => "txt",
        }
    }

    /// The bytes of a picture with a title; `None` where only struck signs are text.
    pub fn write(self, halftone: &Halftone, title: &str) -> Option<Vec<u8>> {
        let Halftone { tones, lines } = halftone;
        Some(match (self, tones) {
            (PictureFormat::Txt, Tones::Text(struck)) => struck.text().into_bytes(),
            (PictureFormat::Txt, _) => return None,
            (PictureFormat::Png, Tones::Pixels(picture)) => png(&picture.with_lines(lines)),
            (PictureFormat::Svg, Tones::Pixels(picture)) => {
                svg_of_picture(picture, lines, title).into_bytes()
            }
            (PictureFormat::Png, Tones::Ink(ink) | Tones::Text(Overstrike { ink, .. })) => {
                png(&ink.with(lines).picture())
            }
            (PictureFormat::Svg, Tones::Ink(ink) | Tones::Text(Overstrike { ink, .. })) => {
                svg(&ink.with(lines), title).into_bytes()
            }
        })
    }
}

/// Chords of a curved line to a millimetre.
const CHORDS: f64 = 4.0;

/// Chords of one curved piece of a line at least.
const LEAST: f64 = 8.0;

/// The visible lines of a drawing, drawn with a pen.
pub fn lines(drawing: &Drawing, width: f64) -> Vec<Mark> {
    let visible = drawing.lines.iter().filter(|line| line.class == Class::Visible);
    visible.map(|line| Mark::Line { points: points(&line.path), width }).collect()
}

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
