//! Laws and hard cases of the set operations.

mod cases;
mod properties;
mod random;
mod solids;
mod tiny;

pub use random::Random;
