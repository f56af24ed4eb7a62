//! How the parser goes on behind an error: at the end of the bracket or of the statement.

use chumsky::prelude::*;

use super::{
    Extra, Input, Parse,
    reader::{Reader, note, place},
    state::State,
};
use crate::syntax::{
    ast::{Expr, ExprKind, Stmt, StmtKind},
    token::{Token, TokenSet},
};

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

/// Goes behind the end of the innermost bracket open here.
pub(super) fn skip_bracket(input: &mut Reader<'_, '_>) {
    skip_to_closer(input, TokenSet::EMPTY);
    input.skip();
}

/// The rest of a bracket, with its end.
pub(super) fn rest_of_bracket<'s>() -> impl Parse<'s, ()> {
    custom::<_, Input<'s>, _, Extra<'s>>(|input| {
        skip_bracket(input);
        Ok(())
    })
}

/// Whether the statement just read ends here: at a line end, a closing brace or the end of the file.
pub(super) fn ends_statement(input: &mut Reader<'_, '_>) -> bool {
    const END: TokenSet = TokenSet::of(&[Token::Newline, Token::RBrace]);
    let ends = input.peek().is_none_or(|token| END.has(token));
    if !ends {
        note(input, TokenSet::of(&[Token::Newline]));
    }
    ends
}

/// A statement that cannot be read, up to its end. What it would have named stays known.
pub(super) fn broken_stmt(input: &mut Reader<'_, '_>) -> Stmt {
    let start = input.cursor();
    skip_to_closer(input, TokenSet::of(&[Token::Newline]));
    skip_stranded_braces(input);
    let end = place(input);
    let tokens = input.slice_since(&start..);
    named_error(input.state(), tokens, *start.inner(), end)
}

fn named_error(state: &mut State<'_>, tokens: &[Token], start: usize, end: usize) -> Stmt {
    let span = state.span(start, end);
    let error = Expr { kind: ExprKind::Error, span };
    let kind = match defined(tokens) {
        Some(at) => StmtKind::Bind { name: state.name(start + at), ty: None, value: error },
        None => StmtKind::Expr(error),
    };
    Stmt { kind, span }
}

/// Which token of a statement is the name that it defines.
fn defined(tokens: &[Token]) -> Option<usize> {
    const HEADS: TokenSet = TokenSet::OUTPUTS.or(TokenSet::of(&[Token::Param, Token::Fn]));
    let is_name = |at: usize| tokens.get(at).is_some_and(|t| TokenSet::NAMES.has(*t));
    let binds = |at: usize| matches!(tokens.get(at), Some(Token::Assign | Token::Colon));
    let first = usize::from(tokens.first() == Some(&Token::Pub) && is_name(1));
    let head = tokens.get(first).is_some_and(|t| HEADS.has(*t));
    if head && is_name(first + 1) {
        return Some(first + 1);
    }
    (is_name(first) && binds(first + 1)).then_some(first)
}
