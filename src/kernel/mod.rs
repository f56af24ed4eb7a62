//! The kernels: siblings that do not know each other.

pub mod brep;
pub mod field;
pub mod profile;
pub mod tet;
