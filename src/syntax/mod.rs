//! From text to tree: tokens, line ends, the parser, and the tree itself.
//!
//! `syntax` knows no value, no shape and no editor.

pub mod ast;
mod bracket;
mod decode;
mod depth;
mod foreign;
pub mod lexer;
mod newline;
pub mod number;
mod parser;
mod text;
pub mod token;

pub use decode::{MAX_BYTES, decode};
pub use parser::{Production, parse, productions};
