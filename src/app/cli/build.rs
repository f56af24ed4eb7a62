//! `katachi build`: meshes to files.

use std::io::{self, Write};

use super::{Exit, args::Build, desk::Desk, fail};
use crate::{
    app::{render::Style, write::write_whole},
    base::Diagnostic,
    session::Format,
};

/// Writes what was asked for, prints the path of each file written, and reports.
pub fn run(arguments: &Build, style: Style) -> io::Result<Exit> {
    let format = match arguments.format.as_deref().map(format_named).transpose() {
        Ok(format) => format,
        Err(words) => return fail(style, Exit::Usage, words),
    };
    let desk = match Desk::open(&arguments.model, Some(&arguments.making), style) {
        Ok(desk) => desk,
        Err(words) => return fail(style, Exit::Usage, words),
    };
    let session = desk.session();
    let (mut model, mut diagnostics) = match desk.compile_asked(&session, &arguments.part) {
        Ok(compiled) => compiled,
        Err(diagnostics) => return desk.report(&session, &diagnostics),
    };
    let artifacts = model.artifacts(&arguments.part, format, &mut diagnostics);
    let mut written = vec![];
    diagnostics.extend(model.build(&artifacts, &mut |artifact, bytes| {
        written.push(write_whole(&arguments.output, &artifact.file, bytes)?);
        Ok(())
    }));
    desk.watch().end_bar();
    let mut out = io::stdout().lock();
    for path in &written {
        writeln!(out, "{}", path.display())?;
    }
    if artifacts.is_empty() && !diagnostics.iter().any(Diagnostic::is_error) {
        writeln!(out, "nothing to write: the model has no output")?;
    }
    desk.report(&session, &diagnostics)
}

fn format_named(name: &str) -> Result<Format, String> {
    let words = || format!("there is no format `{name}`; the formats are {}", Format::names());
    Format::from_name(name).ok_or_else(words)
}
