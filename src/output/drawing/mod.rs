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

mod camera;
mod cells;
mod clip;
mod count;
#[allow(clippy::module_inception, reason = "the noun is the file's")]
mod drawing;
mod lattice;
mod links;
mod merge;
mod model;
mod scene;
mod span;

pub use camera::{Camera, CameraError, View, Window};
pub use drawing::{Class, Drawing, Line, Path, Segment};
pub use scene::{Body, Hidden, Kind, Method, Options, Scene, Stroke};

use clip::Clipper;
use count::Counter;
use merge::{Piece, merged};
use model::Model;
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
    let spans = hidden_spans(&model, options.method);
    let pieces = pieces(&model, &spans);
    let (min, max) = cells::around(model.at.iter().copied());
    let size = if min.x <= max.x { (max - min).max_element() / model.lattice.steps(1.0) } else { 0.0 };
    assemble(&merged(&pieces, size * COINCIDENT), options.hidden)
}

/// The spans of every edge, and where each edge's begin.
struct Spans {
    starts: Vec<u32>,
    spans: Vec<Span>,
}

fn hidden_spans(model: &Model, method: Method) -> Spans {
    let clipper = Clipper::new(model);
    let mut all = Spans { starts: vec![0], spans: vec![] };
    match method {
        Method::Clip => {
            let mut desk = clipper.desk();
            all.collect(model, |edge, out| clipper.hide(edge, &mut desk, out));
        }
        Method::Auto | Method::Count => {
            let counter = Counter::new(model, &clipper);
            let mut tally = counter.tally();
            all.collect(model, |edge, out| counter.hide(edge, &mut tally, out));
        }
    }
    all
}

impl Spans {
    fn collect(&mut self, model: &Model, mut hide: impl FnMut(&model::Edge, &mut Vec<Span>)) {
        for edge in &model.edges {
            if model.at[edge.a as usize] != model.at[edge.b as usize] {
                hide(edge, &mut self.spans);
            }
            self.starts.push(self.spans.len() as u32);
        }
    }
}

/// The parts of all edges on paper.
fn pieces(model: &Model, spans: &Spans) -> Vec<Piece> {
    let mut pieces = Vec::with_capacity(spans.spans.len());
    for (edge, range) in model.edges.iter().zip(spans.starts.windows(2)) {
        let [p, q] = [edge.a, edge.b].map(|i| model.at[i as usize]);
        let place = |t: f64| model.lattice.millimetres(p + (q - p) * t);
        for span in &spans.spans[range[0] as usize..range[1] as usize] {
            let class = match edge.kind {
                Kind::Cutting => Class::Cutting,
                Kind::Centre => Class::Centre,
                _ if span.order == 0 => Class::Visible,
                _ => Class::Hidden,
            };
            let (from, to) = (place(span.from), place(span.to));
            pieces.push(Piece { from, to, class, kind: edge.kind, id: edge.id, order: span.order });
        }
    }
    pieces
}

fn assemble(pieces: &[Piece], hidden: Hidden) -> Drawing {
    let length = |class: Class| {
        let of = pieces.iter().filter(|p| p.class == class);
        of.map(|p| p.from.distance(p.to)).sum::<f64>()
    };
    let counted = |p: &&Piece| p.class <= Class::Hidden;
    Drawing {
        visible: length(Class::Visible),
        hidden: length(Class::Hidden),
        segments: pieces.iter().filter(counted).count(),
        lines: pieces.iter().filter_map(|p| line(p, hidden)).collect(),
    }
}

fn line(piece: &Piece, hidden: Hidden) -> Option<Line> {
    let class = match (piece.class, hidden) {
        (Class::Hidden, Hidden::Off) => return None,
        (Class::Hidden, Hidden::Depth(most)) if piece.order <= most => Class::Visible,
        (Class::Hidden, Hidden::Depth(_)) => return None,
        (class, _) => class,
    };
    let path = Path::of(piece.from, Segment::Line { to: piece.to });
    Some(Line { class, kind: piece.kind, id: piece.id, order: piece.order, path })
}
