//! Every source in `tests/errors` and the diagnostics it must give, written beside the offending code.
//!
//! ```text
//! part pin = cylinder(radius = 5, h = 2)
//! //~                 ^^^^^^ unknown-argument: no parameter `radius`
//! //~| did you mean `r`?
//! ```
//!
//! Below a line of code, `//~ code: words` asks for a diagnostic of that code whose message has those
//! words and whose first place in this file starts on that line; carets, where given, stand under exactly the
//! characters of that place. `//~| words` asks the same diagnostic for a label, note or help with those
//! words. No other diagnostic may come. `//~ run: ...` gives the command, `measure` by default.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

use serde_json::Value;

/// A diagnostic that a source asks for.
struct Expected {
    line: u64,
    /// Column and length of the carets.
    carets: Option<(u64, u64)>,
    code: String,
    words: String,
    details: Vec<String>,
}

/// The command under test.
pub fn katachi(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_katachi"));
    command.args(arguments);
    command
}

/// Runs the command under test in a folder.
pub fn run(folder: &Path, arguments: &[&str]) -> Output {
    katachi(arguments).current_dir(folder).output().expect("the command starts")
}

#[test]
fn every_source_gives_the_diagnostics_written_beside_it() {
    let folder = Path::new("tests/errors");
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder).expect("readable").map(|e| e.expect("readable").path()).collect();
    files.retain(|file| file.extension().is_some_and(|e| e == "kata"));
    files.sort();
    assert!(files.len() >= 20, "only {} sources found", files.len());
    let faults: Vec<String> = files.iter().flat_map(|file| faults(file)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn faults(file: &Path) -> Vec<String> {
    let text = fs::read_to_string(file).expect("readable");
    let name = file.file_name().expect("named").to_str().expect("plain name");
    let asked = text.lines().find_map(|line| line.strip_prefix("//~ run: ")).unwrap_or("measure");
    let mut arguments: Vec<&str> = asked.split_whitespace().collect();
    arguments.extend(["--diagnostics", "json", name]);
    let output = run(file.parent().expect("in a folder"), &arguments);
    let mut found: Vec<Value> = String::from_utf8_lossy(&output.stderr)
        .lines()
        .map(|line| serde_json::from_str(line).unwrap_or_else(|_| Value::from(line)))
        .collect();
    let mut faults = vec![];
    for expected in expectations(&text) {
        match found.iter().position(|d| is_met(&expected, d, name)) {
            Some(index) => drop(found.remove(index)),
            None => faults.push(format!(
                "{name}:{}: missing `{}: {}` {:?} {:?}",
                expected.line, expected.code, expected.words, expected.carets, expected.details
            )),
        }
    }
    faults.extend(found.iter().map(|d| format!("{name}: unexpected {d}")));
    faults
}

fn expectations(text: &str) -> Vec<Expected> {
    let mut found: Vec<Expected> = vec![];
    let mut code_line = 0;
    for (number, line) in (1..).zip(text.lines()) {
        let Some(at) = line.find("//~") else {
            code_line = number;
            continue;
        };
        let rest = &line[at + 3..];
        if let Some(words) = rest.strip_prefix('|') {
            let last = found.last_mut().expect("`//~|` follows an expectation");
            last.details.push(words.trim().to_string());
        } else if !rest.starts_with(" run: ") {
            found.push(expectation(code_line, at + 3, rest));
        }
    }
    found
}

fn expectation(line: u64, offset: usize, rest: &str) -> Expected {
    let words = rest.trim_start_matches([' ', '^']);
    let marks = &rest[..rest.len() - words.len()];
    let carets = marks.find('^').map(|first| {
        let length = marks.trim().len();
        ((offset + first + 1) as u64, length as u64)
    });
    let (code, words) = words.split_once(": ").expect("`code: words`");
    Expected { line, carets, code: code.to_string(), words: words.to_string(), details: vec![] }
}

fn is_met(expected: &Expected, found: &Value, file: &str) -> bool {
    let labels = found["labels"].as_array().cloned().unwrap_or_default();
    let Some(place) = labels.iter().find(|label| label["path"] == file) else { return false };
    let length = || Some(place["end_column"].as_u64()? - place["column"].as_u64()?);
    let has = |value: &Value, words: &str| value.as_str().is_some_and(|s| s.contains(words));
    let label = |words: &str| {
        let labels = found["labels"].as_array().into_iter().flatten();
        let notes = found["notes"].as_array().into_iter().flatten();
        labels.map(|l| &l["message"]).chain(notes).chain([&found["help"]]).any(|v| has(v, words))
    };
    found["code"] == expected.code.as_str()
        && has(&found["message"], &expected.words)
        && place["line"] == expected.line
        && expected
            .carets
            .is_none_or(|(column, count)| place["column"] == column && length() == Some(count))
        && expected.details.iter().all(|words| label(words))
}
