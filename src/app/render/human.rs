//! Diagnostics with their source lines, drawn by ariadne.

use std::{
    io::{self, Write},
    ops::Range,
    sync::Arc,
};

use ariadne::{Color, Config, IndexType, Label, Report, ReportKind};

use crate::base::{Diagnostic, SourceMap, Span};

/// Writes one diagnostic with the lines it speaks of.
pub fn write(
    out: &mut impl Write,
    color: bool,
    sources: &SourceMap,
    diagnostic: &Diagnostic,
) -> io::Result<()> {
    let Some(primary) = diagnostic.span().filter(|span| sources.get(span.source).is_some()) else {
        return write_without_place(out, diagnostic);
    };
    let (kind, tint) = match diagnostic.is_error() {
        true => (ReportKind::Error, Color::Red),
        false => (ReportKind::Warning, Color::Yellow),
    };
    let labels = diagnostic.labels.iter().enumerate().map(|(i, label)| {
        let tint = if i == 0 { tint } else { Color::Blue };
        Label::new(located(sources, label.span)).with_message(&label.message).with_color(tint)
    });
    let mut report = Report::build(kind, located(sources, primary))
        .with_config(Config::default().with_index_type(IndexType::Byte).with_color(color))
        .with_code(diagnostic.code)
        .with_message(&diagnostic.message)
        .with_labels(labels);
    report.with_notes(&diagnostic.notes);
    report.with_helps(&diagnostic.help);
    let texts = texts(sources, diagnostic);
    report.finish().write(ariadne::sources(texts), &mut *out)
}

fn write_without_place(out: &mut impl Write, diagnostic: &Diagnostic) -> io::Result<()> {
    let severity = if diagnostic.is_error() { "Error" } else { "Warning" };
    writeln!(out, "[{}] {severity}: {}", diagnostic.code, diagnostic.message)?;
    for note in &diagnostic.notes {
        writeln!(out, "    Note: {note}")?;
    }
    diagnostic.help.iter().try_for_each(|help| writeln!(out, "    Help: {help}"))
}

/// A span as ariadne wants it; an empty one is widened to the character after it, so that something
/// is underlined.
fn located(sources: &SourceMap, span: Span) -> (Arc<str>, Range<usize>) {
    let Some(source) = sources.get(span.source) else { return (Arc::from(""), 0..0) };
    let size = source.text.len();
    let start = (span.start as usize).min(size);
    let mut end = (span.end as usize).clamp(start, size);
    if start == end {
        end += source.text[start..].chars().next().map_or(0, char::len_utf8);
    }
    (source.path.clone(), start..end)
}

/// The texts the diagnostic speaks of.
fn texts(sources: &SourceMap, diagnostic: &Diagnostic) -> Vec<(Arc<str>, Arc<str>)> {
    let spoken_of = |id| diagnostic.labels.iter().any(|label| label.span.source == id);
    let texts = sources.iter().filter(|(id, _)| spoken_of(*id));
    texts.map(|(_, source)| (source.path.clone(), source.text.clone())).collect()
}
