//! Drawings of scenes whose line lengths are known.

mod cases;
mod edge_on;
mod facets;
mod figures;
mod grids;
mod language;
mod overdraw;
mod rays;
mod scenes;
mod sights;
mod solids;
