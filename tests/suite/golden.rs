//! Small models, each with the measures of its parts in a text beside it. The reasoning behind the
//! numbers stands in the model. `KATACHI_UPDATE=1` rewrites the texts.

use std::{env, fmt::Write, fs, path::Path};

use serde_json::Value;

use super::errors::run;

#[test]
fn models_measure_what_their_texts_say() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let entries = fs::read_dir(&root).expect("the models are there");
    let names = entries.map(|e| e.expect("readable").file_name().to_string_lossy().into_owned());
    let mut names: Vec<String> = names.collect();
    names.sort();
    assert!(names.len() >= 25, "only {} models", names.len());
    let faults: Vec<String> = names.iter().filter_map(|name| fault(&root.join(name))).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// What is wrong with the model of a folder.
fn fault(folder: &Path) -> Option<String> {
    let output = run(folder, &["measure", "model.kata", "--json"]);
    let said = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() || !said.is_empty() {
        return Some(format!("{}: {}\n{said}", folder.display(), output.status));
    }
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let parts = value["parts"].as_object().expect("parts");
    let found: String =
        parts.iter().map(|(name, measures)| measures_text(name, measures)).collect();
    let file = folder.join("measures.txt");
    if env::var_os("KATACHI_UPDATE").is_some() {
        fs::write(&file, &found).expect("writable");
    }
    let expected = fs::read_to_string(&file).unwrap_or_default();
    let differs = || format!("{}:\n{found}--- but expected:\n{expected}", folder.display());
    (found != expected).then(differs)
}

/// Six decimals: far below the tolerance of the kernel, far above what rounding does.
fn measures_text(name: &str, measures: &Value) -> String {
    let mut text = format!("{name}\n");
    for key in ["volume", "area", "bbox", "centroid", "euler", "genus", "shells", "closed"] {
        writeln!(text, "    {key} = {}", shown(&measures[key])).expect("a string takes all");
    }
    text
}

fn shown(value: &Value) -> String {
    match value {
        Value::Array(items) => {
            format!("[{}]", items.iter().map(shown).collect::<Vec<_>>().join(", "))
        }
        Value::Number(number) => {
            let rounded = (number.as_f64().expect("finite") * 1e6).round() / 1e6;
            format!("{}", rounded + 0.0)
        }
        other => other.to_string(),
    }
}
