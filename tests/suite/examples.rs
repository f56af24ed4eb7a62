//! Every example builds, is closed and is measured, and its tests pass.

use std::{
    fs,
    path::{Path, PathBuf},
};

use serde_json::Value;

use super::errors::run;

/// The folder of the examples.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")
}

/// File names of all examples, sorted.
pub fn models() -> Vec<String> {
    let entries = fs::read_dir(folder()).expect("examples are there");
    let names = entries.map(|e| e.expect("readable").file_name().to_string_lossy().into_owned());
    let mut models: Vec<String> = names.filter(|name| name.ends_with(".kata")).collect();
    models.sort();
    assert!(models.len() >= 10, "only {} examples", models.len());
    models
}

#[test]
fn every_example_builds_is_closed_and_is_measured() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let faults: Vec<String> = models().iter().flat_map(|name| faults(root, name)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn faults(root: &Path, name: &str) -> Vec<String> {
    let file = format!("examples/{name}");
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().to_str().expect("plain path");
    let mut faults = vec![];
    let measured = run(root, &["measure", &file, "--json"]);
    let value: Value = serde_json::from_slice(&measured.stdout).unwrap_or_default();
    let parts = value["parts"].as_object().cloned().unwrap_or_default();
    if parts.is_empty() {
        faults.push(format!("{name}: nothing measured"));
    }
    for (part, m) in &parts {
        let solid = m["closed"] == true && m["volume"].as_f64() > Some(0.0);
        if !solid || m["genus"].as_i64() < Some(0) {
            faults.push(format!("{name}: {part} is no solid: {m}"));
        }
    }
    let commands = [vec!["build", &file, "-o", folder], vec!["test", &file]];
    let outputs = commands.iter().map(|arguments| run(root, arguments));
    for output in outputs.chain([measured]) {
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        if !output.status.success() || !text.is_empty() {
            faults.push(format!("{name}: {}\n{text}", output.status));
        }
    }
    if fs::read_dir(out.path()).map_or(0, Iterator::count) == 0 {
        faults.push(format!("{name}: no file written"));
    }
    faults
}
