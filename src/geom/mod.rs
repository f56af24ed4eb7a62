//! What all kernels share: numbers, placements, surfaces and meshes. It knows no language and no kernel.

pub mod bounds;
pub mod bvh;
pub mod charge;
pub mod curved_grid;
pub mod flatten;
pub mod formula;
pub mod mesh;
pub mod nearest;
pub mod orient;
pub mod outline;
pub mod overlay;
pub mod parity;
pub mod placement;
pub mod predicates;
pub mod raster;
pub mod region;
pub mod sides;
pub mod spherical_projection;
pub mod stretch;
pub mod sum;
pub mod surface;
pub mod tolerance;
pub mod triangulate;
pub mod trig;
pub mod wide;

pub use bounds::Bounds;
pub use charge::{Charge, Falloff};
pub use curved_grid::{CurvedGrid, GridError};
pub use formula::Formula;
pub use mesh::{FaceRef, Origin, PolyMesh};
pub use placement::Placement;
pub use raster::Raster;
pub use region::{Contour, EdgeCurve, Piece, Region};
pub use stretch::Stretch;
pub use surface::Surface;
pub use tolerance::Tolerance;
