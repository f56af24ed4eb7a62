//! One test binary for everything that is tested from outside.

mod floors;
mod grammar;
mod scad;
mod sources;
