//! Facets: the faces of all leaves on the lattice.
//!
//! A face whose snapped corners still lie in one plane is one facet. Any other falls into triangles
//! that remember the face, and are merged again at the end. What snaps to no area is dropped, and
//! its corners are put on the edges it collapsed onto, so that both sides of those are split alike.

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::{
    super::threads,
    frame::Leaf,
    hierarchy::Bounds,
    lattice::Lattice,
    patch::{Patches, Snapped},
    place::Sources,
    polygon,
    space::{NONE, Space},
};
use crate::geom::{
    FaceRef,
    predicates::{Plane, minus},
};

/// A facet.
#[derive(Clone, Copy)]
pub(super) struct Facet {
    /// The operand it belongs to.
    pub owner: u32,
    /// The face it is (a part of).
    pub source: Source,
    /// Its loops: a range of `Facets::loop_ends`.
    loops: (u32, u32),
    /// Its plane and whether it faces against the plane's normal, once asked for.
    plane: Option<(u32, bool)>,
    /// Its box.
    pub bounds: Bounds,
}

/// Which face a facet is made of.
#[derive(Clone, Copy)]
pub(super) struct Source {
    /// The leaf.
    pub leaf: u32,
    /// The face of the leaf.
    pub face: u32,
    /// Whether the face lies in one plane also after snapping.
    pub flat: bool,
    /// Whether the facet faces against the face.
    pub flipped: bool,
}

/// The facets of the operands of an operation, each operand's together.
#[derive(Default)]
pub(super) struct Facets {
    list: Vec<Facet>,
    corners: Vec<u32>,
    /// For each corner the plane that holds the edge to the next one together with the facet's;
    /// [`NONE`] for an edge between lattice points.
    supports: Vec<u32>,
    loop_ends: Vec<u32>,
    /// The facets of every operand: one past its last.
    owner_ends: Vec<u32>,
    /// Corners of dropped facets strictly inside edges.
    pub extra: FxHashMap<(u32, u32), Vec<u32>>,
    /// Whether a facet was dropped.
    pub has_dropped: bool,
    /// Whether corners of a face have become one: the lattice is too coarse for a leaf.
    pub has_collapsed: bool,
}

impl Facets {
    /// The faces of all leaves that are in no patch, and where their corners come from.
    pub fn of(
        leaves: &[Leaf],
        patches: &Patches,
        lattice: &Lattice,
        space: &mut Space,
    ) -> (Facets, Sources) {
        let (mut facets, mut sources) = (Facets::default(), Sources::default());
        let mut dropped = vec![];
        let leaf = |number: usize| (number as u32, &leaves[number], &patches.leaves[number]);
        let mut numbered = |number| (number, sources.add_leaf(leaf(number), lattice, space));
        let numbers: Vec<(usize, Vec<u32>)> = (0..leaves.len()).map(&mut numbered).collect();
        let space = &*space;
        let parts = threads::each(&numbers, |(number, points)| {
            let (mut facets, mut dropped) = (Facets::default(), vec![]);
            facets.add_leaf(leaf(*number), points, space, &mut dropped);
            (facets, dropped)
        });
        for (part, flat) in parts {
            facets.append(part);
            dropped.extend(flat);
        }
        facets.has_dropped = !dropped.is_empty();
        facets.has_collapsed |= facets.has_dropped;
        facets.register(&dropped, space);
        (facets, sources)
    }

    /// Adds the facets of an operand that were collected on their own.
    fn append(&mut self, other: Facets) {
        let (loops, corners) = (self.loop_ends.len() as u32, self.corners.len() as u32);
        let owner = self.owner_ends.len() as u32;
        self.list.extend(other.list.into_iter().map(|facet| Facet {
            owner,
            loops: (facet.loops.0 + loops, facet.loops.1 + loops),
            ..facet
        }));
        self.corners.extend(other.corners);
        self.supports.extend(other.supports);
        self.loop_ends.extend(other.loop_ends.into_iter().map(|end| end + corners));
        self.has_collapsed |= other.has_collapsed;
        self.end_owner();
    }

    /// All facets in order.
    pub fn list(&self) -> &[Facet] {
        &self.list
    }

    /// The number of operands.
    pub fn owner_count(&self) -> usize {
        self.owner_ends.len()
    }

    /// The facets of an operand.
    pub fn of_owner(&self, owner: usize) -> std::ops::Range<usize> {
        let start = if owner == 0 { 0 } else { self.owner_ends[owner - 1] };
        start as usize..self.owner_ends[owner] as usize
    }

    /// The boxes of the facets of every operand.
    pub fn owner_bounds(&self) -> impl Iterator<Item = Bounds> + '_ {
        (0..self.owner_count()).map(|owner| {
            let list = self.list[self.of_owner(owner)].iter();
            list.fold(Bounds::EMPTY, |all, facet| all.with(facet.bounds))
        })
    }

    /// The box of all facets.
    pub fn bounds(&self) -> Bounds {
        self.list.iter().fold(Bounds::EMPTY, |all, facet| all.with(facet.bounds))
    }

    /// Ends an operand: the facets added since the last one are its own.
    pub fn end_owner(&mut self) {
        self.owner_ends.push(self.list.len() as u32);
    }

    fn ranges(&self, facet: u32) -> impl Iterator<Item = std::ops::Range<usize>> + Clone + '_ {
        let (start, end) = self.list[facet as usize].loops;
        (start..end).map(|i| {
            let from = if i == 0 { 0 } else { self.loop_ends[i as usize - 1] };
            from as usize..self.loop_ends[i as usize] as usize
        })
    }

    /// The loops of a facet, as points.
    pub fn loops(&self, facet: u32) -> impl Iterator<Item = &[u32]> + Clone {
        self.ranges(facet).map(|range| &self.corners[range])
    }

    /// The loops of a facet, as points with the supports of the edges that leave them.
    pub fn supported_loops(&self, facet: u32) -> impl Iterator<Item = (&[u32], &[u32])> + Clone {
        self.ranges(facet).map(|range| (&self.corners[range.clone()], &self.supports[range]))
    }

    /// The edges of a facet.
    pub fn edges(&self, facet: u32) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.loops(facet).flat_map(polygon::edges)
    }

    /// The edges of a facet with their supports.
    pub fn supported_edges(&self, facet: u32) -> impl Iterator<Item = (u32, u32, u32)> + '_ {
        self.supported_loops(facet).flat_map(|(corners, supports)| {
            polygon::edges(corners).zip(supports).map(|((a, b), &support)| (a, b, support))
        })
    }

    /// The plane of a facet and whether it faces against the plane's normal.
    pub fn plane(&mut self, facet: u32, space: &mut Space) -> (u32, bool) {
        if let Some(known) = self.list[facet as usize].plane {
            return known;
        }
        let (plane, turned) = self.exact_plane(facet, space);
        let found = (space.add_plane(plane), turned);
        self.list[facet as usize].plane = Some(found);
        found
    }

    fn exact_plane(&self, facet: u32, space: &Space) -> (Plane, bool) {
        let at = |p: u32| space.lattice_point(p).expect("a corner is a lattice point");
        let area = polygon::area_vector(self.loops(facet), &at);
        let first = self.loops(facet).next().map_or([0; 3], |l| at(l[0]));
        Plane::through(area, first).expect("a facet has an area")
    }

    /// Finds the [planes](Facets::plane) of some facets, in the order in which they are first met.
    pub fn find_planes(&mut self, facets: impl Iterator<Item = u32>, space: &mut Space) {
        let mut is_met = vec![false; self.list.len()];
        let is_new = |&facet: &u32| {
            let known = self.list[facet as usize].plane.is_some();
            !known && !std::mem::replace(&mut is_met[facet as usize], true)
        };
        let new: Vec<u32> = facets.filter(is_new).collect();
        let find = |&facet: &u32| self.exact_plane(facet, space);
        let find = |part: &[u32]| part.iter().map(find).collect::<Vec<(Plane, bool)>>();
        let planes = threads::parts(&new, FEW, find).into_iter().flatten();
        for (facet, (plane, turned)) in new.into_iter().zip(planes) {
            self.list[facet as usize].plane = Some((space.add_plane(plane), turned));
        }
    }

    /// Finds the supports of all edges of a facet.
    pub fn find_supports(&mut self, facet: u32, space: &mut Space) {
        let (plane, _) = self.plane(facet, space);
        let ranges: Vec<_> = self.ranges(facet).collect();
        for range in ranges {
            let mut after = self.corners[range.start];
            for place in range.rev() {
                let corner = self.corners[place];
                if self.supports[place] == NONE {
                    self.supports[place] = space.support(corner, after, plane);
                }
                after = corner;
            }
        }
    }

    /// The plane of a facet, if it was asked for before.
    pub fn known_plane(&self, facet: u32) -> Option<(u32, bool)> {
        self.list[facet as usize].plane
    }

    fn add_leaf(
        &mut self,
        (number, leaf, snapped): (u32, &Leaf, &Snapped),
        points: &[u32],
        space: &Space,
        dropped: &mut Vec<[u32; 3]>,
    ) {
        let mirrors = leaf.local.mirrors();
        let mesh = leaf.solid.mesh();
        self.reserve(mesh.face_count());
        for face in mesh.faces().filter(|f| !snapped.rests(f.index())) {
            self.add_face(number, face, (points, mirrors), space, dropped);
        }
        self.end_owner();
    }

    fn add_face(
        &mut self,
        leaf: u32,
        face: FaceRef<'_>,
        (points, mirrors): (&[u32], bool),
        space: &Space,
        dropped: &mut Vec<[u32; 3]>,
    ) {
        let at = |p: u32| space.lattice_point(p).expect("a corner is a lattice point");
        let loops: Vec<Vec<u32>> = face.loops().map(|l| snapped_loop(l, points, mirrors)).collect();
        let flat = loops.iter().all(|l| l.len() >= 3) && polygon::is_flat(&loops, &at);
        let source = Source { leaf, face: face.index() as u32, flat, flipped: false };
        let corners = loops.iter().map(Vec::len).sum::<usize>();
        self.has_collapsed |= corners < face.loops().map(<[u32]>::len).sum();
        if flat {
            self.push_corners(source, &loops, space);
            return;
        }
        let halves = match &loops[..] {
            [quad] => polygon::quad_triangles(quad, &at),
            _ => None,
        };
        if let Some(halves) = halves {
            halves.iter().for_each(|triangle| self.push_triangle(source, triangle, space));
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
                self.push_triangle(source, &triangle, space);
            }
        }
    }

    fn push_triangle(&mut self, source: Source, triangle: &[u32; 3], space: &Space) {
        self.push_loop(triangle.iter().map(|&corner| (corner, NONE)));
        self.push(source, 1, None, space);
    }

    /// Adds a facet with lattice points for corners.
    fn push_corners(&mut self, source: Source, loops: &[Vec<u32>], space: &Space) {
        for corners in loops {
            self.push_loop(corners.iter().map(|&corner| (corner, NONE)));
        }
        self.push(source, loops.len(), None, space);
    }

    /// Adds a loop of the facet that is [pushed](Facets::push) next: its corners and supports.
    pub fn push_loop(&mut self, corners: impl Iterator<Item = (u32, u32)>) {
        for (corner, support) in corners {
            self.corners.push(corner);
            self.supports.push(support);
        }
        self.loop_ends.push(self.corners.len() as u32);
    }

    /// Adds a facet of the loops added last, to the operand that ends next.
    pub fn push(
        &mut self,
        source: Source,
        loops: usize,
        plane: Option<(u32, bool)>,
        space: &Space,
    ) {
        let (owner, end) = (self.owner_ends.len() as u32, self.loop_ends.len());
        let from = if end == loops { 0 } else { self.loop_ends[end - loops - 1] };
        let corners = self.corners[from as usize..].iter();
        let bounds = corners.fold(Bounds::EMPTY, |all, &p| all.with(space.bounds(p)));
        let loops = ((end - loops) as u32, end as u32);
        self.list.push(Facet { owner, source, loops, plane, bounds });
    }

    /// The facets of one operand alone.
    pub fn operand(&self, owner: u32) -> Facets {
        let mut alone = Facets::default();
        alone.reserve(self.of_owner(owner as usize).len());
        self.of_owner(owner as usize).for_each(|f| alone.push_copy(self, f as u32, false));
        alone.end_owner();
        alone
    }

    /// Makes room for so many facets of one loop, most with four corners at most.
    pub fn reserve(&mut self, count: usize) {
        self.list.reserve(count);
        self.loop_ends.reserve(count);
        self.corners.reserve(4 * count);
        self.supports.reserve(4 * count);
    }

    /// Adds a facet of another list, turned over if `flip`.
    pub fn push_copy(&mut self, others: &Facets, number: u32, flip: bool) {
        let start = self.loop_ends.len() as u32;
        let mut facet = others.list[number as usize];
        for range in others.ranges(number) {
            let (corners, supports) = (&others.corners[range.clone()], &others.supports[range]);
            if flip {
                let last = supports[corners.len() - 1];
                let supports = supports[..corners.len() - 1].iter().rev().chain([&last]);
                self.push_loop(corners.iter().rev().copied().zip(supports.copied()));
            } else {
                self.corners.extend_from_slice(corners);
                self.supports.extend_from_slice(supports);
                self.loop_ends.push(self.corners.len() as u32);
            }
        }
        facet.loops = (start, self.loop_ends.len() as u32);
        facet.owner = self.owner_ends.len() as u32;
        if flip {
            facet.source.flipped = !facet.source.flipped;
            facet.plane = facet.plane.map(|(plane, turned)| (plane, !turned));
        }
        self.list.push(facet);
    }

    /// Gives all planes other numbers; [`NONE`] stays.
    pub fn renumber_planes(&mut self, mut number: impl FnMut(u32) -> u32) {
        self.supports.iter_mut().for_each(|support| *support = number(*support));
        let known = self.list.iter_mut().filter_map(|facet| facet.plane.as_mut());
        known.for_each(|(plane, _)| *plane = number(*plane));
    }

    /// Gives all corners other numbers.
    pub fn renumber_points(&mut self, mut number: impl FnMut(u32) -> u32) {
        self.corners.iter_mut().for_each(|corner| *corner = number(*corner));
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
    let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let with = |a: (DVec3, DVec3), b: (DVec3, DVec3)| (a.0.min(b.0), a.1.max(b.1));
    let around = |&(leaf, points): &(&Leaf, &[DVec3])| {
        let mut range = nothing;
        for &p in points {
            let placed = leaf.local.point(p);
            if !placed.is_finite() {
                return (DVec3::splat(f64::NEG_INFINITY), DVec3::INFINITY);
            }
            range = with(range, (placed, placed));
        }
        range
    };
    let parts = leaves
        .iter()
        .flat_map(|leaf| leaf.solid.mesh().points.chunks(CHUNK).map(move |points| (leaf, points)));
    let parts: Vec<_> = parts.collect();
    let around = |parts: &[(&Leaf, &[DVec3])]| parts.iter().map(around).fold(nothing, with);
    let range = threads::parts(&parts, MANY, around).into_iter().fold(nothing, with);
    if range.0.x > range.1.x { (DVec3::ZERO, DVec3::ZERO) } else { range }
}

/// Planes of so many facets are worth handing over.
const FEW: usize = 128;

/// Points that are looked at together by one thread.
const CHUNK: usize = 4096;

/// So many lots of points are worth a second thread.
const MANY: usize = 4;
