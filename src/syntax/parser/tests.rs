//! The parser on whole texts.

use super::*;

fn words(text: &str) -> Vec<String> {
    let (_, diagnostics) = parse(SourceId(0), text);
    diagnostics
        .iter()
        .map(|d| {
            let span = d.span().unwrap();
            format!("{} `{}`", d.message, &text[span.start as usize..span.end as usize])
        })
        .collect()
}

#[test]
fn the_language_by_example_has_no_error() {
    assert_eq!(words(include_str!("../../../tests/grammar/language.kata")), [""; 0]);
    assert_eq!(words(include_str!("../../../tests/grammar/program.kata")), [""; 0]);
}
