//! The operators, from `or` that binds loosest to `^` that binds tightest.
//!
//! The productions from `or` to `power` differ in their operators alone, so one function climbs
//! through all of them: a combinator for each would be tried at every operand, and most operands have
//! no operator behind them.

use chumsky::{input::InputRef, prelude::*};

use super::{Boxed, Extra, Fault, Input, Parse, Production, atom::take};
use crate::{
    base::Span,
    syntax::{
        ast::{BinaryOp, Expr, ExprKind, UnaryOp},
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

/// Where the parser is.
type Reader<'s, 'p> = InputRef<'s, 'p, Input<'s>, Extra<'s>>;

/// Room that one step of climbing may need on the stack, and what is added when there is less.
const STACK: (usize, usize) = (64 << 10, 1 << 20);

/// Everything from `or` to `power`, over operands of `postfix`.
pub(super) fn or<'s>(postfix: impl Parse<'s, Expr>) -> Boxed<'s, Expr> {
    let operand = postfix.or_not().boxed();
    custom::<_, Input<'s>, _, Extra<'s>>(move |input| {
        let at = *input.cursor().inner();
        // What was expected has been noted by the operand, at the token where it stopped.
        climb(input, &operand, Level::Or).ok_or(Fault { at, expected: TokenSet::EMPTY })
    })
    .boxed()
}

/// An expression of a level or a tighter one; `None`, with nothing read, where none begins.
fn climb<'s>(
    input: &mut Reader<'s, '_>,
    operand: &Boxed<'s, Option<Expr>>,
    floor: Level,
) -> Option<Expr> {
    stacker::maybe_grow(STACK.0, STACK.1, || {
        let (mut left, mut ceiling) = prefix(input, operand, floor)?;
        loop {
            let before = input.save();
            let Some((token, span)) = sign(input, operators(floor, ceiling)) else {
                return Some(left);
            };
            let infix = infix_of(token);
            let Some(right) = climb(input, operand, infix.right) else {
                input.rewind(before);
                return Some(left);
            };
            left = match infix.level {
                Level::Range => range(left, token, right, step(input, operand)),
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
    operand: &Boxed<'s, Option<Expr>>,
    floor: Level,
) -> Option<(Expr, Level)> {
    const SIGN: TokenSet = TokenSet::of(&[Token::Minus]);
    const SIGNS: TokenSet = TokenSet::of(&[Token::Minus, Token::Not]);
    let before = input.save();
    let signs = if floor <= Level::Not { SIGNS } else { SIGN };
    let Some((token, span)) = sign(input, signs) else {
        return Some((input.parse(operand).ok()??, Level::Power));
    };
    let (op, production, level, ceiling) = match token {
        Token::Not => (UnaryOp::Not, Production::Not, Level::Not, Level::And),
        _ => (UnaryOp::Negate, Production::Unary, Level::Unary, Level::Prod),
    };
    let Some(inner) = climb(input, operand, level) else {
        input.rewind(before);
        return None;
    };
    input.state().mark(production);
    let (kind_span, operand) = (span.to(inner.span), Box::new(inner));
    let kind = ExprKind::Unary { op, op_span: span, operand };
    Some((Expr { kind, span: kind_span }, ceiling))
}

/// The `step` of a range.
fn step<'s>(input: &mut Reader<'s, '_>, operand: &Boxed<'s, Option<Expr>>) -> Option<Expr> {
    let before = input.save();
    sign(input, TokenSet::of(&[Token::Step]))?;
    let step = climb(input, operand, Level::Sum);
    if step.is_none() {
        input.rewind(before);
    }
    step
}

/// One of the given tokens with its place.
fn sign(input: &mut Reader, set: TokenSet) -> Option<(Token, Span)> {
    let at = *input.cursor().inner();
    let token = input.parse(take(set).or_not()).ok()??;
    Some((token, input.state().span(at, at + 1)))
}

/// The infix operators of the levels from `floor` to `ceiling`.
fn operators(floor: Level, ceiling: Level) -> TokenSet {
    let levels = INFIX.iter().filter(|infix| floor <= infix.level && infix.level <= ceiling);
    levels.fold(TokenSet::EMPTY, |set, infix| set.or(infix.operators))
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

fn binary(left: Expr, (op, op_span): (Token, Span), right: Expr) -> Expr {
    let span = left.span.to(right.span);
    let (left, right) = (Box::new(left), Box::new(right));
    Expr { kind: ExprKind::Binary { op: op_of(op), op_span, left, right }, span }
}

fn range(start: Expr, dots: Token, end: Expr, step: Option<Expr>) -> Expr {
    let span = start.span.to(step.as_ref().unwrap_or(&end).span);
    let kind = ExprKind::Range {
        start: Box::new(start),
        end: Box::new(end),
        inclusive: dots == Token::DotDot,
        step: step.map(Box::new),
    };
    Expr { kind, span }
}
