//! The command as a process: exit codes, files, streams.

use std::{
    fs,
    io::Write,
    path::Path,
    process::{Output, Stdio},
};

use serde_json::Value;
use tempfile::TempDir;

use super::errors::{katachi, run};

fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("writable");
    }
    folder
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("the command ends by itself")
}

fn err(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn out(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn names(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else { return vec![] };
    let mut names: Vec<String> =
        entries.map(|e| e.expect("readable").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Runs and expects an exit code and words on standard error.
fn refused(folder: &Path, arguments: &[&str], exit: i32, words: &str) {
    let output = run(folder, arguments);
    let text = err(&output);
    assert_eq!(code(&output), exit, "{arguments:?}\n{text}");
    assert!(text.contains(words), "{arguments:?} does not say `{words}`:\n{text}");
}

#[test]
fn a_box_becomes_an_stl_in_a_folder_that_is_made() {
    let folder = folder(&[("a.kata", "box(10, 10, 10)")]);
    let output = run(folder.path(), &["build", "a.kata", "-o", "deep/er"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let bytes = fs::read(folder.path().join("deep/er/a.stl")).expect("written");
    assert_eq!(bytes.len(), 84 + 12 * 50);
    assert_eq!(names(&folder.path().join("deep/er")), ["a.stl"]);
    assert_eq!(out(&output).trim(), "deep/er/a.stl");
}

#[test]
fn the_model_may_come_from_standard_input() {
    let folder = folder(&[]);
    let mut command = katachi(&["measure", "-", "--json"]);
    command.current_dir(folder.path()).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = command.spawn().expect("starts");
    child.stdin.take().expect("piped").write_all(b"part p = box(1, 2, 3)").expect("read");
    let output = child.wait_with_output().expect("ends");
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(value["parts"]["p"]["volume"], 6.0);
}

#[test]
fn a_shape_without_a_name_from_standard_input_is_called_stdin() {
    let folder = folder(&[]);
    let mut command = katachi(&["build", "-"]);
    command.current_dir(folder.path()).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = command.spawn().expect("starts");
    child.stdin.take().expect("piped").write_all(b"box(1, 2, 3)").expect("read");
    assert_eq!(child.wait_with_output().expect("ends").status.code(), Some(0));
    assert_eq!(names(&folder.path().join("out")), ["stdin.stl"]);
}

#[test]
fn measures_have_the_keys_that_the_language_names() {
    let folder = folder(&[("a.kata", "part good = box(1, 2, 3)\npart bad = box(1, 2)")]);
    let output = run(folder.path(), &["measure", "a.kata", "--json"]);
    assert_eq!(code(&output), 1);
    let value: Value = serde_json::from_slice(&output.stdout).expect("only JSON");
    let keys: Vec<&str> =
        value["parts"]["good"].as_object().expect("there").keys().map(|k| &**k).collect();
    let expected =
        ["volume", "area", "bbox", "centroid", "triangles", "euler", "genus", "shells", "closed"];
    assert_eq!(keys, expected);
    assert_eq!(
        value["parts"]["good"]["bbox"],
        serde_json::json!([[-0.5, -1.0, 0.0], [0.5, 1.0, 3.0]])
    );
    assert_eq!(value["parts"].as_object().map(|o| o.len()), Some(1));
    assert_eq!(value["views"], serde_json::json!({}));
}

#[test]
fn wrong_use_ends_with_2() {
    let folder = folder(&[("a.kata", "param w = 5mm\npart plate = box(w, 1, 1)")]);
    let at = folder.path();
    refused(at, &[], 2, "Usage");
    refused(at, &["bild", "a.kata"], 2, "build");
    refused(at, &["build", "a.kata", "-p", "plat"], 2, "did you mean `plate`?");
    refused(at, &["build", "a.kata", "-p", "quite_other"], 2, "the outputs are plate");
    refused(at, &["build", "a.kata", "--format", "step"], 2, "3mf");
    refused(at, &["build", "a.kata", "--tolerance", "0mm"], 2, "greater than zero");
    refused(at, &["build", "a.kata", "-j", "0"], 2, "1..=1024");
    refused(at, &["build", "a.kata", "-D", "w"], 2, "NAME=VALUE");
    refused(at, &["build", "a.kata", "-D", "@none.json"], 2, "none.json");
    assert_eq!(code(&run(at, &["--help"])), 0);
    assert_eq!(code(&run(at, &["--version"])), 0);
}

#[test]
fn strings_from_outside_need_no_quotes() {
    let text = "param style = \"lip\" in [\"lip\", \"flat\"]\nparam width = 2mm\n\
                part p = box(width, 1, if style == \"lip\" { 1 } else { 2 })";
    let folder = folder(&[("a.kata", text), ("w.json", "{\"width\": \"1.5in\"}")]);
    let volume = |given: &str| {
        let output = run(folder.path(), &["measure", "a.kata", "--json", "-D", given]);
        let value: Value = serde_json::from_slice(&output.stdout).expect("only JSON");
        value["parts"]["p"]["volume"].as_f64()
    };
    assert_eq!(volume("style=flat"), Some(4.0));
    assert_eq!(volume("style=\"flat\""), Some(4.0));
    assert_eq!(volume("@w.json"), Some(38.1));
    let at = folder.path();
    refused(at, &["measure", "a.kata", "-D", "style=round"], 1, "`style` is \"round\"");
}

#[test]
fn syntax_errors_leave_the_rest_of_the_file() {
    let text = "part a = box(1, 1, 1)\npart b = box(1, 2,\nx = 3 +\npart c = box(2, 2, 2)\n\
                y = [1, 2\nz = ) 4\npart d = a + c";
    let folder = folder(&[("a.kata", text)]);
    let output = run(folder.path(), &["measure", "a.kata", "--json", "--diagnostics", "short"]);
    assert_eq!(code(&output), 1);
    let value: Value = serde_json::from_slice(&output.stdout).expect("only JSON");
    let parts: Vec<&String> = value["parts"].as_object().expect("parts").keys().collect();
    assert_eq!(parts, ["a", "c", "d"]);
    let places: Vec<String> = err(&output).lines().map(|line| line[..10].to_string()).collect();
    assert_eq!(places, ["a.kata:2:1", "a.kata:3:7", "a.kata:5:5", "a.kata:6:5"]);
}

#[test]
fn parameters_from_outside_are_checked() {
    let text = "param width = 5mm in 1mm..9mm\npart p = box(width, 1, 1)";
    let folder =
        folder(&[("a.kata", text), ("w.json", "{\"width\": 4}"), ("bad.json", "{\"with\": 4}")]);
    let at = folder.path();
    refused(at, &["build", "a.kata", "-D", "widht=3mm"], 2, "did you mean `width`?");
    refused(at, &["build", "a.kata", "-D", "width=30deg"], 1, "length");
    refused(at, &["build", "a.kata", "-D", "width=10mm"], 1, "9");
    refused(at, &["build", "a.kata", "-D", "width=("], 2, "-D width:1:");
    refused(at, &["build", "a.kata", "-D", "width=\"lip\""], 1, "string");
    refused(at, &["build", "a.kata", "-D", "width=lip"], 2, "quotes");
    refused(at, &["build", "a.kata", "-D", "width=1 2"], 2, "-D width:1:");
    refused(at, &["build", "a.kata", "-D", "@bad.json"], 2, "width");
    for (define, volume) in [("width=0.2cm", 2.0), ("@w.json", 4.0)] {
        let output = run(at, &["measure", "a.kata", "--json", "-D", define]);
        let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(value["parts"]["p"]["volume"], volume, "{define}");
    }
}

#[test]
fn sources_that_are_none_are_refused() {
    let folder = folder(&[("a.kata", "box(1, 1, 1)")]);
    let at = folder.path();
    fs::write(at.join("rubbish.kata"), [0x7f, b'E', b'L', b'F', 0, 0xff, 0xfe]).expect("writable");
    fs::create_dir(at.join("folder.kata")).expect("writable");
    refused(at, &["build", "rubbish.kata"], 1, "not a text file");
    refused(at, &["build", "missing.kata"], 1, "no such file");
    refused(at, &["build", "folder.kata"], 1, "not a file");
    refused(at, &["build", "no/such/folder.kata"], 2, "no such file");
    refused(at, &["build", "a.kata", "--root", "folder.kata"], 2, "outside the root");
}

#[test]
fn what_cannot_be_written_is_said_and_the_rest_is_written() {
    let text = "part a = box(1, 1, 1)\npart b = box(2, 2, 2)\nexport \"b.off\" = b\n";
    let folder = folder(&[("m.kata", text), ("taken", "a file")]);
    let at = folder.path();
    refused(at, &["build", "m.kata", "-o", "taken"], 1, "taken");
    fs::create_dir_all(at.join("out/a.stl")).expect("writable");
    refused(at, &["build", "m.kata"], 1, "a folder stands there");
    assert_eq!(names(&at.join("out")), ["a.stl", "b.off"]);
}

#[test]
fn an_export_writes_the_outputs_that_it_names() {
    let built = |text: &str, chosen: &[&str]| {
        let folder = folder(&[("m.kata", text)]);
        let output = run(folder.path(), &[&["build", "m.kata"], chosen].concat());
        assert_eq!(code(&output), 0, "{text}: {}", err(&output));
        names(&folder.path().join("out"))
    };
    let twins = "w = box(1, 1, 1)\npart a = w\npart b = w\n";
    let with = |export: &str| format!("{twins}export {export}");
    assert_eq!(built(&with("\"a.3mf\" = a"), &[]), ["a.3mf", "b.stl"]);
    assert_eq!(built(&with("\"a.3mf\" = a"), &["-p", "b"]), ["b.stl"]);
    assert_eq!(built(&with("\"a.3mf\" = a"), &["-p", "a"]), ["a.3mf"]);
    assert_eq!(built(&with("\"e.3mf\" = { a, b }"), &[]), ["e.3mf"]);
    assert_eq!(built(&with("\"e.3mf\" = { lid = b, hat = w }"), &[]), ["a.stl", "e.3mf"]);
    assert_eq!(built(&with("\"e.3mf\" = { a, b }"), &["-p", "a"]), ["a.stl"]);
    assert_eq!(built(&with("\"e.3mf\" = w"), &[]), ["a.stl", "b.stl", "e.3mf"]);
    let one = "w = box(1, 1, 1)\npart a = w\nexport \"e.3mf\" = w";
    assert_eq!(built(one, &[]), ["e.3mf"]);
    let sum = "part a = box(1, 1, 1)\npart b = box(2, 1, 1)\nexport \"e.3mf\" = a + b";
    assert_eq!(built(sum, &[]), ["a.stl", "b.stl", "e.3mf"]);
}

#[test]
fn exports_stay_in_the_output_folder_and_have_a_known_format() {
    let text = "part a = box(1, 1, 1)\nexport \"../a.stl\" = a\nexport \"a.step\" = a\nexport \"in/a.obj\" = a";
    let folder = folder(&[("m.kata", text)]);
    let output = run(folder.path(), &["build", "m.kata", "--diagnostics", "short"]);
    assert_eq!(code(&output), 1);
    assert!(err(&output).contains("outside the output folder"), "{}", err(&output));
    assert!(err(&output).contains("m.kata:3:"), "{}", err(&output));
    assert_eq!(names(folder.path()), ["m.kata", "out"]);
    assert_eq!(names(&folder.path().join("out")), ["in"]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_write_leaves_the_old_file_and_no_part_of_the_new_one() {
    let folder = folder(&[("ball.kata", "sphere(10, sides = 100)")]);
    let at = folder.path();
    fs::create_dir(at.join("out")).expect("writable");
    fs::write(at.join("out/ball.stl"), "old").expect("writable");
    // Files may not grow beyond 8 blocks: writing fails half way.
    let script = "trap '' XFSZ; ulimit -f 8; exec \"$0\" build ball.kata";
    let mut command = std::process::Command::new("sh");
    command.args(["-c", script, env!("CARGO_BIN_EXE_katachi")]).current_dir(at);
    let output = command.output().expect("starts");
    assert_eq!(code(&output), 1, "{}", err(&output));
    assert_eq!(names(&at.join("out")), ["ball.stl"]);
    assert_eq!(fs::read(at.join("out/ball.stl")).expect("kept"), b"old");
}

#[test]
fn the_number_of_threads_does_not_show_in_the_bytes() {
    let text = "a = sphere(10) - cylinder(3, 30).move(z = -15)\n\
                part one = a\npart two = a.rotate(x = 17) & box(15, 15, 15)\n\
                part three = hull([a, box(4, 4, 30)])\nexport \"all.3mf\" = { one, two, three }";
    let folder = folder(&[("m.kata", text)]);
    for jobs in ["1", "2"] {
        let output = run(folder.path(), &["build", "m.kata", "-j", jobs, "-o", jobs]);
        assert_eq!(code(&output), 0, "{}", err(&output));
    }
    let bytes = |jobs: &str| fs::read(folder.path().join(jobs).join("all.3mf")).expect("written");
    assert!(bytes("1") == bytes("2"), "the files differ");
}

#[test]
fn a_limit_ends_with_5() {
    let folder = folder(&[("a.kata", "sphere(10, sides = 100000)")]);
    refused(folder.path(), &["build", "a.kata"], 5, "the limit is");
}

#[test]
fn tests_are_run_one_line_each() {
    let text = "part p = box(1, 2, 3)\n\
                test \"right\" { assert volume(p) == 6mm^3 }\n\
                test \"wrong\" { assert volume(p) == 7mm^3 }\n";
    let folder = folder(&[("m.kata", text)]);
    let output = run(folder.path(), &["test", "m.kata"]);
    assert_eq!(code(&output), 3, "{}", err(&output));
    assert_eq!(out(&output), "ok     right\nFAILED wrong\n1 passed, 1 failed\n");
    let output = run(folder.path(), &["test", "m.kata", "--filter", "right"]);
    assert_eq!((code(&output), out(&output).lines().last()), (0, Some("1 passed, 0 failed")));
}

#[test]
fn goldens_are_written_when_asked_for() {
    let text =
        "part p = box(1, 2, 3)\ntest \"as before\" { golden(\"ref/p.stl\", p, volume = 1e-6) }";
    let folder = folder(&[("m.kata", text)]);
    assert_eq!(code(&run(folder.path(), &["test", "m.kata"])), 3);
    let output = run(folder.path(), &["test", "m.kata", "--update"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    assert_eq!(names(&folder.path().join("ref")), ["p.stl"]);
    assert_eq!(code(&run(folder.path(), &["test", "m.kata"])), 0);
}

#[test]
fn a_new_project_builds_and_its_test_passes() {
    let folder = folder(&[]);
    let at = folder.path();
    assert_eq!(code(&run(at, &["new", "lid"])), 0);
    assert_eq!(names(&at.join("lid")), ["README.md", "katachi.toml", "lid.kata"]);
    let output = run(at, &["test", "lid/lid.kata"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    assert_eq!(code(&run(&at.join("lid"), &["build", "lid.kata"])), 0);
    refused(at, &["new", "lid"], 2, "not empty");
}

#[test]
fn parameters_are_listed() {
    let text = "/// Overall width\nparam width = 60mm in 20mm..120mm step 1mm\nparam style = \"lip\" in [\"lip\", \"flat\"]\nbox(width, 1, 1)";
    let folder = folder(&[("m.kata", text)]);
    let output = run(folder.path(), &["params", "m.kata", "--json"]);
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let width = &value["params"][0];
    assert_eq!(
        (&width["name"], &width["value"], &width["max"]),
        (&"width".into(), &60.0.into(), &120.0.into())
    );
    assert_eq!(width["doc"], "Overall width");
    assert_eq!(value["params"][1]["choices"], serde_json::json!(["lip", "flat"]));
    assert!(out(&run(folder.path(), &["params", "m.kata"])).contains("width"));
}

#[test]
fn timings_name_every_phase() {
    let folder = folder(&[("m.kata", "box(1, 1, 1) - sphere(0.4)")]);
    let output = run(folder.path(), &["build", "m.kata", "--timings", "times/t.json"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let text = fs::read(folder.path().join("times/t.json")).expect("written");
    let value: Value = serde_json::from_slice(&text).expect("JSON");
    let keys: Vec<&str> = value.as_object().expect("object").keys().map(|k| &**k).collect();
    let expected =
        ["parse_ms", "eval_ms", "solids_ms", "drawings_ms", "halftones_ms", "write_ms", "total_ms"];
    assert_eq!(keys, expected);
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let folder = folder(&[("m.kata", "box(1, 1, 1)")]);
    let mut command = katachi(&["measure", "m.kata"]);
    command.current_dir(folder.path()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("ends");
    assert_eq!((code(&output), err(&output)), (0, String::new()));
}

/// A box of `n` by `n` squares a side, as binary STL.
fn large_stl(n: u32) -> Vec<u8> {
    let mut triangles: Vec<[[f32; 3]; 3]> = vec![];
    for axis in 0..3 {
        for side in [0, n] {
            for i in 0..n {
                for j in 0..n {
                    let corner = |a: u32, b: u32| {
                        let mut p = [0.0; 3];
                        p[axis] = side as f32;
                        p[(axis + 1) % 3] = (i + a) as f32;
                        p[(axis + 2) % 3] = (j + b) as f32;
                        p
                    };
                    let [p, q, r, s] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                    let turned =
                        if side == 0 { [[p, r, q], [p, s, r]] } else { [[p, q, r], [p, r, s]] };
                    triangles.extend(turned);
                }
            }
        }
    }
    let mut bytes = vec![0; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in &triangles {
        bytes.extend([0; 12]);
        triangle.iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn triangles_of_a_large_stl_may_come_in_any_order() {
    let ordered = large_stl(110);
    let mut mixed = ordered[..84].to_vec();
    let records: Vec<&[u8]> = ordered[84..].chunks_exact(50).collect();
    let places = (0..records.len()).map(|i| i * 7919 % records.len());
    places.for_each(|place| mixed.extend(records[place]));
    let folder = folder(&[("m.kata", "part a = import(\"a.stl\")\npart b = import(\"b.stl\")")]);
    fs::write(folder.path().join("a.stl"), ordered).expect("writable");
    fs::write(folder.path().join("b.stl"), mixed).expect("writable");
    let output = run(folder.path(), &["measure", "m.kata", "--json"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let parts = &serde_json::from_slice::<Value>(&output.stdout).expect("JSON")["parts"];
    for key in ["volume", "area", "bbox", "triangles", "euler", "shells"] {
        assert_eq!(parts["a"][key], parts["b"][key], "{key}");
    }
    assert_eq!(parts["a"]["volume"], 110f64.powi(3));
}

#[test]
#[ignore = "needs seconds and gigabytes in a debug build; .ci/run runs it in release"]
fn a_200_mb_stl_is_read() {
    let folder = folder(&[("m.kata", "import(\"large.stl\")")]);
    let n: u32 = 578;
    let bytes = large_stl(n);
    assert!(bytes.len() > 200_000_000);
    fs::write(folder.path().join("large.stl"), bytes).expect("writable");
    let output = run(folder.path(), &["measure", "m.kata", "--json"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(value["parts"]["m"]["volume"], f64::from(n).powi(3));
}

#[test]
fn mistakes_that_no_output_uses_are_told_and_the_rest_is_made() {
    let text =
        "a = cylinder(radius = 5, h = 2)\nv = volume(p)\npart p = box(1, 2, 3)\npart q = box(1, 2)";
    let folder = folder(&[("m.kata", text)]);
    let at = folder.path();
    let lines = |arguments: &[&str]| {
        let output = run(at, arguments);
        assert_eq!(code(&output), 1, "{arguments:?}");
        let mut lines: Vec<String> = err(&output).lines().map(str::to_string).collect();
        lines.sort();
        lines
    };
    let both = lines(&["check", "m.kata", "--diagnostics", "short"]);
    assert!(both.len() == 2 && both[0].contains("radius") && both[1].contains("`z`"), "{both:?}");
    assert_eq!(lines(&["build", "m.kata", "--diagnostics", "short"]), both);
    assert_eq!(lines(&["measure", "m.kata", "--diagnostics", "short"]), both);
    assert_eq!(lines(&["measure", "m.kata", "-p", "p", "--diagnostics", "short"]), both[..1]);
    assert_eq!(names(&at.join("out")), ["p.stl"]);
}

#[test]
fn a_failing_assert_is_told_once_however_many_outputs_there_are() {
    let text =
        "part p = box(1, 2, 3)\npart q = p\nexport \"e.stl\" = q\nassert volume(p) > 7, \"thin\"";
    let folder = folder(&[("m.kata", text)]);
    let output = run(folder.path(), &["build", "m.kata", "--diagnostics", "short"]);
    assert_eq!((code(&output), err(&output).lines().count()), (1, 1), "{}", err(&output));
}

#[test]
fn outputs_of_one_file_are_refused_and_every_refusal_has_a_place() {
    let text = "part a = box(1, 1, 1)\npart b = box(2, 2, 2)\nexport \"a.stl\" = b\n\
                export \"A.stl\" = b\nexport \"c\\\\d.stl\" = b\nexport \"e.stl\" = {}";
    let folder = folder(&[("m.kata", text)]);
    let output = run(folder.path(), &["build", "m.kata", "--diagnostics", "short"]);
    let text = err(&output);
    assert_eq!((code(&output), text.lines().count()), (1, 4), "{text}");
    for part in [
        "m.kata:1:6: error[duplicate]",
        "m.kata:4:8: error[duplicate]",
        "m.kata:5:8",
        "m.kata:6:18",
    ] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
    assert_eq!(names(&folder.path().join("out")), ["a.stl"]);
}

#[test]
fn every_kind_of_error_is_a_line_of_json_when_asked_for() {
    let folder = folder(&[("a.kata", "param w = 5mm\nbox(w, 1)"), ("taken", "")]);
    let wrong: [(&[&str], &str); 8] = [
        (&["bild"], "usage"),
        (&["build", "a.kata", "-j", "0"], "usage"),
        (&["build", "a.kata", "--tolerance", "3deg"], "usage"),
        (&["build", "a.kata", "-D", "x=1"], "usage"),
        (&["build", "a.kata", "--format", "step"], "usage"),
        (&["build", "none.kata"], "unreadable-file"),
        (&["build", "a.kata"], "missing-argument"),
        (&["new", "taken/x"], "unwritable-file"),
    ];
    for (arguments, expected) in wrong {
        let output = run(folder.path(), &[arguments, &["--diagnostics", "json"]].concat());
        let text = err(&output);
        assert!(code(&output) > 0 && text.lines().count() == 1, "{arguments:?}\n{text}");
        let value: Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(value["code"], expected, "{arguments:?}");
        let placed = ["missing-argument"].contains(&expected);
        assert_eq!(
            value["line"].is_u64() && value["column"].is_u64(),
            placed || arguments.contains(&"x=1")
        );
    }
}

#[cfg(unix)]
#[test]
fn a_command_told_to_stop_leaves_no_part_of_a_file() {
    let folder = folder(&[("m.kata", "part p = sphere(10, sides = 1500)")]);
    let out = folder.path().join("out");
    let mut command = katachi(&["build", "m.kata", "--format", "obj"]);
    command.current_dir(folder.path()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().expect("starts");
    // The temporary file appears, or else writing was too fast to be caught.
    while names(&out).is_empty() && child.try_wait().expect("a child").is_none() {
        std::thread::yield_now();
    }
    let mut kill = std::process::Command::new("kill");
    kill.args(["-INT", &child.id().to_string()]).stderr(Stdio::null()).status().expect("kill");
    let end = child.wait().expect("ends").code();
    let left = names(&out);
    // The signal may also come just before or after the file is put in place: then it is whole.
    assert!(matches!(end, Some(0 | 130)), "{end:?}");
    assert!(left.is_empty() && end == Some(130) || left == ["p.obj"], "{end:?} {left:?}");
    if !left.is_empty() {
        let again = ["build", "m.kata", "--format", "obj", "-o", "whole"];
        let status = katachi(&again).current_dir(folder.path()).stdout(Stdio::null()).status();
        assert!(status.expect("starts").success());
        let read = |place: &str| fs::read(folder.path().join(place)).expect("readable");
        assert!(read("out/p.obj") == read("whole/p.obj"), "part of a file is left");
    }
}
