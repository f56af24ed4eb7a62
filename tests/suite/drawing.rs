//! Drawings of scenes whose line lengths are known.

mod cases;
mod edge_on;
mod figures;
mod language;
mod rays;
mod scenes;
mod sights;
