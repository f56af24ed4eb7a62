//! Pairs of brackets. Behind this pass every bracket has its partner, so that the parser meets no
//! missing one and a mistake in one place does not swallow the rest of the file.

use super::token::{Token, TokenSet, Tokens};
use crate::base::{Code, Diagnostic, SourceId, Span};

/// Tokens with paired brackets, and what had to be said.
pub struct Balanced {
    /// The tokens.
    pub tokens: Tokens,
    /// Missing and needless brackets.
    pub diagnostics: Vec<Diagnostic>,
    /// The `;` found, in one message.
    pub semicolons: Option<Diagnostic>,
}

/// Pairs the brackets: closing ones that close nothing are dropped, missing ones are put at the end
/// of the line before the text moves back out. Also tells the `(` of a lambda from other ones, and
/// takes `;` for a line end.
pub fn balance(source: SourceId, text: &str, tokens: Tokens) -> Balanced {
    let kinds = tokens.kinds.clone();
    let mut pass = Balance { source, text, tokens, ..Balance::default() };
    pass.run();
    if !pass.dropped.is_empty() || !pass.inserted.is_empty() {
        // A bracket is missing somewhere: now lines that look like statements end what is open.
        let tokens = Tokens { kinds, ..pass.tokens };
        pass = Balance { source, text, tokens, strict: true, ..Balance::default() };
        pass.run();
    }
    pass.finish()
}

#[derive(Default)]
struct Balance<'s> {
    source: SourceId,
    text: &'s str,
    tokens: Tokens,
    /// Whether a line that looks like a statement ends open parentheses.
    strict: bool,
    /// The open brackets.
    open: Vec<Opener>,
    /// Index of the first token of the line.
    line: usize,
    /// The line of an opener, the limit, and the place last found for them.
    last_place: Option<(usize, usize, usize)>,
    /// How many of them are of each kind.
    counts: [usize; 4],
    /// Tokens to leave out.
    dropped: Vec<usize>,
    /// Closing brackets to put before the token of this index.
    inserted: Vec<(usize, Token)>,
    semicolons: Vec<usize>,
    diagnostics: Vec<Diagnostic>,
}

/// An open bracket and the first token of its line, by index.
#[derive(Clone, Copy)]
struct Opener {
    at: usize,
    line: usize,
}

fn closer_of(opener: Token) -> Token {
    match opener {
        Token::LBracket => Token::RBracket,
        Token::LBrace => Token::RBrace,
        Token::HoleOpen => Token::HoleClose,
        _ => Token::RParen,
    }
}

fn kind_of(closer: Token) -> usize {
    match closer {
        Token::RParen => 0,
        Token::RBracket => 1,
        Token::RBrace => 2,
        _ => 3,
    }
}

impl Balance<'_> {
    fn run(&mut self) {
        for index in 0..self.tokens.len() {
            self.take(index);
        }
        self.close_all(self.tokens.len(), 0);
    }

    fn take(&mut self, index: usize) {
        let token = self.tokens.kinds[index];
        if TokenSet::OPENERS.has(token) {
            self.open.push(Opener { at: index, line: self.line });
            self.counts[kind_of(closer_of(token))] += 1;
        } else if TokenSet::CLOSERS.has(token) {
            self.close(index, token);
        } else if token == Token::Semicolon {
            self.semicolon(index);
        } else if token == Token::Newline {
            self.line = index + 1;
            if self.strict && self.starts_statement(index + 1) {
                self.end_lists(index);
            }
        }
    }

    /// Whether a line begins with `name =`, or with a word that begins an item and a name.
    fn starts_statement(&self, index: usize) -> bool {
        const HEADS: TokenSet = TokenSet::NAMES.or(TokenSet::of(&[Token::Fn])).without(PLAIN);
        const PLAIN: TokenSet = TokenSet::of(&[
            Token::Name,
            Token::As,
            Token::With,
            Token::Step,
            Token::When,
            Token::Fails,
        ]);
        let (Some(first), Some(second)) = (self.tokens.get(index), self.tokens.get(index + 1))
        else {
            return false;
        };
        let named = TokenSet::NAMES.has(second) || second == Token::StringStart;
        (TokenSet::NAMES.has(first) && second == Token::Assign) || (HEADS.has(first) && named)
    }

    /// Closes the parentheses and square brackets open at a line end, if the next line is not
    /// indented deeper than the line that opened them.
    fn end_lists(&mut self, newline: usize) {
        let indent = self.indent(newline + 1);
        let ends = |open: &Opener| {
            self.tokens.kinds[open.at] != Token::LBrace && indent <= self.indent(open.line)
        };
        let keep = self.open.iter().rposition(|open| !ends(open)).map_or(0, |at| at + 1);
        self.close_all(newline, keep);
    }

    fn close(&mut self, index: usize, closer: Token) {
        if self.counts[kind_of(closer)] > 0 {
            let matches = |open: &Opener| closer_of(self.tokens.kinds[open.at]) == closer;
            let depth = self.open.iter().rposition(matches).unwrap_or(0);
            self.close_all(index, depth + 1);
            self.pop(index);
        } else if let Some(&opener) = self.open.last()
            && opener.line == self.line
        {
            self.swap(opener.at, index, closer);
        } else {
            self.dropped.push(index);
            let span = self.span(index);
            let message = format!("this {} closes nothing", closer.describe());
            self.diagnostics.push(
                Diagnostic::error(Code::Syntax, message)
                    .label(span, "no bracket is open here")
                    .help("remove it, or open it before")
                    .fix(span, ""),
            );
        }
    }

    /// Takes the innermost open bracket as closed by the token at `index`.
    fn pop(&mut self, index: usize) {
        let Some(Opener { at: opener, .. }) = self.open.pop() else { return };
        let kind = self.tokens.kinds[opener];
        self.counts[kind_of(closer_of(kind))] -= 1;
        let arrow = self.tokens.get(index + 1) == Some(Token::FatArrow);
        if kind == Token::LParen && arrow {
            self.tokens.kinds[opener] = Token::LambdaParen;
        }
    }

    /// `(1, 2]`: one bracket was mistaken for another.
    fn swap(&mut self, opener: usize, index: usize, closer: Token) {
        let kind = self.tokens.kinds[opener];
        let needed = closer_of(kind);
        let message = format!("{} is closed with {}", kind.describe(), closer.describe());
        let (from, to) = (self.span(opener), self.span(index));
        self.diagnostics.push(
            Diagnostic::error(Code::Syntax, message)
                .label(to, format!("{} is needed here", needed.describe()))
                .label(from, "opened here")
                .fix(to, needed.describe().trim_matches('`')),
        );
        self.tokens.kinds[index] = needed;
        self.pop(index);
    }

    /// Closes the brackets open above the first `keep` ones, before the token at `index`.
    fn close_all(&mut self, index: usize, keep: usize) {
        let mut reported = None;
        while self.open.len() > keep {
            let Some(&opener) = self.open.last() else { return };
            let at = self.place_of_missing(opener, index);
            let closer = closer_of(self.tokens.kinds[opener.at]);
            self.inserted.push((at, closer));
            self.pop(at);
            if reported != Some(at) {
                self.report_missing(opener.at, closer, at);
            }
            reported = Some(at);
        }
    }

    /// Where the missing partner of a bracket belongs: at the first line end behind which the text
    /// is indented no deeper than the line that opened it, at the latest before `limit`.
    fn place_of_missing(&mut self, opener: Opener, limit: usize) -> usize {
        if let Some((line, bound, place)) = self.last_place
            && (line, bound) == (opener.line, limit)
            && place > opener.at
        {
            return place;
        }
        let indent = self.indent(opener.line);
        let mut line_ends =
            (opener.at + 1..limit).filter(|&i| self.tokens.kinds[i] == Token::Newline);
        let outside = line_ends.find(|&i| {
            let next = self.tokens.get(i + 1);
            i + 1 < limit
                && self.indent(i + 1) <= indent
                && next.is_some_and(|t| !TokenSet::CLOSERS.has(t) && t != Token::Dot)
        });
        let place = outside.unwrap_or(limit);
        self.last_place = Some((opener.line, limit, place));
        place
    }

    /// Bytes of white space before the first token of a line.
    fn indent(&self, index: usize) -> usize {
        let before = &self.text[..self.tokens.spans[index].0 as usize];
        let start = before.rfind(['\n', '\r']).map_or(0, |i| i + 1);
        let line = &self.text[start..];
        line.len() - line.trim_start_matches([' ', '\t']).len()
    }

    fn report_missing(&mut self, opener: usize, closer: Token, at: usize) {
        let opened = self.span(opener);
        let end = self.tokens.spans[at - 1].1;
        let place = Span::new(self.source, end, end);
        let kind = self.tokens.kinds[opener].describe();
        let diagnostic = Diagnostic::error(Code::Syntax, format!("this {kind} is never closed"))
            .label(opened, "opened here")
            .label(place, format!("{} is needed here, or before", closer.describe()))
            .fix(place, closer.describe().trim_matches('`'));
        self.diagnostics.push(diagnostic);
    }

    /// At a line end `;` is dropped, between statements it stands for a line end, in parentheses it
    /// is left to the parser.
    fn semicolon(&mut self, index: usize) {
        let inside = self.open.last().map(|open| self.tokens.kinds[open.at]);
        if inside.is_some_and(|kind| kind != Token::LBrace) {
            return;
        }
        self.semicolons.push(index);
        self.tokens.kinds[index] = Token::Newline;
    }

    fn span(&self, index: usize) -> Span {
        let (start, end) = self.tokens.spans[index];
        Span::new(self.source, start, end)
    }

    fn semicolons(&self) -> Option<Diagnostic> {
        let span = self.span(*self.semicolons.first()?);
        let diagnostic = Diagnostic::error(Code::Syntax, "a statement ends with its line")
            .label(span, "`;` is not needed")
            .help("remove it; two statements go on two lines")
            .fix(span, "");
        let others = self.semicolons.len() - 1;
        Some(match others {
            0 => diagnostic,
            _ => diagnostic.note(format!("{others} more of them in this file")),
        })
    }

    fn finish(mut self) -> Balanced {
        let semicolons = self.semicolons();
        let tokens = match self.dropped.is_empty() && self.inserted.is_empty() {
            true => std::mem::take(&mut self.tokens),
            false => self.rebuilt(),
        };
        Balanced { tokens, diagnostics: self.diagnostics, semicolons }
    }

    /// The tokens without the dropped and with the inserted brackets.
    fn rebuilt(&mut self) -> Tokens {
        // Stable: of two closers at one place the inner one was put in first.
        self.inserted.sort_by_key(|(at, _)| *at);
        let mut out = Tokens::with_capacity(self.tokens.len() + self.inserted.len());
        let (mut inserted, mut dropped) = (self.inserted.iter().peekable(), self.dropped.iter());
        let mut next_dropped = dropped.next();
        for index in 0..=self.tokens.len() {
            while let Some((_, closer)) = inserted.next_if(|(at, _)| *at == index) {
                let end = out.spans.last().map_or(0, |span| span.1);
                out.push(*closer, (end, end));
            }
            if next_dropped == Some(&index) {
                next_dropped = dropped.next();
            } else if index < self.tokens.len() {
                out.push(self.tokens.kinds[index], self.tokens.spans[index]);
            }
        }
        out
    }
}
