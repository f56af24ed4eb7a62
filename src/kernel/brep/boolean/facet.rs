//! Facets: the faces of all leaves on the lattice.
//!
//! A face whose snapped corners still lie in one plane is one facet. Any other falls into triangles
//! that remember the face, and are merged again at the end. What snaps to no area is dropped, and
//! its corners are put on the edges it collapsed onto, so that both sides of those are split alike.

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::{
    frame::Leaf,
    hierarchy::Bounds,
    lattice::Lattice,
    patch::{Patches, Snapped},
    polygon,
    space::{NONE, Space},
};
use crate::geom::{
    FaceRef,
    predicates::{Int3, Plane, minus},
};

/// A facet.
pub(super) struct Facet {
    /// The leaf it belongs to.
    pub leaf: u32,
    /// The face of the leaf it is (a part of).
    pub face: u32,
    /// Whether it is a whole face, in one plane also after snapping.
    pub flat: bool,
    /// Its loops: a range of `Facets::loop_ends`.
    loops: (u32, u32),
    /// Its plane and whether it faces against the plane's normal, once asked for.
    plane: Option<(u32, bool)>,
    /// Its box.
    pub bounds: Bounds,
}

/// The facets of an operation.
#[derive(Default)]
pub(super) struct Facets {
    list: Vec<Facet>,
    corners: Vec<u32>,
    loop_ends: Vec<u32>,
    /// The facets of every leaf: one past its last.
    leaf_ends: Vec<u32>,
    /// Where each lattice point came from: leaf and point number there.
    pub sources: Vec<(u32, u32)>,
    /// Corners of dropped facets strictly inside edges.
    pub extra: FxHashMap<(u32, u32), Vec<u32>>,
    /// Largest movement of a corner, in mm of the operation's frame.
    pub snap: f64,
    /// Whether a facet was dropped.
    pub has_dropped: bool,
}

impl Facets {
    /// The faces of all leaves that are in no patch.
    pub fn of(leaves: &[Leaf], patches: &Patches, lattice: &Lattice, space: &mut Space) -> Facets {
        let mut facets = Facets::default();
        let mut dropped = vec![];
        for (number, leaf) in leaves.iter().enumerate() {
            let snapped = &patches.leaves[number];
            facets.add_leaf((number as u32, leaf, snapped), lattice, space, &mut dropped);
        }
        facets.has_dropped = !dropped.is_empty();
        facets.register(&dropped, space);
        facets
    }

    /// All facets in order.
    pub fn list(&self) -> &[Facet] {
        &self.list
    }

    /// The facets of a leaf.
    pub fn of_leaf(&self, leaf: usize) -> std::ops::Range<usize> {
        let start = if leaf == 0 { 0 } else { self.leaf_ends[leaf - 1] };
        start as usize..self.leaf_ends[leaf] as usize
    }

    /// The loops of a facet, as points.
    pub fn loops(&self, facet: u32) -> impl Iterator<Item = &[u32]> + Clone {
        let (start, end) = self.list[facet as usize].loops;
        (start..end).map(|i| {
            let from = if i == 0 { 0 } else { self.loop_ends[i as usize - 1] };
            &self.corners[from as usize..self.loop_ends[i as usize] as usize]
        })
    }

    /// The edges of a facet.
    pub fn edges(&self, facet: u32) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.loops(facet).flat_map(polygon::edges)
    }

    /// The plane of a facet and whether it faces against the plane's normal.
    pub fn plane(&mut self, facet: u32, space: &mut Space) -> (u32, bool) {
        if let Some(known) = self.list[facet as usize].plane {
            return known;
        }
        let at = |p: u32| space.lattice_point(p).expect("a corner is a lattice point");
        let area = polygon::area_vector(self.loops(facet), &at);
        let first = self.loops(facet).next().map_or([0; 3], |l| at(l[0]));
        let (plane, turned) = Plane::through(area, first).expect("a facet has an area");
        let found = (space.add_plane(plane), turned);
        self.list[facet as usize].plane = Some(found);
        found
    }

    /// The plane of a facet, if it was asked for before.
    pub fn known_plane(&self, facet: u32) -> Option<(u32, bool)> {
        self.list[facet as usize].plane
    }

    /// The patch that a point borders on.
    pub fn patch(&self, point: u32, patches: &Patches) -> Option<u32> {
        let &(leaf, corner) = self.sources.get(point as usize)?;
        patches.leaves[leaf as usize].patch(corner)
    }

    fn add_leaf(
        &mut self,
        (number, leaf, snapped): (u32, &Leaf, &Snapped),
        lattice: &Lattice,
        space: &mut Space,
        dropped: &mut Vec<[u32; 3]>,
    ) {
        let mesh = leaf.solid.mesh();
        let mut points = vec![NONE; mesh.points.len()];
        let mirrors = leaf.local.mirrors();
        for face in mesh.faces().filter(|f| !snapped.rests(f.index())) {
            for &corner in face.loops().flatten() {
                if points[corner as usize] == NONE {
                    let source = (number, corner, leaf.local.point(mesh.points[corner as usize]));
                    let local = snapped.points[corner as usize];
                    points[corner as usize] = self.add_point(source, local, lattice, space);
                }
            }
            self.add_face(number, face, (&points, mirrors), space, dropped);
        }
        self.leaf_ends.push(self.list.len() as u32);
    }

    /// Adds a corner of a leaf that stands at `placed` and is snapped to `local`.
    fn add_point(
        &mut self,
        (leaf, corner, placed): (u32, u32, DVec3),
        local: Int3,
        lattice: &Lattice,
        space: &mut Space,
    ) -> u32 {
        let moved = (lattice.place(local.map(|c| c as f64)) - placed).length();
        self.snap = self.snap.max(moved);
        let point = space.add_lattice_point(local);
        if point as usize == self.sources.len() {
            self.sources.push((leaf, corner));
        }
        point
    }

    fn add_face(
        &mut self,
        leaf: u32,
        face: FaceRef<'_>,
        (points, mirrors): (&[u32], bool),
        space: &Space,
        dropped: &mut Vec<[u32; 3]>,
    ) {
        let loops: Vec<Vec<u32>> = face.loops().map(|l| snapped_loop(l, points, mirrors)).collect();
        let at = |p: u32| space.lattice_point(p).expect("a corner is a lattice point");
        let number = face.index() as u32;
        if loops.iter().all(|l| l.len() >= 3) && polygon::is_flat(&loops, &at) {
            self.push(leaf, number, true, &loops, &at);
            return;
        }
        for triangle in polygon::triangles(&loops, &at) {
            let [a, b, c] = triangle;
            if a == b || b == c || c == a {
                continue;
            }
            if polygon::area_vector([&triangle[..]].into_iter(), &at) == [0; 3] {
                dropped.push(triangle);
            } else {
                self.push(leaf, number, false, &[triangle.to_vec()], &at);
            }
        }
    }

    fn push(
        &mut self,
        leaf: u32,
        face: u32,
        flat: bool,
        loops: &[Vec<u32>],
        at: &impl Fn(u32) -> Int3,
    ) {
        let start = self.loop_ends.len() as u32;
        let mut bounds = Bounds::EMPTY;
        for corners in loops {
            for &corner in corners {
                let p = at(corner).map(|c| c as i32);
                bounds = bounds.with(Bounds { min: p, max: p });
            }
            self.corners.extend_from_slice(corners);
            self.loop_ends.push(self.corners.len() as u32);
        }
        let loops = (start, self.loop_ends.len() as u32);
        self.list.push(Facet { leaf, face, flat, loops, plane: None, bounds });
    }

    /// Puts the corners of dropped triangles on the edges that run over them. Triangles that share
    /// an edge are one cluster, since what splits one side of an edge splits the other.
    fn register(&mut self, dropped: &[[u32; 3]], space: &Space) {
        for cluster in clusters(dropped) {
            let mut corners: Vec<u32> = cluster.iter().flat_map(|&t| dropped[t]).collect();
            corners.sort_unstable();
            corners.dedup();
            for (a, b) in cluster.iter().flat_map(|&t| polygon::edges(&dropped[t])) {
                let inside = corners.iter().copied().filter(|&c| strictly_between(space, a, b, c));
                let entry = self.extra.entry((a.min(b), a.max(b))).or_default();
                entry.extend(inside);
                entry.sort_unstable();
                entry.dedup();
            }
        }
        self.extra.retain(|_, points| !points.is_empty());
    }
}

/// A loop with its corners snapped and repetitions dropped, reversed in a mirrored leaf.
fn snapped_loop(corners: &[u32], points: &[u32], mirrors: bool) -> Vec<u32> {
    let mut snapped: Vec<u32> = corners.iter().map(|&c| points[c as usize]).collect();
    if mirrors {
        snapped.reverse();
    }
    snapped.dedup();
    while snapped.len() > 1 && snapped.first() == snapped.last() {
        snapped.pop();
    }
    snapped
}

/// Triangles grouped by shared edges.
fn clusters(triangles: &[[u32; 3]]) -> Vec<Vec<usize>> {
    let mut sets = super::union_find::Sets::new(triangles.len());
    let mut seen: FxHashMap<(u32, u32), usize> = FxHashMap::default();
    for (i, triangle) in triangles.iter().enumerate() {
        for (a, b) in polygon::edges(triangle) {
            let first = *seen.entry((a.min(b), a.max(b))).or_insert(i);
            sets.join(first as u32, i as u32);
        }
    }
    let mut groups: Vec<Vec<usize>> = vec![vec![]; triangles.len()];
    for i in 0..triangles.len() {
        groups[sets.find(i as u32) as usize].push(i);
    }
    groups.retain(|g| !g.is_empty());
    groups
}

/// Whether lattice point c lies on the open segment from a to b.
fn strictly_between(space: &Space, a: u32, b: u32, c: u32) -> bool {
    let at = |p: u32| space.lattice_point(p).expect("a corner is a lattice point");
    let (u, v) = (minus(at(c), at(a)), minus(at(b), at(a)));
    let w = minus(at(c), at(b));
    use crate::geom::predicates::{cross, dot};
    cross(u, v) == [0; 3] && dot(u, v) > 0 && dot(w, v) < 0
}

/// The box of all corners of all leaves in the frame of the operation.
pub(super) fn extent(leaves: &[Leaf]) -> (DVec3, DVec3) {
    let mut range = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for leaf in leaves {
        for &p in &leaf.solid.mesh().points {
            let placed = leaf.local.point(p);
            if !placed.is_finite() {
                return (DVec3::NEG_INFINITY, DVec3::INFINITY);
            }
            range = (range.0.min(placed), range.1.max(placed));
        }
    }
    if range.0.x > range.1.x { (DVec3::ZERO, DVec3::ZERO) } else { range }
}
