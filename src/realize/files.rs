//! Files that shapes are made from, read once.

use std::sync::Arc;

use super::{
    Realizer,
    failure::{Made, failure},
};
use crate::base::{Code, Diagnostic, FileError};

impl Realizer<'_> {
    /// The bytes of a file. The error has no place yet.
    pub(super) fn bytes(&self, file: &str) -> Made<Arc<Vec<u8>>> {
        if let Some(bytes) = self.files.get(&file.to_string()) {
            return Ok(bytes);
        }
        let bytes = self.world.read(file).map_err(|error| failure(unreadable(file, &error)))?;
        let bytes = Arc::new(bytes);
        self.files.extend([(file.to_string(), bytes.clone())]);
        Ok(bytes)
    }

    /// The bytes of a file that is not asked for again.
    pub(super) fn last_bytes(&self, file: &str) -> Made<Arc<Vec<u8>>> {
        let bytes = self.bytes(file);
        self.files.take(&file.to_string());
        bytes
    }
}

/// The diagnostic for a file that cannot be read.
pub fn unreadable(file: &str, error: &FileError) -> Diagnostic {
    let code = match error {
        FileError::OutsideRoot => Code::OutsideRoot,
        FileError::TooLarge { .. } => Code::Limit,
        FileError::NotFound | FileError::Other(_) => Code::UnreadableFile,
    };
    Diagnostic::error(code, format!("`{file}` cannot be read: {error}"))
}
