//! What leaves: mesh files, OpenSCAD source and drawings. Everything here returns bytes or text; only the app
//! touches files.

pub mod drawing;
pub mod mesh;
pub mod number;
pub mod scad;
