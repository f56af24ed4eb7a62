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

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::{
    frame::Leaf,
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
    pub points: Vec<Int3>,
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
        let snap = |leaf: &Leaf| {
            let points = leaf.solid.mesh().points.iter();
            points.map(|&p| lattice.snap(leaf.local.point(p))).collect::<Vec<Int3>>()
        };
        let points: Vec<Vec<Int3>> = leaves.par_iter().map(snap).collect();
        let mut patches = Patches { leaves: vec![], list: vec![] };
        let is_large = |leaf: &Leaf| leaf.solid.mesh().face_count() >= LARGE;
        let found: Vec<Vec<bool>> = if resting && leaves.iter().any(is_large) {
            resting_faces(leaves, &points)
        } else {
            vec![vec![]; leaves.len()]
        };
        for ((leaf, points), resting) in leaves.iter().zip(points).zip(found) {
            patches.add(leaf.solid.mesh(), Snapped { points, resting, patches: vec![] });
        }
        patches
    }

    /// Groups the resting faces of a leaf into patches.
    fn add(&mut self, mesh: &PolyMesh, mut snapped: Snapped) {
        let leaf = self.leaves.len() as u32;
        if snapped.resting.contains(&true) {
            let resting = || mesh.faces().filter(|f| snapped.resting[f.index()]);
            let mut sets = joined(resting(), snapped.points.len());
            let mut numbers = vec![NONE; snapped.points.len()];
            for face in resting() {
                let root = sets.find(face.outer()[0]);
                if numbers[root as usize] == NONE {
                    numbers[root as usize] = self.list.len() as u32;
                    self.list.push(Patch { leaf, faces: vec![], bounds: Bounds::EMPTY });
                }
                let number = numbers[root as usize];
                let patch = &mut self.list[number as usize];
                patch.faces.push(face.index() as u32);
                patch.bounds = patch.bounds.with(bounds(face, &snapped.points));
                face.loops().flatten().for_each(|&c| numbers[c as usize] = number);
            }
            snapped.patches = numbers;
        }
        self.leaves.push(snapped);
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
                let [a, b, c] = [corners[0], pair[0], pair[1]].map(|i| points[i as usize]);
                if mirrors { [a, c, b] } else { [a, b, c] }
            })
        })
    }
}

/// Points in one set where faces hold them together.
fn joined<'a>(faces: impl Iterator<Item = FaceRef<'a>>, points: usize) -> Sets {
    let mut sets = Sets::new(points);
    for face in faces {
        let first = face.outer()[0];
        face.loops().flatten().for_each(|&c| sets.join(first, c));
    }
    sets
}

fn bounds(face: FaceRef<'_>, points: &[Int3]) -> Bounds {
    let corners = face.outer().iter().map(|&c| points[c as usize].map(|x| x as i32));
    corners.fold(Bounds::EMPTY, |all, p| all.with(Bounds { min: p, max: p }))
}

/// For each leaf and face whether it may rest.
fn resting_faces(leaves: &[Leaf], points: &[Vec<Int3>]) -> Vec<Vec<bool>> {
    let boxes = |(leaf, points): (&Leaf, &Vec<Int3>)| {
        leaf.solid.mesh().faces().map(|f| bounds(f, points)).collect::<Vec<Bounds>>()
    };
    let boxes: Vec<Vec<Bounds>> = leaves.par_iter().zip(points).map(boxes).collect();
    let around: Vec<Bounds> =
        boxes.iter().map(|b| b.iter().fold(Bounds::EMPTY, |all, b| all.with(*b))).collect();
    let near: Vec<Vec<(Bounds, u32)>> =
        (0..leaves.len()).into_par_iter().map(|leaf| near(leaf, &boxes, &around)).collect();
    let tree = |near: &Vec<(Bounds, u32)>| Hierarchy::new(near.iter().map(|n| n.0));
    let trees: Vec<Hierarchy> = near.par_iter().map(tree).collect();
    let found = (0..leaves.len()).into_par_iter().map(|leaf| {
        let count = boxes[leaf].len();
        if count < LARGE {
            return vec![];
        }
        let mut resting = vec![true; count];
        let others = (0..leaves.len()).filter(|&o| o != leaf && around[o].meets(&around[leaf]));
        for other in others {
            trees[leaf].pairs(&trees[other], |face, _| {
                resting[near[leaf][face as usize].1 as usize] = false;
            });
        }
        wake(leaves[leaf].solid.mesh(), &points[leaf], &mut resting);
        resting
    });
    found.collect()
}

/// The faces of a leaf that others may touch: of a large one those that a grid tells.
fn near(leaf: usize, boxes: &[Vec<Bounds>], around: &[Bounds]) -> Vec<(Bounds, u32)> {
    let all = boxes[leaf].iter().copied().zip(0u32..);
    if boxes[leaf].len() < LARGE {
        return all.collect();
    }
    let mut grid = Grid::new(around[leaf]);
    let others = (0..boxes.len()).filter(|&o| o != leaf && around[o].meets(&around[leaf]));
    let others = others.flat_map(|other| &boxes[other]);
    others.filter(|b| b.meets(&around[leaf])).for_each(|b| grid.mark(b));
    all.filter(|(bounds, _)| grid.meets(bounds)).collect()
}

/// Takes out of the resting faces what the argument needs.
fn wake(mesh: &PolyMesh, points: &[Int3], resting: &mut [bool]) {
    let mut awake = shared_points(points);
    let mut shells = joined(mesh.faces(), points.len());
    let mut first: Vec<u32> = (0..points.len() as u32).collect();
    for point in 0..points.len() as u32 {
        let slot = &mut first[shells.find(point) as usize];
        if points[point as usize] < points[*slot as usize] {
            *slot = point;
        }
    }
    for face in mesh.faces() {
        let corner = face.outer()[0];
        awake[first[shells.find(corner) as usize] as usize] = true;
    }
    for face in mesh.faces() {
        if face.loops().flatten().any(|&c| awake[c as usize]) {
            resting[face.index()] = false;
        }
    }
    let mut planes = vec![false; mesh.plane_count() as usize];
    for face in mesh.faces().filter(|f| !resting[f.index()]) {
        planes[face.plane() as usize] = true;
    }
    let moving = |face: FaceRef<'_>| planes[face.plane() as usize];
    mesh.faces().filter(|&f| moving(f)).for_each(|f| resting[f.index()] = false);
}

/// Whether each point is at the same place as another.
fn shared_points(points: &[Int3]) -> Vec<bool> {
    let mut seen: FxHashMap<[i32; 3], u32> = FxHashMap::default();
    seen.reserve(points.len());
    let mut shared = vec![false; points.len()];
    for (number, point) in (0u32..).zip(points) {
        if let Some(before) = seen.insert(point.map(|c| c as i32), number) {
            shared[before as usize] = true;
            shared[number as usize] = true;
        }
    }
    shared
}

/// Cells along each axis of a grid: the bits of a word.
const CELLS: usize = 64;

/// A box in cells, some of which are marked.
struct Grid {
    bounds: Bounds,
    scale: [f64; 3],
    /// Marks along x, for each z and y.
    rows: Vec<u64>,
}

impl Grid {
    fn new(bounds: Bounds) -> Grid {
        let size = |i: usize| f64::from(bounds.max[i]) - f64::from(bounds.min[i]) + 1.0;
        let scale = std::array::from_fn(|i| CELLS as f64 / size(i));
        Grid { bounds, scale, rows: vec![0; CELLS * CELLS] }
    }

    /// The cell of a coordinate; never decreases with it, so boxes that meet share a cell.
    fn cell(&self, axis: usize, coordinate: i32) -> usize {
        let from = f64::from(coordinate) - f64::from(self.bounds.min[axis]);
        ((from * self.scale[axis]) as usize).min(CELLS - 1)
    }

    /// The rows that a box meets, and the bits of its cells in them.
    fn rows(&self, bounds: &Bounds) -> (impl Iterator<Item = usize> + use<>, u64) {
        let [x, y, z] =
            [0, 1, 2].map(|i| [self.cell(i, bounds.min[i]), self.cell(i, bounds.max[i])]);
        let bits = (u64::MAX >> (CELLS - 1 - (x[1] - x[0]))) << x[0];
        ((z[0]..=z[1]).flat_map(move |z| (y[0]..=y[1]).map(move |y| z * CELLS + y)), bits)
    }

    fn mark(&mut self, bounds: &Bounds) {
        let (rows, bits) = self.rows(bounds);
        rows.for_each(|row| self.rows[row] |= bits);
    }

    fn meets(&self, bounds: &Bounds) -> bool {
        let (mut rows, bits) = self.rows(bounds);
        rows.any(|row| self.rows[row] & bits != 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_that_meet_share_a_cell() {
        let cube = |low: i32, high: i32| Bounds { min: [low; 3], max: [high; 3] };
        let mut grid = Grid::new(cube(-1000, 1000));
        grid.mark(&cube(-2000, -500));
        assert!(grid.meets(&cube(-500, 900)));
        assert!(!grid.meets(&cube(-400, 2000)));
    }

    #[test]
    fn points_at_one_place_are_found() {
        assert_eq!(shared_points(&[[1, 2, 3], [4, 5, 6], [1, 2, 3]]), [true, false, true]);
    }

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
