//! Exact polyhedra: boundary representation by planar polygons.

mod band;
pub mod boolean;
mod closing;
pub mod crossing;
pub mod distance;
pub mod extrude;
pub mod faces;
mod flank;
pub mod hull;
pub mod measure;
pub mod polyhedron;
pub mod primitive;
pub mod resolution;
pub mod revolve;
mod ridge;
mod separation;
pub mod sheet;
pub mod sweep;
mod threads;

pub use polyhedron::{Defect, Polyhedron};
