//! What every command that works on a model sets up first.

use std::{
    fs, io,
    mem::ManuallyDrop,
    path::{Path, PathBuf},
};

use super::{
    Exit,
    args::{Making, Model},
};
use crate::{
    app::{
        disk::{Disk, refusal},
        render::{self, Style},
        stopwatch::Stopwatch,
        write::write_whole,
    },
    base::Diagnostic,
    session::{self, Given, Session, Tolerance},
};

/// A model, and what was found in it.
type Compiled<'s> = (ManuallyDrop<session::Model<'s>>, Vec<Diagnostic>);

/// Files, parameters and watch of one command.
#[derive(Debug)]
pub struct Desk {
    /// The files.
    pub disk: Disk,
    /// The model's path in them.
    pub entry: String,
    /// Parameters given with `-D`, the last of a name counts.
    pub given: Vec<(String, Given)>,
    watch: Stopwatch,
    tolerance: Option<Tolerance>,
    timings: Option<PathBuf>,
    style: Style,
}

impl Desk {
    /// Opens the model's world. The error is in words for the user.
    pub fn open(model: &Model, making: Option<&Making>, style: Style) -> Result<Desk, String> {
        let watch = Stopwatch::start();
        if let Some(jobs) = making.and_then(|making| making.jobs) {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs.into());
            pool.build_global().map_err(|error| error.to_string())?;
        }
        let (disk, entry) = Disk::open(&model.file, model.root.as_deref())?;
        let mut given = vec![];
        for define in &model.define {
            given.extend(defined(define)?);
        }
        Ok(Desk {
            disk,
            entry,
            given,
            watch,
            tolerance: making.and_then(|making| making.tolerance),
            timings: making.and_then(|making| making.timings.clone()),
            style,
        })
    }

    /// The same desk; an entry that is a mesh becomes a model that imports it.
    pub fn importing(mut self) -> Desk {
        let extension = self.entry.rsplit_once('.').map_or("", |(_, extension)| extension);
        let meshes = ["stl", "obj", "off", "ply", "3mf"];
        if meshes.iter().any(|mesh| extension.eq_ignore_ascii_case(mesh)) {
            self.entry = self.disk.import(&self.entry);
        }
        self
    }

    /// A session over these files. It is never dropped: the process ends with its command, and taking
    /// trees and solids apart piece by piece before that would take longer than reading them.
    pub fn session(&self) -> ManuallyDrop<Session<'_>> {
        ManuallyDrop::new(Session::new(&self.disk, &self.watch, self.tolerance))
    }

    /// The model with the parameters given. It is never dropped either.
    pub fn compile<'s>(&self, session: &'s Session<'_>) -> Compiled<'s> {
        let (model, diagnostics) = session.compile(&self.entry, &self.given);
        (ManuallyDrop::new(model), diagnostics)
    }

    /// The same when it has all outputs that are asked for; otherwise all that is to be said.
    pub fn compile_asked<'s>(
        &self,
        session: &'s Session<'_>,
        names: &[String],
    ) -> Result<Compiled<'s>, Vec<Diagnostic>> {
        let (mut model, mut diagnostics) = self.compile(session);
        let unknown = model.refuse_unknown(names);
        if unknown.is_empty() {
            return Ok((model, diagnostics));
        }
        diagnostics.extend(unknown);
        Err(diagnostics)
    }

    /// Reports what was found, each thing once, writes the timings if asked to, and says how the command ends.
    pub fn report(&self, session: &Session, diagnostics: &[Diagnostic]) -> io::Result<Exit> {
        self.watch.end_bar();
        render::report(self.style, &session.sources(), &once_each(diagnostics))?;
        let exit = Exit::of(diagnostics);
        let Some(path) = &self.timings else { return Ok(exit) };
        match write_beside(path, self.watch.timings().as_bytes()) {
            Ok(()) => Ok(exit),
            Err(words) => super::fail(self.style, exit.max(Exit::Model), words),
        }
    }

    /// The watch.
    pub fn watch(&self) -> &Stopwatch {
        &self.watch
    }
}

/// Every diagnostic once, where it came first: outputs that fail for one reason all say so.
fn once_each(diagnostics: &[Diagnostic]) -> Vec<Diagnostic> {
    let mut kept: Vec<Diagnostic> = vec![];
    for diagnostic in diagnostics {
        if !kept.contains(diagnostic) {
            kept.push(diagnostic.clone());
        }
    }
    kept
}

/// Writes a file that the user named by its path.
pub(super) fn write_beside(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let name = path.file_name().ok_or_else(|| format!("`{}` names no file", path.display()))?;
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    write_whole(folder, &name.to_string_lossy(), bytes).map(drop)
}

/// The parameters of one `-D`: `name=value`, or `@file.json`.
fn defined(define: &str) -> Result<Vec<(String, Given)>, String> {
    if let Some(file) = define.strip_prefix('@') {
        let text = fs::read_to_string(file).map_err(|e| format!("`{file}`: {}", refusal(&e)))?;
        let object: serde_json::Map<String, serde_json::Value> =
            serde_json::from_str(&text).map_err(|error| format!("`{file}`: {error}"))?;
        return Ok(object.into_iter().map(|(name, value)| (name, Given::Json(value))).collect());
    }
    let (name, value) = define
        .split_once('=')
        .ok_or_else(|| format!("`-D {define}`: NAME=VALUE or @FILE is needed"))?;
    Ok(vec![(name.trim().to_string(), Given::Text(value.trim().to_string()))])
}
