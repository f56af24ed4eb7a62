//! What leaves: mesh files and OpenSCAD source. Everything here returns bytes or text; only the app
//! touches files.

pub mod mesh;
pub mod number;
pub mod scad;
