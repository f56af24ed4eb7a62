//! What a file offers: parameters, outputs, exports, settings.

use std::sync::Arc;

use super::{
    evaluator::Evaluator,
    failure::{Failure, Outcome, fail},
    instance::{Cell, InstanceId},
    nearest::did_you_mean,
    types::{Type, shown},
    unit::{Code as Expression, CodeId, Global, GlobalKind, RecordPart, Unit},
    value::{Symbol, Value},
};
use crate::{
    base::{Code, Diagnostic, Span},
    shape::{PageSpec, ShadeSpec, ShapeId, ViewSpec},
    syntax::ast::OutputKind,
};

/// A parameter of a file.
#[derive(Clone, Debug)]
pub struct ParamInfo {
    /// Its name.
    pub name: Arc<str>,
    /// The text after `///`.
    pub doc: Option<Arc<str>>,
    /// The title of its group.
    pub group: Option<Arc<str>>,
    /// Its type: `Length`, `String`, ...
    pub kind: String,
    /// Its default, if that can be evaluated.
    pub default: Option<Value>,
    /// Its value in this instance, if it is valid.
    pub value: Option<Value>,
    /// What it may be.
    pub domain: Domain,
    /// Whether its `when` holds.
    pub active: bool,
    /// Its name's place.
    pub span: Span,
}

/// What a parameter may be.
#[derive(Clone, Debug)]
pub enum Domain {
    /// Anything of its type.
    Any,
    /// A range of numbers.
    Range {
        /// Smallest value.
        min: Value,
        /// Largest value.
        max: Value,
        /// Distance of the allowed values, where a step is written.
        step: Option<Value>,
    },
    /// One of these.
    Choices(Vec<Value>),
}

/// An output of a file.
#[derive(Clone, PartialEq, Debug)]
pub struct OutputInfo {
    /// Its name; that of the file for the anonymous part.
    pub name: Arc<str>,
    /// Which kind.
    pub kind: OutputKind,
    /// The place of its name, or of the first shape without a name.
    pub span: Span,
    /// The text after `///`.
    pub doc: Option<Arc<str>>,
}

/// What an output is.
#[derive(Clone, PartialEq, Debug)]
pub enum Product {
    /// A solid or plane figure.
    Shape(ShapeId),
    /// A view.
    View(Arc<ViewSpec>),
    /// A picture.
    Shade(Arc<ShadeSpec>),
    /// A page.
    Sheet(Arc<PageSpec>),
}

impl Product {
    /// The shape, if it is one.
    pub fn shape(&self) -> Option<ShapeId> {
        match self {
            Product::Shape(shape) => Some(*shape),
            _ => None,
        }
    }
}

/// An `export` of a file.
#[derive(Clone, PartialEq, Debug)]
pub struct ExportInfo {
    /// The file's name under the output folder; `None` when it could not be evaluated, which has
    /// been said.
    pub file: Option<Arc<str>>,
    /// Its place.
    pub span: Span,
}

/// What an export writes.
#[derive(Clone, PartialEq, Debug)]
pub struct ExportPart {
    /// Its name in the file.
    pub name: String,
    /// What it is.
    pub product: Product,
    /// The output it is, where the export or a field of its record says so by name: `= a`,
    /// `= { lid, base = a }`. An expression, such as `a + b` or `[a, b]`, is a shape of its own.
    pub output: Option<Arc<str>>,
}

impl Global {
    /// Whether it is seen from outside its file.
    pub(super) fn is_open(&self) -> bool {
        self.public || matches!(self.kind, GlobalKind::Param(_) | GlobalKind::Output(_))
    }
}

impl Unit {
    /// The output that an expression is, if it is the name of one.
    fn output(&self, code: CodeId) -> Option<Arc<str>> {
        let Expression::Global(number) = self.code[code.0 as usize] else { return None };
        let global = &self.globals[number as usize];
        matches!(global.kind, GlobalKind::Output(_)).then(|| global.name.text.clone())
    }

    /// The expression of a field, if an expression is a record that has it written out.
    fn field(&self, record: CodeId, wanted: &str) -> Option<CodeId> {
        let Expression::Record(parts) = &self.code[record.0 as usize] else { return None };
        let fields = parts.iter().rev().filter_map(|part| match part {
            RecordPart::Field(name, code) => (**name == *wanted).then_some(*code),
            RecordPart::Spread(_) => None,
        });
        fields.into_iter().next()
    }
}

impl Evaluator<'_> {
    fn unit_of(&self, instance: InstanceId) -> Arc<Unit> {
        self.instances[instance.0 as usize].unit.clone()
    }

    /// The parameters in source order.
    pub fn params(&mut self, instance: InstanceId) -> Vec<ParamInfo> {
        let unit = self.unit_of(instance);
        unit.params.iter().map(|param| self.param_info(instance, &unit, param)).collect()
    }

    fn param_info(
        &mut self,
        instance: InstanceId,
        unit: &Unit,
        param: &super::unit::ParamCode,
    ) -> ParamInfo {
        let global = &unit.globals[param.global as usize];
        let default = self.eval_in(instance, global.value, global.frame).ok();
        let default = match (default, &global.ty) {
            (Some(value), Some(ty)) => self.typed(value, Some(ty), global.name.span).ok(),
            (default, _) => default,
        };
        let domain = param.domain.and_then(|code| self.eval_in(instance, code, param.frame).ok());
        let active = param.condition.map(|code| self.eval_in(instance, code, param.frame));
        let ty = global.ty.clone().or_else(|| default.as_ref().map(super::interpret::type_of));
        ParamInfo {
            name: global.name.text.clone(),
            doc: global.doc.clone(),
            group: param.group.clone(),
            kind: ty.unwrap_or(Type::Any).to_string(),
            value: self.global(instance, param.global, global.name.span).ok(),
            default,
            domain: domain.map_or(Domain::Any, domain_of),
            active: !matches!(active, Some(Ok(Value::Bool(false)))),
            span: global.name.span,
        }
    }

    /// The outputs in source order. Shapes without a name are one part, named after the file; the
    /// expressions they come from are evaluated here, and one that is no shape is warned of.
    pub fn outputs(&mut self, instance: InstanceId) -> Vec<OutputInfo> {
        let unit = self.unit_of(instance);
        let mut outputs: Vec<OutputInfo> = vec![];
        let mut anonymous = false;
        for (number, global) in unit.globals.iter().enumerate() {
            let kind = match global.kind {
                GlobalKind::Output(kind) => kind,
                GlobalKind::Anonymous if !anonymous && self.is_shape(instance, number as u32) => {
                    anonymous = true;
                    OutputKind::Part
                }
                GlobalKind::Anonymous => {
                    self.is_shape(instance, number as u32);
                    continue;
                }
                _ => continue,
            };
            let (name, doc) = (global.name.text.clone(), global.doc.clone());
            outputs.push(OutputInfo { name, kind, span: global.name.span, doc });
        }
        outputs
    }

    /// Whether a top-level expression is a shape, or fails and so leaves it open.
    fn is_shape(&mut self, instance: InstanceId, number: u32) -> bool {
        if self.instances[instance.0 as usize].refused.is_some() {
            return true;
        }
        let unit = self.unit_of(instance);
        let at = unit.globals[number as usize].name.span;
        let value = self.global(instance, number, at);
        match value.and_then(|value| Ok((self.as_shape(&value, at)?, value))) {
            Err(failure) => {
                self.report(&failure);
                true
            }
            Ok((Some(_), _)) => true,
            Ok((None, Value::Symbol(Symbol::None))) => false,
            Ok((None, value)) => {
                let message = format!("this value is not used: {}", shown(&value));
                let help = "give it a name or remove it; only shapes stand alone";
                self.record(Diagnostic::warning(Code::Unused, message).label(at, "").help(help));
                false
            }
        }
    }

    /// Evaluates one output; what goes wrong is recorded and does not touch other outputs.
    #[expect(clippy::result_unit_err, reason = "the reason is among the diagnostics")]
    pub fn product_of(&mut self, instance: InstanceId, output: &str) -> Result<Product, ()> {
        self.steps_taken = 0;
        let result = self.output_product(instance, output);
        result.map_err(|failure| self.report(&failure))
    }

    fn output_product(&mut self, instance: InstanceId, output: &str) -> Outcome<Product> {
        self.admitted(instance)?;
        let unit = self.unit_of(instance);
        let named = unit.globals.iter().position(|global| {
            matches!(global.kind, GlobalKind::Output(_)) && *global.name.text == *output
        });
        if let Some(number) = named {
            let at = unit.globals[number].name.span;
            let value = self.global(instance, number as u32, at)?;
            return match self.as_product(&value, at)? {
                Some(product) => Ok(product),
                None => self.empty_solid(output, at).map(Product::Shape),
            };
        }
        let anonymous = unit.globals.iter().enumerate();
        let anonymous = anonymous.filter(|(_, global)| global.kind == GlobalKind::Anonymous);
        let anonymous: Vec<u32> = anonymous.map(|(number, _)| number as u32).collect();
        if unit.stem() == output && !anonymous.is_empty() {
            return self.anonymous_shape(instance, &unit, &anonymous).map(Product::Shape);
        }
        let names: Vec<Arc<str>> =
            self.outputs(instance).into_iter().map(|info| info.name).collect();
        let message = format!("{} has no output `{output}`", unit.path);
        let error = Diagnostic::error(Code::UnknownName, message);
        Err(match did_you_mean(output, names.iter().map(|name| &**name)) {
            Some((help, _)) => error.help(help),
            None => error.note(format!("its outputs are {}", names.join(", "))),
        }
        .into())
    }

    /// What a value is as an output; `None` when it is none.
    fn as_product(&mut self, value: &Value, at: Span) -> Outcome<Option<Product>> {
        Ok(match value {
            Value::Drawing(view) => Some(Product::View(view.clone())),
            Value::Picture(shade) => Some(Product::Shade(shade.clone())),
            Value::Page(page) => Some(Product::Sheet(page.clone())),
            value => self.as_shape(value, at)?.map(Product::Shape),
        })
    }

    /// What an output is whose list holds no shape.
    fn empty_solid(&mut self, output: &str, at: Span) -> Outcome<ShapeId> {
        let words = format!("`{output}` is empty: its list holds no shape");
        let warning = Diagnostic::warning(Code::EmptyResult, words).label(at, "");
        self.record(warning.help("`EMPTY` says so on purpose"));
        Ok(self.add_node(crate::shape::Node::Empty(crate::shape::Kind::Solid), at))
    }

    /// The union of all shapes without a name.
    fn anonymous_shape(
        &mut self,
        instance: InstanceId,
        unit: &Unit,
        numbers: &[u32],
    ) -> Outcome<ShapeId> {
        let mut shapes = vec![];
        for &number in numbers {
            let at = unit.globals[number as usize].name.span;
            let value = self.global(instance, number, at)?;
            if self.as_shape(&value, at)?.is_none() {
                continue;
            }
            if let Err(misfit) = Type::Solid.check(&self.graph, &value) {
                let words = format!("a shape without a name is a part: it {}", misfit.words);
                let error = Diagnostic::error(misfit.code, words).label(at, "");
                return Err(error.help("make a solid of it with `.extrude(h)`").into());
            }
            shapes.extend(Type::Solid.convert(&mut self.graph, value).shape());
        }
        let at = unit.globals[numbers[0] as usize].name.span;
        Ok(self.unite(shapes, crate::shape::Kind::Solid, at))
    }

    fn admitted(&self, instance: InstanceId) -> Outcome<()> {
        match &self.instances[instance.0 as usize].refused {
            Some(failure) => Err(failure.clone()),
            None => Ok(()),
        }
    }

    /// The exports in source order, their names evaluated.
    pub fn exports(&mut self, instance: InstanceId) -> Vec<ExportInfo> {
        let unit = self.unit_of(instance);
        let mut exports = vec![];
        for export in &unit.exports {
            let global = &unit.globals[export.global as usize];
            let named = self.admitted(instance);
            let file = named.and_then(|()| self.eval_in(instance, export.file, global.frame));
            if let Err(failure) = &file {
                self.report(failure);
            }
            exports.push(ExportInfo {
                file: file.ok().map(|value| value.to_string().into()),
                span: global.name.span,
            });
        }
        exports
    }

    /// The named things that an export writes: one, or the fields of a record.
    #[expect(clippy::result_unit_err, reason = "the reason is among the diagnostics")]
    pub fn export_products(
        &mut self,
        instance: InstanceId,
        index: usize,
    ) -> Result<Vec<ExportPart>, ()> {
        self.steps_taken = 0;
        let result = self.export_parts(instance, index);
        result.map_err(|failure| self.report(&failure))
    }

    fn export_parts(&mut self, instance: InstanceId, index: usize) -> Outcome<Vec<ExportPart>> {
        self.admitted(instance)?;
        let unit = self.unit_of(instance);
        let export = unit.exports.get(index).ok_or(Failure::TOLD)?;
        let global = &unit.globals[export.global as usize];
        let at = unit.span(global.value);
        let value = self.global(instance, export.global, at)?;
        let file = self.eval_in(instance, export.file, global.frame)?.to_string();
        if let Value::Record(record) = &value {
            if record.fields().is_empty() {
                return fail(
                    Code::WrongKind,
                    at,
                    "an export needs something to write, got an empty record",
                );
            }
            let mut parts = vec![];
            for (name, value) in record.fields() {
                let product = self.export_product(value, at, name)?;
                let output = unit.field(global.value, name).and_then(|code| unit.output(code));
                parts.push(ExportPart { name: name.to_string(), product, output });
            }
            return Ok(parts);
        }
        let output = unit.output(global.value);
        let name = output.as_ref().map_or_else(|| file_stem(&file), |name| name.to_string());
        let product = self.export_product(&value, at, &name)?;
        Ok(vec![ExportPart { name, product, output }])
    }

    fn export_product(&mut self, value: &Value, at: Span, name: &str) -> Outcome<Product> {
        match self.as_product(value, at)? {
            Some(product) => Ok(product),
            None => {
                let words = format!(
                    "an export needs a shape, drawing or page for `{name}`, got {}",
                    shown(value)
                );
                fail(Code::WrongKind, at, words)
            }
        }
    }

    /// The chord error in mm that the file sets, if it does. `set kernel` and `set seed` are checked
    /// here too.
    pub fn tolerance(&mut self, instance: InstanceId) -> Option<f64> {
        let unit = self.unit_of(instance);
        let mut tolerance = None;
        for setting in &unit.settings {
            match self.setting(instance, &unit, setting) {
                Ok(found) => tolerance = found.or(tolerance),
                Err(failure) => self.report(&failure),
            }
        }
        tolerance
    }

    fn setting(
        &mut self,
        instance: InstanceId,
        unit: &Unit,
        setting: &super::unit::Setting,
    ) -> Outcome<Option<f64>> {
        let at = unit.span(setting.value);
        match &*setting.name.text {
            "tolerance" => {
                let value = self.eval_in(instance, setting.value, setting.frame)?;
                let length = Type::Number(super::Dimension::LENGTH);
                let value = self.typed(value, Some(&length), at)?;
                match self.plain_number(&value, at)? {
                    mm if mm > 0.0 => Ok(Some(mm)),
                    _ => fail(
                        Code::Degenerate,
                        at,
                        format!("the tolerance must be above 0, got {value}"),
                    ),
                }
            }
            "kernel" => match self.eval_in(instance, setting.value, setting.frame)? {
                Value::Symbol(Symbol::Exact) => Ok(None),
                other => {
                    let message = format!("there is no kernel {}", shown(&other));
                    let error = Diagnostic::error(Code::UnknownName, message).label(at, "");
                    Err(error.help("the kernels are `EXACT`").into())
                }
            },
            "seed" => self.seed(instance, at).map(|_| None),
            name => {
                let message = format!("there is no setting `{name}`");
                let error =
                    Diagnostic::error(Code::UnknownName, message).label(setting.name.span, "");
                Err(error.help("the settings are `tolerance`, `kernel` and `seed`").into())
            }
        }
    }

    /// Evaluates everything that needs no geometry, so that its errors are told: also names that no
    /// output uses. What asks for geometry is skipped. With `asked`, outputs of other names are left
    /// alone, and so are exports.
    pub fn check(&mut self, instance: InstanceId, asked: &[String]) {
        self.steps_taken = 0;
        self.dry = true;
        self.tolerance(instance);
        if self.admitted(instance).is_ok() {
            self.check_globals(instance, asked);
            self.outputs(instance);
            if asked.is_empty() {
                self.exports(instance);
            }
        }
        self.dry = false;
        if std::mem::take(&mut self.skipped) {
            self.forget();
        }
    }

    /// Makes the next request evaluate anew what `check` saw without geometry: instances whose
    /// asserts it skipped, and all values, which may hold such instances.
    fn forget(&mut self) {
        for instance in &mut self.instances {
            instance.cells.fill(Cell::Todo);
        }
        let instances = &self.instances;
        for numbers in self.instance_index.values_mut() {
            numbers.retain(|id| instances[id.0 as usize].proved);
        }
    }

    fn check_globals(&mut self, instance: InstanceId, asked: &[String]) {
        let unit = self.unit_of(instance);
        let is_asked = |global: &Global| match global.kind {
            GlobalKind::Anonymous => false,
            GlobalKind::Output(_) => {
                asked.is_empty() || asked.iter().any(|name| **name == *global.name.text)
            }
            GlobalKind::Export => asked.is_empty(),
            _ => true,
        };
        for (number, global) in unit.globals.iter().enumerate() {
            if !is_asked(global) {
                continue;
            }
            if let Err(failure) = self.global(instance, number as u32, global.name.span) {
                self.report(&failure);
            }
        }
        for param in &unit.params {
            let Some(code) = param.condition else { continue };
            let checked =
                self.in_frame(instance, param.frame, |this, frame| this.truth(frame, code));
            if let Err(failure) = checked {
                self.report(&failure);
            }
        }
    }
}

fn domain_of(value: Value) -> Domain {
    match value {
        Value::Range(range) => {
            let number = |x| Value::Number(x, range.dimension);
            Domain::Range {
                min: number(range.start),
                max: number(range.end),
                step: range.explicit.then(|| number(range.step)),
            }
        }
        Value::List(list) => Domain::Choices(list.to_vec()),
        _ => Domain::Any,
    }
}

/// A file's name without folder and ending.
fn file_stem(file: &str) -> String {
    let name = file.rsplit('/').next().unwrap_or(file);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_string()
}
