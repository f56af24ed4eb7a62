//! Gmsh MSH 4.1, ASCII (Gmsh reference manual, section "MSH file format").

use super::{
    NamedElements,
    group::{Groups, Lines},
};
use crate::output::number::Shortest;

/// Gmsh's numbers for elements.
const TRIANGLE: usize = 2;
const TETRAHEDRON: usize = 4;

pub(super) fn write(parts: &[NamedElements], groups: &Groups) -> Vec<u8> {
    let mut lines = Lines::default();
    lines.text("$MeshFormat\n4.1 0 8\n$EndMeshFormat");
    names(&mut lines, parts, groups);
    entities(&mut lines, parts, groups);
    nodes(&mut lines, parts, groups);
    elements(&mut lines, parts, groups);
    lines.0.into_bytes()
}

/// Names of physical groups: dimension, number, name.
fn names(lines: &mut Lines, parts: &[NamedElements], groups: &Groups) {
    lines.text("$PhysicalNames");
    lines.line(" ", [parts.len() + groups.surface_count()]);
    for (p, part) in parts.iter().enumerate() {
        for (number, name) in groups.surfaces(p) {
            lines.text(&format!("2 {number} \"{}\"", quoted(name)));
        }
        lines.text(&format!("3 {} \"{}\"", groups.of_part(p), quoted(part.name)));
    }
    lines.text("$EndPhysicalNames");
}

fn quoted(name: &str) -> String {
    name.replace(['"', '\n', '\r'], "_")
}

/// A surface for each group of triangles and a volume for each part, with their boxes.
fn entities(lines: &mut Lines, parts: &[NamedElements], groups: &Groups) {
    lines.text("$Entities");
    lines.line(" ", [0, 0, groups.surface_count(), parts.len()]);
    for (p, part) in parts.iter().enumerate() {
        for (number, _) in groups.surfaces(p) {
            lines.text(&format!("{number} {} 1 {number} 0", bounds(part)));
        }
    }
    for (p, part) in parts.iter().enumerate() {
        let (number, surfaces) =
            (groups.of_part(p), groups.surfaces(p).map(|(n, _)| format!(" {n}")));
        let surfaces: Vec<String> = surfaces.collect();
        let (box_of, count) = (bounds(part), surfaces.len());
        lines.text(&format!("{number} {box_of} 1 {number} {count}{}", surfaces.concat()));
    }
    lines.text("$EndEntities");
}

fn bounds(part: &NamedElements) -> String {
    let points = || part.mesh.points.iter().copied();
    let min = points().reduce(glam::DVec3::min).unwrap_or_default();
    let max = points().reduce(glam::DVec3::max).unwrap_or_default();
    let numbers = [min, max].map(|p| p.to_array().map(|x| Shortest(x).to_string()).join(" "));
    numbers.join(" ")
}

fn nodes(lines: &mut Lines, parts: &[NamedElements], groups: &Groups) {
    let count: usize = parts.iter().map(|part| part.mesh.points.len()).sum();
    lines.text("$Nodes");
    lines.line(" ", [parts.len(), count, 1, count]);
    let mut first = 1;
    for (p, part) in parts.iter().enumerate() {
        lines.line(" ", [3, groups.of_part(p), 0, part.mesh.points.len()]);
        for node in first..first + part.mesh.points.len() {
            lines.line(" ", [node]);
        }
        for point in &part.mesh.points {
            lines.line(" ", point.to_array().map(Shortest));
        }
        first += part.mesh.points.len();
    }
    lines.text("$EndNodes");
}

fn elements(lines: &mut Lines, parts: &[NamedElements], groups: &Groups) {
    let of_part = |part: &NamedElements| part.mesh.boundary.len() + part.mesh.tetrahedra.len();
    let count: usize = parts.iter().map(of_part).sum();
    lines.text("$Elements");
    lines.line(" ", [groups.surface_count() + parts.len(), count, 1, count]);
    let (mut first, mut element) = (1, 1);
    for (p, part) in parts.iter().enumerate() {
        for (number, _) in groups.surfaces(p) {
            let triangles: Vec<usize> = groups.triangles(p, number).collect();
            lines.line(" ", [2, number, TRIANGLE, triangles.len()]);
            for triangle in triangles {
                let corners = part.mesh.boundary[triangle].corners.map(|c| first + c as usize);
                lines.line(" ", [element].into_iter().chain(corners));
                element += 1;
            }
        }
        lines.line(" ", [3, groups.of_part(p), TETRAHEDRON, part.mesh.tetrahedra.len()]);
        for corners in &part.mesh.tetrahedra {
            let corners = corners.map(|c| first + c as usize);
            lines.line(" ", [element].into_iter().chain(corners));
            element += 1;
        }
        first += part.mesh.points.len();
    }
    lines.text("$EndElements");
}
