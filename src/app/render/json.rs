//! One JSON object a line, for programs.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::severity;
use crate::base::{Diagnostic, SourceMap, Span};

/// Writes one diagnostic as `{severity, code, message, path, line, column, labels, notes, help, fix}`. A
/// label and a fix have `path`, `line`, `column`, `end_line`, `end_column` (from 1, columns in characters)
/// and `start`, `end` (bytes, from 0). The first label is the primary place, whose path, line and column
/// stand outside too; they are null where no place is known.
pub fn write(out: &mut impl Write, sources: &SourceMap, diagnostic: &Diagnostic) -> io::Result<()> {
    let labels = diagnostic.labels.iter().map(|l| placed(sources, l.span, "message", &l.message));
    let fix = diagnostic.fix.as_ref();
    let place = diagnostic.span().filter(|span| sources.get(span.source).is_some());
    let line_column = place.map(|span| sources.line_column(span.source, span.start));
    let path = place.and_then(|span| Some(&*sources.get(span.source)?.path));
    let object = json!({
        "severity": severity(diagnostic),
        "code": diagnostic.code.name(),
        "message": diagnostic.message,
        "path": path,
        "line": line_column.map(|(line, _)| line),
        "column": line_column.map(|(_, column)| column),
        "labels": labels.collect::<Vec<_>>(),
        "notes": diagnostic.notes,
        "help": diagnostic.help,
        "fix": fix.map(|f| placed(sources, f.span, "replacement", &f.replacement)),
    });
    writeln!(out, "{object}")
}

fn placed(sources: &SourceMap, span: Span, key: &str, text: &str) -> Value {
    let (line, column) = sources.line_column(span.source, span.start);
    let (end_line, end_column) = sources.line_column(span.source, span.end);
    let path = sources.get(span.source).map(|source| &*source.path);
    json!({
        "path": path, "line": line, "column": column,
        "end_line": end_line, "end_column": end_column,
        "start": span.start, "end": span.end, key: text,
    })
}
