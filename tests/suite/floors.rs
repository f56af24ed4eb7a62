//! The floor plan is a test: which part of `src` may import which.

use std::{
    fs,
    path::{Path, PathBuf},
};

/// A floor and the floors it may import. A floor is a folder or file of `src`; the longest match
/// counts, and a floor may always import itself.
const FLOORS: &[(&str, &[&str])] = &[
    ("base", &[]),
    ("geom", &["base"]),
    ("syntax", &["base"]),
    ("shape", &["base", "geom"]),
    ("eval", &["base", "geom", "syntax", "shape"]),
    ("input", &["base", "geom"]),
    ("kernel", &["geom"]),
    ("kernel/profile", &["geom"]),
    ("kernel/brep", &["geom"]),
    ("kernel/field", &["geom"]),
    ("kernel/tet", &["geom"]),
    ("convert", &["geom", "kernel"]),
    ("realize", &["base", "geom", "shape", "input", "kernel", "convert"]),
    ("output", &["geom"]),
    // OpenSCAD source is the construction tree written out, so its writer reads the shape graph.
    ("output/scad", &["geom", "shape", "output"]),
    (
        "session",
        &["base", "geom", "syntax", "shape", "eval", "input", "kernel", "realize", "output"],
    ),
    ("app", &["base", "syntax", "output", "session"]),
    ("main", &["app"]),
    ("lib", &[]),
];

#[test]
fn every_module_imports_only_the_floors_below_it() {
    let mut faults = vec![];
    for file in rust_files(Path::new("src")) {
        let module = module_of(&file);
        let Some((floor, allowed)) = floor_of(&module) else {
            faults.push(format!("{module} stands on no floor"));
            continue;
        };
        let text = fs::read_to_string(&file).expect("a source file is readable");
        for target in imports(&text) {
            let Some((below, _)) = floor_of(&target) else {
                faults.push(format!("{module} imports {target}, which stands on no floor"));
                continue;
            };
            let inside = below == floor || allowed.iter().any(|a| is_under(below, a));
            if !inside {
                faults.push(format!("{module} (floor {floor}) imports {target} (floor {below})"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = vec![];
    let mut entries: Vec<_> =
        fs::read_dir(folder).expect("src exists").map(|e| e.expect("readable").path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

/// `src/kernel/brep/mod.rs` is `kernel/brep`.
fn module_of(file: &Path) -> String {
    let path = file.strip_prefix("src").expect("under src").with_extension("");
    let text = path.to_string_lossy().replace('\\', "/");
    text.strip_suffix("/mod").unwrap_or(&text).to_string()
}

fn is_under(module: &str, floor: &str) -> bool {
    module == floor || module.strip_prefix(floor).is_some_and(|rest| rest.starts_with('/'))
}

fn floor_of(module: &str) -> Option<(&'static str, &'static [&'static str])> {
    let found = FLOORS.iter().filter(|(floor, _)| is_under(module, floor));
    found.max_by_key(|(floor, _)| floor.len()).copied()
}

/// Every module named by a `crate::` path outside comments, with `{...}` groups opened.
fn imports(text: &str) -> Vec<String> {
    let code: String = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or(""))
        .collect::<Vec<_>>()
        .join("\n");
    let mut found = vec![];
    for (at, _) in code.match_indices("crate::") {
        let before = code[..at].chars().next_back();
        if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '$') {
            continue;
        }
        expand(&code[at + "crate::".len()..], "", &mut found);
    }
    found
}

/// Reads `a::b::{c, d::e}` and pushes `a/b/c` and `a/b/d/e`, module names only.
fn expand(rest: &str, prefix: &str, found: &mut Vec<String>) -> usize {
    let mut path = prefix.to_string();
    let mut at = 0;
    loop {
        let tail = &rest[at..];
        if tail.starts_with('{') {
            return at + expand_group(tail, &path, found);
        }
        let word: String = tail.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        let is_module = word.chars().next().is_some_and(char::is_lowercase);
        if is_module {
            if !path.is_empty() {
                path.push('/');
            }
            path.push_str(&word);
        }
        at += word.len();
        if !rest[at..].starts_with("::") || word.is_empty() {
            if !path.is_empty() {
                found.push(path);
            }
            return at;
        }
        at += 2;
    }
}

fn expand_group(rest: &str, prefix: &str, found: &mut Vec<String>) -> usize {
    let mut at = 1;
    while at < rest.len() && !rest[at..].starts_with('}') {
        let skip = rest[at..].chars().take_while(|c| c.is_whitespace() || *c == ',').count();
        at += skip;
        if rest[at..].starts_with('}') {
            break;
        }
        let read = expand(&rest[at..], prefix, found);
        if read == 0 {
            return rest.len();
        }
        at += read;
    }
    at + 1
}
