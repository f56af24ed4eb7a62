//! The file and its top-level items.

use std::{rc::Rc, sync::Arc};

use chumsky::prelude::*;

use super::{
    Boxed, Parse, Production,
    atom::{doc, marked, name, string, take, token},
    expr::expr,
    primary::record,
    reader::{Reader, accept, place, reading, recover, run},
    recover::{broken_stmt, ends_statement},
    state::here,
    stmt::{Stmts, annotation, bind, block, fn_},
};
use crate::syntax::{
    ast::{
        Block, Expr, Item, ItemKind, Output, OutputKind, Param, Stmt, StmtKind, Test, Text, Use,
        UseClause, UseName,
    },
    token::{Token, TokenSet},
};

/// program = [ item { NL item } ]
pub(super) fn program<'s>() -> impl Parse<'s, Vec<Item>> {
    let expr = expr().boxed();
    let block = block(expr.clone()).boxed();
    let items = Rc::new(Items::new(expr, block));
    reading(move |input| {
        let mut found = vec![];
        while input.peek().is_some() {
            found.push(items.whole(input));
            if accept(input, TokenSet::of(&[Token::Newline])).is_none() {
                break;
            }
        }
        input.state().mark(Production::Program);
        Some(found)
    })
}

/// The items: those that begin with a word of their own, and statements.
struct Items<'s> {
    doc: Boxed<'s, Option<Arc<str>>>,
    worded: Boxed<'s, Option<ItemKind>>,
    stmts: Stmts<'s>,
}

impl<'s> Items<'s> {
    fn new(expr: impl Parse<'s, Expr>, block: impl Parse<'s, Block>) -> Items<'s> {
        let text = string(expr.clone());
        let worded = choice((
            use_(text.clone(), expr.clone()).map(|item| ItemKind::Use(item.into())),
            param(expr.clone()).map(|item| ItemKind::Param(item.into())),
            group(text.clone()),
            set(expr.clone()),
            output(expr.clone()).map(ItemKind::Output),
            export(text.clone(), expr.clone()),
            test(text, block.clone()).map(|item| ItemKind::Test(item.into())),
            public(expr.clone(), block.clone()),
        ));
        Items {
            doc: doc().or_not().boxed(),
            worded: worded.or_not().boxed(),
            stmts: Stmts::new(expr, block),
        }
    }

    /// An item up to its end; one that cannot be read is left out with a message.
    fn whole(&self, input: &mut Reader<'s, '_>) -> Item {
        let doc = match input.peek() {
            Some(Token::Doc) => run(input, &self.doc),
            _ => None,
        };
        let start = place(input);
        let before = input.save();
        let kind = match self.kind(input).filter(|_| ends_statement(input)) {
            Some(kind) => kind,
            None => ItemKind::Stmt { public: true, stmt: recover(input, before, broken_stmt) },
        };
        let end = place(input);
        let state = input.state();
        state.mark(Production::Item);
        Item { doc, kind, span: state.span(start, end) }
    }

    /// item = DOC NL item | use | param | group | set | output | export | test
    ///      | "pub" NAME [":" type] "=" expr | "pub" fn | stmt
    fn kind(&self, input: &mut Reader<'s, '_>) -> Option<ItemKind> {
        if input.peek().is_some_and(|token| TokenSet::ITEMS.has(token))
            && let Some(kind) = run(input, &self.worded)
        {
            return Some(kind);
        }
        let stmt = self.stmts.read(input)?;
        Some(ItemKind::Stmt { public: false, stmt })
    }
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
    let public = token(Token::Pub).or_not().map(|word| word.is_some());
    let head = public.then(take(TokenSet::OUTPUTS)).then(name()).then_ignore(token(Token::Assign));
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
