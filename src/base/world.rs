//! The only door to files.

use std::{error::Error, fmt};

/// Reads files by their path relative to the project root (`/` between folders, no `.` or `..` left:
/// see [`path::resolve`](super::path::resolve)).
///
/// `Send + Sync`, so that kernels may run while the world is borrowed.
pub trait World: Send + Sync {
    /// The whole content of a file.
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError>;
}

/// Why a file could not be read.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum FileError {
    /// There is no such file.
    NotFound,
    /// The path leads outside the project root and the library.
    OutsideRoot,
    /// The file is larger than the limit, in bytes.
    TooLarge {
        /// Size found.
        size: u64,
        /// Size allowed.
        limit: u64,
    },
    /// Anything else, in the system's words.
    Other(String),
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FileError::NotFound => f.write_str("there is no such file"),
            FileError::OutsideRoot => f.write_str("the path leads outside the project root"),
            FileError::TooLarge { size, limit } => {
                write!(f, "the file has {size} bytes; the limit is {limit}")
            }
            FileError::Other(words) => f.write_str(words),
        }
    }
}

impl Error for FileError {}

/// A world of string literals: for tests, documentation and playgrounds.
///
/// ```
/// use katachi::base::{Shelf, World};
/// let shelf = Shelf(&[("a.kata", "box(1, 2, 3)")]);
/// assert_eq!(shelf.read("a.kata").unwrap().len(), 12);
/// assert!(shelf.read("b.kata").is_err());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Shelf<'a>(pub &'a [(&'a str, &'a str)]);

impl World for Shelf<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        let found = self.0.iter().find(|(name, _)| *name == path);
        found.map(|(_, text)| text.as_bytes().to_vec()).ok_or(FileError::NotFound)
    }
}
