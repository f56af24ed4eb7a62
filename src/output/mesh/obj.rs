//! Wavefront OBJ: polygons, an object and a group per part.
//!
//! Colours are left out: OBJ keeps them in a second file (MTL) that easily gets lost, and one file in,
//! one file out is worth more here. 3MF, GLB, PLY and OFF carry them.

use std::io::Write;

use super::part::Part;
use crate::output::number::Shortest;

pub(super) fn write(parts: &[Part]) -> Vec<u8> {
    let mut text = b"# Katachi, unit millimetre\n".to_vec();
    let mut first = 1;
    for part in parts {
        // Writing to memory cannot fail.
        let _ = write_object(&mut text, part, first);
        first += part.mesh.points.len();
    }
    text
}

/// `first` is the number of the part's first point; OBJ counts from 1 through the whole file.
fn write_object(text: &mut Vec<u8>, part: &Part, first: usize) -> std::io::Result<()> {
    let name: String = part.name.split_whitespace().collect::<Vec<_>>().join("_");
    writeln!(text, "o {name}\ng {name}")?;
    for p in &part.mesh.points {
        writeln!(text, "v {} {} {}", Shortest(p.x), Shortest(p.y), Shortest(p.z))?;
    }
    for (_, facet) in part.facets() {
        for polygon in facet.polygons() {
            write!(text, "f")?;
            for &corner in polygon {
                write!(text, " {}", first + corner as usize)?;
            }
            writeln!(text)?;
        }
    }
    Ok(())
}
