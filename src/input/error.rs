//! Why a file cannot be read.

use std::fmt;

use crate::geom::flatten::MOST_CHORDS;

/// What was found in a file, what is needed there, and where.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum ReadError {
    /// The name of the file says nothing about its format.
    #[error("\"{name}\" is in no known format; files that end in {known} can be read")]
    Extension {
        /// The name of the file.
        name: String,
        /// The endings that are known.
        known: &'static str,
    },
    /// The file breaks the rules of its format.
    #[error("{format}{place}: {found}; {needed}")]
    Content {
        /// The format.
        format: &'static str,
        /// Where.
        place: Place,
        /// What was found.
        found: String,
        /// What is needed.
        needed: String,
    },
    /// The file is larger than what is read.
    #[error("{format}: {what} is beyond the limit of {limit}")]
    Limit {
        /// The format.
        format: &'static str,
        /// What is too much.
        what: String,
        /// The limit, with its unit.
        limit: String,
    },
}

/// A place in a file.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A byte, counted from 0.
    Byte(usize),
    /// A line, counted from 1.
    Line(usize),
    /// A triangle, counted from 0.
    Triangle(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::File => Ok(()),
            Place::Byte(byte) => write!(f, " byte {byte}"),
            Place::Line(line) => write!(f, " line {line}"),
            Place::Triangle(triangle) => write!(f, " triangle {triangle}"),
        }
    }
}

/// Makes the errors of one format.
#[derive(Clone, Copy, Debug)]
pub(super) struct Format(pub &'static str);

impl Format {
    /// A broken rule.
    pub fn error(
        self,
        place: Place,
        found: impl Into<String>,
        needed: impl Into<String>,
    ) -> ReadError {
        ReadError::Content { format: self.0, place, found: found.into(), needed: needed.into() }
    }

    /// A curve that the tolerance asks for more chords of than are drawn.
    pub fn chords(self, what: &str, needed: u32) -> Result<(), ReadError> {
        if needed <= MOST_CHORDS {
            return Ok(());
        }
        let what = format!("{what} of {needed} chords at this tolerance");
        Err(self.limit(what, format!("{MOST_CHORDS} chords")))
    }

    /// Something too large.
    pub fn limit(self, what: impl Into<String>, limit: impl Into<String>) -> ReadError {
        ReadError::Limit { format: self.0, what: what.into(), limit: limit.into() }
    }

    /// The bytes as text.
    pub fn text(self, bytes: &[u8]) -> Result<&str, ReadError> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        std::str::from_utf8(bytes).map_err(|error| {
            self.error(
                Place::Byte(error.valid_up_to()),
                "bytes that are no text",
                "UTF-8 is needed",
            )
        })
    }

    /// A finite coordinate.
    pub fn number(self, word: &str, place: Place) -> Result<f64, ReadError> {
        let value = word.parse::<f64>().ok().filter(|v| v.abs() <= MOST_COORDINATE);
        value.ok_or_else(|| {
            self.error(place, format!("\"{}\"", shortened(word)), "a finite number is needed")
        })
    }
}

/// The largest coordinate read, in units of the file.
pub(super) const MOST_COORDINATE: f64 = 1e12;

/// At most 40 characters of what was found.
pub(super) fn shortened(word: &str) -> String {
    const MOST: usize = 40;
    if word.chars().count() <= MOST {
        return word.to_string();
    }
    word.chars().take(MOST).chain("...".chars()).collect()
}
