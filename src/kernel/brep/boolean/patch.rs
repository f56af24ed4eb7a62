//! Patches: parts of a leaf's surface that no other leaf comes near.
//!
//! A cut touches few faces of a large solid. The faces whose boxes meet no box of another leaf's
//! face (seen through a grid, so with room to spare) need no arrangement: those that hang together
//! at points are one patch, wholly in the result or wholly out of it, and are carried over as they
//! stand. Where a patch borders on faces that do take part, what holds there holds for the patch.
//!
//! Faces stay out of patches if the argument needs them: those around the first point of every
//! shell (`seed` starts there), those whose plane number a face that takes part also has (so that
//! coplanar faces still merge), and those at points that are one point of the lattice.

use std::ops::Range;

use rustc_hash::FxHashMap;

use super::{
    super::threads,
    frame::Leaf,
    grid::Grid,
    hierarchy::{Bounds, Hierarchy},
    lattice::Lattice,
    space::NONE,
    union_find::Sets,
};
use crate::geom::{FaceRef, PolyMesh, predicates::Int3};

/// Leaves with fewer faces have no patches: arranging them costs less than looking.
const LARGE: usize = 1000;

/// Faces of one leaf that hang together.
pub(super) struct Patch {
    /// The leaf.
    pub leaf: u32,
    /// Its faces.
    pub faces: Vec<u32>,
    /// Its box.
    pub bounds: Bounds,
}

/// The points of a leaf on the lattice, and which of its faces rest.
#[derive(Default)]
pub(super) struct Snapped {
    /// The points.
    pub points: Vec<[i32; 3]>,
    /// For each face whether it is in a patch; empty if none is.
    resting: Vec<bool>,
    /// The patch of each point, or [`NONE`]; empty if there is none.
    patches: Vec<u32>,
}

impl Snapped {
    /// Whether a face is in a patch.
    pub fn rests(&self, face: usize) -> bool {
        self.resting.get(face).copied().unwrap_or(false)
    }

    /// The patch that a point of the leaf belongs to.
    fn patch(&self, point: u32) -> Option<u32> {
        self.patches.get(point as usize).copied().filter(|&p| p != NONE)
    }
}

/// All leaves on the lattice and their patches.
pub(super) struct Patches {
    /// By leaf.
    pub leaves: Vec<Snapped>,
    /// The patches.
    pub list: Vec<Patch>,
}

/// The patch that each point borders on, or [`NONE`].
pub(super) struct Borders(pub Vec<u32>);

impl Borders {
    /// The patch that a point borders on.
    pub fn patch(&self, point: u32) -> Option<u32> {
        self.0.get(point as usize).copied().filter(|&patch| patch != NONE)
    }
}

impl Patches {
    /// Snaps all leaves; finds their patches if `resting`.
    pub fn of(leaves: &[Leaf], lattice: &Lattice, resting: bool) -> Patches {
        let points =
            in_pieces(leaves.iter().map(|leaf| leaf.solid.mesh().points.len()), |leaf, range| {
                let leaf = &leaves[leaf];
                let points = leaf.solid.mesh().points[range].iter();
                points.map(|&p| lattice.snap(leaf.local.point(p))).collect::<Vec<[i32; 3]>>()
            });
        let mut patches = Patches { leaves: vec![], list: vec![] };
        let is_large = |leaf: &Leaf| leaf.solid.mesh().face_count() >= LARGE;
        let found: Vec<Option<Found>> = if resting && leaves.iter().any(is_large) {
            resting_faces(leaves, &points)
        } else {
            leaves.iter().map(|_| None).collect()
        };
        for (number, (points, found)) in (0u32..).zip(points.into_iter().zip(found)) {
            let Found { resting, patches: mut numbers, list } = found.unwrap_or_default();
            let before = patches.list.len() as u32;
            numbers.iter_mut().filter(|p| **p != NONE).for_each(|patch| *patch += before);
            patches.leaves.push(Snapped { points, resting, patches: numbers });
            patches.list.extend(list.into_iter().map(|patch| Patch { leaf: number, ..patch }));
        }
        patches
    }

    /// Which patch each point borders on, given the leaves' corners that the points are.
    pub fn borders(&self, sources: &[(u32, u32)]) -> Borders {
        if self.list.is_empty() {
            return Borders(vec![]);
        }
        let patch = |&(leaf, corner): &(u32, u32)| self.leaves[leaf as usize].patch(corner);
        Borders(sources.iter().map(|source| patch(source).unwrap_or(NONE)).collect())
    }

    /// The triangles, fans of each loop, of a patch's surface.
    pub fn triangles<'a>(
        &'a self,
        patch: u32,
        leaves: &'a [Leaf],
    ) -> impl Iterator<Item = [Int3; 3]> + 'a {
        let Patch { leaf, faces, .. } = &self.list[patch as usize];
        let (leaf, points) = (&leaves[*leaf as usize], &self.leaves[*leaf as usize].points);
        let mirrors = leaf.local.mirrors();
        let loops = faces.iter().flat_map(|&f| leaf.solid.mesh().face(f as usize).loops());
        loops.flat_map(move |corners| {
            corners[1..].windows(2).map(move |pair| {
                let [a, b, c] =
                    [corners[0], pair[0], pair[1]].map(|i| points[i as usize].map(i64::from));
                if mirrors { [a, c, b] } else { [a, b, c] }
            })
        })
    }
}

/// Points or faces that one thread looks at together.
const CHUNK: usize = 4096;

/// What is found for the items of each list, given how many there are, by looking at pieces of the lists.
fn in_pieces<R: Send + Clone>(
    counts: impl Iterator<Item = usize>,
    find: impl Fn(usize, Range<usize>) -> Vec<R> + Sync,
) -> Vec<Vec<R>> {
    let (mut pieces, mut found) = (vec![], vec![]);
    for (list, count) in counts.enumerate() {
        let starts = (0..count).step_by(CHUNK);
        pieces.extend(starts.map(|start| (list, start..count.min(start + CHUNK))));
        found.push(Vec::with_capacity(count));
    }
    let made = threads::each(&pieces, |(list, range)| find(*list, range.clone()));
    for ((list, _), mut made) in pieces.iter().zip(made) {
        found[*list].append(&mut made);
    }
    found
}

/// Puts the points of a face into one set.
fn join_corners(face: FaceRef<'_>, sets: &mut Sets) {
    let mut least = sets.find(face.outer()[0]);
    for &corner in face.loops().flatten() {
        least = sets.join_least(least, corner);
    }
}

fn bounds(face: FaceRef<'_>, points: &[[i32; 3]]) -> Bounds {
    let mut bounds = Bounds::EMPTY;
    for &corner in face.outer() {
        let at = points[corner as usize];
        bounds = bounds.with(Bounds { min: at, max: at });
    }
    bounds
}

/// What is found about the faces of a large leaf.
struct Large<'a> {
    /// Whether each may rest.
    resting: Vec<bool>,
    /// Their boxes.
    boxes: &'a [Bounds],
    /// The points that resting faces hold together, and perhaps some that were found to be needed.
    sets: Sets,
}

/// What rests of a large leaf.
#[derive(Default)]
struct Found {
    /// For each face whether it is in a patch.
    resting: Vec<bool>,
    /// The number of the patch of each point, or [`NONE`].
    patches: Vec<u32>,
    /// The patches, whose leaf is not given yet.
    list: Vec<Patch>,
}

impl Large<'_> {
    /// Groups the resting faces into patches.
    fn grouped(mut self, mesh: &PolyMesh) -> Found {
        let mut list: Vec<Patch> = vec![];
        let mut numbers = vec![NONE; mesh.points.len()];
        let mut patches = vec![NONE; mesh.points.len()];
        for face in mesh.faces().filter(|f| self.resting[f.index()]) {
            let number = &mut numbers[self.sets.find(face.outer()[0]) as usize];
            if *number == NONE {
                *number = list.len() as u32;
                list.push(Patch { leaf: NONE, faces: vec![], bounds: Bounds::EMPTY });
            }
            let patch = &mut list[*number as usize];
            patch.faces.push(face.index() as u32);
            patch.bounds = patch.bounds.with(self.boxes[face.index()]);
            face.loops().flatten().for_each(|&corner| patches[corner as usize] = *number);
        }
        Found { resting: self.resting, patches, list }
    }
}

/// Which faces of each leaf may rest.
fn resting_faces(leaves: &[Leaf], points: &[Vec<[i32; 3]>]) -> Vec<Option<Found>> {
    let counts = leaves.iter().map(|leaf| leaf.solid.mesh().face_count());
    let boxes = in_pieces(counts, |leaf, faces| {
        let mesh = leaves[leaf].solid.mesh();
        faces.map(|f| bounds(mesh.face(f), &points[leaf])).collect::<Vec<Bounds>>()
    });
    let around: Vec<Bounds> = points
        .iter()
        .map(|p| p.iter().fold(Bounds::EMPTY, |all, &p| all.with(Bounds { min: p, max: p })))
        .collect();
    let mut met: Vec<(u32, u32)> = vec![];
    Hierarchy::new(around.iter().copied()).own_pairs(|a, b| met.push((a, b)));
    let is_large = |leaf: u32| boxes[leaf as usize].len() >= LARGE;
    met.retain(|&(a, b)| is_large(a) || is_large(b));
    let numbers: Vec<usize> = (0..leaves.len()).collect();
    let near: Vec<(Vec<(Bounds, u32)>, Hierarchy)> = threads::each(&numbers, |&leaf| {
        let near = near(leaf, &boxes, &around, &met);
        let tree = Hierarchy::new(near.iter().map(|n| n.0));
        (near, tree)
    });
    let touched = |&(a, b): &(u32, u32)| {
        let mut touched = [vec![], vec![]];
        let [(near_a, tree_a), (near_b, tree_b)] = [a, b].map(|leaf| &near[leaf as usize]);
        tree_a.pairs(tree_b, |f, g| {
            touched[0].push(near_a[f as usize].1);
            touched[1].push(near_b[g as usize].1);
        });
        touched
    };
    let touched: Vec<[Vec<u32>; 2]> = threads::each(&met, touched);
    let mut awake: Vec<Vec<u32>> = vec![vec![]; leaves.len()];
    for (&(a, b), touched) in met.iter().zip(touched) {
        for (leaf, touched) in [a, b].into_iter().zip(touched).filter(|t| is_large(t.0)) {
            awake[leaf as usize].extend(touched);
        }
    }
    let rest = |&leaf: &usize| {
        let boxes = &boxes[leaf];
        if boxes.len() < LARGE {
            return None;
        }
        let mut resting = vec![true; boxes.len()];
        awake[leaf].iter().for_each(|&face| resting[face as usize] = false);
        let mesh = leaves[leaf].solid.mesh();
        let mut sets = Sets::new(points[leaf].len());
        mesh.faces().filter(|f| resting[f.index()]).for_each(|f| join_corners(f, &mut sets));
        wake(mesh, &points[leaf], &sets, &mut resting);
        Some(Large { resting, boxes, sets }.grouped(mesh))
    };
    threads::each(&numbers, rest)
}

/// The faces of a leaf that others may touch: of a large one those that a grid tells. `met` are the pairs of
/// leaves whose boxes meet.
fn near(
    leaf: usize,
    boxes: &[Vec<Bounds>],
    around: &[Bounds],
    met: &[(u32, u32)],
) -> Vec<(Bounds, u32)> {
    let all = boxes[leaf].iter().copied().zip(0u32..);
    if boxes[leaf].len() < LARGE {
        return all.collect();
    }
    let leaf = leaf as u32;
    let others = met.iter().filter(|m| m.0 == leaf || m.1 == leaf).map(|m| m.0 ^ m.1 ^ leaf);
    let others: Vec<usize> = others.map(|other| other as usize).collect();
    let reach = others.iter().fold(Bounds::EMPTY, |all, &other| all.with(around[other]));
    let mut grid = Grid::new(around[leaf as usize].common(reach));
    for bounds in others.iter().flat_map(|&other| &boxes[other]) {
        if bounds.meets(&around[leaf as usize]) {
            grid.mark(bounds);
        }
    }
    all.filter(|(bounds, _)| bounds.meets(&reach) && grid.meets(bounds)).collect()
}

/// Takes out of the resting faces what the argument needs: those around the first point of every
/// shell, those in a plane with faces that take part, those at points of faces that take part which
/// are one point of the lattice. `sets` are the points that resting faces hold together.
fn wake(mesh: &PolyMesh, points: &[[i32; 3]], sets: &Sets, resting: &mut [bool]) {
    let mut shells = sets.clone();
    for face in mesh.faces().filter(|f| !resting[f.index()]) {
        join_corners(face, &mut shells);
    }
    let mut first: Vec<u32> = (0..points.len() as u32).collect();
    for point in 0..points.len() as u32 {
        let slot = &mut first[shells.find(point) as usize];
        if points[point as usize] < points[*slot as usize] {
            *slot = point;
        }
    }
    let mut awake = vec![false; points.len()];
    let roots = (0..points.len() as u32).filter(|&p| shells.find(p) == p).collect::<Vec<_>>();
    roots.into_iter().for_each(|root| awake[first[root as usize] as usize] = true);
    wake_at(mesh, &awake, resting);
    let mut planes = vec![false; mesh.plane_count() as usize];
    for face in mesh.faces().filter(|f| !resting[f.index()]) {
        planes[face.plane() as usize] = true;
    }
    let moving = |face: FaceRef<'_>| planes[face.plane() as usize];
    mesh.faces().filter(|&f| moving(f)).for_each(|f| resting[f.index()] = false);
    while wake_shared(mesh, points, resting) {}
}

/// Takes the faces at marked points out of the resting ones; whether there were any.
fn wake_at(mesh: &PolyMesh, awake: &[bool], resting: &mut [bool]) -> bool {
    let mut any = false;
    for face in mesh.faces() {
        let resting = &mut resting[face.index()];
        if *resting && face.loops().flatten().any(|&corner| awake[corner as usize]) {
            *resting = false;
            any = true;
        }
    }
    any
}

/// Takes the faces at points out of the resting ones that are, on the lattice, one point with another
/// point of a face that takes part; whether there were any.
fn wake_shared(mesh: &PolyMesh, points: &[[i32; 3]], resting: &mut [bool]) -> bool {
    let mut seen: FxHashMap<[i32; 3], u32> = FxHashMap::default();
    let mut shared = vec![];
    for face in mesh.faces().filter(|f| !resting[f.index()]) {
        for &corner in face.loops().flatten() {
            let place = points[corner as usize];
            let known = *seen.entry(place).or_insert(corner);
            if known != corner {
                shared.extend([known, corner]);
            }
        }
    }
    if shared.is_empty() {
        return false;
    }
    let mut awake = vec![false; points.len()];
    shared.into_iter().for_each(|point| awake[point as usize] = true);
    wake_at(mesh, &awake, resting)
}

#[cfg(test)]
mod tests {
    /// A solid with patches in all places that matter gives what it gives without them.
    #[test]
    fn patches_change_nothing() {
        use super::super::{Tree, arranged, frame::plan};
        use crate::{geom::Placement, kernel::brep::measure, kernel::brep::primitive::sphere};
        use glam::{DMat3, DVec3, dvec3};
        let ball = std::sync::Arc::new(sphere(10.0, 64));
        let at = |scale: DVec3, x: f64| {
            let placement = Placement::new(DMat3::from_diagonal(scale), dvec3(x, 0.3, 0.2));
            Tree::Placed(placement, Box::new(Tree::Leaf(ball.clone())))
        };
        let (one, mirror) = (DVec3::ONE, dvec3(1.0, -1.0, 1.0));
        let hollow = || Tree::Difference(vec![at(one, 0.0), at(one * 0.5, 1.0)]);
        let trees = [
            Tree::Union(vec![at(one, 0.0), at(mirror, 5.0), at(one, 50.0)]),
            Tree::Difference(vec![at(one, 0.0), at(mirror, 5.0), at(one * 0.25, -5.0)]),
            Tree::Difference(vec![at(mirror, 0.0), at(mirror, 5.0), at(mirror * 0.25, -5.0)]),
            Tree::Intersection(vec![at(one, 0.0), at(one, 5.0)]),
            Tree::Union(vec![hollow(), at(one * 0.25, 0.0)]),
            Tree::Intersection(vec![hollow(), at(one * 0.25, 0.0)]),
            Tree::Difference(vec![at(one, 50.0), hollow()]),
        ];
        for tree in trees {
            let plan = plan(&tree, &Placement::IDENTITY).expect("a plan");
            let [with, without] = [true, false].map(|resting| {
                let found = arranged(&plan, true, resting).expect("finite");
                found.expect("the spheres do not cross themselves").solid
            });
            let volumes = [&with, &without].map(measure::volume);
            assert!((volumes[0] - volumes[1]).abs() <= 1e-9 * volumes[1], "{volumes:?}");
            assert_eq!(with.mesh().triangle_count(), without.mesh().triangle_count());
            assert_eq!(measure::euler(&with), measure::euler(&without));
        }
    }
}
