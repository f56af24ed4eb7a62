//! OFF, the object file format of Geomview, with a colour at the end of a face's line where it has
//! one. Triangles only: several common readers refuse faces of differing lengths.

use std::io::Write;

use super::part::Part;
use crate::output::number::Shortest;

pub(super) fn write(parts: &[Part]) -> Vec<u8> {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    let (mut first, mut count) = (0, 0);
    for part in parts {
        // Writing to memory cannot fail.
        let _ = write_points(&mut points, part);
        count += write_faces(&mut faces, part, first).unwrap_or(0);
        first += part.mesh.points.len();
    }
    let mut text = format!("OFF\n{first} {count} 0\n").into_bytes();
    text.append(&mut points);
    text.append(&mut faces);
    text
}

fn write_points(text: &mut Vec<u8>, part: &Part) -> std::io::Result<()> {
    let mut points = part.mesh.points.iter();
    points.try_for_each(|p| writeln!(text, "{} {} {}", Shortest(p.x), Shortest(p.y), Shortest(p.z)))
}

/// Returns the number of faces written.
fn write_faces(text: &mut Vec<u8>, part: &Part, first: usize) -> std::io::Result<usize> {
    let mut count = 0;
    for (face, triangles) in part.faces() {
        for triangle in triangles {
            write!(text, "{}", triangle.len())?;
            for &corner in triangle {
                write!(text, " {}", first + corner as usize)?;
            }
            if let Some(color) = face.origin().color {
                write!(text, " {} {} {}", color.r, color.g, color.b)?;
            }
            writeln!(text)?;
            count += 1;
        }
    }
    Ok(count)
}
