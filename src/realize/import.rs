//! Solids from mesh files.

use super::{
    Realizer,
    failure::{Made, failure},
    heal,
};
use crate::{
    base::{Code, Diagnostic},
    input::{self, ReadError},
    kernel::brep::{
        Defect, Polyhedron,
        boolean::self_union,
        crossing::{crossing, is_hollow},
        faces,
    },
    shape::{GeometryError, node::Heal},
};

/// The solid of a mesh file, mended if asked to. The error has no place yet.
pub fn solid(realizer: &Realizer, file: &str, how: Option<Heal>) -> Made<Polyhedron> {
    let bytes = realizer.last_bytes(file)?;
    let mut mesh = input::read_mesh(file, &bytes).map_err(|error| unreadable(file, &error))?;
    drop(bytes);
    match how {
        Some(Heal::Weld(mm)) => mesh = input::weld(&mesh, mm),
        Some(Heal::Winding) | None => {}
    }
    let solid = match faces::from_import(&mesh) {
        Err(Defect::OpenEdge { .. }) if how == Some(Heal::Winding) => {
            faces::from_import(&heal::closed(&mesh))
        }
        found => found,
    };
    let solid = solid.map_err(|defect| open(file, &defect))?;
    drop(mesh);
    enclosed(solid, file, how)
}

/// What the surface winds around, where it crosses or covers itself: then the shells alone do not say what
/// is inside. Refused if that is nothing.
fn enclosed(solid: Polyhedron, file: &str, how: Option<Heal>) -> Made<Polyhedron> {
    let mended = how == Some(Heal::Winding) || crossing(solid.mesh()) != Ok(None);
    let solid = if mended { wound(&solid, file)? } else { solid };
    if !is_hollow(&solid) {
        return Ok(solid);
    }
    let words = format!("`{file}` encloses nothing: its surface is flat or all gaps");
    let help = "if its triangles do not quite meet, `heal = 0.01mm` joins points that near";
    Err(failure(Diagnostic::error(Code::Degenerate, words).help(help)))
}

fn wound(solid: &Polyhedron, file: &str) -> Made<Polyhedron> {
    let united = self_union(solid).map(|evaluated| evaluated.solid);
    united.map_err(|error| {
        let words = format!("`{file}` crosses itself and cannot be mended: {error}");
        failure(Diagnostic::error(Code::OpenMesh, words))
    })
}

/// The error for a file that breaks the rules of its format. It has no place yet.
pub fn unreadable(file: &str, error: &ReadError) -> GeometryError {
    let code = match error {
        ReadError::Limit { .. } => Code::Limit,
        ReadError::Extension { .. } | ReadError::Content { .. } => Code::BadFile,
    };
    failure(Diagnostic::error(code, format!("`{file}`: {error}")))
}

fn open(file: &str, defect: &Defect) -> GeometryError {
    let diagnostic = match defect {
        Defect::OpenEdge { at, edges, .. } => {
            let [x, y, z] = at.to_array();
            let words = format!("`{file}` is not closed: {edges} open edges");
            Diagnostic::error(Code::OpenMesh, words).note(format!("one is at [{x}, {y}, {z}]"))
        }
        other => Diagnostic::error(Code::OpenMesh, format!("`{file}` is no solid: {other}")),
    };
    let help = "`heal = 0.01mm` joins points that near, `heal = WINDING` closes what is open";
    failure(diagnostic.help(help))
}
