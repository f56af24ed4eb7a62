//! Ground floor: places in source text, diagnostics as plain data, and the one door to files.
//!
//! Nothing here knows the language, a shape or a kernel.

pub mod code;
pub mod diagnostic;
pub mod path;
pub mod source;
pub mod span;
pub mod watch;
pub mod world;

pub use code::Code;
pub use diagnostic::{Diagnostic, Fix, Label, Severity};
pub use source::{Source, SourceMap};
pub use span::{SourceId, Span};
pub use watch::{Phase, Watch};
pub use world::{FileError, Shelf, World};
