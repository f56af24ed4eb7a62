//! The one road from a source file to results.

pub use crate::geom::Tolerance;
