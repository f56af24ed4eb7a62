//! Scan-line conversion: line by line, which facet is seen where.
//!
//! On a line every facet is one or more spans, and a span is as near as a straight line. Going along the line,
//! the nearest span is seen until another begins, it ends, or one comes through it. Lines run [`LINES`] to a row
//! of pixels; along a line, spans cover the parts of pixels that they cover.
//!
//! # Paper
//! The second eye of METHODS 3.4: sort, then scan line by line.

use glam::{DVec2, dvec2};
use rayon::prelude::*;

use super::{
    picture::{Frame, Picture},
    plate::{Layer, Plate},
};

/// Lines to a row of pixels.
const LINES: usize = 8;

/// Rows that are made together.
const BAND: usize = 8;

/// Spans that differ in nearness by less than this part of it lie in one plane: the one that is seen stays so.
const COPLANAR: f64 = 1e-10;

/// The colour of a plate at a column and row, given which suns shine there, a bit each.
pub(super) type Paint<'a> = &'a (dyn Fn(&Plate<'_>, DVec2, u32) -> [f32; 3] + Sync);

/// The picture of plates on white paper, and if that is wanted which plate, from 1, is seen in the middle of each pixel,
/// row by row.
pub(super) fn scan(
    plates: &[Plate<'_>],
    frame: &Frame,
    paint: Paint<'_>,
    wanted: bool,
) -> (Picture, Vec<u32>) {
    let rows = frame.size[1] as usize;
    let mut bands: Vec<Vec<u32>> = vec![vec![]; rows.div_ceil(BAND)];
    for (number, plate) in (0u32..).zip(plates) {
        let (from, to) = plate.rows();
        let last = bands.len() - 1;
        let band = |row: f64| ((row.max(0.0) as usize) / BAND).min(last);
        bands[band(from)..=band(to)].iter_mut().for_each(|list| list.push(number));
    }
    let made = bands.into_par_iter().enumerate().map(|(number, list)| {
        let first = number * BAND;
        let mut band = Band::new(plates, frame, first..(first + BAND).min(rows), wanted);
        band.make(&list, paint);
        (band.pixels, band.seen)
    });
    let (pixels, seen): (Vec<_>, Vec<_>) = made.unzip();
    (Picture { frame: *frame, pixels: pixels.concat() }, seen.concat())
}

/// Where a line crosses an edge of a layer of a plate.
#[derive(Clone, Copy)]
struct Crossing {
    plate: u32,
    layer: u32,
    x: f64,
}

/// A part of a line that a plate covers.
#[derive(Clone, Copy)]
struct Span {
    from: f64,
    to: f64,
    plate: u32,
    /// Nearness at column 0, and its growth.
    near: f64,
    rise: f64,
    /// Where crossings of its other layers begin and end in the list of the line.
    others: (u32, u32),
}

impl Span {
    fn near_at(&self, x: f64) -> f64 {
        self.near + self.rise * x
    }
}

/// Rows that are made together.
struct Band<'a> {
    plates: &'a [Plate<'a>],
    width: usize,
    rows: std::ops::Range<usize>,
    lines: Vec<Vec<Crossing>>,
    pixels: Vec<[f32; 3]>,
    /// The last colour that each pixel had of a bent plate, with the plate and its suns: that of the pixel's middle.
    colors: Vec<(u32, u32, [f32; 3])>,
    /// The plate seen in the middle of each pixel, from 1; empty if that is not wanted.
    seen: Vec<u32>,
    spans: Vec<Span>,
    active: Vec<Span>,
}

impl<'a> Band<'a> {
    fn new(
        plates: &'a [Plate<'a>],
        frame: &Frame,
        rows: std::ops::Range<usize>,
        wanted: bool,
    ) -> Band<'a> {
        let width = frame.size[0] as usize;
        let lines = vec![vec![]; rows.len() * LINES];
        let pixels = vec![[1.0; 3]; rows.len() * width];
        let colors = vec![(u32::MAX, 0, [1.0; 3]); pixels.len()];
        let seen = vec![0; if wanted { pixels.len() } else { 0 }];
        Band { plates, width, rows, lines, pixels, colors, seen, spans: vec![], active: vec![] }
    }

    fn make(&mut self, list: &[u32], paint: Paint<'_>) {
        for &plate in list {
            for (layer, part) in (0u32..).zip(&self.plates[plate as usize].layers) {
                if let Layer::Inside(edges) = part {
                    edges.iter().for_each(|edge| self.cross(plate, layer, edge));
                }
            }
        }
        for line in 0..self.lines.len() {
            let mut crossings = std::mem::take(&mut self.lines[line]);
            crossings.sort_by(|a, b| {
                (a.plate, a.layer).cmp(&(b.plate, b.layer)).then(a.x.total_cmp(&b.x))
            });
            let y = (self.rows.start * LINES + line) as f64 + 0.5;
            self.see(&crossings, y / LINES as f64, line, paint);
        }
    }

    /// Puts the crossings of an edge on the lines.
    fn cross(&mut self, plate: u32, layer: u32, [p, q]: &[DVec2; 2]) {
        let place = |y: f64| (y - self.rows.start as f64) * LINES as f64 - 0.5;
        let from = place(p.y).ceil().max(0.0) as usize;
        let to = (place(q.y).ceil().max(0.0) as usize).min(self.lines.len());
        let slope = (q.x - p.x) / (q.y - p.y);
        for line in from..to {
            let y = ((self.rows.start * LINES + line) as f64 + 0.5) / LINES as f64;
            self.lines[line].push(Crossing { plate, layer, x: p.x + (y - p.y) * slope });
        }
    }

    /// Finds what is seen along a line, and paints it.
    fn see(&mut self, crossings: &[Crossing], y: f64, line: usize, paint: Paint<'_>) {
        self.find_spans(crossings, y);
        let (mut spans, mut active) =
            (std::mem::take(&mut self.spans), std::mem::take(&mut self.active));
        spans.sort_by(|a, b| a.from.total_cmp(&b.from).then(a.plate.cmp(&b.plate)));
        active.clear();
        let (mut next, mut x) = (0, 0.0);
        loop {
            active.retain(|span| span.to > x);
            while next < spans.len() && spans[next].from <= x {
                if spans[next].to > x {
                    active.push(spans[next]);
                }
                next += 1;
            }
            let start = spans.get(next).map_or(self.width as f64, |span| span.from);
            if active.is_empty() {
                if next == spans.len() || start >= self.width as f64 {
                    break;
                }
                x = start;
                continue;
            }
            let to = active.iter().map(|span| span.to).fold(start, f64::min);
            let (seen, to) = nearest(&active, x, to.min(self.width as f64));
            if !self.seen.is_empty() && line % LINES == LINES / 2 {
                self.mark(seen.plate, (x, to), line / LINES);
            }
            self.paint(&seen, crossings, (x, to), line / LINES, paint);
            x = to;
            if x >= self.width as f64 {
                break;
            }
        }
        (self.spans, self.active) = (spans, active);
    }

    /// The spans of the plates on a line.
    fn find_spans(&mut self, crossings: &[Crossing], y: f64) {
        self.spans.clear();
        let mut start = 0;
        for own in crossings.chunk_by(|a, b| a.plate == b.plate) {
            let plate = &self.plates[own[0].plate as usize];
            let outline = own.iter().take_while(|c| c.layer == 0).count();
            let others = ((start + outline) as u32, (start + own.len()) as u32);
            for pair in own[..outline].chunks_exact(2).filter(|p| p[0].x < p[1].x && p[1].x > 0.0) {
                let near = plate.near_at(dvec2(0.0, y));
                let (from, to) = (pair[0].x.max(0.0), pair[1].x);
                let rise = plate.near.y;
                self.spans.push(Span { from, to, plate: own[0].plate, near, rise, others });
            }
            start += own.len();
        }
    }

    /// Writes down that a plate is seen in the middles of pixels.
    fn mark(&mut self, plate: u32, (from, to): (f64, f64), row: usize) {
        let middles = [from, to].map(|x| (x - 0.5).ceil().max(0.0) as usize);
        let row = &mut self.seen[row * self.width..][..self.width];
        let to = middles[1].min(self.width);
        row[middles[0].min(to)..to].fill(plate + 1);
    }

    /// Paints a part of a line with a plate.
    fn paint(
        &mut self,
        span: &Span,
        crossings: &[Crossing],
        (from, to): (f64, f64),
        row: usize,
        paint: Paint<'_>,
    ) {
        let plate = &self.plates[span.plate as usize];
        let others = &crossings[span.others.0 as usize..span.others.1 as usize];
        let mut at = from;
        while at < to {
            let past = others.iter().map(|c| c.x).filter(|x| *x > at);
            let end = past.fold(to, f64::min);
            let suns = suns(plate, others, (at + end) / 2.0);
            self.fill((span.plate, suns), (at, end), row, paint);
            at = end;
        }
    }

    /// Adds to pixels what a plate, with some suns on it, covers of them.
    fn fill(
        &mut self,
        (number, suns): (u32, u32),
        (from, to): (f64, f64),
        row: usize,
        paint: Paint<'_>,
    ) {
        let plate = &self.plates[number as usize];
        let last = (to.ceil() as usize).min(self.width);
        let middle =
            |column: usize| dvec2(column as f64 + 0.5, (self.rows.start + row) as f64 + 0.5);
        let flat = plate.is_flat().then(|| paint(plate, middle(from as usize), suns));
        for column in from as usize..last {
            let place = row * self.width + column;
            let known = self.colors[place];
            let color = match flat {
                Some(color) => color,
                None if (known.0, known.1) == (number, suns) => known.2,
                None => {
                    let color = paint(plate, middle(column), suns);
                    self.colors[place] = (number, suns, color);
                    color
                }
            };
            let (low, high) = (from.max(column as f64), to.min(column as f64 + 1.0));
            let share = ((high - low) / LINES as f64) as f32;
            for (part, color) in self.pixels[place].iter_mut().zip(color) {
                *part += (color - 1.0) * share;
            }
        }
    }
}

/// Which suns shine on a plate at a column, a bit each.
fn suns(plate: &Plate<'_>, others: &[Crossing], x: f64) -> u32 {
    let shines = |(number, layer): (u32, &Layer)| match layer {
        Layer::All => true,
        Layer::None => false,
        Layer::Inside(_) => {
            let before = others.iter().filter(|c| c.layer == number && c.x < x).count();
            before % 2 == 1
        }
    };
    let layers = (0u32..).zip(&plate.layers).skip(1);
    layers.filter(|l| shines(*l)).fold(0, |suns, (number, _)| suns | 1 << (number - 1))
}

/// The nearest of some spans from `from` on, and up to where.
fn nearest(active: &[Span], from: f64, to: f64) -> (Span, f64) {
    let ahead = |a: &Span, b: &Span, x: f64| {
        let (p, q) = (a.near_at(x), b.near_at(x));
        p > q + q.abs().max(p.abs()) * COPLANAR
    };
    let middle = |to: f64| (from + to) / 2.0;
    let mut best = active[0];
    let mut to = to;
    for span in &active[1..] {
        let small = from + (to - from) * 1e-6;
        if ahead(span, &best, small)
            || (!ahead(&best, span, small) && ahead(span, &best, middle(to)))
        {
            best = *span;
        }
    }
    for span in active.iter().filter(|s| s.plate != best.plate) {
        if ahead(span, &best, to) {
            let cross = (best.near - span.near) / (span.rise - best.rise);
            if cross > from && cross < to {
                to = cross;
            }
        }
    }
    (best, to)
}
