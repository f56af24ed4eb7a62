//! Top-level names: evaluated when asked for, once; files as instances.

use std::sync::Arc;

use super::{
    super::{
        evaluator::{CallRecord, Evaluator},
        failure::{Failure, Outcome, fail},
        instance::{Cell, Given, Instance, InstanceId},
        library::Index,
        nearest::did_you_mean,
        types::{Type, collect_shapes, shown},
        unit::{ArgumentCode, CodeId, GlobalKind, ParamCode, Unit},
        value::{Closure, Function, Range, Symbol, Traced, Value},
    },
    Call, Frame,
};
use crate::{
    base::{self, Diagnostic, Span},
    syntax::ast::OutputKind,
};

/// Elements compared to find out whether two instances have equal parameters; larger values make
/// instances of their own.
const LONGEST_COMPARISON: u64 = 100_000;

impl Evaluator<'_> {
    /// The value of a top-level name.
    pub(in crate::eval) fn global(
        &mut self,
        instance: InstanceId,
        number: u32,
        at: Span,
    ) -> Outcome<Value> {
        match &self.instances[instance.0 as usize].cells[number as usize] {
            Cell::Done(value) => return Ok(value.clone()),
            Cell::Failed(failure) => return Err(failure.clone()),
            Cell::Busy => return Err(self.cycle(instance, number, at)),
            Cell::Todo => {}
        }
        self.set_cell(instance, number, Cell::Busy);
        self.forcing.push((instance, number, at));
        let result = super::deep(|| self.evaluate_global(instance, number));
        self.forcing.pop();
        let cell = match &result {
            Ok(value) => Cell::Done(value.clone()),
            Err(failure) => {
                // What `check` skips for want of geometry is not wrong: it is asked for again later.
                if self.dry && failure.diagnostic().is_none() {
                    self.skipped = true;
                }
                Cell::Failed(failure.clone())
            }
        };
        self.set_cell(instance, number, cell);
        result
    }

    fn set_cell(&mut self, instance: InstanceId, number: u32, cell: Cell) {
        self.instances[instance.0 as usize].cells[number as usize] = cell;
    }

    fn cycle(&self, instance: InstanceId, number: u32, at: Span) -> Failure {
        let same = |&(i, n, _): &(InstanceId, u32, Span)| (i, n) == (instance, number);
        let start = self.forcing.iter().position(same).unwrap_or(0);
        let cycle = &self.forcing[start..];
        let name = |(i, n, _): &(InstanceId, u32, Span)| {
            self.instances[i.0 as usize].unit.globals[*n as usize].name.clone()
        };
        let mut names: Vec<String> =
            cycle.iter().map(|entry| format!("`{}`", name(entry).text)).collect();
        names.push(names[0].clone());
        let message = format!("these definitions need each other: {}", names.join(" -> "));
        let error = Diagnostic::error(base::Code::Cycle, message).label(at, "needed again here");
        let labelled = cycle.iter().fold(error, |error, entry| {
            let name = name(entry);
            error.label(name.span, format!("`{}` is defined here", name.text))
        });
        labelled.into()
    }

    /// Runs `work` in a frame of its own in an instance.
    pub(in crate::eval) fn in_frame<T>(
        &mut self,
        instance: InstanceId,
        size: u32,
        work: impl FnOnce(&mut Self, &Frame) -> Outcome<T>,
    ) -> Outcome<T> {
        let unit = self.instances[instance.0 as usize].unit.clone();
        let base = self.stack.len();
        self.stack.resize(base + size as usize, Value::NONE);
        let frame = Frame { unit: &unit, instance, base, captures: &[], myself: None };
        let result = work(self, &frame);
        self.stack.truncate(base);
        result
    }

    pub(in crate::eval) fn eval_in(
        &mut self,
        instance: InstanceId,
        code: CodeId,
        size: u32,
    ) -> Outcome<Value> {
        self.in_frame(instance, size, |this, frame| this.eval(frame, code))
    }

    fn evaluate_global(&mut self, instance: InstanceId, number: u32) -> Outcome<Value> {
        let unit = self.instances[instance.0 as usize].unit.clone();
        let global = &unit.globals[number as usize];
        match &global.kind {
            GlobalKind::Module(used) => self.used(instance, *used).map(Value::Module),
            GlobalKind::Imported(used, name) => {
                let target = self.used(instance, *used)?;
                self.module_member(target, name, global.name.span)
            }
            GlobalKind::Param(param) => self.param_value(instance, &unit, *param),
            GlobalKind::Output(kind) => {
                let value = self.eval_in(instance, global.value, global.frame)?;
                self.output_value(*kind, value, unit.span(global.value), &global.name.text)
            }
            GlobalKind::Value | GlobalKind::Anonymous | GlobalKind::Export => {
                let value = self.eval_in(instance, global.value, global.frame)?;
                self.typed(value, global.ty.as_ref(), unit.span(global.value))
            }
        }
    }

    /// A part must be a solid, a list is its union; a view must be a drawing, a sheet a page.
    fn output_value(
        &mut self,
        kind: OutputKind,
        value: Value,
        at: Span,
        name: &str,
    ) -> Outcome<Value> {
        let (word, needed) = match kind {
            OutputKind::Part => ("part", "a solid"),
            OutputKind::View => ("view", "a drawing: write `view(...)`"),
            OutputKind::Shade => ("shade", "a picture: write `shade(...)`"),
            OutputKind::Sheet => ("sheet", "a page: write `page(...)`"),
        };
        if kind == OutputKind::Part && Type::Solid.check(&self.graph, &value).is_ok() {
            return Ok(Type::Solid.convert(&mut self.graph, value));
        }
        match (kind, &value) {
            (OutputKind::View, Value::Drawing(_))
            | (OutputKind::Shade, Value::Picture(_))
            | (OutputKind::Sheet, Value::Page(_)) => {
                return Ok(value);
            }
            _ => {}
        }
        let words = format!("the {word} `{name}` needs {needed}, got {}", shown(&value));
        let error = Diagnostic::error(base::Code::WrongKind, words).label(at, "");
        match (kind, &value) {
            (OutputKind::View, Value::Page(_)) => Err(error.help("a page is a `sheet`").into()),
            (OutputKind::Sheet, Value::Drawing(_)) => Err(error
                .help("put it on a page: `page(A4).place(drawing, at = [105, 148])`")
                .into()),
            (OutputKind::Part, Value::Profile(_)) => {
                Err(error.help("make a solid of it with `.extrude(h)`").into())
            }
            _ => Err(error.into()),
        }
    }

    /// The instance behind a `use`.
    fn used(&mut self, instance: InstanceId, number: u32) -> Outcome<InstanceId> {
        let unit = self.instances[instance.0 as usize].unit.clone();
        let used = &unit.uses[number as usize];
        let path = self.relative(&unit, &used.path, used.span)?;
        let given = match used.with {
            Some(with) => {
                let value = self.eval_in(instance, with, used.frame)?;
                let Value::Record(record) = &value else {
                    let words = format!("`with` needs a record, got {}", shown(&value));
                    return fail(base::Code::WrongKind, unit.span(with), words);
                };
                let span = Some(unit.span(with));
                let fields = record.fields().iter();
                fields
                    .map(|(name, value)| Given { name: name.clone(), value: value.clone(), span })
                    .collect()
            }
            None => vec![],
        };
        self.instance(&path, given, used.span)
    }

    /// `self(name = value)`: this file again, with changed parameters.
    pub(super) fn again(
        &mut self,
        frame: &Frame,
        arguments: &[ArgumentCode],
        span: Span,
    ) -> Outcome<Value> {
        if frame.unit.library || frame.instance == InstanceId::LIBRARY {
            return Err(Failure::TOLD);
        }
        let mut call = Call { span, callee: span, ..Call::default() };
        self.arguments(frame, arguments, &mut call)?;
        if let Some((_, at)) = call.positional.first() {
            let message = "`self` takes parameters by name: `self(width = 40mm)`";
            return fail(base::Code::BadCall, *at, message);
        }
        let mut given = self.instances[frame.instance.0 as usize].given.clone();
        for (name, value, _) in call.named {
            given.retain(|known| known.name != name.text);
            given.push(Given { name: name.text, value, span: Some(name.span) });
        }
        self.enter("self".into(), span)?;
        let made = self.instance(&frame.unit.path, given, span);
        self.leave();
        made.map(Value::Module)
    }

    /// The instance of a file with these parameters: an equal one made before, or a new one, whose
    /// parameters and asserts are checked. The tolerance that the first file sets is settled before
    /// its asserts measure anything.
    pub(in crate::eval) fn instance(
        &mut self,
        path: &Arc<str>,
        mut given: Vec<Given>,
        at: Span,
    ) -> Outcome<InstanceId> {
        given.sort_by(|a, b| a.name.cmp(&b.name));
        let unit = self.unit(path, Some(at))?;
        for given in &given {
            self.check_known(&unit, given, at)?;
        }
        if let Some(known) = self.find_instance(path, &given) {
            return match &self.instances[known.0 as usize].refused {
                Some(failure) => Err(failure.clone()),
                None => Ok(known),
            };
        }
        let id = InstanceId(self.instances.len() as u32);
        self.cells_made += unit.globals.len() as u64;
        self.room(0, at)?;
        let is_entry = self.instance_index.is_empty();
        self.instance_index.entry(fingerprint(path, &given)).or_default().push(id);
        self.instances.push(Instance::new(unit, given));
        if is_entry && let Some(mm) = self.tolerance(id) {
            self.host.settle_tolerance(mm);
        }
        match self.admit(id) {
            Ok(()) => {
                self.instances[id.0 as usize].proved = !self.dry;
                Ok(id)
            }
            Err(failure) => {
                self.instances[id.0 as usize].refused = Some(failure.clone());
                Err(failure)
            }
        }
    }

    fn find_instance(&self, path: &str, given: &[Given]) -> Option<InstanceId> {
        let same = |a: &Given, b: &Given| {
            let mut steps = LONGEST_COMPARISON;
            let equal = super::compare::equal(&a.value, &b.value, &mut steps);
            a.name == b.name && equal == Ok(true)
        };
        let candidates = self.instance_index.get(&fingerprint(path, given))?;
        candidates.iter().copied().find(|id| {
            let instance = &self.instances[id.0 as usize];
            *instance.unit.path == *path
                && instance.given.len() == given.len()
                && instance.given.iter().zip(given).all(|(a, b)| same(a, b))
        })
    }

    fn check_known(&self, unit: &Unit, given: &Given, at: Span) -> Outcome<()> {
        let names =
            || unit.params.iter().map(|param| &*unit.globals[param.global as usize].name.text);
        if names().any(|name| *name == *given.name) {
            return Ok(());
        }
        let message = format!("{} has no parameter `{}`", unit.path, given.name);
        // From the command line, a name that is not there is a wrong use of the command.
        let from_outside = at == Span::default();
        let code = if from_outside { base::Code::Usage } else { base::Code::BadParam };
        let error = Diagnostic::error(code, message);
        let error = match given.span.or((at != Span::default()).then_some(at)) {
            Some(span) => error.label(span, ""),
            None => error,
        };
        let list: Vec<String> = names().map(|name| format!("`{name}`")).collect();
        let error = match list.is_empty() {
            true => error.note("it has no parameters"),
            false => error.note(format!("its parameters are {}", list.join(", "))),
        };
        match did_you_mean(&given.name, names()) {
            Some((help, _)) => Err(error.help(help).into()),
            None => Err(error.into()),
        }
    }

    /// Checks parameters and top-level asserts; every fault but the last is recorded at once.
    fn admit(&mut self, id: InstanceId) -> Outcome<()> {
        let unit = self.instances[id.0 as usize].unit.clone();
        let mut result = Ok(());
        for param in &unit.params {
            let at = unit.globals[param.global as usize].name.span;
            let checked = self.global(id, param.global, at).map(|_| ());
            self.keep_first(&mut result, checked);
        }
        result.as_ref().map_err(Failure::clone)?;
        for assert in &unit.asserts {
            let checked = self.in_frame(id, unit.frame, |this, frame| this.assert(frame, assert));
            if self.dry && matches!(&checked, Err(failure) if failure.diagnostic().is_none()) {
                self.skipped = true;
                continue;
            }
            self.keep_first(&mut result, checked);
        }
        result
    }

    fn keep_first(&mut self, result: &mut Outcome<()>, next: Outcome<()>) {
        match (result.is_ok(), next) {
            (true, next) => *result = next,
            (false, Err(failure)) if !self.expecting_failure() => self.report(&failure),
            _ => {}
        }
    }

    fn param_value(
        &mut self,
        instance: InstanceId,
        unit: &Arc<Unit>,
        number: u32,
    ) -> Outcome<Value> {
        let code = &unit.params[number as usize];
        let global = &unit.globals[code.global as usize];
        let default = self.eval_in(instance, global.value, global.frame)?;
        let default = self.typed(default, global.ty.as_ref(), unit.span(global.value))?;
        let given = self.instances[instance.0 as usize].given(&global.name.text).cloned();
        let at = given.as_ref().map_or(Some(unit.span(global.value)), |given| given.span);
        let value = match given {
            None => default,
            Some(given) => {
                let ty = global.ty.clone().unwrap_or_else(|| type_of(&default));
                ty.check(&self.graph, &given.value).map_err(|misfit| {
                    let message = format!("the parameter `{}` {}", global.name.text, misfit.words);
                    placed(Diagnostic::error(misfit.code, message), at)
                        .label(global.name.span, "declared here")
                })?;
                ty.convert(&mut self.graph, given.value)
            }
        };
        self.check_domain(instance, unit, code, value, at)
    }

    fn check_domain(
        &mut self,
        instance: InstanceId,
        unit: &Arc<Unit>,
        code: &ParamCode,
        value: Value,
        at: Option<Span>,
    ) -> Outcome<Value> {
        let Some(domain) = code.domain else { return Ok(value) };
        let span = unit.span(domain);
        let name = &unit.globals[code.global as usize].name.text;
        let choices = self.eval_in(instance, domain, code.frame)?;
        let inside = match (&choices, &value) {
            (Value::Range(range), Value::Number(number, dimension)) => {
                let fits = range.dimension.common(*dimension).is_some();
                fits && range.admits(*number)
            }
            (Value::List(list), value) => {
                let mut found = false;
                for choice in list.iter() {
                    found = found || self.same(choice, value, span)?;
                }
                found
            }
            (other, _) => {
                let words = format!("a parameter lies in a range or a list, got {}", shown(other));
                return fail(base::Code::BadParam, span, words);
            }
        };
        if inside {
            return Ok(value);
        }
        let message =
            format!("the parameter `{name}` is {}; it must be in {choices}", value.literal());
        let error = placed(Diagnostic::error(base::Code::BadParam, message), at);
        let error = error.label(span, "allowed values");
        match (&choices, &value) {
            (Value::Range(range), Value::Number(number, _)) => {
                Err(near_step(error, range, *number).into())
            }
            _ => Err(error.into()),
        }
    }

    /// Says that a definition failed, once.
    pub(in crate::eval) fn report(&mut self, failure: &Failure) {
        if let Some(diagnostic) = failure.diagnostic() {
            self.record(diagnostic.clone());
        }
    }

    /// The united shape of a value of an output or export; `None` when it is no shape.
    pub(in crate::eval) fn as_shape(
        &mut self,
        value: &Value,
        at: Span,
    ) -> Outcome<Option<crate::shape::ShapeId>> {
        let mut ids = vec![];
        if !matches!(value, Value::Solid(_) | Value::Profile(_) | Value::List(_))
            || !collect_shapes(value, &mut ids)
        {
            return Ok(None);
        }
        if ids.is_empty() {
            return Ok(None);
        }
        let (ids, kind) = self.shapes_of(value, at)?;
        Ok(Some(self.unite(ids, kind, at)))
    }

    /// A name of the standard library.
    pub(in crate::eval) fn library_value(&mut self, number: u32) -> Outcome<Value> {
        if let Some(Some(value)) = self.library.get(number as usize) {
            return Ok(value.clone());
        }
        let value = self.load_library(number)?;
        if self.library.len() <= number as usize {
            self.library.resize(number as usize + 1, None);
        }
        self.library[number as usize] = Some(value.clone());
        Ok(value)
    }

    fn load_library(&mut self, number: u32) -> Outcome<Value> {
        let (constant, signatures) = self.declared(number)?;
        Ok(constant.unwrap_or_else(|| overloads(number, signatures)))
    }

    /// What is called when a constant of the library is: `ISO` is a direction, `ISO(5mm)` a mesh of paper.
    pub(super) fn called_constant(&mut self, symbol: Symbol) -> Outcome<Option<Value>> {
        let Some(number) = Index::get().find(symbol.name()) else { return Ok(None) };
        let (_, signatures) = self.declared(number)?;
        Ok((!signatures.is_empty()).then(|| overloads(number, signatures)))
    }

    /// What the declarations of a name of the library say: its value as a constant, and its signatures.
    fn declared(&mut self, number: u32) -> Outcome<(Option<Value>, Vec<Closure>)> {
        let unit = self.library_unit(number)?;
        let frame = Frame {
            unit: &unit,
            instance: InstanceId::LIBRARY,
            base: self.stack.len(),
            captures: &[],
            myself: None,
        };
        let (mut constant, mut signatures) = (None, vec![]);
        for global in &unit.globals {
            let base = self.stack.len();
            self.stack.resize(base + global.frame as usize, Value::NONE);
            let value = self.eval(&frame, global.value);
            self.stack.truncate(base);
            match value? {
                Value::Function(function) => match Arc::try_unwrap(function) {
                    Ok(Function::Closure(closure)) => signatures.push(closure),
                    Ok(function) => constant = Some(Value::Function(Arc::new(function))),
                    Err(shared) => constant = Some(Value::Function(shared)),
                },
                value => constant = Some(value),
            }
        }
        Ok((constant, signatures))
    }

    /// Whether a `test ... fails` is running, whose errors are not for the modeller.
    pub(in crate::eval) fn expecting_failure(&self) -> bool {
        self.test.as_ref().is_some_and(|test| test.fails)
    }
}

/// A function of the library with its signatures.
fn overloads(number: u32, signatures: Vec<Closure>) -> Value {
    let name = Index::get().name(number).into();
    Value::Function(Arc::new(Function::Overloads { name, signatures }))
}

impl CallRecord {
    pub(super) fn shown(&self) -> String {
        match &self.name {
            Some(name) => format!("`{name}`"),
            None => "a lambda".into(),
        }
    }
}

/// Equal for equal parameters; numbers and strings tell most others apart.
fn fingerprint(path: &str, given: &[Given]) -> u64 {
    use std::hash::{Hash, Hasher};
    let mut hasher = rustc_hash::FxHasher::default();
    path.hash(&mut hasher);
    for given in given {
        given.name.hash(&mut hasher);
        match &given.value {
            // 0 and -0 are equal.
            Value::Number(value, _) => (value + 0.0).to_bits().hash(&mut hasher),
            Value::Text(text) => text.hash(&mut hasher),
            _ => {}
        }
    }
    hasher.finish()
}

fn placed(error: Diagnostic, at: Option<Span>) -> Diagnostic {
    match at {
        Some(at) => error.label(at, ""),
        None => error,
    }
}

/// The type a parameter has by its default.
pub fn type_of(default: &Value) -> Type {
    match default {
        Value::Number(_, dimension) => Type::Number(*dimension),
        Value::Bool(_) => Type::Bool,
        Value::Text(_) => Type::String,
        Value::List(_) => Type::List(Box::new(Type::Any)),
        Value::Record(_) => Type::Record,
        Value::Range(_) => Type::Range,
        Value::Function(_) => Type::Function,
        Value::Solid(_) => Type::Solid,
        Value::Profile(_) => Type::Profile,
        Value::Curve(_) => Type::Curve,
        Value::Surface(_) => Type::Surface,
        Value::Field(_) => Type::Field,
        Value::Traced(Traced { dimension: Some(dimension), .. }) => Type::Number(*dimension),
        Value::Traced(_) => Type::Bool,
        Value::Drawing(_) => Type::Drawing,
        Value::Picture(_) => Type::Picture,
        Value::Page(_) => Type::Page,
        Value::Symbol(_) | Value::Module(_) => Type::Any,
    }
}

fn near_step(error: Diagnostic, range: &Range, number: f64) -> Diagnostic {
    let steps = (number - range.start) / range.step;
    let between = steps > 0.0 && steps < range.count().saturating_sub(1) as f64;
    if !(range.explicit && between) {
        return error;
    }
    let (low, high) = (range.element(steps.floor() as u64), range.element(steps.ceil() as u64));
    error.help(format!("the nearest values are {low} and {high}"))
}
