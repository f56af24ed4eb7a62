//! The file and its top-level items.

use std::sync::Arc;

use chumsky::prelude::*;

use super::{
    Boxed, Parse, Production,
    atom::{doc, marked, name, string, take, token},
    expr::expr,
    primary::record,
    recover::{broken_stmt, statement_end},
    state::here,
    stmt::{annotation, bind, block, fn_, stmt},
};
use crate::syntax::{
    ast::{
        Block, Expr, Item, ItemKind, Output, OutputKind, Param, Stmt, StmtKind, Test, Text, Use,
        UseClause, UseName,
    },
    token::{Token, TokenSet},
};

/// program = [ item { NL item } ]
pub(super) fn program<'s>() -> Boxed<'s, Vec<Item>> {
    let expr = expr().boxed();
    let block = block(expr.clone()).boxed();
    let items = item(expr, block).separated_by(token(Token::Newline)).at_least(1).collect();
    let items = end().map(|()| vec![]).or(items);
    marked(Production::Program, items)
}

/// item = DOC NL item | use | param | group | set | output | export | test
///      | "pub" NAME [":" type] "=" expr | "pub" fn | stmt
fn item<'s>(expr: impl Parse<'s, Expr>, block: impl Parse<'s, Block>) -> Boxed<'s, Item> {
    let text = string(expr.clone());
    let kind = choice((
        use_(text.clone(), expr.clone()).map(ItemKind::Use),
        param(expr.clone()).map(ItemKind::Param),
        group(text.clone()),
        set(expr.clone()),
        output(expr.clone()).map(ItemKind::Output),
        export(text.clone(), expr.clone()),
        test(text, block.clone()).map(ItemKind::Test),
        public(expr.clone(), block.clone()),
        stmt(expr, block).map(|stmt| ItemKind::Stmt { public: false, stmt }),
    ));
    let broken = broken_stmt().map(|stmt| ItemKind::Stmt { public: true, stmt });
    let kind = kind.then_ignore(statement_end()).recover_with(via_parser(broken));
    let item = kind.map_with(|kind, extra| Item { doc: None, kind, span: here(extra) });
    let item = doc().or_not().then(item).map(|(doc, item)| Item { doc, ..item });
    marked(Production::Item, item)
}

/// use = "use" STRING ["as" NAME] ["with" record]
///     | "use" STRING "{" NAME ["as" NAME] { "," NAME ["as" NAME] } "}"
fn use_<'s>(text: Boxed<'s, Text>, expr: impl Parse<'s, Expr>) -> Boxed<'s, Use> {
    let alias = token(Token::As).ignore_then(name()).or_not();
    let with = record(expr).map_with(|kind, extra| Expr { kind, span: here(extra) });
    let with = token(Token::With).ignore_then(with).or_not();
    let module = alias.clone().then(with).map(|(alias, with)| UseClause::Module { alias, with });
    let single = name().then(alias).map(|(name, alias)| UseName { name, alias });
    let names = single.separated_by(token(Token::Comma)).at_least(1).allow_trailing().collect();
    let names = names.delimited_by(token(Token::LBrace), token(Token::RBrace));
    let clause = names.map(UseClause::Names).or(module);
    let parser = token(Token::Use).ignore_then(text).then(clause);
    marked(Production::Use, parser.map(|(path, clause)| Use { path, clause }))
}

/// param = "param" NAME [":" type] "=" expr ["in" expr] ["when" expr]
fn param<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, Param> {
    let head = token(Token::Param).ignore_then(name()).then(annotation());
    let default = token(Token::Assign).ignore_then(expr.clone());
    let domain = token(Token::In).ignore_then(expr.clone()).or_not();
    let condition = token(Token::When).ignore_then(expr).or_not();
    let parser = head.then(default).then(domain).then(condition);
    let parser = parser.map(|((((name, ty), default), domain), condition)| Param {
        name,
        ty,
        default,
        domain,
        condition,
    });
    marked(Production::Param, parser)
}

/// group = "group" STRING
fn group<'s>(text: Boxed<'s, Text>) -> Boxed<'s, ItemKind> {
    marked(Production::Group, token(Token::Group).ignore_then(text).map(ItemKind::Group))
}

/// set = "set" NAME "=" expr
fn set<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, ItemKind> {
    let parser = token(Token::Set).ignore_then(name()).then_ignore(token(Token::Assign)).then(expr);
    marked(Production::Set, parser.map(|(name, value)| ItemKind::Set { name, value }))
}

/// output = ["pub"] ("part" | "view" | "shade" | "sheet") NAME "=" expr
fn output<'s>(expr: impl Parse<'s, Expr>) -> Boxed<'s, Output> {
    const KINDS: TokenSet = TokenSet::of(&[Token::Part, Token::View, Token::Shade, Token::Sheet]);
    let public = token(Token::Pub).or_not().map(|word| word.is_some());
    let head = public.then(take(KINDS)).then(name()).then_ignore(token(Token::Assign));
    let parser = head.then(expr).map(|(((public, kind), name), value)| {
        let kind = match kind {
            Token::Part => OutputKind::Part,
            Token::View => OutputKind::View,
            Token::Shade => OutputKind::Shade,
            _ => OutputKind::Sheet,
        };
        Output { public, kind, name, value }
    });
    marked(Production::Output, parser)
}

/// export = "export" STRING "=" expr
fn export<'s>(text: Boxed<'s, Text>, expr: impl Parse<'s, Expr>) -> Boxed<'s, ItemKind> {
    let head = token(Token::Export).ignore_then(text).then_ignore(token(Token::Assign));
    let parser = head.then(expr).map(|(file, value)| ItemKind::Export { file, value });
    marked(Production::Export, parser)
}

/// test = "test" STRING ["fails" STRING] block
fn test<'s>(text: Boxed<'s, Text>, block: impl Parse<'s, Block>) -> Boxed<'s, Test> {
    let fails = token(Token::Fails).ignore_then(text.clone()).or_not();
    let parser = token(Token::Test).ignore_then(text).then(fails).then(block);
    marked(Production::Test, parser.map(|((title, fails), body)| Test { title, fails, body }))
}

/// "pub" NAME [":" type] "=" expr | "pub" fn
fn public<'s>(expr: impl Parse<'s, Expr>, block: impl Parse<'s, Block>) -> Boxed<'s, ItemKind> {
    let function = fn_(expr.clone(), block).map(|f| StmtKind::Fn(Arc::new(f)));
    let kind = bind(expr).or(function);
    let stmt = kind.map_with(|kind, extra| Stmt { kind, span: here(extra) });
    let parser = token(Token::Pub).ignore_then(stmt);
    parser.map(|stmt| ItemKind::Stmt { public: true, stmt }).boxed()
}
