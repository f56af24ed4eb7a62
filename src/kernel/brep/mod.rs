//! Exact polyhedra: boundary representation by planar polygons.

pub mod boolean;
pub mod polyhedron;

pub use polyhedron::{Defect, Polyhedron};
