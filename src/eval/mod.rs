//! From syntax trees to shapes and values.
//!
//! A file is resolved (names become slots), instantiated (its parameters are set), and its
//! outputs are evaluated when they are asked for. Evaluation builds nodes of the shape graph; what
//! it must know of shapes it asks a [`Host`].
//!
//! The machine stack is never used without bound: every recursion takes its stack from the heap.
//! Work and memory are counted and limited ([`Limits`]).

mod builtin;
mod dimension;
mod evaluator;
mod failure;
mod instance;
mod interpret;
pub mod library;
mod nearest;
mod outputs;
mod resolve;
mod stack;
mod testing;
mod types;
mod unit;
pub mod value;

pub use dimension::Dimension;
pub use evaluator::{Evaluator, Host, Limits, Loaded, Override};
pub use instance::InstanceId;
pub use nearest::{here_called, nearest};
pub use outputs::{Domain, ExportInfo, ExportPart, OutputInfo, ParamInfo, Product};
pub use testing::{TestInfo, TestOutcome, Write};
pub use value::Value;
