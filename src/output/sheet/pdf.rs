//! PDF: one page, a layer (optional content group) for each class of line. Text is drawn by its outlines, so that it
//! looks the same everywhere, under characters that are not painted but can be searched and copied.
//!
//! Written with pdf-writer, the low floor of krilla: drawings need no fonts or tagging, but layers, which krilla does
//! not offer.

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
    tone::Tone,
};
use crate::{
    geom::{
        mesh::Color,
        trig::{cos_deg, sin_deg},
    },
    output::{
        drawing::{Path, Segment},
        pixels::Pixels,
    },
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
    let images: Vec<(&Pixels, Ref)> =
        page.groups.iter().flat_map(images).zip(first_image(&refs)).collect();
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
    let mut objects = resources.x_objects();
    for (number, (_, reference)) in images.iter().enumerate() {
        objects.pair(Name(image_name(number).as_bytes()), *reference);
    }
    objects.finish();
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
    for (pixels, reference) in &images {
        write_image(&mut pdf, *reference, pixels);
    }
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

/// How hard bytes are compressed: half-tones of thousands of shapes take four times as long for the last 3 %.
const LEVEL: u32 = 4;

/// Bytes compressed. A vector takes all that is written to it.
fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(vec![], Compression::new(LEVEL));
    encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("a vector grows")
}

fn content(page: &Page) -> Vec<u8> {
    let mut content = Content::new();
    content.transform([POINTS as f32, 0.0, 0.0, POINTS as f32, 0.0, 0.0]);
    content.set_line_join(LineJoinStyle::RoundJoin);
    let mut image = 0;
    for group in &page.groups {
        content.save_state();
        if let Some((min, max)) = group.clip {
            let ((x, y), (w, h)) = (xy(min), xy(max - min));
            content.rect(x, y, w, h).clip_nonzero().end_path();
        }
        for layer in Layer::ALL {
            if group.layer(layer).next().is_some() {
                draw_layer(&mut content, group, layer, &mut image);
            }
        }
        content.restore_state();
    }
    content.finish().into_vec()
}

/// The pixels of a group, in the order in which they are drawn.
fn images(group: &Group) -> impl Iterator<Item = &Pixels> {
    group.layer(Layer::Tone).filter_map(|ink| match &ink.mark {
        Mark::Tone(Tone::Pixels { pixels, .. }) => Some(&**pixels),
        _ => None,
    })
}

/// The numbers of images follow those of layers.
fn first_image(layers: &[Ref]) -> impl Iterator<Item = Ref> {
    (FIRST_LAYER + layers.len() as i32..).map(Ref::new)
}

fn image_name(number: usize) -> String {
    format!("I{number}")
}

fn write_image(pdf: &mut Pdf, reference: Ref, pixels: &Pixels) {
    let samples = deflated(&pixels.samples);
    let mut image = pdf.image_xobject(reference, &samples);
    image.filter(Filter::FlateDecode);
    image.width(pixels.size[0] as i32).height(pixels.size[1] as i32).bits_per_component(8);
    if pixels.is_grey {
        image.color_space().device_gray();
    } else {
        image.color_space().device_rgb();
    }
}

fn draw_tone(content: &mut Content, tone: &Tone, image: &mut usize) {
    content.set_fill_gray(0.0);
    match tone {
        Tone::Dots(dots) => dots.iter().for_each(|(p, r)| disc(content, *p, *r)),
        Tone::Areas(areas) => areas.iter().for_each(|rings| fill(content, rings)),
        Tone::Strokes { strokes, width } => {
            content.set_stroke_gray(0.0).set_line_width(*width as f32);
            content.set_line_cap(LineCapStyle::ButtCap);
            for points in strokes {
                run(content, points);
                content.stroke();
            }
        }
        Tone::Pixels { min, max, .. } => {
            let ((x, y), (w, h)) = (xy(*min), xy(max - min));
            content.save_state().transform([w, 0.0, 0.0, h, x, y]);
            content.x_object(Name(image_name(*image).as_bytes())).restore_state();
            *image += 1;
        }
    }
}

/// The part of the radius that the handles of four cubics have which make a circle.
const HANDLE: f64 = 0.552_284_749_8;

/// A black disc of four cubics.
fn disc(content: &mut Content, center: DVec2, r: f64) {
    let (x, y) = xy(center + DVec2::X * r);
    content.move_to(x, y);
    let mut out = DVec2::X;
    for _ in 0..4 {
        let ahead = out.perp();
        let handles = [out + ahead * HANDLE, ahead + out * HANDLE, ahead];
        cubic(content, handles.map(|p| center + p * r));
        out = ahead;
    }
    content.fill_nonzero();
}

fn draw_layer(content: &mut Content, group: &Group, layer: Layer, image: &mut usize) {
    content
        .begin_marked_content_with_properties(Name(b"OC"))
        .properties_named(Name(layer.name().as_bytes()));
    take(content, group.style.pen(layer));
    for ink in group.layer(layer) {
        match &ink.mark {
            Mark::Line(path) => draw_path(content, path),
            Mark::Area(rings) => fill(content, rings),
            Mark::Text(letters) => write_text(content, letters),
            Mark::Tone(tone) => draw_tone(content, tone, image),
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
        run(content, ring);
        content.close_path();
    }
    content.fill_even_odd();
}

/// Straight lines from point to point.
fn run(content: &mut Content, points: &[DVec2]) {
    for (i, &p) in points.iter().enumerate() {
        let (x, y) = xy(p);
        if i == 0 {
            content.move_to(x, y)
        } else {
            content.line_to(x, y)
        };
    }
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
