//! PLY, the Stanford polygon format: binary, little endian, `double` coordinates, colours on faces if
//! any face has one. Triangles only: several common readers refuse lists of differing lengths.

use super::part::{PLAIN, Part};

pub(super) fn write(parts: &[Part]) -> Vec<u8> {
    let coloured = parts.iter().any(Part::is_coloured);
    let points: usize = parts.iter().map(|part| part.mesh.points.len()).sum();
    let mut body = Vec::with_capacity(24 * points);
    for p in parts.iter().flat_map(|part| &part.mesh.points) {
        p.to_array().iter().for_each(|x| body.extend_from_slice(&(x + 0.0).to_le_bytes()));
    }
    let (mut first, mut faces) = (0, 0);
    for part in parts {
        faces += push_faces(&mut body, part, first, coloured);
        first += part.mesh.points.len() as u32;
    }
    let mut bytes = header(points, faces, coloured).into_bytes();
    bytes.append(&mut body);
    bytes
}

fn header(points: usize, faces: usize, coloured: bool) -> String {
    let colour = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    format!(
        "ply\nformat binary_little_endian 1.0\ncomment Katachi, unit millimetre\n\
         element vertex {points}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {faces}\nproperty list uchar uint vertex_indices\n{}end_header\n",
        if coloured { colour } else { "" }
    )
}

/// Returns the number of faces written.
fn push_faces(body: &mut Vec<u8>, part: &Part, first: u32, coloured: bool) -> usize {
    let mut count = 0;
    for (face, triangles) in part.faces() {
        let color = face.origin().color.unwrap_or(PLAIN);
        for triangle in triangles {
            body.push(triangle.len() as u8);
            triangle.iter().for_each(|c| body.extend_from_slice(&(first + c).to_le_bytes()));
            if coloured {
                body.extend_from_slice(&[color.r, color.g, color.b]);
            }
            count += 1;
        }
    }
    count
}
