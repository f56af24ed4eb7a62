//! Abaqus input: nodes, elements C3D4 in a set for each part, and a surface for each group of triangles.

use super::{
    NamedElements,
    group::{Groups, Lines, plain_name},
};
use crate::output::number::Shortest;

/// Abaqus' numbers of the faces opposite to each corner of C3D4.
const FACES: [&str; 4] = ["S3", "S4", "S2", "S1"];

pub(super) fn write(parts: &[NamedElements], groups: &Groups) -> Vec<u8> {
    let mut lines = Lines::default();
    lines.text("*HEADING\nlengths in mm\n*NODE");
    let mut node = 1;
    for part in parts {
        for point in &part.mesh.points {
            let [x, y, z] = point.to_array().map(Shortest);
            lines.text(&format!("{node}, {x}, {y}, {z}"));
            node += 1;
        }
    }
    let (mut first, mut element) = (1, 1);
    let mut starts = vec![];
    for part in parts {
        starts.push(element);
        lines.text(&format!("*ELEMENT, TYPE=C3D4, ELSET={}", plain_name(part.name)));
        for corners in &part.mesh.tetrahedra {
            let corners = corners.map(|c| first + c as usize);
            lines.line(", ", [element].into_iter().chain(corners));
            element += 1;
        }
        first += part.mesh.points.len();
    }
    for (p, part) in parts.iter().enumerate() {
        for (number, name) in groups.surfaces(p) {
            lines.text(&format!("*SURFACE, TYPE=ELEMENT, NAME={}", plain_name(name)));
            for t in groups.triangles(p, number) {
                let triangle = &part.mesh.boundary[t];
                let element = starts[p] + triangle.tetrahedron as usize;
                lines.text(&format!("{element}, {}", FACES[usize::from(triangle.opposite)]));
            }
        }
    }
    lines.0.into_bytes()
}
