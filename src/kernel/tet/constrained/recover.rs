//! Triangles of the boundary that the tetrahedra lack: what passes through them is taken out and filled again.

use rustc_hash::{FxHashMap, FxHashSet};

use super::{NoTetrahedra, Work, facets, sorted, wrap::Wrap};
use crate::kernel::tet::delaunay::{Delaunay, GHOST, Side, of_side, side};

/// The wanted triangles, each whatever its direction.
type Wanted = FxHashSet<[u32; 3]>;

impl Work {
    /// Makes every triangle of every facet a face of tetrahedra. All edges must be there.
    pub(super) fn recover_facets(&mut self) -> Result<(), NoTetrahedra> {
        let wanted: Wanted =
            self.facets.iter().flat_map(|f| f.triangles.iter().map(|&t| sorted(t))).collect();
        for number in 0..self.facets.len() {
            let triangles = self.facets[number].triangles.clone();
            let missing: Vec<[u32; 3]> =
                triangles.into_iter().filter(|&t| self.delaunay.side_with(t).is_none()).collect();
            for region in self.regions(&missing) {
                if region.iter().all(|&t| self.delaunay.side_with(t).is_some()) {
                    continue;
                }
                let near = region[0][0];
                recover(&mut self.delaunay, &region, &wanted)
                    .ok_or_else(|| NoTetrahedra::Crossing { place: self.place(near) })?;
            }
        }
        Ok(())
    }

    /// Missing triangles in groups that hang together by edges which are missing as well.
    fn regions(&mut self, missing: &[[u32; 3]]) -> Vec<Vec<[u32; 3]>> {
        let mut owner: FxHashMap<[u32; 2], Vec<usize>> = FxHashMap::default();
        for (i, &triangle) in missing.iter().enumerate() {
            for edge in facets::edges(triangle) {
                if self.delaunay.with_corners(edge[0], &[edge[1]]).is_none() {
                    owner.entry(sorted(edge)).or_default().push(i);
                }
            }
        }
        let mut seen = vec![false; missing.len()];
        let mut regions = vec![];
        for start in 0..missing.len() {
            if std::mem::replace(&mut seen[start], true) {
                continue;
            }
            let (mut region, mut next) = (vec![start], 0);
            while let Some(&here) = region.get(next) {
                next += 1;
                for edge in facets::edges(missing[here]) {
                    for &there in owner.get(&sorted(edge)).into_iter().flatten() {
                        if !std::mem::replace(&mut seen[there], true) {
                            region.push(there);
                        }
                    }
                }
            }
            regions.push(region.into_iter().map(|i| missing[i]).collect());
        }
        regions
    }
}

/// Makes the triangles of a region faces of tetrahedra; `None` when that cannot be.
fn recover(delaunay: &mut Delaunay, region: &[[u32; 3]], wanted: &Wanted) -> Option<()> {
    let cavity = cavity(delaunay, region)?;
    let plane = region[0];
    let inside: FxHashSet<u32> = cavity.iter().copied().collect();
    let mut halves = [vec![], vec![]];
    for &tetrahedron in &cavity {
        for corner in 0..4 {
            let outer = delaunay.across(side(tetrahedron, corner));
            let face = delaunay.face(outer);
            let is_inner = inside.contains(&of_side(outer).0);
            if is_inner && !wanted.contains(&sorted(face)) {
                continue;
            }
            let height = face.into_iter().map(|c| height(delaunay, plane, c)).find(|&h| h != 0)?;
            halves[usize::from(height < 0)].push(face);
        }
    }
    for &[a, b, c] in region {
        halves[0].push([a, b, c]);
        halves[1].push([a, c, b]);
    }
    let mut corners: Vec<u32> = cavity.iter().flat_map(|&t| delaunay.corners(t)).collect();
    corners.sort_unstable();
    corners.dedup();
    let mut filling = vec![];
    for (fronts, side) in halves.into_iter().zip([1, -1]) {
        let near = corners.iter().copied().filter(|&c| height(delaunay, plane, c) * side >= 0);
        filling.extend(Wrap::new(delaunay, fronts, near.collect()).fill()?);
    }
    replace(delaunay, &cavity, filling)
}

/// On which side of the plane of a triangle a point is.
fn height(delaunay: &Delaunay, plane: [u32; 3], point: u32) -> i32 {
    if point == GHOST || plane.contains(&point) { 0 } else { delaunay.sign(plane, point) }
}

/// The tetrahedra that pass through a region: from one edge that crosses it around all that do.
fn cavity(delaunay: &mut Delaunay, region: &[[u32; 3]]) -> Option<Vec<u32>> {
    let plane = region[0];
    let (start, edge) = first_crossing(delaunay, region)?;
    let mut edges = FxHashSet::from_iter([sorted(edge)]);
    let (mut open, mut found, mut cavity) = (vec![(start, edge)], FxHashSet::default(), vec![]);
    while let Some((tetrahedron, edge)) = open.pop() {
        for t in delaunay.around(tetrahedron, edge) {
            if !found.insert(t) {
                continue;
            }
            if delaunay.is_ghost(t) {
                return None;
            }
            cavity.push(t);
            for edge in crossing_edges(delaunay, plane, t) {
                if edges.insert(sorted(edge)) {
                    open.push((t, edge));
                }
            }
        }
    }
    Some(cavity)
}

/// The edges of a tetrahedron with an end on either side of a plane.
fn crossing_edges(delaunay: &Delaunay, plane: [u32; 3], tetrahedron: u32) -> Vec<[u32; 2]> {
    let corners = delaunay.corners(tetrahedron);
    let heights = corners.map(|c| height(delaunay, plane, c));
    let pairs = (0..4).flat_map(|i| (0..i).map(move |j| (i, j)));
    pairs
        .filter(|&(i, j)| heights[i] * heights[j] < 0)
        .map(|(i, j)| [corners[i], corners[j]])
        .collect()
}

/// A tetrahedron and an edge of it that crosses a triangle of the region.
fn first_crossing(delaunay: &mut Delaunay, region: &[[u32; 3]]) -> Option<(u32, [u32; 2])> {
    for &corner in region.iter().flatten() {
        for t in delaunay.star(corner) {
            if delaunay.is_ghost(t) {
                continue;
            }
            for edge in crossing_edges(delaunay, region[0], t) {
                if region.iter().any(|&triangle| crosses(delaunay, triangle, edge)) {
                    return Some((t, edge));
                }
            }
        }
    }
    None
}

/// Whether an edge with ends on either side of a triangle's plane passes through it or its border.
fn crosses(delaunay: &Delaunay, triangle: [u32; 3], [p, q]: [u32; 2]) -> bool {
    let signs = facets::edges(triangle).map(|[a, b]| delaunay.sign([a, b, p], q));
    signs.iter().all(|&s| s >= 0) || signs.iter().all(|&s| s <= 0)
}

/// Takes tetrahedra out and puts others in their place, joined to each other and to what is around.
fn replace(delaunay: &mut Delaunay, cavity: &[u32], filling: Vec<[u32; 4]>) -> Option<()> {
    let mut open: FxHashMap<[u32; 3], Side> = FxHashMap::default();
    let inside: FxHashSet<u32> = cavity.iter().copied().collect();
    for &tetrahedron in cavity {
        for corner in 0..4 {
            let outer = delaunay.across(side(tetrahedron, corner));
            if !inside.contains(&of_side(outer).0) {
                open.insert(sorted(delaunay.face(outer)), outer);
            }
        }
    }
    cavity.iter().for_each(|&t| delaunay.remove(t));
    for corners in filling {
        let new = delaunay.push(corners);
        for corner in 0..4 {
            let mine = side(new, corner);
            let key = sorted(delaunay.face(mine));
            match open.remove(&key) {
                Some(other) => delaunay.join(mine, other),
                None => drop(open.insert(key, mine)),
            }
        }
    }
    open.is_empty().then_some(())
}
