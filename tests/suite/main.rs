//! One test binary for everything that is tested from outside.

mod eval;
mod floors;
mod grammar;
