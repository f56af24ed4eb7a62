//! The boundary of a solid, made ready for many questions.

use glam::DVec3;

use crate::{
    geom::{
        Bounds,
        bvh::Bvh,
        nearest::{of_segments, on_triangle},
        orient::orient3d,
        parity::is_below,
        triangulate::triangulate,
    },
    kernel::brep::Polyhedron,
};

/// The triangles of a solid's boundary in a hierarchy of boxes.
#[derive(Clone, Debug)]
pub struct Boundary {
    triangles: Vec<[DVec3; 3]>,
    tree: Bvh,
}

impl Boundary {
    /// The boundary of a solid that is not empty.
    pub fn new(solid: &Polyhedron) -> Boundary {
        let mesh = solid.mesh();
        let corners = triangulate(mesh).corners;
        let triangles: Vec<[DVec3; 3]> =
            corners.iter().map(|t| t.map(|c| mesh.points[c as usize])).collect();
        let boxes: Vec<Bounds> = triangles.iter().map(|t| Bounds::of(*t)).collect();
        Boundary { tree: Bvh::new(&boxes), triangles }
    }

    /// Its triangles, each with its corners counter-clockwise from outside.
    pub fn triangles(&self) -> &[[DVec3; 3]] {
        &self.triangles
    }

    /// The box around it.
    pub fn bounds(&self) -> Bounds {
        self.tree.bounds()
    }

    /// A point of it.
    pub(super) fn some_point(&self) -> DVec3 {
        self.triangles[0][0]
    }

    /// The nearest triangle and its distance in mm.
    pub fn nearest(&self, p: DVec3) -> (u32, f64) {
        self.nearest_from(p, 0)
    }

    /// The same, quicker if the triangle `guess` is near.
    pub(super) fn nearest_from(&self, p: DVec3, guess: u32) -> (u32, f64) {
        let square = |t: u32| self.distance_squared(t, p);
        let limit = square(guess);
        let (t, square) =
            self.tree.nearest(&Bounds::of([p]), limit, square).unwrap_or((guess, limit));
        (t, square.sqrt())
    }

    pub(super) fn distance_squared(&self, triangle: u32, p: DVec3) -> f64 {
        on_triangle(self.triangles[triangle as usize], p).distance_squared(p)
    }

    /// Whether a point is inside, by the parity of the triangles above it; a boundary point is either.
    pub fn contains(&self, p: DVec3) -> bool {
        let mut odd = false;
        let column = Bounds { min: p, max: p.with_z(f64::INFINITY) };
        self.tree.visit(&column, |t| odd ^= is_below(p, self.triangles[t as usize]));
        odd
    }

    /// How deep a point is inside, in mm; negative outside.
    pub fn depth(&self, p: DVec3) -> f64 {
        self.signed(p, self.nearest(p).1)
    }

    /// A distance to the boundary as a depth.
    pub(super) fn signed(&self, p: DVec3, distance: f64) -> f64 {
        if distance > 0.0 && !self.contains(p) { -distance } else { distance }
    }

    /// The least distance to a segment in mm; 0 where it passes through.
    pub(super) fn distance_to_segment(&self, ends: [DVec3; 2]) -> f64 {
        let square = |t: u32| beside(&ends, &self.triangles[t as usize]);
        let found = self.tree.nearest(&Bounds::of(ends), f64::INFINITY, square);
        found.map_or(f64::INFINITY, |(_, square)| square.sqrt())
    }

    /// The least distance to another boundary in mm; 0 where they cross.
    pub fn distance(&self, other: &Boundary) -> f64 {
        let square =
            |i: u32, j: u32| apart(&self.triangles[i as usize], &other.triangles[j as usize]);
        let found = self.tree.nearest_pair(&other.tree, f64::INFINITY, square);
        found.map_or(f64::INFINITY, |(.., square)| square.sqrt())
    }
}

/// The square of the distance of two triangles.
fn apart(s: &[DVec3; 3], t: &[DVec3; 3]) -> f64 {
    let edges = |t: &[DVec3; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let pierced = |t: &[DVec3; 3], by: &[DVec3; 3]| edges(by).iter().any(|e| pierces(e, t));
    if pierced(s, t) || pierced(t, s) {
        return 0.0;
    }
    let corner = |t: &[DVec3; 3], p: &DVec3| on_triangle(*t, *p).distance_squared(*p);
    let corners = t.iter().map(|p| corner(s, p)).chain(s.iter().map(|p| corner(t, p)));
    let pairs = edges(s).into_iter().flat_map(|e| edges(t).map(|f| of_segments(e, f)));
    corners.chain(pairs.map(|[p, q]| p.distance_squared(q))).fold(f64::INFINITY, f64::min)
}

/// The square of the distance of a segment and a triangle.
fn beside(segment: &[DVec3; 2], t: &[DVec3; 3]) -> f64 {
    if pierces(segment, t) {
        return 0.0;
    }
    let ends = segment.iter().map(|p| on_triangle(*t, *p).distance_squared(*p));
    let edges = [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let pairs = edges.map(|edge| of_segments(*segment, edge));
    ends.chain(pairs.map(|[p, q]| p.distance_squared(q))).fold(f64::INFINITY, f64::min)
}

/// Whether a segment passes through the inside of a triangle, exactly.
fn pierces([p, q]: &[DVec3; 2], [a, b, c]: &[DVec3; 3]) -> bool {
    let side = |p: &DVec3| orient3d(*a, *b, *c, *p);
    let around = |u: &DVec3, v: &DVec3| orient3d(*p, *q, *u, *v);
    let (from, to) = (side(p), side(q));
    if from * to >= 0.0 {
        return false;
    }
    let turns = [around(a, b), around(b, c), around(c, a)];
    turns.iter().all(|t| *t > 0.0) || turns.iter().all(|t| *t < 0.0)
}
