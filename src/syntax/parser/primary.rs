//! Expressions that begin with a token of their own, and what follows them directly.

use chumsky::prelude::*;

use super::{
    Boxed, Parse, Production,
    atom::{marked, name, string, take, token},
    expr::{expression, lambda},
    reader::{Reader, accept, note, place, recover, run},
    recover::{rest_of_bracket, skip_bracket},
    state::{Rows, here},
};
use crate::syntax::{
    ast::{Argument, Binder, Block, Expr, ExprKind, Field, For, If, Member, Name, Stmt, StmtKind},
    token::{Token, TokenSet},
};

/// The rarer forms of an expression, each by the token it begins with.
pub(super) struct Forms<'s> {
    pub lambda: Boxed<'s, Option<Expr>>,
    text: Boxed<'s, Option<Expr>>,
    record: Boxed<'s, Option<Expr>>,
    run: Boxed<'s, Option<Expr>>,
    decision: Boxed<'s, Option<Expr>>,
    repeat: Boxed<'s, Option<Expr>>,
}

impl<'s> Forms<'s> {
    pub fn new(expr: impl Parse<'s, Expr>, block: impl Parse<'s, Block>) -> Forms<'s> {
        let spanned = |kind: Boxed<'s, ExprKind>| {
            kind.map_with(|kind, extra| Expr { kind, span: here(extra) }).or_not().boxed()
        };
        let run = token(Token::Do).ignore_then(block.clone());
        Forms {
            lambda: spanned(lambda(expr.clone())),
            text: spanned(string(expr.clone()).map(|text| ExprKind::Text(text.into())).boxed()),
            record: spanned(record(expr.clone())),
            run: spanned(run.map(|block| ExprKind::Do(block.into())).boxed()),
            decision: if_(expr.clone(), block.clone()).or_not().boxed(),
            repeat: spanned(for_(expr, block)),
        }
    }
}

/// postfix = primary { "." NAME | "(" [ arg { "," arg } [","] ] ")" | "[" expr "]" }
pub(super) fn postfix<'s>(input: &mut Reader<'s, '_>, forms: &Forms<'s>) -> Option<Expr> {
    let start = place(input);
    let mut object = primary(input, forms)?;
    loop {
        let before = input.save();
        let kind = match input.peek() {
            Some(Token::Dot) => match member_name(input) {
                Some(name) => ExprKind::Member(Box::new(Member { object, name })),
                None => {
                    input.rewind(before);
                    return Some(object);
                }
            },
            Some(Token::LParen | Token::LambdaParen) => {
                let commas = |input: &mut Reader<'s, '_>| commas(input, forms, arg);
                match inside(input, Token::RParen, commas) {
                    Some(arguments) => ExprKind::Call { callee: Box::new(object), arguments },
                    None => ExprKind::Error,
                }
            }
            Some(Token::LBracket) => {
                match inside(input, Token::RBracket, |input| expression(input, forms)) {
                    Some(index) => ExprKind::Index { object: object.into(), index: index.into() },
                    None => ExprKind::Error,
                }
            }
            _ => return Some(object),
        };
        let end = place(input);
        let state = input.state();
        state.mark(Production::Postfix);
        object = Expr { kind, span: state.span(start, end) };
    }
}

/// The name behind a `.`: any word.
fn member_name(input: &mut Reader<'_, '_>) -> Option<Name> {
    input.skip();
    let at = place(input);
    accept(input, TokenSet::NAMES.or(TokenSet::RESERVED))?;
    Some(input.state().name(at))
}

/// What stands in the brackets that open here; `None`, behind them, where it is broken.
fn inside<'s, T>(
    input: &mut Reader<'s, '_>,
    closer: Token,
    content: impl FnOnce(&mut Reader<'s, '_>) -> Option<T>,
) -> Option<T> {
    input.skip();
    let before = input.save();
    let found = content(input);
    if found.is_some() && accept(input, TokenSet::of(&[closer])).is_some() {
        return found;
    }
    recover(input, before, skip_bracket);
    None
}

/// Elements with commas between them; a comma may stand behind the last.
fn commas<'s, T>(
    input: &mut Reader<'s, '_>,
    forms: &Forms<'s>,
    element: impl Fn(&mut Reader<'s, '_>, &Forms<'s>) -> Option<T>,
) -> Option<Vec<T>>
where
    Rows: AsMut<Vec<T>>,
{
    let first = input.state().rows.as_mut().len();
    loop {
        let before = input.save();
        let Some(found) = element(input, forms) else {
            input.rewind(before);
            break;
        };
        input.state().rows.as_mut().push(found);
        if accept(input, TokenSet::of(&[Token::Comma])).is_none() {
            break;
        }
    }
    // Taken out of a shared row, since a vector that grows keeps room it does not need.
    Some(input.state().rows.as_mut().drain(first..).collect())
}

/// arg = NAME "=" expr | ".." expr | expr
fn arg<'s>(input: &mut Reader<'s, '_>, forms: &Forms<'s>) -> Option<Argument> {
    let at = place(input);
    let argument = match input.peek() {
        Some(Token::DotDot) => {
            input.skip();
            Argument::Spread(expression(input, forms)?)
        }
        Some(token)
            if TokenSet::NAMES.has(token) && input.state().kind(at + 1) == Some(Token::Assign) =>
        {
            input.skip();
            input.skip();
            let name = input.state().name(at);
            Argument::Named { name, value: expression(input, forms)? }
        }
        _ => Argument::Positional(expression(input, forms)?),
    };
    input.state().mark(Production::Arg);
    Some(argument)
}

/// primary = NUMBER | STRING | NAME | "true" | "false" | "(" expr ")" | "[" ... "]" | record
///         | "do" block | if | "for" binder { "," binder } [ "if" expr ] block
fn primary<'s>(input: &mut Reader<'s, '_>, forms: &Forms<'s>) -> Option<Expr> {
    let start = place(input);
    let expr = match input.peek() {
        Some(Token::StringStart) => run(input, &forms.text)?,
        Some(Token::LBrace) => run(input, &forms.record)?,
        Some(Token::Do) => run(input, &forms.run)?,
        Some(Token::If) => run(input, &forms.decision)?,
        Some(Token::For) => run(input, &forms.repeat)?,
        Some(token) if PLAIN.has(token) => {
            input.skip();
            input.state().atom(token, start)
        }
        Some(token @ (Token::LParen | Token::LBracket)) => {
            let kind = bracketed(input, forms, token).unwrap_or(ExprKind::Error);
            let end = place(input);
            Expr { kind, span: input.state().span(start, end) }
        }
        _ => {
            note(input, TokenSet::STARTS);
            return None;
        }
    };
    input.state().mark(Production::Primary);
    Some(expr)
}

/// The tokens that are an expression by themselves.
const PLAIN: TokenSet =
    TokenSet::of(&[Token::Number, Token::True, Token::False, Token::Bad]).or(TokenSet::NAMES);

/// "(" expr ")" | "[" [ expr { "," expr } [","] ] "]"
fn bracketed<'s>(input: &mut Reader<'s, '_>, forms: &Forms<'s>, opener: Token) -> Option<ExprKind> {
    if opener == Token::LParen {
        let inner = inside(input, Token::RParen, |input| expression(input, forms))?;
        return Some(ExprKind::Paren(Box::new(inner)));
    }
    let elements = |input: &mut Reader<'s, '_>| commas(input, forms, expression);
    Some(ExprKind::List(inside(input, Token::RBracket, elements)?))
}

/// record = "{" [ field { ("," | NL) field } [","] ] "}"
pub(super) fn record<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, ExprKind> {
    const SEPARATORS: TokenSet = TokenSet::of(&[Token::Comma, Token::Newline]);
    let fields = field(expr).separated_by(take(SEPARATORS)).allow_trailing().collect();
    let whole = fields.then_ignore(token(Token::RBrace)).map(|mut fields: Vec<Field>| {
        fields.shrink_to_fit();
        ExprKind::Record(fields)
    });
    let whole = whole.recover_with(via_parser(rest_of_bracket().map(|()| ExprKind::Error)));
    marked(Production::Record, token(Token::LBrace).ignore_then(whole))
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
            .ignore_then(expr)
            .then(block)
            .then(token(Token::Else).ignore_then(otherwise).or_not())
            .map_with(|((condition, then), otherwise), extra| {
                let kind = ExprKind::If(Box::new(If { condition, then, otherwise }));
                Expr { kind, span: here(extra) }
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
    let condition = token(Token::If).ignore_then(expr).or_not();
    token(Token::For)
        .ignore_then(binders)
        .then(condition)
        .then(block)
        .map(|((mut binders, condition), body): ((Vec<Binder>, _), _)| {
            binders.shrink_to_fit();
            ExprKind::For(Box::new(For { binders, condition, body }))
        })
        .boxed()
}

/// binder = NAME ["," NAME] "in" expr
fn binder<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, Binder> {
    let index = token(Token::Comma).ignore_then(name()).or_not();
    let binder = name().then(index).then_ignore(token(Token::In)).then(expr);
    let binder = binder.map(|((name, index), source)| Binder { name, index, source });
    marked(Production::Binder, binder)
}
