//! Characters that are not of the language: what to say of them, and what was probably meant.

use super::{
    number::{self, UNITS},
    token::Token,
};
use crate::base::{Code, Diagnostic, Span};

/// A sign that no token begins with.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Sign {
    /// Its length in bytes.
    pub length: usize,
    /// The token it is read as.
    pub means: Token,
    /// What to write instead, if that replaces it one for one.
    pub instead: Option<&'static str>,
    /// What to do.
    pub help: &'static str,
}

const fn sign_of(
    text: &str,
    means: Token,
    instead: Option<&'static str>,
    help: &'static str,
) -> Sign {
    Sign { length: text.len(), means, instead, help }
}

const SIGNS: &[(&str, Sign)] = &[
    ("&&", sign_of("&&", Token::And, Some("and"), "write `and`")),
    ("||", sign_of("||", Token::Or, Some("or"), "write `or`; to unite shapes, `+`")),
    ("|", sign_of("|", Token::Plus, Some("+"), "write `+` to unite shapes, `or` for conditions")),
    ("!", sign_of("!", Token::Not, Some("not "), "write `not`")),
    ("−", sign_of("−", Token::Minus, Some("-"), "this is a typographic minus; write `-`")),
    ("–", sign_of("–", Token::Minus, Some("-"), "this is a dash; write `-`")),
    ("×", sign_of("×", Token::Star, Some("*"), "write `*`")),
    ("·", sign_of("·", Token::Star, Some("*"), "write `*`")),
    ("÷", sign_of("÷", Token::Slash, Some("/"), "write `/`")),
    ("≤", sign_of("≤", Token::LessEqual, Some("<="), "write `<=`")),
    ("≥", sign_of("≥", Token::GreaterEqual, Some(">="), "write `>=`")),
    ("≠", sign_of("≠", Token::NotEqual, Some("!="), "write `!=`")),
    ("?", sign_of("?", Token::Bad, None, "write `if condition { a } else { b }`")),
    (
        "$",
        sign_of(
            "$",
            Token::Bad,
            None,
            "there are no special variables; `sides = n` asks for a polygon, `set tolerance = 0.05mm` for a finer mesh",
        ),
    ),
    ("#", sign_of("#", Token::Bad, None, "comments begin with `//`")),
    ("'", sign_of("'", Token::Bad, None, "strings stand in double quotes: `\"text\"`")),
    ("“", sign_of("“", Token::Bad, None, "this is a typographic quote; write `\"`")),
    ("”", sign_of("”", Token::Bad, None, "this is a typographic quote; write `\"`")),
    ("‘", sign_of("‘", Token::Bad, None, "strings stand in double quotes: `\"text\"`")),
    ("’", sign_of("’", Token::Bad, None, "strings stand in double quotes: `\"text\"`")),
];

/// The foreign sign at the start of `text`, which is not empty.
pub fn sign(text: &str) -> Sign {
    let known = SIGNS.iter().find(|(name, _)| text.starts_with(name));
    if let Some((name, sign)) = known {
        let quoted = matches!(*name, "'" | "“" | "‘");
        return if quoted { Sign { length: quoted_length(text), ..*sign } } else { *sign };
    }
    let length = text.chars().next().map_or(1, char::len_utf8);
    Sign { length, means: Token::Bad, instead: None, help: "" }
}

/// How many characters a string in foreign quotes may have to be taken as a whole.
const FAR: usize = 200;

/// A string in foreign quotes, if it ends on its line; else the quote alone.
fn quoted_length(text: &str) -> usize {
    let line = text.char_indices().take_while(|(_, c)| *c != '\n').take(FAR);
    let first = text.chars().next().map_or(1, char::len_utf8);
    let mut rest = line.skip(1);
    let closing = rest.find(|(_, c)| matches!(c, '\'' | '”' | '’' | '"' | '“' | '‘'));
    closing.map_or(first, |(at, c)| at + c.len_utf8())
}

/// What to say of a foreign sign.
pub fn diagnostic(text: &str, sign: &Sign, place: Span) -> Diagnostic {
    let shown: String = text[..sign.length].chars().take(20).collect();
    let message = match shown.chars().next() {
        Some(c) if c.is_control() => format!("the character U+{:04X} has no place here", c as u32),
        _ => format!("`{shown}` is not part of the language"),
    };
    let mut diagnostic = Diagnostic::error(Code::BadToken, message).label(place, "");
    if !sign.help.is_empty() {
        diagnostic = diagnostic.help(sign.help);
    }
    match sign.instead {
        Some(instead) => diagnostic.fix(place, instead),
        None => diagnostic,
    }
}

/// What to say of letters behind a number that are no unit.
pub fn unknown_unit(word: &str, place: Span) -> Diagnostic {
    let names: Vec<&str> = UNITS.iter().map(|(name, _)| *name).collect();
    let note = format!("the units are {}", names.join(" "));
    let diagnostic = Diagnostic::error(Code::BadToken, format!("there is no unit `{word}`"))
        .label(place, "not a unit")
        .note(note);
    match number::nearest_unit(word) {
        Some(unit) => diagnostic.help(format!("did you mean `{unit}`?")).fix(place, unit),
        None => diagnostic.help("put a space and an operator between a number and a name"),
    }
}

/// What to say of an escape or a brace in a string that means nothing.
pub fn bad_escape(text: &str, place: Span) -> Diagnostic {
    if text.starts_with('}') {
        return Diagnostic::error(Code::BadToken, "a `}` alone stands in this string")
            .label(place, "closes nothing")
            .help("write `}}` for a brace")
            .fix(place, "}}");
    }
    let shown = &text[..place.len() as usize];
    Diagnostic::error(Code::BadToken, format!("`{shown}` is not an escape"))
        .label(place, "unknown escape")
        .help(r#"the escapes are \n \t \" \\ and \u{hexadecimal}; write `\\` for a backslash"#)
}
