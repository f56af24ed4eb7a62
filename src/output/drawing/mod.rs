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
//! # The way of a scene
//!
//! 1. What is behind the eye is cut off (`frustum`).
//! 2. The scene is put on the picture's lattice, and faces and edges are told apart (`model`); faces of known round
//!    surfaces get their true contours and edges (`smooth`, `field`), and contours of surfaces known by their facets
//!    alone are traced over the normals of the facets' corners (`mesh_contour`).
//! 3. Each edge is given its order of invisibility: by body against body for convex polyhedra (`convex`), by Nishita's
//!    count over crossings with outlines (`count`), or by clipping against facets (`clip`). Debug builds hold the
//!    count against the clipping.
//! 4. Curves are fitted (`fit`), coincident lines merged (`merge`, `arcs`, `cover`), and lines joined to paths (`join`).
//!
//! Surfaces over a plane are drawn by their floating horizon ([`horizon_lines`]), curved grids by [`grid_lines`].
//!
//! # What holds
//!
//! - Which side of a line a point is on is decided exactly on the lattice, 2^-45 of the picture's size. A sight line that
//!   grazes a face passes to its left (see `lattice`); where lines coincide, the more important one is drawn.
//! - A face hides what is behind its plane by more than 2^-26 of the scene's size; what lies in it is not hidden.
//! - Back faces do not hide: an eye inside a solid sees out, an eye in a room sees the room.
//! - Lines of surfaces that are known by their facets alone are known no better than the bound, by which chords may be off: a
//!   quarter of the tolerance, by default a twentieth of the thinnest pen. Two of them that run along each other within twice
//!   the bound are one, drawn as the more important. A part of one that is hidden otherwise than what is around it, but is
//!   shorter than the bound, is a speck, and hidden as that is; a line shorter than the bound that joins no other is left out.
//!   No feature goes with them: the lines around one that is larger than the bound are longer, and joined. Edges between
//!   flat and round faces are exact, and drawn however short they are.
//! - A round face is drawn as its true surface when its facets are within the tolerance of it; where two such surfaces
//!   nearly touch, their facets decide which of them sticks out.
//!
//! # Paper
//! T. Nishita, hidden lines of sets of polyhedra by the order of invisibility (METHODS, section 3).
//!
//! # Departures
//! The count of a straight edge starts from a sight line of its own, not of its chain: finding it is one look into a
//! grid cell, and an edge can then be counted alone. Chains of chords along a curve are counted as one.

mod arcs;
mod camera;
mod cells;
mod chain;
mod clip;
mod conic;
mod convex;
mod count;
mod cover;
mod curved_grid;
mod curves;
#[allow(clippy::module_inception, reason = "the noun is the file's")]
mod drawing;
mod envelope;
mod field;
mod fit;
mod folded;
mod frustum;
mod horizon;
mod join;
mod lattice;
mod links;
mod meet;
mod merge;
mod mesh_contour;
mod model;
mod outline;
mod patches;
mod pieces;
mod round;
mod scene;
mod smooth;
mod span;
mod spline;
mod strips;
mod thread;

pub use crate::geom::{Hidden, Method, View};
pub use camera::{Camera, CameraError, Window};
pub use curved_grid::{grid_lines, grid_strokes, is_drawn_smooth};
pub use drawing::{Class, Drawing, Line, Path, Segment};
pub use horizon::{HeightField, HorizonError, horizon_lines};
pub use outline::true_outlines;
pub use round::Round;
pub use scene::{Body, Kind, Options, Scene, Stroke};

use rayon::prelude::*;

use arcs::ArcPiece;
use clip::Clipper;
use convex::Bodies;
use count::Counter;
use fit::{Fitted, Shape};
use join::Drawn;
use links::NONE;
use merge::{Mark, Nearness, Piece};
use model::{Edge, Model};
use span::Span;

/// Lines coincide on paper when they are nearer than this part of the picture's size: corners that set
/// operations rounded to 2^-29 of the size are a few times that apart.
const COINCIDENT: f64 = 1e-8;

/// Cubic curves are so much farther from the true curve than lines that coincide from each other: they only have to
/// look right and be as long, and each digit costs half as many pieces again.
const LOOSE: f64 = 100.0;

/// Straight lines of a body whose faces are not exact, and curves traced over facets, are drawn once if they are nearer than this part of what chords may
/// be off, or than curves that coincide: its walls are off by that where they are seen edge-on.
const ROUGH: f64 = 0.1;

/// Two lines that are known by facets alone stand for one if they are nearer than so many times what chords may be off: each
/// may be off by once that, and which of them is off is not known. So the turns of a thread, whose chords lie apart, are
/// one circle from above. A pen is wider than both, so no detail goes with them: what is left out lies under a line.
const APART: f64 = 2.0;

/// A line that is not so many times as long as coincident lines are apart is a dot: an edge seen end-on, or what rounding
/// leaves of a line beside the end of another.
const DOT: f64 = 200.0;

/// The lines of a scene that an eye sees, and those it would see but for what is in front.
///
/// Never fails: what is behind the eye or outside the window is left out, as are bodies and strokes with points that
/// are not finite or farther than 1e60 mm; a scene without lines gives a
/// drawing without lines. The same input gives the same drawing whatever the number of threads.
pub fn visible_lines(scene: &Scene, camera: &Camera, options: &Options) -> Drawing {
    let model = Model::new(scene, camera, options);
    let layered = matches!(options.hidden, Hidden::Depth(_));
    let (rough, speck) = (scene.rough(), model.speck());
    let mut sheet = Sheet { layered, rough, speck, bound: model.bound, ..Sheet::default() };
    hide(&model, options.method, &mut sheet);
    if let Some(window) = camera.window() {
        sheet.cut(&window);
    }
    sheet.assemble(model.picture_size() * COINCIDENT, options.hidden)
}

/// Lines before they are merged.
#[derive(Default)]
struct Sheet {
    /// Whether it counts how many faces a hidden part is behind; otherwise hidden parts are of order 1.
    layered: bool,
    straight: Vec<Piece>,
    arcs: Vec<ArcPiece>,
    curves: Vec<(Path, Mark)>,
    /// Curves that were traced over facets.
    traced: Vec<(Path, Mark)>,
    /// Numbers of bodies whose faces are not exact, in order.
    rough: Vec<u32>,
    /// How far chords may be off their curve, mm.
    bound: f64,
    /// What is shorter is a speck if chords may be off, mm.
    speck: f64,
}

/// Puts all edges on the sheet.
fn hide(model: &Model, method: Method, sheet: &mut Sheet) {
    let bodies_only = model.hulls.last().is_some_and(|h| h.edges.end == model.edges.len());
    let bodies_only = bodies_only && model.threads.is_empty();
    if method == Method::Auto && bodies_only && model.hulls.iter().all(|h| h.convex) {
        return hide_convex(model, sheet);
    }
    let clipper = Clipper::new(model);
    let (mut desk, counter) = (clipper.desk(), Counter::new(model, &clipper));
    let mut tally = counter.tally();
    for hull in &model.hulls {
        sheet.add_edges(model, hull.edges.clone(), |edge, out| {
            if method == Method::Clip || hull.reached {
                clipper.hide(edge, &mut desk, out);
            } else {
                counter.hide(edge, &mut tally, out);
                debug_assert!(agree(model, edge, out, |edge, out| {
                    clipper.hide(edge, &mut desk, out);
                }));
            }
        });
    }
    let strokes = model.hulls.last().map_or(0, |h| h.edges.end)..model.edges.len();
    let mut from = strokes.start;
    for bow in &model.bows {
        let Some(ellipse) = bow.ellipse(model) else { continue };
        let edges = bow.edges();
        sheet.add_edges(model, from..edges.start, |e, out| clipper.hide(e, &mut desk, out));
        let layered = sheet.layered;
        let hide = |edge: &Edge, out: &mut Vec<Span>| {
            clipper.hide(edge, &mut desk, out);
            if !layered {
                span::unite(out);
            }
        };
        bow.pieces(model, ellipse, hide, mark, &mut sheet.arcs);
        from = edges.end;
    }
    sheet.add_edges(model, from..strokes.end, |edge, out| clipper.hide(edge, &mut desk, out));
    hide_chains(model, &counter, sheet);
    hide_threads(model, &clipper, sheet);
}

/// Puts the edges of convex bodies on the sheet.
fn hide_convex(model: &Model, sheet: &mut Sheet) {
    let bodies = Bodies::new(model);
    let mut steps = vec![];
    for (number, hull) in model.hulls.iter().enumerate() {
        sheet.add_edges(model, hull.edges.clone(), |edge, out| {
            bodies.hide(number, edge, &mut steps, out);
        });
    }
}

/// Whether another method finds as much of an edge visible. Where a true surface stands in for facets, the methods
/// need not agree.
fn agree(
    model: &Model,
    edge: &Edge,
    spans: &[Span],
    other: impl FnOnce(&Edge, &mut Vec<Span>),
) -> bool {
    let visible = |spans: &[Span]| -> f64 {
        spans.iter().filter(|s| s.order == 0).map(|s| s.to - s.from).sum()
    };
    let mut found = vec![];
    other(edge, &mut found);
    let [p, q] = [edge.a, edge.b].map(|i| model.at[i as usize]);
    let gap = (visible(spans) - visible(&found)).abs() * p.distance(q);
    let curved = !model.fields.is_empty() || !model.threads.is_empty();
    curved || gap <= model.dust * DISPUTED
}

/// Two methods may differ by so many lengths of dust: where an edge lies in the plane of a face, one stops at the
/// corner and the other at the border.
const DISPUTED: f64 = 1e6;

/// Puts curved edges on the sheet.
fn hide_chains(model: &Model, counter: &Counter, sheet: &mut Sheet) {
    let tolerance = model.picture_size() * COINCIDENT;
    let chains = chain::chains(model);
    let drawn = chains.par_iter().map_init(
        || counter.tally(),
        |tally, chain| {
            let edge = &model.edges[chain[0].edge as usize];
            let fitted = Fitted::new(model, chain, tolerance);
            let mut shapes = vec![];
            for stretch in counter.hide_chain(chain, tally, sheet.layered) {
                let mark = mark(edge, stretch.order);
                fitted.shapes(&stretch, |shape| shapes.push((shape, mark)));
            }
            shapes
        },
    );
    let drawn: Vec<Vec<(Shape, Mark)>> = drawn.collect();
    drawn.into_iter().flatten().for_each(|(shape, mark)| sheet.add_shape(shape, mark));
}

/// Puts the lines of curved grids on the sheet.
fn hide_threads(model: &Model, clipper: &Clipper, sheet: &mut Sheet) {
    let tolerance = model.picture_size() * COINCIDENT;
    let drawn = model.threads.par_iter().map_init(
        || clipper.desk(),
        |desk, thread| {
            let mut shapes = vec![];
            thread.hide(model, clipper, desk, sheet.layered, tolerance, |order, shape| {
                let loose = thread.is_traced();
                shapes.push((shape, Mark { loose, ..mark_of(thread.kind, thread.id, order) }));
            });
            shapes
        },
    );
    let drawn: Vec<Vec<(Shape, Mark)>> = drawn.collect();
    for (thread, shapes) in model.threads.iter().zip(drawn) {
        for (shape, mark) in shapes {
            match shape {
                Shape::Curve(path) if thread.is_traced() => sheet.traced.push((path, mark)),
                shape => sheet.add_shape(shape, mark),
            }
        }
    }
}

/// How a part of an edge behind so many faces is drawn.
fn mark(edge: &Edge, order: u32) -> Mark {
    Mark { loose: edge.loose, ..mark_of(edge.kind, edge.id, order) }
}

/// How a part of a line behind so many faces is drawn.
fn mark_of(kind: Kind, id: u32, order: u32) -> Mark {
    let class = match kind {
        Kind::Cutting => Class::Cutting,
        Kind::Centre => Class::Centre,
        _ if order == 0 => Class::Visible,
        _ => Class::Hidden,
    };
    Mark { class, order, kind, id, loose: false }
}

impl Sheet {
    /// Adds the straight edges of a range, hidden by `hide`.
    fn add_edges(
        &mut self,
        model: &Model,
        range: std::ops::Range<usize>,
        mut hide: impl FnMut(&Edge, &mut Vec<Span>),
    ) {
        let mut spans = vec![];
        for number in range {
            let edge = &model.edges[number];
            if edge.curve == NONE && model.at[edge.a as usize] != model.at[edge.b as usize] {
                spans.clear();
                hide(edge, &mut spans);
                if !self.layered {
                    span::unite(&mut spans);
                }
                self.add_spans(model, number, &spans);
            }
        }
    }

    /// Adds the parts of a straight edge.
    fn add_spans(&mut self, model: &Model, number: usize, spans: &[Span]) {
        let edge = &model.edges[number];
        let [p, q] = [edge.a, edge.b].map(|i| model.at[i as usize]);
        let moved = model.moved.get(&number);
        let place = |t: f64| match moved {
            Some([p, q]) => p.lerp(*q, t),
            None => model.lattice.millimetres(p + (q - p) * t),
        };
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

    /// Cuts all lines off at the border of a window.
    fn cut(&mut self, window: &Window) {
        self.straight.retain_mut(|piece| window.cut(piece));
        for arc in std::mem::take(&mut self.arcs) {
            let at = |t: f64| arc.from + (arc.to - arc.from) * t;
            let parts = window.of_curve(|t| arc.ellipse.at(at(t)));
            let part = |(from, to)| ArcPiece { from: at(from), to: at(to), ..arc };
            self.arcs.extend(parts.into_iter().map(part));
        }
        for curves in [&mut self.curves, &mut self.traced] {
            for (path, mark) in std::mem::take(curves) {
                for (start, segment) in path.pieces() {
                    for (from, to) in window.of_curve(|t| segment.at(start, t)) {
                        let (start, segment) = segment.part(start, from, to);
                        curves.push((Path::of(start, segment), mark));
                    }
                }
            }
        }
    }

    /// Merges what coincides within `tolerance` mm, measures, and keeps what is wanted, joined to paths.
    fn assemble(mut self, tolerance: f64, hidden: Hidden) -> Drawing {
        let loose = tolerance * LOOSE;
        let rough = loose.max(self.bound * ROUGH);
        let near = Nearness { tolerance, loose: rough, rough: self.rough };
        let straight = merge::merged(&self.straight, &near)
            .into_iter()
            .map(|p| (Path::of(p.from, Segment::Line { to: p.to }), p.mark));
        let curves = arcs::adopted(self.curves, &mut self.arcs, loose);
        let arcs = arcs::merged(&self.arcs, tolerance).into_iter().map(|a| {
            let conic::Ellipse { center, major, minor } = a.ellipse;
            let arc = Segment::Arc { center, major, minor, from: a.from, to: a.to };
            (Path::of(a.ellipse.at(a.from), arc), a.mark)
        });
        let drawn = straight.chain(arcs).chain(curves::merged(curves, loose));
        let (edges, mut all): (Vec<Drawn>, Vec<Drawn>) = drawn.partition(|(_, mark)| mark.loose);
        let ends = (tolerance / 8.0).max(f64::MIN_POSITIVE);
        let dot = tolerance * DOT;
        let speck = self.speck.max(dot);
        let edges = join::joined(edges, ends);
        let edges = edges.into_iter().map(|line| (line, rough.max(self.bound * APART)));
        let loose = edges.chain(self.traced.into_iter().map(|line| (line, rough)));
        all.extend(cover::uncovered(loose.collect(), &all));
        let length = |class: Class| {
            let of = all.iter().filter(|(_, mark)| mark.class == class);
            of.map(|(path, _)| path.length()).sum::<f64>()
        };
        let counted = all.iter().filter(|(_, mark)| mark.class <= Class::Hidden);
        Drawing {
            visible: length(Class::Visible),
            hidden: length(Class::Hidden),
            segments: counted.map(|(path, _)| path.segments.len()).sum(),
            lines: join::joined(all, ends)
                .into_iter()
                .filter(|(path, mark)| path.length() > if mark.loose { speck } else { dot })
                .filter_map(|(path, mark)| line(path, mark, hidden))
                .collect(),
        }
    }
}

/// The line that is drawn, if it is wanted.
fn line(path: Path, mark: Mark, hidden: Hidden) -> Option<Line> {
    let class = match (mark.class, hidden) {
        (Class::Hidden, Hidden::Off) => return None,
        (Class::Hidden, Hidden::Depth(most)) if mark.order <= most => Class::Visible,
        (Class::Hidden, Hidden::Depth(_)) => return None,
        (class, _) => class,
    };
    Some(Line { class, kind: mark.kind, id: mark.id, order: mark.order, path })
}
