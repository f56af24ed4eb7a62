//! One test binary for everything that is tested from outside.

mod command;
mod errors;
mod eval;
mod examples;
mod floors;
mod golden;
mod grammar;
mod laws;
mod readers;
mod readme;
mod scad;
mod sources;
