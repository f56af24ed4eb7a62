//! Laws and hard cases of the set operations.

mod cases;
mod oracle;
mod properties;
mod random;
mod scales;
mod solids;
mod soundness;
mod threads;
mod tiny;
mod touching;
mod wild;

pub use random::{Random, style, tree};
