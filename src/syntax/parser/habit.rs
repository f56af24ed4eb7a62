//! What was probably meant: slips of the pen, and habits from other languages.

use super::{fault::Fault, hint::Context};
use crate::{
    base::{Code, Diagnostic, Span},
    syntax::{
        number::UNITS,
        token::{Token, TokenSet},
    },
};

type Rule = fn(&Context<'_>, &Fault) -> Option<Diagnostic>;

/// The first rule that knows the fault speaks.
const RULES: &[Rule] = &[
    semicolon,
    foreign_word,
    foreign_loop,
    unquoted,
    several_in_parentheses,
    spaced_unit,
    assignment,
    chained_comparison,
    colon,
    thin_arrow,
    children,
    prefixed_verb,
    reserved_word,
    missing_comma,
    brace_on_next_line,
    missing_operand,
    empty_interpolation,
    stray_operator,
    two_statements,
];

/// The fault in the words that fit what was probably meant.
pub(super) fn recognise(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    RULES.iter().find_map(|rule| rule(context, fault))
}

fn error(message: impl Into<String>, place: Span, label: &str) -> Diagnostic {
    Diagnostic::error(Code::Syntax, message).label(place, label)
}

fn semicolon(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    let found = context.kind(fault.at) == Some(Token::Semicolon);
    let place = context.span(fault.at);
    found.then(|| {
        error("`;` has no place here", place, "found here").help("elements are separated by `,`")
    })
}

/// `module foo()`, `let x = 1`, `return x`: a word of another language before a name or value.
fn foreign_word(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    const WORDS: &[(&[&str], &str)] = &[
        (
            &["module", "function", "def", "func", "fun", "proc"],
            "a function is written `fn name(a, b = 2) = value`, or with a block `fn name(a) { ... }`",
        ),
        (&["let", "var", "const", "val"], "a value gets its name with `name = value` alone"),
        (&["return", "yield"], "the value of a block is its last line; leave the word out"),
        (&["while", "loop"], "there is no loop without an end: `for i in 0..<10 { ... }`"),
        (&["elif", "elseif", "elsif"], "write `else if`"),
        (
            &["include", "from", "require"],
            "another file is taken in with `use \"file.kata\" as name`",
        ),
        (&["echo", "print"], "values are shown by `katachi check`; `assert` checks them"),
        (&["class", "struct", "type", "enum"], "a record is written `{ a = 1, b = 2 }`"),
    ];
    let at = fault.at.checked_sub(1)?;
    if context.kind(at) != Some(Token::Name) || context.kind(fault.at).is_none() {
        return None;
    }
    let word = context.word(at);
    let (_, help) = WORDS.iter().find(|(words, _)| words.contains(&word))?;
    let message = format!("`{word}` is not a word of this language");
    Some(error(message, context.span(at), "found here").help(*help))
}

/// `for (i = [0:5])`.
fn foreign_loop(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    if context.before(fault.at) != Some(Token::For) || context.kind(fault.at) != Some(Token::LParen)
    {
        return None;
    }
    let diagnostic =
        error("`for` takes a name here, not `(`", context.span(fault.at), "found here");
    Some(diagnostic.help("write `for i in 0..5 { ... }`; the result is a list"))
}

/// `use parts`, `export clip = clip`.
fn unquoted(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    let word = context.before(fault.at)?;
    let what = match word {
        Token::Use => "a path",
        Token::Export => "a file name",
        Token::Group | Token::Test => "a title",
        _ => return None,
    };
    let name = context.kind(fault.at).is_some_and(|token| TokenSet::NAMES.has(token));
    let word = context.word(fault.at - 1);
    let found = context.word(fault.at);
    name.then(|| {
        let message = format!("`{word}` needs {what} in quotes");
        error(message, context.span(fault.at), "a string is needed here")
            .help(format!("write `{word} \"{found}\"`"))
    })
}

/// `(a, b)` where no `=>` follows.
fn several_in_parentheses(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    let comma = context.kind(fault.at) == Some(Token::Comma);
    let opener = context.opener(fault.at).filter(|at| context.kind(*at) == Some(Token::LParen))?;
    let one = fault.expected.has(Token::RParen) && !fault.expected.has(Token::Comma);
    let assert = context.before(opener) == Some(Token::Assert);
    (comma && one).then(|| {
        let diagnostic = error("parentheses hold one expression", context.span(fault.at), "");
        diagnostic.label(context.span(opener), "opened here").help(if assert {
            "write `assert condition, \"message\"` without parentheses"
        } else {
            "a list is written `[a, b]`"
        })
    })
}

/// `5 mm`.
fn spaced_unit(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    let unit = UNITS.iter().find(|(name, _)| *name == context.word(fault.at))?.0;
    let starts_statement = context.kind(fault.at + 1) == Some(Token::Assign);
    if context.before(fault.at) != Some(Token::Number) || starts_statement {
        return None;
    }
    let gap = Span { end: context.span(fault.at).start, ..context.behind(fault.at) };
    let place = context.span(fault.at);
    let diagnostic = error(format!("the unit `{unit}` is apart from its number"), place, "");
    Some(diagnostic.help("a unit stands directly behind the number").fix(gap, ""))
}

/// `if a = 1 {`, `a += 1`, `f(x) = 2`.
fn assignment(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    const CONDITIONS: TokenSet = TokenSet::of(&[Token::If, Token::Assert, Token::And, Token::Or]);
    const ARITHMETIC: TokenSet =
        TokenSet::of(&[Token::Plus, Token::Minus, Token::Star, Token::Slash, Token::Percent]);
    if context.kind(fault.at) != Some(Token::Assign) {
        return None;
    }
    let place = context.span(fault.at);
    if context.before(fault.at).is_some_and(|token| ARITHMETIC.has(token)) {
        let diagnostic = error("a name keeps its value", place, "cannot change one");
        return Some(diagnostic.help("give the new value a new name; sum a list with `sum`"));
    }
    if context.nearest(fault.at, CONDITIONS).is_some() {
        let diagnostic = error("`=` gives a name to a value", place, "`==` is needed here");
        return Some(diagnostic.help("to compare, write `==`").fix(place, "=="));
    }
    let diagnostic = error("`=` needs a single name before it", place, "found here");
    Some(diagnostic.help("a function is written `fn name(a) = value`; to compare, write `==`"))
}

/// `a < b < c`.
fn chained_comparison(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    let found = context.kind(fault.at).filter(|token| TokenSet::COMPARISONS.has(*token))?;
    let first = context.nearest(fault.at, TokenSet::COMPARISONS)?;
    if fault.expected.has(found) {
        return None;
    }
    let diagnostic = error("comparisons do not chain", context.span(fault.at), "the second one");
    let help = "write `a < b and b < c`";
    Some(diagnostic.label(context.span(first), "the first one").help(help))
}

/// `[0:5]`, `{ a: 1 }`, `a ? b : c`.
fn colon(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    if context.kind(fault.at) != Some(Token::Colon) {
        return None;
    }
    let place = context.span(fault.at);
    let inside = context.opener(fault.at).and_then(|at| context.kind(at));
    let (help, instead) = match inside {
        Some(Token::LBracket) => ("a range is written `0..5`, with a step `0..5 step 2`", None),
        Some(Token::LBrace | Token::LParen) => ("a value gets its name with `=`", Some("=")),
        _ => ("a value gets its name with `name = value`", None),
    };
    let diagnostic = error("`:` has no place here", place, "found here").help(help);
    Some(match instead {
        Some(instead) => diagnostic.fix(place, instead),
        None => diagnostic,
    })
}

/// `x -> x + 1`.
fn thin_arrow(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    let place = context.span(fault.at);
    (context.kind(fault.at) == Some(Token::Arrow)).then(|| {
        let diagnostic =
            error("`->` only stands before the type of a function's result", place, "");
        diagnostic.help("a function without a name is written `x => x + 1`").fix(place, "=>")
    })
}

/// The name before the call that ends before `at`: `f` of `f(1, 2)`.
fn callee<'s>(context: &Context<'s>, at: usize) -> Option<(usize, &'s str)> {
    let closing = at.checked_sub(1)?;
    if context.kind(closing) != Some(Token::RParen) {
        return None;
    }
    let name = context.opener(closing)?.checked_sub(1)?;
    (context.kind(name) == Some(Token::Name)).then(|| (name, context.word(name)))
}

/// `difference() { a b }`.
fn children(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    if context.kind(fault.at) != Some(Token::LBrace) {
        return None;
    }
    let (at, name) = callee(context, fault.at)?;
    let help = match name {
        "difference" => "write `a - b`, or `difference(a, [b, c])`".to_string(),
        "union" => "write `a + b`, or `union([a, b])`".to_string(),
        "intersection" => "write `a & b`, or `intersection([a, b])`".to_string(),
        "hull" => "write `hull([a, b])`".to_string(),
        "linear_extrude" => "write `profile.extrude(height)`".to_string(),
        "rotate_extrude" => "write `profile.revolve()`".to_string(),
        "translate" => "write `shape.move([x, y, z])`".to_string(),
        "module" | "function" => "a function is written `fn name(a) = value`".to_string(),
        _ => format!("shapes are arguments: `{name}([a, b])`, or `shape.{name}(...)`"),
    };
    let diagnostic =
        error("a call takes no shapes in braces", context.span(fault.at), "found here");
    Some(diagnostic.label(context.span(at), "this call").help(help))
}

/// `translate([1, 2, 3]) cube(5)`.
fn prefixed_verb(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    const VERBS: &[(&str, &str)] = &[
        ("translate", "move"),
        ("rotate", "rotate"),
        ("scale", "scale"),
        ("mirror", "mirror"),
        ("color", "color"),
        ("multmatrix", "transform"),
        ("offset", "offset"),
        ("linear_extrude", "extrude"),
        ("rotate_extrude", "revolve"),
    ];
    let found = context.kind(fault.at)?;
    if !TokenSet::NAMES.has(found) {
        return None;
    }
    let (at, name) = callee(context, fault.at)?;
    let (_, verb) = VERBS.iter().find(|(word, _)| *word == name)?;
    let message = format!("`{name}` stands before its shape");
    let diagnostic = error(message, context.span(fault.at), "the shape");
    let help = format!("verbs go after the thing: `shape.{verb}(...)`");
    Some(diagnostic.label(context.span(at), "the verb").help(help))
}

/// `in = 5`, `fn for(x)`.
fn reserved_word(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    let found = context.kind(fault.at)?;
    let name_needed = fault.expected.has(Token::Name);
    if !name_needed || !TokenSet::RESERVED.has(found) {
        return None;
    }
    let word = context.word(fault.at);
    let place = context.span(fault.at);
    let message = format!("`{word}` is a reserved word");
    let only_name = !fault.expected.has(Token::Number);
    let named = context.kind(fault.at + 1) == Some(Token::Assign);
    (only_name || named).then(|| {
        error(message, place, "a name is needed here")
            .help(format!("choose another name, such as `{word}_`"))
    })
}

/// `f(a b)`, `[1 2]`.
fn missing_comma(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    let found = context.kind(fault.at)?;
    if !fault.expected.has(Token::Comma) || !TokenSet::STARTS.has(found) {
        return None;
    }
    let brackets = TokenSet::of(&[Token::RParen, Token::RBracket, Token::RBrace]);
    if brackets.without(fault.expected) == brackets {
        return None;
    }
    let place = context.behind(fault.at);
    let diagnostic = error("a `,` is missing", context.span(fault.at), "`,` is needed before this");
    Some(diagnostic.fix(place, ","))
}

/// A `{` that begins the next line.
fn brace_on_next_line(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    let ended = context.kind(fault.at) == Some(Token::Newline);
    let brace = context.kind(fault.at + 1) == Some(Token::LBrace);
    let needed = fault.expected.has(Token::LBrace);
    (ended && brace && needed).then(|| {
        error("a line end stands before `{`", context.span(fault.at), "the line ends here")
            .help("put `{` at the end of this line")
    })
}

/// `x = 1 +` at the end of a line or before a closing bracket.
fn missing_operand(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    const ENDS: TokenSet = TokenSet::CLOSERS.or(TokenSet::of(&[Token::Newline, Token::Comma]));
    const BEFORE: TokenSet = TokenSet::OPERATORS.or(TokenSet::of(&[
        Token::Assign,
        Token::FatArrow,
        Token::Not,
        Token::In,
        Token::Step,
        Token::When,
    ]));
    let ended = context.kind(fault.at).is_none_or(|token| ENDS.has(token));
    let open = context.before(fault.at).is_some_and(|token| BEFORE.has(token));
    if !ended || !open || !fault.expected.has(Token::Number) {
        return None;
    }
    let word = context.word(fault.at - 1);
    let place = context.span(fault.at - 1);
    Some(error(format!("nothing follows `{word}`"), place, "an expression is needed behind this"))
}

/// `"{}"`.
fn empty_interpolation(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    let empty = context.kind(fault.at) == Some(Token::HoleClose)
        && context.before(fault.at) == Some(Token::HoleOpen);
    empty.then(|| {
        error("this interpolation is empty", context.span(fault.at), "an expression is needed here")
            .help("for braces in the text write `{{` and `}}`")
    })
}

/// `x = * 2`, and a line that starts with `+b`.
fn stray_operator(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    let found = context.kind(fault.at)?;
    if !TokenSet::OPERATORS.has(found) || !fault.expected.has(Token::Number) {
        return None;
    }
    let word = context.word(fault.at);
    let place = context.span(fault.at);
    let diagnostic = error(format!("nothing stands before `{word}`"), place, "found here");
    let starts_line = context.before(fault.at).is_none_or(|token| token == Token::Newline);
    let twice = context.before(fault.at).is_some_and(|token| TokenSet::OPERATORS.has(token));
    Some(if starts_line {
        diagnostic.help(format!("to go on from the line before, put a space behind `{word}`"))
    } else if twice {
        diagnostic.help("two operators stand side by side; leave one out")
    } else {
        diagnostic.help("an expression is needed first")
    })
}

/// `a = 1 b = 2`.
fn two_statements(context: &Context<'_>, fault: &Fault) -> Option<Diagnostic> {
    const STARTS: TokenSet = TokenSet::STARTS.or(TokenSet::of(&[Token::Fn]));
    let found = context.kind(fault.at)?;
    if !fault.expected.has(Token::Newline) || !STARTS.has(found) {
        return None;
    }
    let diagnostic = error(
        "two statements stand on one line",
        context.span(fault.at),
        "the second one begins here",
    );
    Some(diagnostic.help("put it on a line of its own, or an operator before it"))
}
