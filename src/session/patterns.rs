//! Figures drawn on faces: laid on their face, moved with the solid, and cut off where the face ends.

use std::fmt;

use glam::{DVec2, DVec3};

use super::{
    outline::{Outline, Tracer},
    wrapped::Wrapped,
};
use crate::{
    base::{Code, Diagnostic},
    geom::{
        Placement, PolyMesh, Surface,
        development::{Development, directions},
        nearest::on_triangle,
        triangulate::triangulate,
    },
    output::drawing::{Kind, Stroke},
    shape::{
        Node, ShapeGraph, ShapeId,
        drawing::{FaceSpec, FiguresSpec},
    },
};

/// Faces are in one plane when they are no farther from it than this part of the size: what set operations round is less.
const CONTACT: f64 = 1e-7;

/// Normals are parallel when the cosine of the angle between them is at least this.
const PARALLEL: f64 = 1.0 - 1e-12;

/// Calls of `draw_on` that one view shows, copies of a solid counted each.
const MOST_FIGURES: usize = 10_000;

/// What figures are laid on, in the solid's own frame.
enum Ground {
    Flat(Frame),
    Round(Surface, Development),
}

/// A plane with directions in it.
struct Frame {
    origin: DVec3,
    right: DVec3,
    up: DVec3,
}

impl Frame {
    /// The frame as the placement of the xy plane.
    fn placement(&self) -> Placement {
        let normal = self.right.cross(self.up);
        Placement::new(glam::DMat3::from_cols(self.right, self.up, normal), self.origin)
    }
}

/// The figures on all shapes of a view, whose meshes are given in the same order.
pub fn all(
    tracer: &Tracer,
    shapes: &[ShapeId],
    meshes: &[&PolyMesh],
) -> Result<Vec<Stroke>, Diagnostic> {
    let figured = figured(tracer.graph);
    let mut strokes = vec![];
    for ((&shape, mesh), id) in shapes.iter().zip(meshes).zip(0..) {
        for (figures, child, placement) in found(tracer.graph, &figured, shape)? {
            let lines = lines(tracer, figures)?;
            let mut add = |points, drawn, round| {
                strokes.push(Stroke { points, kind: Kind::Pattern, id, round, drawn });
            };
            match ground(tracer, figures, child)? {
                Ground::Flat(frame) => {
                    let onto = placement.after(&frame.placement());
                    let area = Area::new(mesh, &onto);
                    for line in lines.iter().map(|line| line.placed(&onto)) {
                        let parts = area.parts(&line).into_iter();
                        parts.for_each(|part| add(part, vec![], line.round));
                    }
                }
                Ground::Round(surface, sheet) => {
                    let wrapped = Wrapped::new(&sheet, surface, placement, mesh)
                        .ok_or_else(|| stretched(figures))?;
                    let parts = lines.iter().flat_map(|line| wrapped.parts(line));
                    parts.for_each(|(facets, surface)| add(facets, surface, None));
                }
            }
        }
    }
    Ok(strokes)
}

/// For each node whether figures are drawn on something in it.
fn figured(graph: &ShapeGraph) -> Vec<bool> {
    let mut known: Vec<bool> = Vec::with_capacity(graph.len());
    for id in 0..graph.len() as u32 {
        let node = graph.node(ShapeId(id));
        let here = matches!(node, Node::Figured { .. });
        let within = node.children().iter().any(|child| known[child.0 as usize]);
        known.push(here || within);
    }
    known
}

/// The figures on a shape, the solids they are drawn on, and where these stand in it.
fn found<'a>(
    graph: &'a ShapeGraph,
    figured: &[bool],
    shape: ShapeId,
) -> Result<Vec<(&'a FiguresSpec, ShapeId, Placement)>, Diagnostic> {
    let mut found = vec![];
    let mut open = vec![(shape, Placement::IDENTITY)];
    while let Some((id, outer)) = open.pop() {
        if !figured[id.0 as usize] {
            continue;
        }
        match graph.node(id) {
            Node::Figured { figures, child } => {
                found.push((&**figures, *child, outer));
                open.push((*child, outer));
            }
            Node::Transform { placement, child } => open.push((*child, outer.after(placement))),
            Node::Tag { child, .. } | Node::Paint { child, .. } => open.push((*child, outer)),
            Node::Union(list) | Node::Intersection(list) => {
                open.extend(list.iter().rev().map(|&child| (child, outer)));
            }
            Node::Difference(list) => open.extend(list.first().map(|&child| (child, outer))),
            _ => {}
        }
        if found.len() > MOST_FIGURES {
            let words = format!("the view shows more than {MOST_FIGURES} drawings on faces");
            return Err(Diagnostic::error(Code::Limit, words).label(graph.origin(shape), ""));
        }
    }
    Ok(found)
}

/// The lines of figures in the plane of their face.
fn lines(tracer: &Tracer, figures: &FiguresSpec) -> Result<Vec<Outline>, Diagnostic> {
    let mut lines = vec![];
    for &profile in &figures.profiles {
        lines.extend(tracer.profile(profile)?);
    }
    for curve in &figures.curves {
        lines.extend(tracer.curve(curve)?);
    }
    let off = lines.iter().flat_map(|line| &line.points).find(|p| p.z.abs() > CONTACT);
    match off {
        Some(p) => {
            let words = format!(
                "figures on a face lie in the xy plane; this one has a point at z = {} mm",
                p.z
            );
            Err(Diagnostic::error(Code::OutOfRange, words).label(figures.place.0, ""))
        }
        None => Ok(lines),
    }
}

/// The error for a round face that is stretched after figures were drawn on it.
fn stretched(figures: &FiguresSpec) -> Diagnostic {
    let words = "figures on a round face cannot be stretched with it";
    Diagnostic::error(Code::WrongKind, words)
        .label(figures.place.0, "")
        .help("scale the solid first and draw on it then, or scale all axes alike")
}

/// The face that figures are drawn on, in the solid's own frame.
fn ground(tracer: &Tracer, figures: &FiguresSpec, child: ShapeId) -> Result<Ground, Diagnostic> {
    let solid = tracer.realizer.solid(tracer.graph, child).map_err(|error| *error.diagnostic)?;
    let mesh = solid.polyhedron.mesh();
    match figures.face {
        FaceSpec::Near(at) => near(mesh, at).ok_or_else(|| missing(figures)),
        _ => frame(mesh, figures).map(Ground::Flat),
    }
}

/// The face nearest to a point, its origin there.
fn near(mesh: &PolyMesh, at: DVec3) -> Option<Ground> {
    let triangles = triangulate(mesh);
    let found =
        triangles.corners.iter().zip(&triangles.face).map(|(corners, face)| {
            (on_triangle(corners.map(|c| mesh.points[c as usize]), at), *face)
        });
    let (on, face) =
        found.min_by(|a, b| a.0.distance_squared(at).total_cmp(&b.0.distance_squared(at)))?;
    let face = mesh.face(face as usize);
    let (normal, surface) = (face.area_vector().try_normalize()?, face.origin().surface);
    Some(match Development::new(surface, on, normal) {
        Some(sheet) => Ground::Round(surface, sheet),
        None => {
            let (right, up) = directions(normal);
            Ground::Flat(Frame { origin: on, right, up })
        }
    })
}

/// The error for a face that is not there.
fn missing(figures: &FiguresSpec) -> Diagnostic {
    let words = format!("the solid has no flat face {}", figures.face);
    Diagnostic::error(Code::WrongKind, words)
        .label(figures.place.0, "")
        .help("name a side such as TOP, a tag, { at = point, normal = side }, or { at = point }")
}

/// The frame of a flat face, its origin in the middle.
fn frame(mesh: &PolyMesh, figures: &FiguresSpec) -> Result<Frame, Diagnostic> {
    let Some((normal, on)) = face(mesh, &figures.face) else {
        return Err(missing(figures));
    };
    let (right, up) = directions(normal);
    let plane = Plane { normal, on, slack: CONTACT * size(mesh) };
    let corners = plane.faces(mesh).flat_map(|face| face.loops().flatten());
    let places = corners.map(|&corner| {
        let v = mesh.points[corner as usize] - on;
        DVec2::new(right.dot(v), up.dot(v))
    });
    let (min, max) =
        places.fold((DVec2::MAX, DVec2::MIN), |(min, max), p: DVec2| (min.min(p), max.max(p)));
    let middle = (min + max) / 2.0;
    Ok(Frame { origin: on + right * middle.x + up * middle.y, right, up })
}

fn size(mesh: &PolyMesh) -> f64 {
    mesh.points.iter().fold(0.0, |size: f64, p| size.max(p.abs().max_element()))
}

/// The outward normal of a face and a point of it.
fn face(mesh: &PolyMesh, wanted: &FaceSpec) -> Option<(DVec3, DVec3)> {
    let flat = mesh.faces().filter_map(|face| {
        let vector = face.area_vector();
        let normal = vector.try_normalize()?;
        let surface = face.origin().surface;
        let flat = matches!(surface, Surface::Plane | Surface::Facets);
        flat.then(|| (face, normal, vector.length(), mesh.points[face.outer()[0] as usize]))
    });
    let slack = CONTACT * size(mesh);
    let best = match wanted {
        FaceSpec::Side(side) => {
            let towards = side.direction();
            flat.filter(|f| f.1.dot(towards) >= PARALLEL)
                .max_by(|a, b| a.3.dot(towards).total_cmp(&b.3.dot(towards)))
        }
        FaceSpec::Tag(tag) => {
            flat.filter(|f| f.0.origin().tags.contains(tag)).max_by(|a, b| a.2.total_cmp(&b.2))
        }
        FaceSpec::Plane { at, normal } => {
            let towards = normal.normalize();
            flat.filter(|f| f.1.dot(towards) >= PARALLEL)
                .find(|f| towards.dot(f.3 - *at).abs() <= slack)
        }
        FaceSpec::Near(_) => None,
    };
    best.map(|(_, normal, _, on)| (normal, on))
}

impl fmt::Display for FaceSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FaceSpec::Side(side) => write!(f, "towards {}", format!("{side:?}").to_uppercase()),
            FaceSpec::Tag(tag) => write!(f, "with the tag \"{tag}\""),
            FaceSpec::Plane { .. } => write!(f, "in this plane"),
            FaceSpec::Near(_) => write!(f, "near this point"),
        }
    }
}

/// A plane, and how far faces may be from it.
struct Plane {
    normal: DVec3,
    on: DVec3,
    slack: f64,
}

impl Plane {
    /// The faces that lie in it and face the same way.
    fn faces<'a>(
        &'a self,
        mesh: &'a PolyMesh,
    ) -> impl Iterator<Item = crate::geom::FaceRef<'a>> + 'a {
        let near = |p: DVec3| self.normal.dot(p - self.on).abs() <= self.slack;
        mesh.faces().filter(move |face| {
            face.area_vector().normalize_or_zero().dot(self.normal) >= PARALLEL - self.slack
                && face.outer().iter().all(|&corner| near(mesh.points[corner as usize]))
        })
    }
}

/// The faces of a solid in one plane, in coordinates of the plane.
struct Area {
    frame: Frame,
    edges: Vec<[DVec2; 2]>,
}

impl Area {
    /// What of a mesh lies in the plane that a placement takes the xy plane to.
    fn new(mesh: &PolyMesh, onto: &Placement) -> Area {
        let [x, y] = [DVec3::X, DVec3::Y].map(|v| onto.vector(v).normalize_or_zero());
        let turned = if onto.mirrors() { -1.0 } else { 1.0 };
        let normal = x.cross(y).normalize_or_zero() * turned;
        let (right, up) = directions(normal);
        let frame = Frame { origin: onto.offset(), right, up };
        let plane = Plane { normal, on: frame.origin, slack: CONTACT * size(mesh) };
        let mut edges = vec![];
        for face in plane.faces(mesh) {
            for corners in face.loops() {
                let before = corners[corners.len() - 1];
                corners.iter().fold(before, |before, &corner| {
                    let ends = [before, corner].map(|c| frame.place(mesh.points[c as usize]));
                    edges.push(ends);
                    corner
                });
            }
        }
        Area { frame, edges }
    }

    /// The parts of a line that are on the faces.
    fn parts(&self, line: &Outline) -> Vec<Vec<DVec3>> {
        let mut parts: Vec<Vec<DVec3>> = vec![];
        let mut open = false;
        for ends in line.points.windows(2) {
            let mut at = 0.0;
            for cut in self.cuts(ends).into_iter().chain([1.0]) {
                let (from, to) = (ends[0].lerp(ends[1], at), ends[0].lerp(ends[1], cut));
                if cut <= at {
                    continue;
                }
                let inside = self.holds(self.frame.place((from + to) / 2.0));
                match parts.last_mut().filter(|_| open && inside) {
                    Some(part) => part.push(to),
                    None if inside => parts.push(vec![from, to]),
                    None => {}
                }
                (open, at) = (inside, cut);
            }
        }
        parts
    }

    /// Where a segment crosses the borders of the faces, in order.
    fn cuts(&self, ends: &[DVec3]) -> Vec<f64> {
        let [p, q] = [ends[0], ends[1]].map(|p| self.frame.place(p));
        let along = q - p;
        let crossing = |&[a, b]: &[DVec2; 2]| {
            let (s, t) = (along.perp_dot(a - p), along.perp_dot(b - p));
            let at = a.lerp(b, s / (s - t)) - p;
            ((s > 0.0) != (t > 0.0)).then(|| at.dot(along) / along.length_squared())
        };
        let mut cuts: Vec<f64> = self.edges.iter().filter_map(crossing).collect();
        cuts.retain(|t| *t > 0.0 && *t < 1.0);
        cuts.sort_by(f64::total_cmp);
        cuts
    }

    /// Whether a place is on the faces.
    fn holds(&self, p: DVec2) -> bool {
        let mut inside = false;
        for [a, b] in &self.edges {
            if (a.y > p.y) != (b.y > p.y) {
                let x = a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y));
                inside ^= x > p.x;
            }
        }
        inside
    }
}

impl Frame {
    /// A point in the coordinates of the plane.
    fn place(&self, p: DVec3) -> DVec2 {
        let v = p - self.origin;
        DVec2::new(self.right.dot(v), self.up.dot(v))
    }
}
