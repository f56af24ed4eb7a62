//! Exact polyhedra: boundary representation by planar polygons.

mod band;
pub mod extrude;
mod flank;
pub mod measure;
pub mod polyhedron;
pub mod primitive;
pub mod revolve;

pub use polyhedron::{Defect, Polyhedron};
