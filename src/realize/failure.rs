//! Kernel errors become diagnostics: a code, and the place of the call that asked for the shape.

use std::fmt::Display;

use crate::{
    base::{Code, Diagnostic, Label, Span},
    shape::GeometryError,
};

/// A result of this floor.
pub type Made<T> = Result<T, GeometryError>;

/// An error that knows what kind of diagnostic it is. Its words are the message.
pub trait Coded: Display {
    /// The kind.
    fn code(&self) -> Code;

    /// What to do about it, where that is known.
    fn help(&self) -> Option<String> {
        None
    }
}

/// Puts the place in the source on an error of a kernel.
pub trait At<T>: Sized {
    /// The same result; an error is a diagnostic that has no place yet.
    fn unplaced(self) -> Made<T>;

    /// The same result; an error is a diagnostic at `origin`.
    fn at(self, origin: Span) -> Made<T> {
        self.unplaced().map_err(|mut error| {
            error.diagnostic.labels.push(Label { span: origin, message: String::new() });
            error
        })
    }
}

impl<T, E: Coded> At<T> for Result<T, E> {
    fn unplaced(self) -> Made<T> {
        self.map_err(|error| {
            let mut diagnostic = Diagnostic::error(error.code(), error.to_string());
            diagnostic.help = error.help();
            failure(diagnostic)
        })
    }
}

/// A diagnostic as this floor's error.
pub fn failure(diagnostic: Diagnostic) -> GeometryError {
    GeometryError { diagnostic: Box::new(diagnostic) }
}
