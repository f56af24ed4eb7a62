//! Every format is read back by a small reader that shares no code with its writer.

use std::{
    collections::BTreeMap,
    io::{Cursor, Read},
    sync::Arc,
};

use glam::{DVec3, dvec3};
use serde_json::Value;

use super::{MeshFormat, NamedMesh, WriteError, write};
use crate::geom::{Origin, PolyMesh, Surface, mesh::Color};

const RED: Color = Color { r: 255, g: 0, b: 0 };
const VOLUME: f64 = 3.0;

/// An L of three unit cubes on z = 0: two concave faces, the one on top red. The first corner of both
/// is the concave one.
fn angle() -> PolyMesh {
    let outline = [(1., 1.), (1., 2.), (0., 2.), (0., 0.), (2., 0.), (2., 1.)];
    let ring = |z: f64| outline.iter().map(move |&(x, y)| dvec3(x, y, z));
    let mut mesh = PolyMesh::with_points(ring(0.0).chain(ring(1.0)).collect());
    let plain = mesh.add_origin(Origin::of(Surface::Plane));
    let red =
        Origin { tags: vec![Arc::from("top")], color: Some(RED), ..Origin::of(Surface::Plane) };
    let red = mesh.add_origin(red);
    let mut push = |face: &[u32], origin| {
        let plane = mesh.add_plane();
        mesh.push_face(&[face], plane, origin);
    };
    push(&[0, 5, 4, 3, 2, 1], plain);
    push(&[6, 7, 8, 9, 10, 11], red);
    for i in 0..6 {
        let next = (i + 1) % 6;
        push(&[i, next, next + 6, i + 6], plain);
    }
    mesh
}

/// A bipyramid about z whose equator's last corner is 1e-9 mm off the first: one point in `f32`.
fn needle() -> PolyMesh {
    let top = [dvec3(0., 0., 1.), dvec3(0., 0., -1.)];
    let ring =
        [dvec3(1., 0., 0.), dvec3(0., 1., 0.), dvec3(-1., -1., 0.), dvec3(1. + 1e-9, 0., 0.)];
    let mut mesh = PolyMesh::with_points(top.into_iter().chain(ring).collect());
    let origin = mesh.add_origin(Origin::of(Surface::Facets));
    for i in 0..4u32 {
        let (a, b) = (2 + i, 2 + (i + 1) % 4);
        for face in [[a, b, 0], [b, a, 1]] {
            let plane = mesh.add_plane();
            mesh.push_face(&[face], plane, origin);
        }
    }
    mesh
}

fn written(format: MeshFormat, mesh: &PolyMesh) -> Vec<u8> {
    write(format, &[NamedMesh { name: "an <L> & more", mesh }]).expect("a mesh that fits")
}

type Triangle = [DVec3; 3];

fn volume(triangles: &[Triangle]) -> f64 {
    triangles.iter().map(|[a, b, c]| a.dot(b.cross(*c))).sum::<f64>() / 6.0
}

/// Every directed edge, known by its coordinates, runs as often as its reverse.
fn is_closed(triangles: &[Triangle]) -> bool {
    let bits = |p: DVec3| p.to_array().map(f64::to_bits);
    let mut runs: BTreeMap<_, i32> = BTreeMap::new();
    for t in triangles {
        for i in 0..3 {
            let (a, b) = (bits(t[i]), bits(t[(i + 1) % 3]));
            *runs.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
        }
    }
    runs.values().all(|&n| n == 0)
}

fn check(triangles: &[Triangle], count: usize) {
    assert_eq!(triangles.len(), count);
    assert!(is_closed(triangles));
    assert!((volume(triangles) - VOLUME).abs() < 1e-12);
}

fn fan(points: &[DVec3], corners: &[usize]) -> Vec<Triangle> {
    corners.windows(2).skip(1).map(|w| [corners[0], w[0], w[1]].map(|i| points[i])).collect()
}

fn f32_at(bytes: &[u8], at: usize) -> f64 {
    f64::from(f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()))
}

fn u32_at(bytes: &[u8], at: usize) -> usize {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

fn vector_at(bytes: &[u8], at: usize) -> DVec3 {
    dvec3(f32_at(bytes, at), f32_at(bytes, at + 4), f32_at(bytes, at + 8))
}

fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

fn point(line: &str) -> DVec3 {
    let n = numbers(line);
    dvec3(n[0], n[1], n[2])
}

fn read_binary_stl(bytes: &[u8]) -> Vec<Triangle> {
    assert!(!bytes.starts_with(b"solid"));
    let count = u32_at(bytes, 80);
    assert_eq!(bytes.len(), 84 + 50 * count);
    let triangles: Vec<Triangle> =
        (0..count).map(|i| [12, 24, 36].map(|at| vector_at(bytes, 84 + 50 * i + at))).collect();
    for (i, [a, b, c]) in triangles.iter().enumerate() {
        let normal = (b - a).cross(c - a).normalize_or_zero();
        assert!((vector_at(bytes, 84 + 50 * i) - normal).length() < 1e-6);
    }
    triangles
}

#[test]
fn binary_stl_reads_back() {
    let bytes = written(MeshFormat::Stl, &angle());
    assert!(bytes.starts_with(b"Katachi"));
    check(&read_binary_stl(&bytes), 20);
}

#[test]
fn binary_stl_stays_closed_where_points_become_one() {
    let triangles = read_binary_stl(&written(MeshFormat::Stl, &needle()));
    assert_eq!(triangles.len(), 6);
    assert!(is_closed(&triangles));
}

#[test]
fn ascii_stl_reads_back() {
    let text = String::from_utf8(written(MeshFormat::StlAscii, &angle())).unwrap();
    assert!(text.starts_with("solid an_<L>_&_more\n"));
    let corners: Vec<DVec3> =
        text.lines().filter_map(|l| l.strip_prefix("vertex ")).map(point).collect();
    let triangles: Vec<Triangle> = corners.chunks(3).map(|c| [c[0], c[1], c[2]]).collect();
    check(&triangles, 20);
}

#[test]
fn ascii_stl_keeps_every_bit() {
    let text = String::from_utf8(written(MeshFormat::StlAscii, &needle())).unwrap();
    assert!(text.contains("vertex 1.000000001 0 0"));
}

#[test]
fn obj_reads_back_and_counts_points_through_all_parts() {
    let mesh = angle();
    let parts = [NamedMesh { name: "a", mesh: &mesh }, NamedMesh { name: "b", mesh: &mesh }];
    let text = String::from_utf8(write(MeshFormat::Obj, &parts).unwrap()).unwrap();
    let points: Vec<DVec3> = text.lines().filter_map(|l| l.strip_prefix("v ")).map(point).collect();
    let face = |l: &str| numbers(l).iter().map(|&n| n as usize - 1).collect::<Vec<_>>();
    let faces: Vec<Vec<usize>> =
        text.lines().filter_map(|l| l.strip_prefix("f ")).map(face).collect();
    let triangles: Vec<Triangle> = faces.iter().flat_map(|f| fan(&points, f)).collect();
    assert_eq!(faces.iter().filter(|f| f.len() == 4).count(), 12);
    check(&triangles[..20], 20);
    check(&triangles[20..], 20);
    assert!(text.contains("o b\ng b\n"));
}

#[test]
fn off_reads_back_with_colours() {
    let text = String::from_utf8(written(MeshFormat::Off, &angle())).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("OFF"));
    let counts = numbers(lines.next().unwrap());
    let points: Vec<DVec3> = lines.by_ref().take(counts[0] as usize).map(point).collect();
    let faces: Vec<Vec<f64>> = lines.map(numbers).collect();
    assert_eq!(faces.len(), counts[1] as usize);
    let red = faces.iter().filter(|f| f.ends_with(&[255., 0., 0.]) && f.len() == 7);
    assert_eq!(red.count(), 4);
    let corners = |f: &Vec<f64>| f[1..=f[0] as usize].iter().map(|&i| i as usize).collect();
    let triangles: Vec<Triangle> = faces
        .iter()
        .flat_map(|f| {
            let corners: Vec<usize> = corners(f);
            fan(&points, &corners)
        })
        .collect();
    check(&triangles, 20);
}

#[test]
fn ply_reads_back_with_colours() {
    let bytes = written(MeshFormat::Ply, &angle());
    let end = b"end_header\n";
    let split = bytes.windows(end.len()).position(|w| w == end).unwrap() + end.len();
    let header = std::str::from_utf8(&bytes[..split]).unwrap();
    assert!(header.contains("element vertex 12\n") && header.contains("element face 20\n"));
    let body = &bytes[split..];
    let coordinate = |i: usize| f64::from_le_bytes(body[8 * i..8 * i + 8].try_into().unwrap());
    let points: Vec<DVec3> = (0..12)
        .map(|i| dvec3(coordinate(3 * i), coordinate(3 * i + 1), coordinate(3 * i + 2)))
        .collect();
    let (mut at, mut triangles, mut red) = (12 * 24, vec![], 0);
    while at < body.len() {
        let n = body[at] as usize;
        let corners: Vec<usize> = (0..n).map(|i| u32_at(body, at + 1 + 4 * i)).collect();
        at += 1 + 4 * n;
        red += usize::from(body[at..at + 3] == [255, 0, 0]);
        at += 3;
        triangles.extend(fan(&points, &corners));
    }
    assert_eq!(red, 4);
    check(&triangles, 20);
}

/// The values of an attribute in all elements of a name, in order.
fn attribute(xml: &str, element: &str, name: &str) -> Vec<String> {
    let (open, key) = (format!("<{element} "), format!(" {name}=\""));
    let elements = xml.split(&open).skip(1).filter_map(|rest| rest.split('>').next());
    let value = |e: &str| {
        let spaced = format!(" {e}");
        let value = spaced.split(&key).nth(1)?.split('"').next()?;
        Some(value.to_string())
    };
    elements.filter_map(value).collect()
}

#[test]
fn threemf_reads_back_with_names_and_colours() {
    let (angle, needle) = (angle(), needle());
    let parts =
        [NamedMesh { name: "an <L> & more", mesh: &angle }, NamedMesh { name: "b", mesh: &needle }];
    let bytes = write(MeshFormat::ThreeMf, &parts).unwrap();
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut text = |name: &str| {
        let mut out = String::new();
        archive.by_name(name).unwrap().read_to_string(&mut out).unwrap();
        out
    };
    assert!(text("[Content_Types].xml").contains("3dmanufacturing-3dmodel+xml"));
    assert!(text("_rels/.rels").contains("Target=\"/3D/3dmodel.model\""));
    let xml = text("3D/3dmodel.model");
    assert_well_formed(&xml);
    assert!(xml.contains("unit=\"millimeter\""));
    assert_eq!(attribute(&xml, "object", "name"), ["an &lt;L&gt; &amp; more", "b"]);
    assert_eq!(attribute(&xml, "object", "pindex"), ["0"]);
    assert_eq!(attribute(&xml, "item", "objectid"), ["2", "3"]);
    assert_eq!(attribute(&xml, "base", "displaycolor"), ["#C8C8C8", "#FF0000"]);
    assert_eq!(attribute(&xml, "triangle", "p1"), ["1"; 4]);
    let first = xml.split("</object>").next().unwrap();
    let axes = ["x", "y", "z"].map(|axis| attribute(first, "vertex", axis));
    let corners = ["v1", "v2", "v3"].map(|corner| attribute(first, "triangle", corner));
    let at = |i: usize| dvec3(number(&axes[0][i]), number(&axes[1][i]), number(&axes[2][i]));
    let triangle = |t: usize| [0, 1, 2].map(|k| at(number(&corners[k][t]) as usize));
    check(&(0..corners[0].len()).map(triangle).collect::<Vec<_>>(), 20);
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

fn assert_well_formed(xml: &str) {
    let mut reader = quick_xml::Reader::from_str(xml);
    reader.config_mut().check_end_names = true;
    while reader.read_event().expect("well-formed XML") != quick_xml::events::Event::Eof {}
}

#[test]
fn glb_reads_back_in_metres_with_materials() {
    let bytes = written(MeshFormat::Glb, &angle());
    assert_eq!((&bytes[..4], u32_at(&bytes, 4)), (&b"glTF"[..], 2));
    assert_eq!(u32_at(&bytes, 8), bytes.len());
    let size = u32_at(&bytes, 12);
    assert!(size.is_multiple_of(4) && &bytes[16..20] == b"JSON");
    let document: Value = serde_json::from_slice(&bytes[20..20 + size]).unwrap();
    let chunk = 20 + size;
    assert_eq!(&bytes[chunk + 4..chunk + 8], b"BIN\0");
    let binary = &bytes[chunk + 8..];
    assert_eq!(u32_at(&bytes, chunk), binary.len());
    assert_eq!(document["buffers"][0]["byteLength"].as_u64(), Some(binary.len() as u64));
    assert_eq!(document["nodes"][1]["name"], "an <L> & more");
    let primitives = document["meshes"][0]["primitives"].as_array().unwrap();
    assert_eq!(primitives.len(), 2);
    let names = ["#c8c8c8", "#ff0000"];
    for (primitive, name) in primitives.iter().zip(names) {
        let material = primitive["material"].as_u64().unwrap() as usize;
        assert_eq!(document["materials"][material]["name"], name);
    }
    let triangles: Vec<Triangle> =
        primitives.iter().flat_map(|p| glb_triangles(&document, binary, p)).collect();
    check(&triangles, 20);
    let m: Vec<f64> = serde_json::from_value(document["nodes"][0]["matrix"].clone()).unwrap();
    let image = |p: DVec3| {
        let row = |r: usize| m[r] * p.x + m[4 + r] * p.y + m[8 + r] * p.z + m[12 + r];
        dvec3(row(0), row(1), row(2))
    };
    assert_eq!(image(dvec3(1000., 2000., 3000.)), dvec3(1., 3., -2.));
}

fn glb_triangles(document: &Value, binary: &[u8], primitive: &Value) -> Vec<Triangle> {
    let start = |accessor: &Value| {
        let accessor = &document["accessors"][accessor.as_u64().unwrap() as usize];
        let view = &document["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let start = view["byteOffset"].as_u64().unwrap() as usize;
        (start, accessor["count"].as_u64().unwrap() as usize)
    };
    let (positions, _) = start(&primitive["attributes"]["POSITION"]);
    let (normals, _) = start(&primitive["attributes"]["NORMAL"]);
    let (indices, count) = start(&primitive["indices"]);
    let corner = |i: usize| u32_at(binary, indices + 4 * i);
    (0..count / 3)
        .map(|t| {
            let corners = [0, 1, 2].map(|k| corner(3 * t + k));
            let [a, b, c] = corners.map(|i| vector_at(binary, positions + 12 * i));
            let normal = vector_at(binary, normals + 12 * corners[0]);
            assert!((b - a).cross(c - a).normalize().dot(normal) > 0.999_999);
            [a, b, c]
        })
        .collect()
}

#[test]
fn the_same_mesh_gives_the_same_bytes() {
    for format in MeshFormat::ALL {
        assert_eq!(written(format, &angle()), written(format, &angle()), "{format:?}");
    }
}

#[test]
fn an_empty_part_makes_a_valid_file() {
    for format in MeshFormat::ALL {
        let bytes = written(format, &PolyMesh::default());
        assert!(!bytes.is_empty(), "{format:?}");
    }
}

#[test]
fn what_the_format_cannot_hold_is_refused_with_words() {
    let mut mesh = angle();
    mesh.points[3].y = 1e39;
    let part = NamedMesh { name: "far", mesh: &mesh };
    let error = write(MeshFormat::Stl, &[part]).unwrap_err().to_string();
    assert!(error.contains("part `far`") && error.contains("stl needs"), "{error}");
    assert!(write(MeshFormat::Off, &[part]).is_ok());
    mesh.points[3].y = f64::NAN;
    let part = NamedMesh { name: "far", mesh: &mesh };
    assert!(matches!(write(MeshFormat::Off, &[part]), Err(WriteError::Coordinate { .. })));
}

#[test]
fn names_and_extensions_lead_to_formats() {
    for format in MeshFormat::ALL {
        assert_eq!(MeshFormat::from_name(format.name()), Some(format));
    }
    assert_eq!(MeshFormat::from_extension("STL"), Some(MeshFormat::Stl));
    assert_eq!(MeshFormat::from_extension("3mf"), Some(MeshFormat::ThreeMf));
    assert_eq!(MeshFormat::from_extension("step"), None);
}
