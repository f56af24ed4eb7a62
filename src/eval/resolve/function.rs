//! Functions, lambdas, blocks and statements.

use std::sync::Arc;

use super::{Resolver, scope::Scope};
use crate::{
    base::{self, Diagnostic, Span},
    eval::{
        builtin,
        unit::{AssertCode, Body, Code, CodeId, FunctionCode, Parameter, Step},
        value::Value,
    },
    syntax::ast::{self, ExprKind, StmtKind},
};

/// What the last statement of a block must be.
#[derive(Clone, Copy, PartialEq)]
pub enum Ending {
    /// A value.
    Value,
    /// A value, or an `if` without `else`: the body of a `for`.
    Element,
    /// Anything: the body of a test.
    Free,
}

impl Resolver<'_> {
    /// A named function; `local` ones may call themselves by a slot of their own.
    pub fn function(&mut self, function: &ast::Function, local: bool) -> u32 {
        let mut scope = Scope::default();
        scope.myself = local.then(|| function.name.text.clone());
        self.scopes.push(scope);
        self.scope().open();
        let params = self.parameters(&function.params);
        let native = self.native(function);
        let body = match (&native, &function.body) {
            (Some(native), _) => Body::Native(*native),
            (None, ast::Body::Expr(expr)) => Body::Code(self.expression(expr)),
            (None, ast::Body::Block(block)) => Body::Code(self.block(block, Ending::Value)),
        };
        let result = self.ty(function.result.as_deref());
        self.finish(Some(function.name.text.clone()), params, body, result)
    }

    /// A lambda.
    pub fn lambda(&mut self, params: &[ast::Name], body: &ast::Expr) -> u32 {
        self.scopes.push(Scope::default());
        self.scope().open();
        let params: Vec<Parameter> = params
            .iter()
            .map(|name| {
                self.bind(name);
                Parameter { name: name.text.clone(), ty: None, default: None }
            })
            .collect();
        let body = Body::Code(self.expression(body));
        self.finish(None, params, body, None)
    }

    fn parameters(&mut self, params: &[ast::FnParam]) -> Vec<Parameter> {
        params
            .iter()
            .map(|param| {
                let ty = self.ty(param.ty.as_deref());
                let default = param.default.as_ref().map(|default| self.expression(default));
                self.bind(&param.name);
                Parameter { name: param.name.text.clone(), ty, default }
            })
            .collect()
    }

    fn finish(
        &mut self,
        name: Option<Arc<str>>,
        params: Vec<Parameter>,
        body: Body,
        result: Option<crate::eval::types::Type>,
    ) -> u32 {
        let scope = self.scopes.pop().unwrap_or_default();
        let plain = params.iter().all(|param| param.ty.is_none() && param.default.is_none());
        let simple = plain && result.is_none() && matches!(body, Body::Code(_));
        self.unit.functions.push(Arc::new(FunctionCode {
            name,
            params: params.into(),
            captures: scope.captures.into_iter().map(|(_, capture)| capture).collect(),
            frame: scope.frame,
            body,
            result,
            simple,
        }));
        self.unit.functions.len() as u32 - 1
    }

    /// The Rust function behind `= builtin("name")` in the library.
    fn native(&mut self, function: &ast::Function) -> Option<builtin::Native> {
        let ast::Body::Expr(expr) = &function.body else { return None };
        let ExprKind::Call { callee, arguments } = &expr.kind else { return None };
        self.native_value(callee, arguments)
    }

    /// The Rust function behind `builtin("name")`, in the library only.
    pub fn native_value(
        &self,
        callee: &ast::Expr,
        arguments: &[ast::Argument],
    ) -> Option<builtin::Native> {
        let ExprKind::Name(name) = &callee.kind else { return None };
        let [ast::Argument::Positional(argument)] = arguments else { return None };
        let ExprKind::Text(text) = &argument.kind else { return None };
        match (&text.pieces[..], self.unit.library && &*name.text == "builtin") {
            ([ast::Piece::Literal(name)], true) => builtin::find(name),
            _ => None,
        }
    }

    /// A block in a scope of its own.
    pub fn block(&mut self, block: &ast::Block, ending: Ending) -> CodeId {
        self.scope().open();
        let code = self.open_block(block, ending);
        self.scope().close();
        code
    }

    fn open_block(&mut self, block: &ast::Block, ending: Ending) -> CodeId {
        let (last, before) = match block.stmts.split_last() {
            Some((last, before)) => (Some(last), before),
            None => (None, &block.stmts[..]),
        };
        let mut steps: Vec<Step> = before.iter().map(|stmt| self.step(stmt)).collect();
        let value = match last.map(|stmt| (&stmt.kind, stmt)) {
            Some((StmtKind::Expr(expr), _)) => self.ending(expr, ending),
            Some((_, stmt)) if ending == Ending::Free => {
                steps.push(self.step(stmt));
                self.constant(Value::NONE, block.span)
            }
            Some((_, stmt)) => {
                steps.push(self.step(stmt));
                self.broken(no_value(stmt.span), block.span)
            }
            None => self.add(Code::Broken, block.span),
        };
        if steps.is_empty() {
            return value;
        }
        self.add(Code::Block(steps.into(), value), block.span)
    }

    fn ending(&mut self, expr: &ast::Expr, ending: Ending) -> CodeId {
        match (&expr.kind, ending) {
            (ExprKind::If(decision), Ending::Element) => self.decision(decision, ending, expr.span),
            _ => self.expression(expr),
        }
    }

    /// `if`; without `else` only where an element may be dropped.
    pub fn decision(&mut self, decision: &ast::If, ending: Ending, span: Span) -> CodeId {
        if decision.otherwise.is_none() && ending != Ending::Element {
            let message = "this `if` has no `else`, so it has no value when its condition is false";
            let error = Diagnostic::error(base::Code::Syntax, message).label(span, "").help(
                "add `else { ... }`; only as the last line of a `for` body may it be left out",
            );
            return self.broken(error, span);
        }
        let condition = self.expression(&decision.condition);
        let then = self.block(&decision.then, ending);
        let otherwise = decision.otherwise.as_ref().map(|block| self.block(block, ending));
        self.add(Code::If { condition, then, otherwise }, span)
    }

    fn step(&mut self, stmt: &ast::Stmt) -> Step {
        match &stmt.kind {
            StmtKind::Bind { name, ty, value } => {
                let ty = self.ty(ty.as_deref());
                let value = self.expression(value);
                Step::Bind { slot: self.bind(name), value, ty }
            }
            StmtKind::Fn(function) => {
                let index = self.function(function, true);
                let value = self.add(Code::Closure(index), function.span);
                Step::Bind { slot: self.bind(&function.name), value, ty: None }
            }
            StmtKind::Assert { condition, message } => {
                Step::Assert(self.assert(condition, message.as_ref()))
            }
            StmtKind::Expr(expr) => Step::Drop(self.expression(expr)),
        }
    }

    pub fn assert(&mut self, condition: &ast::Expr, message: Option<&ast::Expr>) -> AssertCode {
        let condition = self.expression(condition);
        AssertCode { condition, message: message.map(|message| self.expression(message)) }
    }
}

fn no_value(span: Span) -> Diagnostic {
    Diagnostic::error(base::Code::Syntax, "this block has no value")
        .label(span, "the last line of a block must be an expression")
        .help("end the block with the value it should have")
}
