//! From tokens to the tree, with chumsky: one function for each production of
//! `grammar/katachi.ebnf`, named like it.
//!
//! What begins with a word or bracket of its own is put together from combinators. Where nearly every
//! token is met (items, statements, operators, calls and single names) the next token decides by
//! itself, so those productions [read](reader) it by hand, inside the same chumsky input.

mod atom;
mod expr;
mod fault;
mod habit;
mod hint;
mod item;
mod operator;
mod primary;
mod production;
mod reader;
mod recover;
mod state;
mod stmt;

use chumsky::prelude::*;

pub use production::{Production, productions};

use self::{fault::Fault, production::Productions, state::State};
use super::{
    ast::Program,
    bracket, depth,
    lexer::{self, Lexed},
    newline,
    token::{Token, Tokens},
};
use crate::base::{Diagnostic, SourceId, Span};

type Input<'s> = &'s [Token];
type Extra<'s> = extra::Full<Fault, State<'s>, ()>;
type Boxed<'s, T> = chumsky::Boxed<'s, 's, Input<'s>, T, Extra<'s>>;

/// Messages beyond these are left out: nobody reads them, and rubbish has a million.
const MAX_DIAGNOSTICS: usize = 100;

/// A parser of this grammar.
trait Parse<'s, T>: Parser<'s, Input<'s>, T, Extra<'s>> + Clone + 's {}
impl<'s, T, P: Parser<'s, Input<'s>, T, Extra<'s>> + Clone + 's> Parse<'s, T> for P {}

/// Reads a whole file. The tree holds everything that could be read: a broken value is an
/// [`ExprKind::Error`](super::ast::ExprKind::Error), so that its name stays known. Diagnostics are
/// in source order, at most one for each mistake. Never panics, whatever the text.
///
/// ```
/// use katachi::{base::SourceId, syntax::parse};
/// let (program, diagnostics) = parse(SourceId(0), "w = 40mm\nh = * 2\nbox(w, 30, 5)\n");
/// assert_eq!(program.items.len(), 3);
/// assert_eq!(diagnostics.len(), 1);
/// ```
pub fn parse(source: SourceId, text: &str) -> (Program, Vec<Diagnostic>) {
    let (program, diagnostics, _) = read(source, text);
    (program, diagnostics)
}

fn read(source: SourceId, text: &str) -> (Program, Vec<Diagnostic>, Productions) {
    let lexed = lexer::lex(source, text);
    let doc = state::file_doc(text, &lexed);
    let Lexed { tokens, mut diagnostics, .. } = lexed;
    let balanced = bracket::balance(source, text, tokens);
    diagnostics.extend(balanced.diagnostics);
    let tokens = depth::limit(source, balanced.tokens, &mut diagnostics);
    let tokens = newline::newlines(text, tokens);
    let mut state = State::new(source, text, &tokens);
    let (items, faults) =
        item::program().parse_with_state(&tokens.kinds, &mut state).into_output_errors();
    let used = state.used();
    diagnostics.sort_by_key(start);
    diagnostics.truncate(MAX_DIAGNOSTICS);
    let known: Vec<Span> = diagnostics.iter().filter_map(Diagnostic::span).collect();
    diagnostics.extend(balanced.semicolons);
    diagnostics.extend(messages(source, text, &tokens, &faults, &known));
    diagnostics.sort_by_key(start);
    diagnostics.truncate(MAX_DIAGNOSTICS);
    let span = Span::new(source, 0, text.len() as u32);
    (Program { doc, items: items.unwrap_or_default(), span }, diagnostics, used)
}

fn start(diagnostic: &Diagnostic) -> u32 {
    diagnostic.span().map_or(0, |span| span.start)
}

/// What the parser's faults mean in words; none where an earlier pass has spoken already.
fn messages(
    source: SourceId,
    text: &str,
    tokens: &Tokens,
    faults: &[Fault],
    known: &[Span],
) -> Vec<Diagnostic> {
    let context = hint::Context::new(source, text, tokens);
    let fresh =
        faults.iter().take(MAX_DIAGNOSTICS).filter(|fault| !context.is_known(fault.at, known));
    fresh.map(|fault| context.diagnostic(fault)).collect()
}

#[cfg(test)]
mod tests;
