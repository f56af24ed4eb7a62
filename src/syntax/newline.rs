//! Which line ends are the end of a statement.
//!
//! A line end counts unless the innermost open bracket is `( )` or `[ ]`, or the line ends in an
//! operator, `=`, `,`, `.`, `=>` or `..`, or the next line starts with `.`, `else`, `and`, `or`, or
//! with `step`, `when`, `in` or `with` that no `=` follows, or with an infix operator followed by a
//! space. It does not count at the start and end of a file, behind `{` and before `}` either.
//!
//! A line that ends too early (`x = 3 +`) does not swallow a statement that plainly begins below it.

use super::token::{Token, TokenSet, Tokens};

/// A line that ends in one of these goes on.
const OPEN_ENDED: TokenSet = TokenSet::OPERATORS.or(TokenSet::of(&[
    Token::Assign,
    Token::Comma,
    Token::Dot,
    Token::FatArrow,
    Token::Not,
]));

/// A line that starts with one of these goes on from the line before.
const CONTINUING: TokenSet = TokenSet::of(&[Token::Dot, Token::Else, Token::And, Token::Or]);

/// Words that begin an item when a name or string follows.
const ITEM_WORDS: TokenSet = TokenSet::ITEMS.or(TokenSet::of(&[Token::Assert, Token::Fn]));

/// So does one that starts with one of these, if no `=` follows.
const CONTINUING_WORDS: TokenSet =
    TokenSet::of(&[Token::Step, Token::When, Token::In, Token::With]);

/// Drops the line ends that end no statement, and `///` lines that stand before no item: inside
/// brackets, where they are plain comments, and at the end of the file.
pub fn newlines(text: &str, mut tokens: Tokens) -> Tokens {
    let mut open: Vec<Token> = vec![];
    // What is kept moves up to the front; what is looked ahead at lies behind it.
    let mut kept = 0_usize;
    for index in 0..tokens.len() {
        let kind = tokens.kinds[index];
        let before = || kept.checked_sub(1).map(|last| tokens.kinds[last]);
        match kind {
            Token::Newline if !ends_statement(text, &tokens, index, open.last(), before()) => {
                continue;
            }
            Token::Doc if !open.is_empty() => continue,
            Token::LParen
            | Token::LambdaParen
            | Token::LBracket
            | Token::LBrace
            | Token::HoleOpen => open.push(kind),
            Token::RParen | Token::RBracket | Token::RBrace | Token::HoleClose => {
                open.pop();
                // A line end before a closing bracket does not count.
                kept -= usize::from(before() == Some(Token::Newline));
            }
            _ => {}
        }
        if kept < index {
            tokens.kinds[kept] = kind;
            tokens.spans[kept] = tokens.spans[index];
        }
        kept += 1;
    }
    let tail = tokens.kinds[..kept].iter().rev();
    kept -= tail.take_while(|kind| matches!(kind, Token::Newline | Token::Doc)).count();
    tokens.truncate(kept);
    tokens
}

fn ends_statement(
    text: &str,
    tokens: &Tokens,
    index: usize,
    innermost: Option<&Token>,
    before: Option<Token>,
) -> bool {
    let Some(before) = before else { return false };
    if innermost.is_some_and(|open| *open != Token::LBrace) {
        return false;
    }
    if matches!(before, Token::LBrace | Token::Newline) {
        return false;
    }
    if OPEN_ENDED.has(before) {
        return before != Token::Comma && begins_statement(tokens, index + 1);
    }
    !continues(text, tokens, index + 1)
}

/// Whether the line that starts with this token goes on from the line before.
fn continues(text: &str, tokens: &Tokens, index: usize) -> bool {
    let Some(kind) = tokens.get(index) else { return false };
    if CONTINUING.has(kind) {
        return true;
    }
    if CONTINUING_WORDS.has(kind) {
        return tokens.get(index + 1) != Some(Token::Assign);
    }
    TokenSet::OPERATORS.has(kind) && space_follows(text, tokens.spans[index].1)
}

/// Whether what starts with this token can be nothing but a statement of its own.
fn begins_statement(tokens: &Tokens, index: usize) -> bool {
    let (Some(first), Some(second)) = (tokens.get(index), tokens.get(index + 1)) else {
        return false;
    };
    let binding = TokenSet::NAMES.has(first) && second == Token::Assign;
    let word = TokenSet::NAMES.has(second) && !CONTINUING_WORDS.has(second);
    binding || ITEM_WORDS.has(first) && (word || second == Token::StringStart)
}

fn space_follows(text: &str, at: u32) -> bool {
    let rest = &text[at as usize..];
    rest.starts_with(char::is_whitespace) || rest.starts_with("//") || rest.starts_with("/*")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{base::SourceId, syntax::lexer::lex};

    /// How many statements the lines are.
    fn statements(text: &str) -> usize {
        let tokens = newlines(text, lex(SourceId(0), text).tokens);
        let mut depth = 0;
        let mut ends = 0;
        for kind in &tokens.kinds {
            depth += i32::from(TokenSet::OPENERS.has(*kind));
            depth -= i32::from(TokenSet::CLOSERS.has(*kind));
            ends += usize::from(*kind == Token::Newline && depth == 0);
        }
        ends + usize::from(!tokens.is_empty())
    }

    #[test]
    fn a_line_end_ends_a_statement() {
        for (text, count) in [
            ("", 0),
            ("\n\n", 0),
            ("// only a comment\n", 0),
            ("a = 1\nb = 2", 2),
            ("\n\na = 1\n\n\r\n// c\nb = 2\n\n", 2),
            ("a\n-b", 2),
            ("a\n+b", 2),
            ("a\n[0]", 2),
            ("a\n(b)", 2),
            ("a\n..b", 2),
            ("a\nstep = 1", 2),
            ("a\nwhen = 1", 2),
            ("a\nwith = 1", 2),
            ("a\nstepped", 2),
            ("a\norder", 2),
            ("a\nnot b", 2),
            ("a\nif b { 1 }", 2),
            ("/// doc\na = 1\n/// at the end", 2),
        ] {
            assert_eq!(statements(text), count, "{text:?}");
        }
    }

    #[test]
    fn a_line_that_ends_too_early_swallows_no_statement() {
        for text in [
            "a = 1 +\nb = 2",
            "a =\nb = 2",
            "a =\n\n// c\npart b = 2",
            "a = b.\nparam c = 2",
            "a = x =>\nfn f() = 1",
            "a = 1 *\nassert b",
            "a = 1 *\nexport \"a.stl\" = b",
        ] {
            assert_eq!(statements(text), 2, "{text:?}");
        }
        for text in ["a = 1 +\nb == 2", "a = 0 ..\npart step 2", "a = 1 +\nview(b)", "a,\nb = 2"] {
            assert_eq!(statements(text), 1, "{text:?}");
        }
    }

    #[test]
    fn a_line_end_goes_on() {
        for text in [
            "f(1,\n2\n)",
            "[1\n, 2\n]",
            "a = {\n b = 1\n}",
            "a =\n1",
            "a +\nb",
            "a -\n\n// c\nb",
            "a *\nb",
            "a /\nb",
            "a %\nb",
            "a &\nb",
            "a ^\nb",
            "a ++\nb",
            "a ==\nb",
            "a !=\nb",
            "a <\nb",
            "a <=\nb",
            "a >\nb",
            "a >=\nb",
            "a ..\nb",
            "a ..<\nb",
            "a and\nb",
            "a or\nb",
            "a = not\nb",
            "a, \nb",
            "a.\nb",
            "x =>\nx",
            "a\n.b",
            "a\n\n// c\n  .b",
            "if a { 1 }\nelse { 2 }",
            "a\nand b",
            "a\nor b",
            "a\nstep 1",
            "a\nwhen b",
            "a\nin b",
            "a\nwith { b }",
            "a\n+ b",
            "a\n- b",
            "a\n- /* c */ b",
            "a\n* b",
            "a\n/ b",
            "a\n% b",
            "a\n& b",
            "a\n^ b",
            "a\n++ b",
            "a\n== b",
            "a\n< b",
            "a\n.. b",
        ] {
            assert_eq!(statements(text), 1, "{text:?}");
        }
    }

    #[test]
    fn the_innermost_bracket_decides() {
        let ends = |text: &str| {
            let tokens = newlines(text, lex(SourceId(0), text).tokens);
            tokens.kinds.iter().filter(|kind| **kind == Token::Newline).count()
        };
        assert_eq!(ends("f(do {\n a\n b\n})"), 1);
        assert_eq!(ends("{ f(\na\n) }"), 0);
        assert_eq!(ends("[{\na = 1\nb = [1,\n2]\n}\n]"), 1);
        assert_eq!(ends("do {\n\n a\n\n /// plain here\n b\n\n}"), 1);
    }
}
