//! GLB, binary glTF 2.0.
//!
//! glTF is in metres with y up; the points stay in millimetres with z up, and the one root node turns
//! and scales them. Each part is a child node with its name and mesh, each colour of a part a primitive
//! with its material. Corners are not shared between faces, so that facets are shaded flat.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use serde_json::{Value, json};

use super::{
    WriteError, check_count,
    part::{PLAIN, Part},
};
use crate::geom::{FaceRef, mesh::Color};

/// Column by column: millimetres to metres, z up to y up.
const MILLIMETRE_Z_UP: [f64; 16] =
    [0.001, 0., 0., 0., 0., 0., -0.001, 0., 0., 0.001, 0., 0., 0., 0., 0., 1.];

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const TRIANGLES: u32 = 4;

pub(super) fn write(parts: &[Part]) -> Result<Vec<u8>, WriteError> {
    let parts: Vec<&Part> = parts.iter().filter(|part| !part.mesh.is_empty()).collect();
    let mut file = File { colors: colors(&parts), ..File::default() };
    let nodes: Vec<Value> = parts.iter().map(|part| file.push_part(part)).collect();
    let size = file.buffer.len();
    let mut root = json!({ "name": "Katachi", "matrix": MILLIMETRE_Z_UP });
    if !nodes.is_empty() {
        root["children"] = json!((1..=nodes.len()).collect::<Vec<_>>());
    }
    let all_nodes: Vec<Value> = std::iter::once(root).chain(nodes).collect();
    let mut document = json!({
        "asset": { "version": "2.0", "generator": "Katachi" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": all_nodes,
    });
    // Empty lists are not allowed.
    if size > 0 {
        document["meshes"] = Value::Array(file.meshes);
        document["materials"] = file.colors.iter().map(|&color| material(color)).collect();
        document["accessors"] = Value::Array(file.accessors);
        document["bufferViews"] = Value::Array(file.views);
        document["buffers"] = json!([{ "byteLength": size }]);
    }
    assemble(document.to_string().into_bytes(), file.buffer)
}

/// The container: a header and the two chunks, each padded to four bytes.
fn assemble(mut json: Vec<u8>, mut binary: Vec<u8>) -> Result<Vec<u8>, WriteError> {
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = 12 + 8 + json.len() + if binary.is_empty() { 0 } else { 8 + binary.len() };
    check_count("bytes", length as u64, "glb")?;
    let mut bytes = Vec::with_capacity(length);
    bytes.extend_from_slice(b"glTF");
    bytes.extend_from_slice(&2u32.to_le_bytes());
    bytes.extend_from_slice(&(length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", binary)] {
        if !chunk.is_empty() {
            bytes.extend_from_slice(&(chunk.len() as u32).to_le_bytes());
            bytes.extend_from_slice(kind);
            bytes.extend_from_slice(&chunk);
        }
    }
    Ok(bytes)
}

/// A document in the making.
#[derive(Default)]
struct File {
    buffer: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    /// The colours of all parts in order; their places are the numbers of their materials.
    colors: Vec<Color>,
}

fn colors(parts: &[&Part]) -> Vec<Color> {
    let faces = parts.iter().flat_map(|part| part.mesh.faces());
    let colors: BTreeSet<Color> = faces.map(|f| f.origin().color.unwrap_or(PLAIN)).collect();
    colors.into_iter().collect()
}

/// The corners of some faces, not shared between them.
#[derive(Default)]
struct Corners {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    indices: Vec<u32>,
}

impl File {
    /// Adds a mesh with a primitive for each colour and returns its node.
    fn push_part(&mut self, part: &Part) -> Value {
        let mut by_color: BTreeMap<Color, Corners> = BTreeMap::new();
        let mut place = vec![0; part.mesh.points.len()];
        for (face, triangles) in part.faces() {
            let color = face.origin().color.unwrap_or(PLAIN);
            by_color.entry(color).or_default().push(part, face, triangles, &mut place);
        }
        let primitives: Vec<Value> =
            by_color.iter().map(|(&color, corners)| self.push_primitive(color, corners)).collect();
        self.meshes.push(json!({ "name": part.name, "primitives": primitives }));
        json!({ "name": part.name, "mesh": self.meshes.len() - 1 })
    }

    fn push_primitive(&mut self, color: Color, corners: &Corners) -> Value {
        let positions = self.push_vectors(&corners.positions);
        let (low, high) = bounds(&corners.positions);
        self.accessors[positions]["min"] = json!(low);
        self.accessors[positions]["max"] = json!(high);
        let normals = self.push_vectors(&corners.normals);
        let indices = corners.indices.iter().flat_map(|i| i.to_le_bytes());
        let indices = self.push_view(indices, ELEMENT_ARRAY_BUFFER);
        let count = corners.indices.len();
        self.accessors.push(json!({
            "bufferView": indices, "componentType": UNSIGNED_INT, "count": count, "type": "SCALAR"
        }));
        json!({
            "attributes": { "POSITION": positions, "NORMAL": normals },
            "indices": self.accessors.len() - 1,
            "material": self.colors.binary_search(&color).unwrap_or(0),
            "mode": TRIANGLES,
        })
    }

    /// Returns the number of the accessor.
    fn push_vectors(&mut self, vectors: &[[f32; 3]]) -> usize {
        let bytes = vectors.iter().flatten().flat_map(|x| x.to_le_bytes());
        let view = self.push_view(bytes, ARRAY_BUFFER);
        let count = vectors.len();
        self.accessors.push(json!({
            "bufferView": view, "componentType": FLOAT, "count": count, "type": "VEC3"
        }));
        self.accessors.len() - 1
    }

    fn push_view(&mut self, bytes: impl Iterator<Item = u8>, target: u32) -> usize {
        let offset = self.buffer.len();
        self.buffer.extend(bytes);
        let length = self.buffer.len() - offset;
        self.views.push(json!({
            "buffer": 0, "byteOffset": offset, "byteLength": length, "target": target
        }));
        self.views.len() - 1
    }
}

impl Corners {
    /// `place` is scratch: where a point of the face at hand stands among the corners.
    fn push(&mut self, part: &Part, face: FaceRef, triangles: &[[u32; 3]], place: &mut [u32]) {
        let normal = single(face.area_vector().try_normalize().unwrap_or(DVec3::Z));
        for &corner in face.loops().flatten() {
            place[corner as usize] = self.positions.len() as u32;
            self.positions.push(single(part.mesh.points[corner as usize]));
            self.normals.push(normal);
        }
        self.indices.extend(triangles.iter().flatten().map(|&corner| place[corner as usize]));
    }
}

fn single(p: DVec3) -> [f32; 3] {
    p.to_array().map(|x| x as f32 + 0.0)
}

fn bounds(points: &[[f32; 3]]) -> ([f32; 3], [f32; 3]) {
    let widen = |(low, high): ([f32; 3], [f32; 3]), p: &[f32; 3]| {
        (std::array::from_fn(|i| low[i].min(p[i])), std::array::from_fn(|i| high[i].max(p[i])))
    };
    points.iter().fold(([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]), widen)
}

fn material(color: Color) -> Value {
    let Color { r, g, b } = color;
    let name = format!("#{r:02x}{g:02x}{b:02x}");
    let [r, g, b] = [r, g, b].map(linear);
    json!({
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.7
        }
    })
}

/// sRGB to linear light, the transfer function of IEC 61966-2-1.
fn linear(component: u8) -> f64 {
    let c = f64::from(component) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }
}
