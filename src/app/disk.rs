//! The world of real files: everything under one root folder, and standard input.

use std::{
    fs::{self, File},
    io::{self, Read},
    path::{Path, PathBuf},
};

use crate::base::{FileError, World};

/// Files larger than this are refused: 1 GiB, five times the largest mesh that is tested.
pub const LARGEST_FILE: u64 = 1 << 30;

/// The file whose presence makes a folder a project's root.
pub const ROOT_MARK: &str = "katachi.toml";

/// The name under which standard input is read and shown.
pub const STDIN: &str = "<stdin>";

/// The name of a model that only imports a mesh.
const IMPORT: &str = "<import>";

/// Files under a root folder. Symbolic links may not lead out of it.
#[derive(Debug)]
pub struct Disk {
    root: PathBuf,
    /// A file that is not on the disk: its name and bytes.
    held: Option<(&'static str, Vec<u8>)>,
}

impl Disk {
    /// The world of a command and the entry's path within it. `file` is a path, or `-` for standard
    /// input, which is read here. The root is `root` if given, else the nearest folder upwards with a
    /// `katachi.toml`, else the entry's own folder. Fails, with the words for the user, where a folder
    /// cannot be found or the entry lies outside the given root.
    pub fn open(file: &str, root: Option<&Path>) -> Result<(Disk, String), String> {
        if file == "-" {
            let root = canonical(root.unwrap_or(Path::new(".")))?;
            let stdin =
                limited(io::stdin().lock(), 0).map_err(|e| format!("standard input: {e}"))?;
            return Ok((Disk { root, held: Some((STDIN, stdin)) }, STDIN.to_string()));
        }
        let path = Path::new(file);
        let name = path.file_name().ok_or_else(|| format!("`{file}` does not name a file"))?;
        let parent = path.parent().filter(|p| !p.as_os_str().is_empty());
        let folder = canonical(parent.unwrap_or(Path::new(".")))?;
        let root = match root {
            Some(root) => canonical(root)?,
            None => marked(&folder).unwrap_or(&folder).to_path_buf(),
        };
        let entry = folder.join(name);
        let inside = entry.strip_prefix(&root);
        let inside = inside.map_err(|_| format!("`{file}` lies outside the root given"))?;
        let entry = inside.to_string_lossy().replace('\\', "/");
        Ok((Disk { root, held: None }, entry))
    }

    /// Adds a model that imports a mesh, and returns its path.
    pub fn import(&mut self, mesh: &str) -> String {
        let quoted: String = mesh
            .chars()
            .map(|c| match c {
                '"' | '\\' => format!("\\{c}"),
                '{' | '}' => format!("{c}{c}"),
                c => c.to_string(),
            })
            .collect();
        self.held = Some((IMPORT, format!("import(\"{quoted}\")").into_bytes()));
        IMPORT.to_string()
    }

    /// The root folder, absolute and free of symbolic links.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Follows symbolic links and makes sure that they stay under the root.
    fn locate(&self, path: &str) -> Result<PathBuf, FileError> {
        if path.split('/').any(|part| part == "..") || Path::new(path).is_absolute() {
            return Err(FileError::OutsideRoot);
        }
        let found = fs::canonicalize(self.root.join(path)).map_err(|e| refusal(&e))?;
        if !found.starts_with(&self.root) {
            return Err(FileError::OutsideRoot);
        }
        Ok(found)
    }
}

impl World for Disk {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        if let Some((_, bytes)) = self.held.as_ref().filter(|(name, _)| *name == path) {
            return Ok(bytes.clone());
        }
        let found = self.locate(path)?;
        let about = fs::metadata(&found).map_err(|e| refusal(&e))?;
        if !about.is_file() {
            return Err(FileError::Other("it is not a file".to_string()));
        }
        if about.len() > LARGEST_FILE {
            return Err(FileError::TooLarge { size: about.len(), limit: LARGEST_FILE });
        }
        limited(File::open(&found).map_err(|e| refusal(&e))?, about.len() as usize)
    }
}

fn canonical(folder: &Path) -> Result<PathBuf, String> {
    fs::canonicalize(folder).map_err(|e| format!("folder `{}`: {}", folder.display(), refusal(&e)))
}

/// The nearest folder upwards that holds the mark of a root.
fn marked(folder: &Path) -> Option<&Path> {
    folder.ancestors().find(|above| above.join(ROOT_MARK).is_file())
}

/// All bytes, of which there are probably `size`.
fn limited(from: impl Read, size: usize) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::with_capacity(size);
    let read = from.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(|e| refusal(&e))?;
    if read as u64 > LARGEST_FILE {
        return Err(FileError::TooLarge { size: read as u64, limit: LARGEST_FILE });
    }
    Ok(bytes)
}

/// The system's error in plain words.
pub fn refusal(error: &io::Error) -> FileError {
    match error.kind() {
        io::ErrorKind::NotFound => FileError::NotFound,
        io::ErrorKind::PermissionDenied => FileError::Other("permission denied".to_string()),
        io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists => {
            FileError::Other("a file stands where a folder is needed".into())
        }
        _ => FileError::Other(without_number(error.to_string())),
    }
}

/// The system's words without its number for them.
fn without_number(mut words: String) -> String {
    words.truncate(words.find(" (os error").unwrap_or(words.len()));
    words.to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::create_dir(folder.path().join("parts")).expect("writable");
        fs::write(folder.path().join("parts/a.kata"), "box(1, 2, 3)").expect("writable");
        folder
    }

    #[test]
    fn the_root_is_marked_or_the_entrys_folder() {
        let folder = folder();
        let file = folder.path().join("parts/a.kata");
        let file = file.to_str().expect("plain path");
        assert_eq!(Disk::open(file, None).expect("opens").1, "a.kata");
        fs::write(folder.path().join(ROOT_MARK), "").expect("writable");
        let (disk, entry) = Disk::open(file, None).expect("opens");
        assert_eq!(entry, "parts/a.kata");
        assert_eq!(disk.read(&entry).expect("reads"), b"box(1, 2, 3)");
        assert_eq!(disk.read("parts"), Err(FileError::Other("it is not a file".to_string())));
        assert_eq!(disk.read("b.kata"), Err(FileError::NotFound));
    }

    #[cfg(unix)]
    #[test]
    fn links_may_not_lead_out() {
        let (folder, other) = (folder(), folder());
        let link = folder.path().join("parts/link.kata");
        std::os::unix::fs::symlink(other.path().join("parts/a.kata"), link).expect("writable");
        let file = folder.path().join("parts/a.kata");
        let (disk, _) = Disk::open(file.to_str().expect("plain path"), None).expect("opens");
        assert_eq!(disk.read("link.kata"), Err(FileError::OutsideRoot));
        assert_eq!(disk.read("../parts/a.kata"), Err(FileError::OutsideRoot));
    }
}
