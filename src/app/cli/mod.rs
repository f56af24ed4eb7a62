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
mod view;

use std::{
    ffi::OsString,
    io::{self, Write},
    process::ExitCode,
};

use clap::{Parser, ValueEnum};

use self::args::{Cli, Command};
pub use self::exit::Exit;
use super::render::{self, Style};
use crate::base::{Code, Diagnostic, SourceMap};

/// Runs the command that the process was started with.
pub fn run() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return refuse(&error),
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

/// Help or version on standard output; a wrong use in the style that the arguments ask for.
fn refuse(error: &clap::Error) -> ExitCode {
    let style = style_asked(std::env::args_os());
    if !error.use_stderr() || style == Style::Human {
        let _ = error.print();
        return ExitCode::from(error.exit_code() as u8);
    }
    let text = error.render().to_string();
    let words = text.lines().next().unwrap_or_default();
    let words = words.strip_prefix("error: ").unwrap_or(words);
    fail(style, Exit::Usage, words).unwrap_or(Exit::Usage).into()
}

/// The last style named by `--diagnostics` in arguments that cannot be understood as a whole.
fn style_asked(arguments: impl Iterator<Item = OsString>) -> Style {
    let arguments: Vec<OsString> = arguments.collect();
    let pairs = arguments.windows(2).filter(|pair| pair[0] == "--diagnostics");
    let apart = pairs.filter_map(|pair| pair[1].to_str());
    let joined = arguments.iter().filter_map(|a| a.to_str()?.strip_prefix("--diagnostics="));
    let mut named = apart.chain(joined).filter_map(|name| Style::from_str(name, false).ok());
    named.next_back().unwrap_or_default()
}

fn dispatch(cli: &Cli) -> io::Result<Exit> {
    let style = cli.diagnostics;
    match &cli.command {
        Command::Build(arguments) => build::run(arguments, style),
        Command::Check(arguments) => check::run(arguments, style),
        Command::Test(arguments) => test::run(arguments, style),
        Command::Measure(arguments) => measure::run(arguments, style),
        Command::Params(arguments) => params::run(arguments, style),
        Command::View(arguments) => view::run(arguments, style),
        Command::New(arguments) => new::run(arguments, style),
    }
}

/// Reports an error that has no place in a source and ends with `exit`.
fn fail(style: Style, exit: Exit, words: impl Into<String>) -> io::Result<Exit> {
    let code = if exit == Exit::Usage { Code::Usage } else { Code::UnwritableFile };
    render::report(style, &SourceMap::default(), &[Diagnostic::error(code, words)])?;
    Ok(exit)
}
