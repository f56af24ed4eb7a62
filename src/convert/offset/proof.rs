//! Whether an offset is where it should be.

use glam::DVec3;
use rayon::prelude::*;

use crate::{
    geom::{PolyMesh, Tolerance, triangulate::triangulate},
    kernel::{
        brep::Polyhedron,
        field::{Field, Polyhedral},
    },
};

/// How far a surface is from where it should be.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Deviation {
    /// The largest difference found, mm.
    pub most: f64,
    /// A place where it was found, mm.
    pub at: DVec3,
}

/// The largest difference between `by` mm and the distance of a point of a surface from a solid, over the
/// corners, the middles of the edges and the middles of the triangles of the surface; `None` for the empty
/// surface.
pub fn deviation(surface: &PolyMesh, field: &Polyhedral, by: f64) -> Option<Deviation> {
    let cut = triangulate(surface);
    let corner = |i: u32| surface.points[i as usize];
    let middles = cut.corners.par_iter().flat_map_iter(|&[a, b, c]| {
        let [p, q, r] = [a, b, c].map(corner);
        let edges = [(a, b, p, q), (b, c, q, r), (c, a, r, p)];
        let edges = edges.into_iter().filter(|e| e.0 < e.1).map(|e| (e.2 + e.3) / 2.0);
        [p, (p + q + r) / 3.0].into_iter().chain(edges)
    });
    let off = |at: DVec3| Deviation { most: (field.distance(at) - by).abs(), at };
    let worse = |a: Deviation, b: Deviation| match a.most.total_cmp(&b.most) {
        std::cmp::Ordering::Less => b,
        std::cmp::Ordering::Greater => a,
        // The same place whichever thread finds it.
        std::cmp::Ordering::Equal => {
            if a.at.to_array() <= b.at.to_array() {
                a
            } else {
                b
            }
        }
    };
    middles.map(off).reduce_with(worse)
}

/// A solid without the shells that are nowhere near the distance from another: what the offset surface winds
/// around beyond the middle of thin parts.
pub(super) fn without_strays(
    grown: &Polyhedron,
    field: &Polyhedral,
    by: f64,
    tolerance: Tolerance,
) -> Polyhedron {
    let mesh = grown.mesh();
    let shells = shells(mesh);
    let far = |p: DVec3| (field.distance(p) - by).abs() > tolerance.mm();
    let count = shells.iter().map(|&s| s as usize + 1).max().unwrap_or(0);
    let mut stray = vec![true; count];
    for (point, &shell) in mesh.points.iter().zip(&shells) {
        if stray[shell as usize] && !far(*point) {
            stray[shell as usize] = false;
        }
    }
    if !stray.contains(&true) {
        return grown.clone();
    }
    let mut kept = PolyMesh::with_points(mesh.points.clone());
    for origin in mesh.origins() {
        kept.add_origin(origin.clone());
    }
    for _ in 0..mesh.plane_count() {
        kept.add_plane();
    }
    for face in mesh.faces().filter(|f| !stray[shells[f.outer()[0] as usize] as usize]) {
        let loops: Vec<&[u32]> = face.loops().collect();
        kept.push_face(&loops, face.plane(), face.origin_index());
    }
    kept.drop_unused_points();
    Polyhedron::trusted(kept)
}

/// The number of the connected part of the surface that each point is of.
fn shells(mesh: &PolyMesh) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..mesh.points.len() as u32).collect();
    for face in mesh.faces() {
        for &corner in face.loops().flatten() {
            let first = root(&mut parent, face.outer()[0]);
            let other = root(&mut parent, corner);
            let (low, high) = (first.min(other), first.max(other));
            parent[high as usize] = low;
        }
    }
    (0..mesh.points.len() as u32).map(|i| root(&mut parent, i)).collect()
}

fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        parent[i as usize] = parent[parent[i as usize] as usize];
        i = parent[i as usize];
    }
    i
}
