//! Every model that once went wrong: it says what went wrong, is closed, and its own tests pass.

use std::{fs, path::Path};

use serde_json::Value;

use super::errors::run;

#[test]
fn what_went_wrong_once_is_right() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regressions");
    let entries = fs::read_dir(&folder).expect("models are there");
    let names = entries.map(|e| e.expect("readable").file_name().to_string_lossy().into_owned());
    let mut models: Vec<String> = names.filter(|name| name.ends_with(".kata")).collect();
    models.sort();
    assert!(models.len() >= 9, "only {} models", models.len());
    let faults: Vec<String> = models.iter().flat_map(|name| faults(&folder, name)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn faults(folder: &Path, name: &str) -> Vec<String> {
    let text = fs::read_to_string(folder.join(name)).expect("UTF-8");
    let mut faults = vec![];
    if !text.starts_with("//! ") || !text.contains("volume(") {
        faults.push(format!("{name}: says not what went wrong, or asserts no volume"));
    }
    let measured = run(folder, &["measure", name, "--json"]);
    let value: Value = serde_json::from_slice(&measured.stdout).unwrap_or_default();
    let parts = value["parts"].as_object().cloned().unwrap_or_default();
    let open = parts.iter().filter(|(_, m)| m["closed"] != true);
    faults.extend(open.map(|(part, m)| format!("{name}: {part} is not closed: {m}")));
    if parts.is_empty() {
        faults.push(format!("{name}: nothing measured"));
    }
    for output in [run(folder, &["test", name]), measured] {
        if !output.status.success() {
            let said = [output.stdout, output.stderr].concat();
            faults.push(format!("{name}: {}\n{}", output.status, String::from_utf8_lossy(&said)));
        }
    }
    faults
}
