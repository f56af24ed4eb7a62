//! DXF of AutoCAD 2000 (AC1015): layers and line types by class of line, millimetres.
//!
//! Lines are `LINE` and `LWPOLYLINE`, arcs `ARC`, `CIRCLE` and `ELLIPSE`, cubics `SPLINE`; filled areas are closed
//! polylines and text is `TEXT`, so that a person can edit both. Of half-tones, dots are circles, areas closed polylines and
//! strokes lines; of one made of pixels there is a frame with a note in it.

use std::{
    f64::consts::TAU,
    fmt::{Display, Write},
};

use glam::DVec2;

use super::{
    page::{Ink, Letters, Mark, Page},
    pen::{Layer, Pen},
    tone::Tone,
};
use crate::output::{
    drawing::{Path, Segment},
    number::Shortest,
};

/// Half axes whose lengths differ by less than this part make a circle.
const ROUND: f64 = 1e-9;

/// Height of capitals of a note, mm.
const NOTE: f64 = 2.5;

/// The page as the bytes of a DXF file.
///
/// ```
/// use katachi::output::sheet::{Figure, Unlettered, dxf};
/// let text = String::from_utf8(dxf::write(&Figure::default().page("empty", &Unlettered))).unwrap();
/// assert!(text.starts_with("  0\nSECTION") && text.contains("AC1015"));
/// ```
pub fn write(page: &Page) -> Vec<u8> {
    let mut file = File::default();
    let layers = used_layers(page);
    let mut entities = File { handle: FIRST_ENTITY, ..File::default() };
    for group in &page.groups {
        for ink in &group.inks {
            entities.ink(ink);
        }
    }
    file.header(page, entities.handle);
    file.tables(&layers);
    file.blocks();
    file.section("ENTITIES");
    file.text.push_str(&entities.text);
    file.pair(0, "ENDSEC");
    file.objects();
    file.pair(0, "EOF");
    file.text.into_bytes()
}

/// The layers that hold ink, with the pen of the first group that uses each.
fn used_layers(page: &Page) -> Vec<(Layer, Pen)> {
    let pen = |layer: Layer| {
        let mut groups = page.groups.iter();
        let group = groups.find(|group| group.layer(layer).next().is_some())?;
        Some((layer, group.style.pen(layer).clone()))
    };
    Layer::ALL.into_iter().filter_map(pen).collect()
}

// Handles of the objects that every file has.
const MODEL: u32 = 0x1F;
const PAPER: u32 = 0x1E;
const ROOT: u32 = 0xC;
/// Handles from here on are given out in order to layers and line types.
const FIRST_TABLE: u32 = 0x40;
const FIRST_ENTITY: u32 = 0x100;

/// A DXF text as it grows.
#[derive(Default)]
struct File {
    text: String,
    /// The next handle.
    handle: u32,
}

impl File {
    fn pair(&mut self, code: u32, value: impl Display) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "{code:>3}\n{value}");
    }

    fn real(&mut self, code: u32, value: f64) {
        self.pair(code, format_args!("{}", Shortest(value)));
    }

    fn point(&mut self, code: u32, p: DVec2) {
        self.real(code, p.x);
        self.real(code + 10, p.y);
        self.real(code + 20, 0.0);
    }

    fn handle(&mut self, handle: u32) {
        self.pair(5, format_args!("{handle:X}"));
    }

    fn section(&mut self, name: &str) {
        self.pair(0, "SECTION");
        self.pair(2, name);
    }

    fn header(&mut self, page: &Page, next: u32) {
        let title = plain(&page.title);
        self.section("HEADER");
        for (name, code, value) in [
            ("$ACADVER", 1, "AC1015".to_string()),
            ("$DWGCODEPAGE", 3, "ANSI_1252".to_string()),
            ("$HANDSEED", 5, format!("{next:X}")),
            ("$INSUNITS", 70, "4".to_string()),
            ("$MEASUREMENT", 70, "1".to_string()),
            ("$LWDISPLAY", 290, "1".to_string()),
        ] {
            self.pair(9, name);
            self.pair(code, value);
        }
        for (name, p) in [("$EXTMIN", DVec2::ZERO), ("$EXTMAX", page.size)] {
            self.pair(9, name);
            self.point(10, p);
        }
        self.pair(0, "ENDSEC");
        self.pair(999, format_args!("{title}, katachi {}", env!("CARGO_PKG_VERSION")));
    }

    fn table(&mut self, name: &str, handle: u32, entries: usize) {
        self.pair(0, "TABLE");
        self.pair(2, name);
        self.handle(handle);
        self.pair(330, 0);
        self.pair(100, "AcDbSymbolTable");
        self.pair(70, entries);
    }

    fn entry(&mut self, kind: &str, (handle, owner): (u32, u32), class: &str, name: &str) {
        self.pair(0, kind);
        self.pair(if kind == "DIMSTYLE" { 105 } else { 5 }, format_args!("{handle:X}"));
        self.pair(330, format_args!("{owner:X}"));
        self.pair(100, "AcDbSymbolTableRecord");
        self.pair(100, class);
        self.pair(2, name);
    }

    fn tables(&mut self, layers: &[(Layer, Pen)]) {
        self.handle = FIRST_TABLE;
        self.section("TABLES");
        self.view_port();
        self.line_types(layers);
        self.layers(layers);
        self.text_style();
        for (name, handle) in [("VIEW", 0x6), ("UCS", 0x7)] {
            self.table(name, handle, 0);
            self.pair(0, "ENDTAB");
        }
        self.table("APPID", 0x9, 1);
        self.entry("APPID", (0x12, 0x9), "AcDbRegAppTableRecord", "ACAD");
        self.pair(70, 0);
        self.pair(0, "ENDTAB");
        self.table("DIMSTYLE", 0xA, 0);
        self.pair(100, "AcDbDimStyleTable");
        self.pair(0, "ENDTAB");
        self.table("BLOCK_RECORD", 0x1, 2);
        for (name, handle) in [("*Model_Space", MODEL), ("*Paper_Space", PAPER)] {
            self.entry("BLOCK_RECORD", (handle, 0x1), "AcDbBlockTableRecord", name);
        }
        self.pair(0, "ENDTAB");
        self.pair(0, "ENDSEC");
    }

    fn view_port(&mut self) {
        self.table("VPORT", 0x8, 0);
        self.pair(0, "ENDTAB");
    }

    fn line_types(&mut self, layers: &[(Layer, Pen)]) {
        let dashed = layers.iter().filter(|(_, pen)| !pen.dash.is_empty());
        self.table("LTYPE", 0x5, 3 + dashed.clone().count());
        for (name, handle) in [("ByBlock", 0x14), ("ByLayer", 0x15), ("Continuous", 0x16)] {
            self.entry("LTYPE", (handle, 0x5), "AcDbLinetypeTableRecord", name);
            self.pair(70, 0);
            self.pair(3, "");
            self.pair(72, 65);
            self.pair(73, 0);
            self.real(40, 0.0);
        }
        for (layer, pen) in dashed {
            self.line_type(*layer, pen);
        }
        self.pair(0, "ENDTAB");
    }

    fn line_type(&mut self, layer: Layer, pen: &Pen) {
        let handle = self.next();
        self.entry("LTYPE", (handle, 0x5), "AcDbLinetypeTableRecord", &type_name(layer));
        // A pattern of odd length goes on with its gaps as dashes, as in SVG.
        let twice = pen.dash.len() % 2 == 1;
        let parts: Vec<f64> =
            pen.dash.iter().chain(pen.dash.iter().filter(|_| twice)).copied().collect();
        self.pair(70, 0);
        self.pair(3, layer.name());
        self.pair(72, 65);
        self.pair(73, parts.len());
        self.real(40, parts.iter().sum());
        for (i, &part) in parts.iter().enumerate() {
            self.real(49, if i % 2 == 0 { part } else { -part });
            self.pair(74, 0);
        }
    }

    fn layers(&mut self, layers: &[(Layer, Pen)]) {
        self.table("LAYER", 0x2, layers.len() + 1);
        self.layer(0x10, "0", "Continuous", None);
        for (layer, pen) in layers {
            let handle = self.next();
            let dashes = if pen.dash.is_empty() { "Continuous".into() } else { type_name(*layer) };
            self.layer(handle, layer.name(), &dashes, Some(pen));
        }
        self.pair(0, "ENDTAB");
    }

    fn layer(&mut self, handle: u32, name: &str, dashes: &str, pen: Option<&Pen>) {
        self.entry("LAYER", (handle, 0x2), "AcDbLayerTableRecord", name);
        self.pair(70, 0);
        self.pair(62, 7);
        if let Some(color) = pen.map(|pen| pen.color).filter(|c| (c.r, c.g, c.b) != (0, 0, 0)) {
            let [r, g, b] = [color.r, color.g, color.b].map(u32::from);
            self.pair(420, (r << 16) | (g << 8) | b);
        }
        self.pair(6, dashes);
        if let Some(pen) = pen {
            self.pair(370, line_weight(pen.width));
        }
        self.pair(390, "F");
    }

    fn text_style(&mut self) {
        self.table("STYLE", 0x3, 1);
        self.entry("STYLE", (0x11, 0x3), "AcDbTextStyleTableRecord", "Standard");
        self.pair(70, 0);
        self.real(40, 0.0);
        self.real(41, 1.0);
        self.real(50, 0.0);
        self.pair(71, 0);
        self.real(42, 2.5);
        self.pair(3, "txt");
        self.pair(4, "");
        self.pair(0, "ENDTAB");
    }

    fn blocks(&mut self) {
        self.section("BLOCKS");
        let blocks = [("*Model_Space", MODEL, 0x20, 0x21), ("*Paper_Space", PAPER, 0x1C, 0x1D)];
        for (name, owner, begin, end) in blocks {
            self.block_mark("BLOCK", begin, owner);
            self.pair(100, "AcDbBlockBegin");
            self.pair(2, name);
            self.pair(70, 0);
            self.point(10, DVec2::ZERO);
            self.pair(3, name);
            self.pair(1, "");
            self.block_mark("ENDBLK", end, owner);
            self.pair(100, "AcDbBlockEnd");
        }
        self.pair(0, "ENDSEC");
    }

    fn block_mark(&mut self, kind: &str, handle: u32, owner: u32) {
        self.pair(0, kind);
        self.handle(handle);
        self.pair(330, format_args!("{owner:X}"));
        self.pair(100, "AcDbEntity");
        self.pair(8, "0");
    }

    fn objects(&mut self) {
        self.section("OBJECTS");
        self.dictionary(ROOT, 0, &[("ACAD_GROUP", 0xD), ("ACAD_PLOTSTYLENAME", 0xE)]);
        self.dictionary(0xD, ROOT, &[]);
        self.pair(0, "ACDBDICTIONARYWDFLT");
        self.handle(0xE);
        self.pair(330, format_args!("{ROOT:X}"));
        self.pair(100, "AcDbDictionary");
        self.pair(281, 1);
        self.pair(3, "Normal");
        self.pair(350, "F");
        self.pair(100, "AcDbDictionaryWithDefault");
        self.pair(340, "F");
        self.pair(0, "ACDBPLACEHOLDER");
        self.handle(0xF);
        self.pair(330, "E");
        self.pair(0, "ENDSEC");
    }

    fn dictionary(&mut self, handle: u32, owner: u32, entries: &[(&str, u32)]) {
        self.pair(0, "DICTIONARY");
        self.handle(handle);
        self.pair(330, format_args!("{owner:X}"));
        self.pair(100, "AcDbDictionary");
        self.pair(281, 1);
        for (name, handle) in entries {
            self.pair(3, name);
            self.pair(350, format_args!("{handle:X}"));
        }
    }

    fn next(&mut self) -> u32 {
        self.handle += 1;
        self.handle - 1
    }

    fn entity(&mut self, kind: &str, layer: Layer, class: &str) {
        let handle = self.next();
        self.pair(0, kind);
        self.handle(handle);
        self.pair(330, format_args!("{MODEL:X}"));
        self.pair(100, "AcDbEntity");
        self.pair(8, layer.name());
        self.pair(100, class);
    }

    fn ink(&mut self, ink: &Ink) {
        match &ink.mark {
            Mark::Line(path) => self.path(path, ink.layer),
            Mark::Area(rings) => rings.iter().for_each(|ring| self.area(ring, ink.layer)),
            Mark::Text(letters) => self.letters(letters, ink.layer),
            Mark::Tone(tone) => self.tone(tone, ink.layer),
        }
    }

    fn tone(&mut self, tone: &Tone, layer: Layer) {
        match tone {
            Tone::Dots(dots) => dots.iter().for_each(|(center, r)| self.circle(*center, *r, layer)),
            Tone::Areas(areas) => {
                areas.iter().flatten().for_each(|ring| self.polyline(ring, true, layer));
            }
            Tone::Strokes { strokes, .. } => {
                strokes.iter().for_each(|points| self.straight(points, layer));
            }
            Tone::Pixels { min, max, .. } => {
                let corners = [*min, DVec2::new(max.x, min.y), *max, DVec2::new(min.x, max.y)];
                self.polyline(&corners, true, layer);
                let text = "picture of pixels: see the PDF or SVG".into();
                let at = *min + DVec2::splat(NOTE);
                let note = Letters { text, at, height: NOTE, angle: 0.0, outlines: vec![] };
                self.letters(&note, layer);
            }
        }
    }

    fn circle(&mut self, center: DVec2, r: f64, layer: Layer) {
        self.entity("CIRCLE", layer, "AcDbCircle");
        self.point(10, center);
        self.real(40, r);
    }

    /// A filled triangle, such as the head of an arrow; other areas by their outline.
    fn area(&mut self, ring: &[DVec2], layer: Layer) {
        let &[a, b, c] = ring else { return self.polyline(ring, true, layer) };
        self.entity("SOLID", layer, "AcDbTrace");
        for (code, p) in [(10, a), (11, b), (12, c), (13, c)] {
            self.point(code, p);
        }
    }

    /// Runs of straight pieces are polylines, curves entities of their own.
    fn path(&mut self, path: &Path, layer: Layer) {
        let mut run = vec![path.start];
        for (start, segment) in path.pieces() {
            if let Segment::Line { to } = *segment {
                run.push(to);
                continue;
            }
            self.straight(&run, layer);
            run = vec![segment.end()];
            match *segment {
                Segment::Cubic { first, second, to } => {
                    self.spline([start, first, second, to], layer);
                }
                _ => self.arc(segment, layer),
            }
        }
        self.straight(&run, layer);
    }

    fn straight(&mut self, run: &[DVec2], layer: Layer) {
        match run {
            [] | [_] => {}
            [from, to] => {
                self.entity("LINE", layer, "AcDbLine");
                self.point(10, *from);
                self.point(11, *to);
            }
            [first, inner @ .., last] => {
                let closed = first.distance(*last) < ROUND && inner.len() > 1;
                let points = if closed { &run[..run.len() - 1] } else { run };
                self.polyline(points, closed, layer);
            }
        }
    }

    fn polyline(&mut self, points: &[DVec2], closed: bool, layer: Layer) {
        self.entity("LWPOLYLINE", layer, "AcDbPolyline");
        self.pair(90, points.len());
        self.pair(70, u8::from(closed));
        for p in points {
            self.real(10, p.x);
            self.real(20, p.y);
        }
    }

    fn arc(&mut self, arc: &Segment, layer: Layer) {
        let Segment::Arc { center, major, minor, from, to } = *arc else { return };
        let (low, high) = (from.min(to), from.max(to));
        let whole = high - low >= TAU * (1.0 - ROUND);
        let (a, b) = (major.length(), minor.length());
        if (a - b).abs() <= ROUND * a {
            self.entity(if whole { "CIRCLE" } else { "ARC" }, layer, "AcDbCircle");
            self.point(10, center);
            self.real(40, a);
            if !whole {
                let turn = libm::atan2(major.y, major.x);
                self.pair(100, "AcDbArc");
                self.real(50, positive(low + turn).to_degrees());
                self.real(51, positive(high + turn).to_degrees());
            }
            return;
        }
        self.entity("ELLIPSE", layer, "AcDbEllipse");
        self.point(10, center);
        self.point(11, major);
        for (code, z) in [(210, 0.0), (220, 0.0), (230, 1.0)] {
            self.real(code, z);
        }
        self.real(40, b / a);
        self.real(41, if whole { 0.0 } else { positive(low) });
        self.real(42, if whole { TAU } else { positive(low) + (high - low) });
    }

    fn spline(&mut self, points: [DVec2; 4], layer: Layer) {
        self.entity("SPLINE", layer, "AcDbSpline");
        for (code, value) in [(70, 8), (71, 3), (72, 8), (73, 4), (74, 0)] {
            self.pair(code, value);
        }
        for knot in [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0] {
            self.real(40, knot);
        }
        points.iter().for_each(|&p| self.point(10, p));
    }

    fn letters(&mut self, letters: &Letters, layer: Layer) {
        self.entity("TEXT", layer, "AcDbText");
        self.point(10, letters.at);
        self.real(40, letters.height);
        self.pair(1, plain(&letters.text));
        self.real(50, letters.angle);
        self.pair(100, "AcDbText");
    }
}

fn type_name(layer: Layer) -> String {
    format!("KATACHI_{}", layer.name().to_uppercase())
}

/// An angle from 0 to below a full turn.
fn positive(angle: f64) -> f64 {
    angle - (angle / TAU).floor() * TAU
}

/// The nearest line weight there is, in hundredths of a millimetre.
fn line_weight(width: f64) -> u32 {
    const WEIGHTS: [u32; 24] = [
        0, 5, 9, 13, 15, 18, 20, 25, 30, 35, 40, 50, 53, 60, 70, 80, 90, 100, 106, 120, 140, 158,
        200, 211,
    ];
    let off = |weight: &u32| (f64::from(*weight) - width * 100.0).abs();
    let nearer = |a: &u32, b: &u32| off(a).total_cmp(&off(b));
    WEIGHTS.into_iter().min_by(nearer).unwrap_or(25)
}

/// Text on one line: diameter, degrees and plus or minus by their own codes, what else is not ASCII as `\U+XXXX`, which
/// readers of all code pages know.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    for c in text.chars().filter(|c| !c.is_control()) {
        match c {
            '\u{d8}' | '\u{2300}' => plain.push_str("%%c"),
            '\u{b0}' => plain.push_str("%%d"),
            '\u{b1}' => plain.push_str("%%p"),
            ' '..='~' => plain.push(c),
            '\0'..='\u{ffff}' => {
                let _ = write!(plain, "\\U+{:04X}", c as u32);
            }
            _ => plain.push('?'),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    fn entities(path: &Path) -> String {
        let mut file = File::default();
        file.path(path, Layer::Visible);
        file.text
    }

    #[test]
    fn arcs_are_what_they_are() {
        let arc = |minor: f64, to: f64| {
            let (major, minor) = (dvec2(0.0, 2.0), dvec2(-minor, 0.0));
            let arc = Segment::Arc { center: DVec2::ONE, major, minor, from: 0.0, to };
            entities(&Path::of(arc.at(DVec2::ZERO, 0.0), arc))
        };
        assert!(arc(2.0, TAU).contains("CIRCLE"));
        assert!(arc(2.0, 1.0).contains(" 50\n90\n 51\n147.29"));
        assert!(arc(1.0, -1.0).contains("ELLIPSE") && arc(1.0, -1.0).contains(" 40\n0.5\n"));
    }

    #[test]
    fn pens_have_weights() {
        assert_eq!([0.5, 0.25, 0.7, 0.34, 9.0].map(line_weight), [50, 25, 70, 35, 211]);
        assert_eq!(plain("Ø 5 ± 1°\n"), "%%c 5 %%p 1%%d");
        assert_eq!(plain("é"), "\\U+00E9");
    }
}
