//! `katachi test`: the tests that stand in a model.

use std::io::{self, Write};

use super::{Exit, args::Test, desk::Desk, fail};
use crate::{
    app::{render::Style, write::write_whole},
    base::{Code, Diagnostic},
    session::{Model, TestOutcome},
};

/// Runs the chosen tests, one line each, and reports.
pub fn run(arguments: &Test, style: Style) -> io::Result<Exit> {
    let desk = match Desk::open(&arguments.model, Some(&arguments.making), style) {
        Ok(desk) => desk,
        Err(words) => return fail(style, Exit::Usage, words),
    };
    let session = desk.session();
    let (mut model, mut diagnostics) = desk.compile(&session);
    let (mut passed, mut failed) = (0, 0);
    let mut out = io::stdout().lock();
    for (index, test) in model.tests().into_iter().enumerate() {
        if arguments.filter.as_ref().is_some_and(|text| !test.title.contains(text)) {
            continue;
        }
        let Some(mut outcome) = model.run_test(index, arguments.update) else { continue };
        update(&desk, &model, &mut outcome);
        let (count, word) =
            if outcome.passed { (&mut passed, "ok") } else { (&mut failed, "FAILED") };
        *count += 1;
        desk.watch().end_bar();
        writeln!(out, "{word:6} {}", test.title)?;
        diagnostics.extend(outcome.diagnostics);
    }
    writeln!(out, "{passed} passed, {failed} failed")?;
    let exit = desk.report(&session, &diagnostics)?;
    match (exit, failed) {
        (Exit::Ok | Exit::Model, 1..) => Ok(Exit::TestFailed),
        _ => Ok(exit),
    }
}

/// Writes the references that a test gave back, under the project's root.
fn update(desk: &Desk, model: &Model, outcome: &mut TestOutcome) {
    for write in &outcome.writes {
        let written = model.reference(write).and_then(|(path, bytes)| {
            write_whole(desk.disk.root(), &path, &bytes)
                .map_err(|words| Diagnostic::error(Code::UnwritableFile, words))
        });
        if let Err(diagnostic) = written {
            outcome.passed = false;
            outcome.diagnostics.push(diagnostic);
        }
    }
}
