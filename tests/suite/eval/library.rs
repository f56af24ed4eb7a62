//! The standard library: every name has documentation and an example that runs.

use katachi::eval::library::Index;

use super::host::{holds, run_files};

#[test]
fn every_declaration_has_a_doc_and_a_running_example() {
    let mut faults = vec![];
    for declaration in Index::get().declarations() {
        let examples = declaration.examples();
        if examples.is_empty() || declaration.doc().trim().is_empty() {
            faults.push(format!("{} has no example", declaration.signature()));
        }
        for example in examples {
            let words = run_files(&[("main.kata", &example)], &[]).words();
            if !words.is_empty() {
                faults.push(format!("{}\n{example}\n{words}", declaration.signature()));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn metric_sizes() {
    holds(
        r#"
use "std/metric" as metric
use "std/metric" { clearance, nut as hexagon }
assert clearance(5mm) == 5.5mm and metric.clearance(3) == 3.4mm
assert hexagon(8mm).flats == 13mm
assert metric.tap_hole(6mm) == 5mm
part plate = box(20, 20, 3) - metric.hole(5mm, 3mm)
part trap = metric.nut_trap(5mm)
test "no M7" fails "there is no M7" { clearance(7mm) }
"#,
    );
}

#[test]
fn signatures_read_as_declared() {
    let signature = |name: &str| {
        let mut found = Index::get().declarations().filter(|d| d.name == name);
        found.next().map(|declaration| declaration.signature())
    };
    assert_eq!(signature("box"), Some("fn box(x: Length, y: Length, z: Length) -> Solid"));
    assert_eq!(signature("row"), Some("fn row(shape: Shape, n: Count, step: Point) -> Shape"));
    assert_eq!(
        signature("grid_of"),
        Some("fn grid_of(shape: Shape, n: List[Count], step: Point) -> Shape")
    );
    assert_eq!(signature("PI"), Some("PI"));
}
