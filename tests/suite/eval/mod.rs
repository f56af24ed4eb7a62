//! Evaluation, tested from outside with a host of string literals.

mod host;
mod library;
mod mutants;
mod refusals;
mod shapes;
mod values;
