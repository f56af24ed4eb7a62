//! Wavefront OBJ, by the crate `tobj`: polygons kept, objects and groups become tags.
//!
//! Materials stand in files of their own, which are not read. Normals, texture coordinates, lines
//! and points are left out.

use std::io::{BufRead, Read};

use glam::dvec3;
use tobj::{LoadError, LoadOptions, Model};

use super::{
    Place, ReadError,
    error::{Format, MOST_COORDINATE, shortened},
    soup::Soup,
};
use crate::geom::PolyMesh;

const OBJ: Format = Format("OBJ");

/// The mesh of an OBJ file.
///
/// # Errors
/// What `tobj` refuses, with the line it had come to; coordinates that are not finite; no faces.
pub fn read(bytes: &[u8]) -> Result<PolyMesh, ReadError> {
    let text = OBJ.text(bytes)?;
    check_indices(text)?;
    let mut reader = Counted { rest: text.as_bytes(), lines: 0 };
    let options = LoadOptions { ignore_points: true, ignore_lines: true, ..LoadOptions::default() };
    let loaded = tobj::load_obj_buf(&mut reader, &options, |_| Err(LoadError::OpenFileFailed));
    let (models, _) = loaded.map_err(|error| {
        let needed = "numbers and indices as the OBJ format has them are needed";
        OBJ.error(Place::Line(reader.lines), error.to_string(), needed)
    })?;
    let mut soup = Soup::new(OBJ);
    for model in &models {
        add(&mut soup, model)?;
    }
    soup.finish()
}

/// Every face must name what exists: `tobj` computes with any number.
fn check_indices(text: &str) -> Result<(), ReadError> {
    const KINDS: [(&str, &str); 3] =
        [("v", "points"), ("vt", "texture coordinates"), ("vn", "normals")];
    let first = |line: &str| line.split_whitespace().next().map(str::to_owned).unwrap_or_default();
    let mut counts = [0_i64; 3];
    for word in text.lines().map(first) {
        if let Some(kind) = KINDS.iter().position(|(name, _)| *name == word) {
            counts[kind] += 1;
        }
    }
    for (number, line) in text.lines().enumerate().filter(|(_, line)| first(line) == "f") {
        for corner in line.split_whitespace().skip(1) {
            for (kind, index) in corner.split('/').enumerate().filter(|(_, i)| !i.is_empty()) {
                let (_, what) = KINDS.get(kind).unwrap_or(&KINDS[0]);
                let count = counts.get(kind).copied().unwrap_or(0);
                let value = index.parse::<i64>().ok();
                if value.is_none_or(|v| v == 0 || v < -count || v > count) {
                    let found = format!("a face with \"{}\"", shortened(corner));
                    let needed = format!("there are {count} {what}, counted from 1");
                    return Err(OBJ.error(Place::Line(number + 1), found, needed));
                }
            }
        }
    }
    Ok(())
}

fn add(soup: &mut Soup, model: &Model) -> Result<(), ReadError> {
    const UNNAMED: &str = "unnamed_object";
    soup.name(if model.name == UNNAMED { "" } else { &model.name });
    let base = soup.mesh.points.len() as u32;
    let mesh = &model.mesh;
    for p in mesh.positions.chunks_exact(3) {
        if !p.iter().all(|c| c.abs() <= MOST_COORDINATE) {
            let found = format!("a point at ({}, {}, {})", p[0], p[1], p[2]);
            return Err(OBJ.error(Place::File, found, "coordinates must be finite numbers"));
        }
        soup.mesh.points.push(dvec3(p[0], p[1], p[2]));
    }
    let mut indices = mesh.indices.as_slice();
    let triangles = vec![3; if mesh.face_arities.is_empty() { indices.len() / 3 } else { 0 }];
    for &arity in mesh.face_arities.iter().chain(&triangles) {
        let Some((face, rest)) = indices.split_at_checked(arity as usize) else { break };
        indices = rest;
        let corners: Vec<u32> = face.iter().map(|i| base + i).collect();
        soup.face(&corners, None)?;
    }
    Ok(())
}

/// Counts the lines that were read.
struct Counted<'a> {
    rest: &'a [u8],
    lines: usize,
}

impl Read for Counted<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.rest.read(buffer)
    }
}

impl BufRead for Counted<'_> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        Ok(self.rest)
    }

    fn consume(&mut self, amount: usize) {
        self.lines += self.rest[..amount].iter().filter(|b| **b == b'\n').count();
        self.rest = &self.rest[amount..];
    }
}
