//! Half-tones as SVG, in millimetres.

use std::fmt::Write;

use glam::DVec2;

use super::{
    ink::{Ink, Mark},
    picture::{Frame, Picture},
    png::png,
};

/// Digits after the point: a ten-thousandth of a millimetre.
const DIGITS: usize = 4;

/// Ink as an SVG file: round dots as circles, areas as filled paths, strokes as stroked ones, one layer each, in the
/// order in which a plotter draws them.
///
/// ```
/// use glam::DVec2;
/// use katachi::output::{drawing::Window, halftone::{Frame, Ink, Mark, svg}};
/// let window = Window { min: DVec2::ZERO, max: DVec2::splat(10.0) };
/// let frame = Frame { window, size: [1, 1] };
/// let dot = Mark::Dot { center: DVec2::splat(2.0), radius: 1.5 };
/// let file = svg(&Ink { frame, marks: vec![dot] }, "dot");
/// assert!(file.contains("<circle cx=\"2\" cy=\"8\" r=\"1.5\"/>"));
/// ```
pub fn svg(ink: &Ink, title: &str) -> String {
    let mut file = head(&ink.frame, title);
    let dots = ink.marks.iter().filter(|mark| matches!(mark, Mark::Dot { .. }));
    group(&mut file, "dots", "fill=\"black\"", dots, &ink.frame);
    let areas = ink.marks.iter().filter(|mark| matches!(mark, Mark::Area(_)));
    group(&mut file, "areas", "fill=\"black\"", areas, &ink.frame);
    lines(&mut file, &ink.marks, &ink.frame);
    let strokes = || ink.marks.iter().filter(|mark| matches!(mark, Mark::Stroke { .. }));
    let pen = strokes().find_map(|mark| match mark {
        Mark::Stroke { width, .. } => Some(*width),
        _ => None,
    });
    let style =
        format!("fill=\"none\" stroke=\"black\" stroke-width=\"{}\"", short(pen.unwrap_or(0.0)));
    group(&mut file, "strokes", &style, strokes(), &ink.frame);
    file.push_str("</svg>\n");
    file
}

/// Lines drawn over tones, in their order.
fn lines(file: &mut String, marks: &[Mark], frame: &Frame) {
    let lines = marks.iter().filter(|mark| matches!(mark, Mark::Line { .. }));
    let style = "fill=\"none\" stroke=\"black\" stroke-linecap=\"round\" stroke-linejoin=\"round\"";
    group(file, "lines", style, lines, frame);
}

fn group<'a>(
    file: &mut String,
    name: &str,
    style: &str,
    marks: impl Iterator<Item = &'a Mark>,
    frame: &Frame,
) {
    let mut marks = marks.peekable();
    if marks.peek().is_none() {
        return;
    }
    let _ = writeln!(file, "<g id=\"{name}\" class=\"{name}\" {style}>");
    for mark in marks {
        element(file, mark, frame);
    }
    file.push_str("</g>\n");
}

fn element(file: &mut String, mark: &Mark, frame: &Frame) {
    let place = |p: DVec2| {
        let at = DVec2::new(p.x - frame.window.min.x, frame.window.max.y - p.y);
        (short(at.x), short(at.y))
    };
    let written = match mark {
        Mark::Dot { center, radius } => {
            let (x, y) = place(*center);
            writeln!(file, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\"/>", short(*radius))
        }
        Mark::Stroke { from, to, .. } => {
            let ((x, y), (u, v)) = (place(*from), place(*to));
            writeln!(file, "<path d=\"M{x} {y}L{u} {v}\"/>")
        }
        Mark::Area(points) => writeln!(file, "<path d=\"{}Z\"/>", path(points, place)),
        Mark::Line { points, width } => {
            let width = short(*width);
            writeln!(file, "<path stroke-width=\"{width}\" d=\"{}\"/>", path(points, place))
        }
    };
    // Writing to memory does not fail.
    debug_assert!(written.is_ok());
}

/// Pixels as an SVG file that holds them as a PNG, under lines.
pub fn svg_of_picture(picture: &Picture, marks: &[Mark], title: &str) -> String {
    let (width, height) = extent(&picture.frame);
    let mut file = head(&picture.frame, title);
    let data = base64(&png(picture));
    let _ = writeln!(
        file,
        "<image width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" href=\"data:image/png;base64,{data}\"/>"
    );
    lines(&mut file, marks, &picture.frame);
    file.push_str("</svg>\n");
    file
}

/// Width and height of a frame.
fn extent(frame: &Frame) -> (String, String) {
    let extent = frame.window.max - frame.window.min;
    (short(extent.x), short(extent.y))
}

fn head(frame: &Frame, title: &str) -> String {
    let (width, height) = extent(frame);
    let size = format!("width=\"{width}mm\" height=\"{height}mm\"");
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" {size} viewBox=\"0 0 {width} {height}\">\n<title>{}</title>\n",
        escaped(title)
    )
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

/// A run of straight lines.
fn path(points: &[DVec2], place: impl Fn(DVec2) -> (String, String)) -> String {
    let mut path = String::new();
    for (i, p) in points.iter().enumerate() {
        let (x, y) = place(*p);
        path.push(if i == 0 { 'M' } else { 'L' });
        path += &x;
        path.push(' ');
        path += &y;
    }
    path
}

/// A number with few digits.
fn short(number: f64) -> String {
    let text = format!("{number:.DIGITS$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_rfc() {
        let texts = ["", "f", "fo", "foo", "foob", "fooba", "foobar"];
        let coded = ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"];
        assert_eq!(texts.map(|text| base64(text.as_bytes())), coded);
    }
}
