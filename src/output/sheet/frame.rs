//! Frame (ISO 5457) and title block (ISO 7200).

use std::f64::consts::TAU;

use glam::{DVec2, dvec2};

use super::{
    lettering::{Anchor, Lettering, write},
    page::Ink,
    pen::Layer,
};
use crate::output::drawing::{Path, Segment};

/// Free paper at the left, where the sheet is filed, mm.
const FILING: f64 = 20.0;
/// Free paper on the other sides, mm.
const BORDER: f64 = 10.0;
/// Length of the centring marks into the drawing area, mm.
const CENTRING: f64 = 5.0;
/// Width of the title block, mm.
const BLOCK: f64 = 180.0;
/// Height of a row of the title block, mm.
const ROW: f64 = 9.0;
/// Height of the row with the title, mm.
const TITLE_ROW: f64 = 14.0;
/// Heights of labels, entries and the title, mm.
const LABEL: f64 = 1.8;
const ENTRY: f64 = 2.5;
const TITLE: f64 = 5.0;

/// What stands in the title block.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Title {
    /// The title.
    pub title: String,
    /// Fields: what they are and what they say.
    pub fields: Vec<(String, String)>,
}

/// The drawing area of a page: lower left and upper right corner, mm. `None` when the borders leave nothing.
pub fn drawing_area(size: DVec2) -> Option<(DVec2, DVec2)> {
    let (min, max) = (dvec2(FILING, BORDER), size - BORDER);
    (max - min).cmpgt(DVec2::ZERO).all().then_some((min, max))
}

/// The frame around the drawing area with centring marks; the lower one stays outside, where a title block may stand.
pub fn frame((min, max): (DVec2, DVec2), size: DVec2) -> Vec<Ink> {
    let middle = size / 2.0;
    let mark = |from: DVec2, to: DVec2| Ink::stroke(Layer::Frame, from, to);
    vec![
        Ink::rectangle(Layer::Frame, min, max),
        mark(dvec2(min.x - CENTRING, middle.y), dvec2(min.x + CENTRING, middle.y)),
        mark(dvec2(max.x + CENTRING, middle.y), dvec2(max.x - CENTRING, middle.y)),
        mark(dvec2(middle.x, min.y - CENTRING), dvec2(middle.x, min.y)),
        mark(dvec2(middle.x, max.y + CENTRING), dvec2(middle.x, max.y - CENTRING)),
    ]
}

/// The size of a title block with so many fields in a drawing area of a width, mm.
pub fn block_size(width: f64, fields: usize) -> DVec2 {
    dvec2(BLOCK.min(width), TITLE_ROW + ROW * fields.div_ceil(COLUMNS).max(1) as f64)
}

/// Fields side by side.
const COLUMNS: usize = 4;

/// The title block in the lower right corner of the drawing area, with the symbol of the projection.
pub fn title_block(
    title: &Title,
    corner: DVec2,
    width: f64,
    first_angle: bool,
    lettering: &dyn Lettering,
) -> Vec<Ink> {
    let size = block_size(width, title.fields.len());
    let min = dvec2(corner.x - size.x, corner.y);
    let max = min + size;
    let mut inks = vec![Ink::rectangle(Layer::Title, min, max)];
    let title_base = max.y - TITLE_ROW;
    inks.push(Ink::stroke(Layer::Title, dvec2(min.x, title_base), dvec2(max.x, title_base)));
    let place = (dvec2(min.x + 3.0, title_base + 4.5), Anchor::Start, 0.0);
    inks.push(write(lettering, Layer::Title, &title.title, TITLE, place));
    inks.extend(symbol(dvec2(max.x - 20.0, title_base + TITLE_ROW / 2.0), first_angle));
    let column = size.x / COLUMNS as f64;
    for (i, (label, entry)) in title.fields.iter().enumerate() {
        let (x, row) = (min.x + column * (i % COLUMNS) as f64, (i / COLUMNS) as f64);
        let top = title_base - row * ROW;
        if i % COLUMNS == 0 && i > 0 {
            inks.push(Ink::stroke(Layer::Title, dvec2(min.x, top), dvec2(max.x, top)));
        }
        if i % COLUMNS > 0 {
            inks.push(Ink::stroke(Layer::Title, dvec2(x, top), dvec2(x, top - ROW)));
        }
        for (text, height, down) in [(label, LABEL, 2.8), (entry, ENTRY, 7.2)] {
            let place = (dvec2(x + 1.5, top - down), Anchor::Start, 0.0);
            inks.push(write(lettering, Layer::Title, text, height, place));
        }
    }
    inks
}

/// A truncated cone in two views, as the projection arranges them (ISO 5456-2), about a point.
fn symbol(center: DVec2, first_angle: bool) -> Vec<Ink> {
    let side = if first_angle { 1.0 } else { -1.0 };
    let (small, large) = (2.0, 4.0);
    let cone = center - dvec2(side * 5.0, 0.0);
    let eye = center + dvec2(side * 6.0, 0.0);
    // The view from the left shows the small end, which points to the left.
    let corners = [
        cone + dvec2(-4.0, -small),
        cone + dvec2(4.0, -large),
        cone + dvec2(4.0, large),
        cone + dvec2(-4.0, small),
        cone + dvec2(-4.0, -small),
    ];
    let mut inks: Vec<Ink> = Ink::polyline(Layer::Title, &corners).into_iter().collect();
    for r in [small, large] {
        let (major, minor) = (dvec2(r, 0.0), dvec2(0.0, r));
        let arc = Segment::Arc { center: eye, major, minor, from: 0.0, to: TAU };
        inks.push(Ink::line(Layer::Title, Path::of(eye + major, arc)));
    }
    let across = |c: DVec2, reach: f64| {
        Ink::stroke(Layer::Center, c - dvec2(reach, 0.0), c + dvec2(reach, 0.0))
    };
    inks.push(across(cone, 5.5));
    inks.push(across(eye, 5.5));
    inks.push(Ink::stroke(Layer::Center, eye - dvec2(0.0, 5.5), eye + dvec2(0.0, 5.5)));
    inks
}
