//! From text to tree: tokens, line ends, the parser, and the tree itself.
//!
//! `syntax` knows no value, no shape and no editor.

pub mod ast;
