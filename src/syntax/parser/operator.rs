//! The operators, from `or` that binds loosest to `^` that binds tightest.
//!
//! The productions from `or` to `power` differ in their operators alone, so one function climbs
//! through all of them: a combinator for each would be tried at every operand, and most operands have
//! no operator behind them.

use super::{
    Production,
    primary::{Forms, postfix},
    reader::{Reader, note, place},
};
use crate::{
    base::Span,
    syntax::{
        ast::{Binary, BinaryOp, Chain, Expr, ExprKind, Link, Range, UnaryOp},
        token::{Token, TokenSet},
    },
};

/// The productions by how tightly they bind.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    /// or = and { "or" and }
    Or,
    /// and = not { "and" not }
    And,
    /// not = "not" not | cmp
    Not,
    /// cmp = range [ ("==" | "!=" | "<" | "<=" | ">" | ">=") range ]
    Cmp,
    /// range = sum [ (".." | "..<") sum [ "step" sum ] ]
    Range,
    /// sum = prod { ("+" | "-" | "++") prod }
    Sum,
    /// prod = unary { ("*" | "/" | "%" | "&") unary }
    Prod,
    /// unary = "-" unary | power
    Unary,
    /// power = postfix [ "^" unary ]
    Power,
}

const LEVELS: [Level; 9] = [
    Level::Or,
    Level::And,
    Level::Not,
    Level::Cmp,
    Level::Range,
    Level::Sum,
    Level::Prod,
    Level::Unary,
    Level::Power,
];

/// A level with infix operators: the operators, what stands right of one, and the tightest level
/// whose operators may follow what it made (a comparison takes no second one).
struct Infix {
    level: Level,
    production: Production,
    operators: TokenSet,
    right: Level,
    next: Level,
}

const INFIX: [Infix; 7] = {
    const OR: TokenSet = TokenSet::of(&[Token::Or]);
    const AND: TokenSet = TokenSet::of(&[Token::And]);
    const DOTS: TokenSet = TokenSet::of(&[Token::DotDot, Token::DotDotLess]);
    const SUMS: TokenSet = TokenSet::of(&[Token::Plus, Token::Minus, Token::Join]);
    const PRODUCTS: TokenSet =
        TokenSet::of(&[Token::Star, Token::Slash, Token::Percent, Token::Ampersand]);
    const CARET: TokenSet = TokenSet::of(&[Token::Caret]);
    const fn infix(
        level: Level,
        production: Production,
        operators: TokenSet,
        right: Level,
        next: Level,
    ) -> Infix {
        Infix { level, production, operators, right, next }
    }
    [
        infix(Level::Or, Production::Or, OR, Level::And, Level::Or),
        infix(Level::And, Production::And, AND, Level::Not, Level::And),
        infix(Level::Cmp, Production::Cmp, TokenSet::COMPARISONS, Level::Range, Level::Not),
        infix(Level::Range, Production::Range, DOTS, Level::Sum, Level::Cmp),
        infix(Level::Sum, Production::Sum, SUMS, Level::Prod, Level::Sum),
        infix(Level::Prod, Production::Prod, PRODUCTS, Level::Unary, Level::Prod),
        infix(Level::Power, Production::Power, CARET, Level::Unary, Level::Unary),
    ]
};

/// What may follow an operand; the operand itself has read it, if it is there.
const SUFFIXES: TokenSet =
    TokenSet::of(&[Token::Dot, Token::LParen, Token::LambdaParen, Token::LBracket]);

/// What may follow an expression whose loosest operator is of the level `ceiling`, where operators of
/// `floor` and tighter ones are read.
const fn following(floor: Level, ceiling: Level) -> TokenSet {
    let mut set = if ceiling as u8 == Level::Power as u8 { SUFFIXES } else { TokenSet::EMPTY };
    let mut at = 0;
    while at < INFIX.len() {
        let level = INFIX[at].level as u8;
        if floor as u8 <= level && level <= ceiling as u8 {
            set = set.or(INFIX[at].operators);
        }
        at += 1;
    }
    set
}

/// [`following`] for every pair of levels.
const FOLLOWING: [[TokenSet; LEVELS.len()]; LEVELS.len()] = {
    let mut table = [[TokenSet::EMPTY; LEVELS.len()]; LEVELS.len()];
    let mut at = 0;
    while at < LEVELS.len() * LEVELS.len() {
        let (floor, ceiling) = (at / LEVELS.len(), at % LEVELS.len());
        table[floor][ceiling] = following(LEVELS[floor], LEVELS[ceiling]);
        at += 1;
    }
    table
};

/// Room that one step of climbing may need on the stack, and what is added when there is less.
const STACK: (usize, usize) = (64 << 10, 1 << 20);

/// Everything from `or` to `power`, over operands of `postfix`.
pub(super) fn or<'s>(input: &mut Reader<'s, '_>, forms: &Forms<'s>) -> Option<Expr> {
    climb(input, forms, Level::Or)
}

/// An expression of a level or a tighter one.
fn climb<'s>(input: &mut Reader<'s, '_>, forms: &Forms<'s>, floor: Level) -> Option<Expr> {
    stacker::maybe_grow(STACK.0, STACK.1, || {
        let (mut left, mut ceiling) = prefix(input, forms, floor)?;
        loop {
            let before = input.save();
            let expected = FOLLOWING[floor as usize][ceiling as usize];
            let Some((token, span)) = sign(input, expected) else { return Some(left) };
            let infix = infix_of(token);
            let Some(right) = climb(input, forms, infix.right) else {
                input.rewind(before);
                return Some(left);
            };
            left = match infix.level {
                Level::Range => range(left, token, right, step(input, forms)),
                _ => binary(left, (token, span), right),
            };
            input.state().mark(infix.production);
            ceiling = infix.next;
        }
    })
}

/// What an expression begins with, and the tightest level whose operators may follow it.
fn prefix<'s>(
    input: &mut Reader<'s, '_>,
    forms: &Forms<'s>,
    floor: Level,
) -> Option<(Expr, Level)> {
    let (op, production, level, ceiling) = match input.peek() {
        Some(Token::Not) if floor <= Level::Not => {
            (UnaryOp::Not, Production::Not, Level::Not, Level::And)
        }
        Some(Token::Minus) => (UnaryOp::Negate, Production::Unary, Level::Unary, Level::Prod),
        _ => return Some((postfix(input, forms)?, Level::Power)),
    };
    let at = place(input);
    input.skip();
    let operand = Box::new(climb(input, forms, level)?);
    let state = input.state();
    state.mark(production);
    let op_span = state.span(at, at + 1);
    let span = op_span.to(operand.span);
    Some((Expr { kind: ExprKind::Unary { op, op_span, operand }, span }, ceiling))
}

/// The `step` of a range.
fn step<'s>(input: &mut Reader<'s, '_>, forms: &Forms<'s>) -> Option<Expr> {
    let before = input.save();
    sign(input, TokenSet::of(&[Token::Step]))?;
    let step = climb(input, forms, Level::Sum);
    if step.is_none() {
        input.rewind(before);
    }
    step
}

/// One of the given tokens, but for suffixes, with its place.
fn sign(input: &mut Reader<'_, '_>, set: TokenSet) -> Option<(Token, Span)> {
    let at = place(input);
    match input.peek() {
        Some(token) if set.without(SUFFIXES).has(token) => {
            input.skip();
            Some((token, input.state().span(at, at + 1)))
        }
        _ => {
            note(input, set);
            None
        }
    }
}

fn infix_of(token: Token) -> &'static Infix {
    INFIX.iter().find(|infix| infix.operators.has(token)).expect("an infix operator")
}

fn op_of(token: Token) -> BinaryOp {
    match token {
        Token::Or => BinaryOp::Or,
        Token::And => BinaryOp::And,
        Token::Equal => BinaryOp::Equal,
        Token::NotEqual => BinaryOp::NotEqual,
        Token::Less => BinaryOp::Less,
        Token::LessEqual => BinaryOp::LessEqual,
        Token::Greater => BinaryOp::Greater,
        Token::GreaterEqual => BinaryOp::GreaterEqual,
        Token::Plus => BinaryOp::Add,
        Token::Minus => BinaryOp::Subtract,
        Token::Join => BinaryOp::Join,
        Token::Star => BinaryOp::Multiply,
        Token::Slash => BinaryOp::Divide,
        Token::Percent => BinaryOp::Remainder,
        Token::Ampersand => BinaryOp::Intersect,
        _ => BinaryOp::Power,
    }
}

/// Whether operators of the same level stand side by side in one [`Chain`].
fn chains(a: BinaryOp, b: BinaryOp) -> bool {
    use BinaryOp::*;
    let level = |op| match op {
        Or => Some(0),
        And => Some(1),
        Add | Subtract | Join => Some(2),
        Multiply | Divide | Remainder | Intersect => Some(3),
        _ => None,
    };
    level(a).is_some() && level(a) == level(b)
}

fn binary(left: Expr, (sign, op_span): (Token, Span), right: Expr) -> Expr {
    let (op, span) = (op_of(sign), left.span.to(right.span));
    let kind = match left.kind {
        ExprKind::Chain(mut chain) if chains(chain.links[0].op, op) => {
            chain.links.push(Link { op, op_span, right });
            ExprKind::Chain(chain)
        }
        ExprKind::Binary(inner) if chains(inner.op, op) => {
            let second = Link { op, op_span, right };
            let first = Link { op: inner.op, op_span: inner.op_span, right: inner.right };
            ExprKind::Chain(Box::new(Chain { first: inner.left, links: vec![first, second] }))
        }
        _ => ExprKind::Binary(Box::new(Binary { op, op_span, left, right })),
    };
    Expr { kind, span }
}

fn range(start: Expr, dots: Token, end: Expr, step: Option<Expr>) -> Expr {
    let span = start.span.to(step.as_ref().unwrap_or(&end).span);
    let inclusive = dots == Token::DotDot;
    Expr { kind: ExprKind::Range(Box::new(Range { start, end, inclusive, step })), span }
}
