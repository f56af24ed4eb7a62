//! Ink on paper: what all writers of drawings take.

use std::sync::Arc;

use glam::{DVec2, dvec2};

use super::{
    pen::{Layer, Style},
    tone::Tone,
};
use crate::output::drawing::{Path, Segment};

/// A sheet of paper, millimetres from its lower left corner, y up.
#[derive(Clone, PartialEq, Debug)]
pub struct Page {
    /// Width and height.
    pub size: DVec2,
    /// What it shows.
    pub title: String,
    /// What is on it, the lowest first.
    pub groups: Vec<Group>,
}

/// Inks that belong together: a view, or the frame of the page.
#[derive(Clone, PartialEq, Debug)]
pub struct Group {
    /// What it is called; empty when it has no name of its own.
    pub name: String,
    /// What else is known of it, such as its scale: name and text.
    pub data: Vec<(&'static str, String)>,
    /// Its pens.
    pub style: Style,
    /// Opposite corners of the rectangle that its inks end at, if there is one.
    pub clip: Option<(DVec2, DVec2)>,
    /// Lines, areas and letters.
    pub inks: Vec<Ink>,
}

impl Group {
    /// The inks of a layer.
    pub fn layer(&self, layer: Layer) -> impl Iterator<Item = &Ink> {
        self.inks.iter().filter(move |ink| ink.layer == layer)
    }
}

/// Something drawn.
#[derive(Clone, PartialEq, Debug)]
pub struct Ink {
    /// What it stands for.
    pub layer: Layer,
    /// What is drawn.
    pub mark: Mark,
    /// The part of the model it shows.
    pub part: Option<Arc<str>>,
}

/// What is drawn.
#[derive(Clone, PartialEq, Debug)]
pub enum Mark {
    /// A line with the pen of the layer.
    Line(Path),
    /// An area filled in the colour of the layer, bounded by closed polygons (even-odd).
    Area(Vec<Vec<DVec2>>),
    /// A line of text.
    Text(Letters),
    /// A half-tone, black whatever the pen.
    Tone(Tone),
}

/// A line of text and its outlines.
#[derive(Clone, PartialEq, Debug)]
pub struct Letters {
    /// The characters.
    pub text: String,
    /// Where its base line begins.
    pub at: DVec2,
    /// Height of capitals, mm.
    pub height: f64,
    /// Direction of the base line, degrees counter-clockwise.
    pub angle: f64,
    /// Closed polygons on the page (even-odd).
    pub outlines: Vec<Vec<DVec2>>,
}

impl Ink {
    /// A line.
    pub fn line(layer: Layer, path: Path) -> Ink {
        Ink { layer, mark: Mark::Line(path), part: None }
    }

    /// A straight line.
    pub fn stroke(layer: Layer, from: DVec2, to: DVec2) -> Ink {
        Ink::line(layer, Path::of(from, Segment::Line { to }))
    }

    /// Straight lines from point to point; nothing for fewer than two points.
    pub fn polyline(layer: Layer, points: &[DVec2]) -> Option<Ink> {
        let (&start, rest) = points.split_first()?;
        let segments: Vec<_> = rest.iter().map(|&to| Segment::Line { to }).collect();
        (!segments.is_empty()).then(|| Ink::line(layer, Path { start, segments }))
    }

    /// A rectangle by two corners.
    pub fn rectangle(layer: Layer, min: DVec2, max: DVec2) -> Ink {
        let corners = [dvec2(max.x, min.y), max, dvec2(min.x, max.y), min];
        let segments = corners.map(|to| Segment::Line { to }).to_vec();
        Ink::line(layer, Path { start: min, segments })
    }
}

/// The box around inks; `None` when there are none. Exact for lines and arcs, not smaller than the curve for others.
pub fn bounds<'a>(inks: impl IntoIterator<Item = &'a Ink>) -> Option<(DVec2, DVec2)> {
    let mut reach = Reach::default();
    for ink in inks {
        match &ink.mark {
            Mark::Line(path) => reach.path(path),
            Mark::Area(rings) => rings.iter().flatten().for_each(|&p| reach.point(p)),
            Mark::Text(text) => text.outlines.iter().flatten().for_each(|&p| reach.point(p)),
            Mark::Tone(tone) => tone.corners().into_iter().for_each(|p| reach.point(p)),
        }
    }
    reach.0
}

#[derive(Default)]
struct Reach(Option<(DVec2, DVec2)>);

impl Reach {
    fn point(&mut self, p: DVec2) {
        self.0 = Some(self.0.map_or((p, p), |(min, max)| (min.min(p), max.max(p))));
    }

    fn path(&mut self, path: &Path) {
        self.point(path.start);
        for (start, segment) in path.pieces() {
            self.point(segment.end());
            match *segment {
                Segment::Line { .. } => {}
                Segment::Cubic { first, second, .. } => {
                    self.point(first);
                    self.point(second);
                }
                Segment::Arc { major, minor, from, to, .. } => {
                    for t in turning_points(major, minor, from, to) {
                        self.point(segment.at(start, t));
                    }
                }
            }
        }
    }
}

/// Where in 0..1 an arc runs along an axis.
fn turning_points(major: DVec2, minor: DVec2, from: f64, to: f64) -> impl Iterator<Item = f64> {
    use std::f64::consts::PI;
    let angles = [libm::atan2(minor.x, major.x), libm::atan2(minor.y, major.y)];
    let (low, high) = (from.min(to), from.max(to));
    angles.into_iter().flat_map(move |angle| {
        let first = angle + ((low - angle) / PI).ceil() * PI;
        let count = ((high - first) / PI).floor() + 1.0;
        (0..count.clamp(0.0, 4.0) as u32)
            .map(move |i| (first + f64::from(i) * PI - from) / (to - from))
    })
}

/// A path scaled and then moved.
pub fn placed(path: &Path, scale: f64, offset: DVec2) -> Path {
    let point = |p: DVec2| p * scale + offset;
    let segment = |segment: &Segment| match *segment {
        Segment::Line { to } => Segment::Line { to: point(to) },
        Segment::Cubic { first, second, to } => {
            Segment::Cubic { first: point(first), second: point(second), to: point(to) }
        }
        Segment::Arc { center, major, minor, from, to } => {
            let (major, minor) = (major * scale, minor * scale);
            Segment::Arc { center: point(center), major, minor, from, to }
        }
    };
    Path { start: point(path.start), segments: path.segments.iter().map(segment).collect() }
}

/// An ink moved.
pub fn moved(ink: &Ink, offset: DVec2) -> Ink {
    let rings = |rings: &Vec<Vec<DVec2>>| -> Vec<Vec<DVec2>> {
        rings.iter().map(|ring| ring.iter().map(|&p| p + offset).collect()).collect()
    };
    let mark = match &ink.mark {
        Mark::Line(path) => Mark::Line(placed(path, 1.0, offset)),
        Mark::Area(area) => Mark::Area(rings(area)),
        Mark::Text(text) => {
            let outlines = rings(&text.outlines);
            Mark::Text(Letters { at: text.at + offset, outlines, ..text.clone() })
        }
        Mark::Tone(tone) => Mark::Tone(tone.moved(offset)),
    };
    Ink { layer: ink.layer, mark, part: ink.part.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_around_arcs_are_exact() {
        let arc = |from: f64, to: f64| {
            let major = dvec2(3.0, 4.0);
            let segment =
                Segment::Arc { center: dvec2(1.0, 1.0), major, minor: major.perp(), from, to };
            Ink::line(Layer::Visible, Path::of(segment.at(DVec2::ZERO, 0.0), segment))
        };
        let (min, max) = bounds([&arc(0.0, std::f64::consts::TAU)]).expect("ink");
        assert!(min.distance(dvec2(-4.0, -4.0)) < 1e-12 && max.distance(dvec2(6.0, 6.0)) < 1e-12);
        let (min, max) = bounds([&arc(0.5, -0.5)]).expect("ink");
        assert!(max.distance(dvec2(5.5504, 5.9486)) < 1e-3 && min.y > 3.0);
        assert_eq!(bounds([]), None);
    }
}
