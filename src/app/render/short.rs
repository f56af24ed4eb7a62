//! One line a diagnostic, as compilers write them, for editors and `grep`.

use std::io::{self, Write};

use super::severity;
use crate::base::{Diagnostic, SourceMap};

/// Writes `path:line:column: error[code]: message; help: ...`; the place is left out where none is
/// known, and so is the help.
pub fn write(out: &mut impl Write, sources: &SourceMap, diagnostic: &Diagnostic) -> io::Result<()> {
    let place = diagnostic.span().and_then(|span| Some((span, sources.get(span.source)?)));
    if let Some((span, source)) = place {
        let (line, column) = sources.line_column(span.source, span.start);
        write!(out, "{}:{line}:{column}: ", source.path)?;
    }
    let message = one_line(&diagnostic.message);
    write!(out, "{}[{}]: {message}", severity(diagnostic), diagnostic.code)?;
    if let Some(help) = &diagnostic.help {
        write!(out, "; help: {}", one_line(help))?;
    }
    writeln!(out)
}

fn one_line(text: &str) -> String {
    text.replace('\n', " ")
}
