//! The tetrahedra of a closed polyhedron: constrained Delaunay.
//!
//! Corners first: the Delaunay tetrahedralisation of all of them ([`super::delaunay`]). Then the edges: one that
//! is missing is split by a point on it until its pieces are there ([`segments`]). Then the faces: where one is
//! missing, the tetrahedra that pass through it are taken out and both sides filled again up to it ([`recover`],
//! [`wrap`]); once all edges are there, this needs no more points. What is outside is dropped at last
//! ([`inside`]).
//!
//! Everything is decided by exact signs on a lattice to which corners are rounded first (2^-27 of the size of the
//! model); new points are at dyadic places on edges, exactly.
//!
//! Sources: J. R. Shewchuk, *Constrained Delaunay Tetrahedralizations and Provably Good Boundary Recovery*, 2002
//! (edges suffice); H. Si, K. Gärtner, *3D boundary recovery by constrained Delaunay tetrahedralization*, 2011;
//! L. Diazzi, D. Panozzo, A. Vaxman, M. Attene, *Constrained Delaunay Tetrahedrization: A Robust and Practical
//! Approach*, 2023 (ties broken by perturbation, cavities filled by gift wrapping).

mod facets;
mod inside;
mod recover;
mod segments;
mod touching;
mod wrap;

use glam::DVec3;
use rustc_hash::FxHashMap;
use thiserror::Error;

use super::{complex::Complex, delaunay::Delaunay, lattice::Lattice};
use crate::geom::{Bounds, PolyMesh};

/// Why a polyhedron has no tetrahedra.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum NoTetrahedra {
    /// The corners span no volume.
    #[error("all {corners} corners lie in one plane; tetrahedra need a volume")]
    Flat {
        /// How many.
        corners: usize,
    },
    /// Two parts of the boundary meet where they share no corner, or come nearer than the lattice tells apart.
    #[error(
        "the boundary crosses itself near {place}, or nearly touches itself; tetrahedra need one that does not"
    )]
    Crossing {
        /// Where, mm.
        place: DVec3,
    },
    /// More points are needed than can be held.
    #[error(
        "more than {limit} points on its edges are needed for a boundary of {corners} corners; \
         it has edges that nearly touch, near {place}"
    )]
    TooMany {
        /// The limit.
        limit: usize,
        /// Corners given.
        corners: usize,
        /// Where, mm.
        place: DVec3,
    },
    /// Floats are too coarse where the solid stands.
    #[error(
        "coordinates cannot hold the tetrahedra {distance} mm from the origin; nearer to it they can"
    )]
    Far {
        /// The largest coordinate in mm.
        distance: f64,
    },
    /// The sides of faces do not tell inside from outside.
    #[error("the boundary is open near {place}; tetrahedra need a closed one")]
    Open {
        /// Where, mm.
        place: DVec3,
    },
}

/// New points are at most this many for each corner, and some: beyond, edges nearly touch.
const NEW_POINTS: usize = 20;

/// Fills a closed polyhedron with tetrahedra. Its corners are kept, its edges may get points between.
///
/// # Errors
/// When the boundary spans no volume, is open or crosses itself, or has edges that nearly touch, or stands so far from
/// the origin that coordinates cannot hold new points.
///
/// ```
/// use glam::DVec3;
/// use katachi::kernel::{brep::primitive::cuboid, tet::constrained::tetrahedralize};
/// let solid = tetrahedralize(cuboid(DVec3::ZERO, DVec3::ONE).mesh()).unwrap();
/// assert_eq!((solid.mesh().points.len(), solid.volume()), (8, 1.0));
/// assert_eq!(solid.check(), Ok(()));
/// ```
pub fn tetrahedralize(boundary: &PolyMesh) -> Result<Complex, NoTetrahedra> {
    if boundary.is_empty() {
        return Ok(Complex::default());
    }
    let mut work = Work::begin(boundary)?;
    work.recover_segments()?;
    if work.cut_bent_facets() {
        work.recover_segments()?;
    }
    work.triangulate_facets();
    work.recover_facets()?;
    work.inside(boundary)
}

/// A tetrahedralisation on the way to hold all edges and faces of a boundary.
struct Work {
    lattice: Lattice,
    /// Places in mm of the points that were given; those added later have none.
    places: Vec<DVec3>,
    delaunay: Delaunay,
    facets: Vec<facets::Facet>,
    /// The points by which edges were split, by their ends in order of their numbers.
    splits: FxHashMap<[u32; 2], u32>,
}

impl Work {
    /// Rounds the corners and makes the Delaunay tetrahedralisation of them.
    fn begin(boundary: &PolyMesh) -> Result<Work, NoTetrahedra> {
        let lattice = Lattice::around(Bounds::of(boundary.points.iter().copied()));
        let (numbers, places) = welded(boundary, &lattice);
        let points: Vec<DVec3> = places.iter().map(|&place| lattice.point(place)).collect();
        let facets = facets::of_mesh(boundary, &numbers, &points);
        let corners = points.len();
        let delaunay = Delaunay::new(points).ok_or(NoTetrahedra::Flat { corners })?;
        Ok(Work { lattice, places, delaunay, facets, splits: FxHashMap::default() })
    }

    /// The place of a point in mm.
    fn place(&self, point: u32) -> DVec3 {
        match self.places.get(point as usize) {
            Some(&place) => place,
            None => self.lattice.place(self.delaunay.points[point as usize]),
        }
    }
}

/// The number of each point of a mesh where those that fall together on the lattice are one, and their places.
fn welded(mesh: &PolyMesh, lattice: &Lattice) -> (Vec<u32>, Vec<DVec3>) {
    let mut known: FxHashMap<[i64; 3], u32> = FxHashMap::default();
    let mut places = vec![];
    let number = |&place: &DVec3| {
        let key = lattice.point(place).to_array().map(|c| c as i64);
        *known.entry(key).or_insert_with(|| {
            places.push(place);
            places.len() as u32 - 1
        })
    };
    let numbers = mesh.points.iter().map(number).collect();
    (numbers, places)
}

/// An edge or a triangle whatever its direction.
fn sorted<const N: usize>(mut corners: [u32; N]) -> [u32; N] {
    corners.sort_unstable();
    corners
}

#[cfg(test)]
mod tests;
