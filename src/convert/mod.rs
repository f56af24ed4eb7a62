//! Where kernels meet: solids become fields, and fields become solids.

pub mod contour;
pub mod offset;
