//! Readers: small samples of each format, what is refused and how, and seeded mutations of the samples.

use std::io::Write;

use glam::{DVec3, dvec3};
use katachi::{
    geom::{EdgeCurve, PolyMesh, Tolerance},
    input::{Data, read_data, read_mesh, read_profile, weld},
};

const OFF: &str = "COFF # a pyramid\n5 5 8\n0 0 0 255 0 0 255\n2 0 0\n2 2 0\n0 2 0\n1 1 1\n\
    4 0 3 2 1 255 128 0\n3 0 1 4 1.0 0.5 0.0\n3 1 2 4\n3 2 3 4\n3 3 0 4\n";

const OBJ: &str = "# pyramid\nmtllib a.mtl\no pyramid\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 1 1.1\nvn 0 0 1\n\
    usemtl red\nf 1//1 4//1 3//1 2//1\nf 1 2 5\ng side\nf -4 -3 -1\nf 3 4 5\nf 4 1 5\n";

const PLY: &str = "ply\nformat ascii 1.0\ncomment a pyramid\nelement vertex 5\nproperty float x\nproperty float y\n\
    property float z\nproperty uchar red\nelement face 5\nproperty list uchar int vertex_indices\n\
    property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n0 0 0 9\n2 0 0 9\n2 2 0 9\n\
    0 2 0 9\n1 1 1 9\n4 0 3 2 1 255 128 0\n3 0 1 4 1 2 3\n3 1 2 4 1 2 3\n3 2 3 4 1 2 3\n3 3 0 4 1 2 3\n";

const MODEL: &str = r##"<?xml version="1.0" encoding="UTF-8"?>
<model unit="centimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<resources><basematerials id="1"><base name="orange" displaycolor="#FF8000FF"/></basematerials>
<object id="2" type="model" name="pyramid" pid="1" pindex="0"><mesh><vertices>
<vertex x="0" y="0" z="0"/><vertex x="2" y="0" z="0"/><vertex x="2" y="2" z="0"/><vertex x="0" y="2" z="0"/>
<vertex x="1" y="1" z="1"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="3" v3="2"/>
<triangle v1="0" v2="1" v3="4"/><triangle v1="1" v2="2" v3="4"/><triangle v1="2" v2="3" v3="4"/>
<triangle v1="3" v2="0" v3="4"/></triangles></mesh></object>
<object id="3"><components><component objectid="2"/>
<component objectid="2" transform="-1 0 0 0 1 0 0 0 1 -5 0 0"/></components></object></resources>
<build><item objectid="3" transform="1 0 0 0 1 0 0 0 1 10 0 0"/></build></model>"##;

const SVG: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="20mm" viewBox="0 0 400 200">
<rect x="10" y="20" width="100" height="50"/><path d="M200 100 h100 v50 h-100 z M220 110 h20 v20 h-20 z" fill-rule="evenodd"/>
<circle cx="350" cy="50" r="40" fill="red"/><path d="M0 0 L10 10" fill="none" stroke="black"/></svg>"##;

/// Code and value pairs from words.
fn dxf(words: &str) -> String {
    words.split_whitespace().map(|w| format!("{w}\n")).collect()
}

fn dxf_sample() -> String {
    dxf("0 SECTION 2 HEADER 9 $INSUNITS 70 5 0 ENDSEC \
        0 SECTION 2 BLOCKS 0 BLOCK 2 hole 10 1 20 1 0 CIRCLE 10 1 20 1 40 0.5 0 ENDBLK 0 ENDSEC \
        0 SECTION 2 ENTITIES \
        0 LINE 10 0 20 0 11 10 21 0 0 LINE 10 10 20 10 11 10 21 0 0 LINE 10 10 20 10 11 0 21 10 \
        0 ARC 10 0 20 5 40 5 50 90 51 270 \
        0 LWPOLYLINE 70 1 10 20 20 0 42 1 10 24 20 0 42 1 \
        0 ELLIPSE 10 40 20 0 11 4 21 0 40 0.5 41 0 42 6.283185307179586 \
        0 SPLINE 71 2 70 1 40 0 40 0 40 0 40 1 40 1 40 1 10 60 20 0 10 62 20 4 10 64 20 0 \
        0 POLYLINE 70 1 0 VERTEX 10 80 20 0 0 VERTEX 10 82 20 0 0 VERTEX 10 82 20 2 0 SEQEND \
        0 INSERT 2 hole 10 3 20 3 41 2 42 2 70 2 71 1 44 3 0 TEXT 1 hi 0 ENDSEC 0 EOF")
}

fn binary_ply(big: bool) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let head = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement vertex 4\nproperty double x\nproperty float y\n\
         property short z\nelement face 4\nproperty list uchar uint vertex_index\nend_header\n"
    );
    let mut bytes = head.into_bytes();
    let mut put = |b: &[u8]| {
        if big { bytes.extend(b.iter().rev()) } else { bytes.extend(b) }
    };
    for (x, y, z) in [(0., 0., 0), (1., 0., 0), (0., 1., 0), (0., 0., 1_i16)] {
        put(&f64::to_le_bytes(x));
        put(&f32::to_le_bytes(y));
        put(&z.to_le_bytes());
    }
    for face in [[0_u32, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        put(&[3]);
        face.iter().for_each(|c| put(&c.to_le_bytes()));
    }
    bytes
}

fn zipped(model: &str) -> Vec<u8> {
    let mut writer = zip::ZipWriter::new(std::io::Cursor::new(vec![]));
    writer.start_file("3D/3dmodel.model", zip::write::SimpleFileOptions::default()).unwrap();
    writer.write_all(model.as_bytes()).unwrap();
    writer.finish().unwrap().into_inner()
}

fn binary_stl() -> Vec<u8> {
    let mut bytes = vec![b's'; 80];
    bytes.extend(2_u32.to_le_bytes());
    for value in 0..24 {
        bytes.extend(if value % 12 < 3 { 0.0_f32 } else { (value % 7) as f32 }.to_le_bytes());
        if value % 12 == 11 {
            bytes.extend([0, 0]);
        }
    }
    bytes
}

const ASCII_STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
    endloop\nendfacet\nendsolid a\n";

/// Six times the volume under the faces, fans being enough for convex ones.
fn volume(mesh: &PolyMesh) -> f64 {
    let fan = |corners: &[u32]| -> f64 {
        let p: Vec<DVec3> = corners.iter().map(|&c| mesh.points[c as usize]).collect();
        (1..p.len() - 1).map(|i| p[0].dot(p[i].cross(p[i + 1]))).sum()
    };
    mesh.faces().flat_map(|f| f.loops()).map(fan).sum::<f64>() / 6.0
}

#[test]
fn a_pyramid_comes_out_of_every_format() {
    for (name, bytes, height) in [
        ("a.off", OFF.as_bytes(), 1.0),
        ("a.OBJ", OBJ.as_bytes(), 1.1),
        ("b/a.ply", PLY.as_bytes(), 1.0),
    ] {
        let mesh = read_mesh(name, bytes).unwrap();
        assert_eq!((mesh.points.len(), mesh.face_count()), (5, 5), "{name}");
        assert!((volume(&mesh) - height * 4.0 / 3.0).abs() < 1e-12, "{name}");
    }
    let color = read_mesh("a.off", OFF.as_bytes()).unwrap().face(0).origin().color.unwrap();
    assert_eq!((color.r, color.g, color.b), (255, 128, 0));
    let tags = read_mesh("a.obj", OBJ.as_bytes()).unwrap().face(0).origin().tags.clone();
    assert_eq!(tags[0].as_ref(), "pyramid");
}

#[test]
fn both_byte_orders_of_ply() {
    for big in [false, true] {
        let mesh = read_mesh("a.ply", &binary_ply(big)).unwrap();
        assert!((volume(&mesh) - 1.0 / 6.0).abs() < 1e-12);
    }
}

#[test]
fn units_components_and_mirrors_of_3mf() {
    let mesh = read_mesh("a.3mf", &zipped(MODEL)).unwrap();
    assert_eq!((mesh.points.len(), mesh.face_count()), (10, 12));
    assert!((volume(&mesh) - 2.0 * 4000.0 / 3.0).abs() < 1e-9, "{}", volume(&mesh));
    let least = mesh.points.iter().copied().reduce(DVec3::min).unwrap();
    assert_eq!(least, dvec3(30.0, 0.0, 0.0));
    let color = mesh.face(0).origin().color.unwrap();
    assert_eq!((color.r, color.g, color.b), (255, 128, 0));
}

#[test]
fn points_of_no_face_are_left_out() {
    let stray =
        OFF.replace("5 5 8", "6 5 8").replace("1 1 1\n", "9 9 9\n1 1 1\n").replace(" 4\n", " 5\n");
    let stray = stray.replace("1 4 1.0", "1 5 1.0");
    let mesh = read_mesh("a.off", stray.as_bytes()).unwrap();
    assert_eq!(mesh, read_mesh("a.off", OFF.as_bytes()).unwrap());
    let point = "OFF\n3 1 0\n1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n";
    assert_eq!(
        mesh_error("a.off", point),
        "OFF: no faces; a mesh with at least one face is needed"
    );
}

#[test]
fn healing_welds_near_points() {
    let cracked = OFF
        .replace("5 5 8", "6 5 8")
        .replace("1 1 1\n", "1 1 1\n1 1 1.004\n")
        .replace("3 3 0 4", "3 3 0 5");
    let mesh = read_mesh("a.off", cracked.as_bytes()).unwrap();
    assert_eq!(mesh.points.len(), 6);
    assert_eq!(weld(&mesh, 0.01).points.len(), 5);
    assert_eq!(weld(&mesh, 0.001).points.len(), 6);
}

#[test]
fn svg_lengths_are_millimetres_and_y_points_up() {
    let figure = read_profile("a.svg", SVG.as_bytes(), Tolerance::DEFAULT).unwrap();
    let pieces = &figure.region.pieces;
    assert_eq!(pieces.len(), 3);
    let corner = pieces[0].outer.points[0];
    assert!((corner.x - 1.0).abs() < 1e-4 && (corner.y - 13.0).abs() < 1e-4, "{corner}");
    assert_eq!(pieces[1].holes.len(), 1);
    let expected = 50.0 + 46.0 + std::f64::consts::PI * 16.0;
    assert!((figure.region.area() - expected).abs() < 1.0, "{}", figure.region.area());
    assert_eq!(figure.notes, ["1 strokes are left out: only fills count"]);
}

#[test]
fn dxf_outlines_are_joined_and_blocks_placed() {
    let fine = Tolerance::new(1e-4).unwrap();
    let figure = read_profile("a.dxf", dxf_sample().as_bytes(), fine).unwrap();
    let pi = std::f64::consts::PI;
    // Plate with a round end less two holes; a disc; an ellipse; a parabola; a triangle: in cm.
    let expected = 100.0 + 12.5 * pi - 2.0 * pi + 4.0 * pi + 8.0 * pi + 16.0 / 3.0 + 2.0;
    assert!((figure.region.area() / 100.0 - expected).abs() < 1e-3, "{}", figure.region.area());
    assert_eq!(figure.region.pieces.len(), 5);
    assert_eq!(figure.notes, ["1 TEXT left out"]);
    let round = |c: &EdgeCurve| matches!(c, EdgeCurve::Circle { radius, .. } if (*radius - 10.0).abs() < 1e-9);
    assert!(figure.region.pieces[0].holes[0].curves.iter().all(round));
}

/// The area of a drawing, or why it is not read.
fn drawn(name: &str, text: &str) -> Result<f64, String> {
    let figure = read_profile(name, text.as_bytes(), Tolerance::DEFAULT);
    figure.map(|figure| figure.region.area()).map_err(|error| error.to_string())
}

#[test]
fn curves_that_need_too_many_chords_are_refused() {
    let entities = |words: &str| dxf(&format!("0 SECTION 2 ENTITIES {words} 0 ENDSEC 0 EOF"));
    let large = [
        entities("0 CIRCLE 10 0 20 0 40 1e8"),
        entities("0 ELLIPSE 10 0 20 0 11 1e8 21 0 40 0.5"),
        entities("0 LWPOLYLINE 70 1 10 0 20 0 42 1 10 1e8 20 0"),
        entities(
            "0 SPLINE 71 2 70 1 40 0 40 0 40 0 40 1 40 1 40 1 10 0 20 0 10 1e9 20 2e9 10 2e9 20 0",
        ),
        dxf("0 SECTION 2 BLOCKS 0 BLOCK 2 b 10 0 20 0 0 CIRCLE 10 0 20 0 40 1 0 ENDBLK 0 ENDSEC \
             0 SECTION 2 ENTITIES 0 INSERT 2 b 10 0 20 0 41 1 42 1e8 0 ENDSEC 0 EOF"),
    ];
    for text in large {
        let said = drawn("a.dxf", &text).expect_err(&text);
        assert!(said.contains("chords at this tolerance is beyond the limit of"), "{said}");
    }
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\">\
               <path d=\"M0 0 C0 1e10 1e10 2e10 1e10 0 z\"/></svg>";
    let said = drawn("a.svg", svg).expect_err(svg);
    assert!(said.starts_with("SVG: a curve of") && said.contains("limit of 16384"), "{said}");
}

/// A slice of a circle of a hundred kilometres: few chords, for it is nearly straight.
#[test]
fn a_small_part_of_a_large_circle_is_read() {
    let text = dxf(
        "0 SECTION 2 ENTITIES 0 LWPOLYLINE 70 1 10 0 20 0 42 0.001 10 1000 20 0 0 ENDSEC 0 EOF",
    );
    let (half, height) = (500.0, 0.5);
    let area = drawn("a.dxf", &text).expect("read");
    assert!((area - 4.0 / 3.0 * half * height).abs() < 0.05 * 1000.0, "{area}");
}

#[test]
fn values_of_json_and_csv() {
    let Ok(Data::Record(fields)) = read_data("a.json", br#"{"b": [1, null], "a": "x"}"#) else {
        panic!()
    };
    assert_eq!(fields[0], ("b".into(), Data::List(vec![Data::Number(1.0), Data::Null])));
    let Ok(Data::List(rows)) =
        read_data("a.csv", "\u{feff}d, name\n5,\"M5, long\"\n-1e3,\n".as_bytes())
    else {
        panic!()
    };
    let row = |d, name: &str| {
        Data::Record(vec![("d".into(), Data::Number(d)), ("name".into(), Data::Text(name.into()))])
    };
    assert_eq!(rows, [row(5.0, "M5, long"), row(-1000.0, "")]);
}

fn mesh_error(name: &str, text: &str) -> String {
    read_mesh(name, text.as_bytes()).unwrap_err().to_string()
}

#[test]
fn refusals_say_what_where_and_what_is_needed() {
    assert_eq!(
        mesh_error("a.step", ""),
        "\"a.step\" is in no known format; files that end in .stl, .obj, .off, .ply or .3mf can be read"
    );
    assert_eq!(
        mesh_error("a.off", &OFF.replace("3 1 2 4", "3 1 2 5")),
        "OFF line 10: point \"5\"; a number below 5 is needed, there are so many points"
    );
    assert_eq!(
        mesh_error("a.off", &OFF.replace("1 1 1\n", "1 1 nan\n")),
        "OFF line 7: \"nan\"; a finite number is needed"
    );
    assert_eq!(
        mesh_error("a.off", "OFF\n4000000000 1 0\n"),
        "OFF: 4000000000 points and 1 faces announced in 2 lines; each takes a line"
    );
    assert!(
        mesh_error("a.obj", &OBJ.replace("v 2 2 0", "v 2 x 0"))
            .starts_with("OBJ line 6: position parse error")
    );
    assert_eq!(
        mesh_error("a.obj", &OBJ.replace("f 3 4 5", "f 3 4 9")),
        "OBJ line 15: a face with \"9\"; there are 5 points, counted from 1"
    );
    assert!(
        mesh_error("a.ply", &PLY.replace("vertex 5", "vertex 4000000000"))
            .contains("bytes that are left cannot hold them")
    );
    assert!(
        mesh_error("a.ply", &PLY.replace("3 2 3 4", "3 2 3 -1")).contains("a face with point -1")
    );
    assert!(mesh_error("a.3mf", "rubbish").starts_with("3MF: "));
    let cyclic =
        zipped(&MODEL.replace("<component objectid=\"2\"/>", "<component objectid=\"3\"/>"));
    let error = read_mesh("a.3mf", &cyclic).unwrap_err().to_string();
    assert!(error.ends_with("objectid=\"3\"; an object that came before is needed"), "{error}");
}

#[test]
fn refusals_of_drawings_and_values() {
    let profile = |name: &str, text: &str| {
        read_profile(name, text.as_bytes(), Tolerance::DEFAULT).unwrap_err().to_string()
    };
    assert!(profile("a.svg", "<svg").starts_with("SVG: "));
    assert!(
        profile("a.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"5\" height=\"5\"/>")
            .contains("no filled shapes")
    );
    let open = dxf_sample()
        .replace("11\n10\n21\n0\n0\nLINE\n10\n10\n20\n10\n11\n10\n21\n0", "11\n10\n21\n0");
    assert!(
        profile("a.dxf", &open).contains("100 mm apart; its ends must meet"),
        "{}",
        profile("a.dxf", &open)
    );
    let own = dxf(
        "0 SECTION 2 BLOCKS 0 BLOCK 2 a 0 INSERT 2 a 70 1000 71 1000 0 ENDBLK 0 ENDSEC 0 SECTION 2 ENTITIES 0 INSERT 2 a 0 ENDSEC",
    );
    assert!(profile("a.dxf", &own).contains("nested deeper than 32"), "{}", profile("a.dxf", &own));
    let data = |name: &str, text: &str| read_data(name, text.as_bytes()).unwrap_err().to_string();
    assert_eq!(
        data("a.json", "{\n\"a\": 1,\n\"a\": 2}"),
        "JSON line 3: the name \"a\" for the second time; well-formed JSON is needed (column 7)"
    );
    assert!(data("a.json", &"[".repeat(10_000)).contains("recursion limit"));
    assert_eq!(
        data("a.csv", "a,b\n1,2\n1\n"),
        "CSV line 3: a row of 1 cells; the first line names 2 columns"
    );
    assert!(data("a.csv", "a,a\n").contains("\"a\""));
}

#[test]
fn a_zip_bomb_of_components_is_refused() {
    let mut objects = String::new();
    for id in 3..60 {
        let component = format!("<component objectid=\"{}\"/>", id - 1);
        objects += &format!(
            "<object id=\"{id}\"><components>{component}{component}{component}</components></object>"
        );
    }
    let start = MODEL.find("<object id=\"3\"").unwrap();
    let end = MODEL.find("</resources>").unwrap();
    let model = format!("{}{objects}{}", &MODEL[..start], &MODEL[end..])
        .replace("item objectid=\"3\"", "item objectid=\"59\"");
    let error = read_mesh("a.3mf", &zipped(&model)).unwrap_err().to_string();
    assert!(error.contains("beyond the limit"), "{error}");
}

/// Splitmix64 (Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n.max(1) as u64) as usize
    }
}

/// Changes, takes out, repeats and cuts bytes.
fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        let end = (at + random.below(12)).min(bytes.len());
        match random.below(6) {
            0 if !bytes.is_empty() => bytes[at] = random.below(256) as u8,
            1 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
            2 => drop(bytes.drain(at..end)),
            3 => {
                let part = bytes[at..end].to_vec();
                let to = random.below(bytes.len());
                drop(bytes.splice(to..to, part));
            }
            4 => {
                let numbers =
                    ["-1", "4294967296", "1e309", "1e-320", "nan", "0", "99999999", "3", " "];
                drop(bytes.splice(at..end, numbers[random.below(numbers.len())].bytes()));
            }
            _ => bytes.truncate(bytes.len() - random.below(20).min(bytes.len())),
        }
    }
}

#[test]
fn mutated_files_are_read_or_refused() {
    let meshes: [(&str, Vec<u8>); 8] = [
        ("a.off", OFF.into()),
        ("a.obj", OBJ.into()),
        ("a.ply", PLY.into()),
        ("a.ply", binary_ply(true)),
        ("a.stl", binary_stl()),
        ("a.stl", ASCII_STL.into()),
        ("a.3mf", zipped(MODEL)),
        ("a.3mf", MODEL.into()),
    ];
    let others: [(&str, Vec<u8>); 4] = [
        ("a.svg", SVG.into()),
        ("a.dxf", dxf_sample().into()),
        ("a.json", br#"{"b": [1, null, -2.5e3], "a": "x\u00e4", "c": {"d": true}}"#.to_vec()),
        ("a.csv", b"d,name\n5,\"M5, long\"\n-1e3,x\n".to_vec()),
    ];
    let mut random = Random(1);
    for round in 0..2000 {
        for (name, sample) in &meshes {
            let mut bytes = sample.clone();
            mutate(&mut bytes, &mut random);
            // The XML of a 3MF file is mutated inside its archive too.
            let inner = *sample == MODEL.as_bytes();
            let bytes = if inner { zipped(&String::from_utf8_lossy(&bytes)) } else { bytes };
            if let Ok(mesh) = read_mesh(name, &bytes) {
                assert!(mesh.points.iter().all(|p| p.is_finite()) && !mesh.is_empty(), "{round}");
            }
        }
        for (name, sample) in &others {
            let mut bytes = sample.clone();
            mutate(&mut bytes, &mut random);
            match read_profile(name, &bytes, Tolerance::DEFAULT) {
                Ok(figure) => assert!(figure.region.area() > 0.0, "{round}"),
                Err(_) => drop(read_data(name, &bytes)),
            }
        }
    }
}

#[test]
fn drawings_that_multiply_themselves_are_refused() {
    let head = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\">";
    let mut uses = format!("{head}<defs><rect id=\"a0\" width=\"5\" height=\"5\"/>");
    for level in 1..30 {
        let one = format!("<use href=\"#a{}\"/>", level - 1);
        uses += &format!("<g id=\"a{level}\">{}</g>", one.repeat(10));
    }
    uses += "</defs><use href=\"#a29\"/></svg>";
    assert!(read_profile("a.svg", uses.as_bytes(), Tolerance::DEFAULT).is_err());
    let deep = format!(
        "{head}{}<rect width=\"5\" height=\"5\"/>{}</svg>",
        "<g>".repeat(50_000),
        "</g>".repeat(50_000)
    );
    assert!(read_profile("a.svg", deep.as_bytes(), Tolerance::DEFAULT).is_err());
}
