//! The application: the only floor that touches files, clocks and the terminal.

pub mod cli;
pub mod disk;
mod interrupt;
pub mod render;
pub mod stopwatch;
pub mod write;
