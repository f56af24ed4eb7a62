//! Expressions, and the knot that ties them to blocks.

use std::{rc::Rc, sync::Arc};

use chumsky::prelude::*;

use super::{
    Boxed, Parse, Production,
    atom::{name, token},
    operator::or,
    primary::Forms,
    reader::{Reader, place, reading, run},
    stmt::block,
};
use crate::syntax::{
    ast::{Expr, ExprKind, Name},
    token::{Token, TokenSet},
};

/// Any expression.
pub(super) fn expr<'s>() -> impl Parse<'s, Expr> {
    recursive(|expr| {
        let block = block(expr.clone());
        let forms = Rc::new(Forms::new(expr, block));
        reading(move |input| expression(input, &forms))
    })
}

/// expr = NAME "=>" expr | "(" [ NAME { "," NAME } ] ")" "=>" expr | or
pub(super) fn expression<'s>(input: &mut Reader<'s, '_>, forms: &Forms<'s>) -> Option<Expr> {
    let next = place(input) + 1;
    let is_lambda = match input.peek() {
        Some(Token::LambdaParen) => true,
        Some(token) => {
            TokenSet::NAMES.has(token) && input.state().kind(next) == Some(Token::FatArrow)
        }
        None => false,
    };
    let expr = if is_lambda { run(input, &forms.lambda)? } else { or(input, forms)? };
    input.state().mark(Production::Expr);
    Some(expr)
}

/// NAME "=>" expr | "(" [ NAME { "," NAME } ] ")" "=>" expr
pub(super) fn lambda<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, ExprKind> {
    let single = name().map(|name| vec![name]);
    let several = name().separated_by(token(Token::Comma)).allow_trailing().collect::<Vec<Name>>();
    let several = token(Token::LambdaParen).ignore_then(several).then_ignore(token(Token::RParen));
    let params = single.or(several).then_ignore(token(Token::FatArrow));
    let lambda = params.then(expr.map(Arc::new));
    lambda.map(|(params, body)| ExprKind::Lambda { params, body }).boxed()
}
