//! Tetrahedral solids: every point of the inside has an address.
//!
//! A solid is a set of tetrahedra whose faces are all matched with a neighbour's face or lie on the boundary. That
//! gives what a boundary alone does not: walking from one point to another through the inside, sums over elements
//! of volume, and meshes for analysis.
//!
//! # Paper
//! Y. Arakawa, solids of tetrahedra with closed adjacency (METHODS, section 2).
//!
//! | here | there |
//! |---|---|
//! | [`Complex`](complex::Complex) | the set of tetrahedra with its neighbourhood |
//! | [`check`](complex::Complex::check) | coherence: every face is matched |
//! | [`Walk`](walk::Walk) | address: which tetrahedron holds a point |
//!
//! ```
//! use glam::DVec3;
//! use katachi::kernel::{brep::primitive::cuboid, tet::{constrained::tetrahedralize, walk::Walk}};
//! let solid = tetrahedralize(cuboid(DVec3::ZERO, DVec3::splat(2.0)).mesh()).unwrap();
//! assert_eq!((solid.mesh().tetrahedra.len(), solid.volume()), (6, 8.0));
//! assert!(Walk::new(&solid).locate(DVec3::ONE).is_some());
//! ```

pub mod complex;
pub mod constrained;
mod delaunay;
mod lattice;
pub mod measure;
pub mod quality;
mod sphere;
pub mod walk;
