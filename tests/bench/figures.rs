//! The figures of the README: whole runs of the command, from start to finished file.
//!
//! `cargo bench` prints a table; every model stands in `tests/bench/models` or `examples`.

use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
};

fn main() {
    divan::main();
}

/// Runs `katachi` with these arguments and insists on success.
fn katachi(arguments: &[&str]) {
    let status = Command::new(env!("CARGO_BIN_EXE_katachi"))
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .expect("the command starts");
    assert!(status.success(), "katachi {arguments:?} failed");
}

fn build(model: &str) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    katachi(&["build", model, "-o", &folder.path().to_string_lossy()]);
}

#[divan::bench(sample_count = 50)]
fn box_to_stl() {
    build("tests/bench/models/box.kata");
}

#[divan::bench(sample_count = 30)]
fn twelve_cuboid_frame() {
    build("examples/twelve_cuboid_frame.kata");
}

#[divan::bench(sample_count = 5)]
fn menger_level_3() {
    build("tests/bench/models/menger3.kata");
}

#[divan::bench(sample_count = 5)]
fn plate_with_1000_holes() {
    build("tests/bench/models/plate.kata");
}

#[divan::bench(sample_count = 5)]
fn sphere_minus_sphere_100k() {
    build("tests/bench/models/spheres224.kata");
}

#[divan::bench(sample_count = 10)]
fn million_iterations() {
    katachi(&["check", "tests/bench/models/loop.kata"]);
}

#[divan::bench(sample_count = 20)]
fn parse_and_resolve_10000_lines(bencher: divan::Bencher) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("long.kata");
    write_long_model(&file);
    bencher.bench_local(|| katachi(&["params", &file.to_string_lossy()]));
}

/// Ten thousand lines of ordinary bindings, functions and shapes that lean on earlier lines.
fn write_long_model(file: &Path) {
    let mut text = String::from("w0 = 1mm\n");
    for i in 1..2500 {
        let before = i - 1;
        text += &format!("w{i} = w{before} + {}.5mm // a running width\n", i % 7);
        text += &format!("fn rib{i}(length, t = 2mm) = box(length, t, w{i})\n");
        text += &format!("r{i} = {{ d = w{i} / 2, holes = [for k in 0..<3 {{ k * w{i} }}] }}\n");
        text += &format!("s{i} = rib{i}(40 + {i}).move(x = r{i}.d).rotate(z = {}deg)\n", i % 360);
    }
    text += "part first = s1\n";
    fs::write(file, text).expect("the temporary folder can be written");
}
