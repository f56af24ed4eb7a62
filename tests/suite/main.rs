//! One test binary for everything that is tested from outside.

mod broken;
mod command;
mod drawing;
mod errors;
mod eval;
mod examples;
mod fields;
mod floors;
mod formats;
mod golden;
mod grammar;
mod halftone;
mod laws;
mod level_sets;
mod made;
mod openscad;
mod random;
mod readers;
mod readme;
mod regressions;
mod scad;
mod sheets;
mod sources;
mod stretch;
mod sweeps;
