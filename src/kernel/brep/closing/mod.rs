//! From loose triangles to solids: neighbours are found ([`twins`]), shells turned the right way
//! ([`shells`]), triangles of one plane merged ([`coplanar`]). A few passes over flat arrays, so that
//! millions of triangles take seconds.
//!
//! Half-edge 3 t + k runs from corner k of triangle t to the next corner.

mod coplanar;
mod doubled;
mod shells;
mod twins;

use glam::DVec3;

use super::{Defect, Polyhedron};
use crate::geom::{Origin, PolyMesh, triangulate::triangulate};

/// Flatness of faces from files, relative to the largest coordinate: one unit in the last place of the
/// single-precision numbers that STL files hold. Points of higher precision are held to the same measure,
/// far below what a maker can mean.
const SINGLE_PRECISION: f64 = 1.0 / (1 << 23) as f64;
/// Flatness of faces computed here: some units in the last place of double precision, what moving a flat
/// face into place costs.
const DOUBLE_PRECISION: f64 = 32.0 * f64::EPSILON;

/// Triangles over shared points; each remembers the face it is part of.
struct Soup {
    points: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// For each triangle the origin of its face.
    origin: Vec<u32>,
}

/// Makes a solid of a mesh whose points are welded.
pub(super) fn close(mesh: &PolyMesh) -> Result<Polyhedron, Defect> {
    if let Some(point) = mesh.points.iter().position(|p| !p.is_finite()) {
        return Err(Defect::NotFinite { point: point as u32 });
    }
    let mut soup = Soup::new(mesh);
    let (mut twin, crowded) = twins::pair(&mut soup)?;
    twins::split_fans(&mut soup, &twin);
    doubled::split(&mut soup, &mut twin, crowded);
    shells::turn_outwards(&mut soup, &mut twin);
    Ok(Polyhedron::trusted(coplanar::merge(&soup, &twin, mesh.origins(), SINGLE_PRECISION)))
}

/// The faces of triangles that are closed, manifold and turned outwards already.
pub(super) fn merged(points: Vec<DVec3>, triangles: Vec<[u32; 3]>, origin: Origin) -> PolyMesh {
    let mut soup = Soup { points, origin: vec![0; triangles.len()], triangles };
    match twins::pair(&mut soup) {
        Ok((twin, _)) => coplanar::merge(&soup, &twin, &[origin], DOUBLE_PRECISION),
        Err(defect) => unreachable!("closed triangles have neighbours: {defect}"),
    }
}

impl Soup {
    /// The triangles of all faces; those with a point twice have no area and are left out.
    fn new(mesh: &PolyMesh) -> Soup {
        let all = triangulate(mesh);
        let origin_of: Vec<u32> = mesh.faces().map(|f| f.origin_index()).collect();
        let mut soup = Soup { points: mesh.points.clone(), triangles: vec![], origin: vec![] };
        let is_whole = |&[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
        let kept = all.corners.iter().zip(&all.face).filter(|(t, _)| is_whole(t));
        for (&t, &face) in kept {
            soup.triangles.push(t);
            soup.origin.push(origin_of[face as usize]);
        }
        soup
    }

    fn start(&self, half_edge: u32) -> u32 {
        self.triangles[half_edge as usize / 3][half_edge as usize % 3]
    }

    fn end(&self, half_edge: u32) -> u32 {
        self.start(following(half_edge))
    }

    fn ends(&self, half_edge: u32) -> [u32; 2] {
        [self.start(half_edge), self.end(half_edge)]
    }

    /// The corners of a triangle as points.
    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|c| self.points[c as usize])
    }

    fn middle(&self, half_edge: u32) -> DVec3 {
        let [a, b] = self.ends(half_edge);
        (self.points[a as usize] + self.points[b as usize]) / 2.0
    }

    /// Turns the chosen triangles over.
    fn turn_over(&mut self, chosen: impl Fn(usize) -> bool) {
        let triangles = self.triangles.iter_mut().enumerate();
        triangles.filter(|(t, _)| chosen(*t)).for_each(|(_, t)| t.swap(1, 2));
    }
}

fn following(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

fn preceding(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}
