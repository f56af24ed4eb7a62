//! The resolve pass: a syntax tree becomes a [`Unit`], in which every name is a slot.
//!
//! Unknown names, second definitions and unknown types are found here, for the whole file at once.

mod expression;
mod function;
mod items;
mod scope;

use std::sync::Arc;

use scope::{Found, Scope};

use super::{
    library::Index,
    nearest::{did_you_mean, here_called},
    types::Type,
    unit::{Capture, Code, CodeId, Unit},
    value::Value,
};
use crate::{
    base::{self, Diagnostic, Span},
    syntax::ast,
};

/// Resolves a file. `library` tells the names of the standard library.
pub fn resolve(
    program: &ast::Program,
    path: &Arc<str>,
    text: &Arc<str>,
    library: &Index,
) -> (Unit, Vec<Diagnostic>) {
    run(program, Unit::new(path, text, false), library)
}

/// Resolves a piece of the library, where `builtin("...")` binds to Rust.
pub fn resolve_library(
    program: &ast::Program,
    unit: Unit,
    library: &Index,
) -> (Unit, Vec<Diagnostic>) {
    run(program, unit, library)
}

fn run(program: &ast::Program, unit: Unit, library: &Index) -> (Unit, Vec<Diagnostic>) {
    let mut resolver = Resolver { library, unit, scopes: vec![], diagnostics: vec![] };
    resolver.program(program);
    (resolver.unit, resolver.diagnostics)
}

struct Resolver<'a> {
    library: &'a Index,
    unit: Unit,
    /// Functions around the current place, the innermost last.
    scopes: Vec<Scope>,
    diagnostics: Vec<Diagnostic>,
}

impl Resolver<'_> {
    fn add(&mut self, code: Code, span: Span) -> CodeId {
        let id = CodeId(self.unit.code.len() as u32);
        self.unit.code.push(code);
        self.unit.spans.push(span);
        id
    }

    fn constant(&mut self, value: Value, span: Span) -> CodeId {
        self.add(Code::Constant(value), span)
    }

    fn broken(&mut self, diagnostic: Diagnostic, span: Span) -> CodeId {
        self.diagnostics.push(diagnostic);
        self.add(Code::Broken, span)
    }

    fn scope(&mut self) -> &mut Scope {
        if self.scopes.is_empty() {
            self.scopes.push(Scope::default());
        }
        let last = self.scopes.len() - 1;
        &mut self.scopes[last]
    }

    /// Resolves something in a frame of its own; gives the number of slots it needs.
    fn framed<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> (T, u32) {
        self.scopes.push(Scope::default());
        let result = work(self);
        let frame = self.scopes.pop().map_or(0, |scope| scope.frame);
        (result, frame)
    }

    /// Binds a name in the innermost block; a second definition there is an error.
    fn bind(&mut self, name: &ast::Name) -> u32 {
        if let Some(first) = self.scope().bound_here(&name.text) {
            let first = first.span;
            self.diagnostics.push(duplicate(&name.text, name.span, first));
        }
        self.scope().bind(name.text.clone(), name.span)
    }

    fn ty(&mut self, written: Option<&ast::Type>) -> Option<Type> {
        match Type::read(written?) {
            Ok(ty) => Some(ty),
            Err(diagnostic) => {
                self.diagnostics.push(diagnostic);
                None
            }
        }
    }

    fn name(&mut self, name: &ast::Name) -> CodeId {
        match self.find(&name.text) {
            Some(code) => self.add(code, name.span),
            None => {
                let unknown = self.unknown(name);
                self.broken(unknown, name.span)
            }
        }
    }

    fn find(&mut self, name: &str) -> Option<Code> {
        if let Some(found) = self.find_from(self.scopes.len(), name) {
            return Some(match found {
                Found::Local(slot) => Code::Local(slot),
                Found::Captured(index) => Code::Captured(index),
                Found::Myself => Code::Myself,
            });
        }
        // In the library a name means all signatures of that name, not the piece at hand.
        if let Some(&global) = self.unit.names.get(name).filter(|_| !self.unit.library) {
            return Some(Code::Global(global));
        }
        self.library.find(name).map(Code::Library)
    }

    /// Looks in the scope below `level` and outwards; what lies farther out is captured on the way.
    fn find_from(&mut self, level: usize, name: &str) -> Option<Found> {
        let index = level.checked_sub(1)?;
        if let Some(found) = self.scopes[index].find(name) {
            return Some(found);
        }
        let capture = match self.find_from(index, name)? {
            Found::Local(slot) => Capture::Local(slot),
            Found::Captured(index) => Capture::Captured(index),
            Found::Myself => Capture::Myself,
        };
        let captures = &mut self.scopes[index].captures;
        captures.push((name.into(), capture));
        Some(Found::Captured(captures.len() as u32 - 1))
    }

    fn unknown(&self, name: &ast::Name) -> Diagnostic {
        /// Unknown names for which near ones are looked up; more are one cause, such as a lost `use`.
        const EXPLAINED: usize = 50;
        if self.diagnostics.len() > EXPLAINED {
            return unknown_name(name, std::iter::empty());
        }
        let locals = self.scopes.iter().flat_map(Scope::names);
        let globals = self.unit.names.keys().map(|name| &**name);
        let known = locals.chain(globals).chain(self.library.names());
        unknown_name(name, known)
    }
}

/// The error for a name that stands for nothing.
pub fn unknown_name<'a>(name: &ast::Name, known: impl Iterator<Item = &'a str>) -> Diagnostic {
    let message = format!("unknown name `{}`", name.text);
    let found = Diagnostic::error(base::Code::UnknownName, message).label(name.span, "not found");
    if let Some(here) = here_called(&name.text) {
        return found.help(format!("here this is `{here}`"));
    }
    match did_you_mean(&name.text, known) {
        Some((help, first)) => found.help(help).fix(name.span, first),
        None => found,
    }
}

fn duplicate(name: &str, second: Span, first: Span) -> Diagnostic {
    Diagnostic::error(base::Code::Duplicate, format!("`{name}` is already defined"))
        .label(second, "defined again here")
        .label(first, "first defined here")
        .help("names are bound once; give the second one another name")
}
