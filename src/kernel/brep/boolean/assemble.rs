//! From outlines to the mesh of the result: vertices are rounded here, once.

use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

use super::{
    super::{
        crossing::{Tangle, tangle},
        threads,
    },
    boundary::Boundary,
    carry::Carried,
    cells::Complex,
    classify::Sides,
    facet::Facets,
    flat::flat_triangle,
    frame::Plan,
    origins::{Flat, Key, Labels},
    outline::{Loop, Once, Outline},
    patch::{Borders, Patches},
    place::Places,
    space::{NONE, Space},
};
use crate::{
    geom::{PolyMesh, triangulate::triangulate_face},
    kernel::brep::Polyhedron,
};

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

/// Results of so many faces are tested wherever they are not exactly what was arranged, larger ones only where
/// vertices are rounded: a corner that goes back from the lattice to its place hardly ever passes anything.
const SMALL: usize = 2000;

/// How often a result that crosses itself is mended.
const ROUNDS: usize = 4;

/// What is taken as it is on the lattice because the result crosses itself there otherwise.
#[derive(Default)]
struct Strict {
    /// Cells that are merged with no other.
    cells: FxHashSet<u32>,
    /// Points that do not go back to the corner they come from.
    points: FxHashSet<u32>,
}

/// A mesh and what its parts come from.
#[derive(Default)]
struct Draft {
    mesh: PolyMesh,
    /// The polygon of each face; those of patches follow and have none.
    polygons: Vec<u32>,
    /// The point of each vertex, so far as it has one.
    points: Vec<u32>,
    /// The faces that may cross others: with a vertex that is no lattice point, bent, or moved.
    suspects: Vec<u32>,
}

impl Assembly<'_> {
    /// The result, placed, and a place in mm where it crosses itself or is flat if that could not be mended; `None`
    /// if it is not closed.
    ///
    /// What is merged, moved back to its corners and rounded may cross what was apart by less. There
    /// cells stay pieces and points stay on the lattice.
    pub fn solid(&self) -> Option<(Polyhedron, Option<DVec3>)> {
        let mut strict = Strict::default();
        let mut rounds = 0..ROUNDS;
        loop {
            let (draft, carried) = self.draft(&strict)?;
            let faces = draft.polygons.len();
            let ((tangle, flat), solid) = threads::both(
                || match tangle(&draft.mesh, faces, &draft.suspects) {
                    None => (None, self.flat_triangle(&draft)),
                    found => (found, None),
                },
                || self.finished(draft.mesh.clone(), carried),
            );
            match (tangle, rounds.next()) {
                (Some(tangle), Some(_)) => self.hold_apart(&tangle, &draft, &mut strict),
                (tangle, _) => return Some((solid?, tangle.map(|t| t.place).or(flat))),
            }
        }
    }

    /// A place in mm where a face is flat: among those that may cross others, of a small result among all.
    fn flat_triangle(&self, draft: &Draft) -> Option<DVec3> {
        let count = draft.polygons.len() as u32;
        let all: Vec<u32> = match draft.polygons.len() <= SMALL || self.plan.mending.is_some() {
            true => (0..count).collect(),
            false => vec![],
        };
        let faces = if all.is_empty() { &draft.suspects } else { &all };
        flat_triangle(&draft.mesh, faces, &draft.points)
    }

    /// The solid of the arranged faces and those that are carried over; `None` if it is open.
    fn finished(&self, mut mesh: PolyMesh, carried: (Carried<'_>, Vec<u32>)) -> Option<Polyhedron> {
        let (faces, points) = (mesh.face_count(), mesh.points.len() as u32);
        let (carried, origins) = carried;
        carried.add_faces(&origins, &mut mesh);
        if self.plan.frame.mirrors() {
            mesh.flip();
        }
        if Polyhedron::is_seam_sound(&mesh, faces, points) {
            return Some(Polyhedron::trusted(mesh));
        }
        Polyhedron::new(mesh).ok()
    }

    /// Takes what is around crossing faces as it is on the lattice.
    fn hold_apart(&self, tangle: &Tangle, draft: &Draft, strict: &mut Strict) {
        let mut polygons: FxHashSet<u32> = FxHashSet::default();
        for &face in tangle.faces.iter().flatten() {
            polygons.extend(draft.polygons.get(face as usize));
            let corners = draft.mesh.face(face as usize).loops().flatten();
            strict.points.extend(corners.filter_map(|&c| draft.points.get(c as usize)));
        }
        let mut labels = Labels::new(self.plan, self.facets).holding_apart(strict.cells.clone());
        let boundary = Boundary::of(self.complex, self.sides, &mut labels);
        let halves = self.complex.halves.iter().zip(&boundary.polygon);
        let cells =
            halves.filter(|(_, polygon)| polygons.contains(polygon)).map(|(half, _)| half.cell);
        strict.cells.extend(cells);
    }

    /// The arranged faces of the result, placed, and those that are carried over, with their origins; `None`
    /// if it is open.
    fn draft(&self, strict: &Strict) -> Option<(Draft, (Carried<'_>, Vec<u32>))> {
        let mut labels = Labels::new(self.plan, self.facets).holding_apart(strict.cells.clone());
        let boundary = Boundary::of(self.complex, self.sides, &mut labels);
        if boundary.is_open(self.borders) {
            return None;
        }
        let outline = Outline::of(&boundary, self.borders, self.complex, Once::Vertex);
        let dropped = outline.dropped((&boundary, self.borders), self.complex, self.space);
        let mut draft = Draft::default();
        let shape = (&boundary, &outline, &dropped[..]);
        let (mut loops, standing) = self.corners(shape, strict, &mut draft);
        let carried = Carried::new(self, &boundary.up, &standing);
        if boundary.touches {
            part_equal_edges(&mut loops, &mut draft.mesh);
        }
        let carried_origins = carried.origins(&mut labels);
        for origin in labels.origins {
            draft.mesh.add_origin(origin);
        }
        self.add_faces(&boundary, &outline, &loops, &mut draft);
        Some((draft, (carried, carried_origins)))
    }

    /// Every loop as mesh points, and for every edge a number that both its sides share; and a mesh
    /// point for each point.
    fn corners(
        &self,
        (boundary, outline, dropped): (&Boundary, &Outline, &[bool]),
        strict: &Strict,
        draft: &mut Draft,
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
                    *number = draft.points.len() as u32;
                    let point = boundary.origin[half as usize];
                    standing[point as usize] = *number;
                    draft.points.push(point);
                    draft.mesh.points.push(match strict.points.contains(&point) {
                        true => self.places.on_lattice(point, self.space),
                        false => self.places.of(point, self.space),
                    });
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
        draft: &mut Draft,
    ) {
        let mesh = &mut draft.mesh;
        let (points, space) = (&draft.points, self.space);
        let any = |corners: &[Vec<u32>], test: &dyn Fn(u32) -> bool| {
            corners.iter().flatten().any(|&c| points.get(c as usize).is_none_or(|&p| test(p)))
        };
        let is_rounded = |point: u32| !space.is_on_lattice(point);
        let is_moved = |point: u32| self.places.is_moved(point, space);
        let mut doubtful = vec![];
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
            let first = mesh.face_count();
            if is_pinched(&corners) {
                add_triangles(&corners, plane, key.origin, mesh);
            } else {
                mesh.push_face(&corners, plane, key.origin);
            }
            draft.polygons.resize(mesh.face_count(), run[0].polygon);
            let faces = first as u32..mesh.face_count() as u32;
            if any(&corners, &is_rounded) {
                draft.suspects.extend(faces);
            } else if matches!(key.plane().0, Flat::Source(..)) || any(&corners, &is_moved) {
                doubtful.extend(faces);
            }
            start += run.len();
        }
        if mesh.face_count() <= SMALL || self.plan.mending.is_some() {
            draft.suspects.extend(doubtful);
        }
    }
}

/// Whether the loops of a polygon have a vertex in common.
fn is_pinched(loops: &[Vec<u32>]) -> bool {
    if loops.len() == 1 {
        return false;
    }
    let mut corners = loops.concat();
    corners.sort_unstable();
    corners.windows(2).any(|pair| pair[0] == pair[1])
}

/// Adds a pinched polygon as triangles: a face of a mesh is around a corner but once. Rounding may have left so
/// little of it that there are triangles with one corner twice; without them the others fit together as well.
fn add_triangles(loops: &[Vec<u32>], plane: u32, origin: u32, mesh: &mut PolyMesh) {
    let loops: Vec<&[u32]> = loops.iter().map(Vec::as_slice).collect();
    let mut triangles = vec![];
    triangulate_face(&mesh.points, &loops, &mut triangles);
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    triangles.iter().for_each(|corners| mesh.push_face(&[corners], plane, origin));
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
