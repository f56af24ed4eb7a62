//! Files to be written: which shapes go into which, and their bytes.

use std::path::Path;

use crate::{
    base::{Code, Diagnostic, Span},
    geom::{PolyMesh, Region},
    output::{
        mesh::{self, MeshFormat, NamedMesh},
        scad,
    },
    realize::Realizer,
    shape::{ShapeGraph, ShapeId, Stretched},
};

/// What a file is written as.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Format {
    /// A mesh.
    Mesh(MeshFormat),
    /// OpenSCAD source.
    Scad,
}

impl Format {
    /// The format of a name on the command line, such as `stl-ascii`.
    pub fn from_name(name: &str) -> Option<Format> {
        match name.eq_ignore_ascii_case("scad") {
            true => Some(Format::Scad),
            false => MeshFormat::from_name(name).map(Format::Mesh),
        }
    }

    /// The format of a file name, by its extension.
    pub fn of_file(file: &str) -> Option<Format> {
        let extension = Path::new(file).extension()?.to_str()?;
        match extension.eq_ignore_ascii_case("scad") {
            true => Some(Format::Scad),
            false => MeshFormat::from_extension(extension).map(Format::Mesh),
        }
    }

    /// What outputs are written as when nobody says.
    pub const STL: Format = Format::Mesh(MeshFormat::Stl);

    /// All names, for messages.
    pub fn names() -> String {
        let names: Vec<&str> = MeshFormat::ALL.iter().map(|format| format.name()).collect();
        format!("{} or scad", names.join(", "))
    }

    /// All extensions, for messages.
    pub fn extensions() -> String {
        let mut names: Vec<&str> = MeshFormat::ALL.iter().map(|f| f.extension()).collect();
        names.dedup();
        format!(".{} or .scad", names.join(", ."))
    }

    /// The extension of its files.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Mesh(format) => format.extension(),
            Format::Scad => "scad",
        }
    }

    fn holds_parts(self) -> bool {
        match self {
            Format::Mesh(format) => format.holds_parts(),
            Format::Scad => true,
        }
    }
}

/// A named shape and where the model says so.
#[derive(Clone, PartialEq, Debug)]
pub struct Part {
    /// Its name in the file.
    pub name: String,
    /// The solid.
    pub shape: ShapeId,
    /// What asked for it.
    pub span: Span,
}

/// One file to be written.
#[derive(Clone, PartialEq, Debug)]
pub struct Artifact {
    /// Path under the output folder.
    pub file: String,
    /// What it is written as.
    pub format: Format,
    /// What is in it.
    pub parts: Vec<Part>,
}

impl Artifact {
    /// The files for some parts: one if the format can hold them all, else one each, named
    /// `<stem>-<part>.<extension>`.
    pub fn split(file: &str, format: Format, parts: Vec<Part>) -> Vec<Artifact> {
        if parts.len() <= 1 || format.holds_parts() {
            return vec![Artifact { file: file.to_string(), format, parts }];
        }
        let (stem, extension) = file.rsplit_once('.').unwrap_or((file, format.extension()));
        let single = |part: Part| Artifact {
            file: format!("{stem}-{}.{extension}", part.name),
            format,
            parts: vec![part],
        };
        parts.into_iter().map(single).collect()
    }

    /// The bytes of the file. Parts that cannot be made fail with the diagnostic of the shape.
    pub fn encode(&self, realizer: &Realizer, graph: &ShapeGraph) -> Result<Vec<u8>, Diagnostic> {
        let mut solids = vec![];
        for part in &self.parts {
            let solid = realizer.solid(graph, part.shape).map_err(|e| *e.diagnostic)?;
            solids.push((&*part.name, solid.polyhedron));
        }
        match self.format {
            Format::Mesh(format) => {
                let meshes: Vec<NamedMesh> =
                    solids.iter().map(|(name, s)| NamedMesh { name, mesh: s.mesh() }).collect();
                mesh::write(format, &meshes).map_err(|e| self.refused(&e.to_string()))
            }
            Format::Scad => {
                let parts: Vec<_> = self.parts.iter().map(|p| (&*p.name, p.shape)).collect();
                let realized = Shapes { realizer, graph };
                scad::write(graph, &parts, realizer.tolerance(), &realized)
                    .map(String::into_bytes)
                    .map_err(|e| self.refused(&e.to_string()))
            }
        }
    }

    fn refused(&self, words: &str) -> Diagnostic {
        self.unwritable(format!("`{}`: {words}", self.file))
    }

    /// The error for a file that cannot be written, at what asked for it.
    pub(super) fn unwritable(&self, words: String) -> Diagnostic {
        let diagnostic = Diagnostic::error(Code::UnwritableFile, words);
        match self.span() {
            Some(span) => diagnostic.label(span, ""),
            None => diagnostic,
        }
    }

    /// Where the model asks for it.
    pub(super) fn span(&self) -> Option<Span> {
        self.parts.first().map(|part| part.span)
    }
}

/// The shapes of a graph, made when OpenSCAD has no word for them.
struct Shapes<'a> {
    realizer: &'a Realizer<'a>,
    graph: &'a ShapeGraph,
}

impl scad::Realized for Shapes<'_> {
    fn mesh(&self, shape: Stretched) -> Option<PolyMesh> {
        Some(self.realizer.solid_under(self.graph, shape).ok()?.polyhedron.mesh().clone())
    }

    fn region(&self, shape: Stretched) -> Option<Region> {
        Some(self.realizer.figure_under(self.graph, shape).ok()?.region.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_share_a_file_where_the_format_can() {
        let part =
            |name: &str| Part { name: name.into(), shape: ShapeId(0), span: Span::default() };
        let files = |file: &str| -> Vec<String> {
            let format = Format::of_file(file).expect("known");
            let parts = vec![part("a"), part("b")];
            Artifact::split(file, format, parts).into_iter().map(|a| a.file).collect()
        };
        assert_eq!(files("both.3mf"), ["both.3mf"]);
        assert_eq!(files("sub/both.stl"), ["sub/both-a.stl", "sub/both-b.stl"]);
        assert_eq!(Format::of_file("both.step"), None);
    }
}
