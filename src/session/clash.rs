//! Two outputs that would be one file.

use std::collections::BTreeMap;

use super::artifact::Artifact;
use crate::base::{Code, Diagnostic};

/// The artifacts whose files are their own, and an error for each of the others: the first that is
/// written to a file keeps it. Names that differ in upper and lower case alone are one file on many
/// machines.
pub fn refuse_clashes(artifacts: Vec<Artifact>) -> (Vec<Artifact>, Vec<Diagnostic>) {
    let mut taken: BTreeMap<String, usize> = BTreeMap::new();
    let mut kept: Vec<Artifact> = vec![];
    let mut clashes = vec![];
    for artifact in artifacts {
        match taken.get(&key(&artifact.file)) {
            Some(&first) => clashes.push(clash(&artifact, &kept[first])),
            None => {
                taken.insert(key(&artifact.file), kept.len());
                kept.push(artifact);
            }
        }
    }
    (kept, clashes)
}

/// Equal for names of one file.
fn key(file: &str) -> String {
    let steps: Vec<&str> = file.split('/').filter(|step| !matches!(*step, "" | ".")).collect();
    let rooted = if file.starts_with('/') { "/" } else { "" };
    rooted.to_string() + &steps.join("/").to_lowercase()
}

fn clash(second: &Artifact, first: &Artifact) -> Diagnostic {
    let words = if second.file == first.file {
        format!("two outputs are written to `{}`", first.file)
    } else {
        let by_case = second.file.eq_ignore_ascii_case(&first.file);
        let condition = if by_case { " where case is not told apart" } else { "" };
        format!("`{}` and `{}` are one file{condition}", second.file, first.file)
    };
    let places = [(second, "this is not written"), (first, "this is")];
    let error = Diagnostic::error(Code::Duplicate, words).help("give one of them another name");
    places.into_iter().fold(error, |error, (artifact, words)| match artifact.span() {
        Some(span) => error.label(span, words),
        None => error,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::{Content, Format};

    #[test]
    fn the_first_of_one_name_is_kept() {
        let artifact = |file: &str| Artifact {
            file: file.to_string(),
            format: Format::STL,
            content: Content::Solids(vec![]),
        };
        let files = ["a.stl", "./a.stl", "A.STL", "b/a.stl", "a.stl", "/a.stl"];
        let (kept, clashes) = refuse_clashes(files.map(artifact).to_vec());
        let kept: Vec<&str> = kept.iter().map(|artifact| &*artifact.file).collect();
        assert_eq!(kept, ["a.stl", "b/a.stl", "/a.stl"]);
        assert_eq!(clashes.len(), 3);
        assert_eq!(clashes[2].message, "two outputs are written to `a.stl`");
    }
}
