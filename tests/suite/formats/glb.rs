//! Just enough of binary glTF 2.0 to find the triangles again.

use glam::DVec3;
use serde_json::Value;

use super::six_volumes;

/// Bytes of the header, and of the head of each chunk.
const HEADER: usize = 12;
const CHUNK: usize = 8;

/// The volume in the triangles of all meshes, mm^3: what the root node's matrix makes of it in m^3,
/// times 10^9. `None` if the file is not as the format says.
pub fn volume(bytes: &[u8]) -> Option<f64> {
    let whole = bytes.starts_with(b"glTF") && number(bytes, 8)? as usize == bytes.len();
    let json = chunk(bytes, HEADER, b"JSON")?;
    let binary = chunk(bytes, HEADER + CHUNK + json.len(), b"BIN\0")?;
    let document: Value = serde_json::from_slice(json).ok()?;
    let mut sum = 0.0;
    for mesh in document["meshes"].as_array()? {
        for primitive in mesh["primitives"].as_array()? {
            sum += six_volumes(triangles(&document, binary, primitive)?.into_iter());
        }
    }
    let matrix: Vec<f64> =
        document["nodes"][0]["matrix"].as_array()?.iter().filter_map(Value::as_f64).collect();
    let axis = |i: usize| DVec3::from_slice(&matrix[4 * i..4 * i + 3]);
    let scale = axis(0).dot(axis(1).cross(axis(2)));
    whole.then_some(sum / 6.0 * scale * 1e9)
}

fn triangles(document: &Value, binary: &[u8], primitive: &Value) -> Option<Vec<[DVec3; 3]>> {
    let (points, _) = accessor(document, primitive["attributes"]["POSITION"].as_u64()?)?;
    let (indices, count) = accessor(document, primitive["indices"].as_u64()?)?;
    let corner = |i: usize| {
        let point = points + 12 * number(binary, indices + 4 * i)? as usize;
        let axis = |k: usize| number(binary, point + 4 * k).map(|x| f64::from(f32::from_bits(x)));
        Some(DVec3::new(axis(0)?, axis(1)?, axis(2)?))
    };
    (0..count / 3).map(|t| Some([corner(3 * t)?, corner(3 * t + 1)?, corner(3 * t + 2)?])).collect()
}

/// Where the numbers of an accessor start, and how many there are.
fn accessor(document: &Value, index: u64) -> Option<(usize, usize)> {
    let accessor = &document["accessors"][index as usize];
    let view = &document["bufferViews"][accessor["bufferView"].as_u64()? as usize];
    let offset = |of: &Value| of["byteOffset"].as_u64().unwrap_or(0) as usize;
    Some((offset(accessor) + offset(view), accessor["count"].as_u64()? as usize))
}

fn chunk<'a>(bytes: &'a [u8], at: usize, kind: &[u8; 4]) -> Option<&'a [u8]> {
    let length = number(bytes, at)? as usize;
    let found = bytes.get(at + 4..at + CHUNK)? == kind;
    bytes.get(at + CHUNK..at + CHUNK + length).filter(|_| found)
}

fn number(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
}
