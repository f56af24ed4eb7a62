//! Views and sheets from the language to files: what is measured, what is written, and that it is the same every time.

use std::{fs, path::Path};

use serde_json::Value;

use super::errors::run;

/// A plate with 100 holes, seen from the front, and stairs.
const MODEL: &str = "
holes = for i in 0..<10 { for j in 0..<10 { cylinder(d = 8, h = 10).move(x = 12 * i - 54, y = 12 * j - 54) } }
plate = box(120, 120, 10) - holes
stairs = for i in 0..<5 { box(from = [10 * i, 0, 0], to = [10 * i + 10, 30, 10 * (i + 1)]) }
view front = plate.view(from = FRONT)
view iso = union(stairs).view(from = ISO, hidden = DASHED)
view donut = torus(30, 10).view(from = [0, -86.60254037844386, 50])
view cut = [plate, sphere(9)].section({ at = [0, 0, 5], normal = TOP }).center_lines()
sheet big = page(A3, landscape = true).place(front, at = [100, 200]).title(\"A < B & \\\"C\\\"\")
export \"both.pdf\" = { cut, iso }
export \"front.dxf\" = front
";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("model.kata"), MODEL).expect("writable");
    folder
}

/// Names and bytes of what a build with so many threads writes.
fn build(folder: &Path, jobs: &str) -> Vec<(String, Vec<u8>)> {
    let out = format!("out{jobs}");
    let output = run(folder, &["build", "model.kata", "-o", &out, "-j", jobs]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{said}");
    let entries = fs::read_dir(folder.join(&out)).expect("readable");
    let mut files: Vec<_> = entries
        .map(|entry| {
            let entry = entry.expect("readable");
            let name = entry.file_name().to_string_lossy().into_owned();
            (name, fs::read(entry.path()).expect("readable"))
        })
        .collect();
    files.sort();
    files
}

#[test]
fn views_are_measured() {
    let folder = folder();
    let output = run(folder.path(), &["measure", "model.kata", "--json"]);
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let measured = |view: &str, what: &str| value["views"][view][what].as_f64().expect("a number");
    let near = |found: f64, needed: f64| (found - needed).abs() < 1e-5 * needed;
    assert!(near(measured("front", "visible"), 260.0), "{value}");
    assert!(near(measured("front", "hidden"), 200.0), "{value}");
    assert!(near(measured("iso", "visible"), 390.0 * (2.0f64 / 3.0).sqrt()), "{value}");
    assert!(near(measured("donut", "visible"), 291.784), "{value}");
    // The rim and one hidden line for each side of a row of holes.
    assert_eq!(measured("front", "segments"), 4.0 + 20.0);
    assert!(value["views"].get("big").is_none());
}

#[test]
fn the_same_files_on_one_thread_and_two() {
    let folder = folder();
    let (one, two) = (build(folder.path(), "1"), build(folder.path(), "2"));
    let names: Vec<&str> = one.iter().map(|(name, _)| &**name).collect();
    let expected = ["big.svg", "both-cut.pdf", "both-iso.pdf", "donut.svg", "front.dxf"];
    assert_eq!(names, expected);
    assert!(one == two);
    let text = |name: &str| {
        let (_, bytes) = one.iter().find(|file| file.0 == name).expect("written");
        String::from_utf8_lossy(bytes).into_owned()
    };
    let page = text("big.svg");
    assert!(page.contains("width=\"420mm\"") && page.contains("class=\"frame\""));
    usvg::Tree::from_str(&page, &usvg::Options::default()).expect("an SVG");
    assert!(text("front.dxf").contains("LWPOLYLINE") && text("both-cut.pdf").starts_with("%PDF"));
}

/// Bytes of all files of an example in a format, made with so many threads.
fn drawn(example: &str, format: &str, jobs: &str) -> Vec<(String, Vec<u8>)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let out = tempfile::tempdir().expect("a temporary folder");
    let (file, to) = (format!("examples/{example}"), out.path().to_str().expect("plain"));
    let output = run(root, &["build", &file, "--format", format, "-o", to, "-j", jobs]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let entries = fs::read_dir(out.path()).expect("readable");
    let mut files: Vec<_> = entries
        .map(|entry| entry.expect("readable").path())
        .map(|path| (path.display().to_string(), fs::read(&path).expect("readable")))
        .map(|(path, bytes)| (path.rsplit('/').next().unwrap_or_default().to_string(), bytes))
        .collect();
    files.sort();
    files
}

#[test]
fn every_drawn_example_is_the_same_on_one_thread_and_two() {
    let mut count = 0;
    for example in super::examples::models() {
        let text = fs::read_to_string(super::examples::folder().join(&example)).expect("readable");
        if !text.lines().any(|line| line.starts_with("view ") || line.starts_with("sheet ")) {
            continue;
        }
        for format in ["svg", "dxf", "pdf"] {
            let one = drawn(&example, format, "1");
            count += usize::from(one.iter().any(|(name, _)| name.ends_with(format)));
            assert!(one == drawn(&example, format, "2"), "{example} {format}");
        }
    }
    assert!(count >= 9, "{count} drawings");
}

#[test]
fn drawings_come_back_as_profiles() {
    let folder = folder();
    let view = ["view", "model.kata", "--from", "TOP", "-o", "top.dxf"];
    assert!(!run(folder.path(), &view).status.success(), "the model has no part");
    let part = "part p = box(40, 30, 5)";
    fs::write(folder.path().join("part.kata"), part).expect("writable");
    for file in ["top.svg", "top.dxf"] {
        let output = run(folder.path(), &["view", "part.kata", "--from", "TOP", "-o", file]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), file);
    }
    let back =
        "assert near(area(import(\"top.dxf\")), 1200mm^2)\npart q = import(\"top.dxf\").extrude(1)";
    fs::write(folder.path().join("back.kata"), back).expect("writable");
    let output = run(folder.path(), &["measure", "back.kata"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_mesh_is_drawn_ad_hoc() {
    let folder = folder();
    fs::write(folder.path().join("part.kata"), "part p = box(40, 30, 5)").expect("writable");
    run(folder.path(), &["build", "part.kata", "-o", "."]);
    let arguments = ["view", "p.stl", "--from", "1,-2,1", "--hidden", "dashed", "-o", "p.pdf"];
    let output = run(folder.path(), &arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(folder.path().join("p.pdf").exists());
    for bad in [["--from", "SIDE"], ["--hidden", "some"], ["--eye", "0,0,0"], ["-o", "p.png"]] {
        let output = run(folder.path(), &["view", "p.stl", bad[0], bad[1]]);
        assert_eq!(output.status.code(), Some(2), "{bad:?}");
    }
}

/// A sheet with a half-tone of each kind, one at another scale.
const HALFTONES: &str = "
part ball = sphere(10)
front = ball.view(from = FRONT)
fn lit(screen) = ball.shade(from = RIGHT, shadow = NONE, screen = screen, dpi = 127)
dotted = lit(dots(pitch = 1mm))
shade hero = dotted
sheet mixed = page(A4)
    .place(front, at = [100, 250]).place(dotted, beside = front)
    .place(dotted, at = [60, 200], scale = 2).place(lit(hatch()), at = [120, 200])
    .place(lit(GREY), at = [160, 200]).place(lit(overstrike()), at = [60, 120])
";

#[test]
fn half_tones_stand_on_pages() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("m.kata"), HALFTONES).expect("writable");
    let made = |format: &str, jobs: &str| {
        let build = ["build", "m.kata", "--format", format, "-o", jobs, "-j", jobs];
        let output = run(folder.path(), &build);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let read = |name: &str| {
            let file = folder.path().join(jobs).join(format!("{name}.{format}"));
            String::from_utf8_lossy(&fs::read(file).expect("written")).into_owned()
        };
        [read("mixed"), read("hero")]
    };
    for format in ["svg", "pdf", "dxf"] {
        assert!(made(format, "1") == made(format, "2"), "{format}");
    }
    let [mixed, hero] = made("svg", "1");
    let tree = usvg::Tree::from_str(&mixed, &usvg::Options::default()).expect("an SVG");
    assert!(!tree.clip_paths().is_empty());
    for class in ["tone", "dots", "strokes", "areas"] {
        assert!(mixed.contains(&format!("class=\"{class}\"")), "{class}");
    }
    assert_eq!(mixed.matches("<image").count(), 1);
    // Twice as large it has four times as many dots of the same pitch.
    let (one, all) = (hero.matches("<circle").count(), mixed.matches("<circle").count());
    assert!((all as f64 / one as f64 - 5.0).abs() < 0.2, "{all} of {one}");
    assert!(hero.contains("width=\"21.2mm\""), "{}", &hero[..300]);
    let [mixed, _] = made("pdf", "1");
    assert_eq!(mixed.matches("/Subtype /Image").count(), 1);
    let [mixed, hero] = made("dxf", "1");
    // The outline of the ball in its view is a circle too.
    assert!(mixed.matches("CIRCLE").count() == all + 1 && hero.matches("CIRCLE").count() == one);
    assert!(mixed.contains("picture of pixels"));
}

/// The length of the straight lines in a layer of an SVG file.
fn length_of(svg: &str, layer: &str) -> f64 {
    let start = svg.find(&format!("<g class=\"{layer}\"")).expect("the layer is there");
    let group = svg[start..].split("</g>").next().unwrap_or_default();
    let data = group.split(" d=\"").skip(1).filter_map(|rest| rest.split('"').next());
    data.map(|data| {
        let points: Vec<Vec<f64>> = data
            .split(['M', 'L', 'Z'])
            .filter(|point| !point.is_empty())
            .map(|point| point.split(' ').map(|x| x.parse().expect("a number")).collect())
            .collect();
        let mut ends: Vec<_> = points.windows(2).map(|p| (&p[0], &p[1])).collect();
        if data.ends_with('Z') {
            ends.push((&points[points.len() - 1], &points[0]));
        }
        ends.iter().map(|(p, q)| libm::hypot(p[0] - q[0], p[1] - q[1])).sum::<f64>()
    })
    .sum()
}

#[test]
fn shadows_in_views_are_outlined_and_filled() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let model = "
part cube = box(10, 10, 10)
over = box(10, 10, 2).move(z = 20)
view on_ground = cube.view(from = TOP, light = sun([-1, 0, 1]), shadow = ground())
view on_plate = [box(60, 60, 2).move(z = -2), cube].view(from = TOP, light = sun([-1, 0, 1]))
view under = [cube, over].view(from = TOP, hidden = DASHED, light = sun([0, 0, 1]), style = { hatch_pitch = 1mm })
";
    fs::write(folder.path().join("m.kata"), model).expect("writable");
    let output = run(folder.path(), &["build", "m.kata"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let svg = |name: &str| {
        fs::read_to_string(folder.path().join(format!("out/{name}.svg"))).expect("written")
    };
    // Three sides beside the cube, and the square in lines 1.5 mm apart.
    for name in ["on_ground", "on_plate"] {
        let length = length_of(&svg(name), "shadow");
        assert!((length - 30.0 - 100.0 / 1.5).abs() < 3.0, "{name}: {length}");
    }
    assert!(!svg("under").contains("class=\"shadow\""), "hidden shadows are not drawn");
}

#[test]
fn figures_on_faces_are_lines_over_tones() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let model = "
die = box(10, 10, 10).draw_on(TOP, circle(3)).draw_on(BOTTOM, circle(2))
shade lit = die.shade(from = TOP, shadow = NONE, light = sun([0, 0, 1]))
export \"lit.svg\" = lit
export \"lit.png\" = lit
";
    fs::write(folder.path().join("m.kata"), model).expect("writable");
    let output = run(folder.path(), &["build", "m.kata"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let svg = fs::read_to_string(folder.path().join("out/lit.svg")).expect("written");
    let pattern = svg.split("class=\"pattern\"").nth(1).expect("a layer");
    // One circle of two or three arcs, and not the one below.
    assert!(pattern.contains("A3 3 ") && !pattern.contains("A2 2 "), "{pattern}");
    assert!(!svg.contains("class=\"visible\""));
    // The same in pixels: all white but for the circle.
    let file = fs::File::open(folder.path().join("out/lit.png")).expect("written");
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a picture");
    let mut samples = vec![0; reader.output_buffer_size().expect("small")];
    reader.next_frame(&mut samples).expect("pixels");
    assert!(samples.iter().any(|&s| s < 50) && samples[samples.len() / 2] > 200);
}

#[test]
fn pictures_are_printed_in_characters() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let part = "part ball = sphere(10)\n";
    let shade = "shade top = box(10, 20, 5).shade(from = TOP, light = sun([0, 1, 1]))\n";
    fs::write(folder.path().join("part.kata"), part).expect("writable");
    fs::write(folder.path().join("shade.kata"), format!("{part}{shade}")).expect("writable");
    fs::write(folder.path().join("none.kata"), "x = 1\n").expect("writable");
    let printed = |arguments: &[&str]| {
        let output = run(folder.path(), arguments);
        (output.status.success(), String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let (ok, ball) = printed(&["view", "part.kata", "--text", "--columns", "40"]);
    let widths = || ball.lines().map(|line| line.chars().count());
    assert!(ok && widths().max() > Some(34) && widths().max() <= Some(40), "{ball}");
    // As high as wide: characters are twice as high.
    assert!((19..=20).contains(&ball.lines().count()), "{ball}");
    let mut signs: Vec<char> = ball.chars().filter(|c| *c != '\n').collect();
    signs.sort_unstable();
    signs.dedup();
    assert!((15..=20).contains(&signs.len()), "{signs:?}");
    let (ok, shade) = printed(&["view", "shade.kata", "--text", "--columns", "30"]);
    // A half-tone comes before parts: a box seen from above, twice as long as wide.
    assert!(ok && shade.lines().count() > 24, "{shade}");
    assert!(!printed(&["view", "none.kata", "--text"]).0);
    assert!(!printed(&["view", "part.kata", "--text", "-o", "x.svg"]).0);
    assert!(!printed(&["view", "part.kata", "--columns", "40"]).0);
}
