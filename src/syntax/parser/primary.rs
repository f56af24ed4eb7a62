//! Expressions that begin with a token of their own, and what follows them directly.

use chumsky::prelude::*;

use super::{
    Boxed, Parse, Production,
    atom::{marked, member_name, name, name_before, number, string, take, token},
    recover::rest_of_bracket,
    state::here,
};
use crate::{
    base::Span,
    syntax::{
        ast::{Argument, Binder, Block, Expr, ExprKind, Field, Stmt, StmtKind},
        token::{Token, TokenSet},
    },
};

/// What directly follows an expression.
#[derive(Clone)]
enum Suffix {
    Member(crate::syntax::ast::Name),
    Call(Option<Vec<Argument>>),
    Index(Option<Box<Expr>>),
}

/// The inside of a bracket whose opening has been read, with its end; `None` where it is broken.
fn inside<'s, T: 's>(content: impl Parse<'s, T>, closer: Token) -> impl Parse<'s, Option<T>> {
    let whole = content.then_ignore(token(closer)).map(Some);
    whole.recover_with(via_parser(rest_of_bracket().map(|()| None)))
}

fn commas<'s, T: 's>(element: impl Parse<'s, T>) -> impl Parse<'s, Vec<T>> {
    element.separated_by(token(Token::Comma)).allow_trailing().collect()
}

/// postfix = primary { "." NAME | "(" [ arg { "," arg } [","] ] ")" | "[" expr "]" }
pub(super) fn postfix<'s>(
    primary: impl Parse<'s, Expr>,
    expr: impl Parse<'s, Expr>,
) -> Boxed<'s, Expr> {
    const CALL: TokenSet = TokenSet::of(&[Token::LParen, Token::LambdaParen]);
    let member = token(Token::Dot).ignore_then(member_name()).map(Suffix::Member);
    let arguments = inside(commas(arg(expr.clone())), Token::RParen);
    let call = take(CALL).ignore_then(arguments).map(Suffix::Call);
    let index = inside(expr.map(Box::new), Token::RBracket);
    let index = token(Token::LBracket).ignore_then(index).map(Suffix::Index);
    let suffix = choice((member, call, index)).boxed();
    primary
        .foldl_with(suffix.repeated(), |object, suffix, extra| {
            let span = here(extra);
            extra.state().mark(Production::Postfix);
            follow(object, suffix, span)
        })
        .boxed()
}

fn follow(object: Expr, suffix: Suffix, span: Span) -> Expr {
    let object = Box::new(object);
    let kind = match suffix {
        Suffix::Member(name) => ExprKind::Member { object, name },
        Suffix::Call(Some(arguments)) => ExprKind::Call { callee: object, arguments },
        Suffix::Index(Some(index)) => ExprKind::Index { object, index },
        Suffix::Call(None) | Suffix::Index(None) => ExprKind::Error,
    };
    Expr { kind, span }
}

/// arg = NAME "=" expr | ".." expr | expr
fn arg<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, Argument> {
    let named = name_before(TokenSet::of(&[Token::Assign])).then_ignore(token(Token::Assign));
    let named = named.then(expr.clone()).map(|(name, value)| Argument::Named { name, value });
    let spread = token(Token::DotDot).ignore_then(expr.clone()).map(Argument::Spread);
    marked(Production::Arg, choice((named, spread, expr.map(Argument::Positional))))
}

/// primary = NUMBER | STRING | NAME | "true" | "false" | "(" expr ")" | "[" ... "]" | record
///         | "do" block | if | "for" binder { "," binder } [ "if" expr ] block
pub(super) fn primary<'s>(
    expr: impl Parse<'s, Expr>,
    block: impl Parse<'s, Block>,
) -> Boxed<'s, Expr> {
    let spanned = |kind: Boxed<'s, ExprKind>| {
        kind.map_with(|kind, extra| Expr { kind, span: here(extra) }).boxed()
    };
    let name = name().map(ExprKind::Name);
    let truth = take(TokenSet::of(&[Token::True, Token::False]));
    let truth = truth.map(|token| ExprKind::Bool(token == Token::True));
    let bad = token(Token::Bad).map(|_| ExprKind::Error);
    let run = token(Token::Do).ignore_then(block.clone()).map(ExprKind::Do);
    let parser = choice((
        spanned(name.boxed()),
        number(),
        spanned(string(expr.clone()).map(ExprKind::Text).boxed()),
        spanned(paren(expr.clone())),
        spanned(list(expr.clone())),
        spanned(record(expr.clone())),
        spanned(choice((truth, bad, run)).boxed()),
        if_(expr.clone(), block.clone()),
        spanned(for_(expr, block)),
    ));
    marked(Production::Primary, parser)
}

fn paren<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, ExprKind> {
    let inner = inside(expr.map(Box::new), Token::RParen);
    let paren = token(Token::LParen).ignore_then(inner);
    paren.map(|inner| inner.map_or(ExprKind::Error, ExprKind::Paren)).boxed()
}

fn list<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, ExprKind> {
    let list = token(Token::LBracket).ignore_then(inside(commas(expr), Token::RBracket));
    list.map(|elements| elements.map_or(ExprKind::Error, ExprKind::List)).boxed()
}

/// record = "{" [ field { ("," | NL) field } [","] ] "}"
pub(super) fn record<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, ExprKind> {
    const SEPARATORS: TokenSet = TokenSet::of(&[Token::Comma, Token::Newline]);
    let fields = field(expr).separated_by(take(SEPARATORS)).allow_trailing().collect();
    let record = token(Token::LBrace).ignore_then(inside(fields, Token::RBrace));
    let record = record.map(|fields| fields.map_or(ExprKind::Error, ExprKind::Record));
    marked(Production::Record, record)
}

/// field = NAME [ "=" expr ] | ".." expr
fn field<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, Field> {
    let value = token(Token::Assign).ignore_then(expr.clone()).or_not();
    let named = name().then(value).map(|(name, value)| Field::Named { name, value });
    let spread = token(Token::DotDot).ignore_then(expr).map(Field::Spread);
    marked(Production::Field, named.or(spread))
}

/// if = "if" expr block [ "else" ( block | if ) ]
fn if_<'s>(expr: impl Parse<'s, Expr>, block: impl Parse<'s, Block>) -> Boxed<'s, Expr> {
    let chain = recursive(|chain| {
        let otherwise = block.clone().or(chain.map(block_of));
        token(Token::If)
            .ignore_then(expr.map(Box::new))
            .then(block)
            .then(token(Token::Else).ignore_then(otherwise).or_not())
            .map_with(|((condition, then), otherwise), extra| {
                let span = here(extra);
                Expr { kind: ExprKind::If { condition, then, otherwise }, span }
            })
    });
    marked(Production::If, chain)
}

fn block_of(expr: Expr) -> Block {
    let span = expr.span;
    Block { stmts: vec![Stmt { kind: StmtKind::Expr(expr), span }], span }
}

fn for_<'s>(expr: impl Parse<'s, Expr>, block: impl Parse<'s, Block>) -> Boxed<'s, ExprKind> {
    let binders = binder(expr.clone()).separated_by(token(Token::Comma)).at_least(1).collect();
    let condition = token(Token::If).ignore_then(expr.map(Box::new)).or_not();
    token(Token::For)
        .ignore_then(binders)
        .then(condition)
        .then(block)
        .map(|((binders, condition), body)| ExprKind::For { binders, condition, body })
        .boxed()
}

/// binder = NAME ["," NAME] "in" expr
fn binder<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, Binder> {
    let index = token(Token::Comma).ignore_then(name()).or_not();
    let binder = name().then(index).then_ignore(token(Token::In)).then(expr);
    let binder = binder.map(|((name, index), source)| Binder { name, index, source });
    marked(Production::Binder, binder)
}
