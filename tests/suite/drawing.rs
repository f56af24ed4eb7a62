//! Drawings of scenes whose line lengths are known.

mod cases;
mod figures;
mod rays;
mod scenes;
