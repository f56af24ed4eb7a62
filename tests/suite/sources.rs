//! Every Katachi source that is shipped or compared parses without a diagnostic.

use std::{
    fs,
    path::{Path, PathBuf},
};

use katachi::{base::SourceId, syntax};

/// All `.kata` files under a folder.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(folder).expect("a folder").map(|e| e.expect("readable").path());
    for path in entries {
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "kata") {
            found.push(path);
        }
    }
}

#[test]
fn every_example_and_every_compared_model_parses() {
    let mut found = vec![];
    sources(Path::new("examples"), &mut found);
    sources(Path::new("tests/openscad"), &mut found);
    found.sort();
    assert!(found.len() >= 40, "{} files", found.len());
    let mut faults = vec![];
    for path in found {
        let text = fs::read_to_string(&path).expect("UTF-8");
        let (program, diagnostics) = syntax::parse(SourceId(0), &text);
        assert!(!program.items.is_empty(), "{}: nothing in it", path.display());
        faults.extend(diagnostics.iter().map(|d| format!("{}: {d:?}", path.display())));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
