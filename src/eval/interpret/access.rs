//! `a.name`: keys of records, names of files, coordinates of points, `.width` of a text, `.vertices` of a curve.

use std::sync::Arc;

use super::super::{
    builtin::point_value,
    evaluator::Evaluator,
    failure::{Outcome, fail},
    library::Index,
    resolve::unknown_name,
    unit::CodeId,
    value::Value,
};
use super::{Frame, sequence::missing_key};
use crate::{
    base::{self, Diagnostic, Span},
    shape::{CurveSpec, Node, ShapeId},
    syntax::ast,
};

impl Evaluator<'_> {
    pub(super) fn member(&mut self, value: Value, at: Span, name: &ast::Name) -> Outcome<Value> {
        if let Some(found) = self.find_member(&value, name)? {
            return Ok(found);
        }
        if let Value::Record(record) = &value {
            return Err(missing_key(record, &name.text, name.span).into());
        }
        let known = Index::get().find(&name.text).is_some();
        let message = format!("{} has no `{}`", value.words(), name.text);
        let error = Diagnostic::error(base::Code::MissingKey, message)
            .label(name.span, "")
            .label(at, value.words());
        match (known, &value) {
            (true, _) => {
                Err(error.help(format!("functions are called: `.{}()`", name.text)).into())
            }
            (_, Value::List(_)) => Err(error
                .help("points have `.x`, `.y` and `.z`; elements are `[0]`, `[1]`, ...")
                .into()),
            _ => Err(error.into()),
        }
    }

    /// A key, name or coordinate; `None` when the value has none of that name.
    pub(super) fn find_member(
        &mut self,
        value: &Value,
        name: &ast::Name,
    ) -> Outcome<Option<Value>> {
        match value {
            Value::Record(record) => Ok(record.get(&name.text).cloned()),
            Value::Module(instance) => {
                self.module_member(*instance, &name.text, name.span).map(Some)
            }
            Value::List(list) if list.len() == 2 || list.len() == 3 => {
                let axis = ["x", "y", "z"].iter().position(|axis| **axis == *name.text);
                Ok(axis.and_then(|axis| list.get(axis).cloned()))
            }
            Value::Profile(id) if &*name.text == "width" => self.text_width(*id, name.span),
            Value::Curve(curve) if &*name.text == "vertices" => Ok(match &**curve {
                CurveSpec::Exact(curve) => {
                    let points = curve.vertices().iter().map(|p| point_value(*p));
                    Some(Value::list(points.collect()))
                }
                CurveSpec::Hatch { .. } => None,
            }),
            _ => Ok(None),
        }
    }

    /// The advance width of a text profile, also behind a tag or colour.
    fn text_width(&mut self, mut id: ShapeId, at: Span) -> Outcome<Option<Value>> {
        loop {
            match self.graph.node(id) {
                Node::Tag { child, .. } | Node::Paint { child, .. } => id = *child,
                Node::Text(spec) => {
                    let spec = spec.clone();
                    let width = self.ask(at, |host, _| host.text_width(&spec))?;
                    return Ok(Some(Value::length(width)));
                }
                _ => return Ok(None),
            }
        }
    }

    /// A name of a file from outside it: parameters, outputs and `pub` names.
    pub(in crate::eval) fn module_member(
        &mut self,
        instance: super::InstanceId,
        name: &str,
        at: Span,
    ) -> Outcome<Value> {
        let unit = self.instances[instance.0 as usize].unit.clone();
        let Some(&number) = unit.names.get(name) else {
            let open = unit.globals.iter().filter(|global| global.is_open());
            let known = open.map(|global| &*global.name.text);
            let wanted = ast::Name { text: name.into(), span: at };
            let error = unknown_name(&wanted, known);
            return Err(error.note(format!("looked for in {}", unit.path)).into());
        };
        let global = &unit.globals[number as usize];
        if !global.is_open() {
            let message = format!("`{name}` is private to {}", unit.path);
            let error = Diagnostic::error(base::Code::Private, message).label(at, "");
            return Err(error
                .label(global.name.span, "defined here without `pub`")
                .help("only parameters, outputs and `pub` names are seen from outside")
                .into());
        }
        self.enter(name.into(), at)?;
        let value = self.global(instance, number, at);
        self.leave();
        value
    }

    /// Calls that a member may be: `module.f(a)`, `record.f(a)`; `None` when the value has no such
    /// member.
    pub(super) fn callable_member(
        &mut self,
        value: &Value,
        name: &ast::Name,
    ) -> Outcome<Option<Value>> {
        match value {
            Value::Record(record) => Ok(record.get(&name.text).cloned()),
            Value::Module(instance) => {
                let unit = &self.instances[instance.0 as usize].unit;
                match unit.names.contains_key(&name.text) {
                    true => self.find_member(value, name),
                    false => Ok(None),
                }
            }
            _ => Ok(None),
        }
    }

    /// Stops at a name that is no function and no member of the object.
    pub(super) fn unknown_method<T>(
        &mut self,
        frame: &Frame,
        object: CodeId,
        value: &Value,
        name: &ast::Name,
    ) -> Outcome<T> {
        if let Value::Module(instance) = value {
            return self.module_member(*instance, &name.text, name.span).and_then(|_| {
                fail(base::Code::WrongKind, frame.unit.span(object), "cannot be called")
            });
        }
        let own: &[(Arc<str>, Value)] = match value {
            Value::Record(record) => record.fields(),
            _ => &[],
        };
        let own = own.iter().map(|(key, _)| &**key);
        let globals = frame.unit.names.keys().map(|name| &**name);
        Err(unknown_name(name, own.chain(globals).chain(Index::get().names())).into())
    }
}
