//! Exact polyhedra: boundary representation by planar polygons.

mod band;
pub mod polyhedron;
pub mod primitive;

pub use polyhedron::{Defect, Polyhedron};
