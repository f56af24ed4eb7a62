//! Every folder in `tests/openscad` against the export that stands in it.

use std::{
    fs,
    path::{Path, PathBuf},
};

use katachi::kernel::brep::Polyhedron;
use serde_json::Value;

use super::facts::{Facts, SIX_DIGITS, apart, arcs};
use crate::made::{Made, OFF, on_two_threads, solid};

/// A solid in two languages.
pub struct Case {
    /// The name of its folder.
    pub name: String,
    folder: PathBuf,
    /// What is expected of it.
    pub expected: Facts,
    /// How near volume, area and bounds must be.
    pub relative: f64,
}

/// What we make of a case.
pub struct Ours {
    /// The measures that the session tells.
    pub facts: Facts,
    /// The solid, by way of an OFF file.
    pub solid: Polyhedron,
}

impl Case {
    /// All cases by name.
    pub fn all() -> Vec<Case> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/openscad");
        let entries = fs::read_dir(root).expect("cases").map(|e| e.expect("readable").path());
        let mut folders: Vec<PathBuf> = entries.filter(|path| path.is_dir()).collect();
        folders.sort();
        folders.into_iter().map(Case::read).collect()
    }

    fn read(folder: PathBuf) -> Case {
        let name = folder.file_name().expect("named").to_string_lossy().into_owned();
        let text = fs::read_to_string(folder.join("expected.json"));
        let text = text.unwrap_or_else(|e| panic!("{name}: expected.json: {e}"));
        let json: Value = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        let expected = Facts::from_json(&json).unwrap_or_else(|| panic!("{name}: {json}"));
        let relative = json["relative"].as_f64().unwrap_or(SIX_DIGITS);
        Case { name, folder, expected, relative }
    }

    /// A file of its folder.
    pub fn file(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Makes its Katachi source.
    pub fn ours(&self) -> Result<Ours, String> {
        let made = Made::of_file(&self.file("model.kata"), &[OFF])?;
        if !made.warnings.is_empty() {
            return Err(format!("warnings: {:?}", made.warnings));
        }
        let ([(_, measures)], Some(off)) = (&*made.parts, made.file(".off")) else {
            return Err(format!("{} parts, expected one", made.parts.len()));
        };
        Ok(Ours { facts: Facts::from(&**measures), solid: solid("ours.off", off)? })
    }

    /// The faults of what we make, seen against an export of OpenSCAD.
    pub fn faults(&self, export: &[u8]) -> Vec<String> {
        let compared = self.ours().and_then(|ours| Ok((ours, solid("openscad.off", export)?)));
        let mut faults = match compared {
            Err(words) => vec![words],
            Ok((ours, theirs)) => {
                let mut faults = ours.facts.differences(&self.expected, self.relative);
                let export = Facts::from(&theirs).differences(&self.expected, self.relative);
                faults.extend(export.into_iter().map(|f| format!("the export itself: {f}")));
                faults.extend(apart(&ours.solid, &theirs, arcs(self.relative)));
                faults
            }
        };
        faults.iter_mut().for_each(|fault| *fault = format!("{}: {fault}", self.name));
        faults
    }
}

#[test]
fn every_case_is_the_solid_that_openscad_made() {
    let cases = Case::all();
    assert!(cases.len() >= 24, "only {} cases", cases.len());
    let committed = |case: &Case| match fs::read(case.file("openscad.off")) {
        Ok(export) => case.faults(&export),
        Err(error) => vec![format!("{}: openscad.off: {error}", case.name)],
    };
    let faults = on_two_threads(&cases, committed).concat();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_solid_that_is_off_is_noticed() {
    let cases = Case::all();
    let by_name = |name: &str| cases.iter().find(|c| c.name == name).expect("a case");
    let (gear, other) = (by_name("gear"), by_name("hexagon_nut"));
    let export = fs::read_to_string(gear.file("openscad.off")).expect("readable");
    // One corner of the gear, moved by a millimetre.
    let moved = export.replacen("22 1.09999 6", "23 1.09999 6", 1);
    assert!(export != moved, "the corner is not there");
    let faults = gear.faults(moved.as_bytes()).join("\n");
    assert!(faults.contains("gear: ") && faults.contains("lie in one solid only"), "{faults}");
    let faults = gear.faults(&fs::read(other.file("openscad.off")).expect("readable")).join("\n");
    for word in ["volume", "area", "bounds"] {
        assert!(faults.contains(word), "{word} is not in: {faults}");
    }
}
