//! Statements, functions, types and blocks.

use std::{rc::Rc, sync::Arc};

use chumsky::prelude::*;

use super::{
    Boxed, Parse, Production,
    atom::{marked, name, name_before, token},
    reader::{Reader, accept, note, place, reading, recover, run},
    recover::{broken_stmt, ends_statement},
    state::here,
};
use crate::syntax::{
    ast::{Block, Body, Expr, FnParam, Function, Stmt, StmtKind, Type},
    token::{Token, TokenSet},
};

/// block = "{" stmt { NL stmt } "}"
pub(super) fn block<'s>(expr: impl Parse<'s, Expr>) -> impl Parse<'s, Block> {
    recursive(|block| {
        let stmts = Rc::new(Stmts::new(expr, block));
        reading(move |input| {
            let start = place(input);
            accept(input, TokenSet::of(&[Token::LBrace]))?;
            let mut found = vec![];
            loop {
                found.push(stmts.whole(input));
                if accept(input, TokenSet::of(&[Token::Newline])).is_none() {
                    break;
                }
            }
            accept(input, TokenSet::of(&[Token::RBrace]))?;
            found.shrink_to_fit();
            let end = place(input);
            let state = input.state();
            state.mark(Production::Block);
            Some(Block { stmts: found, span: state.span(start, end) })
        })
    })
}

/// The statements, each kind by what it begins with.
pub(super) struct Stmts<'s> {
    expr: Boxed<'s, Option<Expr>>,
    typed: Boxed<'s, Option<StmtKind>>,
    function: Boxed<'s, Option<StmtKind>>,
    assert: Boxed<'s, Option<StmtKind>>,
}

impl<'s> Stmts<'s> {
    pub fn new(expr: impl Parse<'s, Expr>, block: impl Parse<'s, Block>) -> Stmts<'s> {
        let function = fn_(expr.clone(), block).map(|f| StmtKind::Fn(Arc::new(f)));
        Stmts {
            typed: bind(expr.clone()).or_not().boxed(),
            function: function.or_not().boxed(),
            assert: assert(expr.clone()).or_not().boxed(),
            expr: expr.or_not().boxed(),
        }
    }

    /// A statement up to its end; one that cannot be read is left out with a message.
    fn whole(&self, input: &mut Reader<'s, '_>) -> Stmt {
        let before = input.save();
        match self.read(input).filter(|_| ends_statement(input)) {
            Some(stmt) => stmt,
            None => recover(input, before, broken_stmt),
        }
    }

    /// stmt = NAME [":" type] "=" expr | fn | "assert" expr ["," expr] | expr
    pub fn read(&self, input: &mut Reader<'s, '_>) -> Option<Stmt> {
        let start = place(input);
        let kind = self.kind(input)?;
        let end = place(input);
        let state = input.state();
        state.mark(Production::Stmt);
        Some(Stmt { kind, span: state.span(start, end) })
    }

    fn kind(&self, input: &mut Reader<'s, '_>) -> Option<StmtKind> {
        let at = place(input);
        match (input.peek(), input.state().kind(at + 1)) {
            (Some(name), Some(Token::Assign)) if TokenSet::NAMES.has(name) => {
                input.skip();
                input.skip();
                let name = input.state().name(at);
                Some(StmtKind::Bind { name, ty: None, value: run(input, &self.expr)? })
            }
            (Some(name), Some(Token::Colon)) if TokenSet::NAMES.has(name) => {
                run(input, &self.typed)
            }
            (Some(Token::Fn), _) => run(input, &self.function),
            (Some(Token::Assert), _) => run(input, &self.assert).or_else(|| self.value(input)),
            _ => self.value(input),
        }
    }

    fn value(&self, input: &mut Reader<'s, '_>) -> Option<StmtKind> {
        let value = run(input, &self.expr);
        if value.is_none() {
            note(input, TokenSet::of(&[Token::Fn]));
        }
        value.map(StmtKind::Expr)
    }
}

/// NAME [":" type] "=" expr
pub(super) fn bind<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, StmtKind> {
    let name = name_before(TokenSet::of(&[Token::Colon, Token::Assign]));
    let head = name.then(annotation()).then_ignore(token(Token::Assign));
    head.then(expr).map(|((name, ty), value)| StmtKind::Bind { name, ty, value }).boxed()
}

fn assert<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, StmtKind> {
    let message = token(Token::Comma).ignore_then(expr.clone()).or_not();
    let assert = token(Token::Assert).ignore_then(expr).then(message);
    assert.map(|(condition, message)| StmtKind::Assert { condition, message }).boxed()
}

/// fn = "fn" NAME "(" [ fparam { "," fparam } [","] ] ")" ["->" type] ( "=" expr | block )
pub(super) fn fn_<'s>(
    expr: impl Parse<'s, Expr>,
    block: impl Parse<'s, Block>,
) -> Boxed<'s, Function> {
    let params = fparam(expr.clone()).separated_by(token(Token::Comma)).allow_trailing().collect();
    let params = params.delimited_by(token(Token::LParen), token(Token::RParen));
    let result = token(Token::Arrow).ignore_then(type_()).map(Box::new).or_not();
    let expression = token(Token::Assign).ignore_then(expr).map(Body::Expr);
    let body = expression.or(block.map(Body::Block));
    let function = token(Token::Fn).ignore_then(name()).then(params).then(result).then(body);
    let function = function.map_with(|(((name, mut params), result), body), extra| {
        Vec::shrink_to_fit(&mut params);
        let span = here(extra);
        Function { name, params, result, body, span }
    });
    marked(Production::Fn, function)
}

/// fparam = NAME [":" type] ["=" expr]
fn fparam<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, FnParam> {
    let default = token(Token::Assign).ignore_then(expr).or_not();
    let param = name().then(annotation()).then(default);
    marked(Production::FnParam, param.map(|((name, ty), default)| FnParam { name, ty, default }))
}

/// [":" type]
pub(super) fn annotation<'s>() -> Boxed<'s, Option<Box<Type>>> {
    token(Token::Colon).ignore_then(type_()).map(Box::new).or_not().boxed()
}

/// type = NAME ["[" type { "," type } "]"]
fn type_<'s>() -> Boxed<'s, Type> {
    let parser = recursive(|inner| {
        let arguments = inner.separated_by(token(Token::Comma)).at_least(1).collect();
        let arguments = arguments.delimited_by(token(Token::LBracket), token(Token::RBracket));
        name().then(arguments.or_not()).map_with(|(name, arguments), extra| {
            let span = here(extra);
            Type { name, arguments: arguments.unwrap_or_default(), span }
        })
    });
    marked(Production::Type, parser)
}
