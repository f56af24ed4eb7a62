//! Medit `.mesh` (P. Frey, *MEDIT: an interactive mesh visualization software*, 2001). References are the numbers
//! of groups; their names stand in comments.

use super::{
    NamedElements,
    group::{Groups, Lines, plain_name},
};
use crate::output::number::Shortest;

pub(super) fn write(parts: &[NamedElements], groups: &Groups) -> Vec<u8> {
    let mut lines = Lines::default();
    lines.text("MeshVersionFormatted 2\nDimension 3");
    for (p, part) in parts.iter().enumerate() {
        lines.text(&format!("# {} {}", groups.of_part(p), plain_name(part.name)));
        for (number, name) in groups.surfaces(p) {
            lines.text(&format!("# {number} {}", plain_name(name)));
        }
    }
    lines.text("Vertices");
    lines.line(" ", [parts.iter().map(|part| part.mesh.points.len()).sum::<usize>()]);
    for (p, part) in parts.iter().enumerate() {
        for point in &part.mesh.points {
            let [x, y, z] = point.to_array().map(Shortest);
            lines.text(&format!("{x} {y} {z} {}", groups.of_part(p)));
        }
    }
    lines.text("Triangles");
    lines.line(" ", [parts.iter().map(|part| part.mesh.boundary.len()).sum::<usize>()]);
    let mut first = 1;
    for (p, part) in parts.iter().enumerate() {
        for (t, triangle) in part.mesh.boundary.iter().enumerate() {
            let corners = triangle.corners.map(|c| first + c as usize);
            lines.line(" ", corners.into_iter().chain([groups.of_triangle(p, t)]));
        }
        first += part.mesh.points.len();
    }
    lines.text("Tetrahedra");
    lines.line(" ", [parts.iter().map(|part| part.mesh.tetrahedra.len()).sum::<usize>()]);
    let mut first = 1;
    for (p, part) in parts.iter().enumerate() {
        for corners in &part.mesh.tetrahedra {
            let corners = corners.map(|c| first + c as usize);
            lines.line(" ", corners.into_iter().chain([groups.of_part(p)]));
        }
        first += part.mesh.points.len();
    }
    lines.text("End");
    lines.0.into_bytes()
}
