//! The words and signs of the language, and sets of them.

use logos::Logos;

/// One token. It carries no text: its span leads to the characters.
///
/// The words from `part` on are keywords only where the grammar can take them; elsewhere, and
/// always behind a `.`, they are names.
#[derive(Logos, Clone, Copy, PartialEq, Eq, Debug)]
#[logos(skip r"[ \t\f\u{a0}\u{2000}-\u{200b}\u{3000}\u{feff}]+")]
#[repr(u8)]
pub enum Token {
    /// One or more line ends.
    #[regex(r"\r?\n|\r")]
    Newline,
    /// A comment of one line: also `///` and `//!` before they are told apart.
    #[regex(r"//[^\r\n]*", allow_greedy = true)]
    LineComment,
    /// The opening of a `/* ... */` comment, then the whole of it.
    #[token("/*")]
    BlockComment,
    /// A line of documentation: `/// ...`.
    Doc,
    /// A line of documentation for the whole file: `//! ...`.
    FileDoc,
    /// A number with its unit. The pattern matches the leading digits only.
    #[regex(r"[0-9]+")]
    Number,
    /// The opening quote of a string.
    #[token("\"")]
    StringStart,
    /// Characters of a string, escapes as written.
    StringText,
    /// The `{` of an interpolation.
    HoleOpen,
    /// The `}` of an interpolation.
    HoleClose,
    /// The closing quote of a string.
    StringEnd,
    /// A name.
    #[regex(r"[A-Za-z_][A-Za-z0-9_]*", priority = 3)]
    #[regex(r"[_\p{XID_Start}]\p{XID_Continue}*", priority = 1)]
    Name,
    /// Characters that are no token; a diagnostic has been given.
    Bad,
    /// `;`, which only other languages need.
    #[token(";")]
    Semicolon,
    /// `(`
    #[token("(")]
    LParen,
    /// The `(` before the parameters of a lambda.
    LambdaParen,
    /// `)`
    #[token(")")]
    RParen,
    /// `[`
    #[token("[")]
    LBracket,
    /// `]`
    #[token("]")]
    RBracket,
    /// `{`
    #[token("{")]
    LBrace,
    /// `}`
    #[token("}")]
    RBrace,
    /// `,`
    #[token(",")]
    Comma,
    /// `.`
    #[token(".")]
    Dot,
    /// `:`
    #[token(":")]
    Colon,
    /// `=`
    #[token("=")]
    Assign,
    /// `=>`
    #[token("=>")]
    FatArrow,
    /// `->`
    #[token("->")]
    Arrow,
    /// `..`
    #[token("..")]
    DotDot,
    /// `..<`
    #[token("..<")]
    DotDotLess,
    /// `+`
    #[token("+")]
    Plus,
    /// `-`
    #[token("-")]
    Minus,
    /// `++`
    #[token("++")]
    Join,
    /// `*`
    #[token("*")]
    Star,
    /// `/`
    #[token("/")]
    Slash,
    /// `%`
    #[token("%")]
    Percent,
    /// `&`
    #[token("&")]
    Ampersand,
    /// `^`
    #[token("^")]
    Caret,
    /// `==`
    #[token("==")]
    Equal,
    /// `!=`
    #[token("!=")]
    NotEqual,
    /// `<`
    #[token("<")]
    Less,
    /// `<=`
    #[token("<=")]
    LessEqual,
    /// `>`
    #[token(">")]
    Greater,
    /// `>=`
    #[token(">=")]
    GreaterEqual,
    /// `and`
    #[token("and")]
    And,
    /// `or`
    #[token("or")]
    Or,
    /// `not`
    #[token("not")]
    Not,
    /// `true`
    #[token("true")]
    True,
    /// `false`
    #[token("false")]
    False,
    /// `if`
    #[token("if")]
    If,
    /// `else`
    #[token("else")]
    Else,
    /// `for`
    #[token("for")]
    For,
    /// `in`
    #[token("in")]
    In,
    /// `do`
    #[token("do")]
    Do,
    /// `fn`
    #[token("fn")]
    Fn,
    /// `part`
    #[token("part")]
    Part,
    /// `view`
    #[token("view")]
    View,
    /// `shade`
    #[token("shade")]
    Shade,
    /// `sheet`
    #[token("sheet")]
    Sheet,
    /// `param`
    #[token("param")]
    Param,
    /// `use`
    #[token("use")]
    Use,
    /// `set`
    #[token("set")]
    Set,
    /// `test`
    #[token("test")]
    Test,
    /// `export`
    #[token("export")]
    Export,
    /// `group`
    #[token("group")]
    Group,
    /// `assert`
    #[token("assert")]
    Assert,
    /// `pub`
    #[token("pub")]
    Pub,
    /// `as`
    #[token("as")]
    As,
    /// `with`
    #[token("with")]
    With,
    /// `step`
    #[token("step")]
    Step,
    /// `when`
    #[token("when")]
    When,
    /// `fails`
    #[token("fails")]
    Fails,
}

impl Token {
    /// How a message names the token, where its own characters are not shown.
    pub const fn describe(self) -> &'static str {
        match self {
            Token::Newline => "the end of the line",
            Token::Name => "a name",
            Token::Number => "a number",
            Token::StringStart => "a string in quotes",
            Token::LParen | Token::LambdaParen => "`(`",
            Token::RParen => "`)`",
            Token::LBracket => "`[`",
            Token::RBracket => "`]`",
            Token::LBrace => "`{`",
            Token::RBrace | Token::HoleClose => "`}`",
            Token::Comma => "`,`",
            Token::Dot => "`.`",
            Token::Colon => "`:`",
            Token::Assign => "`=`",
            Token::FatArrow => "`=>`",
            Token::Arrow => "`->`",
            Token::In => "`in`",
            Token::As => "`as`",
            Token::Else => "`else`",
            Token::If => "`if`",
            Token::Fn => "`fn`",
            Token::With => "`with`",
            Token::When => "`when`",
            Token::Step => "`step`",
            Token::Fails => "`fails`",
            Token::DotDot => "`..`",
            _ => "something else",
        }
    }
}

/// The tokens that a message can name as needed.
const NAMED: &[Token] = &[
    Token::Newline,
    Token::Name,
    Token::Number,
    Token::StringStart,
    Token::LParen,
    Token::RParen,
    Token::LBracket,
    Token::RBracket,
    Token::LBrace,
    Token::RBrace,
    Token::HoleClose,
    Token::Comma,
    Token::Dot,
    Token::Colon,
    Token::Assign,
    Token::FatArrow,
    Token::Arrow,
    Token::In,
    Token::If,
    Token::Else,
    Token::Fn,
    Token::As,
    Token::With,
    Token::Step,
    Token::When,
    Token::Fails,
];

/// A set of tokens.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct TokenSet(u128);

impl TokenSet {
    /// No token.
    pub const EMPTY: TokenSet = TokenSet(0);

    /// The words that name what is made.
    pub const OUTPUTS: TokenSet =
        TokenSet::of(&[Token::Part, Token::View, Token::Shade, Token::Sheet]);

    /// The words that begin an item and are names elsewhere.
    pub const ITEMS: TokenSet = TokenSet::OUTPUTS.or(TokenSet::of(&[
        Token::Param,
        Token::Use,
        Token::Set,
        Token::Test,
        Token::Export,
        Token::Group,
        Token::Pub,
    ]));

    /// Names and the words that are names where the grammar takes no keyword.
    pub const NAMES: TokenSet = TokenSet::ITEMS.or(TokenSet::of(&[
        Token::Name,
        Token::Assert,
        Token::As,
        Token::With,
        Token::Step,
        Token::When,
        Token::Fails,
    ]));

    /// The words that are never names, but behind a `.`.
    pub const RESERVED: TokenSet = TokenSet::of(&[
        Token::And,
        Token::Or,
        Token::Not,
        Token::True,
        Token::False,
        Token::If,
        Token::Else,
        Token::For,
        Token::In,
        Token::Do,
        Token::Fn,
    ]);

    /// The infix operators that compare.
    pub const COMPARISONS: TokenSet = TokenSet::of(&[
        Token::Equal,
        Token::NotEqual,
        Token::Less,
        Token::LessEqual,
        Token::Greater,
        Token::GreaterEqual,
    ]);

    /// The infix operators.
    pub const OPERATORS: TokenSet = TokenSet::of(&[
        Token::DotDot,
        Token::DotDotLess,
        Token::Plus,
        Token::Minus,
        Token::Join,
        Token::Star,
        Token::Slash,
        Token::Percent,
        Token::Ampersand,
        Token::Caret,
        Token::And,
        Token::Or,
    ])
    .or(TokenSet::COMPARISONS);

    /// What an expression can begin with.
    pub const STARTS: TokenSet = TokenSet::of(&[
        Token::Number,
        Token::StringStart,
        Token::True,
        Token::False,
        Token::LParen,
        Token::LambdaParen,
        Token::LBracket,
        Token::LBrace,
        Token::Do,
        Token::If,
        Token::For,
        Token::Not,
        Token::Minus,
        Token::Bad,
    ])
    .or(TokenSet::NAMES);

    /// The opening brackets.
    pub const OPENERS: TokenSet = TokenSet::of(&[
        Token::LParen,
        Token::LambdaParen,
        Token::LBracket,
        Token::LBrace,
        Token::HoleOpen,
    ]);

    /// The closing brackets.
    pub const CLOSERS: TokenSet =
        TokenSet::of(&[Token::RParen, Token::RBracket, Token::RBrace, Token::HoleClose]);

    /// The given tokens.
    pub const fn of(tokens: &[Token]) -> TokenSet {
        let mut bits = 0;
        let mut i = 0;
        while i < tokens.len() {
            bits |= 1 << tokens[i] as u8;
            i += 1;
        }
        TokenSet(bits)
    }

    /// Whether the token is among them.
    pub const fn has(self, token: Token) -> bool {
        self.0 >> (token as u8) & 1 == 1
    }

    /// The tokens of either set.
    pub const fn or(self, other: TokenSet) -> TokenSet {
        TokenSet(self.0 | other.0)
    }

    /// The tokens of this set that the other lacks.
    pub const fn without(self, other: TokenSet) -> TokenSet {
        TokenSet(self.0 & !other.0)
    }

    /// The tokens in it that a message can name, in the order of their declaration.
    pub fn iter(self) -> impl Iterator<Item = Token> {
        NAMED.iter().copied().filter(move |token| self.has(*token))
    }
}

/// Tokens and their byte ranges, in two columns: the parser reads the narrow one.
#[derive(Clone, Debug, Default)]
pub struct Tokens {
    /// What each token is.
    pub kinds: Vec<Token>,
    /// The bytes each one covers, start and end.
    pub spans: Vec<(u32, u32)>,
}

impl Tokens {
    /// Room for so many tokens.
    pub fn with_capacity(count: usize) -> Tokens {
        Tokens { kinds: Vec::with_capacity(count), spans: Vec::with_capacity(count) }
    }

    /// Adds a token at the end.
    pub fn push(&mut self, kind: Token, span: (u32, u32)) {
        self.kinds.push(kind);
        self.spans.push(span);
    }

    /// Keeps the first `count` tokens.
    pub fn truncate(&mut self, count: usize) {
        self.kinds.truncate(count);
        self.spans.truncate(count);
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// The token at a place, if there is one.
    pub fn get(&self, index: usize) -> Option<Token> {
        self.kinds.get(index).copied()
    }
}
