//! The smallest parsers: single tokens, names, numbers, strings.

use std::sync::Arc;

use chumsky::prelude::*;

use super::{Boxed, Extra, Fault, Input, Parse, Production, state::here};
use crate::syntax::{
    ast::{Expr, Name, Piece, Text},
    text,
    token::{Token, TokenSet},
};

/// Any one of the given tokens.
pub(super) fn take<'s>(set: TokenSet) -> impl Parse<'s, Token> {
    custom::<_, Input<'s>, _, Extra<'s>>(move |input| match input.peek() {
        Some(token) if set.has(token) => {
            input.skip();
            Ok(token)
        }
        _ => Err(Fault { at: *input.cursor().inner(), expected: set }),
    })
}

/// This token.
pub(super) fn token<'s>(token: Token) -> impl Parse<'s, Token> {
    take(TokenSet::of(&[token]))
}

/// Marks a production as used where its parser succeeds.
pub(super) fn marked<'s, T: 's>(production: Production, parser: impl Parse<'s, T>) -> Boxed<'s, T> {
    parser
        .map_with(move |value, extra| {
            extra.state().mark(production);
            value
        })
        .boxed()
}

/// NAME
pub(super) fn name<'s>() -> impl Parse<'s, Name> {
    take(TokenSet::NAMES).map_with(|_, extra| {
        let at = extra.span().start;
        extra.state().name(at)
    })
}

/// A NAME before one of the given tokens, which are not read: other names are not looked up, since
/// most of them begin an expression.
pub(super) fn name_before<'s>(next: TokenSet) -> impl Parse<'s, Name> {
    custom::<_, Input<'s>, _, Extra<'s>>(move |input| {
        let at = *input.cursor().inner();
        let named = input.next().is_some_and(|token| TokenSet::NAMES.has(token));
        if !named || !input.peek().is_some_and(|token| next.has(token)) {
            return Err(Fault { at, expected: TokenSet::NAMES });
        }
        Ok(input.state().name(at))
    })
}

/// STRING
pub(super) fn string<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, Text> {
    let literal = token(Token::StringText).map_with(|_, extra| {
        let at = extra.span().start;
        Piece::Literal(text::unescape(extra.state().slice(at)).into())
    });
    let hole = token(Token::HoleOpen)
        .ignore_then(expr.map(|e| Piece::Expr(Box::new(e))))
        .then_ignore(token(Token::HoleClose));
    let pieces = literal.or(hole).repeated().collect();
    let pieces = pieces.map(|mut pieces: Vec<Piece>| {
        pieces.shrink_to_fit();
        pieces
    });
    let string = token(Token::StringStart)
        .ignore_then(pieces)
        .then_ignore(token(Token::StringEnd))
        .map_with(|pieces, extra| Text { pieces, span: here(extra) });
    marked(Production::Text, string)
}

/// DOC NL, once or more: the lines joined.
pub(super) fn doc<'s>() -> Boxed<'s, Arc<str>> {
    let line = token(Token::Doc)
        .map_with(|_, extra| {
            let at = extra.span().start;
            super::state::doc_line(extra.state().slice(at))
        })
        .then_ignore(token(Token::Newline));
    let lines = line.repeated().at_least(1).collect::<Vec<&str>>();
    marked(Production::Doc, lines.map(|lines| lines.join("\n").into()))
}
