//! From bytes to text.

use crate::base::{Code, Diagnostic, SourceId, Span};

/// The largest source text, in bytes: far more than anyone writes, little enough for any memory.
pub const MAX_BYTES: usize = 8 << 20;

/// The text of a source file: UTF-8, a byte order mark left out. Fails for what is not text (bytes
/// that are not UTF-8, or a zero byte) and for more than [`MAX_BYTES`].
///
/// ```
/// use katachi::{base::SourceId, syntax::decode};
/// assert_eq!(decode(SourceId(0), b"\xef\xbb\xbfw = 1").unwrap(), "w = 1");
/// assert!(decode(SourceId(0), &[0xff, 0xfe, 0x00]).is_err());
/// ```
pub fn decode(source: SourceId, bytes: &[u8]) -> Result<&str, Diagnostic> {
    if bytes.len() > MAX_BYTES {
        let message =
            format!("this file has {} bytes; a source text has at most {MAX_BYTES}", bytes.len());
        return Err(Diagnostic::error(Code::Limit, message).label(Span::new(source, 0, 0), ""));
    }
    let (bytes, mark) = match bytes.strip_prefix(b"\xef\xbb\xbf") {
        Some(rest) => (rest, 3),
        None => (bytes, 0),
    };
    let text = std::str::from_utf8(bytes).map_err(|e| e.valid_up_to());
    let zero = if bytes.contains(&0) { bytes.iter().position(|byte| *byte == 0) } else { None };
    match (text, zero) {
        (Ok(text), None) => Ok(text),
        (Err(at), zero) if zero.is_none_or(|zero| at <= zero) => {
            Err(not_text(source, bytes, at, mark))
        }
        (_, zero) => Err(binary(source, bytes, zero.unwrap_or(0), mark)),
    }
}

/// Bytes that are not UTF-8.
fn not_text(source: SourceId, bytes: &[u8], at: usize, mark: usize) -> Diagnostic {
    let found = format!("byte {} (0x{:02X}, line {})", at + mark, bytes[at], line(bytes, at));
    let utf16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
    let help = if utf16 {
        "this looks like UTF-16; save it as UTF-8"
    } else {
        "a model is plain text in UTF-8; is this the right file?"
    };
    error(source, format!("this is not a text file: {found} is not UTF-8 text"), help)
}

/// A zero byte, which is UTF-8 but stands in no text.
fn binary(source: SourceId, bytes: &[u8], at: usize, mark: usize) -> Diagnostic {
    let found = format!("a zero byte at offset {} (line {})", at + mark, line(bytes, at));
    let help = "this looks like a binary file; a model is plain text in UTF-8";
    error(source, format!("this is not a text file: {found}"), help)
}

fn line(bytes: &[u8], at: usize) -> usize {
    bytes[..at].iter().filter(|byte| **byte == b'\n').count() + 1
}

/// The label is empty: the text it would underline does not exist.
fn error(source: SourceId, message: String, help: &str) -> Diagnostic {
    Diagnostic::error(Code::NotText, message).label(Span::new(source, 0, 0), "").help(help)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_text_is_refused_with_its_place() {
        let error = |bytes: &[u8]| decode(SourceId(0), bytes).unwrap_err();
        assert_eq!(error(b"a\n\x00b").code, Code::NotText);
        assert!(error(b"a\n\x00b").message.ends_with("a zero byte at offset 2 (line 2)"));
        assert!(error(b"a\n\x00b").help.unwrap().contains("binary"));
        assert!(error(b"\x00\xff").message.ends_with("a zero byte at offset 0 (line 1)"));
        assert!(error(b"a\xffb").message.contains("byte 1 (0xFF, line 1)"));
        assert!(error(&[0xff, 0xfe, b'a', 0]).help.unwrap().contains("UTF-16"));
        assert_eq!(error(&vec![b' '; MAX_BYTES + 1]).code, Code::Limit);
        assert_eq!(decode(SourceId(0), "形".as_bytes()).unwrap(), "形");
    }
}
