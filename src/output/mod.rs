//! What leaves: mesh files, OpenSCAD source, drawings and the sheets they stand on. Everything here returns bytes or
//! text; only the app touches files.

pub mod drawing;
pub mod mesh;
pub mod number;
pub mod scad;
pub mod sheet;
