//! SVG in millimetres: a layer for each class of line, as Inkscape and browsers read it.
//!
//! One user unit is one millimetre. A group's layers are `<g class="visible">` with the pen as attributes;
//! lines carry the part they show as `data-part`. The paper is white by a style of the root, not by a shape.

use std::fmt::Write;

use glam::DVec2;
use svg::node::element::Element;
use svg::node::{Blob, Node, Text};

use super::{
    page::{Group, Ink, Mark, Page},
    pen::{Layer, Pen},
    tone::Tone,
};
use crate::{
    geom::mesh::Color,
    output::{
        drawing::{Path, Segment},
        pixels::Pixels,
    },
};

/// The page as the bytes of an SVG file.
///
/// ```
/// use katachi::output::sheet::{Figure, Unlettered, svg};
/// let page = Figure::default().page("empty", &Unlettered);
/// let text = String::from_utf8(svg::write(&page)).unwrap();
/// assert!(text.contains(r#"width="10mm""#) && text.contains("<title>empty</title>"));
/// ```
pub fn write(page: &Page) -> Vec<u8> {
    let (w, h) = (Number(page.size.x), Number(page.size.y));
    let mut root = Element::new("svg");
    root.assign("xmlns", "http://www.w3.org/2000/svg");
    root.assign("xmlns:inkscape", "http://www.inkscape.org/namespaces/inkscape");
    root.assign("version", "1.1");
    root.assign("width", format!("{w}mm"));
    root.assign("height", format!("{h}mm"));
    root.assign("viewBox", format!("0 0 {w} {h}"));
    root.assign("style", "background:#fff");
    root.assign("data-generator", concat!("katachi ", env!("CARGO_PKG_VERSION")));
    let mut title = Element::new("title");
    title.append(Text::new(plain(&page.title)));
    root.append(title);
    for (number, group) in page.groups.iter().enumerate() {
        root.append(group_element(group, number, page.size.y));
    }
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{root}\n").into_bytes()
}

fn group_element(group: &Group, number: usize, height: f64) -> Element {
    let mut element = Element::new("g");
    if let Some((min, max)) = group.clip {
        let name = format!("clip{number}");
        element.assign("clip-path", format!("url(#{name})"));
        let mut border = Element::new("rect");
        rectangle(&mut border, (min, max), height);
        let mut clip = Element::new("clipPath");
        clip.assign("id", name);
        clip.append(border);
        element.append(clip);
    }
    if !group.name.is_empty() {
        element.assign("data-name", plain(&group.name));
        element.assign("inkscape:label", plain(&group.name));
        element.assign("inkscape:groupmode", "layer");
    }
    for (name, text) in &group.data {
        element.assign(format!("data-{name}"), plain(text));
    }
    for layer in Layer::ALL {
        if group.layer(layer).next().is_some() {
            element.append(layer_element(group, layer, height));
        }
    }
    element
}

fn layer_element(group: &Group, layer: Layer, height: f64) -> Element {
    let pen = group.style.pen(layer);
    let mut element = Element::new("g");
    element.assign("class", layer.name());
    element.assign("inkscape:groupmode", "layer");
    element.assign("inkscape:label", layer.name());
    element.assign("fill", "none");
    element.assign("stroke", hex(pen.color));
    element.assign("stroke-width", Number(pen.width).to_string());
    if layer != Layer::Tone {
        element.assign("stroke-linecap", "round");
    }
    element.assign("stroke-linejoin", "round");
    if !pen.dash.is_empty() {
        element.assign("stroke-linecap", "butt");
        let dash: Vec<String> = pen.dash.iter().map(|&d| Number(d).to_string()).collect();
        element.assign("stroke-dasharray", dash.join(" "));
    }
    for ink in group.layer(layer) {
        element.append(ink_element(ink, pen, height));
    }
    element
}

/// Puts a shape where a rectangle of the page is.
fn rectangle(element: &mut Element, (min, max): (DVec2, DVec2), height: f64) {
    let size = max - min;
    let numbers = [("x", min.x), ("y", height - max.y), ("width", size.x), ("height", size.y)];
    numbers.into_iter().for_each(|(name, x)| element.assign(name, Number(x).to_string()));
}

/// A half-tone. Shapes are one text, as there are many.
fn tone_element(tone: &Tone, height: f64) -> Element {
    let mut element = Element::new("g");
    let mut shapes = String::new();
    element.assign("fill", "#000000");
    element.assign("stroke", "none");
    // Writing to a string cannot fail.
    let _ = match tone {
        Tone::Dots(dots) => {
            element.assign("class", "dots");
            dots.iter().try_for_each(|(p, r)| {
                let (x, y, r) = (Number(p.x), Number(height - p.y), Number(*r));
                writeln!(shapes, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\"/>")
            })
        }
        Tone::Areas(areas) => {
            element.assign("class", "areas");
            element.assign("fill-rule", "evenodd");
            let mut write = |data| writeln!(shapes, "<path d=\"{data}\"/>");
            areas.iter().try_for_each(|rings| write(ring_data(rings, height)))
        }
        Tone::Strokes { strokes, width } => {
            element.assign("class", "strokes");
            element.assign("fill", "none");
            element.assign("stroke", "#000000");
            element.assign("stroke-width", Number(*width).to_string());
            let mut write = |data| writeln!(shapes, "<path d=\"{data}\"/>");
            strokes.iter().try_for_each(|points| write(run_data(points, height)))
        }
        Tone::Pixels { min, max, pixels } => return image_element((*min, *max), pixels, height),
    };
    element.append(Blob::new(shapes.trim_end()));
    element
}

/// Pixels that fill a rectangle.
fn image_element((min, max): (DVec2, DVec2), pixels: &Pixels, height: f64) -> Element {
    let mut image = Element::new("image");
    rectangle(&mut image, (min, max), height);
    image.assign("preserveAspectRatio", "none");
    let side = (max.x - min.x) / f64::from(pixels.size[0]);
    image.assign("href", format!("data:image/png;base64,{}", base64(&pixels.png(side))));
    image
}

/// Bytes as text (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let at = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for i in 0..4 {
            let sign = SIGNS[(bits >> (18 - 6 * i) & 63) as usize];
            text.push(if i > three.len() { '=' } else { char::from(sign) });
        }
    }
    text
}

fn ink_element(ink: &Ink, pen: &Pen, height: f64) -> Element {
    let mut element = Element::new("path");
    let data = match &ink.mark {
        Mark::Tone(tone) => return tone_element(tone, height),
        Mark::Line(path) => path_data(path, height),
        Mark::Area(rings) => ring_data(rings, height),
        Mark::Text(letters) => ring_data(&letters.outlines, height),
    };
    element.assign("d", data);
    if !matches!(ink.mark, Mark::Line(_)) {
        element.assign("fill", hex(pen.color));
        element.assign("fill-rule", "evenodd");
        element.assign("stroke", "none");
    }
    if let Mark::Text(letters) = &ink.mark {
        element.assign("data-text", plain(&letters.text));
    }
    if let Some(part) = &ink.part {
        element.assign("data-part", plain(part));
    }
    element
}

/// Points of the page in the file, where y runs down.
struct At(DVec2, f64);

impl std::fmt::Display for At {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", Number(self.0.x), Number(self.1 - self.0.y))
    }
}

fn path_data(path: &Path, height: f64) -> String {
    let mut data = format!("M{}", At(path.start, height));
    for (start, segment) in path.pieces() {
        // Writing to a string cannot fail.
        let _ = match *segment {
            Segment::Line { to } => write!(data, "L{}", At(to, height)),
            Segment::Cubic { first, second, to } => {
                let [first, second, to] = [first, second, to].map(|p| At(p, height));
                write!(data, "C{first} {second} {to}")
            }
            Segment::Arc { .. } => arc_data(&mut data, start, segment, height),
        };
    }
    let at_start = At(path.start, height).to_string() == At(path.end(), height).to_string();
    if at_start && path.segments.len() > 1 {
        data.push('Z');
    }
    data
}

/// An arc of at most half a turn is one `A`; a longer one is written in parts, as its end alone would not tell it.
fn arc_data(data: &mut String, start: DVec2, arc: &Segment, height: f64) -> std::fmt::Result {
    let Segment::Arc { major, minor, from, to, .. } = *arc else { return Ok(()) };
    let parts = ((to - from).abs() / LONGEST_ARC).ceil().max(1.0);
    let turn = -libm::atan2(major.y, major.x).to_degrees();
    let (rx, ry) = (Number(major.length()), Number(minor.length()));
    let sweep = u8::from((to < from) == (major.perp_dot(minor) > 0.0));
    for i in 1..=parts as u32 {
        let end = At(arc.at(start, f64::from(i) / parts), height);
        write!(data, "A{rx} {ry} {} 0 {sweep} {end}", Number(turn))?;
    }
    Ok(())
}

/// The longest arc written as one command, radians: clearly below half a turn.
const LONGEST_ARC: f64 = 3.0;

fn ring_data(rings: &[Vec<DVec2>], height: f64) -> String {
    let mut data = String::new();
    for ring in rings {
        data += &run_data(ring, height);
        data.push('Z');
    }
    data
}

/// Straight lines from point to point.
fn run_data(points: &[DVec2], height: f64) -> String {
    let mut data = String::new();
    for (i, &p) in points.iter().enumerate() {
        let _ = write!(data, "{}{}", if i == 0 { 'M' } else { 'L' }, At(p, height));
    }
    data
}

/// A number to a tenth of a micrometre, without zeros that say nothing.
struct Number(f64);

impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let text = format!("{:.4}", self.0);
        let text = text.trim_end_matches('0').trim_end_matches('.');
        f.write_str(if text == "-0" { "0" } else { text })
    }
}

fn hex(color: Color) -> String {
    format!("#{:02x}{:02x}{:02x}", color.r, color.g, color.b)
}

/// Text without the characters that XML cannot hold.
fn plain(text: &str) -> String {
    let held = |c: &char| !c.is_control() && !matches!(*c, '\u{fffe}' | '\u{ffff}');
    text.chars().filter(held).map(|c| if c == '"' { '\u{201d}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::dvec2;

    use super::*;

    #[test]
    fn arcs_keep_their_sense() {
        let arc = |from, to| Segment::Arc {
            center: DVec2::ZERO,
            major: dvec2(2.0, 0.0),
            minor: dvec2(0.0, 1.0),
            from,
            to,
        };
        let data =
            |from, to| path_data(&Path::of(arc(from, to).at(DVec2::ZERO, 0.0), arc(from, to)), 0.0);
        assert_eq!(data(0.0, TAU / 4.0), "M2 0A2 1 0 0 0 0 -1");
        assert_eq!(data(TAU / 4.0, 0.0), "M0 -1A2 1 0 0 1 2 0");
        assert_eq!(data(0.0, TAU).matches('A').count(), 3);
    }

    #[test]
    fn base64_is_that_of_the_rfc() {
        let texts = ["", "f", "fo", "foo", "foob", "fooba", "foobar"];
        let coded = ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"];
        assert_eq!(texts.map(|text| base64(text.as_bytes())), coded);
    }

    #[test]
    fn numbers_are_short() {
        let texts = [0.1 + 0.2, -0.00001, 5.0, 120.0, -2.50004].map(|x| Number(x).to_string());
        assert_eq!(texts, ["0.3", "0", "5", "120", "-2.5"]);
    }
}
