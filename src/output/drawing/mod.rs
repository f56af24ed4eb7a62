//! Hidden-line drawings: which lines of a scene an eye sees.
//!
//! A [`Scene`] of meshes is looked at through a [`Camera`]; [`visible_lines`] gives the [`Drawing`]: lines in
//! millimetres on paper, each with its class, what it stands for and whose it is. Nothing here knows of
//! files, pens or sheets.
//!
//! ```
//! use glam::DVec3;
//! use katachi::{kernel::brep::primitive::cuboid, output::drawing::{Camera, Options, Scene, View, visible_lines}};
//! let cube = cuboid(DVec3::ZERO, DVec3::ONE);
//! let drawing = visible_lines(&Scene::of([cube.mesh()]), &Camera::view(View::Iso), &Options::default());
//! let edge = (2.0f64 / 3.0).sqrt();
//! assert!((drawing.visible - 9.0 * edge).abs() < 1e-12);
//! assert!((drawing.hidden - 3.0 * edge).abs() < 1e-12);
//! ```
//!
//! # Paper
//! T. Nishita, hidden lines of sets of polyhedra by the order of invisibility (METHODS, section 3).

mod arcs;
mod camera;
mod cells;
mod chain;
mod clip;
mod conic;
mod count;
#[allow(clippy::module_inception, reason = "the noun is the file's")]
mod drawing;
mod field;
mod fit;
mod lattice;
mod links;
mod meet;
mod merge;
mod model;
mod scene;
mod smooth;
mod span;

pub use camera::{Camera, CameraError, View, Window};
pub use drawing::{Class, Drawing, Line, Path, Segment};
pub use scene::{Body, Hidden, Kind, Method, Options, Scene, Stroke};

use arcs::ArcPiece;
use clip::Clipper;
use count::Counter;
use fit::{Fitted, Shape};
use links::NONE;
use merge::{Mark, Piece};
use model::{Edge, Model};
use span::Span;

/// Lines coincide on paper when they are nearer than this part of the picture's size: corners that set
/// operations rounded to 2^-29 of the size are a few times that apart.
const COINCIDENT: f64 = 1e-8;

/// The lines of a scene that an eye sees, and those it would see but for what is in front.
///
/// Never fails: what is behind the eye or outside the window is left out, and a scene without lines gives a
/// drawing without lines. The same input gives the same drawing whatever the number of threads.
pub fn visible_lines(scene: &Scene, camera: &Camera, options: &Options) -> Drawing {
    let model = Model::new(scene, camera, options);
    let mut sheet = Sheet::default();
    hide(&model, options.method, &mut sheet);
    sheet.assemble(model.picture_size() * COINCIDENT, options.hidden)
}

/// Lines before they are merged.
#[derive(Default)]
struct Sheet {
    straight: Vec<Piece>,
    arcs: Vec<ArcPiece>,
    curves: Vec<(Path, Mark)>,
}

/// Puts all edges on the sheet.
fn hide(model: &Model, method: Method, sheet: &mut Sheet) {
    let clipper = Clipper::new(model);
    let mut desk = clipper.desk();
    let counter = Counter::new(model, &clipper);
    let mut tally = counter.tally();
    let mut spans = vec![];
    let clip = method == Method::Clip;
    for edge in &model.edges {
        if edge.curve != NONE || model.at[edge.a as usize] == model.at[edge.b as usize] {
            continue;
        }
        spans.clear();
        if clip || model.pierces(edge) {
            clipper.hide(edge, &mut desk, &mut spans);
        } else {
            counter.hide(edge, &mut tally, &mut spans);
        }
        sheet.add_spans(model, edge, &spans);
    }
    let tolerance = model.picture_size() * COINCIDENT;
    for chain in chain::chains(model) {
        let edge = &model.edges[chain[0].edge as usize];
        let fitted = Fitted::new(model, &chain, tolerance);
        for stretch in counter.hide_chain(&chain, &mut tally) {
            let mark = mark(edge, stretch.order);
            fitted.shapes(&stretch, |shape| sheet.add_shape(shape, mark));
        }
    }
}

/// How a part of an edge behind so many faces is drawn.
fn mark(edge: &Edge, order: u32) -> Mark {
    let class = match edge.kind {
        Kind::Cutting => Class::Cutting,
        Kind::Centre => Class::Centre,
        _ if order == 0 => Class::Visible,
        _ => Class::Hidden,
    };
    Mark { class, order, kind: edge.kind, id: edge.id }
}

impl Sheet {
    /// Adds the parts of a straight edge.
    fn add_spans(&mut self, model: &Model, edge: &Edge, spans: &[Span]) {
        let [p, q] = [edge.a, edge.b].map(|i| model.at[i as usize]);
        let place = |t: f64| model.lattice.millimetres(p + (q - p) * t);
        for span in spans {
            let (from, to) = (place(span.from), place(span.to));
            self.straight.push(Piece { from, to, mark: mark(edge, span.order) });
        }
    }

    fn add_shape(&mut self, shape: Shape, mark: Mark) {
        match shape {
            Shape::Straight(from, to) => self.straight.push(Piece { from, to, mark }),
            Shape::Arc(ellipse, from, to) => self.arcs.push(ArcPiece { ellipse, from, to, mark }),
            Shape::Curve(path) => self.curves.push((path, mark)),
        }
    }

    /// Merges what coincides within `tolerance` mm, measures, and keeps what is wanted.
    fn assemble(self, tolerance: f64, hidden: Hidden) -> Drawing {
        let straight = merge::merged(&self.straight, tolerance).into_iter().map(|p| {
            (Path::of(p.from, Segment::Line { to: p.to }), p.mark)
        });
        let arcs = arcs::merged(&self.arcs, tolerance).into_iter().map(|a| {
            let (from, to) = (a.from, a.to);
            let conic::Ellipse { center, major, minor } = a.ellipse;
            let arc = Segment::Arc { center, major, minor, from, to };
            (Path::of(a.ellipse.at(from), arc), a.mark)
        });
        let mut drawing = Drawing::default();
        for (path, mark) in straight.chain(arcs).chain(self.curves) {
            drawing.add(path, mark, hidden);
        }
        drawing
    }
}

impl Drawing {
    /// Measures a line and keeps it if it is wanted.
    fn add(&mut self, path: Path, mark: Mark, hidden: Hidden) {
        match mark.class {
            Class::Visible => self.visible += path.length(),
            Class::Hidden => self.hidden += path.length(),
            Class::Cutting | Class::Centre => {}
        }
        self.segments += usize::from(mark.class <= Class::Hidden);
        let class = match (mark.class, hidden) {
            (Class::Hidden, Hidden::Off) => return,
            (Class::Hidden, Hidden::Depth(most)) if mark.order <= most => Class::Visible,
            (Class::Hidden, Hidden::Depth(_)) => return,
            (class, _) => class,
        };
        self.lines.push(Line { class, kind: mark.kind, id: mark.id, order: mark.order, path });
    }
}
