//! SVG drawings, by the crate `usvg`: filled shapes become a plane figure.
//!
//! Lengths are millimetres: the size of the page comes from `width`, `height` and `viewBox` at 96 pixels an
//! inch, as Inkscape has it; the lower left corner of the page is the origin and y points up. Every fill counts,
//! whatever its colour, by its own fill rule; strokes, text, pictures, clips and masks are left out with
//! a note. No other file is read. Limits of `usvg`: a million elements, nested 1024 deep.

use glam::{DVec2, dvec2};
use usvg::{
    FillRule, Group, ImageHrefResolver, Node, Options, Path, Tree, tiny_skia_path::PathSegment,
};

use super::{Figure, Place, ReadError, error::Format};
use crate::geom::{
    Contour, Tolerance,
    outline::Outline,
    overlay::{Fill, Rule, overlay},
};

const SVG: Format = Format("SVG");

/// Millimetres for each pixel.
const PIXEL: f64 = 25.4 / 96.0;

/// Stack for the recursion of `usvg` over 1024 nested elements.
const STACK: usize = 64 << 20;

/// The figure of an SVG file.
///
/// # Errors
/// What `usvg` refuses, curves of more chords than are drawn, and a drawing without filled shapes.
pub fn read(bytes: &[u8], tolerance: Tolerance) -> Result<Figure, ReadError> {
    let text = SVG.text(bytes)?;
    stacker::grow(STACK, || drawn(text, tolerance))
}

fn drawn(text: &str, tolerance: Tolerance) -> Result<Figure, ReadError> {
    let sealed = ImageHrefResolver {
        resolve_data: Box::new(|_, _, _| None),
        resolve_string: Box::new(|_, _| None),
    };
    let options = Options { image_href_resolver: sealed, ..Options::default() };
    let tree = Tree::from_str(text, &options).map_err(|error| {
        SVG.error(Place::File, error.to_string(), "a well-formed SVG drawing is needed")
    })?;
    let height = f64::from(tree.size().height());
    let mut drawing = Drawing {
        height,
        outline: Outline::new(tolerance),
        contours: vec![],
        left_out: LeftOut::default(),
    };
    drawing.group(tree.root());
    SVG.chords("a curve", drawing.outline.most_chords())?;
    if text.contains("<text") {
        drawing.left_out.texts = true;
    }
    let region = overlay(&drawing.contours, [], Rule::Union, Fill::NonZero);
    let notes = drawing.left_out.notes();
    if region.is_empty() {
        let found = format!(
            "no filled shapes ({})",
            if notes.is_empty() { "it is empty".into() } else { notes.join("; ") }
        );
        return Err(SVG.error(
            Place::File,
            found,
            "at least one is needed; turn strokes and text to paths first",
        ));
    }
    Ok(Figure { region, notes })
}

/// What was left out.
#[derive(Default)]
struct LeftOut {
    strokes: usize,
    images: usize,
    clips: usize,
    texts: bool,
}

impl LeftOut {
    fn notes(&self) -> Vec<String> {
        let counts = [
            (self.strokes, "strokes are left out: only fills count"),
            (self.images, "pictures are left out"),
            (self.clips, "clips and masks are left out"),
        ];
        let counted = counts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}"));
        let texts = self.texts.then(|| "text is left out: turn it to paths first".to_string());
        counted.chain(texts).collect()
    }
}

struct Drawing {
    /// The height of the page in pixels.
    height: f64,
    outline: Outline,
    contours: Vec<Contour>,
    left_out: LeftOut,
}

impl Drawing {
    fn group(&mut self, group: &Group) {
        self.left_out.clips += usize::from(group.clip_path().is_some() || group.mask().is_some());
        for node in group.children() {
            match node {
                Node::Group(inner) => self.group(inner),
                Node::Path(path) => self.path(path),
                Node::Image(_) => self.left_out.images += 1,
                Node::Text(_) => self.left_out.texts = true,
            }
        }
    }

    fn path(&mut self, path: &Path) {
        if !path.is_visible() {
            return;
        }
        self.left_out.strokes += usize::from(path.stroke().is_some());
        let Some(fill) = path.fill() else { return };
        let t = path.abs_transform();
        let [a, b, c, d, e, f] = [t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from);
        let height = self.height;
        let at = |p: usvg::tiny_skia_path::Point| -> DVec2 {
            let (x, y) = (f64::from(p.x), f64::from(p.y));
            dvec2(a * x + c * y + e, height - (b * x + d * y + f)) * PIXEL
        };
        for segment in path.data().segments() {
            match segment {
                PathSegment::MoveTo(p) => self.outline.move_to(at(p)),
                PathSegment::LineTo(p) => self.outline.line_to(at(p)),
                PathSegment::QuadTo(c, p) => self.outline.quad_to(at(c), at(p)),
                PathSegment::CubicTo(c, d, p) => self.outline.cubic_to(at(c), at(d), at(p)),
                PathSegment::Close => self.outline.close(),
            }
        }
        let rule = match fill.rule() {
            FillRule::NonZero => Fill::NonZero,
            FillRule::EvenOdd => Fill::EvenOdd,
        };
        let region = overlay(&self.outline.take(), [], Rule::Union, rule);
        self.contours.extend(region.contours().cloned());
    }
}
