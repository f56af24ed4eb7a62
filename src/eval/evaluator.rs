//! The evaluator: what it holds, and how files come in.

use std::{
    hash::{Hash, Hasher},
    sync::Arc,
};

use rustc_hash::{FxHashMap, FxHashSet, FxHasher};

use super::{
    dimension::{Dimension, quantity},
    failure::{Failure, Outcome, fail},
    instance::{Given, Instance, InstanceId},
    library::{Index, LIBRARY},
    resolve::{resolve, resolve_library},
    testing::Running,
    types::shown,
    unit::{GlobalKind, ParamKind, Unit, UseCode},
    value::Value,
};
use crate::{
    base::{Code, Diagnostic, FileError, SourceId, Span, path},
    geom::formula::Recording,
    shape::{Geometry, GeometryError, ShapeGraph, geometry::Data},
    syntax::{self, ast},
};

/// What evaluation needs from outside: geometry, and other source files.
pub trait Host: Geometry {
    /// A source file by its path relative to the project root, or `std/...`. The error has no
    /// label; the evaluator adds the place of the `use`.
    fn load(&self, path: &str) -> Result<Arc<Loaded>, Diagnostic>;
}

/// A source file that was read and parsed.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// Its path relative to the project root.
    pub path: Arc<str>,
    /// Its text.
    pub text: Arc<str>,
    /// Its number in the source map.
    pub source: SourceId,
    /// Its tree.
    pub program: ast::Program,
    /// Syntax errors.
    pub diagnostics: Vec<Diagnostic>,
}

/// What evaluation may use; counted, so that a limit is hit at the same place on every machine.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Limits {
    /// Loop turns, calls and elements handled.
    pub steps: u64,
    /// Elements of lists, records and strings kept at a time (about 16 bytes each).
    pub values: u64,
    /// Calls within calls.
    pub depth: u32,
}

impl Default for Limits {
    /// 400 million steps (about a minute), 60 million values (about 1 GB), 20,000 calls deep.
    fn default() -> Limits {
        Limits { steps: 400_000_000, values: 60_000_000, depth: 20_000 }
    }
}

/// A parameter's value given from outside: `-D name=value`.
#[derive(Clone, Debug)]
pub enum Override {
    /// An expression of the language; `source` is its number in the source map.
    Source {
        /// Where the text is known as.
        source: SourceId,
        /// The expression.
        text: Arc<str>,
    },
    /// A value from a JSON file.
    Data(Data),
    /// A number with its dimension, in millimetres and degrees.
    Quantity(f64, Dimension),
}

/// A call that is running.
#[derive(Clone, PartialEq, Debug)]
pub struct CallRecord {
    pub name: Option<Arc<str>>,
    pub span: Span,
}

/// Messages, each said once.
#[derive(Debug, Default)]
pub struct Messages {
    pub list: Vec<Diagnostic>,
    said: FxHashSet<u64>,
}

impl Messages {
    fn add(&mut self, diagnostic: Diagnostic) {
        let mut hasher = FxHasher::default();
        (diagnostic.code, &diagnostic.message, diagnostic.span()).hash(&mut hasher);
        if self.said.insert(hasher.finish()) {
            self.list.push(diagnostic);
        }
    }
}

/// Evaluates files. It owns the shape graph, the instances and the diagnostics.
pub struct Evaluator<'h> {
    pub(super) host: &'h dyn Host,
    pub(super) limits: Limits,
    pub(super) graph: ShapeGraph,
    pub(super) units: FxHashMap<Arc<str>, Option<Arc<Unit>>>,
    /// Files being loaded, for the cycle of `use`.
    loading: Vec<(Arc<str>, Option<Span>)>,
    pub(super) instances: Vec<Instance>,
    /// Instances by file and parameters.
    pub(super) instance_index: FxHashMap<u64, Vec<InstanceId>>,
    /// Values of library names by number.
    pub(super) library: Vec<Option<Value>>,
    library_units: FxHashMap<u32, Arc<Unit>>,
    pub(super) stack: Vec<Value>,
    pub(super) calls: Vec<CallRecord>,
    /// Top-level names being evaluated.
    pub(super) forcing: Vec<(InstanceId, u32, Span)>,
    pub(super) steps_taken: u64,
    /// Top-level names of all instances.
    pub(super) cells_made: u64,
    /// The modeller's call that led into the library.
    pub(super) library_call: Span,
    pub(super) messages: Messages,
    pub(super) test: Option<Running>,
    /// Formulas of fields taken down so far.
    pub(super) recording: Recording,
    /// Fields whose formula is being taken down, one within the other.
    pub(super) tracing: u32,
    /// Set while `check` runs: geometry is not asked.
    pub(super) dry: bool,
    /// Set when `check` met something it could not evaluate without geometry.
    pub(super) skipped: bool,
}

impl<'h> Evaluator<'h> {
    /// An evaluator without any file yet.
    pub fn new(host: &'h dyn Host, limits: Limits) -> Evaluator<'h> {
        Evaluator {
            host,
            limits,
            graph: ShapeGraph::default(),
            units: FxHashMap::default(),
            loading: vec![],
            instances: vec![],
            instance_index: FxHashMap::default(),
            library: vec![],
            library_units: FxHashMap::default(),
            stack: vec![],
            calls: vec![],
            forcing: vec![],
            steps_taken: 0,
            cells_made: 0,
            library_call: Span::default(),
            messages: Messages::default(),
            test: None,
            recording: Recording::default(),
            tracing: 0,
            dry: false,
            skipped: false,
        }
    }

    /// Loads the entry file and instantiates it with these parameters; top-level asserts run.
    /// `None` when the file cannot be loaded. A refused instance (an assert that fails, a parameter
    /// outside its domain) still tells its params and outputs, but evaluates none.
    pub fn open(&mut self, path: &str, overrides: &[(String, Override)]) -> Option<InstanceId> {
        self.steps_taken = 0;
        let path: Arc<str> = path.into();
        if let Err(failure) = self.unit(&path, None) {
            self.report(&failure);
            return None;
        }
        let mut given = vec![];
        let mut refused = None;
        for (name, value) in overrides {
            let value = self.as_declared(&path, name, value);
            match self.override_value(name, &value) {
                Ok(value) => {
                    given.push(Given { name: name.as_str().into(), value: value.0, span: value.1 })
                }
                Err(failure) => refused = Some(failure),
            }
        }
        let made = match refused {
            None => self.instance(&path, given, Span::default()),
            Some(failure) => Err(failure),
        };
        match made {
            Ok(id) => Some(id),
            Err(failure) => {
                self.report(&failure);
                Some(self.refused_instance(&path, failure))
            }
        }
    }

    /// The instance that was refused, or one in its place with the defaults.
    fn refused_instance(&mut self, path: &Arc<str>, failure: Failure) -> InstanceId {
        let last = self.instances.last();
        if last.is_none_or(|instance| instance.refused.is_none()) {
            let unit = self.units.get(path).cloned().flatten();
            let Some(unit) = unit else { return InstanceId(0) };
            let mut instance = Instance::new(unit, vec![]);
            instance.refused = Some(failure);
            self.instances.push(instance);
        }
        let mine = |instance: &Instance| instance.unit.path == *path && instance.refused.is_some();
        InstanceId(self.instances.iter().rposition(mine).unwrap_or(0) as u32)
    }

    /// A value from outside as its parameter takes it: a string needs no quotes (`-D style=flat`), and
    /// JSON, which has no units, may hold a number with its unit as a string.
    fn as_declared(&self, path: &str, name: &str, given: &Override) -> Override {
        let unit = self.units.get(path).cloned().flatten();
        let kind = unit.and_then(|unit| unit.param_kind(name));
        match (kind, given) {
            (Some(ParamKind::Text), Override::Source { text, .. }) if !text.starts_with('"') => {
                Override::Data(Data::Text(text.clone()))
            }
            (Some(ParamKind::Number), Override::Data(Data::Text(text))) => quantity(text)
                .map_or_else(|| given.clone(), |(x, unit)| Override::Quantity(x, unit)),
            _ => given.clone(),
        }
    }

    fn override_value(&mut self, name: &str, given: &Override) -> Outcome<(Value, Option<Span>)> {
        match given {
            Override::Data(data) => Ok((super::builtin::data_value(data), None)),
            Override::Quantity(number, dimension) => Ok((Value::Number(*number, *dimension), None)),
            Override::Source { source, text } => {
                let (program, diagnostics) = syntax::parse(*source, text);
                if let Some(first) = diagnostics.into_iter().find(Diagnostic::is_error) {
                    return Err(wrong_use(first).into());
                }
                let span = Span::new(*source, 0, text.len() as u32);
                let path: Arc<str> = "<parameter>".into();
                let (unit, diagnostics) = resolve(&program, &path, text, Index::get());
                if let Some(first) = diagnostics.into_iter().next() {
                    let quotes = format!("a string is written in quotes: `{name}=\"{text}\"`");
                    let word = text.chars().all(char::is_alphanumeric);
                    let first = wrong_use(first);
                    return Err(if word { first.note(quotes) } else { first }.into());
                }
                let [global] = &unit.globals[..] else {
                    let words = format!("the value of `{name}` must be one expression");
                    return fail(Code::Usage, span, words);
                };
                let (code, frame) = (global.value, global.frame);
                let id = InstanceId(self.instances.len() as u32);
                self.instances.push(Instance::new(Arc::new(unit), vec![]));
                Ok((self.eval_in(id, code, frame)?, Some(span)))
            }
        }
    }

    /// The shapes built so far.
    pub fn graph(&self) -> &ShapeGraph {
        &self.graph
    }

    /// The messages since the last call, each said once.
    pub fn take_diagnostics(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages.list)
    }

    /// How many steps the last request took.
    pub fn steps(&self) -> u64 {
        self.steps_taken
    }

    /// Adds a message unless it has been said.
    pub(super) fn record(&mut self, diagnostic: Diagnostic) {
        self.messages.add(diagnostic);
    }

    /// A file after the resolve pass, loaded when first asked for.
    pub(super) fn unit(&mut self, path: &Arc<str>, at: Option<Span>) -> Outcome<Arc<Unit>> {
        if let Some(known) = self.units.get(path) {
            return known.clone().ok_or(Failure::TOLD);
        }
        if let Some(start) = self.loading.iter().position(|(loading, _)| loading == path) {
            return Err(self.use_cycle(start, path, at));
        }
        self.loading.push((path.clone(), at));
        let unit = super::stack::deep(|| self.load(path, at));
        self.loading.pop();
        self.units.insert(path.clone(), unit.as_ref().ok().cloned());
        unit
    }

    fn load(&mut self, path: &Arc<str>, at: Option<Span>) -> Outcome<Arc<Unit>> {
        let placed = |error: Diagnostic| match at {
            Some(at) if error.labels.is_empty() => error.label(at, ""),
            _ => error,
        };
        let loaded = self.host.load(path).map_err(placed)?;
        let (mut unit, diagnostics) = resolve(&loaded.program, path, &loaded.text, Index::get());
        for error in loaded.diagnostics.iter().filter(|diagnostic| diagnostic.is_error()) {
            unit.disable(error.span());
        }
        for diagnostic in loaded.diagnostics.iter().cloned().chain(diagnostics) {
            self.record(diagnostic);
        }
        let unit = Arc::new(unit);
        let taken: Vec<Outcome<()>> = unit.uses.iter().map(|used| self.take(&unit, used)).collect();
        let mut failures = taken.into_iter().filter_map(Result::err);
        let last = failures.next();
        failures.for_each(|failure| self.report(&failure));
        last.map_or(Ok(unit), Err)
    }

    fn take(&mut self, unit: &Unit, used: &UseCode) -> Outcome<()> {
        let target = self.relative(unit, &used.path, used.span)?;
        let target = self.unit(&target, Some(used.span))?;
        self.check_imports(unit, &target, used);
        Ok(())
    }

    /// Names taken from a file must be there and open.
    fn check_imports(&mut self, unit: &Unit, target: &Unit, used: &UseCode) {
        for global in &unit.globals {
            let GlobalKind::Imported(number, name) = &global.kind else { continue };
            let here = std::ptr::eq(&unit.uses[*number as usize], used);
            if !here || target.names.contains_key(name) {
                continue;
            }
            let open = target.globals.iter().filter(|global| global.is_open());
            let wanted = ast::Name { text: name.clone(), span: global.name.span };
            let error =
                super::resolve::unknown_name(&wanted, open.map(|global| &*global.name.text));
            self.record(error.note(format!("looked for in {}", target.path)));
        }
    }

    fn use_cycle(&self, start: usize, path: &str, at: Option<Span>) -> Failure {
        let files: Vec<&str> =
            self.loading[start..].iter().map(|(path, _)| &**path).chain([path]).collect();
        let message = format!("files use each other: {}", files.join(" -> "));
        let error = Diagnostic::error(Code::UseCycle, message);
        let spans = self.loading[start + 1..].iter().filter_map(|(_, at)| *at);
        at.into_iter().chain(spans).fold(error, |error, span| error.label(span, "")).into()
    }

    /// A path as written in a file, relative to the root.
    pub(super) fn relative(&self, unit: &Unit, written: &str, at: Span) -> Outcome<Arc<str>> {
        match path::resolve(&unit.path, written) {
            Ok(path) => Ok(path.into()),
            Err(error) => {
                let message = format!("cannot read `{written}`: {error}");
                let code = match error {
                    FileError::OutsideRoot => Code::OutsideRoot,
                    _ => Code::UnreadableFile,
                };
                fail(code, at, message)
            }
        }
    }

    /// Asks about shapes; an error without a place gets `at`.
    pub(super) fn ask<T>(
        &mut self,
        at: Span,
        question: impl FnOnce(&dyn Host, &ShapeGraph) -> Result<T, GeometryError>,
    ) -> Outcome<T> {
        if self.dry {
            return Err(Failure::TOLD);
        }
        question(self.host, &self.graph).map_err(|error| {
            let diagnostic = *error.diagnostic;
            let here = self.shown_at(at);
            if diagnostic.labels.is_empty() { diagnostic.label(here, "") } else { diagnostic }
                .into()
        })
    }

    /// The declarations of a library name, parsed and resolved when first used.
    pub(super) fn library_unit(&mut self, number: u32) -> Outcome<Arc<Unit>> {
        if let Some(unit) = self.library_units.get(&number) {
            return Ok(unit.clone());
        }
        let text = Index::get().text(number);
        let (program, diagnostics) = syntax::parse(LIBRARY, &text);
        let path: Arc<str> = format!("std/{}", Index::get().name(number)).into();
        let unit = Unit::new(&path, &text, true);
        let (unit, more) = resolve_library(&program, unit, Index::get());
        if let Some(first) = diagnostics.into_iter().chain(more).next() {
            return Err(first
                .note(format!("in the library, at `{}`", Index::get().name(number)))
                .into());
        }
        let unit = Arc::new(unit);
        self.library_units.insert(number, unit.clone());
        Ok(unit)
    }

    /// A number from a setting or argument, with words for the error.
    pub(super) fn plain_number(&self, value: &Value, at: Span) -> Outcome<f64> {
        match value {
            Value::Number(number, _) => Ok(*number),
            other => fail(Code::WrongKind, at, format!("needs a number, got {}", shown(other))),
        }
    }
}

/// The text of a `-D` that is no expression: not the model is wrong, but the command line.
fn wrong_use(diagnostic: Diagnostic) -> Diagnostic {
    Diagnostic { code: Code::Usage, ..diagnostic }
}
