//! The operators, from `or` that binds loosest to `^` that binds tightest.

use chumsky::prelude::*;

use super::{
    Boxed, Parse, Production,
    atom::{take, token},
    state::here,
};
use crate::{
    base::Span,
    syntax::{
        ast::{BinaryOp, Expr, ExprKind, UnaryOp},
        token::{Token, TokenSet},
    },
};

fn op_of(token: Token) -> BinaryOp {
    match token {
        Token::Or => BinaryOp::Or,
        Token::And => BinaryOp::And,
        Token::Equal => BinaryOp::Equal,
        Token::NotEqual => BinaryOp::NotEqual,
        Token::Less => BinaryOp::Less,
        Token::LessEqual => BinaryOp::LessEqual,
        Token::Greater => BinaryOp::Greater,
        Token::GreaterEqual => BinaryOp::GreaterEqual,
        Token::Plus => BinaryOp::Add,
        Token::Minus => BinaryOp::Subtract,
        Token::Join => BinaryOp::Join,
        Token::Star => BinaryOp::Multiply,
        Token::Slash => BinaryOp::Divide,
        Token::Percent => BinaryOp::Remainder,
        Token::Ampersand => BinaryOp::Intersect,
        _ => BinaryOp::Power,
    }
}

fn binary(left: Expr, (op, op_span): (Token, Span), right: Expr) -> Expr {
    let span = left.span.to(right.span);
    let (left, right) = (Box::new(left), Box::new(right));
    Expr { kind: ExprKind::Binary { op: op_of(op), op_span, left, right }, span }
}

fn unary_expr((op, op_span): (UnaryOp, Span), operand: Expr) -> Expr {
    let span = op_span.to(operand.span);
    Expr { kind: ExprKind::Unary { op, op_span, operand: Box::new(operand) }, span }
}

fn sign<'s>(set: TokenSet) -> impl Parse<'s, (Token, Span)> {
    take(set).map_with(|token, extra| (token, here(extra)))
}

/// Operands joined by operators of one precedence, from left to right.
fn left_chain<'s>(
    production: Production,
    operators: TokenSet,
    operand: impl Parse<'s, Expr>,
) -> Boxed<'s, Expr> {
    let tail = sign(operators).then(operand.clone());
    operand
        .foldl_with(tail.repeated(), move |left, (op, right), extra| {
            extra.state().mark(production);
            binary(left, op, right)
        })
        .boxed()
}

/// or = and { "or" and }
pub(super) fn or<'s>(primary: impl Parse<'s, Expr>) -> Boxed<'s, Expr> {
    left_chain(Production::Or, TokenSet::of(&[Token::Or]), and(primary))
}

/// and = not { "and" not }
fn and<'s>(primary: impl Parse<'s, Expr>) -> Boxed<'s, Expr> {
    left_chain(Production::And, TokenSet::of(&[Token::And]), not(primary))
}

/// not = "not" not | cmp
fn not<'s>(primary: impl Parse<'s, Expr>) -> Boxed<'s, Expr> {
    let sign = token(Token::Not).map_with(|_, extra| (UnaryOp::Not, here(extra)));
    sign.repeated()
        .foldr_with(cmp(primary), |op, operand, extra| {
            extra.state().mark(Production::Not);
            unary_expr(op, operand)
        })
        .boxed()
}

/// cmp = range [ ("==" | "!=" | "<" | "<=" | ">" | ">=") range ]
fn cmp<'s>(primary: impl Parse<'s, Expr>) -> Boxed<'s, Expr> {
    let range = range(primary);
    let tail = sign(TokenSet::COMPARISONS).then(range.clone());
    range
        .then(tail.or_not())
        .map_with(|(left, tail), extra| match tail {
            Some((op, right)) => {
                extra.state().mark(Production::Cmp);
                binary(left, op, right)
            }
            None => left,
        })
        .boxed()
}

/// range = sum [ (".." | "..<") sum [ "step" sum ] ]
fn range<'s>(primary: impl Parse<'s, Expr>) -> Boxed<'s, Expr> {
    const DOTS: TokenSet = TokenSet::of(&[Token::DotDot, Token::DotDotLess]);
    let sum = sum(primary);
    let step = token(Token::Step).ignore_then(sum.clone()).or_not();
    let tail = take(DOTS).then(sum.clone()).then(step);
    sum.then(tail.or_not())
        .map_with(|(start, tail), extra| {
            let Some(((dots, end), step)) = tail else { return start };
            let span = here(extra);
            extra.state().mark(Production::Range);
            let kind = ExprKind::Range {
                start: Box::new(start),
                end: Box::new(end),
                inclusive: dots == Token::DotDot,
                step: step.map(Box::new),
            };
            Expr { kind, span }
        })
        .boxed()
}

/// sum = prod { ("+" | "-" | "++") prod }
fn sum<'s>(primary: impl Parse<'s, Expr>) -> Boxed<'s, Expr> {
    const SIGNS: TokenSet = TokenSet::of(&[Token::Plus, Token::Minus, Token::Join]);
    left_chain(Production::Sum, SIGNS, prod(primary))
}

/// prod = unary { ("*" | "/" | "%" | "&") unary }
fn prod<'s>(primary: impl Parse<'s, Expr>) -> Boxed<'s, Expr> {
    const SIGNS: TokenSet =
        TokenSet::of(&[Token::Star, Token::Slash, Token::Percent, Token::Ampersand]);
    left_chain(Production::Prod, SIGNS, unary(primary))
}

/// unary = "-" unary | power
fn unary<'s>(postfix: impl Parse<'s, Expr>) -> Boxed<'s, Expr> {
    recursive(|unary| {
        let sign = token(Token::Minus).map_with(|_, extra| (UnaryOp::Negate, here(extra)));
        sign.repeated().foldr_with(power(postfix, unary), |op, operand, extra| {
            extra.state().mark(Production::Unary);
            unary_expr(op, operand)
        })
    })
    .boxed()
}

/// power = postfix [ "^" unary ]
fn power<'s>(postfix: impl Parse<'s, Expr>, unary: impl Parse<'s, Expr>) -> Boxed<'s, Expr> {
    let tail = sign(TokenSet::of(&[Token::Caret])).then(unary);
    postfix
        .then(tail.or_not())
        .map_with(|(base, tail), extra| match tail {
            Some((op, exponent)) => {
                extra.state().mark(Production::Power);
                binary(base, op, exponent)
            }
            None => base,
        })
        .boxed()
}
