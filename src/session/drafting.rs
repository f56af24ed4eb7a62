//! From what a model says of a view to lines on paper: makes the solids, cuts them where the view is a section,
//! asks for visible lines, and measures dimensions.

use std::{cell::RefCell, sync::Arc};

use glam::{DVec2, DVec3};

use super::{
    axes, cut,
    outline::{Outline, Tracer},
    patterns,
    subjects::Subjects,
};
use crate::{
    base::{Code, Diagnostic, Phase, Span, Watch, watch::during},
    geom::{PolyMesh, Tolerance, View},
    kernel::profile::{self, TextOptions},
    output::{
        drawing::{self, Camera, CameraError, Drawing, Window},
        sheet::{
            self, CuttingLine, Dimension, Figure, IsometricGrid, Layer, Lettering, Shape,
            dimension_number,
        },
    },
    realize::{self, Realizer},
    shape::{
        Node, ShapeGraph, ShapeId, ViewSpec,
        drawing::{CuttingSpec, DimSpec, Measured, PenName, Projection, StyleSpec},
    },
};

/// Width over height of the window that a field of view opens.
const ASPECT: f64 = 4.0 / 3.0;

/// A drawing made, and what is to be said about it.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The drawing.
    pub figure: Figure,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
}

/// What became of a view.
type Outcome = Result<Arc<Drawn>, Diagnostic>;

/// Draws views of the shapes of one graph; each view once.
pub struct Drafter<'a> {
    pub(super) realizer: &'a Realizer<'a>,
    pub(super) graph: &'a ShapeGraph,
    watch: &'a dyn Watch,
    drawn: RefCell<Vec<(Arc<ViewSpec>, Outcome)>>,
}

impl<'a> Drafter<'a> {
    pub fn new(realizer: &'a Realizer<'a>, graph: &'a ShapeGraph, watch: &'a dyn Watch) -> Self {
        Drafter { realizer, graph, watch, drawn: RefCell::default() }
    }

    /// The drawing of a view. Fails with the diagnostic of a shape that cannot be made, or of a dimension that the
    /// view does not show.
    pub fn draw(&self, view: &Arc<ViewSpec>) -> Outcome {
        let known = |(other, _): &&(Arc<ViewSpec>, _)| Arc::ptr_eq(other, view) || other == view;
        if let Some((_, drawn)) = self.drawn.borrow().iter().find(known) {
            return drawn.clone();
        }
        let drawn = self.make(view).map(Arc::new);
        self.drawn.borrow_mut().push((view.clone(), drawn.clone()));
        drawn
    }

    /// Runs `work` as one phase of the watch.
    pub fn timed<T>(&self, phase: Phase, work: impl FnOnce() -> T) -> T {
        during(self.watch, phase, work)
    }

    fn make(&self, view: &ViewSpec) -> Result<Drawn, Diagnostic> {
        self.realizer.realize(self.graph, &view.shapes);
        let tracer = Tracer { realizer: self.realizer, graph: self.graph };
        let (mut free, mut tags) = (vec![], vec![]);
        for curve in &view.curves {
            free.extend(tracer.curve(curve)?);
            tags.resize(free.len(), curve.tag().cloned());
        }
        for &profile in &view.profiles {
            free.extend(tracer.profile(profile)?);
        }
        let mut warnings = vec![];
        let mut solids = vec![];
        for &shape in &view.shapes {
            let solid = self.realizer.solid(self.graph, shape).map_err(|e| *e.diagnostic)?;
            warnings.extend(realize::warnings(self.realizer, self.graph, shape));
            solids.push(solid.polyhedron);
        }
        let camera = sight(view.projection, view.target, view.window);
        let camera = camera.map_err(|error| refused(&error, view.place.0))?;
        during(self.watch, Phase::Drawings, || {
            // Holes keep their centre lines when the cut takes half of them.
            let axes = match view.center_lines {
                true => axes::center_lines(solids.iter().map(|solid| solid.mesh()), &camera),
                false => vec![],
            };
            let mut cuts = vec![];
            if let Some(plane) = &view.section {
                let cut = cut::cut(&mut solids, plane, &camera, self.realizer.tolerance());
                cuts = cut.map_err(|words| at(Code::WrongKind, words, view.place.0))?;
                if cuts.is_empty() && !solids.is_empty() {
                    warnings.push(cut::misses(&solids, view.place.0));
                }
            }
            let meshes: Vec<&PolyMesh> = solids.iter().map(|solid| solid.mesh()).collect();
            let patterns = patterns::all(&tracer, &view.shapes, &meshes)?;
            let bounds = bounds(view, &meshes, &free);
            let shown_axes = axes.iter().filter_map(|ends| on_paper(ends, &camera)).collect();
            let subjects = Subjects { solids: meshes, free, axes, patterns };
            let mut drawing = subjects.lines(view, &camera, &self.options(view));
            warnings.extend(blank(&drawing, view, bounds));
            if let Some(cast) = &view.shadow {
                subjects.cast(&mut drawing, cast, view, (&camera, &self.options(view)));
            }
            let dimensions = view.dims.iter().map(|dim| dimension(dim, view, &camera));
            let dimensions = dimensions.collect::<Result<_, _>>()?;
            let shapes = view.shapes.iter().map(|&shape| name_of(self.graph, shape));
            let parts = shapes.chain(view.surfaces.iter().map(|_| None)).chain(tags).collect();
            let style = style(&view.style);
            let cuttings = view.cuttings.iter().map(|cutting| cutting_line(cutting, &camera));
            let cuttings = cuttings.collect::<Result<_, _>>()?;
            let caption = view.caption.as_deref().unwrap_or_default().into();
            let figure = Figure {
                drawing,
                parts,
                cuts,
                axes: shown_axes,
                cuttings,
                grid: grid(view, &camera),
                caption,
                dimensions,
                style,
            };
            coarse_enough(&figure, view)?;
            Ok(Drawn { figure, warnings })
        })
    }

    /// How the lines of a view are wanted.
    fn options(&self, view: &ViewSpec) -> drawing::Options {
        let standard = drawing::Options::default();
        let crease = view.style.crease.unwrap_or(standard.crease);
        drawing::Options {
            hidden: view.hidden,
            method: view.method,
            tolerance: self.realizer.tolerance(),
            crease,
        }
    }
}

/// Text in the embedded font.
pub struct Letterer;

impl Lettering for Letterer {
    fn outlines(&self, text: &str, height: f64) -> Option<(Vec<Vec<DVec2>>, f64)> {
        let fine = Tolerance::new(height * LETTER_CHORD)?;
        let options = TextOptions { size: height, tolerance: fine, ..TextOptions::default() };
        let set = profile::text(text, &options, None).ok()?;
        let contours = set.region.contours().map(|contour| contour.points.clone());
        Some((contours.collect(), set.width))
    }
}

/// Chord error of letters for each millimetre of their height: far below what a pen shows.
const LETTER_CHORD: f64 = 2e-3;

pub(super) fn at(code: Code, words: impl Into<String>, span: Span) -> Diagnostic {
    Diagnostic::error(code, words).label(span, "")
}

pub(super) fn refused(error: &CameraError, span: Span) -> Diagnostic {
    at(Code::Degenerate, error.to_string(), span)
}

/// The camera of a view or picture.
pub(super) fn sight(
    projection: Projection,
    target: DVec3,
    window: Option<[DVec2; 2]>,
) -> Result<Camera, CameraError> {
    let camera = match projection {
        Projection::Side(side) => Camera::view(side).at(target),
        Projection::Direction(direction) => Camera::parallel(direction)?.at(target),
        Projection::Perspective { eye, fov } => {
            let camera = Camera::perspective(eye, target)?;
            fov.map_or(Ok(camera), |fov| camera.with_field_of_view(fov, ASPECT))?
        }
    };
    match window {
        Some([min, max]) => camera.with_window(Window { min, max }),
        None => Ok(camera),
    }
}

/// The outermost tag of a shape.
fn name_of(graph: &ShapeGraph, mut shape: ShapeId) -> Option<Arc<str>> {
    loop {
        match graph.node(shape) {
            Node::Tag { name, .. } => return Some(name.clone()),
            Node::Transform { child, .. }
            | Node::Paint { child, .. }
            | Node::Figured { child, .. } => shape = *child,
            _ => return None,
        }
    }
}

/// The corners of the box around all that a view shows.
fn bounds(view: &ViewSpec, meshes: &[&PolyMesh], free: &[Outline]) -> Option<[DVec3; 2]> {
    let mut corners: Option<[DVec3; 2]> = None;
    let mut take = |p: DVec3| {
        corners = Some(corners.map_or([p, p], |[min, max]| [min.min(p), max.max(p)]));
    };
    meshes.iter().flat_map(|mesh| &mesh.points).for_each(|p| take(*p));
    view.surfaces.iter().flat_map(|grid| grid.points()).for_each(|p| take(*p));
    free.iter().flat_map(|line| &line.points).for_each(|p| take(*p));
    corners
}

/// The guide mesh of a view.
fn grid(view: &ViewSpec, camera: &Camera) -> Option<IsometricGrid> {
    let origin = camera.project(DVec3::ZERO).unwrap_or_default();
    view.grid.map(|pitch| IsometricGrid { origin, pitch, window: view.window })
}

/// Refuses a guide mesh of too many lines.
fn coarse_enough(figure: &Figure, view: &ViewSpec) -> Result<(), Diagnostic> {
    let Some(grid) = &figure.grid else { return Ok(()) };
    let bare = Figure { grid: None, ..figure.clone() };
    let outline = sheet::bounds(&bare.inks(1.0, &Letterer));
    let lines = grid.lines(1.0, outline);
    if lines <= sheet::MOST_LINES {
        return Ok(());
    }
    let words = format!("the grid would have {lines} lines; the limit is {}", sheet::MOST_LINES);
    Err(at(Code::Limit, words, view.place.0).help("give it a larger pitch"))
}

/// The warning for a drawing without lines.
fn blank(drawing: &Drawing, view: &ViewSpec, bounds: Option<[DVec3; 2]>) -> Option<Diagnostic> {
    if drawing.segments > 0 || !drawing.lines.is_empty() || view.grid.is_some() {
        return None;
    }
    let warning = |words| Diagnostic::warning(Code::EmptyResult, words).label(view.place.0, "");
    let Some([min, max]) = bounds else {
        return Some(warning("the view shows nothing: its shapes are empty"));
    };
    let corner = |p: DVec3| format!("[{}, {}, {}]", short(p.x), short(p.y), short(p.z));
    let words = "the view shows nothing: nothing of its shapes is in the window";
    let noted =
        warning(words).note(format!("the shapes lie in {} to {}", corner(min), corner(max)));
    Some(match view.window {
        Some([min, max]) => noted.note(format!(
            "the window is [{}, {}] to [{}, {}] on paper",
            short(min.x),
            short(min.y),
            short(max.x),
            short(max.y)
        )),
        None => noted,
    })
}

/// A number for people: four decimals at most.
pub(super) fn short(x: f64) -> String {
    format!("{}", (x * 1e4).round() / 1e4 + 0.0)
}

pub(super) fn style(spec: &StyleSpec) -> sheet::Style {
    let mut style = sheet::Style::default();
    for (name, change) in &spec.pens {
        let pen = style.pen_mut(layer(*name));
        pen.width = change.width.unwrap_or(pen.width);
        pen.color = change.color.unwrap_or(pen.color);
        if let Some(dash) = &change.dash {
            pen.dash.clone_from(dash);
        }
    }
    style.hatch_pitch = spec.hatch_pitch.unwrap_or(style.hatch_pitch);
    style.text_height = spec.text_height.unwrap_or(style.text_height);
    style
}

fn layer(name: PenName) -> Layer {
    match name {
        PenName::Visible => Layer::Visible,
        PenName::Hidden => Layer::Hidden,
        PenName::Center => Layer::Center,
        PenName::Cutting => Layer::Cutting,
        PenName::Section => Layer::Section,
        PenName::Hatch => Layer::Hatch,
        PenName::Dimension => Layer::Dimension,
        PenName::Pattern => Layer::Pattern,
        PenName::Free => Layer::Free,
        PenName::Upper => Layer::Upper,
        PenName::Lower => Layer::Lower,
        PenName::Shadow => Layer::Shadow,
        PenName::Grid => Layer::Grid,
    }
}

/// The images of two points; `None` where one is not in the picture.
fn on_paper([a, b]: &[DVec3; 2], camera: &Camera) -> Option<[DVec2; 2]> {
    let seen = |p: &DVec3| {
        let within = |p: DVec2, w: Window| p.cmpge(w.min).all() && p.cmple(w.max).all();
        camera.project(*p).filter(|&p| camera.window().is_none_or(|w| within(p, w)))
    };
    Some([seen(a)?, seen(b)?])
}

/// The line of a cutting plane on paper. Fails in views that do not look along the plane.
fn cutting_line(spec: &CuttingSpec, camera: &Camera) -> Result<CuttingLine, Diagnostic> {
    let toward = -spec.plane.normal.normalize();
    let across = toward.dot(camera.toward());
    if camera.is_perspective() || across.abs() > ALONG {
        let words = "the cutting plane is not seen as a line: the view does not look along it";
        let help = "draw the line in a parallel view whose sight line lies in the plane";
        return Err(at(Code::Degenerate, words, spec.place.0).help(help));
    }
    let image = |p: DVec3| camera.project(p).unwrap_or_default();
    let from = image(spec.plane.at);
    let toward = (image(spec.plane.at + toward) - from).normalize_or_zero();
    Ok(CuttingLine { at: from, toward, name: spec.name.to_string() })
}

/// The sine of the angle to the sight line below which a plane is seen as a line.
const ALONG: f64 = 1e-9;

/// A dimension on paper. Fails for points that the view does not show apart.
fn dimension(spec: &DimSpec, view: &ViewSpec, camera: &Camera) -> Result<Dimension, Diagnostic> {
    let image = |p: DVec3| {
        let behind =
            || at(Code::OutOfRange, "the dimension has a point behind the eye", spec.place.0);
        camera.project(p).ok_or_else(behind)
    };
    let (shape, values) = match &spec.measured {
        Measured::Linear { points, along, offset } => {
            let images = points.iter().map(|&p| image(p)).collect::<Result<Vec<_>, _>>()?;
            let ends = (images[0], images[images.len() - 1]);
            let way = match along {
                Some(along) => image(points[0] + *along)? - ends.0,
                None => ends.1 - ends.0,
            };
            let Some(unit) = way.try_normalize() else {
                let words =
                    "the dimension has no length in this view: its direction is that of sight";
                return Err(at(Code::Degenerate, words, spec.place.0));
            };
            let values = lengths(points, &images, *along, unit, view);
            (Shape::Linear { points: images, along: unit, offset: *offset }, values)
        }
        Measured::Round { center, r, diameter, angle } => {
            let value = if *diameter { 2.0 * r } else { *r };
            let r = r * camera.magnification(*center);
            let center = image(*center)?;
            (Shape::Round { center, r, diameter: *diameter, angle: *angle }, vec![value])
        }
        Measured::Angle { apex, from, to, r } => {
            let [center, a, b] = [image(*apex)?, image(*from)?, image(*to)?];
            let degrees = |p: DVec2| libm::atan2(p.y - center.y, p.x - center.x).to_degrees();
            let from_angle = degrees(a);
            let turn = degrees(b) - from_angle;
            let turn = if turn <= 0.0 { turn + 360.0 } else { turn };
            let value = if is_true(view) { turn } else { between(*from - *apex, *to - *apex) };
            let legs = [a, b];
            (Shape::Angle { apex: center, legs, from: from_angle, turn, r: *r }, vec![value])
        }
    };
    let (before, after) = match spec.measured {
        Measured::Linear { .. } => ("", ""),
        Measured::Round { diameter, .. } => (if diameter { "Ø" } else { "R" }, ""),
        Measured::Angle { .. } => ("", "°"),
    };
    let text = |value: &f64| {
        let number = format!("{before}{}{after}", dimension_number(*value));
        spec.text.as_ref().map_or(number.clone(), |text| text.replace("<>", &number))
    };
    Ok(Dimension { shape, texts: values.iter().map(text).collect() })
}

/// Whether a view shows two of the three axes in true length.
fn is_true(view: &ViewSpec) -> bool {
    !matches!(
        view.projection,
        Projection::Side(View::Iso | View::Dimetric) | Projection::Perspective { .. }
    )
}

/// Degrees between two directions.
fn between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b)).to_degrees()
}

/// The measured lengths: along a direction of the model where one is given, on paper in views that show true
/// lengths, else in space.
fn lengths(
    points: &[DVec3],
    images: &[DVec2],
    along: Option<DVec3>,
    unit: DVec2,
    view: &ViewSpec,
) -> Vec<f64> {
    let pairs = points.windows(2).zip(images.windows(2));
    pairs
        .map(|(p, q)| match along {
            Some(along) => (p[1] - p[0]).dot(along.normalize()).abs(),
            None if is_true(view) => (q[1] - q[0]).dot(unit).abs(),
            None => p[0].distance(p[1]),
        })
        .collect()
}
