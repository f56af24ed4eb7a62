//! Top-level items.

use std::sync::Arc;

use super::{Resolver, duplicate, function::Ending};
use crate::{
    base::{self, Diagnostic},
    eval::{
        unit::{
            Code, CodeId, ExportCode, Global, GlobalKind, ParamCode, Setting, TestCode, Unit,
            UseCode, stem,
        },
        value::Value,
    },
    syntax::ast::{self, Item, ItemKind, StmtKind},
};

impl Unit {
    /// A unit without anything in it yet.
    pub fn new(path: &Arc<str>, text: &Arc<str>, library: bool) -> Unit {
        Unit {
            path: path.clone(),
            text: text.clone(),
            library,
            code: vec![],
            spans: vec![],
            functions: vec![],
            globals: vec![],
            names: Default::default(),
            params: vec![],
            exports: vec![],
            uses: vec![],
            asserts: vec![],
            tests: vec![],
            settings: vec![],
            frame: 0,
            fractions: vec![],
        }
    }
}

/// Stands in for code that is not resolved yet.
const PENDING: CodeId = CodeId(u32::MAX);

impl Resolver<'_> {
    pub fn program(&mut self, program: &ast::Program) {
        self.unit.names.reserve(program.items.len());
        for item in &program.items {
            self.declare(item);
        }
        let mut group = None;
        let mut globals = 0..self.unit.globals.len();
        for item in &program.items {
            self.item(item, &mut group, &mut globals);
        }
    }

    /// Enters the names an item defines, in the order in which `item` will visit them.
    fn declare(&mut self, item: &Item) {
        match &item.kind {
            ItemKind::Use(used) => self.declare_use(used, item),
            ItemKind::Param(param) => {
                let number = self.unit.params.len() as u32;
                self.unit.params.push(ParamCode {
                    global: self.unit.globals.len() as u32,
                    group: None,
                    domain: None,
                    condition: None,
                    frame: 0,
                });
                self.define(&param.name, GlobalKind::Param(number), item, true);
            }
            ItemKind::Output(output) => {
                self.define(&output.name, GlobalKind::Output(output.kind), item, true);
            }
            ItemKind::Export { file, .. } => self.hidden(GlobalKind::Export, file.span, item),
            ItemKind::Stmt { public, stmt } => match &stmt.kind {
                StmtKind::Bind { name, .. } => self.define(name, GlobalKind::Value, item, *public),
                StmtKind::Fn(function) => {
                    if !(self.unit.library && self.unit.names.contains_key(&function.name.text)) {
                        self.define(&function.name, GlobalKind::Value, item, *public);
                    } else {
                        self.hidden(GlobalKind::Value, function.name.span, item);
                    }
                }
                StmtKind::Expr(expr) => self.hidden(GlobalKind::Anonymous, expr.span, item),
                StmtKind::Assert { .. } => {}
            },
            ItemKind::Group(_) | ItemKind::Set { .. } | ItemKind::Test(_) => {}
        }
    }

    fn declare_use(&mut self, used: &ast::Use, item: &Item) {
        let number = self.unit.uses.len() as u32;
        let path = self.use_path(used);
        let with = None;
        self.unit.uses.push(UseCode { path: path.clone(), span: used.path.span, with, frame: 0 });
        match &used.clause {
            ast::UseClause::Module { alias, .. } => {
                let name = alias.clone().unwrap_or_else(|| ast::Name {
                    text: stem(&path).into(),
                    span: used.path.span,
                });
                self.define(&name, GlobalKind::Module(number), item, false);
            }
            ast::UseClause::Names(names) => {
                for taken in names {
                    let here = taken.alias.as_ref().unwrap_or(&taken.name);
                    let kind = GlobalKind::Imported(number, taken.name.text.clone());
                    self.define(here, kind, item, false);
                }
            }
        }
    }

    /// The literal path of a `use`.
    fn use_path(&mut self, used: &ast::Use) -> Arc<str> {
        match &used.path.pieces[..] {
            [] => "".into(),
            [ast::Piece::Literal(path)] => path.clone(),
            _ => {
                let message = "the path of a `use` is fixed: it cannot hold `{...}`";
                let error = Diagnostic::error(base::Code::Syntax, message);
                self.diagnostics.push(error.label(used.path.span, ""));
                "".into()
            }
        }
    }

    fn define(&mut self, name: &ast::Name, kind: GlobalKind, item: &Item, public: bool) {
        let number = self.unit.globals.len() as u32;
        match self.unit.names.get(&name.text) {
            Some(&first) => {
                let first = self.unit.globals[first as usize].name.span;
                self.diagnostics.push(duplicate(&name.text, name.span, first));
            }
            None => {
                self.unit.names.insert(name.text.clone(), number);
            }
        }
        self.push_global(name.clone(), kind, item, public);
    }

    fn hidden(&mut self, kind: GlobalKind, span: base::Span, item: &Item) {
        let text = self.unit.stem().into();
        self.push_global(ast::Name { text, span }, kind, item, false);
    }

    fn push_global(&mut self, name: ast::Name, kind: GlobalKind, item: &Item, public: bool) {
        let doc = item.doc.clone();
        self.unit.globals.push(Global {
            name,
            kind,
            public,
            doc,
            ty: None,
            value: PENDING,
            frame: 0,
        });
    }

    fn item(
        &mut self,
        item: &Item,
        group: &mut Option<Arc<str>>,
        globals: &mut std::ops::Range<usize>,
    ) {
        match &item.kind {
            ItemKind::Use(used) => self.use_item(used, globals),
            ItemKind::Param(param) => self.param(param, group.clone(), globals),
            ItemKind::Group(title) => *group = Some(literal(title)),
            ItemKind::Set { name, value } => {
                if &*name.text == "kernel" && self.refuse_kernel(value) {
                    return;
                }
                let (value, frame) = self.framed(|this| this.expression(value));
                self.unit.settings.push(Setting { name: name.clone(), value, frame });
            }
            ItemKind::Output(output) => self.global(&output.value, None, globals),
            ItemKind::Export { file, value } => self.export(file, value, globals),
            ItemKind::Test(test) => self.test(test, item.span),
            ItemKind::Stmt { stmt, .. } => self.top_level(stmt, globals),
        }
    }

    /// Says that a kernel does not exist when its name is unknown.
    fn refuse_kernel(&mut self, value: &ast::Expr) -> bool {
        let ast::ExprKind::Name(name) = &value.kind else { return false };
        if self.find(&name.text).is_some() {
            return false;
        }
        let message = format!("there is no kernel `{}`", name.text);
        let error = Diagnostic::error(base::Code::UnknownName, message).label(name.span, "");
        self.diagnostics.push(error.help("the kernels are `EXACT`"));
        true
    }

    fn top_level(&mut self, stmt: &ast::Stmt, globals: &mut std::ops::Range<usize>) {
        match &stmt.kind {
            StmtKind::Bind { ty, value, .. } => self.global(value, ty.as_deref(), globals),
            StmtKind::Expr(value) => self.global(value, None, globals),
            StmtKind::Fn(function) => {
                let index = self.function(function, false);
                let value = self.add(Code::Closure(index), function.span);
                self.set_global(globals, value, 0);
            }
            StmtKind::Assert { condition, message } => {
                let (assert, frame) = self.framed(|this| this.assert(condition, message.as_ref()));
                self.unit.asserts.push(assert);
                self.unit.frame = self.unit.frame.max(frame);
            }
        }
    }

    fn global(
        &mut self,
        value: &ast::Expr,
        ty: Option<&ast::Type>,
        globals: &mut std::ops::Range<usize>,
    ) {
        let ty = self.ty(ty);
        let (code, frame) = self.framed(|this| this.expression(value));
        let number = self.set_global(globals, code, frame);
        self.unit.globals[number].ty = ty;
    }

    fn set_global(
        &mut self,
        globals: &mut std::ops::Range<usize>,
        value: CodeId,
        frame: u32,
    ) -> usize {
        let number = globals.next().unwrap_or(0);
        self.unit.globals[number].value = value;
        self.unit.globals[number].frame = frame;
        number
    }

    fn use_item(&mut self, used: &ast::Use, globals: &mut std::ops::Range<usize>) {
        let placeholder = self.constant(Value::NONE, used.path.span);
        match &used.clause {
            ast::UseClause::Names(names) => {
                for _ in names {
                    self.set_global(globals, placeholder, 0);
                }
            }
            ast::UseClause::Module { with, .. } => {
                let global = self.set_global(globals, placeholder, 0);
                let GlobalKind::Module(number) = self.unit.globals[global].kind else { return };
                if let Some(with) = with {
                    let (with, frame) = self.framed(|this| this.expression(with));
                    let used = &mut self.unit.uses[number as usize];
                    (used.with, used.frame) = (Some(with), frame);
                }
            }
        }
    }

    fn param(
        &mut self,
        param: &ast::Param,
        group: Option<Arc<str>>,
        globals: &mut std::ops::Range<usize>,
    ) {
        let ty = self.ty(param.ty.as_deref());
        let (value, frame) = self.framed(|this| this.expression(&param.default));
        let number = self.set_global(globals, value, frame);
        self.unit.globals[number].ty = ty;
        let ((domain, condition), frame) = self.framed(|this| {
            let domain = param.domain.as_ref().map(|domain| this.expression(domain));
            (domain, param.condition.as_ref().map(|condition| this.expression(condition)))
        });
        if let GlobalKind::Param(index) = self.unit.globals[number].kind {
            let code = &mut self.unit.params[index as usize];
            (code.group, code.domain, code.condition, code.frame) =
                (group, domain, condition, frame);
        }
    }

    fn export(
        &mut self,
        file: &ast::Text,
        value: &ast::Expr,
        globals: &mut std::ops::Range<usize>,
    ) {
        let ((file, code), frame) = self.framed(|this| (this.text(file), this.expression(value)));
        let global = self.set_global(globals, code, frame) as u32;
        self.unit.exports.push(ExportCode { file, global });
    }

    fn test(&mut self, test: &ast::Test, span: base::Span) {
        let ((title, fails, body), frame) = self.framed(|this| {
            let title = this.text(&test.title);
            let fails = test.fails.as_ref().map(|fails| this.text(fails));
            (title, fails, this.block(&test.body, Ending::Free))
        });
        self.unit.tests.push(TestCode { title, fails, body, frame, span });
    }
}

fn literal(text: &ast::Text) -> Arc<str> {
    let pieces = text.pieces.iter().map(|piece| match piece {
        ast::Piece::Literal(literal) => &**literal,
        ast::Piece::Expr(_) => "...",
    });
    pieces.collect::<String>().into()
}
