//! Text on paper.

use glam::{DVec2, dvec2};

use super::page::{Ink, Letters, Mark};
use super::pen::Layer;
use crate::geom::trig::{cos_deg, sin_deg};

/// Sets a line of text.
pub trait Lettering {
    /// Outlines of a text whose capitals are `height` mm high, from the origin along +x, and its width; `None` for
    /// text that the font cannot set.
    fn outlines(&self, text: &str, height: f64) -> Option<(Vec<Vec<DVec2>>, f64)>;
}

/// Which point of a text stands where it is put.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Anchor {
    /// The start of the base line.
    Start,
    /// The middle of the base line.
    Middle,
    /// The end of the base line.
    End,
}

/// Writes a text at a point, its base line turned by `angle` degrees counter-clockwise. Text that the font cannot
/// set has no outlines and stays as text in files that have text.
pub fn write(
    lettering: &dyn Lettering,
    layer: Layer,
    text: &str,
    height: f64,
    (at, anchor, angle): (DVec2, Anchor, f64),
) -> Ink {
    let (rings, width) = lettering.outlines(text, height).unwrap_or_default();
    let back = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => width / 2.0,
        Anchor::End => width,
    };
    let along = dvec2(cos_deg(angle), sin_deg(angle));
    let start = at - along * back;
    let place = |p: &DVec2| start + along * p.x + along.perp() * p.y;
    let outlines = rings.iter().map(|ring| ring.iter().map(place).collect()).collect();
    let letters = Letters { text: text.into(), at: start, height, angle, outlines };
    Ink { layer, mark: Mark::Text(letters), part: None }
}

/// Sets nothing: for drawings without text.
#[derive(Clone, Copy, Debug)]
pub struct Unlettered;

impl Lettering for Unlettered {
    fn outlines(&self, _: &str, _: f64) -> Option<(Vec<Vec<DVec2>>, f64)> {
        None
    }
}
