//! The shape graph that a file builds, and what outputs, exports and tests say of it.

use katachi::{
    base::{Code, SourceId},
    eval::{Domain, Evaluator, Limits, Override, Value, Write},
    shape::{Kind, Node, ShapeGraph, ShapeId},
};

use super::host::{Bench, holds, refuses, run_files};

/// Evaluates `part p` and looks at its node.
fn part(source: &str, look: impl FnOnce(&ShapeGraph, ShapeId)) {
    let files = [("main.kata", source)];
    let bench = Bench::new(&files);
    let mut evaluator = Evaluator::new(&bench, Limits::default());
    let instance = evaluator.open("main.kata", &[]).expect("it opens");
    let shape = evaluator.product_of(instance, "p");
    let words = evaluator.take_diagnostics();
    assert!(words.is_empty(), "{source}: {words:?}");
    look(evaluator.graph(), shape.expect("it evaluates").shape().expect("a shape"));
}

fn children(source: &str) -> (&'static str, usize) {
    let mut found = ("other", 0);
    part(source, |graph, id| {
        found = match graph.node(id) {
            Node::Union(list) => ("union", list.len()),
            Node::Difference(list) => ("difference", list.len()),
            Node::Intersection(list) => ("intersection", list.len()),
            Node::Transform { .. } => ("transform", 1),
            Node::Box { .. } => ("box", 0),
            Node::Empty(Kind::Solid) => ("empty", 0),
            _ => ("other", 0),
        };
    });
    found
}

#[test]
fn set_operations_are_flat() {
    let abc = "a = box(1, 1, 1)\nb = box(2, 2, 2)\nc = box(3, 3, 3)\n";
    for (source, expected) in [
        ("a + b + c", ("union", 3)),
        ("a + [b, [c]]", ("union", 3)),
        ("a - b - c", ("difference", 3)),
        ("a - [b, [c, c]]", ("difference", 3)),
        ("a & b & c", ("intersection", 3)),
        ("[a, b]", ("union", 2)),
        ("a + a", ("box", 0)),
        ("a - []", ("box", 0)),
        ("a + EMPTY", ("box", 0)),
        ("EMPTY", ("empty", 0)),
        ("EMPTY + EMPTY", ("empty", 0)),
        ("a & EMPTY", ("empty", 0)),
        ("EMPTY - a", ("empty", 0)),
        ("[a, b] - [c]", ("difference", 2)),
        ("[a] + [b]", ("union", 2)),
        ("union([a, [b, c]])", ("union", 3)),
        ("difference(a, [b, c])", ("difference", 3)),
        ("intersection([a, b, c])", ("intersection", 3)),
        ("a.move(x = 1).rotate(z = 90)", ("transform", 1)),
        ("a.move(x = 1).move(x = -1)", ("box", 0)),
        ("[a, b].move(x = 1)", ("transform", 1)),
        ("a.row(3, [1, 0, 0])", ("union", 3)),
        ("a.row(3, step = 5)", ("union", 3)),
        ("a.grid_of([3, 2], [5, 5])", ("union", 6)),
        ("a.grid_of([3, 2, 2], [5, 5, 5])", ("union", 12)),
        ("a.ring_of(5, 20)", ("union", 5)),
    ] {
        assert_eq!(children(&format!("{abc}part p = {source}")), expected, "{source}");
    }
}

#[test]
fn placements_are_exact_at_quarter_turns() {
    part("part p = box(1, 2, 3).rotate(x = 90, y = 180deg, z = -90)", |graph, id| {
        let Node::Transform { placement, .. } = graph.node(id) else { panic!("placed") };
        let numbers = placement.linear().to_cols_array();
        assert!(numbers.iter().all(|x| [0.0, 1.0, -1.0].contains(x)), "{numbers:?}");
    });
    part("part p = box(1, 2, 3).rotate([0, 0, 2], 30deg)", |graph, id| {
        let Node::Transform { placement, .. } = graph.node(id) else { panic!("placed") };
        let m = placement.linear();
        assert_eq!((m.x_axis.y, m.y_axis.x, m.z_axis.z), (0.5, -0.5, 1.0));
    });
    part("part p = box(1, 2, 3).mirror([2, 0, 0], at = [5, 0, 0])", |graph, id| {
        let Node::Transform { placement, .. } = graph.node(id) else { panic!("placed") };
        assert_eq!(placement.point(glam::DVec3::new(1.0, 2.0, 3.0)).to_array(), [9.0, 2.0, 3.0]);
    });
}

#[test]
fn attach_stands_on_a_side() {
    part("part p = box(2, 2, 2).attach(box(10, 10, 10), side = TOP, gap = 1)", |graph, id| {
        let Node::Transform { placement, .. } = graph.node(id) else { panic!("placed") };
        assert_eq!(placement.offset().to_array(), [0.0, 0.0, 11.0]);
    });
    part("part p = box(2, 2, 2).attach(box(10, 10, 10), side = LEFT)", |graph, id| {
        let Node::Transform { placement, .. } = graph.node(id) else { panic!("placed") };
        assert_eq!(placement.offset().to_array(), [-6.0, 0.0, 4.0]);
    });
}

#[test]
fn measures_are_values() {
    holds(
        r#"
b = box(1, 2, 3)
assert volume(b) == 6mm^3 and bbox(b).size == [1, 2, 3] and bbox(b).max.z == 3mm
assert b.centroid().z == 1.5mm and mass(b, 2) == 12 and inside(b, [0, 0, 1]) and not b.inside([9, 9, 9])
assert volume([b, b.move(x = 5)]) == 12mm^3 and genus(b) == 0 and shells(b) == 1 and closed(b)
assert text("abc", size = 5).width == 15mm and text("ab").tag("t").width == 20mm
assert distance(b, [3, 4, 0]) == 5mm and distance([3, 4, 0], b) == 5mm and distance(b, sphere(1)) == 1.5mm
assert area(rect(1, 1)) == 22mm^2 and length(rect(1, 1)) == 6mm and inertia(b)[1][1] == 1mm^5
"#,
    );
    refuses("part p = box(bbox(EMPTY).size.x, 1, 1)", &["an empty shape has no bounding box"]);
}

#[test]
fn imports_are_what_their_files_hold() {
    let main = "part a = import(\"ref/a.stl\", heal = 0.01mm)\npart b = import(\"ref/b.svg\").extrude(2)\nassert import(\"c.json\") == [1.5, NONE]";
    let files = [("main.kata", main), ("ref/a.stl", ""), ("ref/b.svg", ""), ("c.json", "")];
    assert_eq!(run_files(&files, &[]).words(), "");
    refuses(
        "part p = import(\"none.stl\")",
        &["unreadable-file: cannot read none.stl @\"none.stl\"@"],
    );
    refuses("part p = import(\"../none.stl\")", &["outside-root: cannot read `../none.stl`"]);
    refuses("part p = import(\"a.stl\", heal = -1mm)", &["`heal` is a length above 0 or WINDING"]);
}

#[test]
fn what_a_file_offers() {
    let source = "set tolerance = 0.02\ngroup \"Size\"\n/// Overall width\nparam width = 60mm in 20mm..120mm step 1mm\nparam style = \"lip\" in [\"lip\", \"flat\"]\nparam gap = 0.2mm when style == \"flat\"\nbox(1, 1, 1)\nsphere(2)\n/// The clip\npart clip = box(width, 1, 1)\nexport \"{style}.3mf\" = { clip, other = sphere(1) }\nexport \"list.stl\" = [clip, sphere(3)]";
    let files = [("models/main.kata", source)];
    let bench = Bench::new(&files);
    let mut evaluator = Evaluator::new(&bench, Limits::default());
    let given = Override::Source { source: SourceId(9), text: "40".into() };
    let id = evaluator.open("models/main.kata", &[("width".into(), given)]).expect("it opens");
    let params = evaluator.params(id);
    assert_eq!(params[0].doc.as_deref(), Some("Overall width"));
    assert_eq!((params[0].group.as_deref(), &*params[0].kind), (Some("Size"), "Length"));
    assert!(matches!(params[0].value, Some(Value::Number(40.0, _))));
    assert!(matches!(params[0].default, Some(Value::Number(60.0, _))));
    assert!(matches!(&params[0].domain, Domain::Range { step: Some(_), .. }));
    assert!(matches!(&params[1].domain, Domain::Choices(list) if list.len() == 2));
    assert!(params[0].active && !params[2].active);
    let outputs: Vec<String> = evaluator.outputs(id).iter().map(|o| o.name.to_string()).collect();
    assert_eq!(outputs, ["main", "clip"]);
    let main = evaluator.product_of(id, "main").expect("the anonymous part");
    let main = main.shape().expect("a shape");
    assert!(matches!(evaluator.graph().node(main), Node::Union(list) if list.len() == 2));
    let exports = evaluator.exports(id);
    assert_eq!(exports[0].file.as_deref(), Some("lip.3mf"));
    let parts = evaluator.export_products(id, 0).expect("parts");
    let names: Vec<&str> = parts.iter().map(|part| &*part.name).collect();
    assert_eq!(names, ["clip", "other"]);
    assert_eq!((parts[0].output.as_deref(), &parts[1].output), (Some("clip"), &None));
    let part = &evaluator.export_products(id, 1).expect("one part")[0];
    assert_eq!((&*part.name, &part.output), ("list", &None));
    assert_eq!(evaluator.tolerance(id), Some(0.02));
    assert!(evaluator.take_diagnostics().is_empty());
    assert!(evaluator.product_of(id, "clop").is_err());
    assert_eq!(evaluator.take_diagnostics()[0].code, Code::UnknownName);
}

#[test]
fn references_are_compared_and_written() {
    let main = "test \"solid\" { golden(\"ref/a.stl\", box(1, 2, 3)) }\ntest \"other\" { golden(\"ref/a.stl\", box(1, 2, 4)) }\ntest \"text\" { snapshot(\"ref/s.txt\", { w = 5mm, b = box(1, 2, 3) }) }\ntest \"none\" { snapshot(\"ref/none.txt\", 1) }";
    let files = [("main.kata", main), ("ref/a.stl", ""), ("ref/s.txt", "w = 5mm\n")];
    let bench = Bench::new(&files);
    let mut evaluator = Evaluator::new(&bench, Limits::default());
    let id = evaluator.open("main.kata", &[]).expect("it opens");
    assert_eq!(evaluator.tests(id)[0].title, "solid");
    let plain: Vec<bool> = (0..4).map(|i| evaluator.run_test(id, i, false).passed).collect();
    assert_eq!(plain, [true, false, false, false]);
    let words = evaluator.run_test(id, 1, false).diagnostics[0].message.clone();
    assert_eq!(words, "the volume differs from ref/a.stl by 0.25 of it; allowed is 0.0001");
    let updated: Vec<_> = (0..4).map(|i| evaluator.run_test(id, i, true)).collect();
    assert!(updated.iter().all(|outcome| outcome.passed));
    assert!(updated[0].writes.is_empty());
    assert!(matches!(&updated[1].writes[..], [Write::Mesh { path, .. }] if &**path == "ref/a.stl"));
    let [Write::Text { text, .. }] = &updated[2].writes[..] else { panic!("a text") };
    assert!(
        text.starts_with(
            "w = 5mm\nb:\nsolid\nvolume 6mm^3\narea 22mm^2\nbbox [-0.5, -1, 0] to [0.5, 1, 3]\n"
        ),
        "{text}"
    );
}

#[test]
fn tests_that_should_fail() {
    refuses(
        "test \"t\" fails \"zero\" { box(1, 1, 1) }",
        &["test-failed: this test passes, but should fail with \"zero\""],
    );
    refuses(
        "test \"t\" fails \"zero\" { box(0, 1, 1) }",
        &["test-failed: this test fails, but not with \"zero\"", "greater than 0"],
    );
    holds("test \"t\" fails \"greater than 0\" { box(0, 1, 1) }");
    refuses("test \"t\" { assert 1 == 2, \"never\" }", &["assertion-failed: never"]);
}

#[test]
fn check_asks_no_geometry_and_leaves_what_it_skips() {
    let main = "b = box(1, 2, 3)\nv = volume(b)\nw = v / 1mm^2 + 1mm\npart p = box(w, 1, 1)\nq = 1 / 0\nassert v > 0mm^3";
    let files = [("main.kata", main)];
    let bench = Bench::new(&files);
    let mut evaluator = Evaluator::new(&bench, Limits::default());
    let id = evaluator.open("main.kata", &[]).expect("it opens");
    evaluator.check(id, &[]);
    let told = evaluator.take_diagnostics();
    assert_eq!(told.len(), 1, "{told:?}");
    assert_eq!(told[0].code, Code::Arithmetic);
    let shape = evaluator.product_of(id, "p").expect("it is evaluated after the check");
    let shape = shape.shape().expect("a shape");
    assert!(matches!(evaluator.graph().node(shape), Node::Box { max, .. } if max.x == 3.5));
}

#[test]
fn asserts_that_check_skips_are_made_up_for() {
    let main = "use \"h.kata\" as h\npart p = h.leaf";
    let leaf = "part leaf = box(1, 2, 3)\nassert volume(leaf) > 7mm^3, \"too small\"";
    let files = [("main.kata", main), ("h.kata", leaf)];
    let bench = Bench::new(&files);
    let mut evaluator = Evaluator::new(&bench, Limits::default());
    let id = evaluator.open("main.kata", &[]).expect("it opens");
    evaluator.check(id, &[]);
    assert!(evaluator.take_diagnostics().is_empty());
    assert!(evaluator.product_of(id, "p").is_err());
    assert_eq!(evaluator.take_diagnostics()[0].message, "too small");
}
