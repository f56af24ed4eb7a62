//! Faces of the boundary as plane pieces with triangles of their own.

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::touching::Touching;
use super::{Work, sorted};
use crate::{
    geom::{PolyMesh, triangulate::triangulate_face},
    kernel::tet::sphere::{Numbered, in_sphere, volume_sign},
};

/// A piece of the boundary in one plane, exactly.
#[derive(Clone, Debug)]
pub(super) struct Facet {
    /// The face of the mesh it is of.
    pub(super) face: u32,
    /// Corners, counter-clockwise seen from outside, holes clockwise.
    pub(super) loops: Vec<Vec<u32>>,
    /// Its triangles, when they are known.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Whether it is in one plane exactly, not but for rounding.
    plane: bool,
}

impl Facet {
    /// The edges of its border, each as it goes around.
    pub(super) fn edges(&self) -> impl Iterator<Item = [u32; 2]> {
        self.loops.iter().flat_map(|corners| {
            let next = corners.iter().cycle().skip(1);
            corners.iter().zip(next).map(|(&a, &b)| [a, b])
        })
    }
}

/// The facets of a mesh over numbered points, one a face.
pub(super) fn of_mesh(mesh: &PolyMesh, numbers: &[u32], points: &[DVec3]) -> Vec<Facet> {
    let mut facets = vec![];
    for face in mesh.faces() {
        let number = face.index() as u32;
        let loops: Vec<Vec<u32>> = face
            .loops()
            .map(|corners| welded_loop(corners.iter().map(|&c| numbers[c as usize])))
            .filter(|corners| corners.len() > 2)
            .collect();
        if loops.is_empty() {
            continue;
        }
        let plane = is_plane(&loops, points);
        facets.push(Facet { face: number, loops, triangles: vec![], plane });
    }
    facets
}

/// A loop in which no corner follows itself.
fn welded_loop(corners: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut corners: Vec<u32> = corners.collect();
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    corners
}

/// The triangles of a polygon.
fn triangles_of(loops: &[Vec<u32>], points: &[DVec3]) -> Vec<[u32; 3]> {
    let loops: Vec<&[u32]> = loops.iter().map(Vec::as_slice).collect();
    let mut triangles = vec![];
    triangulate_face(points, &loops, &mut triangles);
    triangles
}

/// Whether all corners are in one plane.
fn is_plane(loops: &[Vec<u32>], points: &[DVec3]) -> bool {
    if loops.len() == 1 && loops[0].len() == 3 {
        return has_area([loops[0][0], loops[0][1], loops[0][2]], points);
    }
    let p = |i: u32| points[i as usize];
    let Some([a, b, c]) = spanning(loops, points) else { return false };
    loops.iter().flatten().all(|&d| volume_sign(p(a), p(b), p(c), p(d)) == 0)
}

/// Three corners of the outer loop that are not on one line.
fn spanning(loops: &[Vec<u32>], points: &[DVec3]) -> Option<[u32; 3]> {
    let outer = &loops[0];
    let [a, b] =
        [outer[0], *outer.iter().find(|&&b| points[b as usize] != points[outer[0] as usize])?];
    outer.iter().map(|&c| [a, b, c]).find(|&t| has_area(t, points))
}

/// Whether the corners of a triangle are not on one line.
fn has_area(triangle: [u32; 3], points: &[DVec3]) -> bool {
    apex(triangle, points).is_some()
}

/// A place off the plane of a triangle, on the side from which it turns counter-clockwise; `None` when its corners
/// are on one line. Only its side counts.
pub(super) fn apex(triangle: [u32; 3], points: &[DVec3]) -> Option<DVec3> {
    /// How far, in steps of the fine lattice.
    const FAR: f64 = (1u64 << 40) as f64;
    let [a, b, c] = triangle.map(|i| points[i as usize]);
    DVec3::AXES.into_iter().find_map(|axis| match volume_sign(a, b, c, a + axis * FAR) {
        0 => None,
        sign => Some(a + axis * FAR * f64::from(sign)),
    })
}

impl Work {
    /// Triangulates all facets so that no circle through a triangle holds the corner across an edge (Lawson 1977);
    /// ties are broken as they are in space, so that what the tetrahedra have is found again.
    pub(super) fn triangulate_facets(&mut self) {
        let mut facets = std::mem::take(&mut self.facets);
        let points = Touching::new(&self.delaunay.points);
        facets.iter_mut().for_each(|facet| self.triangulate(facet, &points));
        self.facets = facets;
    }

    fn triangulate(&self, facet: &mut Facet, touching: &Touching) {
        for corners in &mut facet.loops {
            *corners = self.split_loop(corners);
        }
        facet.triangles = match facet.loops.as_slice() {
            [corners] if corners.len() == 3 => vec![[corners[0], corners[1], corners[2]]],
            loops => triangles_of(loops, &self.delaunay.points),
        };
        facet.triangles.retain(|&t| has_area(t, &self.delaunay.points));
        if facet.plane {
            touching.insert(&self.delaunay.points, &mut facet.triangles);
        }
        flip(&mut facet.triangles, |a, b, c, d| self.wants_flip(a, b, c, d));
    }

    /// Makes of every facet that is plane but for rounding one for each triangle. How it is cut is free: the
    /// diagonals that the tetrahedra have are taken first. Whether there were any.
    pub(super) fn cut_bent_facets(&mut self) -> bool {
        let facets = std::mem::take(&mut self.facets);
        let (plane, bent): (Vec<Facet>, Vec<Facet>) = facets.into_iter().partition(|f| f.plane);
        self.facets = plane;
        let points = Touching::new(&self.delaunay.points);
        for mut facet in bent.iter().cloned() {
            self.triangulate(&mut facet, &points);
            flip(&mut facet.triangles, |a, b, c, d| self.prefers(a, b, c, d));
            let triangle = |t: [u32; 3]| Facet {
                loops: vec![t.to_vec()],
                triangles: vec![],
                plane: true,
                ..facet
            };
            self.facets.extend(facet.triangles.iter().map(|&t| triangle(t)));
        }
        !bent.is_empty()
    }

    /// Whether the edge from a to b between the triangles a, b, c and b, a, d should go from c to d.
    fn wants_flip(&self, a: u32, b: u32, c: u32, d: u32) -> bool {
        let points = &self.delaunay.points;
        let Some(apex) = apex([a, b, c], points) else { return false };
        let p = |i: u32| points[i as usize];
        // The number of the apex never counts: without it the others are in one plane.
        let numbered = |i: u32| -> Numbered { (i, p(i)) };
        in_sphere([numbered(a), numbered(b), numbered(c), (u32::MAX, apex)], numbered(d))
            && volume_sign(p(d), p(b), p(c), apex) > 0
            && volume_sign(p(a), p(d), p(c), apex) > 0
    }

    /// Whether the tetrahedra have the edge from c to d and not that from a to b, and the corners are those of a
    /// convex quadrilateral seen from both triangles.
    fn prefers(&mut self, a: u32, b: u32, c: u32, d: u32) -> bool {
        let points = &self.delaunay.points;
        let p = |i: u32| points[i as usize];
        let convex = [apex([a, b, c], points), apex([b, a, d], points)].into_iter().all(|apex| {
            apex.is_some_and(|apex| {
                volume_sign(p(d), p(b), p(c), apex) > 0 && volume_sign(p(a), p(d), p(c), apex) > 0
            })
        });
        convex
            && self.delaunay.with_corners(a, &[b]).is_none()
            && self.delaunay.with_corners(c, &[d]).is_some()
    }
}

/// Flips edges between triangles that `wants` names until it names none: asked with the ends of the edge and the
/// corners across, the triangles being a, b, c and b, a, d.
fn flip(triangles: &mut [[u32; 3]], mut wants: impl FnMut(u32, u32, u32, u32) -> bool) {
    if triangles.len() < 2 {
        return;
    }
    let mut owner: FxHashMap<[u32; 2], usize> = FxHashMap::default();
    let mut open = vec![];
    for (t, &corners) in triangles.iter().enumerate() {
        for [a, b] in edges(corners) {
            owner.insert([a, b], t);
            if owner.contains_key(&[b, a]) {
                open.push([a, b]);
            }
        }
    }
    // Each flip lowers the lifted surface, so there are at most as many as pairs of corners.
    let mut left = triangles.len() * triangles.len() + 64;
    while let Some([a, b]) = open.pop() {
        let (Some(&first), Some(&second)) = (owner.get(&[a, b]), owner.get(&[b, a])) else {
            continue;
        };
        let (c, d) = (third(triangles[first], a, b), third(triangles[second], a, b));
        if left == 0
            || c == d
            || owner.contains_key(&[c, d])
            || owner.contains_key(&[d, c])
            || !wants(a, b, c, d)
        {
            continue;
        }
        left -= 1;
        owner.remove(&[a, b]);
        owner.remove(&[b, a]);
        triangles[first] = [a, d, c];
        triangles[second] = [d, b, c];
        for t in [first, second] {
            for edge in edges(triangles[t]) {
                owner.insert(edge, t);
            }
        }
        open.extend([[a, d], [d, b], [b, c], [c, a]]);
    }
}

/// The edges of a triangle.
pub(super) fn edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// The corner of a triangle that is neither.
fn third(triangle: [u32; 3], a: u32, b: u32) -> u32 {
    triangle.into_iter().find(|&c| c != a && c != b).unwrap_or(a)
}

/// Which pieces of the boundary every triangle of it is of, with the direction it is seen from.
pub(super) fn wanted(facets: &[Facet]) -> FxHashMap<[u32; 3], Vec<(u32, [u32; 3])>> {
    let mut wanted: FxHashMap<[u32; 3], Vec<(u32, [u32; 3])>> = FxHashMap::default();
    for facet in facets {
        for &triangle in &facet.triangles {
            wanted.entry(sorted(triangle)).or_default().push((facet.face, triangle));
        }
    }
    wanted
}
