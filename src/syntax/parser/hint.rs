//! A parser's fault in words: what was found, what is needed, and what was probably meant.

use super::fault::Fault;
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

    fn kind(&self, at: usize) -> Option<Token> {
        self.tokens.get(at)
    }

    fn span(&self, at: usize) -> Span {
        match self.tokens.spans.get(at) {
            Some(&(start, _)) if self.kind(at) == Some(Token::Newline) => {
                Span::new(self.source, start, start)
            }
            Some(&(start, end)) => Span::new(self.source, start, end),
            None => {
                let end = self.tokens.spans.last().map_or(0, |span| span.1);
                Span::new(self.source, end, end)
            }
        }
    }

    fn found(&self, at: usize) -> String {
        match self.kind(at) {
            None => "the end of the file".to_string(),
            Some(Token::Newline) => "the end of the line".to_string(),
            Some(Token::StringStart) => "a string".to_string(),
            Some(Token::Doc) => "a documentation comment".to_string(),
            Some(_) => {
                let (start, end) = self.tokens.spans[at];
                format!("`{}`", &self.text[start as usize..end as usize])
            }
        }
    }

    /// The fault in words.
    pub fn diagnostic(&self, fault: &Fault) -> Diagnostic {
        let found = self.found(fault.at);
        let needed = needed(fault.expected);
        Diagnostic::error(Code::Syntax, format!("found {found} where {needed} is needed"))
            .label(self.span(fault.at), format!("{needed} is needed here"))
    }
}

/// What could follow, in words.
fn needed(expected: TokenSet) -> String {
    if expected.meets(TokenSet::of(&[Token::Number])) {
        return "an expression".to_string();
    }
    let _ = expected;
    "something else".to_string()
}
