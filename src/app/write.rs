//! Files are written whole or not at all: to a temporary file beside the target, then renamed. One that holds the
//! same already only gets the date of now: file systems see to it that what takes the place of another file is on the
//! disk, which takes longer than to look.

use std::{
    fs::{self, File},
    io::{self, Read, Write},
    path::{Component, Path, PathBuf},
    time::SystemTime,
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
    if !is_renewed(&path, bytes).unwrap_or(false) {
        replace(parent, &path, bytes).map_err(words)?;
    }
    Ok(path)
}

/// Whether a file holds these bytes already, and has the date of now.
#[expect(clippy::disallowed_methods, reason = "the date of a file that would have been written")]
fn is_renewed(path: &Path, bytes: &[u8]) -> io::Result<bool> {
    let found = fs::symlink_metadata(path)?;
    if !found.is_file() || found.len() != bytes.len() as u64 {
        return Ok(false);
    }
    let mut file = File::open(path)?;
    let mut piece = vec![0; bytes.len().min(PIECE)];
    for expected in bytes.chunks(PIECE) {
        let read = &mut piece[..expected.len()];
        file.read_exact(read)?;
        if read != expected {
            return Ok(false);
        }
    }
    file.set_modified(SystemTime::now())?;
    Ok(true)
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
    fn what_has_not_changed_gets_a_new_date() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let write =
            |text: &str| write_whole(folder.path(), "a.stl", text.as_bytes()).expect("writes");
        let path = write("one");
        let other = folder.path().join("other.stl");
        fs::hard_link(&path, &other).expect("a second name");
        let old = SystemTime::UNIX_EPOCH;
        File::open(&path).and_then(|file| file.set_modified(old)).expect("an old date");
        let date = |path: &Path| fs::metadata(path).and_then(|m| m.modified()).expect("a date");
        write("one");
        assert!(date(&path) > old && date(&other) > old); // the same file
        write("two");
        assert_eq!(fs::read(&path).expect("readable"), b"two");
        assert_eq!(fs::read(&other).expect("readable"), b"one");
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
