//! Black shapes on white paper: what screens make of tones.

use glam::DVec2;
use rayon::prelude::*;

use super::picture::{Frame, Picture};
use crate::geom::trig::{cos_deg, sin_deg};

/// Shapes of ink, millimetres on paper. They may cover each other; ink is black once.
#[derive(Clone, PartialEq, Debug)]
pub struct Ink {
    /// The paper.
    pub frame: Frame,
    /// The shapes.
    pub marks: Vec<Mark>,
}

/// A shape of ink.
#[derive(Clone, PartialEq, Debug)]
pub enum Mark {
    /// A round dot.
    Dot {
        /// Its middle.
        center: DVec2,
        /// Its radius.
        radius: f64,
    },
    /// A filled area: an outer polygon, counter-clockwise, and those of holes, clockwise.
    Area(Vec<Vec<DVec2>>),
    /// A stroke with blunt ends that bends little from piece to piece.
    Stroke {
        /// From where the pen is put down to where it is lifted; at least two.
        points: Vec<DVec2>,
        /// Width of the pen, the same for all strokes of a picture.
        width: f64,
    },
}

/// Corners of the polygon with the area of a dot that stands for it in pixels.
const CORNERS: u32 = 24;

/// Lines to a row of pixels.
const LINES: usize = 8;

/// Rows that are made together.
const BAND: usize = 8;

impl Mark {
    /// Polygons that cover it together; those of dots have their area.
    fn outlines(&self) -> Vec<Vec<DVec2>> {
        match self {
            Mark::Area(rings) => rings.clone(),
            Mark::Stroke { points, width } => vec![ribbon(points, *width)],
            Mark::Dot { center, radius } => vec![disc(*center, *radius)],
        }
    }
}

/// A polygon with the area of a disc.
fn disc(center: DVec2, radius: f64) -> Vec<DVec2> {
    let step = 360.0 / f64::from(CORNERS);
    // A regular polygon has n / 2 r^2 sin(360 / n) for pi r^2.
    let share = f64::from(CORNERS) / 2.0 * sin_deg(step) / std::f64::consts::PI;
    let r = radius / share.sqrt();
    let corner = |i: u32| DVec2::new(cos_deg(step * f64::from(i)), sin_deg(step * f64::from(i)));
    (0..CORNERS).map(|i| center + corner(i) * r).collect()
}

/// What a pen covers along points, with blunt ends.
fn ribbon(points: &[DVec2], width: f64) -> Vec<DVec2> {
    let side = |i: usize| {
        let (before, after) = (points[i.saturating_sub(1)], points[(i + 1).min(points.len() - 1)]);
        (after - before).normalize_or_zero().perp() * (width / 2.0)
    };
    let right = (0..points.len()).map(|i| points[i] - side(i));
    right.chain((0..points.len()).rev().map(|i| points[i] + side(i))).collect()
}

/// Polygons that a pen with a round tip covers along points.
pub(super) fn line_outlines(points: &[DVec2], width: f64) -> Vec<Vec<DVec2>> {
    let joints = points.iter().map(|p| disc(*p, width / 2.0));
    points.windows(2).map(|ends| ribbon(ends, width)).chain(joints).collect()
}

impl Ink {
    /// The ink as pixels: a pixel is as dark as the part of it that is covered.
    pub fn picture(&self) -> Picture {
        let outlines = self.marks.par_iter().flat_map_iter(Mark::outlines).collect();
        let covered = cover(&self.frame, outlines);
        let pixels = covered.into_iter().map(|share| [1.0 - share; 3]).collect();
        Picture { frame: self.frame, pixels }
    }
}

/// The part of each pixel that polygons on paper cover together.
pub(super) fn cover(frame: &Frame, mut outlines: Vec<Vec<DVec2>>) -> Vec<f32> {
    let rows = frame.size[1] as usize;
    outlines.par_iter_mut().flatten().for_each(|p| *p = frame.column_row(*p));
    let mut bands: Vec<Vec<u32>> = vec![vec![]; rows.div_ceil(BAND)];
    for (number, outline) in (0u32..).zip(&outlines) {
        let heights = outline.iter().map(|p| (p.y, p.y));
        let Some((low, high)) = heights.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else {
            continue;
        };
        if high < 0.0 || low > rows as f64 {
            continue;
        }
        let band = |row: f64| ((row.max(0.0) as usize) / BAND).min(bands.len() - 1);
        let range = band(low)..=band(high);
        bands[range].iter_mut().for_each(|list| list.push(number));
    }
    let made = bands.into_par_iter().enumerate().map(|(number, list)| {
        let first = number * BAND;
        let last = (first + BAND).min(rows);
        let lines = (first * LINES..last * LINES).map(|line| (line as f64 + 0.5) / LINES as f64);
        let mut pixels = vec![0.0; (last - first) * frame.size[0] as usize];
        for (line, y) in lines.enumerate() {
            let row =
                &mut pixels[line / LINES * frame.size[0] as usize..][..frame.size[0] as usize];
            spans(&list, &outlines, y).into_iter().for_each(|span| fill(row, span));
        }
        pixels
    });
    made.flatten().collect()
}

/// What outlines cover of a line, from and to.
fn spans(list: &[u32], outlines: &[Vec<DVec2>], y: f64) -> Vec<(f64, f64)> {
    let mut turns: Vec<(f64, i32)> = vec![];
    for &number in list {
        let outline = &outlines[number as usize];
        for (p, q) in outline.iter().zip(outline.iter().cycle().skip(1)) {
            if (p.y <= y) != (q.y <= y) {
                let (low, high, way) = if p.y <= q.y { (p, q, 1) } else { (q, p, -1) };
                turns.push((low.x + (y - low.y) * (high.x - low.x) / (high.y - low.y), way));
            }
        }
    }
    turns.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let (mut spans, mut winding, mut from) = (vec![], 0, 0.0);
    for (x, way) in turns {
        if winding == 0 {
            from = x;
        }
        winding += way;
        if winding == 0 && x > from {
            spans.push((from, x));
        }
    }
    spans
}

/// Adds what a span covers of the pixels of a row.
fn fill(row: &mut [f32], (from, to): (f64, f64)) {
    let (from, to) = (from.max(0.0), to.min(row.len() as f64));
    for (column, pixel) in row.iter_mut().enumerate().take(to.ceil() as usize).skip(from as usize) {
        let width = to.min(column as f64 + 1.0) - from.max(column as f64);
        *pixel += (width.max(0.0) / LINES as f64) as f32;
    }
}
