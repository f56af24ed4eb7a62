//! How deep the tree may become. The bound is taken from the tokens, before a parser goes down.

use super::token::{Token, TokenSet, Tokens};
use crate::base::{Code, Diagnostic, SourceId, Span};

/// The deepest tree: each operator counts 1, each bracket [`BRACKET`]. So 256 brackets in each
/// other or 1024 operators in one expression are allowed. A tree of this depth is built, printed,
/// copied and dropped within 2 MB of stack by a debug build (a test holds it).
pub const LIMIT: u32 = 1024;

/// What a bracket counts: it stands for several levels of tree.
pub const BRACKET: u32 = 4;

/// More statements than these are not spoken of.
const MAX_FAULTS: usize = 100;

/// What deepens the tree beside brackets.
const DEEPENING: TokenSet = TokenSet::OPERATORS.or(TokenSet::of(&[
    Token::Not,
    Token::FatArrow,
    Token::Else,
    Token::Dot,
    Token::If,
    Token::For,
    Token::Do,
    Token::Fn,
    Token::Step,
]));

/// One open bracket, or the file.
#[derive(Clone, Copy, Default)]
struct Level {
    /// Depth above this bracket.
    above: u32,
    /// Operators since the last comma or line end.
    operators: u32,
    /// The deepest bracket closed since then.
    deepest: u32,
    /// The deepest of the earlier elements.
    height: u32,
}

impl Level {
    fn depth(&self) -> u32 {
        self.above + self.height.max(self.operators + self.deepest)
    }

    fn separate(&mut self) {
        self.height = self.height.max(self.operators + self.deepest);
        self.operators = 0;
        self.deepest = 0;
    }
}

/// Replaces every top-level statement that is nested too deep by one bad token behind its `=`, with
/// an error at the place where it goes too far. Brackets must be paired.
/// What was said of such a statement before is taken back: it is one mistake.
pub fn limit(source: SourceId, tokens: Tokens, said: &mut Vec<Diagnostic>) -> Tokens {
    let faults = too_deep(&tokens);
    if faults.is_empty() {
        return tokens;
    }
    let mut out = Tokens::with_capacity(tokens.len());
    let mut copied = 0;
    for fault in &faults {
        let head = tokens.kinds[fault.start..fault.end].iter().position(|t| *t == Token::Assign);
        let kept = head.map_or(fault.start, |at| fault.start + at + 1).min(fault.at);
        out.kinds.extend_from_slice(&tokens.kinds[copied..kept]);
        out.spans.extend_from_slice(&tokens.spans[copied..kept]);
        out.push(Token::Bad, (tokens.spans[kept].0, tokens.spans[fault.end - 1].1));
        copied = fault.end;
    }
    out.kinds.extend_from_slice(&tokens.kinds[copied..]);
    out.spans.extend_from_slice(&tokens.spans[copied..]);
    for fault in faults.iter().take(MAX_FAULTS) {
        let (start, end) = (tokens.spans[fault.start].0, tokens.spans[fault.end - 1].1);
        said.retain(|d| d.span().is_none_or(|span| span.start < start || span.start > end));
        said.push(diagnostic(source, tokens.spans[fault.at]));
    }
    out
}

fn diagnostic(source: SourceId, (start, end): (u32, u32)) -> Diagnostic {
    let message = "this is nested too deep";
    Diagnostic::error(Code::TooDeep, message)
        .label(Span::new(source, start, end), "one level too many")
        .note(format!(
            "the limit is {} brackets in each other, or {LIMIT} operators in one expression",
            LIMIT / BRACKET
        ))
        .help("name parts of it; for long sums of shapes write `union([...])`")
}

/// A statement nested too deep: its tokens `start..end`, and the one that goes too far.
struct Fault {
    start: usize,
    end: usize,
    at: usize,
}

fn too_deep(tokens: &Tokens) -> Vec<Fault> {
    let mut faults: Vec<Fault> = vec![];
    let mut levels = vec![Level::default()];
    let (mut start, mut at) = (0, None);
    for (index, &token) in tokens.kinds.iter().enumerate() {
        if token == Token::Newline && levels.len() == 1 {
            faults.extend(at.take().map(|at| Fault { start, end: index, at }));
            start = index + 1;
            levels = vec![Level::default()];
            continue;
        }
        step(&mut levels, token);
        if at.is_none() && levels.last().is_some_and(|level| level.depth() > LIMIT) {
            at = Some(index);
        }
    }
    faults.extend(at.map(|at| Fault { start, end: tokens.len(), at }));
    faults
}

fn step(levels: &mut Vec<Level>, token: Token) {
    let Some(top) = levels.last_mut() else { return };
    if TokenSet::OPENERS.has(token) {
        let above = top.above + top.operators + BRACKET;
        levels.push(Level { above, ..Level::default() });
    } else if TokenSet::CLOSERS.has(token) {
        top.separate();
        let height = top.height + BRACKET;
        levels.pop();
        if let Some(outer) = levels.last_mut() {
            outer.operators += 1;
            outer.deepest = outer.deepest.max(height);
        }
    } else if matches!(token, Token::Comma | Token::Newline) {
        top.separate();
    } else if DEEPENING.has(token) {
        top.operators += 1;
    }
}
