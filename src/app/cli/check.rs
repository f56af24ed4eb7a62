//! `katachi check`: mistakes that show without geometry.

use std::io;

use super::{Exit, args::Check, desk::Desk, fail};
use crate::app::render::Style;

/// Evaluates everything that needs no geometry and reports.
pub fn run(arguments: &Check, style: Style) -> io::Result<Exit> {
    let desk = match Desk::open(&arguments.model, None, style) {
        Ok(desk) => desk,
        Err(words) => return fail(style, Exit::Usage, words),
    };
    let session = desk.session();
    let (mut model, mut diagnostics) = desk.compile(&session);
    diagnostics.extend(model.check(&[]));
    desk.report(&session, &diagnostics)
}
