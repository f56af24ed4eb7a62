//! Files to be written: which shapes go into which, and their bytes.

use std::{path::Path, sync::Arc};

use super::{
    drafting::{Drafter, Letterer},
    sheet::page,
};
use crate::{
    base::{Code, Diagnostic, Span},
    eval::Product,
    geom::{PolyMesh, Region},
    output::{
        elements::{self, ElementFormat, NamedElements},
        halftone::PictureFormat,
        mesh::{self, MeshFormat, NamedMesh},
        scad,
        sheet::{self, DrawingFormat, Page},
    },
    realize::Realizer,
    shape::{PageSpec, ShadeSpec, ShapeGraph, ShapeId, Stretched, ViewSpec, halftone::ScreenSpec},
};

/// What a file is written as.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Format {
    /// A mesh.
    Mesh(MeshFormat),
    /// Tetrahedra.
    Elements(ElementFormat),
    /// OpenSCAD source.
    Scad,
    /// A drawing.
    Drawing(DrawingFormat),
    /// A picture.
    Picture(PictureFormat),
}

impl Format {
    /// The format of a name on the command line, such as `stl-ascii`.
    pub fn from_name(name: &str) -> Option<Format> {
        let other = || Format::of_paper(name).or(Format::of_source(name));
        MeshFormat::from_name(name).map(Format::Mesh).or_else(other)
    }

    /// The format of a file name, by its extension.
    pub fn of_file(file: &str) -> Option<Format> {
        let extension = Path::new(file).extension()?.to_str()?;
        let other = || Format::of_paper(extension).or(Format::of_source(extension));
        MeshFormat::from_extension(extension).map(Format::Mesh).or_else(other)
    }

    fn of_paper(extension: &str) -> Option<Format> {
        let picture = || PictureFormat::from_name(extension).map(Format::Picture);
        DrawingFormat::from_name(extension).map(Format::Drawing).or_else(picture)
    }

    fn of_source(extension: &str) -> Option<Format> {
        let scad = extension.eq_ignore_ascii_case("scad").then_some(Format::Scad);
        ElementFormat::from_name(extension).map(Format::Elements).or(scad)
    }

    /// What parts are written as when nobody says.
    pub const STL: Format = Format::Mesh(MeshFormat::Stl);

    /// What views and sheets are written as when nobody says.
    pub const SVG: Format = Format::Drawing(DrawingFormat::Svg);

    /// What pictures are written as when nobody says.
    pub const PNG: Format = Format::Picture(PictureFormat::Png);

    /// All names, for messages.
    pub fn names() -> String {
        let names: Vec<&str> = MeshFormat::ALL.iter().map(|format| format.name()).collect();
        format!("{}, {ELEMENTS}, scad, {DRAWINGS}", names.join(", "))
    }

    /// All extensions, for messages.
    pub fn extensions() -> String {
        let mut names: Vec<&str> = MeshFormat::ALL.iter().map(|f| f.extension()).collect();
        names.dedup();
        names.extend(ElementFormat::ALL.map(ElementFormat::name));
        format!(".{}, .scad, .svg, .pdf, .dxf, .png or .txt", names.join(", ."))
    }

    /// The extension of its files.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Mesh(format) => format.extension(),
            Format::Elements(format) => format.name(),
            Format::Scad => "scad",
            Format::Drawing(format) => format.name(),
            Format::Picture(format) => format.name(),
        }
    }

    /// Whether it holds what an output is.
    pub fn holds(self, product: &Product) -> bool {
        match product {
            Product::Shape(_) => self.is_solid(),
            Product::View(_) | Product::Sheet(_) => self.is_drawing(),
            // Pixels are no lines.
            Product::Shade(shade) => match self {
                Format::Drawing(DrawingFormat::Dxf) => shade.screen != ScreenSpec::Grey,
                Format::Drawing(_) | Format::Picture(_) => true,
                Format::Mesh(_) | Format::Elements(_) | Format::Scad => false,
            },
        }
    }

    /// Whether it holds solids.
    pub fn is_solid(self) -> bool {
        matches!(self, Format::Mesh(_) | Format::Elements(_) | Format::Scad)
    }

    /// Whether it holds lines, not solids.
    pub fn is_drawing(self) -> bool {
        matches!(self, Format::Drawing(_))
    }

    fn holds_parts(self) -> bool {
        match self {
            Format::Mesh(format) => format.holds_parts(),
            Format::Scad | Format::Elements(_) => true,
            Format::Drawing(_) | Format::Picture(_) => false,
        }
    }
}

/// The names of the formats of tetrahedra, for messages.
const ELEMENTS: &str = "msh, vtu, inp, mesh";

/// The names of the formats of drawings, for messages.
const DRAWINGS: &str = "svg, pdf, dxf, png or txt";

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

/// A named drawing or page and where the model says so.
#[derive(Clone, PartialEq, Debug)]
pub struct Paper {
    /// Its name.
    pub name: String,
    /// What is on it.
    pub kind: PaperKind,
    /// What asked for it.
    pub span: Span,
}

/// What is on paper.
#[derive(Clone, PartialEq, Debug)]
pub enum PaperKind {
    /// A view, on paper of its own size.
    View(Arc<ViewSpec>),
    /// A picture.
    Shade(Arc<ShadeSpec>),
    /// A page.
    Sheet(Arc<PageSpec>),
}

impl PaperKind {
    /// The output it comes from.
    pub fn product(&self) -> Product {
        match self {
            PaperKind::View(view) => Product::View(view.clone()),
            PaperKind::Shade(shade) => Product::Shade(shade.clone()),
            PaperKind::Sheet(page) => Product::Sheet(page.clone()),
        }
    }
}

/// What is in a file.
#[derive(Clone, PartialEq, Debug)]
pub enum Content {
    /// Solids.
    Solids(Vec<Part>),
    /// A drawing or page.
    Paper(Paper),
}

/// One file to be written.
#[derive(Clone, PartialEq, Debug)]
pub struct Artifact {
    /// Path under the output folder.
    pub file: String,
    /// What it is written as; it suits the content.
    pub format: Format,
    /// What is in it.
    pub content: Content,
}

impl Artifact {
    /// The files for some parts: one if the format can hold them all, else one each, named
    /// `<stem>-<part>.<extension>`.
    pub fn split(file: &str, format: Format, parts: Vec<Part>) -> Vec<Artifact> {
        if parts.len() <= 1 || format.holds_parts() {
            let content = Content::Solids(parts);
            return vec![Artifact { file: file.to_string(), format, content }];
        }
        let (stem, extension) = file.rsplit_once('.').unwrap_or((file, format.extension()));
        let single = |part: Part| Artifact {
            file: format!("{stem}-{}.{extension}", part.name),
            format,
            content: Content::Solids(vec![part]),
        };
        parts.into_iter().map(single).collect()
    }

    /// The solids in it.
    pub fn parts(&self) -> &[Part] {
        match &self.content {
            Content::Solids(parts) => parts,
            Content::Paper(_) => &[],
        }
    }

    /// The bytes of the file. Parts that cannot be made fail with the diagnostic of the shape. Warnings about drawings
    /// are added to `said`.
    pub fn encode(
        &self,
        realizer: &Realizer,
        drafter: &Drafter,
        graph: &ShapeGraph,
        said: &mut Vec<Diagnostic>,
    ) -> Result<Vec<u8>, Diagnostic> {
        if let Content::Paper(paper) = &self.content {
            return self.encode_paper(paper, drafter, said);
        }
        let mut solids = vec![];
        for part in self.parts() {
            let solid = realizer.solid(graph, part.shape).map_err(|e| *e.diagnostic)?;
            solids.push((&*part.name, solid.polyhedron));
        }
        match self.format {
            Format::Mesh(format) => {
                let meshes: Vec<NamedMesh> =
                    solids.iter().map(|(name, s)| NamedMesh { name, mesh: s.mesh() }).collect();
                mesh::write(format, &meshes).map_err(|e| self.refused(&e.to_string()))
            }
            Format::Elements(format) => self.encode_elements(format, realizer, graph),
            Format::Scad => {
                let parts: Vec<_> = self.parts().iter().map(|p| (&*p.name, p.shape)).collect();
                let realized = Shapes { realizer, graph };
                scad::write(graph, &parts, realizer.tolerance(), &realized)
                    .map(String::into_bytes)
                    .map_err(|e| self.refused(&e.to_string()))
            }
            Format::Drawing(_) | Format::Picture(_) => {
                Err(self.refused("a format of drawings and pictures holds no solids"))
            }
        }
    }

    fn encode_elements(
        &self,
        format: ElementFormat,
        realizer: &Realizer,
        graph: &ShapeGraph,
    ) -> Result<Vec<u8>, Diagnostic> {
        let mut complexes = vec![];
        for part in self.parts() {
            let complex = realizer.complex(graph, part.shape).map_err(|e| {
                let diagnostic = *e.diagnostic;
                if diagnostic.labels.is_empty() {
                    diagnostic.label(part.span, "")
                } else {
                    diagnostic
                }
            })?;
            complexes.push((&*part.name, complex));
        }
        let parts: Vec<NamedElements> =
            complexes.iter().map(|(name, c)| NamedElements { name, mesh: c.mesh() }).collect();
        elements::write(format, &parts).map_err(|e| self.refused(&e.to_string()))
    }

    fn encode_paper(
        &self,
        paper: &Paper,
        drafter: &Drafter,
        said: &mut Vec<Diagnostic>,
    ) -> Result<Vec<u8>, Diagnostic> {
        match (&paper.kind, self.format) {
            (PaperKind::Shade(spec), Format::Picture(format)) => {
                let (halftone, warnings) = drafter.shade(spec, 1.0)?;
                said.extend(warnings);
                let words = "only a picture with `screen = overstrike()` is text";
                format.write(&halftone).ok_or_else(|| self.refused(words))
            }
            (PaperKind::Shade(spec), Format::Drawing(format)) => {
                let (halftone, warnings) = drafter.shade(spec, 1.0)?;
                said.extend(warnings);
                Ok(sheet::write(format, &halftone.print().page(&paper.name)))
            }
            (PaperKind::View(view), Format::Drawing(format)) => {
                let drawn = drafter.draw(view)?;
                said.extend(drawn.warnings.clone());
                Ok(sheet::write(format, &drawn.figure.page(&paper.name, &Letterer)))
            }
            (PaperKind::Sheet(spec), Format::Drawing(format)) => {
                Ok(sheet::write(format, &composed(drafter, &paper.name, spec, said)?))
            }
            _ => Err(self.refused("this format holds no lines")),
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
        match &self.content {
            Content::Solids(parts) => parts.first().map(|part| part.span),
            Content::Paper(paper) => Some(paper.span),
        }
    }
}

/// A page with its ink. All reasons but the first why it cannot be made are added to `said`.
fn composed(
    drafter: &Drafter,
    name: &str,
    spec: &PageSpec,
    said: &mut Vec<Diagnostic>,
) -> Result<Page, Diagnostic> {
    match page(drafter, name, spec) {
        Ok((page, warnings)) => {
            said.extend(warnings);
            Ok(page)
        }
        Err(mut errors) => {
            let first = errors.remove(0);
            said.extend(errors);
            Err(first)
        }
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
        assert!(Format::of_file("sub/front.SVG").is_some_and(Format::is_drawing));
    }
}
