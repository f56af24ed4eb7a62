//! What all kernels share: numbers, placements, surfaces and meshes. It knows no language and no kernel.

pub mod mesh;
pub mod placement;
pub mod predicates;
pub mod region;
pub mod surface;
pub mod tolerance;
pub mod wide;

pub use mesh::{FaceRef, Origin, PolyMesh};
pub use placement::Placement;
pub use region::{Contour, Region};
pub use surface::Surface;
pub use tolerance::Tolerance;
