//! VTK unstructured grid, XML with ASCII arrays (VTK file formats, "UnstructuredGrid"). Cells are the tetrahedra, then
//! the triangles of the boundary; `group` is the number of each one's group, named in the comment at the top.

use super::{
    NamedElements,
    group::{Groups, Lines, plain_name},
};
use crate::output::number::Shortest;

/// VTK's numbers for cells.
const TRIANGLE: usize = 5;
const TETRAHEDRON: usize = 10;

pub(super) fn write(parts: &[NamedElements], groups: &Groups) -> Vec<u8> {
    let cells = Cells::of(parts, groups);
    let points: usize = parts.iter().map(|part| part.mesh.points.len()).sum();
    let mut lines = Lines::default();
    lines.text("<?xml version=\"1.0\"?>");
    for (p, part) in parts.iter().enumerate() {
        lines.text(&format!("<!-- group {}: {} -->", groups.of_part(p), commented(part.name)));
        for (number, name) in groups.surfaces(p) {
            lines.text(&format!("<!-- group {number}: {} -->", commented(name)));
        }
    }
    lines.text("<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">");
    lines.text("<UnstructuredGrid>");
    lines.text(&format!(
        "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{}\">",
        cells.types.len()
    ));
    lines.text("<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">");
    for point in parts.iter().flat_map(|part| &part.mesh.points) {
        lines.line(" ", point.to_array().map(Shortest));
    }
    lines.text("</DataArray>\n</Points>\n<Cells>");
    array(&mut lines, "Int64", "connectivity", &cells.corners);
    array(&mut lines, "Int64", "offsets", &cells.ends);
    array(&mut lines, "UInt8", "types", &cells.types);
    lines.text("</Cells>\n<CellData Scalars=\"group\">");
    array(&mut lines, "Int32", "group", &cells.groups);
    lines.text("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>");
    lines.0.into_bytes()
}

/// A name in a comment, where two hyphens may not stand.
fn commented(name: &str) -> String {
    plain_name(name).replace("--", "-_")
}

/// Cells as VTK wants them.
#[derive(Default)]
struct Cells {
    corners: Vec<usize>,
    ends: Vec<usize>,
    types: Vec<usize>,
    groups: Vec<usize>,
}

impl Cells {
    fn of(parts: &[NamedElements], groups: &Groups) -> Cells {
        let mut cells = Cells::default();
        let mut first = 0;
        for (p, part) in parts.iter().enumerate() {
            for corners in &part.mesh.tetrahedra {
                cells.push(corners, first, TETRAHEDRON, groups.of_part(p));
            }
            for (t, triangle) in part.mesh.boundary.iter().enumerate() {
                cells.push(&triangle.corners, first, TRIANGLE, groups.of_triangle(p, t));
            }
            first += part.mesh.points.len();
        }
        cells
    }

    fn push(&mut self, corners: &[u32], first: usize, kind: usize, group: usize) {
        self.corners.extend(corners.iter().map(|&c| first + c as usize));
        self.ends.push(self.corners.len());
        self.types.push(kind);
        self.groups.push(group);
    }
}

fn array(lines: &mut Lines, kind: &str, name: &str, values: &[usize]) {
    lines.text(&format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">"));
    for row in values.chunks(12) {
        lines.line(" ", row);
    }
    lines.text("</DataArray>");
}
