//! Laws and hard cases of the set operations.

mod cases;
mod oracle;
mod properties;
mod random;
mod scales;
mod solids;
mod soundness;
mod tiny;
mod wild;

pub use random::Random;
