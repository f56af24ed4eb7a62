//! An evaluated file: its outputs, exports, parameters and tests.

use std::sync::Arc;

use super::{
    Measures, Override, Session,
    artifact::{Artifact, Format, Part},
    clash,
};
use crate::{
    base::{Code, Diagnostic, Phase, watch::during},
    eval::{
        Evaluator, ExportInfo, ExportPart, InstanceId, Limits, OutputInfo, ParamInfo, TestInfo,
        TestOutcome, Write, nearest,
    },
    realize,
    shape::{Geometry, Kind, ShapeId},
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

/// What `measure` found.
#[derive(Debug, Default)]
pub struct Measured {
    /// The parts that could be made, in source order.
    pub found: Vec<(String, Arc<Measures>)>,
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
        let parts = self.parts(names, &mut measured.diagnostics);
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
        measured.diagnostics.extend(self.session.realizer.take_remarks());
        measured
    }

    /// The files to write. Without names: every export, and every output that none of them writes.
    /// With names: the exports that write nothing else, and the named outputs that none of these
    /// writes. A format given here writes the outputs alone, each as `<name>.<extension>`. What
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
        let mut parts = self.parts(names, diagnostics);
        let mut artifacts = vec![];
        if format.is_none() {
            let written: Vec<String>;
            (artifacts, written) = self.exports(names, &parts, diagnostics);
            parts.retain(|part| !written.contains(&part.name));
        }
        diagnostics.extend(self.check(names));
        let format = format.unwrap_or(Format::STL);
        for part in parts {
            let file = format!("{}.{}", part.name, format.extension());
            artifacts.push(Artifact { file, format, parts: vec![part] });
        }
        let (artifacts, clashes) = clash::refuse_clashes(artifacts);
        diagnostics.extend(clashes);
        artifacts
    }

    /// The files of the exports, and the names of the outputs that these write.
    fn exports(
        &mut self,
        names: &[String],
        outputs: &[Part],
        diagnostics: &mut Vec<Diagnostic>,
    ) -> (Vec<Artifact>, Vec<String>) {
        let (mut artifacts, mut written) = (vec![], vec![]);
        let Some(instance) = self.instance else { return (artifacts, written) };
        for (index, export) in self.evaluator.exports(instance).into_iter().enumerate() {
            let parts = during(self.session.watch, Phase::Eval, || {
                self.evaluator.export_shapes(instance, index)
            });
            diagnostics.extend(self.evaluator.take_diagnostics());
            let Ok(parts) = parts else { continue };
            let found: Vec<Option<&Part>> = parts.iter().map(|p| output_of(p, outputs)).collect();
            if !names.is_empty() && found.contains(&None) {
                continue;
            }
            match self.export(&export, parts) {
                Ok(files) if !files.is_empty() => {
                    artifacts.extend(files);
                    written.extend(found.into_iter().flatten().map(|part| part.name.clone()));
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
        parts: Vec<ExportPart>,
    ) -> Result<Vec<Artifact>, Diagnostic> {
        let Some(file) = &export.file else { return Ok(vec![]) };
        let format = Format::of_file(file).ok_or_else(|| {
            let words = format!("`{file}` has no extension of a format that is written");
            Diagnostic::error(Code::UnwritableFile, words)
                .label(export.span, "")
                .help(format!("end the name with one of {}", Format::extensions()))
        })?;
        let part = |ExportPart { name, shape, .. }| {
            self.solid_part(Part { name, shape, span: export.span })
        };
        let parts = parts.into_iter().map(part).collect::<Result<Vec<_>, _>>()?;
        Ok(Artifact::split(file, format, parts))
    }

    /// Makes the files one after the other and hands their bytes to `write`, whose words say why a
    /// file could not be written. One failing file does not stop the others.
    pub fn build(&self, artifacts: &[Artifact], write: Sink) -> Vec<Diagnostic> {
        let all: Vec<Part> = artifacts.iter().flat_map(|a| a.parts.clone()).collect();
        self.realize(&all);
        let mut diagnostics = vec![];
        for artifact in artifacts {
            for part in &artifact.parts {
                diagnostics.extend(self.warnings(part.shape));
            }
            let outcome = during(self.session.watch, Phase::Write, || {
                let bytes = artifact.encode(&self.session.realizer, self.evaluator.graph())?;
                write(artifact, &bytes).map_err(|words| artifact.unwritable(words))
            });
            diagnostics.extend(outcome.err());
        }
        diagnostics.extend(self.session.realizer.take_remarks());
        diagnostics
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
        let artifact = Artifact { file: path.clone(), format, parts: vec![part] };
        let bytes = artifact.encode(&self.session.realizer, self.evaluator.graph())?;
        Ok((path, bytes))
    }

    /// Evaluates the outputs of the given names, or all of them, to solids.
    fn parts(&mut self, names: &[String], diagnostics: &mut Vec<Diagnostic>) -> Vec<Part> {
        let Some(instance) = self.instance else { return vec![] };
        let mut parts = vec![];
        for output in self.evaluator.outputs(instance) {
            if !names.is_empty() && !names.iter().any(|name| **name == *output.name) {
                continue;
            }
            let shape = during(self.session.watch, Phase::Eval, || {
                self.evaluator.shape_of(instance, &output.name)
            });
            diagnostics.extend(self.evaluator.take_diagnostics());
            let Ok(shape) = shape else { continue };
            let name = output.name.to_string();
            match self.solid_part(Part { name, shape, span: output.span }) {
                Ok(part) => parts.push(part),
                Err(diagnostic) => diagnostics.push(diagnostic),
            }
        }
        parts
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

/// The output that an export writes with one of its parts: the one it names, else the only one of that shape.
fn output_of<'a>(part: &ExportPart, outputs: &'a [Part]) -> Option<&'a Part> {
    if let Some(name) = &part.output {
        return outputs.iter().find(|output| *output.name == **name);
    }
    let mut same = outputs.iter().filter(|output| output.shape == part.shape);
    let first = same.next();
    first.filter(|_| same.next().is_none())
}
