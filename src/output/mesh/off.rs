//! OFF, the object file format of Geomview, with a colour at the end of a face's line where it has
//! one. Triangles only: several common readers refuse faces of differing lengths.

use super::part::Part;
use crate::output::number::{Shortest, push_count};

pub(super) fn write(parts: &[Part]) -> Vec<u8> {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    let (mut first, mut count) = (0, 0);
    for part in parts {
        write_points(&mut points, part);
        write_faces(&mut faces, part, first);
        first += part.mesh.points.len();
        count += part.triangles.corners.len();
    }
    let mut text = format!("OFF\n{first} {count} 0\n").into_bytes();
    text.append(&mut points);
    text.append(&mut faces);
    text
}

fn write_points(text: &mut Vec<u8>, part: &Part) {
    text.reserve(part.mesh.points.len() * POINT);
    for p in &part.mesh.points {
        for (coordinate, end) in p.to_array().into_iter().zip(*b"  \n") {
            Shortest(coordinate).push_to(text);
            text.push(end);
        }
    }
}

fn write_faces(text: &mut Vec<u8>, part: &Part, first: usize) {
    text.reserve(part.triangles.corners.len() * TRIANGLE);
    for (face, triangles) in part.faces() {
        for triangle in triangles {
            text.push(b'3');
            for &corner in triangle {
                text.push(b' ');
                push_count(first + corner as usize, text);
            }
            if let Some(color) = face.origin().color {
                for level in [color.r, color.g, color.b] {
                    text.push(b' ');
                    push_count(level.into(), text);
                }
            }
            text.push(b'\n');
        }
    }
}

/// Bytes that most points and triangles take, and few more.
const POINT: usize = 60;
const TRIANGLE: usize = 24;
