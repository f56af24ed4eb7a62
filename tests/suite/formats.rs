//! Every format of every example: it reads back to the same solid, and threads do not show in it.

mod glb;

use std::{fs, path::Path};

use glam::DVec3;
use katachi::{
    geom::{PolyMesh, triangulate::triangulate},
    input,
    output::mesh::MeshFormat,
    session::{Format, Measures},
};

use crate::{
    errors::run,
    examples,
    made::{Made, on_two_threads, solid},
};

/// Coordinates of single precision are off by at most 2^-24 of their size, a point by sqrt(3) of that.
/// ASCII STL is written in full but read like binary STL, so that equal corners stay equal.
const SINGLE: f64 = 1.2e-7;

/// Coordinates of double precision are written in full. But the corners of a result are rounded, so its
/// polygons are plane only to the step of the lattice, 5e-9 of the size at most, and the triangles of
/// a file enclose by that much more or less than the polygons that are measured.
const DOUBLE: f64 = 5e-9;

/// How far corners may be from where they were, by the largest coordinate.
fn precision(format: MeshFormat) -> f64 {
    match format {
        MeshFormat::Stl | MeshFormat::StlAscii | MeshFormat::Glb => SINGLE,
        _ => DOUBLE,
    }
}

#[test]
fn every_file_of_an_example_reads_back() {
    let faults = on_two_threads(&examples::models(), |name| reads_back(name)).concat();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn reads_back(name: &str) -> Vec<String> {
    let file = examples::folder().join(name);
    let mut faults = vec![];
    for format in MeshFormat::ALL {
        let made = match Made::of_file(&file, &[Format::Mesh(format)]) {
            Ok(made) => made,
            Err(words) => return vec![format!("{name}: {words}")],
        };
        for ((part, measures), (file, bytes)) in made.parts.iter().zip(&made.files) {
            assert_eq!(*file, format!("{part}.{}", format.extension()));
            let fault = fault(format, file, bytes, measures);
            faults.extend(fault.map(|words| format!("{name}, {}: {words}", format.name())));
        }
        let ending = format!(".{}", format.extension());
        if made.files.iter().filter(|(file, _)| file.ends_with(&ending)).count() != made.parts.len()
        {
            faults.push(format!("{name}, {}: {} files", format.name(), made.files.len()));
        }
    }
    faults
}

/// What is wrong with the file of one part.
fn fault(format: MeshFormat, file: &str, bytes: &[u8], expected: &Measures) -> Option<String> {
    let volume = match volume(format, file, bytes) {
        Ok(volume) => volume,
        Err(words) => return Some(words),
    };
    let reach = expected.bounds.map_or(0.0, |[a, b]| a.abs().max(b.abs()).max_element());
    let limit = precision(format) * expected.area * reach;
    let off = (volume - expected.volume).abs();
    (off > limit).then(|| format!("{file}: {volume} mm^3, expected {}", expected.volume))
}

/// The volume of the triangles of a file. Formats that we read must be closed as well.
fn volume(format: MeshFormat, file: &str, bytes: &[u8]) -> Result<f64, String> {
    if format == MeshFormat::Glb {
        return glb::volume(bytes).ok_or_else(|| format!("{file}: no triangles found"));
    }
    solid(file, bytes)?;
    let mesh = input::read_mesh(file, bytes).map_err(|e| e.to_string())?;
    Ok(enclosed(&mesh))
}

/// The volume in a closed mesh.
fn enclosed(mesh: &PolyMesh) -> f64 {
    let corners = triangulate(mesh).corners;
    six_volumes(corners.iter().map(|t| t.map(|c| mesh.points[c as usize]))) / 6.0
}

fn six_volumes(triangles: impl Iterator<Item = [DVec3; 3]>) -> f64 {
    triangles.map(|[a, b, c]| a.dot(b.cross(c))).sum()
}

#[test]
fn threads_do_not_show_in_files() {
    let faults = on_two_threads(&examples::models(), |name| threads_show(name)).concat();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The formats whose files differ when an example is built with one thread and with two.
fn threads_show(name: &str) -> Vec<String> {
    let meshes = MeshFormat::ALL.map(MeshFormat::name);
    let formats = meshes.iter().chain([&"scad"]).map(|format| vec!["--format", format]);
    let mut faults = vec![];
    for format in formats.chain([vec![]]) {
        let [one, two] = ["1", "2"].map(|jobs| built(name, &format, jobs));
        if one.is_empty() || one != two {
            faults.push(format!("{name} {}: {} files", format.join(" "), one.len()));
        }
    }
    faults
}

/// Names and bytes of what `katachi build` writes.
fn built(name: &str, format: &[&str], jobs: &str) -> Vec<(String, Vec<u8>)> {
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().to_str().expect("plain path");
    let output =
        run(&examples::folder(), &[&["build", name, "-o", folder, "-j", jobs], format].concat());
    assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    let mut files = vec![];
    collect(out.path(), &mut files);
    files.sort();
    files
}

fn collect(folder: &Path, files: &mut Vec<(String, Vec<u8>)>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            collect(&path, files);
        } else {
            let name = path.file_name().expect("named").to_string_lossy().into_owned();
            files.push((name, fs::read(&path).expect("readable")));
        }
    }
}
