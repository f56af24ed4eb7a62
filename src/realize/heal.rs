//! Closing an open mesh: `heal = WINDING`.
//!
//! Jacobson, Kavan, Sorkine-Hornung, *Robust inside-outside segmentation using generalized winding
//! numbers*, 2013. A hole takes from the winding number the solid angle of its boundary. A fan from the
//! middle of the boundary spans that angle up to full turns; with it the number is whole everywhere, and
//! one half or more means inside.
//!
//! # Departures
//! The number is made whole by fans, not measured in cells. Sheets that cross one another stay as they
//! are.

use std::collections::BTreeMap;

use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

use crate::geom::{Origin, PolyMesh, Surface, triangulate::triangulate};

type Corners = [u32; 3];

/// The mesh closed, its equal points being one already: triangles given twice count once, two that face
/// each other cancel, those that face the other way than most of their piece are turned over, and holes are
/// filled. Edges may border more than two triangles.
pub fn closed(mesh: &PolyMesh) -> PolyMesh {
    let mut points = mesh.points.clone();
    let mut triangles = different(&triangulate(mesh).corners);
    agree(&mut triangles);
    fill(&mut points, &mut triangles);
    mesh_of(points, &triangles)
}

/// The edges of a triangle.
fn edges([a, b, c]: Corners) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}

/// Triangles of three different corners, each once; two that face each other cancel.
fn different(triangles: &[Corners]) -> Vec<Corners> {
    let first_least = |t: Corners| {
        let least = (0..3).min_by_key(|&k| t[k]).unwrap_or(0);
        [t[least], t[(least + 1) % 3], t[(least + 2) % 3]]
    };
    let proper = triangles.iter().filter(|[a, b, c]| a != b && b != c && c != a);
    let turned: Vec<Corners> = proper.map(|&t| first_least(t)).collect();
    let given: FxHashSet<Corners> = turned.iter().copied().collect();
    let mut seen = FxHashSet::default();
    let keep = |t: &Corners| seen.insert(*t) && !given.contains(&[t[0], t[2], t[1]]);
    turned.into_iter().filter(keep).collect()
}

/// Turns triangles over until neighbours at edges of just two triangles face one way, as most of each piece do.
/// A piece with one side only stays in disagreement somewhere.
fn agree(triangles: &mut [Corners]) {
    let across = neighbours(triangles);
    let mut turned: Vec<Option<bool>> = vec![None; triangles.len()];
    for first in 0..triangles.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let mut piece = vec![first];
        let mut next = 0;
        while next < piece.len() {
            let here = piece[next];
            next += 1;
            for &(there, against) in across[here].iter().flatten() {
                if turned[there].is_none() {
                    turned[there] = turned[here].map(|turn| turn ^ against);
                    piece.push(there);
                }
            }
        }
        let minority = 2 * piece.iter().filter(|&&t| turned[t] == Some(true)).count() > piece.len();
        for t in piece {
            if turned[t] == Some(!minority) {
                triangles[t].swap(1, 2);
            }
        }
    }
}

/// Across each edge of each triangle the other triangle, where there is just one, and whether it runs along the
/// edge the same way and so faces against this one.
fn neighbours(triangles: &[Corners]) -> Vec<[Option<(usize, bool)>; 3]> {
    let mut borders: Vec<(u32, u32, usize)> = vec![];
    for (t, &triangle) in triangles.iter().enumerate() {
        let sides = edges(triangle).into_iter().zip(0..);
        borders.extend(sides.map(|((a, b), k)| (a.min(b), a.max(b), 3 * t + k)));
    }
    borders.sort_unstable();
    let mut found = vec![[None; 3]; triangles.len()];
    for pair in borders.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)).filter(|g| g.len() == 2) {
        let [x, y] = [pair[0].2, pair[1].2];
        let against = triangles[x / 3][x % 3] == triangles[y / 3][y % 3];
        found[x / 3][x % 3] = Some((y / 3, against));
        found[y / 3][y % 3] = Some((x / 3, against));
    }
    found
}

/// Puts a fan into every hole: from the middle of its corners to its edges.
fn fill(points: &mut Vec<DVec3>, triangles: &mut Vec<Corners>) {
    let boundary = boundary(triangles);
    let mut hole_of: Vec<usize> = (0..points.len()).collect();
    for &(a, b) in &boundary {
        let (a, b) = (lowest(&mut hole_of, a as usize), lowest(&mut hole_of, b as usize));
        hole_of[a.max(b)] = a.min(b);
    }
    let mut holes: BTreeMap<usize, Vec<(u32, u32)>> = BTreeMap::new();
    for &(a, b) in &boundary {
        holes.entry(lowest(&mut hole_of, a as usize)).or_default().push((a, b));
    }
    for edges in holes.values() {
        let sum: DVec3 = edges.iter().map(|&(a, _)| points[a as usize]).sum();
        let middle = points.len() as u32;
        points.push(sum / edges.len() as f64);
        triangles.extend(edges.iter().map(|&(a, b)| [b, a, middle]));
    }
}

/// Directed edges that lack their reverse, in the order of the triangles, each as often as it does.
fn boundary(triangles: &[Corners]) -> Vec<(u32, u32)> {
    let mut surplus: FxHashMap<(u32, u32), i32> = FxHashMap::default();
    for (a, b) in triangles.iter().copied().flat_map(edges) {
        *surplus.entry((a, b)).or_default() += 1;
        *surplus.entry((b, a)).or_default() -= 1;
    }
    let mut found = vec![];
    for edge in triangles.iter().copied().flat_map(edges) {
        let count = surplus.insert(edge, 0).unwrap_or(0);
        found.extend((0..count).map(|_| edge));
    }
    found
}

/// The mesh of triangles.
fn mesh_of(points: Vec<DVec3>, triangles: &[Corners]) -> PolyMesh {
    let mut mesh = PolyMesh::with_points(points);
    let origin = mesh.add_origin(Origin::of(Surface::Facets));
    for triangle in triangles {
        let plane = mesh.add_plane();
        mesh.push_face(&[triangle], plane, origin);
    }
    mesh
}

/// The least number of a set that `number` belongs to; shortens the way to it.
fn lowest(set: &mut [usize], mut number: usize) -> usize {
    while set[number] != number {
        set[number] = set[set[number]];
        number = set[number];
    }
    number
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;
    use crate::kernel::brep::{faces::from_import, measure, primitive::cuboid};

    /// A box without its last face, turned inside out.
    fn open_box() -> PolyMesh {
        let solid = cuboid(DVec3::ZERO, dvec3(2.0, 3.0, 4.0));
        let mut mesh = PolyMesh::with_points(solid.mesh().points.clone());
        let origin = mesh.add_origin(Origin::of(Surface::Facets));
        for face in solid.mesh().faces().take(5) {
            let plane = mesh.add_plane();
            let turned: Vec<u32> = face.outer().iter().rev().copied().collect();
            mesh.push_face(&[turned], plane, origin);
        }
        mesh
    }

    #[test]
    fn a_hole_is_filled() {
        let solid = from_import(&closed(&open_box())).expect("closed");
        assert!((measure::volume(&solid) - 24.0).abs() < 1e-12);
    }

    #[test]
    fn doubled_triangles_count_once_and_facing_ones_cancel() {
        let triangles = [[0, 1, 2], [1, 2, 0], [3, 4, 5], [3, 5, 4], [6, 6, 7]];
        assert_eq!(different(&triangles), [[0, 1, 2]]);
    }
}
