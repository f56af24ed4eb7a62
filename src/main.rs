//! The `katachi` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    katachi::app::cli::run()
}
