//! The standard library: Katachi text, embedded. A name is parsed when it is first used.

use std::sync::{Arc, OnceLock};

use rustc_hash::FxHashMap;

use crate::base::SourceId;

/// The number under which library text stands in spans. No source map holds it: errors inside the
/// library are shown at the call that led there.
pub const LIBRARY: SourceId = SourceId(u32::MAX);

/// The files whose names every model sees.
const PRELUDE: &[(&str, &str)] = &[
    ("std/algebra", include_str!("../../stdlib/algebra.kata")),
    ("std/constants", include_str!("../../stdlib/constants.kata")),
    ("std/curves", include_str!("../../stdlib/curves.kata")),
    ("std/distance", include_str!("../../stdlib/distance.kata")),
    ("std/isometric", include_str!("../../stdlib/isometric.kata")),
    ("std/lists", include_str!("../../stdlib/lists.kata")),
    ("std/mathematics", include_str!("../../stdlib/mathematics.kata")),
    ("std/measures", include_str!("../../stdlib/measures.kata")),
    ("std/placing", include_str!("../../stdlib/placing.kata")),
    ("std/profiles", include_str!("../../stdlib/profiles.kata")),
    ("std/shades", include_str!("../../stdlib/shades.kata")),
    ("std/solids", include_str!("../../stdlib/solids.kata")),
    ("std/strings", include_str!("../../stdlib/strings.kata")),
    ("std/surfaces", include_str!("../../stdlib/surfaces.kata")),
    ("std/sweeps", include_str!("../../stdlib/sweeps.kata")),
    ("std/testing", include_str!("../../stdlib/testing.kata")),
    ("std/views", include_str!("../../stdlib/views.kata")),
];

/// The files that a model may `use`.
const MODULES: &[(&str, &str)] = &[("std/metric", include_str!("../../stdlib/metric.kata"))];

/// The text of a library module such as `std/metric`, with or without `.kata`.
///
/// ```
/// assert!(katachi::eval::library::module("std/metric").unwrap().contains("clearance"));
/// assert!(katachi::eval::library::module("std/nothing").is_none());
/// ```
pub fn module(path: &str) -> Option<&'static str> {
    let path = path.strip_suffix(".kata").unwrap_or(path);
    MODULES.iter().find(|(name, _)| *name == path).map(|(_, text)| *text)
}

/// The paths of the library modules.
pub fn modules() -> impl Iterator<Item = &'static str> {
    MODULES.iter().map(|(name, _)| *name)
}

/// One declaration of the library: what reference, hover and tests read.
#[derive(Clone, PartialEq, Debug)]
pub struct Declaration {
    /// Its name.
    pub name: &'static str,
    /// The file it stands in, such as `std/solids`.
    pub file: &'static str,
    /// The declaration itself.
    pub text: &'static str,
    /// The lines before it, from its first `///`.
    comment: &'static str,
}

impl Declaration {
    /// The `///` lines without the slashes, each with its end.
    pub fn doc(&self) -> String {
        let lines = self.comment.split_inclusive('\n').filter_map(|line| line.strip_prefix("///"));
        lines.map(|words| words.strip_prefix(' ').unwrap_or(words)).collect()
    }

    /// The signature as written: `fn box(x: Length, y: Length, z: Length) -> Solid`, or the name of
    /// a constant.
    pub fn signature(&self) -> &'static str {
        if !self.text.starts_with("fn ") {
            return self.name;
        }
        let mut depth = 0;
        let parameters_end = self.text.char_indices().find_map(|(at, c)| {
            depth += i32::from(c == '(') - i32::from(c == ')');
            (c == ')' && depth == 0).then_some(at + 1)
        });
        let end = parameters_end.unwrap_or(self.text.len());
        let rest = &self.text[end..];
        let body = rest.find(" = ").into_iter().chain(rest.find(" {")).min();
        &self.text[..end + body.unwrap_or(rest.len())]
    }

    /// The examples of the documentation: the text between lines of three back quotes.
    pub fn examples(&self) -> Vec<String> {
        let parts = self.doc();
        parts.split("```").skip(1).step_by(2).map(|example| example.trim().to_string()).collect()
    }
}

/// The names of the library and where each is declared.
#[derive(Debug)]
pub struct Index {
    numbers: FxHashMap<&'static str, u32>,
    entries: Vec<(&'static str, Vec<Declaration>)>,
}

impl Index {
    /// The index of the embedded library, read once.
    pub fn get() -> &'static Index {
        static INDEX: OnceLock<Index> = OnceLock::new();
        INDEX.get_or_init(Index::read)
    }

    fn read() -> Index {
        let mut all = Vec::with_capacity(MANY);
        PRELUDE.iter().for_each(|(file, text)| find_declarations(file, text, &mut all));
        let mut index = Index { numbers: FxHashMap::default(), entries: vec![] };
        index.numbers.reserve(all.len());
        index.entries.reserve(all.len());
        all.into_iter().for_each(|declaration| index.add(declaration));
        index
    }

    fn add(&mut self, declaration: Declaration) {
        let next = self.entries.len() as u32;
        let number = *self.numbers.entry(declaration.name).or_insert(next);
        match self.entries.get_mut(number as usize) {
            Some((_, declarations)) => declarations.push(declaration),
            None => self.entries.push((declaration.name, vec![declaration])),
        }
    }

    /// The number of a name.
    pub fn find(&self, name: &str) -> Option<u32> {
        self.numbers.get(name).copied()
    }

    /// The name behind a number.
    pub fn name(&self, number: u32) -> &'static str {
        self.entries[number as usize].0
    }

    /// All names.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|(name, _)| *name)
    }

    /// All declarations, those of one name together.
    pub fn declarations(&self) -> impl Iterator<Item = &Declaration> {
        self.entries.iter().flat_map(|(_, declarations)| declarations)
    }

    /// The text that declares a name: all its signatures.
    pub fn text(&self, number: u32) -> Arc<str> {
        let declarations = &self.entries[number as usize].1;
        let texts: Vec<&str> = declarations.iter().map(|declaration| declaration.text).collect();
        texts.join("\n").into()
    }
}

/// Room for the declarations of the library.
const MANY: usize = 256;

/// Adds the declarations of a library file. Each begins in the first column with `fn name(` or a name,
/// after its `///` lines; lines that go on with it are indented or begin with a closing bracket.
fn find_declarations(file: &'static str, text: &'static str, found: &mut Vec<Declaration>) {
    let (mut at, mut comment) = (0, None);
    let mut open: Option<[usize; 2]> = None;
    for line in text.split_inclusive('\n') {
        let is_comment = line.as_bytes()[0] == b'/';
        if is_comment || line.starts_with(char::is_alphabetic) {
            found.extend(open.take().and_then(|start| declaration(file, text, start, at)));
            if !is_comment {
                open = Some([comment.take().unwrap_or(at), at]);
            } else if line.as_bytes().starts_with(b"///") {
                comment = comment.or(Some(at));
            }
        }
        at += line.len();
    }
    found.extend(open.and_then(|start| declaration(file, text, start, at)));
}

/// The declaration in a file that begins at two places, with and without what is before it, and goes on to an
/// end.
fn declaration(
    file: &'static str,
    text: &'static str,
    [comment, start]: [usize; 2],
    end: usize,
) -> Option<Declaration> {
    let (comment, text) = (&text[comment..start], &text[start..end]);
    let rest = text.strip_prefix("fn ").unwrap_or(text);
    let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_'))?;
    Some(Declaration { name: &rest[..end], file, text: text.trim_end(), comment })
}
