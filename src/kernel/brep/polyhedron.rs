//! The solid of this kernel: a closed, oriented polygon mesh.

use glam::DVec3;
use rustc_hash::FxHashMap;
use thiserror::Error;

use crate::geom::{Placement, PolyMesh};

/// A closed, consistently oriented 2-manifold of planar polygons, possibly empty.
///
/// By index: every directed edge borders exactly one face, its reverse exactly one other, and the
/// faces around every point form one fan. Geometry (no self-intersection) is the maker's promise.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Polyhedron {
    mesh: PolyMesh,
}

/// Why a mesh is not a solid.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum Defect {
    /// A hole in the boundary, or a fin.
    #[error("edge {a}-{b} borders {faces} faces; a solid needs exactly 2")]
    OpenEdge {
        /// Index of its start.
        a: u32,
        /// Index of its end.
        b: u32,
        /// Faces found there.
        faces: usize,
        /// The middle of the edge, mm.
        at: DVec3,
        /// Number of such edges.
        edges: usize,
    },
    /// Two sheets that meet in one point.
    #[error("the faces at point {point} form {fans} fans; a solid needs exactly 1")]
    PinchedPoint {
        /// Its index.
        point: u32,
        /// Fans found there.
        fans: usize,
    },
    /// A coordinate that is NaN or infinite.
    #[error("point {point} has a coordinate that is not finite")]
    NotFinite {
        /// Its index.
        point: u32,
    },
}

impl Polyhedron {
    /// The empty solid.
    pub fn empty() -> Polyhedron {
        Polyhedron::default()
    }

    /// Takes a mesh in after checking that it is closed and manifold by index.
    pub fn new(mesh: PolyMesh) -> Result<Polyhedron, Defect> {
        check(&mesh)?;
        Ok(Polyhedron { mesh })
    }

    /// Takes a mesh in whose maker vouches for it; checked in debug builds only.
    pub(crate) fn trusted(mesh: PolyMesh) -> Polyhedron {
        debug_assert_eq!(check(&mesh), Ok(()));
        Polyhedron { mesh }
    }

    /// Its boundary.
    pub fn mesh(&self) -> &PolyMesh {
        &self.mesh
    }

    /// Its boundary, given away.
    pub fn into_mesh(self) -> PolyMesh {
        self.mesh
    }

    /// Whether it is the empty solid.
    pub fn is_empty(&self) -> bool {
        self.mesh.is_empty()
    }

    /// The solid after a placement that does not flatten space.
    pub fn placed(&self, placement: &Placement) -> Polyhedron {
        if placement.is_identity() {
            return self.clone();
        }
        Polyhedron { mesh: self.mesh.placed(placement) }
    }
}

/// The edges of a loop, each from corner to next corner.
fn edges(corners: &[u32]) -> impl Iterator<Item = (u32, u32)> + '_ {
    let next = corners.iter().cycle().skip(1);
    corners.iter().copied().zip(next.copied())
}

fn check(mesh: &PolyMesh) -> Result<(), Defect> {
    if let Some(point) = mesh.points.iter().position(|p| !p.is_finite()) {
        return Err(Defect::NotFinite { point: point as u32 });
    }
    // For each directed edge: how many loops run along it, and the corner that follows its end.
    let mut seen: FxHashMap<(u32, u32), (u32, u32)> = FxHashMap::default();
    for corners in mesh.faces().flat_map(|f| f.loops()) {
        for (i, edge) in edges(corners).enumerate() {
            let follower = corners[(i + 2) % corners.len()];
            seen.entry(edge).or_insert((0, follower)).0 += 1;
        }
    }
    check_edges(mesh, &seen)?;
    check_fans(mesh, &seen)
}

fn check_edges(mesh: &PolyMesh, seen: &FxHashMap<(u32, u32), (u32, u32)>) -> Result<(), Defect> {
    let count = |edge| seen.get(&edge).map_or(0, |entry: &(u32, u32)| entry.0);
    let bad = |&(a, b): &(u32, u32)| count((a, b)) != 1 || count((b, a)) != 1;
    let mut first = None;
    let mut open = 0;
    for (a, b) in mesh.faces().flat_map(|f| f.loops()).flat_map(edges).filter(bad) {
        first.get_or_insert((a, b));
        open += 1;
    }
    let Some((a, b)) = first else { return Ok(()) };
    let at = (mesh.points[a as usize] + mesh.points[b as usize]) / 2.0;
    Err(Defect::OpenEdge { a, b, faces: (count((a, b)) + count((b, a))) as usize, at, edges: open })
}

/// Walks once around every point: the walk must meet all edges that leave it.
fn check_fans(mesh: &PolyMesh, seen: &FxHashMap<(u32, u32), (u32, u32)>) -> Result<(), Defect> {
    let mut leaving = vec![0usize; mesh.points.len()];
    let mut start = vec![None; mesh.points.len()];
    for (a, b) in mesh.faces().flat_map(|f| f.loops()).flat_map(edges) {
        leaving[a as usize] += 1;
        start[a as usize].get_or_insert(b);
    }
    for (point, first) in start.iter().enumerate() {
        let Some(first) = *first else { continue };
        let point = point as u32;
        let (mut spoke, mut met) = (first, 0);
        loop {
            met += 1;
            spoke = seen[&(spoke, point)].1;
            if spoke == first || met > leaving[point as usize] {
                break;
            }
        }
        if met != leaving[point as usize] {
            return Err(Defect::PinchedPoint { point, fans: 2 });
        }
    }
    Ok(())
}
