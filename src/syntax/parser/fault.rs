//! The parser's own error: cheap to make and to merge, put into words later.

use chumsky::{DefaultExpected, error::Error, label::LabelError, span::SimpleSpan, util::MaybeRef};

use super::Input;
use crate::syntax::token::{Token, TokenSet};

/// The grammar cannot go on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Fault {
    /// Index of the token it stopped at; their number at the end of the file.
    pub at: usize,
    /// What it could have gone on with.
    pub expected: TokenSet,
}

impl<'s> Error<'s, Input<'s>> for Fault {
    fn merge(self, other: Fault) -> Fault {
        Fault { at: self.at.max(other.at), expected: self.expected.or(other.expected) }
    }
}

impl<'s> LabelError<'s, Input<'s>, DefaultExpected<'s, Token>> for Fault {
    fn expected_found<E: IntoIterator<Item = DefaultExpected<'s, Token>>>(
        expected: E,
        _found: Option<MaybeRef<'s, Token>>,
        span: SimpleSpan<usize>,
    ) -> Fault {
        let expected = expected.into_iter().fold(TokenSet::EMPTY, |set, item| match item {
            DefaultExpected::Token(token) => set.or(TokenSet::of(&[*token])),
            _ => set,
        });
        Fault { at: span.start, expected }
    }
}
