//! Models made in process, through the session alone.

use std::{
    path::Path,
    sync::{
        Arc, Mutex,
        atomic::{AtomicUsize, Ordering},
    },
};

use katachi::{
    app::disk::Disk,
    base::{Diagnostic, World, watch::Unwatched},
    input,
    kernel::brep::{Polyhedron, faces},
    output::mesh::MeshFormat,
    session::{Format, Measures, Session},
};

/// Measures and files of one model.
pub struct Made {
    /// The parts in source order.
    pub parts: Vec<(String, Arc<Measures>)>,
    /// File names and bytes, by format and then in source order.
    pub files: Vec<(String, Vec<u8>)>,
    /// What was said about it without being an error.
    pub warnings: Vec<Diagnostic>,
}

/// Polygons with every digit.
pub const OFF: Format = Format::Mesh(MeshFormat::Off);

impl Made {
    /// Measures a model and writes its parts in the given formats. The error is what the session said.
    pub fn of(world: &dyn World, entry: &str, formats: &[Format]) -> Result<Made, String> {
        let session = Session::new(world, &Unwatched, None);
        let (mut model, mut diagnostics) = session.compile(entry, &[]);
        let measured = model.measure(&[]);
        diagnostics.extend(measured.diagnostics);
        let mut files = vec![];
        for &format in formats {
            let artifacts = model.artifacts(&[], Some(format), &mut diagnostics);
            diagnostics.extend(model.build(&artifacts, &mut |artifact, bytes| {
                files.push((artifact.file.clone(), bytes.to_vec()));
                Ok(())
            }));
        }
        if diagnostics.iter().any(Diagnostic::is_error) {
            return Err(format!("{diagnostics:#?}"));
        }
        Ok(Made { parts: measured.found, files, warnings: diagnostics })
    }

    /// The same for a file on disk.
    pub fn of_file(file: &Path, formats: &[Format]) -> Result<Made, String> {
        let (disk, entry) = Disk::open(file.to_str().ok_or("not a plain path")?, None)?;
        Made::of(&disk, &entry, formats)
    }

    /// The bytes of the first file with this extension.
    pub fn file(&self, extension: &str) -> Option<&[u8]> {
        let found = self.files.iter().find(|(name, _)| name.ends_with(extension));
        found.map(|(_, bytes)| &**bytes)
    }
}

/// The solid of a mesh file.
pub fn solid(name: &str, bytes: &[u8]) -> Result<Polyhedron, String> {
    let mesh = input::read_mesh(name, bytes).map_err(|e| format!("{name}: {e}"))?;
    faces::from_import(&mesh).map_err(|e| format!("{name}: {e}"))
}

/// Tries all items on two threads; the results stand in the order of the items.
pub fn on_two_threads<T: Sync, R: Send>(items: &[T], try_one: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let results = Mutex::new(vec![]);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some((i, item)) = {
                    let i = next.fetch_add(1, Ordering::Relaxed);
                    items.get(i).map(|item| (i, item))
                } {
                    let result = try_one(item);
                    results.lock().expect("no thread fails").push((i, result));
                }
            });
        }
    });
    let mut results = results.into_inner().expect("no thread fails");
    results.sort_by_key(|(i, _)| *i);
    results.into_iter().map(|(_, result)| result).collect()
}
