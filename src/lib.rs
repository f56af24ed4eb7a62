#![doc = "Katachi (形): a small declarative language for solid modelling."]

pub mod base;
pub mod geom;
pub mod input;
pub mod kernel;
pub mod shape;
pub mod syntax;
