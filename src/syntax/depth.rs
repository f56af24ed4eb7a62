//! How deep the tree may become. The bound is taken from the tokens, before a parser goes down.
//!
//! What stands in each other deepens the tree; what stands side by side does not: a sum is one node
//! however many terms it has.

use super::token::{Token, TokenSet, Tokens};
use crate::base::{Code, Diagnostic, SourceId, Span};

/// The deepest tree: each operator or word that holds what follows it counts 1, each bracket
/// [`BRACKET`]. So 256 brackets in each other or 1024 powers, signs or `else if` in one expression are
/// allowed. A tree of this depth is built, printed, copied and dropped within 2 MB of stack by a debug
/// build (a test holds it).
pub const LIMIT: u32 = 1024;

/// What a bracket counts: it stands for several levels of tree.
pub const BRACKET: u32 = 4;

/// More statements than these are not spoken of.
const MAX_FAULTS: usize = 100;

/// Rows of infix operators that bind looser than `not`.
const LOOSER_THAN_NOT: u32 = 2;

/// Behind these a `-` is infix.
const OPERAND_ENDS: TokenSet = TokenSet::CLOSERS.or(TokenSet::NAMES).or(TokenSet::of(&[
    Token::Number,
    Token::StringEnd,
    Token::True,
    Token::False,
    Token::Bad,
]));

/// What a token means for the depth.
#[derive(Clone, Copy)]
enum Effect {
    Nothing,
    Opens,
    Closes,
    Separates,
    /// An infix operator of this row, the loosest first: those of a row make one node, or stand only
    /// once.
    Joins(u32),
    /// Holds all that follows it, where every row of operators may stand once more.
    Holds,
    Not,
    /// A power, a sign or a suffix.
    Deepens,
}

fn effect(token: Token) -> Effect {
    use Token::*;
    match token {
        LParen | LambdaParen | LBracket | LBrace | HoleOpen => Effect::Opens,
        RParen | RBracket | RBrace | HoleClose => Effect::Closes,
        Comma | Newline => Effect::Separates,
        Or => Effect::Joins(0),
        And => Effect::Joins(1),
        Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual => Effect::Joins(2),
        DotDot | DotDotLess => Effect::Joins(3),
        Plus | Minus | Join => Effect::Joins(4),
        Star | Slash | Percent | Ampersand => Effect::Joins(5),
        FatArrow | Else | If | For | Do | Fn | Step => Effect::Holds,
        Not => Effect::Not,
        Caret | Dot => Effect::Deepens,
        _ => Effect::Nothing,
    }
}

/// One open bracket, or the file.
#[derive(Clone, Copy, Default)]
struct Level {
    /// Depth above this bracket.
    above: u32,
    /// Words that hold, and rows of operators, since the last comma or line end.
    holding: u32,
    /// The rows met since the last word that holds.
    rows: u32,
    /// `not` since the last operator that binds looser.
    nots: u32,
    /// What deepens the operand at hand.
    operand: u32,
    /// The deepest bracket closed in it.
    deepest: u32,
    /// The deepest operand since the last comma or line end.
    element: u32,
    /// The deepest of the earlier elements.
    height: u32,
}

impl Level {
    fn here(&self) -> u32 {
        self.holding + self.nots + self.operand + self.deepest
    }

    fn depth(&self) -> u32 {
        self.above + self.height.max(self.element).max(self.here())
    }

    fn separate(&mut self) {
        let height = self.height.max(self.element).max(self.here());
        *self = Level { above: self.above, height, ..Level::default() };
    }

    /// An operator ends an operand. The first of its row stands above all before it.
    fn join(&mut self, row: u32) {
        if self.rows >> row & 1 == 0 {
            self.rows |= 1 << row;
            self.holding += 1;
            self.element += 1;
        }
        self.element = self.element.max(self.here());
        (self.operand, self.deepest) = (0, 0);
        if row < LOOSER_THAN_NOT {
            self.nots = 0;
        }
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
            "the limit is {} brackets in each other, or {LIMIT} operators that hold each other",
            LIMIT / BRACKET
        ))
        .help("name parts of it")
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
            levels[0] = Level::default();
        } else if step(&mut levels, tokens, index)
            && at.is_none()
            && levels.last().is_some_and(|level| level.depth() > LIMIT)
        {
            at = Some(index);
        }
    }
    faults.extend(at.map(|at| Fault { start, end: tokens.len(), at }));
    faults
}

/// Counts a token. Whether the depth may have grown.
fn step(levels: &mut Vec<Level>, tokens: &Tokens, index: usize) -> bool {
    let token = tokens.kinds[index];
    let effect = effect(token);
    if let Effect::Nothing = effect {
        return false;
    }
    let infix = || index > 0 && OPERAND_ENDS.has(tokens.kinds[index - 1]);
    let Some(top) = levels.last_mut() else { return false };
    match effect {
        Effect::Nothing => {}
        Effect::Opens => {
            let above = top.above + top.holding + top.nots + top.operand + BRACKET;
            levels.push(Level { above, ..Level::default() });
        }
        Effect::Closes => {
            top.separate();
            let height = top.height + BRACKET;
            levels.pop();
            if let Some(outer) = levels.last_mut() {
                outer.operand += 1;
                outer.deepest = outer.deepest.max(height);
            }
        }
        Effect::Separates => top.separate(),
        Effect::Joins(_) if token == Token::Minus && !infix() => top.operand += 1,
        Effect::Joins(row) => top.join(row),
        Effect::Holds => {
            top.holding += 1;
            top.rows = 0;
        }
        Effect::Not => top.nots += 1,
        Effect::Deepens => top.operand += 1,
    }
    true
}
