//! What leaves: mesh files, tetrahedra for analysis, OpenSCAD source, drawings, half-tones and the sheets they stand on. Everything here returns bytes or
//! text; only the app touches files.

pub mod drawing;
pub mod elements;
pub mod halftone;
pub mod mesh;
pub mod number;
pub mod pixels;
pub mod scad;
pub mod sheet;
