//! Expressions, and the knot that ties them to blocks.

use std::sync::Arc;

use chumsky::prelude::*;

use super::{
    Boxed, Parse, Production,
    atom::{marked, name, name_before, token},
    operator::or,
    primary::{postfix, primary},
    state::here,
    stmt::block,
};
use crate::syntax::{
    ast::{Expr, ExprKind, Name},
    token::{Token, TokenSet},
};

/// expr = NAME "=>" expr | "(" [ NAME { "," NAME } ] ")" "=>" expr | or
pub(super) fn expr<'s>() -> impl Parse<'s, Expr> {
    recursive(|expr| {
        let block = block(expr.clone());
        let primary = primary(expr.clone(), block);
        let operation = or(postfix(primary, expr.clone()));
        marked(Production::Expr, choice((lambda(expr), operation)))
    })
}

fn lambda<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, Expr> {
    let single = name_before(TokenSet::of(&[Token::FatArrow]));
    let single = single.map(|name| vec![name]).then_ignore(token(Token::FatArrow));
    let several = name().separated_by(token(Token::Comma)).allow_trailing().collect::<Vec<Name>>();
    let several = token(Token::LambdaParen)
        .ignore_then(several)
        .then_ignore(token(Token::RParen))
        .then_ignore(token(Token::FatArrow));
    single
        .or(several)
        .then(expr.map(Arc::new))
        .map_with(|(params, body), extra| {
            let span = here(extra);
            Expr { kind: ExprKind::Lambda { params, body }, span }
        })
        .boxed()
}
