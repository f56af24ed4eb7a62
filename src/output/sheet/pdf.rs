//! PDF: one page, a layer (optional content group) for each class of line, text as outlines.
//!
//! Written with pdf-writer, the low floor of krilla: drawings need no fonts, images or tagging, but layers, which
//! krilla does not offer.

use glam::DVec2;
use pdf_writer::{
    Content, Finish, Name, Pdf, Rect, Ref, TextStr,
    types::{LineCapStyle, LineJoinStyle},
};

use super::{
    page::{Group, Mark, Page},
    pen::{Layer, Pen},
};
use crate::{
    geom::mesh::Color,
    output::drawing::{Path, Segment},
};

/// Points (1/72 inch) for each millimetre.
const POINTS: f64 = 72.0 / 25.4;

const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const PAGE: Ref = Ref::new(3);
const CONTENT: Ref = Ref::new(4);
const INFO: Ref = Ref::new(5);
/// The first layer's number; the others follow.
const FIRST_LAYER: i32 = 6;

/// The page as the bytes of a PDF file. It holds no date.
///
/// ```
/// use katachi::output::sheet::{Figure, Unlettered, pdf};
/// let bytes = pdf::write(&Figure::default().page("empty", &Unlettered));
/// assert!(bytes.starts_with(b"%PDF-1.7") && bytes.ends_with(b"%%EOF"));
/// ```
pub fn write(page: &Page) -> Vec<u8> {
    let has = |layer: &Layer| page.groups.iter().any(|g| g.layer(*layer).next().is_some());
    let layers: Vec<Layer> = Layer::ALL.into_iter().filter(has).collect();
    let refs: Vec<Ref> = (FIRST_LAYER..).take(layers.len()).map(Ref::new).collect();
    let mut pdf = Pdf::new();
    write_catalog(&mut pdf, &refs);
    pdf.pages(PAGES).kids([PAGE]).count(1);
    let mut sheet = pdf.page(PAGE);
    let size = page.size * POINTS;
    sheet.media_box(Rect::new(0.0, 0.0, size.x as f32, size.y as f32));
    sheet.parent(PAGES).contents(CONTENT);
    let mut resources = sheet.resources();
    let mut properties = resources.insert(Name(b"Properties")).dict();
    for (layer, &reference) in layers.iter().zip(&refs) {
        properties.pair(Name(layer.name().as_bytes()), reference);
    }
    properties.finish();
    resources.finish();
    sheet.finish();
    for (layer, &reference) in layers.iter().zip(&refs) {
        let mut group = pdf.indirect(reference).dict();
        group.pair(Name(b"Type"), Name(b"OCG"));
        group.pair(Name(b"Name"), TextStr(layer.name()));
    }
    pdf.stream(CONTENT, &content(page));
    let mut info = pdf.document_info(INFO);
    info.title(TextStr(&page.title));
    info.producer(TextStr(concat!("katachi ", env!("CARGO_PKG_VERSION"))));
    info.finish();
    pdf.finish()
}

fn write_catalog(pdf: &mut Pdf, layers: &[Ref]) {
    let mut catalog = pdf.catalog(CATALOG);
    catalog.pages(PAGES);
    let mut optional = catalog.insert(Name(b"OCProperties")).dict();
    optional.insert(Name(b"OCGs")).array().items(layers);
    let mut standard = optional.insert(Name(b"D")).dict();
    standard.insert(Name(b"Order")).array().items(layers);
    standard.insert(Name(b"ON")).array().items(layers);
}

fn content(page: &Page) -> Vec<u8> {
    let mut content = Content::new();
    content.transform([POINTS as f32, 0.0, 0.0, POINTS as f32, 0.0, 0.0]);
    content.set_line_join(LineJoinStyle::RoundJoin);
    for group in &page.groups {
        for layer in Layer::ALL {
            if group.layer(layer).next().is_some() {
                draw_layer(&mut content, group, layer);
            }
        }
    }
    content.finish().into_vec()
}

fn draw_layer(content: &mut Content, group: &Group, layer: Layer) {
    content
        .begin_marked_content_with_properties(Name(b"OC"))
        .properties_named(Name(layer.name().as_bytes()));
    take(content, group.style.pen(layer));
    for ink in group.layer(layer) {
        match &ink.mark {
            Mark::Line(path) => draw_path(content, path),
            Mark::Area(rings) => fill(content, rings),
            Mark::Text(letters) => fill(content, &letters.outlines),
        }
    }
    content.end_marked_content();
}

/// Sets width, dashes and colour.
fn take(content: &mut Content, pen: &Pen) {
    let Color { r, g, b } = pen.color;
    let [r, g, b] = [r, g, b].map(|c| f32::from(c) / 255.0);
    content.set_stroke_rgb(r, g, b).set_fill_rgb(r, g, b).set_line_width(pen.width as f32);
    let cap = if pen.dash.is_empty() { LineCapStyle::RoundCap } else { LineCapStyle::ButtCap };
    content.set_line_cap(cap);
    content.set_dash_pattern(pen.dash.iter().map(|&d| d as f32), 0.0);
}

fn xy(p: DVec2) -> (f32, f32) {
    (p.x as f32, p.y as f32)
}

fn draw_path(content: &mut Content, path: &Path) {
    let (x, y) = xy(path.start);
    content.move_to(x, y);
    for (start, segment) in path.pieces() {
        match *segment {
            Segment::Line { to } => {
                let (x, y) = xy(to);
                content.line_to(x, y);
            }
            Segment::Cubic { first, second, to } => cubic(content, [first, second, to]),
            Segment::Arc { .. } => {
                cubics(start, segment).into_iter().for_each(|c| cubic(content, c));
            }
        }
    }
    if path.segments.len() > 1 && xy(path.start) == xy(path.end()) {
        content.close_path();
    }
    content.stroke();
}

fn cubic(content: &mut Content, points: [DVec2; 3]) {
    let [(a, b), (c, d), (e, f)] = points.map(xy);
    content.cubic_to(a, b, c, d, e, f);
}

/// The longest part of an arc that one cubic stands for, radians: it is off by less than 1e-5 of the radius.
const LONGEST_CUBIC: f64 = 0.8;

/// An arc as cubics: handles and end of each.
fn cubics(start: DVec2, arc: &Segment) -> Vec<[DVec2; 3]> {
    let Segment::Arc { major, minor, from, to, .. } = *arc else { return vec![] };
    let parts = ((to - from).abs() / LONGEST_CUBIC).ceil().max(1.0);
    let handle = libm::tan((to - from) / parts / 4.0) * 4.0 / 3.0;
    let tangent = |t: f64| {
        let (sin, cos) = libm::sincos(from + (to - from) * t);
        (minor * cos - major * sin) * handle
    };
    let piece = |i: u32| {
        let ends = [f64::from(i) / parts, f64::from(i + 1) / parts];
        let [a, b] = ends.map(|t| arc.at(start, t));
        [a + tangent(ends[0]), b - tangent(ends[1]), b]
    };
    (0..parts as u32).map(piece).collect()
}

fn fill(content: &mut Content, rings: &[Vec<DVec2>]) {
    for ring in rings {
        for (i, &p) in ring.iter().enumerate() {
            let (x, y) = xy(p);
            if i == 0 {
                content.move_to(x, y)
            } else {
                content.line_to(x, y)
            };
        }
        content.close_path();
    }
    content.fill_even_odd();
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn cubics_follow_the_arc() {
        let (major, minor) = (dvec2(10.0, 0.0), dvec2(0.0, 5.0));
        let arc = Segment::Arc { center: DVec2::ZERO, major, minor, from: 0.3, to: -4.0 };
        let mut at = arc.at(DVec2::ZERO, 0.0);
        let mut worst = 0.0f64;
        for [first, second, to] in cubics(DVec2::ZERO, &arc) {
            let cubic = Segment::Cubic { first, second, to };
            for i in 0..=10 {
                let p = cubic.at(at, f64::from(i) / 10.0);
                let off = (dvec2(p.x / 10.0, p.y / 5.0).length() - 1.0).abs();
                worst = worst.max(off);
            }
            at = to;
        }
        assert!(at.distance(arc.end()) < 1e-12);
        assert!(worst < 1e-5, "{worst}");
    }
}
