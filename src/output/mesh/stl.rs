//! STL, binary and ASCII. Millimetres by custom; the format names no unit.
//!
//! Binary STL holds `f32`, so points nearer than its resolution (about 1e-5 mm at 100 mm) may become
//! one. A triangle two of whose corners become one is left out: its other two edges are then each
//! other's reverse, so its neighbours meet there, and every directed edge still has as many partners
//! as runs against it. So the file is closed by coordinates whenever the mesh is closed by index.
//! (Two sheets nearer than the resolution may come to share an edge, as in any `f32` file.)
//!
//! A multi-part file is the triangles of all parts in order; in ASCII each part is a `solid`.

use std::io::Write;

use glam::DVec3;

use super::part::Part;
use crate::output::number::Shortest;

const HEADER: &[u8] = b"Katachi binary STL, unit millimetre";
const HEADER_SIZE: usize = 80;
const RECORD_SIZE: usize = 50;

pub(super) fn binary(parts: &[Part]) -> Vec<u8> {
    let most: usize = parts.iter().map(|part| part.triangles.corners.len()).sum();
    let mut bytes = Vec::with_capacity(HEADER_SIZE + 4 + RECORD_SIZE * most);
    bytes.extend_from_slice(HEADER);
    bytes.resize(HEADER_SIZE, b' ');
    bytes.extend_from_slice(&[0; 4]);
    let mut count = 0u32;
    for part in parts {
        let points: Vec<[f32; 3]> = part.mesh.points.iter().map(|&p| single(p)).collect();
        for triangle in &part.triangles.corners {
            let corners = triangle.map(|c| points[c as usize]);
            if corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0] {
                continue;
            }
            bytes.extend_from_slice(&record(normal(part, triangle), corners));
            count += 1;
        }
    }
    bytes[HEADER_SIZE..HEADER_SIZE + 4].copy_from_slice(&count.to_le_bytes());
    bytes
}

pub(super) fn ascii(parts: &[Part]) -> Vec<u8> {
    let mut text = Vec::new();
    for part in parts {
        // Writing to memory cannot fail.
        let _ = write_solid(&mut text, part);
    }
    text
}

fn write_solid(text: &mut Vec<u8>, part: &Part) -> std::io::Result<()> {
    let name: String = part.name.split_whitespace().collect::<Vec<_>>().join("_");
    let points: Vec<String> = part.mesh.points.iter().map(|&p| spaced(p)).collect();
    writeln!(text, "solid {name}")?;
    for triangle in &part.triangles.corners {
        writeln!(text, "facet normal {}\nouter loop", spaced(normal(part, triangle)))?;
        for &corner in triangle {
            writeln!(text, "vertex {}", points[corner as usize])?;
        }
        writeln!(text, "endloop\nendfacet")?;
    }
    writeln!(text, "endsolid {name}")
}

fn spaced(p: DVec3) -> String {
    format!("{} {} {}", Shortest(p.x), Shortest(p.y), Shortest(p.z))
}

/// The nearest single-precision point, negative zeros made positive so that equal points have equal
/// bytes.
fn single(p: DVec3) -> [f32; 3] {
    p.to_array().map(|x| x as f32 + 0.0)
}

/// The unit normal of a triangle from its corners; zero for one without area.
fn normal(part: &Part, triangle: &[u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|i| part.mesh.points[i as usize]);
    (b - a).cross(c - a).normalize_or_zero() + DVec3::ZERO
}

fn record(normal: DVec3, corners: [[f32; 3]; 3]) -> [u8; RECORD_SIZE] {
    let mut bytes = [0; RECORD_SIZE];
    let numbers = single(normal).into_iter().chain(corners.into_iter().flatten());
    for (slot, number) in bytes.chunks_exact_mut(4).zip(numbers) {
        slot.copy_from_slice(&number.to_le_bytes());
    }
    bytes
}
