//! PDF: one page, a layer (optional content group) for each class of line. Text is drawn by its outlines, so that it
//! looks the same everywhere, under characters that are not painted but can be searched and copied.
//!
//! Written with pdf-writer, the low floor of krilla: drawings need no fonts, images or tagging, but layers, which
//! krilla does not offer.

use std::io::Write;

use flate2::{Compression, write::ZlibEncoder};
use glam::DVec2;
use pdf_writer::{
    Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr,
    types::{LineCapStyle, LineJoinStyle, TextRenderingMode},
};

use super::{
    page::{Group, Letters, Mark, Page},
    pen::{Layer, Pen},
};
use crate::{
    geom::{
        mesh::Color,
        trig::{cos_deg, sin_deg},
    },
    output::drawing::{Path, Segment},
};

/// Points (1/72 inch) for each millimetre.
const POINTS: f64 = 72.0 / 25.4;

const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const PAGE: Ref = Ref::new(3);
const CONTENT: Ref = Ref::new(4);
const INFO: Ref = Ref::new(5);
const FONT: Ref = Ref::new(6);
/// The first layer's number; the others follow.
const FIRST_LAYER: i32 = 7;

/// The name of the font of characters that are not painted, and the height of its capitals for each unit of size.
const HELVETICA: Name = Name(b"F");
const CAPITALS: f64 = 0.718;

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
    resources.fonts().pair(HELVETICA, FONT);
    resources.finish();
    sheet.finish();
    for (layer, &reference) in layers.iter().zip(&refs) {
        let mut group = pdf.indirect(reference).dict();
        group.pair(Name(b"Type"), Name(b"OCG"));
        group.pair(Name(b"Name"), TextStr(layer.name()));
    }
    pdf.type1_font(FONT)
        .base_font(Name(b"Helvetica"))
        .encoding_predefined(Name(b"WinAnsiEncoding"));
    pdf.stream(CONTENT, &deflated(&content(page))).filter(Filter::FlateDecode);
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

/// Bytes compressed. A vector takes all that is written to it.
fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(vec![], Compression::best());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("a vector grows")
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
            Mark::Text(letters) => write_text(content, letters),
        }
    }
    content.end_marked_content();
}

/// Outlines, or characters of a font where the text has none, which its own font could not set.
fn write_text(content: &mut Content, letters: &Letters) {
    let painted = letters.outlines.is_empty();
    let (sin, cos) = (sin_deg(letters.angle) as f32, cos_deg(letters.angle) as f32);
    let (x, y) = xy(letters.at);
    let mode = if painted { TextRenderingMode::Fill } else { TextRenderingMode::Invisible };
    content
        .begin_text()
        .set_font(HELVETICA, (letters.height / CAPITALS) as f32)
        .set_text_rendering_mode(mode)
        .set_text_matrix([cos, sin, -sin, cos, x, y])
        .show(Str(&latin(&letters.text)))
        .end_text();
    fill(content, &letters.outlines);
}

/// A text in the encoding of the font, `?` for what it does not have.
fn latin(text: &str) -> Vec<u8> {
    let byte = |c: char| match c {
        ' '..='~' | '\u{a1}'..='\u{ff}' => c as u8,
        '\u{2013}' => 0x96,
        '\u{2014}' => 0x97,
        '\u{2018}' | '\u{2019}' => b'\'',
        '\u{201c}' | '\u{201d}' => b'"',
        '\u{2026}' => 0x85,
        '\u{20ac}' => 0x80,
        _ => b'?',
    };
    text.chars().map(byte).collect()
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
    if rings.is_empty() {
        return;
    }
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
    fn text_is_written_in_the_encoding_of_the_font() {
        assert_eq!(latin("\u{d8}20 \u{2013} 90\u{b0} \u{3b1}"), b"\xd820 \x96 90\xb0 ?");
    }

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
