//! Named groups of elements, numbered through the file.

use rustc_hash::FxHashMap;

use super::NamedElements;

/// The groups of a file: one of tetrahedra for each part, then those of triangles. Numbers begin at 1.
#[derive(Debug)]
pub(super) struct Groups {
    /// Names of the groups of triangles, and the part each is of.
    surfaces: Vec<(String, usize)>,
    /// For each part the group of each triangle of its boundary.
    of_triangle: Vec<Vec<usize>>,
    parts: usize,
}

impl Groups {
    /// The groups of parts: triangles with the same tags are one.
    pub(super) fn new(parts: &[NamedElements]) -> Groups {
        let mut groups = Groups { surfaces: vec![], of_triangle: vec![], parts: parts.len() };
        for (number, part) in parts.iter().enumerate() {
            let mut known: FxHashMap<Vec<&str>, usize> = FxHashMap::default();
            let of_triangle = part.mesh.boundary.iter().map(|triangle| {
                let origin = part.mesh.origins.get(triangle.origin as usize);
                let tags: Vec<&str> =
                    origin.iter().flat_map(|o| o.tags.iter().map(|tag| &**tag)).collect();
                let surfaces = &mut groups.surfaces;
                *known.entry(tags.clone()).or_insert_with(|| {
                    let name = if tags.is_empty() { "boundary".into() } else { tags.join(".") };
                    surfaces.push((format!("{}.{name}", part.name), number));
                    surfaces.len() - 1
                })
            });
            let of_triangle = of_triangle.collect();
            groups.of_triangle.push(of_triangle);
        }
        groups
    }

    /// The number of the tetrahedra of a part.
    pub(super) fn of_part(&self, part: usize) -> usize {
        part + 1
    }

    /// The number of a triangle of a part's boundary.
    pub(super) fn of_triangle(&self, part: usize, triangle: usize) -> usize {
        self.parts + 1 + self.of_triangle[part][triangle]
    }

    /// The groups of triangles of a part: number and name.
    pub(super) fn surfaces(&self, part: usize) -> impl Iterator<Item = (usize, &str)> {
        let first = self.parts + 1;
        let all = self.surfaces.iter().enumerate();
        all.filter(move |(_, (_, of))| *of == part).map(move |(i, (name, _))| (first + i, &**name))
    }

    /// How many groups of triangles there are.
    pub(super) fn surface_count(&self) -> usize {
        self.surfaces.len()
    }

    /// The triangles of a group, by their places in the boundary of the part.
    pub(super) fn triangles(&self, part: usize, group: usize) -> impl Iterator<Item = usize> {
        let own = group - self.parts - 1;
        let all = self.of_triangle[part].iter().enumerate();
        all.filter(move |(_, of)| **of == own).map(|(i, _)| i)
    }
}

/// A text of lines, written number by number.
#[derive(Default)]
pub(super) struct Lines(pub(super) String);

impl Lines {
    /// Adds a line of words between which stands `between`.
    pub(super) fn line<T: std::fmt::Display>(
        &mut self,
        between: &str,
        words: impl IntoIterator<Item = T>,
    ) {
        use std::fmt::Write;
        for (i, word) in words.into_iter().enumerate() {
            // Writing to a string does not fail.
            let _ = write!(self.0, "{}{word}", if i == 0 { "" } else { between });
        }
        self.0.push('\n');
    }

    /// Adds a line as it is.
    pub(super) fn text(&mut self, text: &str) {
        self.0.push_str(text);
        self.0.push('\n');
    }
}

/// A name of letters, digits, `_`, `-` and `.`; other signs become `_`.
pub(super) fn plain_name(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || "_-.".contains(c) { c } else { '_' };
    name.chars().map(plain).collect()
}
