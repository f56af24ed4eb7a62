//! The characters of strings and comments.

use std::ops::Range;

/// A run of string characters up to the quote, the interpolation or the line end behind it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Run {
    /// Its length in bytes.
    pub length: usize,
    /// Escapes and braces in it that mean nothing.
    pub faults: Vec<Range<usize>>,
}

/// Measures the run of string characters at the start of `text`.
pub fn run(text: &str) -> Run {
    let bytes = text.as_bytes();
    let (mut at, mut faults) = (0, vec![]);
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'"' | b'\n' | b'\r' => break,
            b'{' if bytes.get(at + 1) != Some(&b'{') => break,
            b'{' => at += 2,
            b'}' if bytes.get(at + 1) == Some(&b'}') => at += 2,
            b'}' => {
                faults.push(at..at + 1);
                at += 1;
            }
            b'\\' => {
                let (length, character) = escape(&text[at..]);
                if character.is_none() {
                    faults.push(at..at + length);
                }
                at += length;
            }
            _ => at += 1,
        }
    }
    Run { length: at, faults }
}

/// Length and meaning of the escape at the start of `text`, which begins with `\`.
fn escape(text: &str) -> (usize, Option<char>) {
    let Some(letter) = text[1..].chars().next() else { return (1, None) };
    match letter {
        'n' => (2, Some('\n')),
        't' => (2, Some('\t')),
        '"' => (2, Some('"')),
        '\\' => (2, Some('\\')),
        'u' => unicode_escape(text),
        '\n' | '\r' => (1, None),
        other => (1 + other.len_utf8(), None),
    }
}

/// `\u{1F600}`: one to six hexadecimal digits.
fn unicode_escape(text: &str) -> (usize, Option<char>) {
    let Some(rest) = text.strip_prefix("\\u{") else { return (2, None) };
    let count = rest.bytes().take_while(u8::is_ascii_hexdigit).count();
    if rest.as_bytes().get(count) != Some(&b'}') {
        return (3 + count, None);
    }
    let digits = rest.get(..count.min(7)).unwrap_or("");
    let value = u32::from_str_radix(digits, 16).ok();
    (4 + count, value.and_then(char::from_u32))
}

/// The characters that a run of [`run`] stands for; what means nothing is left out.
pub fn unescape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(['\\', '{', '}']) {
        out.push_str(&rest[..at]);
        rest = &rest[at..];
        let length = match rest.as_bytes()[0] {
            b'\\' => {
                let (length, character) = escape(rest);
                out.extend(character);
                length
            }
            _ if rest.starts_with("{{") => {
                out.push('{');
                2
            }
            _ if rest.starts_with("}}") => {
                out.push('}');
                2
            }
            _ => 1,
        };
        rest = &rest[length..];
    }
    out.push_str(rest);
    out
}

/// Length of a block comment behind its `/*`, up to and with its `*/`; `None` if it never ends.
pub fn block_comment_length(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (1_usize, 0);
    while at + 1 < bytes.len() {
        match (bytes[at], bytes[at + 1]) {
            (b'*', b'/') => {
                depth -= 1;
                at += 2;
                if depth == 0 {
                    return Some(at);
                }
            }
            (b'/', b'*') => {
                depth += 1;
                at += 2;
            }
            _ => at += 1,
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_end_at_quotes_holes_and_line_ends() {
        assert_eq!(run("abc\" + 1").length, 3);
        assert_eq!(run("M{d}\"").length, 1);
        assert_eq!(run("a{{b}}c\"").length, 7);
        assert_eq!(run("a\\\"b\"").length, 4);
        assert_eq!(run("a\nb").length, 1);
        assert_eq!(run("a}b\"").faults[0], 1..2);
        assert_eq!(run("\\q\"").faults[0], 0..2);
        assert_eq!(run("\\u{110000}\"").faults[0], 0..10);
    }

    #[test]
    fn escapes_are_resolved() {
        assert_eq!(unescape(r#"a\n\t\"\\ \u{5f62} {{x}}"#), "a\n\t\"\\ 形 {x}");
    }

    #[test]
    fn block_comments_nest() {
        assert_eq!(block_comment_length(" a /* b */ c */ d"), Some(15));
        assert_eq!(block_comment_length(" a /* b */"), None);
    }
}
