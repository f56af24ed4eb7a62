//! Laws and hard cases of the set operations.

mod cases;
mod solids;
