//! The names of the productions, so that a test can see which ones a text uses.

use super::read;
use crate::base::SourceId;

macro_rules! productions {
    ($($variant:ident = $name:literal,)*) => {
        /// A production of the grammar.
        #[allow(missing_docs, reason = "each is named for the production of grammar/katachi.ebnf")]
        #[derive(Clone, Copy, PartialEq, Eq, Debug)]
        pub enum Production { $($variant,)* }

        impl Production {
            /// Every production, in the order of the grammar.
            pub const ALL: &'static [Production] = &[$(Production::$variant),*];

            /// Its name in the grammar.
            pub const fn name(self) -> &'static str {
                match self { $(Production::$variant => $name,)* }
            }
        }
    };
}

productions! {
    Program = "program",
    Item = "item",
    Use = "use",
    Group = "group",
    Set = "set",
    Param = "param",
    Output = "output",
    Export = "export",
    Test = "test",
    Stmt = "stmt",
    Fn = "fn",
    FnParam = "fparam",
    Type = "type",
    Block = "block",
    Expr = "expr",
    Or = "or",
    And = "and",
    Not = "not",
    Cmp = "cmp",
    Range = "range",
    Sum = "sum",
    Prod = "prod",
    Unary = "unary",
    Power = "power",
    Postfix = "postfix",
    Arg = "arg",
    Primary = "primary",
    If = "if",
    Binder = "binder",
    Record = "record",
    Field = "field",
    Number = "NUMBER",
    Text = "STRING",
    Name = "NAME",
    Doc = "DOC",
}

/// A set of productions.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Productions(u64);

impl Productions {
    pub(super) fn add(&mut self, production: Production) {
        self.0 |= 1 << production as u64;
    }

    fn has(self, production: Production) -> bool {
        self.0 >> (production as u64) & 1 == 1
    }
}

/// The productions that the tree of `text` is made of. Those that pass through to a tighter one
/// (`sum` without a `+`) do not count.
///
/// ```
/// use katachi::syntax::{Production, productions};
/// assert!(productions("1 + 2").contains(&Production::Sum));
/// assert!(!productions("1 * 2").contains(&Production::Sum));
/// ```
pub fn productions(text: &str) -> Vec<Production> {
    let (_, _, used) = read(SourceId(0), text);
    Production::ALL.iter().copied().filter(|production| used.has(*production)).collect()
}
