//! Statements, functions, types and blocks.

use std::sync::Arc;

use chumsky::prelude::*;

use super::{
    Boxed, Parse, Production,
    atom::{marked, name, name_before, token},
    recover::{broken_stmt, statement_end},
    state::here,
};
use crate::syntax::{
    ast::{Block, Body, Expr, FnParam, Function, Stmt, StmtKind, Type},
    token::{Token, TokenSet},
};

/// block = "{" stmt { NL stmt } "}"
pub(super) fn block<'s>(expr: impl Parse<'s, Expr>) -> impl Parse<'s, Block> {
    recursive(|block| {
        let whole = stmt(expr, block).then_ignore(statement_end());
        let whole = whole.recover_with(via_parser(broken_stmt())).boxed();
        let stmts = whole.separated_by(token(Token::Newline)).at_least(1).collect();
        let block = token(Token::LBrace)
            .ignore_then(stmts)
            .then_ignore(token(Token::RBrace))
            .map_with(|stmts, extra| Block { stmts, span: here(extra) });
        marked(Production::Block, block)
    })
}

/// stmt = NAME [":" type] "=" expr | fn | "assert" expr ["," expr] | expr
pub(super) fn stmt<'s>(
    expr: impl Parse<'s, Expr>,
    block: impl Parse<'s, Block>,
) -> Boxed<'s, Stmt> {
    let function = fn_(expr.clone(), block).map(|f| StmtKind::Fn(Arc::new(f)));
    let value = expr.clone().map(StmtKind::Expr);
    let kind = choice((bind(expr.clone()), function, assert(expr), value));
    marked(Production::Stmt, kind.map_with(|kind, extra| Stmt { kind, span: here(extra) }))
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
    let result = token(Token::Arrow).ignore_then(type_()).or_not();
    let expression = token(Token::Assign).ignore_then(expr).map(Body::Expr);
    let body = expression.or(block.map(Body::Block));
    let function = token(Token::Fn).ignore_then(name()).then(params).then(result).then(body);
    let function = function.map_with(|(((name, params), result), body), extra| {
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
pub(super) fn annotation<'s>() -> Boxed<'s, Option<Type>> {
    token(Token::Colon).ignore_then(type_()).or_not().boxed()
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
