//! From text to tokens. Errors never stop it; every one has its exact place.

use logos::Logos;

use super::{
    foreign,
    number::{self, NumberFault},
    text,
    token::{Token, Tokens},
};
use crate::base::{Code, Diagnostic, SourceId, Span};

/// What a text consists of: the tokens for the parser, and beside them what the parser never sees.
#[derive(Clone, Debug, Default)]
pub struct Lexed {
    /// The tokens, line ends and `///` lines among them.
    pub tokens: Tokens,
    /// Every comment in source order (`//`, `/* */`, `///`, `//!`): with the tokens' spans, all a
    /// formatter needs.
    pub comments: Vec<(Token, Span)>,
    /// What is no token.
    pub diagnostics: Vec<Diagnostic>,
}

/// Cuts `text` into tokens.
///
/// ```
/// use katachi::{base::SourceId, syntax::{lexer::lex, token::Token}};
/// let lexed = lex(SourceId(0), "w = 40mm // wide");
/// assert_eq!(lexed.tokens.kinds, [Token::Name, Token::Assign, Token::Number]);
/// assert_eq!(lexed.comments.len(), 1);
/// ```
pub fn lex(source: SourceId, text: &str) -> Lexed {
    // Room for the densest texts; what is not used is never touched.
    let out = Lexed { tokens: Tokens::with_capacity(text.len() / 2), ..Lexed::default() };
    let mut lexer = Lexer { source, text, raw: Token::lexer(text), out, strings: vec![] };
    while let Some(token) = lexer.raw.next() {
        lexer.take(token);
    }
    lexer.abandon_strings(text.len());
    lexer.out
}

/// A string that is being read: a `{` in it was opened, and its expression is next.
struct OpenString {
    /// Index of its first token.
    first: usize,
    /// Braces open inside the interpolation.
    braces: u32,
}

struct Lexer<'s> {
    source: SourceId,
    text: &'s str,
    raw: logos::Lexer<'s, Token>,
    out: Lexed,
    strings: Vec<OpenString>,
}

impl<'s> Lexer<'s> {
    fn take(&mut self, token: Result<Token, ()>) {
        match token {
            Ok(Token::Newline) => self.newline(),
            Ok(Token::LineComment) => self.line_comment(),
            Ok(Token::BlockComment) => self.block_comment(),
            Ok(Token::Number) => self.number(),
            Ok(Token::StringStart) => self.string(),
            Ok(Token::LBrace) => self.brace(),
            Ok(Token::RBrace) => self.closing_brace(),
            Ok(Token::Ampersand) if self.raw.remainder().starts_with('&') => self.foreign(),
            Ok(token) => self.push(token),
            Err(()) => self.foreign(),
        }
    }

    fn range(&self) -> (u32, u32) {
        let range = self.raw.span();
        (range.start as u32, range.end as u32)
    }

    fn span(&self, start: usize, end: usize) -> Span {
        Span::new(self.source, start as u32, end as u32)
    }

    fn push(&mut self, token: Token) {
        let range = self.range();
        self.out.tokens.push(token, range);
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        self.out.diagnostics.push(diagnostic);
    }

    fn newline(&mut self) {
        let at = self.raw.span().start;
        self.abandon_strings(at);
        if self.out.tokens.kinds.last() != Some(&Token::Newline) {
            self.push(Token::Newline);
        }
    }

    fn line_comment(&mut self) {
        let comment = self.raw.slice();
        let kind = if comment.starts_with("//!") {
            Token::FileDoc
        } else if comment.starts_with("///") && !comment.starts_with("////") {
            Token::Doc
        } else {
            Token::LineComment
        };
        let range = self.raw.span();
        let span = self.span(range.start, range.end);
        self.out.comments.push((kind, span));
        if kind == Token::Doc && self.strings.is_empty() {
            self.push(Token::Doc);
        }
    }

    fn block_comment(&mut self) {
        let start = self.raw.span().start;
        let length = text::block_comment_length(self.raw.remainder());
        let rest = self.raw.remainder().len();
        self.raw.bump(length.unwrap_or(rest));
        let range = self.raw.span();
        let span = self.span(range.start, range.end);
        self.out.comments.push((Token::BlockComment, span));
        if length.is_none() {
            let opening = self.span(start, start + 2);
            self.report(
                Diagnostic::error(Code::BadToken, "this comment is never closed")
                    .label(opening, "opened here")
                    .help("close it with `*/`; comments nest, so every `/*` needs its own"),
            );
        }
    }

    fn number(&mut self) {
        let start = self.raw.span().start;
        let parts = number::measure(&self.text[start..]);
        self.raw.bump(start + parts.end - self.raw.span().end);
        match number::check(self.raw.slice(), parts) {
            Ok(()) => self.push(Token::Number),
            Err(fault) => {
                self.push(Token::Bad);
                let diagnostic = self.number_fault(fault, start, parts);
                self.report(diagnostic);
            }
        }
    }

    fn number_fault(
        &self,
        fault: NumberFault,
        start: usize,
        parts: number::NumberParts,
    ) -> Diagnostic {
        let whole = self.span(start, start + parts.end);
        match fault {
            NumberFault::UnknownUnit => {
                let word = &self.text[start + parts.digits..start + parts.unit];
                let place = self.span(start + parts.digits, start + parts.unit);
                foreign::unknown_unit(word, place)
            }
            NumberFault::BrokenExponent => {
                Diagnostic::error(Code::BadToken, "the exponent of a unit is a whole number")
                    .label(whole, "this unit has a fractional exponent")
                    .help("put the value in parentheses to raise it: `(10mm)^2.5`")
            }
            NumberFault::LargeExponent => {
                Diagnostic::error(Code::BadToken, "the exponent of a unit lies between -9 and 9")
                    .label(whole, "this one does not")
            }
            NumberFault::TooLarge => Diagnostic::error(Code::BadToken, "this number is too large")
                .label(whole, "more than 1.8e308"),
        }
    }

    fn string(&mut self) {
        let first = self.out.tokens.len();
        self.push(Token::StringStart);
        self.string_text(first);
    }

    /// Reads the characters of a string up to its end or to an interpolation.
    fn string_text(&mut self, first: usize) {
        let start = self.raw.span().end;
        let run = text::run(self.raw.remainder());
        for fault in &run.faults {
            let place = self.span(start + fault.start, start + fault.end);
            self.report(foreign::bad_escape(&self.text[start + fault.start..], place));
        }
        self.raw.bump(run.length);
        let end = start + run.length;
        if run.length > 0 {
            self.out.tokens.push(Token::StringText, (start as u32, end as u32));
        }
        let next = self.raw.remainder().bytes().next();
        match next {
            Some(b'"') => {
                self.raw.bump(1);
                self.out.tokens.push(Token::StringEnd, (end as u32, end as u32 + 1));
            }
            Some(b'{') => {
                self.raw.bump(1);
                self.out.tokens.push(Token::HoleOpen, (end as u32, end as u32 + 1));
                self.strings.push(OpenString { first, braces: 0 });
            }
            _ => {
                self.strings.push(OpenString { first, braces: 0 });
                self.abandon_strings(end);
            }
        }
    }

    fn brace(&mut self) {
        if let Some(open) = self.strings.last_mut() {
            open.braces += 1;
        }
        self.push(Token::LBrace);
    }

    fn closing_brace(&mut self) {
        match self.strings.last_mut() {
            Some(open) if open.braces == 0 => {
                let first = open.first;
                self.strings.pop();
                self.push(Token::HoleClose);
                self.string_text(first);
            }
            Some(open) => {
                open.braces -= 1;
                self.push(Token::RBrace);
            }
            None => self.push(Token::RBrace),
        }
    }

    /// The line or the file ends inside a string: the outermost string is one bad token.
    fn abandon_strings(&mut self, end: usize) {
        let Some(first) = self.strings.first().map(|open| open.first) else { return };
        self.strings.clear();
        let (start, _) = self.out.tokens.spans[first];
        self.out.tokens.truncate(first);
        self.out.tokens.push(Token::Bad, (start, end as u32));
        let place = self.span(start as usize, end);
        let inside = |d: &Diagnostic| d.span().is_some_and(|span| span.start >= start);
        while self.out.diagnostics.last().is_some_and(inside) {
            self.out.diagnostics.pop();
        }
        self.report(
            Diagnostic::error(Code::BadToken, "this string is not closed on its line")
                .label(place, "no closing `\"` follows")
                .help("end it with `\"`; `\\n` stands for a line end, `{{` for a brace"),
        );
    }

    /// Signs that no token begins with, many of them from other languages.
    fn foreign(&mut self) {
        let start = self.raw.span().start;
        let sign = foreign::sign(&self.text[start..]);
        self.raw.bump(start + sign.length - self.raw.span().end);
        let place = self.span(start, start + sign.length);
        let follows_bad = self.out.tokens.kinds.last() == Some(&Token::Bad)
            && self.out.tokens.spans.last().is_some_and(|&(_, end)| end as usize == start);
        if sign.means == Token::Bad && follows_bad {
            let last = self.out.tokens.spans.len() - 1;
            self.out.tokens.spans[last].1 = place.end;
            return;
        }
        self.push(sign.means);
        let diagnostic = foreign::diagnostic(&self.text[start..], &sign, place);
        self.report(diagnostic);
    }
}
