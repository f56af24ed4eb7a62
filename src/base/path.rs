//! Paths as a model writes them: relative to the file they stand in, never above the project root.

use super::world::FileError;

/// Resolves `path`, written in the file `from` (itself relative to the root), to a path relative to
/// the root. `std/...` is the library's and passes unchanged. Fails with
/// [`FileError::OutsideRoot`] for absolute paths and for paths that climb above the root; no file
/// is looked at.
///
/// ```
/// use katachi::base::path::resolve;
/// assert_eq!(resolve("models/lid.kata", "../parts/./hinge.kata").unwrap(), "parts/hinge.kata");
/// assert_eq!(resolve("models/lid.kata", "std/metric").unwrap(), "std/metric");
/// assert!(resolve("lid.kata", "../secret").is_err());
/// assert!(resolve("lid.kata", "/etc/passwd").is_err());
/// ```
pub fn resolve(from: &str, path: &str) -> Result<String, FileError> {
    if path.starts_with("std/") && !path.split('/').any(|part| part == "..") {
        return Ok(path.to_string());
    }
    if is_absolute(path) {
        return Err(FileError::OutsideRoot);
    }
    let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in path.split(['/', '\\']) {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop().ok_or(FileError::OutsideRoot)?;
            }
            name => parts.push(name),
        }
    }
    Ok(parts.join("/"))
}

fn is_absolute(path: &str) -> bool {
    let drive = path.as_bytes().get(1) == Some(&b':');
    path.starts_with(['/', '\\']) || drive || path.contains('\0')
}
