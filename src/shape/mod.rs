//! The shape graph: what evaluation builds and realisation turns into solids.
//!
//! Pure data. Nodes are immutable and hash-consed: equal construction gives the same
//! [`ShapeId`], so that equality is an integer comparison and results can be kept by node.

pub mod drawing;
mod fingerprint;
pub mod geometry;
pub mod graph;
pub mod halftone;
pub mod node;
mod stretched;
pub mod sweep;

pub use drawing::{CurveSpec, PageSpec, ViewSpec};
pub use geometry::{Geometry, GeometryError, Measures};
pub use graph::ShapeGraph;
pub use halftone::ShadeSpec;
pub use node::{Kind, Node, ShapeId, SphereTest};
pub use stretched::Stretched;
pub use sweep::{SweepAlong, SweepBetween, SweptSurface};
