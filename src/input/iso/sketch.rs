//! The lines of an SVG drawing in the user units of its root, as exact as the file writes them.

use glam::{DAffine2, DMat2, DVec2, dvec2};
use roxmltree::{Document, Node, ParsingOptions};
use svgtypes::{
    Length, LengthUnit, PointsParser, SimplePathSegment, SimplifyingPathParser,
    TransformListParser, TransformListToken, ViewBox,
};

use super::ISO;
use crate::{
    geom::trig::{cos_deg, sin_deg},
    input::{
        Place, ReadError,
        error::{MOST_COORDINATE, shortened},
    },
};

/// Points that a drawing may have.
pub const MOST_POINTS: usize = 5000;

/// Nodes that a file may have.
const MOST_NODES: u32 = 1_000_000;

/// Stack for the parser of deeply nested files.
const STACK: usize = 64 << 20;

/// Millimetres for each pixel.
const PIXEL: f64 = 25.4 / 96.0;

/// A line from point to point, y down.
#[derive(Clone, PartialEq, Debug)]
pub struct Line {
    pub name: Option<String>,
    pub points: Vec<DVec2>,
    pub closed: bool,
    /// Whether it is dashed: it leads to points and is no edge.
    pub dashed: bool,
    /// Whether its strokes join known points whatever their direction.
    pub joins: bool,
}

/// What is drawn.
#[derive(Debug)]
pub struct Sketch {
    pub lines: Vec<Line>,
    /// Centres of small circles.
    pub marks: Vec<DVec2>,
    /// Millimetres on paper for each user unit.
    pub mm: f64,
    pub notes: Vec<String>,
    /// Points and marks so far.
    count: usize,
}

/// The lines of a file.
pub fn read(text: &str) -> Result<Sketch, ReadError> {
    stacker::grow(STACK, || {
        let options =
            ParsingOptions { allow_dtd: true, nodes_limit: MOST_NODES, ..Default::default() };
        let document = Document::parse_with_options(text, options).map_err(|error| {
            ISO.error(Place::File, error.to_string(), "a well-formed SVG drawing is needed")
        })?;
        let root = document.root_element();
        if root.tag_name().name() != "svg" {
            let found = format!("the root element is <{}>", shortened(root.tag_name().name()));
            return Err(ISO.error(Place::File, found, "<svg> is needed"));
        }
        let mut sketch =
            Sketch { lines: vec![], marks: vec![], mm: scale(root), notes: vec![], count: 0 };
        sketch.walk(root)?;
        Ok(sketch)
    })
}

/// Millimetres on paper for each user unit of the root.
fn scale(root: Node<'_, '_>) -> f64 {
    let view: Option<ViewBox> = root.attribute("viewBox").and_then(|text| text.parse().ok());
    let Some(view) = view else { return PIXEL };
    let side = |name, size: f64| {
        let length: Length = root.attribute(name)?.parse().ok()?;
        let unit = match length.unit {
            LengthUnit::None | LengthUnit::Px => PIXEL,
            LengthUnit::In => 25.4,
            LengthUnit::Cm => 10.0,
            LengthUnit::Mm => 1.0,
            LengthUnit::Pt => 25.4 / 72.0,
            LengthUnit::Pc => 25.4 / 6.0,
            LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => return None,
        };
        Some(length.number * unit / size).filter(|scale| *scale > 0.0 && scale.is_finite())
    };
    let sides = [side("width", view.w), side("height", view.h)];
    sides.into_iter().flatten().reduce(f64::min).unwrap_or(PIXEL)
}

/// What an element takes over from those around it.
#[derive(Clone, Copy)]
struct Context {
    transform: DAffine2,
    dashed: bool,
    joins: bool,
}

impl Sketch {
    fn walk(&mut self, root: Node<'_, '_>) -> Result<(), ReadError> {
        let outer = Context { transform: DAffine2::IDENTITY, dashed: false, joins: false };
        let mut pending = vec![(root, outer)];
        let mut left_out = [0; 2];
        while let Some((node, context)) = pending.pop() {
            if !node.is_element() || is_hidden(node) {
                continue;
            }
            let transform = match node.attribute("transform").filter(|_| node != root) {
                Some(text) => context.transform * transform(text)?,
                None => context.transform,
            };
            let dashed = property(node, "stroke-dasharray").map(|dash| dash != "none");
            let context = Context {
                transform,
                dashed: dashed.unwrap_or(context.dashed),
                joins: context.joins || joins(node),
            };
            match node.tag_name().name() {
                "svg" if node != root => left_out[0] += 1,
                "svg" | "g" | "a" | "switch" => {
                    let children: Vec<_> = node.children().collect();
                    pending.extend(children.into_iter().rev().map(|child| (child, context)));
                }
                "use" => left_out[1] += 1,
                _ => self.shape(node, &context)?,
            }
        }
        for (count, what) in left_out.into_iter().zip(["svg", "use"]).filter(|(n, _)| *n > 0) {
            self.notes.push(format!("{count} nested <{what}> left out"));
        }
        Ok(())
    }

    fn few(&self) -> Result<(), ReadError> {
        if self.count <= MOST_POINTS {
            return Ok(());
        }
        Err(ISO.limit(format!("a drawing of {} points", self.count), MOST_POINTS.to_string()))
    }

    /// Takes a line or a mark in.
    fn shape(&mut self, node: Node<'_, '_>, context: &Context) -> Result<(), ReadError> {
        let place = |p: &DVec2| context.transform.transform_point2(*p);
        if matches!(node.tag_name().name(), "circle" | "ellipse") {
            self.marks.push(place(&dvec2(attribute(node, "cx")?, attribute(node, "cy")?)));
            self.count += 1;
            return self.few();
        }
        let mut name = node.attribute("id").map(str::to_string);
        for (points, closed) in outlines(node, &context.transform)? {
            let points: Vec<DVec2> = points.iter().map(place).collect();
            let far = |p: &&DVec2| !p.is_finite() || p.abs().max_element() > MOST_COORDINATE;
            if let Some(far) = points.iter().find(far) {
                let found = format!("a point at ({}, {})", far.x, far.y);
                return Err(ISO.error(Place::File, found, "finite coordinates are needed"));
            }
            let (dashed, joins) = (context.dashed, context.joins);
            self.count += points.len();
            self.lines.push(Line { name: name.take(), points, closed, dashed, joins });
        }
        self.few()
    }
}

/// The lines of an element in its own coordinates, and whether each is closed.
fn outlines(
    node: Node<'_, '_>,
    transform: &DAffine2,
) -> Result<Vec<(Vec<DVec2>, bool)>, ReadError> {
    let point = |x, y| Ok(dvec2(attribute(node, x)?, attribute(node, y)?));
    Ok(match node.tag_name().name() {
        "line" => vec![(vec![point("x1", "y1")?, point("x2", "y2")?], false)],
        "rect" => {
            let (at, size) = (point("x", "y")?, point("width", "height")?);
            let [x, y] = [DVec2::X * size.x, DVec2::Y * size.y];
            vec![(vec![at, at + x, at + size, at + y], true)]
        }
        tag @ ("polyline" | "polygon") => {
            let text = node.attribute("points").unwrap_or_default();
            let points = PointsParser::from(text).map(|(x, y)| dvec2(x, y)).collect();
            vec![(points, tag == "polygon")]
        }
        "path" => parts(node.attribute("d").unwrap_or_default(), transform)?,
        _ => vec![],
    })
}

/// The value of a property, given as an attribute or in `style`.
fn property<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    let style = node.attribute("style").unwrap_or_default();
    let styled = style.split(';').filter_map(|entry| entry.split_once(':'));
    let value =
        styled.filter(|(key, _)| key.trim() == name).map(|(_, value)| value.trim()).next_back();
    value.or_else(|| node.attribute(name).map(str::trim))
}

/// Hidden, locked, or a grid to draw on.
fn is_hidden(node: Node<'_, '_>) -> bool {
    let classes = node.attribute("class").unwrap_or_default();
    let locked = node.attributes().find(|a| a.name() == "insensitive").map(|a| a.value());
    property(node, "display") == Some("none")
        || matches!(property(node, "visibility"), Some("hidden" | "collapse"))
        || classes.split_whitespace().any(|class| class == "grid")
        || locked == Some("true")
}

/// Whether a line joins known points whatever its directions.
fn joins(node: Node<'_, '_>) -> bool {
    let names = ["id", "class"].into_iter().filter_map(|name| node.attribute(name));
    names.flat_map(str::split_whitespace).any(|name| name.starts_with("join"))
}

/// A number of an attribute in user units; 0 if it is not there.
fn attribute(node: Node<'_, '_>, name: &str) -> Result<f64, ReadError> {
    let Some(text) = node.attribute(name) else { return Ok(0.0) };
    let length: Option<Length> = text.parse().ok();
    let unit = |unit| match unit {
        LengthUnit::None | LengthUnit::Px => Some(1.0),
        LengthUnit::In => Some(96.0),
        LengthUnit::Cm => Some(96.0 / 2.54),
        LengthUnit::Mm => Some(96.0 / 25.4),
        LengthUnit::Pt => Some(96.0 / 72.0),
        LengthUnit::Pc => Some(16.0),
        LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => None,
    };
    length.and_then(|length| Some(length.number * unit(length.unit)?)).ok_or_else(|| {
        let found = format!("{name} = \"{}\"", shortened(text));
        ISO.error(Place::File, found, "a length in user units, px, mm, cm, in, pt or pc is needed")
    })
}

/// The map of a `transform` attribute.
fn transform(text: &str) -> Result<DAffine2, ReadError> {
    let mut whole = DAffine2::IDENTITY;
    let skewed = |x: f64, y: f64| {
        let tangent = |angle: f64| sin_deg(angle) / cos_deg(angle);
        DAffine2::from_mat2(DMat2::from_cols_array(&[1.0, tangent(y), tangent(x), 1.0]))
    };
    for token in TransformListParser::from(text) {
        let token = token.map_err(|error| {
            let found = format!("transform = \"{}\" ({error})", shortened(text));
            ISO.error(Place::File, found, "a list of transforms is needed")
        })?;
        whole *= match token {
            TransformListToken::Matrix { a, b, c, d, e, f } => {
                DAffine2::from_cols_array(&[a, b, c, d, e, f])
            }
            TransformListToken::Translate { tx, ty } => DAffine2::from_translation(dvec2(tx, ty)),
            TransformListToken::Scale { sx, sy } => DAffine2::from_scale(dvec2(sx, sy)),
            TransformListToken::Rotate { angle } => {
                let (sin, cos) = (sin_deg(angle), cos_deg(angle));
                DAffine2::from_mat2(DMat2::from_cols_array(&[cos, sin, -sin, cos]))
            }
            TransformListToken::SkewX { angle } => skewed(angle, 0.0),
            TransformListToken::SkewY { angle } => skewed(0.0, angle),
        };
    }
    Ok(whole)
}

/// The parts of a path, and whether each is closed.
fn parts(text: &str, transform: &DAffine2) -> Result<Vec<(Vec<DVec2>, bool)>, ReadError> {
    let mut parts: Vec<(Vec<DVec2>, bool)> = vec![];
    for segment in SimplifyingPathParser::from(text) {
        let segment = segment.map_err(|error| {
            let found = format!("a path \"{}\" ({error})", shortened(text));
            ISO.error(Place::File, found, "path data is needed")
        })?;
        match (segment, parts.last_mut()) {
            (SimplePathSegment::MoveTo { x, y }, _) => parts.push((vec![dvec2(x, y)], false)),
            (SimplePathSegment::LineTo { x, y }, Some((points, _))) => points.push(dvec2(x, y)),
            (SimplePathSegment::ClosePath, Some((_, closed))) => *closed = true,
            (_, Some((points, _))) => {
                let at = transform.transform_point2(points[points.len() - 1]);
                let found = format!("a curved segment at ({}, {})", at.x, at.y);
                let needed = "strokes are straight; a curve is drawn as its control polygon";
                return Err(ISO.error(Place::File, found, needed));
            }
            (_, None) => {}
        }
    }
    Ok(parts)
}
