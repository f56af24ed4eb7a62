//! Solids from mesh files.

use super::{
    Realizer,
    failure::{Made, failure},
    heal,
};
use crate::{
    base::{Code, Diagnostic},
    input::{self, ReadError},
    kernel::brep::{Defect, Polyhedron, faces},
    shape::{GeometryError, node::Heal},
};

/// The solid of a mesh file, mended if asked to. The error has no place yet.
pub fn solid(realizer: &Realizer, file: &str, how: Option<Heal>) -> Made<Polyhedron> {
    let bytes = realizer.last_bytes(file)?;
    let mut mesh = input::read_mesh(file, &bytes).map_err(|error| unreadable(file, &error))?;
    drop(bytes);
    match how {
        Some(Heal::Weld(mm)) => mesh = input::weld(&mesh, mm),
        Some(Heal::Winding) => mesh = heal::closed(&mesh),
        None => {}
    }
    faces::from_import(&mesh).map_err(|defect| open(file, &defect))
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
