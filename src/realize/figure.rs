//! Plane figures: profiles made into regions, each with the frame of its plane.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

use glam::DAffine2;

use super::{
    Realizer,
    failure::{At, Coded, Made, failure},
    import,
    paint::Paint,
    plane,
    structure::figure_parts,
};
use crate::{
    base::{Code, Diagnostic},
    geom::{Contour, EdgeCurve, Placement, Region, Tolerance, flatten::MOST_CHORDS, sides},
    input,
    kernel::profile::{
        self, ProfileError,
        text::{Align, Baseline, Text, TextOptions},
    },
    shape::{
        GeometryError, Node, ShapeGraph, ShapeId, Stretched,
        node::{HorizontalAlign, TextSpec, VerticalAlign},
    },
};

/// A realised profile.
#[derive(Clone, PartialEq, Debug)]
pub struct Figure {
    /// In the coordinates of its plane.
    pub region: Region,
    /// The rigid motion from the xy plane to its plane.
    pub frame: Placement,
    /// Tags and colour for the faces of a solid made from it.
    pub paint: Paint,
}

impl Figure {
    fn flat(region: Region) -> Figure {
        Figure { region, frame: Placement::IDENTITY, paint: Paint::default() }
    }

    fn with_region(&self, region: Region) -> Figure {
        Figure { region, frame: self.frame, paint: self.paint.clone() }
    }
}

impl Coded for ProfileError {
    fn code(&self) -> Code {
        match self {
            ProfileError::SelfCrossing { .. } | ProfileError::StrayHole { .. } => {
                Code::SelfCrossing
            }
            ProfileError::Font { .. } | ProfileError::Glyph { .. } => Code::BadFile,
            ProfileError::LongText { .. } | ProfileError::FineCurve { .. } => Code::Limit,
            ProfileError::Sides { sides } if *sides > profile::MOST_SIDES => Code::Limit,
            _ => Code::Degenerate,
        }
    }
}

/// Where the figures that another one is made from come from.
type Parts<'a> = &'a dyn Fn(ShapeId) -> Made<Arc<Figure>>;

/// Makes the figure of a profile node whose parts are made.
pub fn make(realizer: &Realizer, graph: &ShapeGraph, unit: Stretched) -> Made<Figure> {
    let tolerance = realizer.tolerance_of(unit);
    build(realizer, graph, unit, tolerance, &|part| realizer.figure_made(part))
}

/// The figure of a profile for a solid that bends it once more, and what is left of the solid's `tolerance`
/// for the bending: the two errors add up, so each gets half where the profile has curves.
pub fn bent(
    realizer: &Realizer,
    graph: &ShapeGraph,
    unit: Stretched,
    tolerance: Tolerance,
) -> Made<(Arc<Figure>, Tolerance)> {
    let figure = realizer.figure_made(unit)?;
    let straight = |contour: &Contour| contour.curves.iter().all(|c| *c == EdgeCurve::Line);
    if figure.region.contours().all(straight) {
        return Ok((figure, tolerance));
    }
    let mut needed = BTreeSet::from([unit]);
    let mut open = vec![unit];
    while let Some(next) = open.pop() {
        open.extend(figure_parts(graph, next).into_iter().filter(|&part| needed.insert(part)));
    }
    let mut made: BTreeMap<Stretched, Arc<Figure>> = BTreeMap::new();
    for &next in &needed {
        let half = realizer.tolerance_of(next).half();
        let figure = build(realizer, graph, next, half, &|part| Ok(made[&part].clone()))?;
        made.insert(next, Arc::new(figure));
    }
    Ok((made[&unit].clone(), tolerance.half()))
}

fn build(
    realizer: &Realizer,
    graph: &ShapeGraph,
    unit: Stretched,
    tolerance: Tolerance,
    made: &dyn Fn(Stretched) -> Made<Arc<Figure>>,
) -> Made<Figure> {
    let id = unit.id;
    let origin = graph.origin(id);
    let part = |id: &ShapeId| made(graph.part(unit, *id));
    let parts: Parts = &|id| part(&id);
    match graph.node(id) {
        Node::Rect { size } => profile::rect(*size).at(origin).map(Figure::flat),
        Node::Ellipse { radii, sides } => {
            profile::ellipse(*radii, *sides, tolerance).at(origin).map(Figure::flat)
        }
        Node::Polygon { points, holes } => {
            let holes: Vec<_> = holes.iter().map(|hole| hole.to_vec()).collect();
            profile::polygon(points, &holes).at(origin).map(Figure::flat)
        }
        Node::Outline { curve } => profile::enclosed(curve, tolerance).at(origin).map(Figure::flat),
        Node::Text(spec) => text(realizer, spec, tolerance)
            .map_err(|e| placed(e, graph, id))
            .map(|t| Figure::flat(t.region)),
        Node::ImportProfile { file } => {
            let bytes = realizer.bytes(file).map_err(|e| placed(e, graph, id))?;
            let drawing = input::read_profile(file, &bytes, tolerance);
            let drawing = drawing.map_err(|e| placed(import::unreadable(file, &e), graph, id))?;
            realizer.remark(graph, id, file, &drawing.notes);
            Ok(Figure::flat(drawing.region))
        }
        Node::OffsetProfile { profile, d } => {
            let figure = part(profile)?;
            check_arcs(graph, id, *d, tolerance)?;
            Ok(figure.with_region(profile::offset(&figure.region, *d, tolerance)))
        }
        Node::RoundProfile { profile, r } => {
            let figure = part(profile)?;
            check_arcs(graph, id, *r, tolerance)?;
            Ok(figure.with_region(profile::round(&figure.region, *r, tolerance)))
        }
        Node::Fillet { child, convex, concave } => {
            let figure = part(child)?;
            check_arcs(graph, id, convex.max(*concave), tolerance)?;
            let region = profile::fillet(&figure.region, *convex, *concave, tolerance);
            Ok(figure.with_region(region))
        }
        Node::Transform { placement, child } => {
            transformed(&*part(child)?, placement).ok_or_else(|| flattened(graph, id))
        }
        Node::Tag { name, child } => {
            let figure = part(child)?;
            let paint = figure.paint.within(&Paint::default().tagged(name));
            Ok(Figure { paint, ..Figure::clone(&figure) })
        }
        Node::Paint { color, child } => {
            let figure = part(child)?;
            let paint = figure.paint.within(&Paint::default().painted(*color));
            Ok(Figure { paint, ..Figure::clone(&figure) })
        }
        Node::Union(list) => combined(parts, graph, list, profile::union),
        Node::Difference(list) => combined(parts, graph, list, profile::difference),
        Node::Intersection(list) => combined(parts, graph, list, profile::intersection),
        Node::Hull(list) => {
            let joined = combined(parts, graph, list, profile::union)?;
            let points: Vec<_> =
                joined.region.contours().flat_map(|c| c.points.iter().copied()).collect();
            Ok(joined.with_region(profile::hull(&points).at(origin)?))
        }
        _ => Ok(Figure::flat(Region::default())),
    }
}

/// Refuses arcs that need more chords than are made.
fn check_arcs(graph: &ShapeGraph, id: ShapeId, radius: f64, tolerance: Tolerance) -> Made<()> {
    let needed = sides::circle(radius, tolerance);
    if needed <= MOST_CHORDS {
        return Ok(());
    }
    let words = format!(
        "a circle of {}mm needs {needed} chords at this tolerance; the limit is {MOST_CHORDS}",
        radius.abs()
    );
    let diagnostic = Diagnostic::error(Code::Limit, words).label(graph.origin(id), "");
    Err(failure(diagnostic.help("give a larger tolerance")))
}

/// The figure after a placement; `None` where that flattens it.
fn transformed(figure: &Figure, placement: &Placement) -> Option<Figure> {
    let (within, frame) = plane::split(&placement.after(&figure.frame))?;
    let region = moved(&figure.region, &within);
    Some(Figure { region, frame, paint: figure.paint.clone() })
}

/// The region after a map of its plane, to the bit the same where the map changes nothing.
pub fn moved(region: &Region, map: &DAffine2) -> Region {
    if *map == DAffine2::IDENTITY { region.clone() } else { profile::placed(region, map) }
}

/// The region of a figure as `revolve` and `sweep` see it: a plane that was moved within itself takes its region
/// along.
pub fn upright(figure: &Figure) -> Region {
    let m = figure.frame.linear();
    let t = figure.frame.offset();
    let shift = glam::DVec2::new(t.dot(m.x_axis), t.dot(m.y_axis));
    moved(&figure.region, &DAffine2::from_translation(shift))
}

/// The error for a placement that leaves no area.
pub fn flattened(graph: &ShapeGraph, id: ShapeId) -> GeometryError {
    let words = "the placement flattens the shape; every direction needs a scale other than 0";
    failure(Diagnostic::error(Code::Degenerate, words).label(graph.origin(id), ""))
}

/// Set algebra of figures in one plane, in the frame of the first one. A paint holds where all agree.
fn combined(
    parts: Parts,
    graph: &ShapeGraph,
    list: &[ShapeId],
    algebra: fn(&[Region]) -> Region,
) -> Made<Figure> {
    let figures: Vec<Arc<Figure>> = list.iter().map(|&id| parts(id)).collect::<Result<_, _>>()?;
    let Some(leader) = figures.iter().position(|f| !f.region.is_empty()) else {
        return Ok(Figure::flat(Region::default()));
    };
    let frame = figures[leader].frame;
    let mut regions = vec![];
    for (figure, &id) in figures.iter().zip(list) {
        let apart = || two_planes(graph, list[leader], id);
        let empty = figure.region.is_empty();
        let map =
            if empty { Some(DAffine2::IDENTITY) } else { plane::between(&figure.frame, &frame) };
        regions.push(moved(&figure.region, &map.ok_or_else(apart)?));
    }
    let paint = figures[leader].paint.clone();
    let agreed = figures.iter().all(|f| f.paint == paint);
    Ok(Figure {
        region: algebra(&regions),
        frame,
        paint: if agreed { paint } else { Paint::default() },
    })
}

fn two_planes(graph: &ShapeGraph, a: ShapeId, b: ShapeId) -> GeometryError {
    let words = "these profiles lie in different planes; set operations need one plane";
    let diagnostic = Diagnostic::error(Code::Degenerate, words)
        .label(graph.origin(b), "this one is in another plane")
        .label(graph.origin(a), "than this one")
        .help("move the profiles after they are combined, or extrude them first");
    failure(diagnostic)
}

/// Gives an error without a place the place of the node that asked.
pub fn placed(mut error: GeometryError, graph: &ShapeGraph, id: ShapeId) -> GeometryError {
    if error.diagnostic.labels.is_empty() {
        let label = crate::base::Label { span: graph.origin(id), message: String::new() };
        error.diagnostic.labels.push(label);
    }
    error
}

/// A text as the profile kernel sets it. The error has no place yet.
pub fn text(realizer: &Realizer, spec: &TextSpec, tolerance: Tolerance) -> Made<Text> {
    let font = spec.font.as_ref().map(|file| realizer.bytes(file)).transpose()?;
    let options = TextOptions {
        size: spec.size,
        halign: match spec.halign {
            HorizontalAlign::Left => Align::Left,
            HorizontalAlign::Center => Align::Center,
            HorizontalAlign::Right => Align::Right,
        },
        valign: match spec.valign {
            VerticalAlign::Top => Baseline::Top,
            VerticalAlign::Center => Baseline::Center,
            VerticalAlign::Baseline => Baseline::Baseline,
            VerticalAlign::Bottom => Baseline::Bottom,
        },
        tolerance,
    };
    profile::text::text(&spec.text, &options, font.as_ref().map(|bytes| &bytes[..])).unplaced()
}
