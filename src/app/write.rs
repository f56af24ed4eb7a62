//! Files are written whole or not at all: to a temporary file beside the target, then renamed.

use std::{
    fs,
    io::{self, Write},
    path::{Component, Path, PathBuf},
};

use super::{disk::refusal, interrupt};

/// Writes `bytes` to `folder/name`, making folders as needed, and returns the path. `name` uses `/`
/// and may not leave the folder. On failure no part of the file is left behind; the error is in words.
pub fn write_whole(folder: &Path, name: &str, bytes: &[u8]) -> Result<PathBuf, String> {
    if name.contains(|c: char| c.is_control() || c == '\\') {
        return Err(format!("{name:?} has a character that file names cannot have everywhere"));
    }
    let path =
        inside(folder, name).ok_or_else(|| format!("`{name}` leads outside the output folder"))?;
    let parent = path.parent().unwrap_or(folder);
    let words = |e: io::Error| format!("`{}`: {}", path.display(), refusal(&e));
    fs::create_dir_all(parent).map_err(words)?;
    let (real, root) = (fs::canonicalize(parent), fs::canonicalize(folder));
    if !real.map_err(words)?.starts_with(root.map_err(words)?) {
        return Err(format!("`{name}` leads outside the output folder by a symbolic link"));
    }
    if path.is_dir() {
        return Err(format!("`{}`: a folder stands there", path.display()));
    }
    replace(parent, &path, bytes).map_err(words)?;
    Ok(path)
}

/// So many bytes are written between two questions whether to stop.
const PIECE: usize = 1 << 20;

fn replace(parent: &Path, path: &Path, bytes: &[u8]) -> io::Result<()> {
    interrupt::writing(|is_told_to_stop| {
        let mut file = builder().tempfile_in(parent)?;
        for piece in bytes.chunks(PIECE) {
            file.write_all(piece)?;
            if is_told_to_stop() {
                return Err(io::ErrorKind::Interrupted.into());
            }
        }
        file.persist(path).map_err(|e| e.error)?;
        Ok(())
    })
}

/// Temporary files are private unless told otherwise; outputs are ordinary files.
fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".katachi-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
}

/// `folder/name` if every step of `name` goes down.
fn inside(folder: &Path, name: &str) -> Option<PathBuf> {
    let name = Path::new(name);
    let down = name.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
    (down && name.file_name().is_some()).then(|| folder.join(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("readable");
        entries.map(|e| e.expect("readable").file_name().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn folders_are_made_and_files_replaced() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for text in ["one", "two"] {
            let path = write_whole(folder.path(), "a/b.stl", text.as_bytes()).expect("writes");
            assert_eq!(fs::read(path).expect("readable"), text.as_bytes());
        }
        assert_eq!(names(&folder.path().join("a")), ["b.stl"]);
    }

    #[test]
    fn nothing_is_written_outside_or_in_part() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for name in ["../a.stl", "/a.stl", "a/../../b.stl", "", "a\\b.stl", "a\n.stl", "a\0.stl"] {
            assert!(write_whole(folder.path(), name, b"").is_err(), "{name}");
        }
        fs::create_dir(folder.path().join("taken.stl")).expect("writable");
        assert!(write_whole(folder.path(), "taken.stl", b"x").is_err());
        assert_eq!(names(folder.path()), ["taken.stl"]);
    }
}
