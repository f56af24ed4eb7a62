//! How the command ends.

use std::process::ExitCode;

use crate::base::{Code, Diagnostic};

/// The exit codes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Exit {
    /// All went well.
    Ok = 0,
    /// The model has an error, or a file could not be written.
    Model = 1,
    /// The command line is wrong.
    Usage = 2,
    /// A test failed.
    TestFailed = 3,
    /// A limit of steps, memory or triangles was hit.
    Limit = 5,
}

impl Exit {
    /// The gravest that diagnostics ask for.
    pub fn of(diagnostics: &[Diagnostic]) -> Exit {
        let errors = diagnostics.iter().filter(|d| d.is_error());
        let exits = errors.map(|d| match d.code {
            Code::Usage => Exit::Usage,
            Code::Limit => Exit::Limit,
            _ => Exit::Model,
        });
        exits.max().unwrap_or(Exit::Ok)
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit as u8)
    }
}
