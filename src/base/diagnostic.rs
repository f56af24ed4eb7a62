//! What the modeller is told, as plain data. Rendering is the application's business.

use super::{code::Code, span::Span};

/// How grave it is.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Severity {
    /// The thing asked for cannot be made.
    Error,
    /// It was made, but is perhaps not what was meant.
    Warning,
}

/// A place and what is to be said about it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Label {
    /// The characters to underline.
    pub span: Span,
    /// A few words beside the underline; may be empty.
    pub message: String,
}

/// A replacement that would mend the cause.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Fix {
    /// The characters to replace.
    pub span: Span,
    /// What to put there.
    pub replacement: String,
}

/// One message to the modeller: what was found, what is needed, and where.
///
/// The first label is the primary place.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Diagnostic {
    /// How grave it is.
    pub severity: Severity,
    /// The stable name of this kind of message.
    pub code: Code,
    /// One sentence in plain words, without a full stop.
    pub message: String,
    /// The places it speaks of, the primary one first.
    pub labels: Vec<Label>,
    /// Facts that help to understand it.
    pub notes: Vec<String>,
    /// What to do about it.
    pub help: Option<String>,
    /// The edit that does it, where one is certain enough.
    pub fix: Option<Fix>,
}

impl Diagnostic {
    /// An error of the given kind.
    pub fn error(code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(Severity::Error, code, message.into())
    }

    /// A warning of the given kind.
    pub fn warning(code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(Severity::Warning, code, message.into())
    }

    fn new(severity: Severity, code: Code, message: String) -> Diagnostic {
        Diagnostic { severity, code, message, labels: vec![], notes: vec![], help: None, fix: None }
    }

    /// Adds a place; the first one added is the primary place.
    pub fn label(mut self, span: Span, message: impl Into<String>) -> Diagnostic {
        self.labels.push(Label { span, message: message.into() });
        self
    }

    /// Adds a fact.
    pub fn note(mut self, note: impl Into<String>) -> Diagnostic {
        self.notes.push(note.into());
        self
    }

    /// Says what to do.
    pub fn help(mut self, help: impl Into<String>) -> Diagnostic {
        self.help = Some(help.into());
        self
    }

    /// Adds the edit that mends it.
    pub fn fix(mut self, span: Span, replacement: impl Into<String>) -> Diagnostic {
        self.fix = Some(Fix { span, replacement: replacement.into() });
        self
    }

    /// The primary place, if any is known.
    pub fn span(&self) -> Option<Span> {
        self.labels.first().map(|label| label.span)
    }

    /// Whether this is an error.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}
