//! How evaluation stops: a diagnostic on its way to whoever asked for the value.

use std::sync::Arc;

use crate::base::{Code, Diagnostic, Span};

/// Why there is no value. Cheap to clone: a failed definition gives it to everyone who asks.
#[derive(Clone, Debug)]
pub struct Failure(Option<Arc<Diagnostic>>);

/// A value, or why there is none.
pub type Outcome<T> = Result<T, Failure>;

impl Failure {
    /// The modeller has been told already (a syntax error), or need not be.
    pub const TOLD: Failure = Failure(None);

    /// The message, unless it has been given already.
    pub fn diagnostic(&self) -> Option<&Diagnostic> {
        self.0.as_deref()
    }

    /// The same failure with another diagnostic made of its own.
    pub fn map(self, change: impl FnOnce(Diagnostic) -> Diagnostic) -> Failure {
        match self.0 {
            None => Failure(None),
            Some(shared) => change(Arc::unwrap_or_clone(shared)).into(),
        }
    }
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Failure {
        Failure(Some(Arc::new(diagnostic)))
    }
}

/// Stops with an error at one place.
pub fn fail<T>(code: Code, span: Span, message: impl Into<String>) -> Outcome<T> {
    Err(Diagnostic::error(code, message).label(span, "").into())
}
