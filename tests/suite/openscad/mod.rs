//! The same solids in Katachi and in OpenSCAD.
//!
//! [`cases`] compares the folders in `tests/openscad` with the exports that stand there, so it needs no
//! OpenSCAD. [`live`] exports again and gives OpenSCAD our own sources; [`differential`] does that with
//! random models. Both are ignored unless asked for: `cargo test --release --test suite -- --ignored`.

mod cases;
mod differential;
mod facts;
mod live;
mod random;
mod tool;
