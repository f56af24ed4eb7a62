//! A parser's fault in words: what was found, what is needed, and what was probably meant.

use super::{fault::Fault, habit};
use crate::{
    base::{Code, Diagnostic, SourceId, Span},
    syntax::token::{Token, TokenSet, Tokens},
};

/// The text around a fault.
pub(super) struct Context<'s> {
    source: SourceId,
    text: &'s str,
    tokens: &'s Tokens,
}

impl<'s> Context<'s> {
    pub fn new(source: SourceId, text: &'s str, tokens: &'s Tokens) -> Context<'s> {
        Context { source, text, tokens }
    }

    /// Whether an earlier pass has reported something on the statement of this token.
    pub fn is_known(&self, at: usize, known: &[Span]) -> bool {
        if known.is_empty() {
            return false;
        }
        let is_end = |kind: &Token| *kind == Token::Newline;
        let kinds = &self.tokens.kinds;
        let at = at.min(kinds.len());
        let first = kinds[..at].iter().rposition(is_end).map_or(0, |i| i + 1);
        let last = kinds[at..].iter().position(is_end).map_or(kinds.len(), |i| at + i);
        let start = self.tokens.spans.get(first).map_or(0, |span| span.0);
        let end = self.tokens.spans.get(last).map_or(self.text.len() as u32, |span| span.1);
        known.iter().any(|span| span.start <= end && span.end >= start)
    }

    pub fn kind(&self, at: usize) -> Option<Token> {
        self.tokens.get(at)
    }

    /// The token before the one at `at`.
    pub fn before(&self, at: usize) -> Option<Token> {
        at.checked_sub(1).and_then(|before| self.kind(before))
    }

    /// The characters of a token; none behind the end.
    pub fn word(&self, at: usize) -> &'s str {
        let span = self.tokens.spans.get(at);
        span.map_or("", |&(start, end)| &self.text[start as usize..end as usize])
    }

    /// The place of a token; an empty one at the end of the line or the file.
    pub fn span(&self, at: usize) -> Span {
        match self.tokens.spans.get(at) {
            Some(&(start, _)) if self.kind(at) == Some(Token::Newline) => {
                Span::new(self.source, start, start)
            }
            Some(&(start, end)) => Span::new(self.source, start, end),
            None => self.behind(self.tokens.len()),
        }
    }

    /// The empty place behind the token before the one at `at`.
    pub fn behind(&self, at: usize) -> Span {
        let end = at.checked_sub(1).map_or(0, |before| self.tokens.spans[before].1);
        Span::new(self.source, end, end)
    }

    /// Index of the innermost bracket open at a token, looked for in the last few tokens.
    pub fn opener(&self, at: usize) -> Option<usize> {
        let mut depth = 0_usize;
        for index in (0..at).rev().take(FAR) {
            let token = self.tokens.kinds[index];
            if TokenSet::CLOSERS.has(token) {
                depth += 1;
            } else if TokenSet::OPENERS.has(token) {
                if depth == 0 {
                    return Some(index);
                }
                depth -= 1;
            }
        }
        None
    }

    /// Index of the nearest of the given tokens before `at` on its line.
    pub fn nearest(&self, at: usize, set: TokenSet) -> Option<usize> {
        let kinds = &self.tokens.kinds;
        let line = (0..at).rev().take(FAR).take_while(|&i| kinds[i] != Token::Newline);
        line.into_iter().find(|&i| set.has(kinds[i]))
    }

    fn found(&self, at: usize) -> String {
        match self.kind(at) {
            None => "the end of the file".to_string(),
            Some(Token::Newline) => "the end of the line".to_string(),
            Some(Token::StringStart) => "a string".to_string(),
            Some(Token::Doc) => "a documentation comment".to_string(),
            Some(_) => format!("`{}`", self.word(at)),
        }
    }

    /// The fault in words.
    pub fn diagnostic(&self, fault: &Fault) -> Diagnostic {
        habit::recognise(self, fault).unwrap_or_else(|| self.plain(fault))
    }

    fn plain(&self, fault: &Fault) -> Diagnostic {
        let (found, needed) = (self.found(fault.at), needed(fault.expected));
        let message = format!("found {found} where {needed} is needed");
        Diagnostic::error(Code::Syntax, message)
            .label(self.span(fault.at), format!("{needed} is needed here"))
    }
}

/// How many tokens back the cause of a fault is looked for.
const FAR: usize = 2000;

/// What could follow, in words. What could only lengthen the expression before is left out.
fn needed(expected: TokenSet) -> String {
    const LENGTHENING: TokenSet = TokenSet::OPERATORS.or(TokenSet::of(&[
        Token::Dot,
        Token::LParen,
        Token::LambdaParen,
        Token::LBracket,
        Token::FatArrow,
        Token::Step,
    ]));
    if expected.has(Token::Fn) {
        return "a statement".to_string();
    }
    if expected.has(Token::Number) {
        return "an expression".to_string();
    }
    let names = expected.has(Token::Name);
    let mut rest = expected.without(LENGTHENING);
    if names {
        rest = rest.without(TokenSet::NAMES).or(TokenSet::of(&[Token::Name]));
    }
    if rest == TokenSet::EMPTY {
        rest = expected.without(TokenSet::OPERATORS);
    }
    if rest.has(Token::Newline) {
        return "the end of the line".to_string();
    }
    let words: Vec<&str> = rest.iter().map(Token::describe).collect();
    match words.split_last() {
        Some((last, [])) => last.to_string(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
        None => "something else".to_string(),
    }
}
