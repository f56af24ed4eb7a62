//! Drawings of scenes whose line lengths are known.

mod figures;
mod rays;
mod scenes;
