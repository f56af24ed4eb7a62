//! What the parser needs beside the tokens: their places, the text, and names already seen.

use std::sync::Arc;

use chumsky::{
    input::{Checkpoint, Cursor, MapExtra},
    inspector::Inspector,
};
use rustc_hash::{FxBuildHasher, FxHashMap};
use unicode_normalization::{UnicodeNormalization, is_nfc};

use super::{Extra, Input, Production, Productions};
use crate::{
    base::{SourceId, Span},
    syntax::{
        ast::{Argument, Expr, ExprKind, Name},
        lexer::Lexed,
        number,
        token::{Token, Tokens},
    },
};

/// Bytes of text for which a new name is expected.
const NAMED: usize = 64;

pub(super) struct State<'s> {
    /// Elements of the lists that are being read.
    pub rows: Rows,
    source: SourceId,
    text: &'s str,
    kinds: &'s [Token],
    spans: &'s [(u32, u32)],
    names: FxHashMap<&'s str, Arc<str>>,
    used: Productions,
}

impl<'s> State<'s> {
    pub fn new(source: SourceId, text: &'s str, tokens: &'s Tokens) -> State<'s> {
        State {
            rows: Rows::default(),
            source,
            text,
            kinds: &tokens.kinds,
            spans: &tokens.spans,
            names: FxHashMap::with_capacity_and_hasher(text.len() / NAMED, FxBuildHasher),
            used: Productions::default(),
        }
    }

    pub fn used(&self) -> Productions {
        self.used
    }

    pub fn mark(&mut self, production: Production) {
        self.used.add(production);
    }

    /// The bytes from the first to the last of the tokens `start..end`; where there are none, the
    /// place behind the token before.
    pub fn span(&self, start: usize, end: usize) -> Span {
        if start < end {
            return Span::new(self.source, self.spans[start].0, self.spans[end - 1].1);
        }
        let at = start.checked_sub(1).map_or(0, |before| self.spans[before].1);
        Span::new(self.source, at, at)
    }

    /// The token of an index.
    pub fn kind(&self, index: usize) -> Option<Token> {
        self.kinds.get(index).copied()
    }

    /// The characters of one token.
    pub fn slice(&self, index: usize) -> &'s str {
        let (start, end) = self.spans[index];
        &self.text[start as usize..end as usize]
    }

    /// The name that one token is.
    pub fn name(&mut self, index: usize) -> Name {
        self.mark(Production::Name);
        Name { text: self.word(index), span: self.span(index, index + 1) }
    }

    /// The word of one token in Unicode NFC; equal words share their text.
    fn word(&mut self, index: usize) -> Arc<str> {
        let word = self.slice(index);
        let normal =
            || if is_nfc(word) { word.into() } else { word.nfc().collect::<String>().into() };
        self.names.entry(word).or_insert_with(normal).clone()
    }

    /// The expression that a token is by itself: a number, a truth value, a name, or a bad one.
    pub fn atom(&mut self, token: Token, index: usize) -> Expr {
        let kind = match token {
            Token::Number => self.number(index),
            Token::True | Token::False => ExprKind::Bool(token == Token::True),
            Token::Bad => ExprKind::Error,
            _ => ExprKind::Name(self.name(index)),
        };
        Expr { kind, span: self.span(index, index + 1) }
    }

    fn number(&mut self, index: usize) -> ExprKind {
        self.mark(Production::Number);
        // The lexer has refused what cannot be read.
        match number::read(self.slice(index)) {
            Ok((value, unit)) => ExprKind::Number { value, unit },
            Err(_) => ExprKind::Error,
        }
    }
}

/// Elements of lists that are being read: those of an inner list stand behind those of the outer.
#[derive(Default)]
pub(super) struct Rows {
    arguments: Vec<Argument>,
    exprs: Vec<Expr>,
}

impl AsMut<Vec<Argument>> for Rows {
    fn as_mut(&mut self) -> &mut Vec<Argument> {
        &mut self.arguments
    }
}

impl AsMut<Vec<Expr>> for Rows {
    fn as_mut(&mut self) -> &mut Vec<Expr> {
        &mut self.exprs
    }
}

/// Productions marked on a path that is given up do not count.
impl<'s> Inspector<'s, Input<'s>> for State<'s> {
    type Checkpoint = Productions;

    fn on_token(&mut self, _: &Token) {}

    fn on_save<'p>(&self, _: &Cursor<'s, 'p, Input<'s>>) -> Productions {
        self.used
    }

    fn on_rewind<'p>(&mut self, marker: &Checkpoint<'s, 'p, Input<'s>, Productions>) {
        self.used = *marker.inspector();
    }
}

/// The bytes that the parser just run has read.
pub(super) fn here<'s>(extra: &mut MapExtra<'s, '_, Input<'s>, Extra<'s>>) -> Span {
    let range = extra.span();
    extra.state().span(range.start, range.end)
}

/// The `//!` lines of a file, joined by line ends.
pub(super) fn file_doc(text: &str, lexed: &Lexed) -> Option<Arc<str>> {
    let comments = lexed.comments.iter().filter(|(kind, _)| *kind == Token::FileDoc);
    let lines: Vec<&str> =
        comments.map(|(_, span)| doc_line(&text[span.start as usize..span.end as usize])).collect();
    if lines.is_empty() { None } else { Some(lines.join("\n").into()) }
}

/// What stands behind `///` or `//!`, without the space after it.
pub(super) fn doc_line(comment: &str) -> &str {
    let line = comment[3..].trim_end();
    line.strip_prefix(' ').unwrap_or(line)
}
