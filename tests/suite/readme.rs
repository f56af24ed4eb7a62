//! The README is true: its models build and pass their tests, its commands name things that exist.

use std::path::Path;

use katachi::{
    base::{Shelf, watch::Unwatched},
    session::Session,
};

const README: &str = include_str!("../../README.md");

/// The code blocks of one language.
fn blocks(language: &str) -> Vec<&'static str> {
    let fence = format!("```{language}\n");
    let starts = README.split(fence.as_str()).skip(1);
    starts.map(|rest| rest.split("```").next().unwrap_or("")).collect()
}

#[test]
fn its_models_are_closed_and_pass_their_tests() {
    let models = blocks("kata");
    assert!(!models.is_empty());
    for text in models {
        let files = [("model.kata", text)];
        let shelf = Shelf(&files);
        let session = Session::new(&shelf, &Unwatched, None);
        let (mut model, diagnostics) = session.compile("model.kata", &[]);
        assert!(diagnostics.is_empty(), "{diagnostics:?}");
        let measured = model.measure(&[]);
        assert!(!measured.found.is_empty());
        assert!(measured.found.iter().all(|(_, m)| m.closed && m.volume > 0.0));
        for index in 0..model.tests().len() {
            let outcome = model.run_test(index, false).expect("a test of that number");
            assert!(outcome.passed, "{:?}", outcome.diagnostics);
        }
    }
}

#[test]
fn what_it_links_to_exists() {
    let links = README.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let pictures = README.split("src=\"").skip(1).filter_map(|rest| rest.split('"').next());
    for target in links.chain(pictures) {
        assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join(target).exists(), "{target}");
    }
}

#[test]
fn the_gate_runs_the_very_test_command_it_gives() {
    let commands = blocks("sh")[0];
    let gate = include_str!("../../.ci/run");
    let test =
        commands.lines().find(|line| line.starts_with("cargo test")).expect("a test command");
    let test = test.split('#').next().unwrap_or("").trim();
    assert!(gate.lines().any(|line| line.trim() == test), "{test}");
    assert!(commands.contains("examples/bracket.kata"));
}
