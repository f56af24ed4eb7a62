//! Isometric drawings: lines on an isometric grid, drawn in any SVG editor, become points and lines in space.
//!
//! # Paper
//! METHODS 4.1 (Nakajima). A picture point alone does not fix a space point; a stroke in one of six directions from a known
//! point does.
//!
//! # Departures
//! The paper's pen gives strokes one after another. In a file lines are taken in their order as far as they start at known
//! points, then again; a line may also be known by its end. Every corner of a full line is registered; of a dashed one, which
//! only leads somewhere, those that are marked. Where several known points have one image a marked one counts before
//! others and then the one nearest the eye, unless only one lets the line pass through other known points.

mod known;
mod resolve;
mod sketch;
#[cfg(test)]
mod tests;

use super::{ReadError, check_size, ending, error::Format};
use crate::geom::isometric::{IsoDrawing, IsoScale};

const ISO: Format = Format("isometric SVG");

/// Reads an isometric drawing from an SVG file.
///
/// `path`, `polyline`, `polygon`, `line` and `rect` elements are lines; transforms are followed. The start of the first line
/// is `scale.origin`. Strokes along the images of the axes run along them. Other strokes join known points, or where there is
/// none and they are within half a degree of an axis run along it. All strokes of a line whose `id` or `class` begins with
/// `join` join known points. A corner is marked by a repeated point or by a `circle` or `ellipse` centred on it. What is
/// hidden, locked (in Inkscape) or of class `grid` is left out.
///
/// # Errors
/// No lines; curved segments; points that cannot be resolved, with their place in user units; more than 5000 points.
///
/// ```
/// use katachi::{geom::isometric::IsoScale, input::read_isometric};
/// let svg = br#"<svg xmlns="http://www.w3.org/2000/svg"><path d="M 50 50 v -20 v -10"/></svg>"#;
/// let scale = IsoScale { unit: Some(2.0), ..IsoScale::default() };
/// let drawing = read_isometric("post.svg", svg, &scale).unwrap();
/// assert!((drawing.vertices[2].z - 60.0).abs() < 1e-12);
/// ```
pub fn read(name: &str, bytes: &[u8], scale: &IsoScale) -> Result<IsoDrawing, ReadError> {
    check_size(bytes)?;
    if ending(name) != "svg" {
        return Err(ReadError::Extension { name: name.to_string(), known: ".svg" });
    }
    let sketch = sketch::read(ISO.text(bytes)?)?;
    resolve::resolve(&sketch, scale)
}
