//! One test binary for everything that is tested from outside.

mod eval;
mod floors;
mod scad;
mod sources;
mod laws;
mod grammar;
mod readers;
