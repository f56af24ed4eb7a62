//! The kernels: siblings that do not know each other.

pub mod brep;
pub mod profile;
