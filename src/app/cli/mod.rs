//! The command line.

pub mod args;
mod build;
mod check;
mod desk;
mod exit;
mod measure;
mod new;
mod params;
mod test;

use std::{
    io::{self, Write},
    process::ExitCode,
};

use clap::Parser;

use self::args::{Cli, Command};
pub use self::exit::Exit;
use super::render::{self, Style};
use crate::base::{Code, Diagnostic, SourceMap};

/// Runs the command that the process was started with.
pub fn run() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            let _ = error.print();
            return ExitCode::from(error.exit_code() as u8);
        }
    };
    match dispatch(&cli) {
        Ok(exit) => exit.into(),
        // Whoever read our output has seen enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error) => {
            let _ = writeln!(io::stderr(), "error: {error}");
            Exit::Model.into()
        }
    }
}

fn dispatch(cli: &Cli) -> io::Result<Exit> {
    let style = cli.diagnostics;
    match &cli.command {
        Command::Build(arguments) => build::run(arguments, style),
        Command::Check(arguments) => check::run(arguments, style),
        Command::Test(arguments) => test::run(arguments, style),
        Command::Measure(arguments) => measure::run(arguments, style),
        Command::Params(arguments) => params::run(arguments, style),
        Command::New(arguments) => new::run(arguments, style),
    }
}

/// Reports an error that has no place in a source and ends with `exit`.
fn fail(style: Style, exit: Exit, words: impl Into<String>) -> io::Result<Exit> {
    let code = if exit == Exit::Usage { Code::Usage } else { Code::UnwritableFile };
    render::report(style, &SourceMap::default(), &[Diagnostic::error(code, words)])?;
    Ok(exit)
}
