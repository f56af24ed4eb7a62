//! An evaluated file: its outputs, exports, parameters and tests.

use std::{path::Path, sync::Arc};

use glam::DVec3;

use super::{
    Measures, Override, Session,
    artifact::{Artifact, Content, Format, Paper, PaperKind, Part},
    clash,
    drafting::Drafter,
};
use crate::{
    base::{Code, Diagnostic, Phase, watch::during},
    eval::{
        Evaluator, ExportInfo, ExportPart, InstanceId, Limits, OutputInfo, ParamInfo, Product,
        TestInfo, TestOutcome, Write, nearest,
    },
    geom::{Hidden, Method},
    realize,
    shape::{
        Geometry, Kind, ShapeId, ViewSpec,
        drawing::{Place, Projection, StyleSpec},
        halftone::{ScreenSpec, ShadeSpec, SunSpec},
    },
};

/// A file with its parameters set.
pub struct Model<'s> {
    session: &'s Session<'s>,
    evaluator: Evaluator<'s>,
    /// `None` where the file could not be read or a parameter is refused.
    instance: Option<InstanceId>,
}

/// Takes the bytes of a file; the error says in words why it could not be written.
type Sink<'a> = &'a mut dyn FnMut(&Artifact, &[u8]) -> Result<(), String>;

/// Measures of a view: lengths on paper at scale 1, coincident lines once, hidden under visible ones left out.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Lines {
    /// Length of the visible lines, mm.
    pub visible: f64,
    /// Length of the hidden lines, drawn or not, mm.
    pub hidden: f64,
    /// Number of lines, arcs and curves, visible and hidden.
    pub segments: usize,
}

/// How a whole model is looked at.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Sight {
    /// Where the eye is.
    pub projection: Projection,
    /// The image of this point is the origin.
    pub target: DVec3,
    /// Which hidden lines are drawn.
    pub hidden: Hidden,
}

/// What `measure` found.
#[derive(Debug, Default)]
pub struct Measured {
    /// The parts that could be made, in source order.
    pub found: Vec<(String, Arc<Measures>)>,
    /// The views that could be drawn, in source order.
    pub views: Vec<(String, Lines)>,
    /// What is to be said about them and about those that could not.
    pub diagnostics: Vec<Diagnostic>,
}

impl<'s> Model<'s> {
    pub(super) fn open(
        session: &'s Session<'s>,
        entry: &str,
        given: Vec<(String, Override)>,
    ) -> (Model<'s>, Vec<Diagnostic>) {
        let mut evaluator = Evaluator::new(session, Limits::default());
        let instance = during(session.watch, Phase::Eval, || evaluator.open(entry, &given));
        let diagnostics = evaluator.take_diagnostics();
        (Model { session, evaluator, instance }, diagnostics)
    }

    /// The outputs in source order.
    pub fn outputs(&mut self) -> Vec<OutputInfo> {
        self.instance.map_or_else(Vec::new, |instance| self.evaluator.outputs(instance))
    }

    /// The parameters in source order, and what could not be evaluated about them.
    pub fn params(&mut self) -> (Vec<ParamInfo>, Vec<Diagnostic>) {
        let params = self.instance.map_or_else(Vec::new, |i| self.evaluator.params(i));
        (params, self.evaluator.take_diagnostics())
    }

    /// Evaluates everything that needs no geometry, also what no output uses. With names, outputs of
    /// other names are left alone.
    pub fn check(&mut self, names: &[String]) -> Vec<Diagnostic> {
        if let Some(instance) = self.instance {
            during(self.session.watch, Phase::Eval, || self.evaluator.check(instance, names));
        }
        self.evaluator.take_diagnostics()
    }

    /// Refuses names that no output has.
    pub fn refuse_unknown(&mut self, names: &[String]) -> Vec<Diagnostic> {
        if names.is_empty() || self.instance.is_none() {
            return vec![];
        }
        let outputs = self.outputs();
        let known: Vec<&str> = outputs.iter().map(|output| &*output.name).collect();
        let unknown = names.iter().filter(|name| !known.contains(&name.as_str()));
        let refused = unknown.map(|name| {
            let diagnostic = Diagnostic::error(Code::Usage, format!("there is no output `{name}`"));
            diagnostic.help(match nearest(name, known.iter().copied()).first() {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("the outputs are {}", known.join(", ")),
            })
        });
        refused.collect()
    }

    /// Measures the outputs of the given names, or all of them, and [checks](Model::check) the file.
    pub fn measure(&mut self, names: &[String]) -> Measured {
        let mut measured = Measured::default();
        let (parts, papers) = self.products(names, &mut measured.diagnostics);
        measured.diagnostics.extend(self.check(names));
        self.realize(&parts);
        for part in parts {
            let graph = self.evaluator.graph();
            match self.session.realizer.measures(graph, part.shape) {
                Ok(measures) => measured.found.push((part.name.clone(), measures)),
                Err(error) => measured.diagnostics.push(*error.diagnostic),
            }
            measured.diagnostics.extend(self.warnings(part.shape));
        }
        self.measure_views(&papers, &mut measured);
        measured.diagnostics.extend(self.session.realizer.take_remarks());
        measured
    }

    fn measure_views(&self, papers: &[Paper], measured: &mut Measured) {
        let drafter = self.drafter();
        for paper in papers {
            let PaperKind::View(view) = &paper.kind else { continue };
            match drafter.draw(view) {
                Ok(drawn) => {
                    let drawing = &drawn.figure.drawing;
                    // A sum of nothing is negative zero.
                    let (visible, hidden) = (drawing.visible + 0.0, drawing.hidden + 0.0);
                    let lines = Lines { visible, hidden, segments: drawing.segments };
                    measured.views.push((paper.name.clone(), lines));
                    measured.diagnostics.extend(drawn.warnings.clone());
                }
                Err(diagnostic) => measured.diagnostics.push(diagnostic),
            }
        }
    }

    fn drafter(&self) -> Drafter<'_> {
        let session = self.session;
        Drafter::new(&session.realizer, self.evaluator.graph(), session.watch)
    }

    /// The file of one view of all parts of the given names, or of all there are, each a body of its own. `None` where
    /// there is no part; why is among the diagnostics.
    pub fn sketch(
        &mut self,
        names: &[String],
        sight: &Sight,
        (file, format): (&str, Format),
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<Artifact> {
        let (parts, _) = self.products(names, diagnostics);
        diagnostics.extend(self.check(names));
        if parts.is_empty() && !diagnostics.iter().any(Diagnostic::is_error) {
            diagnostics.push(Diagnostic::error(Code::Usage, "the model has no part to draw"));
        }
        let span = parts.first()?.span;
        let stem = Path::new(file).file_stem().unwrap_or_default();
        let name = stem.to_string_lossy().into_owned();
        let view = ViewSpec {
            shapes: parts.iter().map(|part| part.shape).collect(),
            surfaces: vec![],
            profiles: vec![],
            curves: vec![],
            projection: sight.projection,
            target: sight.target,
            window: None,
            hidden: sight.hidden,
            method: Method::Auto,
            style: StyleSpec::default(),
            shadow: None,
            section: None,
            center_lines: false,
            dims: vec![],
            cuttings: vec![],
            grid: None,
            caption: None,
            place: Place(span),
        };
        let content = Content::Paper(Paper { name, kind: PaperKind::View(Arc::new(view)), span });
        Some(Artifact { file: file.to_string(), format, content })
    }

    /// The first half-tone of the given names, or of all there are, in characters, at most so many columns and rows; where
    /// there is none all parts, lit from the upper left. `None` where there is neither, or where it cannot be made.
    pub fn preview(
        &mut self,
        names: &[String],
        sight: &Sight,
        size: [u32; 2],
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<String> {
        let (parts, papers) = self.products(names, diagnostics);
        diagnostics.extend(self.check(names));
        let shade = papers.iter().find_map(|paper| match &paper.kind {
            PaperKind::Shade(shade) => Some(ShadeSpec::clone(shade)),
            PaperKind::View(_) | PaperKind::Sheet(_) => None,
        });
        let Some(shade) = shade.or_else(|| lit_parts(&parts, sight)) else {
            if !diagnostics.iter().any(Diagnostic::is_error) {
                let words = "the model has neither a half-tone nor a part to show";
                diagnostics.push(Diagnostic::error(Code::Usage, words));
            }
            return None;
        };
        match self.drafter().preview(&shade, size) {
            Ok((text, warnings)) => {
                diagnostics.extend(warnings);
                Some(text)
            }
            Err(error) => {
                diagnostics.push(error);
                None
            }
        }
    }

    /// The files to write. Without names: every export, and every output that none of them writes.
    /// With names: the exports that write nothing else, and the named outputs that none of these
    /// writes. A format given here writes the outputs alone, each as `<name>.<extension>`: parts where it
    /// holds solids, views and sheets where it holds drawings, the others as they are otherwise. What
    /// [`check`](Model::check) finds is among the diagnostics.
    ///
    /// An export writes the outputs that it names, alone or as fields of its record. Where it has an
    /// expression, it writes the output that is this very shape, if there is just one among those asked
    /// for.
    pub fn artifacts(
        &mut self,
        names: &[String],
        format: Option<Format>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Vec<Artifact> {
        let (mut parts, mut papers) = self.products(names, diagnostics);
        let mut artifacts = vec![];
        if format.is_none() {
            let written: Vec<String>;
            let shapes = parts.iter().map(|p| (p.name.clone(), Product::Shape(p.shape)));
            let drawn = papers.iter().map(|p| (p.name.clone(), p.kind.product()));
            let outputs: Vec<(String, Product)> = shapes.chain(drawn).collect();
            (artifacts, written) = self.exports(names, &outputs, diagnostics);
            parts.retain(|part| !written.contains(&part.name));
            papers.retain(|paper| !written.contains(&paper.name));
        }
        diagnostics.extend(self.check(names));
        let of_parts = format.filter(|format| format.is_solid()).unwrap_or(Format::STL);
        let of_paper = format.filter(|format| format.is_drawing()).unwrap_or(Format::SVG);
        for part in parts {
            let file = format!("{}.{}", part.name, of_parts.extension());
            let content = Content::Solids(vec![part]);
            artifacts.push(Artifact { file, format: of_parts, content });
        }
        for paper in papers {
            let format = match paper.kind {
                PaperKind::View(_) | PaperKind::Sheet(_) => of_paper,
                PaperKind::Shade(_) => {
                    format.filter(|f| f.holds(&paper.kind.product())).unwrap_or(Format::PNG)
                }
            };
            let file = format!("{}.{}", paper.name, format.extension());
            artifacts.push(Artifact { file, format, content: Content::Paper(paper) });
        }
        let (artifacts, clashes) = clash::refuse_clashes(artifacts);
        diagnostics.extend(clashes);
        artifacts
    }

    /// The files of the exports, and the names of the outputs that these write.
    fn exports(
        &mut self,
        names: &[String],
        outputs: &[(String, Product)],
        diagnostics: &mut Vec<Diagnostic>,
    ) -> (Vec<Artifact>, Vec<String>) {
        let (mut artifacts, mut written) = (vec![], vec![]);
        let Some(instance) = self.instance else { return (artifacts, written) };
        for (index, export) in self.evaluator.exports(instance).into_iter().enumerate() {
            let parts = during(self.session.watch, Phase::Eval, || {
                self.evaluator.export_products(instance, index)
            });
            diagnostics.extend(self.evaluator.take_diagnostics());
            let Ok(parts) = parts else { continue };
            let found: Vec<Option<&str>> = parts.iter().map(|p| output_of(p, outputs)).collect();
            if !names.is_empty() && found.contains(&None) {
                continue;
            }
            match self.export(&export, parts) {
                Ok(files) if !files.is_empty() => {
                    artifacts.extend(files);
                    written.extend(found.into_iter().flatten().map(str::to_string));
                }
                Ok(_) => {}
                Err(diagnostic) => diagnostics.push(diagnostic),
            }
        }
        (artifacts, written)
    }

    fn export(
        &self,
        export: &ExportInfo,
        products: Vec<ExportPart>,
    ) -> Result<Vec<Artifact>, Diagnostic> {
        let Some(file) = &export.file else { return Ok(vec![]) };
        let format = Format::of_file(file).ok_or_else(|| {
            let words = format!("`{file}` has no extension of a format that is written");
            Diagnostic::error(Code::UnwritableFile, words)
                .label(export.span, "")
                .help(format!("end the name with one of {}", Format::extensions()))
        })?;
        let (mut parts, mut papers) = (vec![], vec![]);
        for ExportPart { name, product, .. } in products {
            let span = export.span;
            if !format.holds(&product) {
                return Err(unsuited(&name, &product, format, export));
            }
            match paper_kind(&product) {
                Ok(kind) => papers.push(Paper { name, kind, span }),
                Err(shape) => parts.push(self.solid_part(Part { name, shape, span })?),
            }
        }
        if !papers.is_empty() {
            return Ok(drawings(file, format, papers));
        }
        Ok(Artifact::split(file, format, parts))
    }

    /// Makes the files one after the other and hands their bytes to `write`, whose words say why a
    /// file could not be written. One failing file does not stop the others.
    pub fn build(&self, artifacts: &[Artifact], write: Sink) -> Vec<Diagnostic> {
        let all: Vec<Part> = artifacts.iter().flat_map(|a| a.parts().to_vec()).collect();
        self.realize(&all);
        let drafter = self.drafter();
        let mut diagnostics = vec![];
        for artifact in artifacts {
            for part in artifact.parts() {
                diagnostics.extend(self.warnings(part.shape));
            }
            let outcome = during(self.session.watch, Phase::Write, || {
                let bytes = self.encode(artifact, &drafter, &mut diagnostics)?;
                write(artifact, &bytes).map_err(|words| artifact.unwritable(words))
            });
            diagnostics.extend(outcome.err());
        }
        diagnostics.extend(self.session.realizer.take_remarks());
        diagnostics
    }

    fn encode(
        &self,
        artifact: &Artifact,
        drafter: &Drafter,
        said: &mut Vec<Diagnostic>,
    ) -> Result<Vec<u8>, Diagnostic> {
        artifact.encode(&self.session.realizer, drafter, self.evaluator.graph(), said)
    }

    /// The tests in source order.
    pub fn tests(&mut self) -> Vec<TestInfo> {
        self.instance.map_or_else(Vec::new, |instance| self.evaluator.tests(instance))
    }

    /// Runs one of the [`tests`](Model::tests), by its place among them. With `update`, references
    /// that differ are given back to be written in place of failing the test.
    pub fn run_test(&mut self, index: usize, update: bool) -> Option<TestOutcome> {
        let instance = self.instance?;
        let run = || self.evaluator.run_test(instance, index, update);
        Some(during(self.session.watch, Phase::Eval, run))
    }

    /// Path relative to the root and bytes of a reference that a test wants written.
    pub fn reference(&self, write: &Write) -> Result<(String, Vec<u8>), Diagnostic> {
        let (path, shape) = match write {
            Write::Text { path, text } => return Ok((path.to_string(), text.clone().into_bytes())),
            Write::Mesh { path, shape } => (path.to_string(), *shape),
        };
        let format = Format::of_file(&path).unwrap_or(Format::STL);
        let part =
            Part { name: "golden".into(), shape, span: self.evaluator.graph().origin(shape) };
        let content = Content::Solids(vec![part]);
        let artifact = Artifact { file: path.clone(), format, content };
        let bytes = self.encode(&artifact, &self.drafter(), &mut vec![])?;
        Ok((path, bytes))
    }

    /// Evaluates the outputs of the given names, or all of them, to solids and to what is put on paper.
    fn products(
        &mut self,
        names: &[String],
        diagnostics: &mut Vec<Diagnostic>,
    ) -> (Vec<Part>, Vec<Paper>) {
        let (mut parts, mut papers) = (vec![], vec![]);
        let Some(instance) = self.instance else { return (parts, papers) };
        for output in self.evaluator.outputs(instance) {
            if !names.is_empty() && !names.iter().any(|name| **name == *output.name) {
                continue;
            }
            let product = during(self.session.watch, Phase::Eval, || {
                self.evaluator.product_of(instance, &output.name)
            });
            diagnostics.extend(self.evaluator.take_diagnostics());
            let Ok(product) = product else { continue };
            let (name, span) = (output.name.to_string(), output.span);
            let shape = match paper_kind(&product) {
                Ok(kind) => {
                    papers.push(Paper { name, kind, span });
                    continue;
                }
                Err(shape) => shape,
            };
            match self.solid_part(Part { name, shape, span }) {
                Ok(part) => parts.push(part),
                Err(diagnostic) => diagnostics.push(diagnostic),
            }
        }
        (parts, papers)
    }

    /// Refuses plane figures.
    fn solid_part(&self, part: Part) -> Result<Part, Diagnostic> {
        let graph = self.evaluator.graph();
        if graph.kind(part.shape) == Kind::Solid {
            return Ok(part);
        }
        let words = format!("`{}` is a plane figure; a part needs a solid", part.name);
        let diagnostic = Diagnostic::error(Code::WrongKind, words)
            .label(graph.origin(part.shape), "this has no volume")
            .help("give it a height with `.extrude(h)`");
        Err(diagnostic)
    }

    fn realize(&self, parts: &[Part]) {
        let roots: Vec<ShapeId> = parts.iter().map(|part| part.shape).collect();
        self.session.realizer.realize(self.evaluator.graph(), &roots);
    }

    fn warnings(&self, shape: ShapeId) -> Vec<Diagnostic> {
        realize::warnings(&self.session.realizer, self.evaluator.graph(), shape)
    }
}

/// Parts as a half-tone in light from the upper left.
fn lit_parts(parts: &[Part], sight: &Sight) -> Option<ShadeSpec> {
    let span = parts.first()?.span;
    Some(ShadeSpec {
        shapes: parts.iter().map(|part| part.shape).collect(),
        surfaces: vec![],
        projection: sight.projection,
        target: sight.target,
        window: None,
        suns: vec![SunSpec::DEFAULT],
        ground: None,
        screen: ScreenSpec::Grey,
        lines: None,
        dpi: 1.0,
        place: Place(span),
    })
}

/// What of a product is put on paper; else its shape.
fn paper_kind(product: &Product) -> Result<PaperKind, ShapeId> {
    match product {
        Product::Shape(shape) => Err(*shape),
        Product::View(view) => Ok(PaperKind::View(view.clone())),
        Product::Shade(shade) => Ok(PaperKind::Shade(shade.clone())),
        Product::Sheet(page) => Ok(PaperKind::Sheet(page.clone())),
    }
}

/// The error for an export whose format does not hold what it is given.
fn unsuited(name: &str, product: &Product, format: Format, export: &ExportInfo) -> Diagnostic {
    let extension = format.extension();
    let (kind, help) = match product {
        Product::Shape(_) => {
            let verb = if format.is_drawing() { "view" } else { "shade" };
            ("solid", format!("draw it: `export \"x.{extension}\" = {name}.{verb}()`"))
        }
        Product::View(_) | Product::Sheet(_) => {
            ("drawing", "drawings are written as .svg, .pdf or .dxf".to_string())
        }
        Product::Shade(shade) if shade.screen == ScreenSpec::Grey && format.is_drawing() => {
            ("picture of pixels", "take black shapes, such as `screen = dots()`".to_string())
        }
        Product::Shade(_) => {
            ("picture", "pictures are written as .png, .svg, .pdf, .dxf or .txt".to_string())
        }
    };
    let words = format!("a {kind} cannot be written as .{extension}");
    Diagnostic::error(Code::UnwritableFile, words).label(export.span, "").help(help)
}

/// The files of some drawings: one each, by the part's name where there are several.
fn drawings(file: &str, format: Format, papers: Vec<Paper>) -> Vec<Artifact> {
    let several = papers.len() > 1;
    let (stem, extension) = file.rsplit_once('.').unwrap_or((file, format.extension()));
    let artifact = |paper: Paper| {
        let file = match several {
            true => format!("{stem}-{}.{extension}", paper.name),
            false => file.to_string(),
        };
        Artifact { file, format, content: Content::Paper(paper) }
    };
    papers.into_iter().map(artifact).collect()
}

/// The output that an export writes with one of its parts: the one it names, else the only one that is the same.
fn output_of<'a>(part: &ExportPart, outputs: &'a [(String, Product)]) -> Option<&'a str> {
    if let Some(name) = &part.output {
        return outputs.iter().map(|(known, _)| &**known).find(|known| *known == &**name);
    }
    let mut same = outputs.iter().filter(|(_, product)| *product == part.product);
    let first = same.next();
    first.filter(|_| same.next().is_none()).map(|(name, _)| &**name)
}
