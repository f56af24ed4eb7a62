//! From outlines to the mesh of the result: vertices are rounded here, once.

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::{
    boundary::Boundary,
    carry::Carried,
    cells::Complex,
    classify::Sides,
    facet::Facets,
    frame::Plan,
    origins::{Key, Labels},
    outline::{Loop, Outline},
    patch::{Borders, Patches},
    place::Places,
    space::{NONE, Space},
};
use crate::{geom::PolyMesh, kernel::brep::polyhedron::Polyhedron};

/// What the result is assembled from.
pub(super) struct Assembly<'a> {
    pub plan: &'a Plan,
    pub patches: &'a Patches,
    pub borders: &'a Borders,
    pub places: &'a Places<'a>,
    pub facets: &'a Facets,
    pub space: &'a Space,
    pub complex: &'a Complex,
    pub sides: &'a Sides,
}

impl Assembly<'_> {
    /// The result, placed; `None` if it is not closed, which means that the operands contradict
    /// themselves.
    pub fn solid(&self) -> Option<Polyhedron> {
        let mut labels = Labels::new(self.plan, self.facets);
        let boundary = Boundary::of(self.complex, self.sides, &mut labels);
        if boundary.is_open(self.borders) {
            return None;
        }
        let outline = Outline::of(&boundary, self.borders, self.complex);
        let dropped = outline.dropped((&boundary, self.borders), self.complex, self.space);
        let mut mesh = PolyMesh::default();
        let (mut loops, standing) = self.corners(&boundary, &outline, &dropped, &mut mesh);
        let carried = Carried::new(self, &boundary.up, &standing);
        if boundary.touches {
            part_equal_edges(&mut loops, &mut mesh);
        }
        let carried_origins = carried.origins(&mut labels);
        for origin in labels.origins {
            mesh.add_origin(origin);
        }
        self.add_faces(&boundary, &outline, &loops, &mut mesh);
        let (faces, points) = (mesh.face_count(), mesh.points.len() as u32);
        carried.add_faces(&carried_origins, &mut mesh);
        if self.plan.frame.mirrors() {
            mesh.flip();
        }
        Polyhedron::seamed(mesh, faces, points).ok()
    }

    /// Every loop as mesh points, and for every edge a number that both its sides share; and a mesh
    /// point for each point.
    fn corners(
        &self,
        boundary: &Boundary,
        outline: &Outline,
        dropped: &[bool],
        mesh: &mut PolyMesh,
    ) -> (Vec<Vec<(u32, u32)>>, Vec<u32>) {
        let mut standing = vec![NONE; self.space.point_count()];
        let mut numbers = vec![NONE; outline.vertex.len()];
        let mut loops = vec![];
        for edge in &outline.loops {
            let halves = outline.halves(edge);
            let vertex = |half: u32| outline.vertex[half as usize] as usize;
            let kept: Vec<usize> =
                (0..halves.len()).filter(|&i| !dropped[vertex(halves[i])]).collect();
            let mut corners = Vec::with_capacity(kept.len());
            for (k, &i) in kept.iter().enumerate() {
                let half = halves[i];
                let number = &mut numbers[vertex(half)];
                if *number == NONE {
                    *number = mesh.points.len() as u32;
                    let point = boundary.origin[half as usize];
                    standing[point as usize] = *number;
                    mesh.points.push(self.places.of(point, self.space));
                }
                let next = kept[(k + 1) % kept.len()];
                let last = halves[(next + halves.len() - 1) % halves.len()];
                corners.push((*number, half.min(boundary.twin[last as usize])));
            }
            loops.push(corners);
        }
        (loops, standing)
    }

    fn add_faces(
        &self,
        boundary: &Boundary,
        outline: &Outline,
        loops: &[Vec<(u32, u32)>],
        mesh: &mut PolyMesh,
    ) {
        let mut planes: FxHashMap<_, u32> = FxHashMap::default();
        let mut start = 0;
        for run in outline.loops.chunk_by(|a, b| a.polygon == b.polygon) {
            let key: Key =
                boundary.keys[run[0].polygon as usize].expect("a polygon is made of cells");
            let plane = *planes.entry(key.plane()).or_insert_with(|| mesh.add_plane());
            let corners = loops[start..start + run.len()].iter();
            let mut corners: Vec<Vec<u32>> =
                corners.map(|l| l.iter().map(|c| c.0).collect()).collect();
            if run.len() > 1 {
                let outer = outer_loop(run, outline, boundary, self.space);
                corners.swap(0, outer);
            }
            mesh.push_face(&corners, plane, key.origin);
            start += run.len();
        }
    }
}

/// The loop that the others are holes in: the one with the greatest area along the polygon's normal.
fn outer_loop(run: &[Loop], outline: &Outline, boundary: &Boundary, space: &Space) -> usize {
    let first = outline.halves(&run[0])[0];
    let base = DVec3::from_array(space.near(boundary.origin[first as usize]));
    let at = |half: u32| DVec3::from_array(space.near(boundary.origin[half as usize])) - base;
    let area = |halves: &[u32]| {
        let next = halves.iter().cycle().skip(1);
        halves.iter().zip(next).map(|(&g, &h)| at(g).cross(at(h))).sum::<DVec3>()
    };
    let areas: Vec<DVec3> = run.iter().map(|edge| area(outline.halves(edge))).collect();
    let normal: DVec3 = areas.iter().sum();
    let along = |i: usize| areas[i].dot(normal);
    (0..run.len()).max_by(|&i, &j| along(i).total_cmp(&along(j))).unwrap_or(0)
}

/// Two edges of the result between the same two vertices (where the result touches itself along an
/// edge) each get a vertex in their middle, so that edges are told apart by their ends.
fn part_equal_edges(loops: &mut [Vec<(u32, u32)>], mesh: &mut PolyMesh) {
    let ends = |corners: &[(u32, u32)], i: usize| {
        let (a, b) = (corners[i].0, corners[(i + 1) % corners.len()].0);
        (a.min(b), a.max(b))
    };
    let all = loops.iter().flat_map(|l| (0..l.len()).map(move |i| ends(l, i)));
    let mut all: Vec<(u32, u32)> = all.collect();
    all.sort_unstable();
    let crowded: Vec<(u32, u32)> =
        all.chunk_by(|a, b| a == b).filter(|run| run.len() > 2).map(|run| run[0]).collect();
    let mut middles: FxHashMap<u32, u32> = FxHashMap::default();
    for corners in loops.iter_mut() {
        let mut parted = Vec::with_capacity(corners.len() + 1);
        for i in 0..corners.len() {
            parted.push(corners[i]);
            let (a, b) = ends(corners, i);
            if crowded.binary_search(&(a, b)).is_ok() {
                let middle = *middles.entry(corners[i].1).or_insert_with(|| {
                    let place = (mesh.points[a as usize] + mesh.points[b as usize]) / 2.0;
                    mesh.points.push(place);
                    mesh.points.len() as u32 - 1
                });
                parted.push((middle, NONE));
            }
        }
        *corners = parted;
    }
}
