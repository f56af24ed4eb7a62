//! OpenSCAD as a process.

use std::{fs, path::Path, process::Command};

/// What came of a source.
pub enum Rendered {
    /// A closed boundary, as OFF.
    Solid(Vec<u8>),
    /// The same, but OpenSCAD says that parts of it touch in edges or points.
    Touching(Vec<u8>),
    /// Nothing is left.
    Empty,
    /// It took longer than it was given.
    Late,
}

impl Rendered {
    /// The OFF file, whatever touches; otherwise what happened instead.
    pub fn bytes(self) -> Result<Vec<u8>, String> {
        match self {
            Rendered::Solid(bytes) | Rendered::Touching(bytes) => Ok(bytes),
            Rendered::Empty => Err("OpenSCAD finds it empty".to_string()),
            Rendered::Late => Err("OpenSCAD took too long".to_string()),
        }
    }
}

/// Renders a source in OpenSCAD within so many seconds. Fails with OpenSCAD's words where it is not
/// content.
pub fn render(source: &Path, seconds: u32) -> Result<Rendered, String> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let target = folder.path().join("out.off");
    let run = Command::new("timeout")
        .arg(seconds.to_string())
        .args(["openscad", "-o"])
        .args([&target, source])
        .output()
        .map_err(|e| format!("`timeout` and `openscad` are needed: {e}"))?;
    let said = String::from_utf8_lossy(&run.stderr);
    if run.status.code() == Some(124) {
        return Ok(Rendered::Late);
    }
    if said.contains("Current top level object is empty") {
        return Ok(Rendered::Empty);
    }
    let touches = |line: &&str| line.contains("may not be a valid 2-manifold");
    let (touching, other): (Vec<&str>, _) = said.lines().partition(touches);
    let complains = |line: &&str| line.contains("WARNING") || line.contains("ERROR");
    if !run.status.success() || other.iter().any(complains) {
        return Err(format!("OpenSCAD: {said}"));
    }
    let bytes = fs::read(&target).map_err(|e| e.to_string())?;
    Ok(if touching.is_empty() { Rendered::Solid(bytes) } else { Rendered::Touching(bytes) })
}

/// Renders source text.
pub fn render_text(text: &[u8], seconds: u32) -> Result<Rendered, String> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let source = folder.path().join("model.scad");
    fs::write(&source, text).map_err(|e| e.to_string())?;
    render(&source, seconds)
}
