//! Reading by hand, token for token, where a combinator would be tried in vain at most places.
//!
//! A function here gives `None` where what it reads does not begin or breaks off. What it needed has
//! been [noted](note) then, at the token where it stopped; how far it has read is not specified.

use chumsky::{
    input::{Checkpoint, InputRef},
    prelude::*,
};

use super::{Extra, Fault, Input, Parse, Productions};
use crate::syntax::token::{Token, TokenSet};

/// Where the parser is.
pub(super) type Reader<'s, 'p> = InputRef<'s, 'p, Input<'s>, Extra<'s>>;

/// A function that reads, as a parser.
pub(super) fn reading<'s, T: 's>(
    read: impl Fn(&mut Reader<'s, '_>) -> Option<T> + Clone + 's,
) -> impl Parse<'s, T> {
    custom::<_, Input<'s>, _, Extra<'s>>(move |input| {
        let at = place(input);
        // What was needed has been noted where it was missed.
        read(input).ok_or(Fault { at, expected: TokenSet::EMPTY })
    })
}

/// Index of the next token.
#[inline]
pub(super) fn place(input: &Reader<'_, '_>) -> usize {
    *input.cursor().inner()
}

/// Remembers that one of these tokens could have stood here.
#[inline]
pub(super) fn note(input: &mut Reader<'_, '_>, expected: TokenSet) {
    let missing =
        custom::<_, Input, (), Extra>(move |input| Err(Fault { at: place(input), expected }));
    let _ = input.parse(missing.or_not());
}

/// Takes one of the given tokens.
#[inline]
pub(super) fn accept(input: &mut Reader<'_, '_>, set: TokenSet) -> Option<Token> {
    match input.peek() {
        Some(token) if set.has(token) => {
            input.skip();
            Some(token)
        }
        _ => {
            note(input, set);
            None
        }
    }
}

/// Runs a parser made with [`or_not`](Parser::or_not).
#[inline]
pub(super) fn run<'s, T>(
    input: &mut Reader<'s, '_>,
    parser: &impl Parser<'s, Input<'s>, Option<T>, Extra<'s>>,
) -> Option<T> {
    input.parse(parser).ok().flatten()
}

/// Goes on with `skip` from where something that could not be read began, and reports it.
pub(super) fn recover<'s, 'p, T>(
    input: &mut Reader<'s, 'p>,
    before: Checkpoint<'s, 'p, Input<'s>, Productions>,
    skip: impl FnOnce(&mut Reader<'s, 'p>) -> T,
) -> T {
    input.rewind(before);
    let fault = fault(input);
    let skipped = skip(input);
    input.emit(fault);
    skipped
}

/// What has been noted farthest on, and is forgotten by this.
fn fault(input: &mut Reader<'_, '_>) -> Fault {
    let at = place(input);
    let missing =
        custom::<_, Input, (), Extra>(move |_| Err(Fault { at, expected: TokenSet::EMPTY }));
    input.parse(missing).expect_err("it fails always")
}
