//! The polygons around crossed edges.
//!
//! Ju, T., Udeshi, T.: *Intersection-free contouring on an octree grid*, 2006: a polygon that goes through a
//! point of its edge and points of the faces between its leaves stays, piece by piece, inside of these leaves,
//! and so cannot meet another one. It has four times as many triangles as one through the vertices alone, and
//! so is used only where it has to be.

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use super::{
    Level,
    edges::{Edge, crossed},
    lattice::key,
    loops::{Loops, NONE, shared},
    octree::Octree,
    vertex::{Sample, inset, root, towards, vertex},
};
use crate::{geom::Bounds, kernel::field::pieces::Pieces};

/// Quadrilaterals whose diagonals are nearer to each other than this, squared and relative to the shorter one, are
/// flat.
const FLAT: f64 = 1e-6;

/// Triangles over points, with the leaves that they came from.
#[derive(Debug, Default)]
pub(super) struct Surface {
    pub points: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// For each point a leaf that it lies in.
    pub cells: Vec<u32>,
}

/// Points of earlier rounds: samples by the ends of their edges, vertices by their leaf and their edges.
#[derive(Debug, Default)]
pub(super) struct Made {
    samples: FxHashMap<[u64; 2], Sample>,
    vertices: FxHashMap<(u32, Vec<[u64; 2]>), DVec3>,
}

/// All that is known of the pieces before their polygons are made.
struct Maker<'a, L> {
    tree: &'a Octree<L>,
    edges: Vec<Edge>,
    loops: Loops,
    samples: Vec<Sample>,
    /// Leaves whose polygons are cut at edges and faces.
    cut: &'a FxHashSet<u32>,
    /// The number of the points made for segments.
    on_faces: Vec<u32>,
    out: Surface,
}

impl Surface {
    /// The surface of an octree; no point of it is off by more than a fraction of the tolerance, if its leaves
    /// are small enough.
    pub fn new<L: Level>(
        tree: &Octree<L>,
        tolerance: f64,
        cut: &FxHashSet<u32>,
        made: &mut Made,
    ) -> Surface {
        let edges = crossed(tree);
        let loops = Loops::new(tree, &edges);
        let names: Vec<[u64; 2]> = edges.iter().map(|e| [key(e.from), key(e.to)]).collect();
        let sample = |(e, name): (&Edge, &[u64; 2])| {
            if let Some(known) = made.samples.get(name) {
                return *known;
            }
            let end = |corner| (tree.lattice.point(corner), tree.value(corner));
            let field = &tree.cells[e.smallest as usize].field;
            root(field, [end(e.from), end(e.to)], tolerance)
        };
        let samples: Vec<Sample> = edges.par_iter().zip(&names).map(sample).collect();
        let place = |piece: u32| {
            let of = loops.around(piece).iter().map(|&e| names[e as usize]).collect();
            let name = (loops.cells[piece as usize], of);
            if let Some(known) = made.vertices.get(&name) {
                return (name, *known);
            }
            let around = loops.around(piece).iter().map(|&e| samples[e as usize]);
            let point = vertex(tree, loops.cells[piece as usize], around, tolerance);
            (name, point)
        };
        let pieces = loops.cells.len() as u32;
        let placed: Vec<_> = (0..pieces).into_par_iter().map(place).collect();
        let points: Vec<DVec3> = placed.iter().map(|(_, point)| *point).collect();
        made.vertices = placed.into_iter().collect();
        made.samples = names.into_iter().zip(samples.iter().copied()).collect();
        let out = Surface { points, triangles: vec![], cells: loops.cells.clone() };
        let on_faces = vec![NONE; loops.segments.len()];
        let mut maker = Maker { tree, edges, loops, samples, cut, on_faces, out };
        maker.face_points(tolerance);
        maker.polygons();
        maker.out
    }
}

impl Surface {
    /// Leaves out pieces that fit into a box of some size: what is left of walls and gaps too thin to be sought.
    pub fn drop_crumbs(&mut self, size: f64) {
        let mut pieces = Pieces::new(self.points.len());
        self.triangles.iter().for_each(|t| pieces.join(*t));
        let mut boxes = vec![Bounds::EMPTY; self.points.len()];
        for i in 0..self.points.len() as u32 {
            let piece = &mut boxes[pieces.of(i) as usize];
            *piece = piece.joined(&Bounds::of([self.points[i as usize]]));
        }
        let mut is_large = |i: u32| {
            let piece = boxes[pieces.of(i) as usize];
            (piece.max - piece.min).max_element() > size
        };
        self.triangles.retain(|t| is_large(t[0]));
    }
}

impl<L: Level> Maker<'_, L> {
    fn add(&mut self, point: DVec3, cell: u32) -> u32 {
        self.out.points.push(point);
        self.out.cells.push(cell);
        self.out.points.len() as u32 - 1
    }

    /// Points on the faces of leaves that are cut.
    fn face_points(&mut self, tolerance: f64) {
        for i in 0..self.loops.segments.len() {
            let segment = self.loops.segments[i];
            if !segment.cells.iter().any(|c| self.cut.contains(c)) {
                continue;
            }
            let (low, size, axis) = shared(self.tree, segment.cells);
            let high = [0, 1, 2].map(|k| low[k] + size[k]);
            let [min, max] = [low, high].map(|corner| self.tree.lattice.point(corner));
            let mut face = inset(&Bounds { min, max });
            (face.min[axis], face.max[axis]) = (min[axis], min[axis]);
            let [a, b] = segment.ends.map(|e| self.samples[e as usize].point);
            let field = &self.tree.cells[segment.cells[0] as usize].field;
            let point = towards(field, (a + b) / 2.0, &face, tolerance);
            self.on_faces[i] = self.add(point, segment.cells[0]);
        }
    }

    fn polygons(&mut self) {
        let split: Vec<bool> = {
            let halves = |e: usize| self.is_shorter(e);
            (0..self.edges.len()).into_par_iter().map(halves).collect()
        };
        for (e, &first) in split.iter().enumerate() {
            self.polygon(e, first);
        }
    }

    /// The vertices around an edge, each once.
    fn corners(&self, e: usize) -> ([u32; 4], usize) {
        let (mut corners, mut count) = ([0; 4], 0);
        for k in 0..4 {
            if self.loops.sides[e][k] != NONE {
                corners[count] = self.loops.pieces[e][k];
                count += 1;
            }
        }
        (corners, count)
    }

    /// Whether a quadrilateral is cut from its first corner to its third: where the middle of the cut is nearer
    /// to the surface.
    fn is_shorter(&self, e: usize) -> bool {
        let (corners, count) = self.corners(e);
        if count < 4 {
            return true;
        }
        let middle = |a: usize, b: usize| {
            let [p, q] = [a, b].map(|i| self.out.points[corners[i] as usize]);
            ((p + q) / 2.0, p.distance_squared(q))
        };
        let ((p, long), (q, wide)) = (middle(0, 2), middle(1, 3));
        // Flat ones need no look at the surface.
        if p.distance_squared(q) < FLAT * long.min(wide) {
            return long <= wide;
        }
        let (a, b) = (self.tree.off(p), self.tree.off(q));
        // Cuts as good as each other are told apart by their lengths.
        if (a - b).abs() > 1e-3 * a.max(b) { a < b } else { long <= wide }
    }

    /// The triangles around an edge.
    fn polygon(&mut self, e: usize, first: bool) {
        let turned = !self.edges[e].leaves;
        let sides = self.loops.sides[e];
        let is_cut = sides.iter().any(|&s| s != NONE && self.on_faces[s as usize] != NONE);
        let (corners, count) = self.corners(e);
        let [a, b, c, d] = corners;
        match (is_cut, count) {
            (true, _) => self.fan(e, turned),
            (false, 4) if first => {
                self.push([a, b, c], turned);
                self.push([a, c, d], turned);
            }
            (false, 4) => {
                self.push([b, c, d], turned);
                self.push([b, d, a], turned);
            }
            (false, 3) => self.push([a, b, c], turned),
            (false, _) => {}
        }
    }

    /// The triangles from the point of an edge to the ring around it.
    fn fan(&mut self, e: usize, turned: bool) {
        let mut ring = vec![];
        for k in 0..4 {
            let side = self.loops.sides[e][k];
            if side != NONE {
                ring.push(self.loops.pieces[e][k]);
                ring.extend(Some(self.on_faces[side as usize]).filter(|p| *p != NONE));
            }
        }
        let middle = self.add(self.samples[e].point, self.edges[e].smallest);
        for i in 0..ring.len() {
            self.push([middle, ring[i], ring[(i + 1) % ring.len()]], turned);
        }
    }

    fn push(&mut self, [a, b, c]: [u32; 3], turned: bool) {
        self.out.triangles.push(if turned { [a, c, b] } else { [a, b, c] });
    }
}
