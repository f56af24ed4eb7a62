//! The offset surface before it is freed of its crossings: faces moved, edges bridged, points capped.

use std::{f64::consts::TAU, sync::Arc};

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::{
    figure::{Figure, Measure, Surroundings, span},
    rings::{Corner, Rings},
};
use crate::geom::{Origin, PolyMesh, Surface, triangulate::triangulate_face};

/// Points of a face that are farther than this from its plane, relative to the coordinates, are not of it.
const FLAT: f64 = 1e-12;

/// A flat face stands across a cylinder if the sine of the angle between its normal and the axis is below this, some
/// digits more than rounding takes.
const ACROSS: f64 = 1e-9;

/// Open points that are worked with: their pieces may all overlap, which takes time that grows with the square
/// of their number.
pub(super) const CROWD: usize = 300;

/// Points of one surface: about a gigabyte while it is made.
pub(super) const CORNERS: usize = 4_000_000;

/// Chords of a full turn; a cap has about a tenth of their square.
const CHORDS: f64 = 4000.0;

/// What there would be too many of.
pub(super) enum TooMany {
    /// Points of the surface, and about how many it would have.
    Corners(f64),
    /// Points to be opened.
    Turned,
}

/// The surface and what is known of it.
pub(super) struct Raw {
    pub mesh: PolyMesh,
    /// Whether figures are open, so that it may cross itself next to them.
    pub folded: bool,
}

/// The surface at a distance outwards from a closed mesh.
///
/// It is the boundary of pieces that are added up: the solid, what each face sweeps over, and what lies around
/// convex edges and points. All of them count once, so that the surface winds around what is in any of them.
/// Where a face or a strip would be turned over, and count against the others, its points are opened.
///
/// Refused are more than [`CORNERS`] points, and more than the crowd that may be opened.
pub(super) fn raw(mesh: &PolyMesh, measure: Measure) -> Result<Raw, TooMany> {
    let rings = Rings::of(mesh, measure.curved);
    let mut open = vec![false; mesh.points.len()];
    loop {
        let mut builder = Builder::new(mesh, &rings, measure, &open);
        builder.points()?;
        builder.weld();
        builder.faces();
        builder.edges();
        let Builder { mut out, folded, turned, .. } = builder;
        let before = open.clone();
        turned.iter().for_each(|&point| open[point as usize] = true);
        if open == before {
            out.drop_unused_points();
            return Ok(Raw { mesh: out, folded });
        }
        if open.iter().filter(|open| **open).count() > measure.crowd {
            return Err(TooMany::Turned);
        }
    }
}

/// Points closer than this, relative to the radius and their coordinates, are one where they should be.
const TOGETHER: f64 = 1e-9;

/// Whether corners of a triangle are the same.
fn is_point([a, b, c]: &[u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// The first of the points that a point fell together with.
fn first_of(welded: &[u32], mut i: u32) -> u32 {
    while welded[i as usize] != i {
        i = welded[i as usize];
    }
    i
}

struct Builder<'a> {
    mesh: &'a PolyMesh,
    rings: &'a Rings,
    measure: Measure,
    out: PolyMesh,
    /// For each corner the points it becomes, and those along the edge behind it.
    corners: Vec<Vec<u32>>,
    chains: Vec<Vec<u32>>,
    /// Origins by what they stand for.
    origins: FxHashMap<Source, u32>,
    /// Points to be opened, and those that something turned over touches.
    open: &'a [bool],
    turned: Vec<u32>,
    folded: bool,
    /// Triangles of caps and their origins.
    caps: Vec<([u32; 3], u32)>,
    /// For each point made the first one that it fell together with.
    welded: Vec<u32>,
}

/// What an origin of the offset stands for.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Source {
    Face(u32),
    Edge(u32, u32),
    /// A rim of many edges between faces of two origins.
    Rim(u32, u32),
    /// A rim about a circle, where a flat face, given by its plane, ends in a cylinder, given by its origin.
    Ring(u32, u32),
    Point(u32),
}

impl<'a> Builder<'a> {
    fn new(
        mesh: &'a PolyMesh,
        rings: &'a Rings,
        measure: Measure,
        open: &'a [bool],
    ) -> Builder<'a> {
        let count = rings.corners.len();
        Builder {
            mesh,
            rings,
            measure,
            out: PolyMesh::default(),
            corners: vec![vec![]; count],
            chains: vec![vec![]; count],
            origins: FxHashMap::default(),
            open,
            turned: vec![],
            folded: false,
            caps: vec![],
            welded: vec![],
        }
    }

    fn points(&mut self) -> Result<(), TooMany> {
        let turn = TAU / span(self.measure.chord);
        if turn > CHORDS {
            return Err(TooMany::Corners(CORNERS as f64 * (turn / CHORDS).powi(2)));
        }
        let all = self.mesh.points.len();
        for point in 0..all as u32 {
            let fan = &self.rings.around[point as usize];
            if fan.is_empty() {
                continue;
            }
            let around = Surroundings::of(self.rings, &self.mesh.points, point, self.measure);
            let figure = around.figure(self.measure, self.open[point as usize]);
            self.place(point, &figure);
            let made = self.out.points.len();
            if made > CORNERS {
                return Err(TooMany::Corners(made as f64 * all as f64 / f64::from(point + 1)));
            }
        }
        Ok(())
    }

    /// Makes points one that the ends of an edge have become, where the surface moves onto its own centres.
    fn weld(&mut self) {
        let mut welded: Vec<u32> = (0..self.out.points.len() as u32).collect();
        if self.measure.curved {
            self.join_ends(&mut welded);
        }
        // What fell together may have left a sheet without volume.
        self.folded |= welded.iter().zip(0..).any(|(first, i)| *first != i);
        let lists = self.corners.iter_mut().chain(&mut self.chains);
        lists.flatten().for_each(|i| *i = welded[*i as usize]);
        self.welded = welded;
    }

    fn join_ends(&self, welded: &mut [u32]) {
        for fan in &self.rings.around {
            for &corner in fan {
                let Corner { point, before, .. } = self.rings.corners[corner as usize];
                let far = &self.chains[self.rings.end(point, before) as usize];
                let near = self.chains[corner as usize].iter().rev();
                for (&a, &b) in near.zip(far).filter(|&(&a, &b)| self.falls_together(a, b)) {
                    let (a, b) = (first_of(welded, a), first_of(welded, b));
                    welded[a.max(b) as usize] = a.min(b);
                }
            }
        }
        for i in 0..welded.len() as u32 {
            welded[i as usize] = first_of(welded, i);
        }
    }

    fn falls_together(&self, a: u32, b: u32) -> bool {
        let [p, q] = [a, b].map(|i| self.out.points[i as usize]);
        p.distance(q) <= TOGETHER * (self.measure.radius + p.abs().max_element())
    }

    /// Puts the figure of a point in its place.
    fn place(&mut self, point: u32, figure: &Figure) {
        let (at, first) = (self.mesh.points[point as usize], self.out.points.len() as u32);
        self.out.points.extend(figure.points.iter().map(|p| at + *p * self.measure.radius));
        self.folded |= figure.open;
        let fan = &self.rings.around[point as usize];
        let moved = |list: &Vec<u32>| list.iter().map(|i| i + first).collect::<Vec<u32>>();
        for (k, &corner) in fan.iter().enumerate() {
            self.corners[corner as usize] = moved(&figure.corners[k]);
            self.chains[corner as usize] = moved(&figure.chains[k]);
        }
        if figure.cap.is_empty() {
            return;
        }
        let faces: Vec<u32> = fan.iter().map(|&c| self.rings.corners[c as usize].face).collect();
        let round = Surface::Sphere { center: at, radius: self.measure.radius };
        let surface = if figure.open { Surface::Smooth } else { round };
        let origin = self.origin(Source::Point(point), surface, &faces);
        for triangle in &figure.cap {
            self.caps.push((triangle.map(|i| i + first), origin));
        }
    }

    fn faces(&mut self) {
        for (triangle, origin) in std::mem::take(&mut self.caps) {
            self.push(&triangle.map(|i| self.welded[i as usize]), origin);
        }
        let mut corner = 0;
        for face in self.mesh.faces() {
            let index = face.index() as u32;
            let mut loops: Vec<Vec<u32>> = vec![];
            for ring in face.loops() {
                loops.push((corner..corner + ring.len() as u32).collect());
                corner += ring.len() as u32;
            }
            let surface = self.grown(index);
            let source = Source::Face(face.origin_index());
            let origin = self.origin(source, surface, &[index]);
            self.face(index, &loops, origin);
        }
    }

    /// One face: a polygon if it is still flat and nowhere turned over, else its triangles.
    fn face(&mut self, face: u32, loops: &[Vec<u32>], origin: u32) {
        let mut triangles = vec![];
        let source: Vec<&[u32]> = self.mesh.face(face as usize).loops().collect();
        triangulate_face(&self.mesh.points, &source, &mut triangles);
        let normal = self.rings.normals[face as usize];
        let number: FxHashMap<u32, u32> =
            loops.iter().flatten().map(|&c| (self.point_of(c), c)).collect();
        let first = |c: u32| self.corners[number[&c] as usize][0];
        let mut moved: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(first)).collect();
        for &corner in loops.iter().flatten() {
            self.spread(corner, loops, &mut moved);
        }
        let points = &self.out.points;
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| points[i as usize]);
            (b - a).cross(c - a).dot(normal)
        };
        let upright = moved.iter().all(|t| is_point(t) || area(t) > 0.0);
        let outline: Vec<Vec<u32>> =
            loops.iter().map(|l| self.outline(l)).filter(|l| l.len() > 2).collect();
        if outline.is_empty() {
            return;
        }
        let base = points[outline[0][0] as usize];
        let reach = base.abs().max_element() + self.measure.radius;
        let off = |&i: &u32| (points[i as usize] - base).dot(normal).abs();
        let flat = outline.iter().flatten().all(|i| off(i) <= FLAT * reach.max(1.0) * 16.0);
        if !upright {
            let corners = loops.iter().flatten();
            self.turned.extend(corners.map(|&c| self.rings.corners[c as usize].point));
        }
        if upright && flat {
            let plane = self.out.add_plane();
            self.out.push_face(&outline, plane, origin);
        } else {
            moved.iter().for_each(|t| self.push(t, origin));
        }
    }

    fn point_of(&self, corner: u32) -> u32 {
        self.rings.corners[corner as usize].point
    }

    /// The points that the corners of a loop become, each once where they fell together.
    fn outline(&self, corners: &[u32]) -> Vec<u32> {
        let points = corners.iter().flat_map(|&c| self.corners[c as usize].iter().copied());
        let mut points: Vec<u32> = points.collect();
        points.dedup();
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        points
    }

    /// Triangles where a corner became several points.
    fn spread(&self, corner: u32, loops: &[Vec<u32>], out: &mut Vec<[u32; 3]>) {
        let list = &self.corners[corner as usize];
        let [first, .., last] = list[..] else { return };
        out.extend(list.windows(2).skip(1).map(|w| [first, w[0], w[1]]));
        let ring = loops.iter().find(|l| l.contains(&corner)).expect("its loop");
        let place = ring.iter().position(|&c| c == corner).expect("in its loop");
        let next = self.corners[ring[(place + 1) % ring.len()] as usize][0];
        out.push([first, last, next]);
    }

    fn edges(&mut self) {
        for v in 0..self.mesh.points.len() as u32 {
            for k in 0..self.rings.around[v as usize].len() {
                let fan = &self.rings.around[v as usize];
                let (right, left) = (fan[k], fan[(k + 1) % fan.len()]);
                let w = self.rings.corners[right as usize].before;
                if v < w {
                    self.edge([v, w], right, left);
                }
            }
        }
    }

    /// Bridges the edge from v to w between the faces of two corners at v.
    fn edge(&mut self, [v, w]: [u32; 2], right: u32, left: u32) {
        let end = self.rings.end(v, w);
        let near: Vec<u32> = self.chains[right as usize].iter().rev().copied().collect();
        let far = self.chains[end as usize].clone();
        if near.len() == 1 && far.len() == 1 {
            return;
        }
        let faces = [left, right].map(|c| self.rings.corners[c as usize].face);
        let [a, b] = [v, w].map(|i| self.mesh.points[i as usize]);
        let axis = (b - a).normalize_or_zero();
        let round = [&near, &far].iter().all(|chain| {
            let square = |i: &&u32| {
                let off = self.out.points[**i as usize] - a;
                axis.cross(off).length()
            };
            chain.iter().all(|i| {
                (square(&i) - self.measure.radius).abs() <= self.measure.chord * self.measure.radius
            })
        });
        let [l, r] = faces.map(|f| self.mesh.face(f as usize).origin_index());
        let own = faces.map(|f| self.mesh.face(f as usize).origin().surface);
        let (source, surface) = if round && own == [Surface::Plane; 2] {
            let radius = self.measure.radius;
            (Source::Edge(v, w), Surface::Cylinder { point: a, axis, radius })
        } else if let Some(ring) = self.ring(faces, a) {
            ring
        } else {
            (Source::Rim(l.min(r), l.max(r)), Surface::Smooth)
        };
        let origin = self.origin(source, surface, &faces);
        if !self.strip(&near, &far, axis, origin) {
            self.turned.extend([v, w]);
        }
    }

    /// The torus about the circle where a flat face ends in a cylinder across it, through a point of that.
    fn ring(&self, faces: [u32; 2], on: DVec3) -> Option<(Source, Surface)> {
        let flat = |f: u32| self.mesh.face(f as usize).origin().surface == Surface::Plane;
        let [plane, curved] = if flat(faces[0]) { faces } else { [faces[1], faces[0]] };
        let wall = self.mesh.face(curved as usize);
        let Surface::Cylinder { point, axis, .. } = wall.origin().surface else { return None };
        let lean = self.rings.normals[plane as usize].cross(axis).length();
        if !flat(plane) || lean > ACROSS {
            return None;
        }
        let center = point + axis * (on - point).dot(axis);
        let (major, minor) = (on.distance(center), self.measure.radius);
        let source = Source::Ring(self.mesh.face(plane as usize).plane(), wall.origin_index());
        Some((source, Surface::Torus { center, axis, major, minor }))
    }

    /// Quadrilaterals and triangles between two chains from the left face to the right one. Whether all of
    /// them run along the edge.
    fn strip(&mut self, near: &[u32], far: &[u32], axis: DVec3, origin: u32) -> bool {
        let (n, m) = (near.len() - 1, far.len() - 1);
        let (mut i, mut j, mut along) = (0, 0, true);
        loop {
            let [from, to] = [near[i], far[j]].map(|p| self.out.points[p as usize]);
            along &= near[i] == far[j] || (to - from).dot(axis) > 0.0;
            // Steps of both chains go side by side.
            let (next_near, next_far) = ((i + 1) * m, (j + 1) * n);
            if i == n && j == m {
                return along;
            }
            if i < n && j < m && next_near == next_far {
                self.quad([far[j], near[i], near[i + 1], far[j + 1]], origin);
                (i, j) = (i + 1, j + 1);
            } else if j >= m || (i < n && next_near < next_far) {
                self.push(&[far[j], near[i], near[i + 1]], origin);
                i += 1;
            } else {
                self.push(&[far[j], near[i], far[j + 1]], origin);
                j += 1;
            }
        }
    }

    /// A quadrilateral, as one face if it is flat.
    fn quad(&mut self, corners: [u32; 4], origin: u32) {
        if (0..4).any(|k| corners[k] == corners[(k + 1) % 4]) {
            let [a, b, c, d] = corners;
            self.push(&[a, b, c], origin);
            return self.push(&[a, c, d], origin);
        }
        let [a, b, c, d] = corners.map(|i| self.out.points[i as usize]);
        let normal = (c - a).cross(d - b);
        let reach = [a, b, c, d].iter().fold(1.0f64, |m, p| m.max(p.abs().max_element()));
        let flat = (b - a).dot(normal).abs() <= 16.0 * FLAT * reach * normal.length();
        let turned = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).dot(normal) > 0.0;
        let convex = turned(a, b, c) && turned(b, c, d) && turned(c, d, a) && turned(d, a, b);
        if flat && convex {
            let plane = self.out.add_plane();
            return self.out.push_face(&[corners], plane, origin);
        }
        let [a, b, c, d] = corners;
        self.push(&[a, b, c], origin);
        self.push(&[a, c, d], origin);
    }

    /// A triangle, unless corners of it fell together.
    fn push(&mut self, triangle: &[u32; 3], origin: u32) {
        if is_point(triangle) {
            return;
        }
        let plane = self.out.add_plane();
        self.out.push_face(&[*triangle], plane, origin);
    }

    /// The number of an origin with the tags and the colour of some faces.
    fn origin(&mut self, source: Source, surface: Surface, faces: &[u32]) -> u32 {
        if let Some(&known) = self.origins.get(&source) {
            return known;
        }
        let parents = || faces.iter().map(|&f| self.mesh.face(f as usize).origin());
        let mut tags: Vec<Arc<str>> = vec![];
        for tag in parents().flat_map(|o| &o.tags) {
            if !tags.contains(tag) {
                tags.push(tag.clone());
            }
        }
        let color = parents().find_map(|o| o.color);
        let number = self.out.add_origin(Origin { surface, form: None, tags, color });
        self.origins.insert(source, number);
        number
    }

    /// The surface of a face, moved outwards with it.
    fn grown(&self, face: u32) -> Surface {
        let on = self.mesh.face(face as usize);
        let at = self.mesh.points[on.outer()[0] as usize];
        grown(on.origin().surface, at, self.rings.normals[face as usize], self.measure.radius)
    }
}

/// A surface moved by `r` towards the side to which its facet at a point faces.
fn grown(surface: Surface, at: DVec3, normal: DVec3, r: f64) -> Surface {
    let away = |from: DVec3| if (at - from).dot(normal) >= 0.0 { r } else { -r };
    let positive = |radius: f64, make: &dyn Fn(f64) -> Surface| {
        if radius > 0.0 { make(radius) } else { Surface::Smooth }
    };
    match surface {
        Surface::Plane | Surface::Smooth | Surface::Facets => surface,
        Surface::Sphere { center, radius } => {
            positive(radius + away(center), &|radius| Surface::Sphere { center, radius })
        }
        Surface::Cylinder { point, axis, radius } => {
            let foot = point + axis * (at - point).dot(axis);
            positive(radius + away(foot), &|radius| Surface::Cylinder { point, axis, radius })
        }
        Surface::Torus { center, axis, major, minor } => {
            let out = (at - center).reject_from_normalized(axis).normalize_or_zero();
            let tube = away(center + out * major);
            positive(minor + tube, &|minor| Surface::Torus { center, axis, major, minor })
        }
        Surface::Cone { apex, axis, slope } => {
            let foot = apex + axis * (at - apex).dot(axis);
            let apex = apex - axis * (away(foot) * (1.0 + slope * slope).sqrt() / slope);
            Surface::Cone { apex, axis, slope }
        }
    }
}
