//! Diagnostics as text: for people, for `grep`, for programs.

mod human;
mod json;
mod short;

use std::io::{self, IsTerminal, Write};

use crate::base::{Diagnostic, SourceMap};

/// So many diagnostics are drawn for people; the rest are counted. Nobody reads more.
const MOST_DRAWN: usize = 50;

/// How diagnostics are written.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, clap::ValueEnum)]
pub enum Style {
    /// With the source lines and underlines.
    #[default]
    Human,
    /// One line each: `path:line:column: error[code]: message; help: ...`.
    Short,
    /// One JSON object a line.
    Json,
}

/// Writes diagnostics to standard error; colours only on a terminal that wants them.
pub fn report(style: Style, sources: &SourceMap, diagnostics: &[Diagnostic]) -> io::Result<()> {
    let mut err = io::stderr().lock();
    let color = err.is_terminal() && std::env::var_os("NO_COLOR").is_none();
    err.write_all(&rendered(style, color, sources, diagnostics)?)
}

/// The text of diagnostics.
fn rendered(
    style: Style,
    color: bool,
    sources: &SourceMap,
    diagnostics: &[Diagnostic],
) -> io::Result<Vec<u8>> {
    let mut text = vec![];
    let most = if style == Style::Human { MOST_DRAWN } else { usize::MAX };
    for diagnostic in diagnostics.iter().take(most) {
        match style {
            Style::Human => human::write(&mut text, color, sources, diagnostic)?,
            Style::Short => short::write(&mut text, sources, diagnostic)?,
            Style::Json => json::write(&mut text, sources, diagnostic)?,
        }
    }
    if diagnostics.len() > most {
        let (more, hint) = (diagnostics.len() - most, "--diagnostics short shows all");
        writeln!(text, "... and {more} more; {hint}")?;
    }
    Ok(text)
}

/// `error` or `warning`.
fn severity(diagnostic: &Diagnostic) -> &'static str {
    if diagnostic.is_error() { "error" } else { "warning" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::{Code, Span};

    fn example() -> (SourceMap, Diagnostic) {
        let mut sources = SourceMap::default();
        let id = sources.add("lid.kata", "形 = 2\nbox(1, radius = 5)\n");
        let diagnostic = Diagnostic::error(Code::UnknownArgument, "no parameter `radius`")
            .label(Span::new(id, 15, 21), "not a parameter of box")
            .help("did you mean `r`?")
            .fix(Span::new(id, 15, 21), "r");
        (sources, diagnostic)
    }

    #[test]
    fn people_are_not_flooded() {
        let (sources, diagnostic) = example();
        let many = vec![diagnostic; MOST_DRAWN + 7];
        let text = rendered(Style::Human, false, &sources, &many).expect("a vector is writable");
        assert!(String::from_utf8(text).expect("text").contains("and 7 more"));
    }

    fn text(style: Style) -> String {
        let (sources, diagnostic) = example();
        let text = rendered(style, false, &sources, &[diagnostic]).expect("a vector is writable");
        String::from_utf8(text).expect("text")
    }

    #[test]
    fn a_short_line_names_the_place_and_the_code() {
        assert_eq!(
            text(Style::Short),
            "lid.kata:2:8: error[unknown-argument]: no parameter `radius`; help: did you mean `r`?\n"
        );
    }

    #[test]
    fn a_json_line_has_bytes_lines_and_columns() {
        let value: serde_json::Value = serde_json::from_str(&text(Style::Json)).expect("JSON");
        let place = &value["labels"][0];
        assert_eq!((&place["line"], &place["column"]), (&2.into(), &8.into()));
        assert_eq!((&place["start"], &place["end"]), (&15.into(), &21.into()));
        assert_eq!((&value["path"], &value["line"]), (&"lid.kata".into(), &2.into()));
        assert_eq!(value["fix"]["replacement"], "r");
        assert_eq!(value["code"], "unknown-argument");
    }

    #[test]
    fn people_see_the_line_underlined() {
        let text = text(Style::Human);
        for part in ["Error", "lid.kata:2:8", "box(1, radius = 5)", "not a parameter", "r`?"] {
            assert!(text.contains(part), "{part} is missing in\n{text}");
        }
        assert!(!text.contains('\u{1b}'), "no escape codes off a terminal");
    }
}
