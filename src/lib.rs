#![doc = "Katachi (形): a small declarative language for solid modelling."]

pub mod app;
pub mod base;
pub mod eval;
pub mod geom;
pub mod input;
pub mod kernel;
pub mod output;
pub mod realize;
pub mod session;
pub mod shape;
pub mod syntax;
