//! How the parser goes on behind an error: at the end of the bracket or of the statement.

use chumsky::{input::InputRef, prelude::*};

use super::{Extra, Fault, Input, Parse, state::State};
use crate::syntax::{
    ast::{Expr, ExprKind, Name, Stmt, StmtKind},
    token::{Token, TokenSet},
};

type Reader<'s, 'p> = InputRef<'s, 'p, Input<'s>, Extra<'s>>;

/// Goes up to the bracket that closes the innermost one open here. Brackets are paired, so there
/// is one unless the end of the file comes first.
fn skip_to_closer(input: &mut Reader<'_, '_>, until: TokenSet) {
    let mut depth = 0_usize;
    while let Some(token) = input.peek() {
        if depth == 0 && (until.has(token) || TokenSet::CLOSERS.has(token)) {
            return;
        }
        if TokenSet::OPENERS.has(token) {
            depth += 1;
        } else if TokenSet::CLOSERS.has(token) {
            depth -= 1;
        }
        input.skip();
    }
}

/// Braces on the line behind a broken statement belonged to it.
fn skip_stranded_braces(input: &mut Reader<'_, '_>) {
    let before = input.save();
    if input.next() == Some(Token::Newline) && input.peek() == Some(Token::LBrace) {
        skip_to_closer(input, TokenSet::of(&[Token::Newline]));
    } else {
        input.rewind(before);
    }
}

/// The rest of a bracket, with its end.
pub(super) fn rest_of_bracket<'s>() -> impl Parse<'s, ()> {
    custom::<_, Input<'s>, _, Extra<'s>>(|input| {
        skip_to_closer(input, TokenSet::EMPTY);
        input.skip();
        Ok(())
    })
}

/// The end of a statement, not read: a line end, a closing brace or the end of the file.
pub(super) fn statement_end<'s>() -> impl Parse<'s, ()> {
    const END: TokenSet = TokenSet::of(&[Token::Newline, Token::RBrace]);
    custom::<_, Input<'s>, _, Extra<'s>>(|input| match input.peek() {
        Some(token) if !END.has(token) => {
            Err(Fault { at: *input.cursor().inner(), expected: TokenSet::of(&[Token::Newline]) })
        }
        _ => Ok(()),
    })
}

/// A statement that cannot be read, up to its end. What it would have named stays known.
pub(super) fn broken_stmt<'s>() -> impl Parse<'s, Stmt> {
    custom::<_, Input<'s>, _, Extra<'s>>(|input| {
        let start = *input.cursor().inner();
        let cursor = input.cursor();
        skip_to_closer(input, TokenSet::of(&[Token::Newline]));
        skip_stranded_braces(input);
        let end = *input.cursor().inner();
        let tokens = input.slice_since(&cursor..);
        Ok(named_error(input.state(), tokens, start, end))
    })
}

fn named_error(state: &mut State<'_>, tokens: &[Token], start: usize, end: usize) -> Stmt {
    let span = state.span(start, end);
    let error = Expr { kind: ExprKind::Error, span };
    let kind = match defined(tokens) {
        Some(at) => {
            let at = start + at;
            let name = Name { text: state.word(at), span: state.span(at, at + 1) };
            StmtKind::Bind { name, ty: None, value: error }
        }
        None => StmtKind::Expr(error),
    };
    Stmt { kind, span }
}

/// Which token of a statement is the name that it defines.
fn defined(tokens: &[Token]) -> Option<usize> {
    const HEADS: TokenSet = TokenSet::of(&[
        Token::Part,
        Token::View,
        Token::Shade,
        Token::Sheet,
        Token::Param,
        Token::Fn,
    ]);
    let is_name = |at: usize| tokens.get(at).is_some_and(|t| TokenSet::NAMES.has(*t));
    let binds = |at: usize| matches!(tokens.get(at), Some(Token::Assign | Token::Colon));
    let first = usize::from(tokens.first() == Some(&Token::Pub) && is_name(1));
    let head = tokens.get(first).is_some_and(|t| HEADS.has(*t));
    if head && is_name(first + 1) {
        return Some(first + 1);
    }
    (is_name(first) && binds(first + 1)).then_some(first)
}
