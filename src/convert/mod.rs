//! Where kernels meet: solids become fields, and offsets of fields become solids.

pub mod offset;
