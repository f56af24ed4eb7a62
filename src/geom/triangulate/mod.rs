//! Polygons with holes into triangles over the same points.
//!
//! A face is projected along the axis nearest to its normal, which only drops a coordinate: the plane
//! points are as exact as the space points, and every decision about them is an exact sign. A sweep
//! ([`sweep`]) triangulates in n log n; flips ([`flip`]) then bring the triangles near Delaunay. A face
//! that no sweep can take (it crosses itself after rounding) is cut by ears ([`ears`]).
//!
//! Every corner is used and no point is added, so a mesh closed by index stays closed.

mod ears;
mod flip;
mod sweep;

use std::cmp::Ordering;

use glam::{DVec2, DVec3, dvec2};

use super::{mesh::PolyMesh, orient::orient2d};

/// Triangles over the points of a mesh.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Triangles {
    /// Point indices, counter-clockwise seen from outside.
    pub corners: Vec<[u32; 3]>,
    /// For each triangle the face it is part of.
    pub face: Vec<u32>,
}

/// The triangles of all faces, face by face.
///
/// A face has corners + 2 holes - 2 triangles, two less for each hole that meets another loop in a
/// shared corner. On a valid face none is inverted or degenerate, with one exception: corners that
/// coincide but are different points need a triangle without area between them. Never fails; the
/// triangles of an invalid face may overlap.
///
/// ```
/// use glam::dvec3;
/// use katachi::geom::{Origin, PolyMesh, Surface, triangulate::triangulate};
/// let corners = [[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]];
/// let mut mesh = PolyMesh::with_points(corners.map(|[x, y]| dvec3(x, y, 0.)).to_vec());
/// let (plane, origin) = (mesh.add_plane(), mesh.add_origin(Origin::of(Surface::Plane)));
/// mesh.push_face(&[[0, 1, 2, 3, 4, 5]], plane, origin);
/// assert_eq!(triangulate(&mesh).corners.len(), 4);
/// ```
pub fn triangulate(mesh: &PolyMesh) -> Triangles {
    let mut triangles = Triangles::default();
    let mut loops = vec![];
    for face in mesh.faces() {
        loops.clear();
        loops.extend(face.loops());
        triangulate_face(&mesh.points, &loops, &mut triangles.corners);
        triangles.face.resize(triangles.corners.len(), face.index() as u32);
    }
    triangles
}

/// Adds the triangles of one face to `out`: its outer loop first, then its holes, as point indices.
pub fn triangulate_face(points: &[DVec3], loops: &[&[u32]], out: &mut Vec<[u32; 3]>) {
    if let &[&[a, b, c]] = loops {
        return out.push([a, b, c]);
    }
    let normal = normal_of(points, loops);
    if let &[&[a, b, c, d]] = loops
        && let Some(pair) = quad(points, [a, b, c, d], normal)
    {
        return out.extend(pair);
    }
    let face = PlaneFace::new(points, loops, normal);
    let swept = match face.with_touching_loops_joined() {
        Some(joined) => sweep::triangles(&joined),
        None => sweep::triangles(&face).filter(|t| t.len() == face.len() + 2 * loops.len() - 4),
    };
    let mut triangles = swept.unwrap_or_else(|| ears::triangles(&face));
    flip::improve(&face, &mut triangles);
    out.extend(triangles.iter().map(|t| t.map(|corner| face.index[corner as usize])));
}

/// The outer loop's area vector (Newell).
fn normal_of(points: &[DVec3], loops: &[&[u32]]) -> DVec3 {
    let outer = loops[0];
    let base = points[outer[0] as usize];
    outer.windows(2).fold(DVec3::ZERO, |sum, w| {
        sum + (points[w[0] as usize] - base).cross(points[w[1] as usize] - base)
    })
}

/// Drops the coordinate along which the normal is longest, so that the face turns counter-clockwise.
fn projection(normal: DVec3) -> impl Fn(DVec3) -> DVec2 {
    let size = normal.abs();
    let axis = if size.z >= size.x.max(size.y) { 2 } else { usize::from(size.y > size.x) };
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let (u, v) = if normal[axis] < 0.0 { (v, u) } else { (u, v) };
    move |p| dvec2(p[u], p[v])
}

/// The two triangles of a quadrilateral, cut along the diagonal that Delaunay wants where both will do.
fn quad(points: &[DVec3], corners: [u32; 4], normal: DVec3) -> Option<[[u32; 3]; 2]> {
    let flat = projection(normal);
    let space = corners.map(|c| points[c as usize]);
    let plane = space.map(flat);
    let turn = |i: usize, j: usize, k: usize| orient2d(plane[i], plane[j], plane[k]) > 0.0;
    let [a, b, c, d] = corners;
    let by_ac = turn(0, 1, 2) && turn(0, 2, 3);
    let by_bd = turn(0, 1, 3) && turn(1, 2, 3);
    let along_ac = by_ac && !(by_bd && flip::wanted(space[0], space[2], space[3], space[1]));
    match (along_ac, by_bd) {
        (true, _) => Some([[a, b, c], [a, c, d]]),
        (false, true) => Some([[a, b, d], [b, c, d]]),
        (false, false) => None,
    }
}

/// So many corners are compared with each other, more are sorted.
const FEW: usize = 16;

/// A face in its plane. Corners are numbered through all loops; a point that two loops share is two
/// corners.
#[derive(Clone)]
struct PlaneFace {
    /// Exact plane points.
    plane: Vec<DVec2>,
    /// Space points, for true lengths.
    space: Vec<DVec3>,
    /// Point index of each corner.
    index: Vec<u32>,
    /// Following corner.
    next: Vec<u32>,
    /// Preceding corner.
    prev: Vec<u32>,
    /// First corner of each loop, and the number of corners at the end.
    starts: Vec<u32>,
}

impl PlaneFace {
    fn new(points: &[DVec3], loops: &[&[u32]], normal: DVec3) -> PlaneFace {
        let index: Vec<u32> = loops.concat();
        let space: Vec<DVec3> = index.iter().map(|&i| points[i as usize]).collect();
        let plane = space.iter().copied().map(projection(normal)).collect();
        let [next, prev] = [0; 2].map(|_| Vec::with_capacity(index.len()));
        let mut face = PlaneFace { plane, space, index, next, prev, starts: vec![0] };
        for corners in loops {
            let (start, n) = (face.next.len() as u32, corners.len() as u32);
            face.next.extend((0..n).map(|i| start + (i + 1) % n));
            face.prev.extend((0..n).map(|i| start + (i + n - 1) % n));
            face.starts.push(start + n);
        }
        face
    }

    fn len(&self) -> usize {
        self.index.len()
    }

    fn turn(&self, a: u32, b: u32, c: u32) -> f64 {
        orient2d(self.plane[a as usize], self.plane[b as usize], self.plane[c as usize])
    }

    /// The face with loops joined where they touch: each edge that comes in goes on along the first edge
    /// that leaves clockwise of it, so that every corner is a wedge of the inside. `None` if no two corners
    /// are at one place.
    ///
    /// Corners at one place that are different points are joined too, unless that would lead from one to
    /// another.
    fn with_touching_loops_joined(&self) -> Option<PlaneFace> {
        let is_apart = |i: usize| self.plane[..i].iter().all(|p| *p != self.plane[i]);
        if self.len() <= FEW && (1..self.len()).all(is_apart) {
            return None;
        }
        let place = |a: u32, b: u32| {
            let [p, q] = [a, b].map(|c| self.plane[c as usize]);
            p.x.total_cmp(&q.x).then_with(|| p.y.total_cmp(&q.y))
        };
        let point = |a: u32, b: u32| self.index[a as usize].cmp(&self.index[b as usize]);
        let face = self.joined(place)?;
        let before = |next: &u32| self.index[face.prev[*next as usize] as usize];
        if self.next.iter().map(before).eq(self.index.iter().copied()) {
            return Some(face);
        }
        self.joined(point)
    }

    /// The face with the edges paired at corners that are the same in an order; `None` if there are none.
    fn joined(&self, order: impl Fn(u32, u32) -> Ordering) -> Option<PlaneFace> {
        let mut corners: Vec<u32> = (0..self.len() as u32).collect();
        corners.sort_unstable_by(|&a, &b| order(a, b).then(a.cmp(&b)));
        let same = |a: &u32, b: &u32| order(*a, *b).is_eq();
        corners.windows(2).find(|w| same(&w[0], &w[1]))?;
        let mut face = self.clone();
        corners.chunk_by(same).filter(|g| g.len() > 1).for_each(|group| face.join(group));
        Some(face)
    }

    /// Pairs the edges at corners that are one point. The corner keeps the edge that comes in.
    fn join(&mut self, group: &[u32]) {
        let here = self.plane[group[0] as usize];
        let leaving: Vec<u32> = group.iter().map(|&c| self.next[c as usize]).collect();
        let mut free = leaving.clone();
        for &corner in group {
            let back = self.plane[self.prev[corner as usize] as usize];
            let first = (0..free.len()).min_by(|&i, &j| {
                let [a, b] = [i, j].map(|k| self.plane[free[k] as usize]);
                clockwise_from(here, back, a, b)
            });
            let next = free.swap_remove(first.expect("as many edges leave as come in"));
            self.next[corner as usize] = next;
            self.prev[next as usize] = corner;
        }
    }
}

/// Which of the points a and b is met first turning about `here` clockwise, from the direction of `from`.
fn clockwise_from(here: DVec2, from: DVec2, a: DVec2, b: DVec2) -> Ordering {
    // In the first half turn: to the right of `from`, or opposite to it.
    let half = |p: DVec2| {
        let side = orient2d(here, from, p);
        let early = side < 0.0 || (side == 0.0 && (from - here).dot(p - here) < 0.0);
        u8::from(!early)
    };
    let turn = orient2d(here, a, b);
    half(a).cmp(&half(b)).then(turn.partial_cmp(&0.0).unwrap_or(Ordering::Equal))
}

#[cfg(test)]
mod tests;
