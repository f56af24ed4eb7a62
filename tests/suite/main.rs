//! One test binary for everything that is tested from outside.

mod command;
mod errors;
mod eval;
mod examples;
mod floors;
mod grammar;
mod laws;
mod readers;
mod readme;
mod regressions;
mod scad;
mod sources;
