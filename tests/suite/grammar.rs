//! The grammar people read and the parser stay in step: same productions, each with a sample.

use std::{collections::BTreeSet, fs, path::Path};

use katachi::{
    base::SourceId,
    syntax::{Production, parse, productions},
};

fn read(path: impl AsRef<Path>) -> String {
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.as_ref().display()))
}

/// The text without `(* comments *)`.
fn without_comments(text: &str) -> String {
    let parts = text.split("(*").map(|part| part.rsplit("*)").next().unwrap_or(""));
    parts.collect()
}

/// The productions of the grammar file: name and right side.
fn grammar() -> Vec<(String, String)> {
    let text = without_comments(&read("grammar/katachi.ebnf"));
    let mut rules: Vec<(String, String)> = vec![];
    for line in text.lines().filter(|line| !line.trim().is_empty()) {
        let defines = !line.starts_with(' ');
        match (line.split_once(" = "), rules.last_mut()) {
            (Some((name, right)), _) if defines => {
                rules.push((name.trim().to_string(), right.to_string()));
            }
            (_, Some((_, right))) => right.push_str(line),
            (_, None) => panic!("a line before the first production: {line}"),
        }
    }
    rules
}

/// What stands between quotes, and what does not.
fn terminals_and_names(right: &str) -> (BTreeSet<String>, BTreeSet<String>) {
    let (mut terminals, mut names) = (BTreeSet::new(), BTreeSet::new());
    let mut rest = right;
    while let Some(first) = rest.chars().next() {
        if first == '"' || first == '\'' {
            let end = rest[1..].find(first).expect("a closing quote") + 1;
            terminals.insert(rest[1..end].to_string());
            rest = &rest[end + 1..];
        } else {
            let length = rest.find(|c: char| !c.is_alphanumeric()).unwrap_or(rest.len());
            if length > 0 {
                names.insert(rest[..length].to_string());
            }
            rest = &rest[length.max(1)..];
        }
    }
    (terminals, names)
}

#[test]
fn grammar_and_parser_have_the_same_productions() {
    let written: Vec<String> = grammar().into_iter().map(|(name, _)| name).collect();
    let mut parsed: Vec<&str> = Production::ALL.iter().map(|p| p.name()).collect();
    let mut written: Vec<&str> = written.iter().map(String::as_str).collect();
    written.sort_unstable();
    parsed.sort_unstable();
    assert_eq!(written, parsed);
}

#[test]
fn every_name_in_the_grammar_is_defined() {
    let rules = grammar();
    let basic = ["NL", "digits", "unit", "letter", "digit", "mark", "character", "escape"];
    for (name, right) in &rules {
        for used in terminals_and_names(right).1 {
            let known = rules.iter().any(|(name, _)| *name == used) || basic.contains(&&*used);
            assert!(known, "{name} uses {used}, which is not defined");
        }
    }
}

#[test]
fn every_production_has_a_sample_that_uses_it() {
    for production in Production::ALL {
        let name = production.name();
        let text = read(format!("tests/grammar/{name}.kata"));
        let (_, diagnostics) = parse(SourceId(0), &text);
        assert!(diagnostics.is_empty(), "{name}.kata: {diagnostics:?}");
        assert!(productions(&text).contains(production), "{name}.kata does not use {name}");
    }
}

#[test]
fn every_terminal_of_a_production_stands_in_its_sample() {
    for (name, right) in grammar() {
        let text = read(format!("tests/grammar/{name}.kata"));
        for terminal in terminals_and_names(&right).0 {
            assert!(text.contains(&terminal), "{name}.kata lacks `{terminal}`");
        }
    }
}

#[test]
fn every_sample_parses() {
    let mut count = 0;
    for entry in fs::read_dir("tests/grammar").expect("the samples") {
        let path = entry.expect("readable").path();
        let (program, diagnostics) = parse(SourceId(0), &read(&path));
        assert!(diagnostics.is_empty(), "{}: {diagnostics:?}", path.display());
        assert!(!program.items.is_empty(), "{}", path.display());
        count += 1;
    }
    assert!(count > Production::ALL.len());
}
