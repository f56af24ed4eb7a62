//! Solids as tetrahedra that know their neighbours.

use std::sync::OnceLock;

use rustc_hash::FxHashMap;
use thiserror::Error;

use crate::geom::{Bounds, TetMesh, bvh::Bvh, orient::orient3d};

/// The corners of the face opposite to each corner of a tetrahedron, counter-clockwise seen from outside.
pub const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// What is on the other side of a tetrahedron's face.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Across {
    /// The tetrahedron of this number, entered by its face opposite to this corner.
    Tetrahedron(u32, u8),
    /// The outside, through the boundary triangle of this number.
    Outside(u32),
}

/// What is wrong with a complex.
#[derive(Clone, PartialEq, Eq, Debug, Error)]
pub enum ComplexDefect {
    /// A face has not one partner.
    #[error(
        "the face of points {corners:?} belongs to {count} tetrahedra and boundary triangles; it needs exactly 2"
    )]
    Unmatched {
        /// Point numbers in order.
        corners: [u32; 3],
        /// How many have it.
        count: usize,
    },
    /// Two neighbours do not name each other.
    #[error(
        "tetrahedron {tetrahedron} and what is across its corner {corner} do not name each other"
    )]
    Astray {
        /// Which.
        tetrahedron: u32,
        /// Opposite to the face.
        corner: u8,
    },
    /// A tetrahedron is turned inside out.
    #[error(
        "tetrahedron {tetrahedron} has a negative volume; it needs a positive one, or exactly none"
    )]
    Inverted {
        /// Which.
        tetrahedron: u32,
    },
}

/// A solid as tetrahedra whose faces are matched with a neighbour's or lie on the boundary. Lengths in mm.
#[derive(Clone, Debug, Default)]
pub struct Complex {
    mesh: TetMesh,
    across: Vec<[Across; 4]>,
    hierarchy: OnceLock<Bvh>,
}

impl Complex {
    /// A complex of a mesh and what is across the face opposite to each corner of each tetrahedron.
    pub(super) fn new(mesh: TetMesh, across: Vec<[Across; 4]>) -> Complex {
        Complex { mesh, across, hierarchy: OnceLock::new() }
    }

    /// What it was made of.
    pub(super) fn into_parts(self) -> (TetMesh, Vec<[Across; 4]>) {
        (self.mesh, self.across)
    }

    /// The tetrahedra and the boundary.
    pub fn mesh(&self) -> &TetMesh {
        &self.mesh
    }

    /// What is across the face of a tetrahedron opposite to a corner.
    pub fn across(&self, tetrahedron: u32, corner: usize) -> Across {
        self.across[tetrahedron as usize][corner]
    }

    /// A hierarchy of the boxes of the tetrahedra, made when it is asked for first.
    pub(super) fn hierarchy(&self) -> &Bvh {
        self.hierarchy.get_or_init(|| {
            let boxes = (0..self.mesh.tetrahedra.len()).map(|t| Bounds::of(self.mesh.corners(t)));
            Bvh::new(&boxes.collect::<Vec<_>>())
        })
    }

    /// Six times the volume, rounded, with its exact sign: 0 for a flat tetrahedron.
    pub(super) fn sign_of(&self, tetrahedron: usize) -> f64 {
        let [a, b, c, d] = self.mesh.corners(tetrahedron);
        -orient3d(a, b, c, d)
    }

    /// How many tetrahedra are exactly flat.
    pub fn flat_count(&self) -> usize {
        (0..self.mesh.tetrahedra.len()).filter(|&t| self.sign_of(t) == 0.0).count()
    }

    /// Whether every face is matched, neighbours name each other, and no volume is negative, all exactly.
    ///
    /// # Errors
    /// The first defect found.
    pub fn check(&self) -> Result<(), ComplexDefect> {
        self.check_matches()?;
        for tetrahedron in 0..self.mesh.tetrahedra.len() as u32 {
            self.check_neighbours(tetrahedron)?;
        }
        self.check_volumes()
    }

    /// Whether no tetrahedron has a negative volume, exactly.
    pub(super) fn check_volumes(&self) -> Result<(), ComplexDefect> {
        match (0..self.mesh.tetrahedra.len()).find(|&t| self.sign_of(t) < 0.0) {
            Some(t) => Err(ComplexDefect::Inverted { tetrahedron: t as u32 }),
            None => Ok(()),
        }
    }

    fn check_matches(&self) -> Result<(), ComplexDefect> {
        let mut counts: FxHashMap<[u32; 3], usize> = FxHashMap::default();
        let inner = self.mesh.tetrahedra.iter().flat_map(|t| FACES.map(|face| face.map(|i| t[i])));
        for mut corners in inner.chain(self.mesh.boundary.iter().map(|triangle| triangle.corners)) {
            corners.sort_unstable();
            *counts.entry(corners).or_default() += 1;
        }
        let wrong = counts.into_iter().filter(|&(_, count)| count != 2).min();
        wrong.map_or(Ok(()), |(corners, count)| Err(ComplexDefect::Unmatched { corners, count }))
    }

    fn check_neighbours(&self, tetrahedron: u32) -> Result<(), ComplexDefect> {
        for corner in 0..4 {
            let face = self.face(tetrahedron, corner);
            let agrees = match self.across(tetrahedron, corner) {
                Across::Tetrahedron(there, opposite) => {
                    self.across(there, opposite.into())
                        == Across::Tetrahedron(tetrahedron, corner as u8)
                        && same_triangle(face, self.face(there, opposite.into()))
                }
                Across::Outside(number) => {
                    same_triangle(face, self.mesh.boundary[number as usize].corners)
                }
            };
            if !agrees {
                return Err(ComplexDefect::Astray { tetrahedron, corner: corner as u8 });
            }
        }
        Ok(())
    }

    /// The corners of the face opposite to a corner, counter-clockwise seen from outside the tetrahedron.
    pub fn face(&self, tetrahedron: u32, corner: usize) -> [u32; 3] {
        FACES[corner].map(|i| self.mesh.tetrahedra[tetrahedron as usize][i])
    }
}

/// Whether two triangles have the same corners.
fn same_triangle(a: [u32; 3], b: [u32; 3]) -> bool {
    a.iter().all(|corner| b.contains(corner))
}
