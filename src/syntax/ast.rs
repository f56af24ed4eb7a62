//! The syntax tree, node for node the grammar of `grammar/katachi.ebnf`.
//!
//! Every node carries the span of the characters it was read from. What the parser could not read
//! is an [`ExprKind::Error`] or is left out; a diagnostic stands for it.
//!
//! A file of ten thousand lines has a hundred thousand expressions, so what is rare or large stands
//! in a box: an [`Expr`] has 56 bytes.

use std::sync::Arc;

use crate::base::Span;

/// A word with its place.
#[derive(Clone, PartialEq, Debug)]
pub struct Name {
    /// The word, in Unicode NFC.
    pub text: Arc<str>,
    /// Its place.
    pub span: Span,
}

/// A whole file.
#[derive(Clone, PartialEq, Debug)]
pub struct Program {
    /// The `//!` lines, joined by line ends.
    pub doc: Option<Arc<str>>,
    /// The items in source order.
    pub items: Vec<Item>,
    /// The whole text.
    pub span: Span,
}

/// One top-level item.
#[derive(Clone, PartialEq, Debug)]
pub struct Item {
    /// The `///` lines before it, joined by line ends.
    pub doc: Option<Arc<str>>,
    /// What it is.
    pub kind: ItemKind,
    /// Its place, without the documentation.
    pub span: Span,
}

/// The kinds of top-level item.
#[derive(Clone, PartialEq, Debug)]
pub enum ItemKind {
    /// `use "path" as name with { ... }` or `use "path" { a, b as c }`.
    Use(Box<Use>),
    /// `param name: type = default in domain when condition`.
    Param(Box<Param>),
    /// `group "title"`: heading for the parameters that follow.
    Group(Text),
    /// `set name = expr`.
    Set {
        /// `tolerance` (the chord error of curves), `kernel` (what makes the solids) or `seed` (what
        /// functions with a `seed` of their own, such as `noise`, take when none is given).
        name: Name,
        /// The value.
        value: Expr,
    },
    /// `part`, `view`, `shade` or `sheet`.
    Output(Output),
    /// `export "file" = expr`.
    Export {
        /// The file's name under the output folder.
        file: Text,
        /// A shape, or a record of named shapes.
        value: Expr,
    },
    /// `test "title" { ... }`.
    Test(Box<Test>),
    /// A statement, with `pub` before it or not.
    Stmt {
        /// Whether `pub` stands before it (only before a binding or a function).
        public: bool,
        /// The statement.
        stmt: Stmt,
    },
}

/// Another file taken in.
#[derive(Clone, PartialEq, Debug)]
pub struct Use {
    /// The path as written.
    pub path: Text,
    /// What is taken from it.
    pub clause: UseClause,
}

/// What a `use` takes.
#[derive(Clone, PartialEq, Debug)]
pub enum UseClause {
    /// The whole file as a record-like module: `as name` (else the file's stem), `with { ... }`.
    Module {
        /// The name given with `as`.
        alias: Option<Name>,
        /// The parameters given with `with`: a record expression.
        with: Option<Expr>,
    },
    /// Single names.
    Names(Vec<UseName>),
}

/// One name taken from a file.
#[derive(Clone, PartialEq, Debug)]
pub struct UseName {
    /// Its name there.
    pub name: Name,
    /// Its name here, if another.
    pub alias: Option<Name>,
}

/// A parameter of the file.
#[derive(Clone, PartialEq, Debug)]
pub struct Param {
    /// Its name.
    pub name: Name,
    /// Its declared type.
    pub ty: Option<Box<Type>>,
    /// The value it has when none is given.
    pub default: Expr,
    /// The range or the list of choices it must lie in.
    pub domain: Option<Expr>,
    /// When it matters.
    pub condition: Option<Expr>,
}

/// A named output.
#[derive(Clone, PartialEq, Debug)]
pub struct Output {
    /// Whether `pub` stands before it (outputs are always reachable; kept for the formatter).
    pub public: bool,
    /// Which kind.
    pub kind: OutputKind,
    /// Its name.
    pub name: Name,
    /// What it shows.
    pub value: Expr,
}

/// The kinds of output.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum OutputKind {
    /// A solid.
    Part,
    /// A line drawing.
    View,
    /// A half-tone.
    Shade,
    /// A page.
    Sheet,
}

/// A test.
#[derive(Clone, PartialEq, Debug)]
pub struct Test {
    /// Its title.
    pub title: Text,
    /// With `fails "..."`: a text that the error must contain.
    pub fails: Option<Text>,
    /// Its statements.
    pub body: Block,
}

/// A statement.
#[derive(Clone, PartialEq, Debug)]
pub struct Stmt {
    /// What it is.
    pub kind: StmtKind,
    /// Its place.
    pub span: Span,
}

/// The kinds of statement.
#[derive(Clone, PartialEq, Debug)]
pub enum StmtKind {
    /// `name: type = expr`.
    Bind {
        /// The name.
        name: Name,
        /// Its declared type.
        ty: Option<Box<Type>>,
        /// The value.
        value: Expr,
    },
    /// `fn name(...) -> type = expr`.
    Fn(Arc<Function>),
    /// `assert expr, message`.
    Assert {
        /// What must hold.
        condition: Expr,
        /// What to say when it does not.
        message: Option<Expr>,
    },
    /// An expression for its value.
    Expr(Expr),
}

/// A named function.
#[derive(Clone, PartialEq, Debug)]
pub struct Function {
    /// Its name.
    pub name: Name,
    /// Its parameters.
    pub params: Vec<FnParam>,
    /// The declared type of its value.
    pub result: Option<Box<Type>>,
    /// Its body: `= expr` or a block.
    pub body: Body,
    /// From `fn` to the end of the body.
    pub span: Span,
}

/// A parameter of a function.
#[derive(Clone, PartialEq, Debug)]
pub struct FnParam {
    /// Its name.
    pub name: Name,
    /// Its declared type.
    pub ty: Option<Box<Type>>,
    /// Its default; a parameter with a default must be named in calls.
    pub default: Option<Expr>,
}

/// A function's body.
#[derive(Clone, PartialEq, Debug)]
pub enum Body {
    /// `= expr`.
    Expr(Expr),
    /// `{ ... }`.
    Block(Block),
}

/// A type such as `Length` or `List[Solid]`.
#[derive(Clone, PartialEq, Debug)]
pub struct Type {
    /// Its name.
    pub name: Name,
    /// What stands in brackets.
    pub arguments: Vec<Type>,
    /// Its place.
    pub span: Span,
}

/// Statements in braces; its value is that of the last statement.
#[derive(Clone, PartialEq, Debug)]
pub struct Block {
    /// The statements, at least one unless the parser recovered from an error.
    pub stmts: Vec<Stmt>,
    /// From brace to brace.
    pub span: Span,
}

/// A string literal.
#[derive(Clone, PartialEq, Debug)]
pub struct Text {
    /// Literal pieces and interpolated expressions in turn, as they stand.
    pub pieces: Vec<Piece>,
    /// From quote to quote.
    pub span: Span,
}

/// A piece of a string literal.
#[derive(Clone, PartialEq, Debug)]
pub enum Piece {
    /// Characters, escapes resolved.
    Literal(Arc<str>),
    /// `{expr}`.
    Expr(Box<Expr>),
}

/// An expression.
#[derive(Clone, PartialEq, Debug)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Its place. Parentheses around an expression belong to its span and leave no other trace,
    /// but for [`ExprKind::Paren`].
    pub span: Span,
}

/// The kinds of expression.
#[derive(Clone, PartialEq, Debug)]
pub enum ExprKind {
    /// A number as written: value before the unit is applied, and the unit.
    Number {
        /// The digits' value.
        value: f64,
        /// The unit behind them.
        unit: Option<Unit>,
    },
    /// A string.
    Text(Box<Text>),
    /// `true` or `false`.
    Bool(bool),
    /// A name.
    Name(Name),
    /// `(expr)`, kept because `(10mm)^2` differs from `10mm^2` and for the formatter.
    Paren(Box<Expr>),
    /// `[a, b]`.
    List(Vec<Expr>),
    /// `{ a = 1, ..b }`.
    Record(Vec<Field>),
    /// `do { ... }`.
    Do(Box<Block>),
    /// `if c { } else { }`.
    If(Box<If>),
    /// `for a, i in list, b in other if c { }`.
    For(Box<For>),
    /// `a => expr`.
    Lambda {
        /// Its parameters.
        params: Vec<Name>,
        /// Its value.
        body: Arc<Expr>,
    },
    /// `-a` or `not a`.
    Unary {
        /// The operator.
        op: UnaryOp,
        /// The operator's place.
        op_span: Span,
        /// The operand.
        operand: Box<Expr>,
    },
    /// `a + b` and its like, `and` and `or` among them.
    Binary(Box<Binary>),
    /// `a + b - c`: two or more operators that bind alike, from left to right.
    Chain(Box<Chain>),
    /// `a..b step c`.
    Range(Box<Range>),
    /// `f(a, b = c, ..d)`.
    Call {
        /// What is called; a [`ExprKind::Member`] may be a uniform call `x.f(a)`.
        callee: Box<Expr>,
        /// The arguments.
        arguments: Vec<Argument>,
    },
    /// `a.name`.
    Member(Box<Member>),
    /// `a[i]`.
    Index {
        /// What is indexed.
        object: Box<Expr>,
        /// The index.
        index: Box<Expr>,
    },
    /// What could not be read; a diagnostic has been given.
    Error,
}

/// `if c { } else { }`.
#[derive(Clone, PartialEq, Debug)]
pub struct If {
    /// The condition.
    pub condition: Expr,
    /// When it holds.
    pub then: Block,
    /// When it does not; the block of `else if` holds one `if` expression.
    pub otherwise: Option<Block>,
}

/// `for a, i in list, b in other if c { }`.
#[derive(Clone, PartialEq, Debug)]
pub struct For {
    /// What runs over what; later binders run inside earlier ones.
    pub binders: Vec<Binder>,
    /// The elements for which it holds are kept.
    pub condition: Option<Expr>,
    /// The value of each element.
    pub body: Block,
}

/// `left op right`.
#[derive(Clone, PartialEq, Debug)]
pub struct Binary {
    /// The operator.
    pub op: BinaryOp,
    /// The operator's place.
    pub op_span: Span,
    /// What stands left of it.
    pub left: Expr,
    /// What stands right of it.
    pub right: Expr,
}

/// `first op right op right ...`, flat: a sum of 100,000 terms is no deeper than one of two.
#[derive(Clone, PartialEq, Debug)]
pub struct Chain {
    /// What stands left of all operators.
    pub first: Expr,
    /// At least two, whose operators bind alike.
    pub links: Vec<Link>,
}

/// One operator of a [`Chain`]: its left operand is all that stands before it.
#[derive(Clone, PartialEq, Debug)]
pub struct Link {
    /// The operator.
    pub op: BinaryOp,
    /// The operator's place.
    pub op_span: Span,
    /// What stands right of it.
    pub right: Expr,
}

/// `start..end step step`.
#[derive(Clone, PartialEq, Debug)]
pub struct Range {
    /// The first element.
    pub start: Expr,
    /// The bound.
    pub end: Expr,
    /// Whether the bound itself belongs to it (`..`) or not (`..<`).
    pub inclusive: bool,
    /// The step, else 1 in the start's unit.
    pub step: Option<Expr>,
}

/// `object.name`.
#[derive(Clone, PartialEq, Debug)]
pub struct Member {
    /// What has it.
    pub object: Expr,
    /// Its name.
    pub name: Name,
}

/// A unit behind a number.
#[derive(Clone, PartialEq, Debug)]
pub struct Unit {
    /// `um mm cm m in ft deg rad turn`.
    pub name: UnitName,
    /// The exponent written behind it, else 1.
    pub exponent: i8,
}

/// The units of the language.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum UnitName {
    /// Micrometre.
    Um,
    /// Millimetre.
    Mm,
    /// Centimetre.
    Cm,
    /// Metre.
    M,
    /// Inch, 25.4 mm.
    In,
    /// Foot, 304.8 mm.
    Ft,
    /// Degree.
    Deg,
    /// Radian.
    Rad,
    /// Full turn, 360 degrees.
    Turn,
}

impl UnitName {
    /// How long one of a unit of length is; `None` for angles.
    ///
    /// ```
    /// use katachi::syntax::ast::UnitName;
    /// assert_eq!(UnitName::In.millimetres(), Some(25.4));
    /// assert_eq!(UnitName::Deg.millimetres(), None);
    /// ```
    pub const fn millimetres(self) -> Option<f64> {
        match self {
            UnitName::Um => Some(0.001),
            UnitName::Mm => Some(1.0),
            UnitName::Cm => Some(10.0),
            UnitName::M => Some(1000.0),
            UnitName::In => Some(25.4),
            UnitName::Ft => Some(304.8),
            UnitName::Deg | UnitName::Rad | UnitName::Turn => None,
        }
    }
}

/// A field of a record.
#[derive(Clone, PartialEq, Debug)]
pub enum Field {
    /// `name = expr`, or `name` alone for `name = name`.
    Named {
        /// The key.
        name: Name,
        /// The value; `None` takes the value of the name in scope.
        value: Option<Expr>,
    },
    /// `..expr`.
    Spread(Expr),
}

/// One `name, index in expr` of a `for`.
#[derive(Clone, PartialEq, Debug)]
pub struct Binder {
    /// The element.
    pub name: Name,
    /// Its index, from 0.
    pub index: Option<Name>,
    /// What it runs over.
    pub source: Expr,
}

/// An argument of a call.
#[derive(Clone, PartialEq, Debug)]
pub enum Argument {
    /// `expr`.
    Positional(Expr),
    /// `name = expr`.
    Named {
        /// The parameter.
        name: Name,
        /// The value.
        value: Expr,
    },
    /// `..record` gives named arguments, `..list` positional ones.
    Spread(Expr),
}

/// The prefix operators.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum UnaryOp {
    /// `-`.
    Negate,
    /// `not`.
    Not,
}

/// The infix operators.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum BinaryOp {
    /// `or`.
    Or,
    /// `and`.
    And,
    /// `==`.
    Equal,
    /// `!=`.
    NotEqual,
    /// `<`.
    Less,
    /// `<=`.
    LessEqual,
    /// `>`.
    Greater,
    /// `>=`.
    GreaterEqual,
    /// `+`.
    Add,
    /// `-`.
    Subtract,
    /// `++`.
    Join,
    /// `*`.
    Multiply,
    /// `/`.
    Divide,
    /// `%`.
    Remainder,
    /// `&`.
    Intersect,
    /// `^`.
    Power,
}
