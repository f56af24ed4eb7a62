//! Offsets and fillets alone, one line a case: `cargo bench --bench fields`.
//!
//! Each line holds the name, the least processor-side time of some runs in milliseconds, the triangles of the
//! result, its volume, and how far it is from where it should be. `compare_fields.py` runs rivals beside it.

use std::{f64::consts::TAU, sync::Arc, time::Instant};

use glam::{DVec3, dvec3};
use katachi::{
    convert::{
        contour::metaball,
        offset::{deviation, fillet, offset},
    },
    geom::{Bounds, Charge, Falloff, Placement, Tolerance},
    kernel::{
        brep::{
            Polyhedron,
            boolean::{Tree, evaluate},
            measure,
            primitive::{cone, cuboid, torus},
        },
        field::{Local, Polyhedral},
    },
};

/// Runs of each case.
const RUNS: usize = 5;

/// Milliseconds that work takes, and what it makes.
#[allow(clippy::disallowed_methods, reason = "timing is its work")]
fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let made = work();
    (start.elapsed().as_secs_f64() * 1e3, made)
}

fn moved(solid: Polyhedron, by: DVec3) -> Polyhedron {
    solid.placed(&Placement::translation(by))
}

fn leaves(list: Vec<Polyhedron>) -> Vec<Tree> {
    list.into_iter().map(|solid| Tree::Leaf(Arc::new(solid))).collect()
}

fn union(list: Vec<Polyhedron>) -> Polyhedron {
    evaluate(&Tree::Union(leaves(list))).expect("closed").solid
}

/// A cube of 20 less a hole of radius 5.
fn hole() -> Polyhedron {
    let drill = moved(cone(5.0, 5.0, 30.0, 64), dvec3(10.0, 10.0, -5.0));
    let list = vec![cuboid(DVec3::ZERO, DVec3::splat(20.0)), drill];
    evaluate(&Tree::Difference(leaves(list))).expect("closed").solid
}

/// Two arms of 30, 5 wide and 10 high.
fn bracket() -> Polyhedron {
    union(vec![
        cuboid(DVec3::ZERO, dvec3(30.0, 5.0, 10.0)),
        cuboid(DVec3::ZERO, dvec3(5.0, 30.0, 10.0)),
    ])
}

/// A cylinder of radius 10 on one of radius 20.
fn stepped() -> Polyhedron {
    let foot = cone(20.0, 20.0, 5.0, 128);
    union(vec![foot, moved(cone(10.0, 10.0, 8.0, 128), dvec3(0.0, 0.0, 5.0))])
}

/// Runs a case some times and prints its line.
fn case(name: &str, work: impl Fn() -> Polyhedron, off: impl Fn(&Polyhedron) -> f64) {
    let mut least = f64::INFINITY;
    let mut made = Polyhedron::empty();
    for _ in 0..RUNS {
        let (taken, found) = timed(&work);
        (least, made) = (least.min(taken), found);
    }
    let (triangles, volume) = (measure::triangles(&made), measure::volume(&made));
    println!("{name}\t{least:.2}\t{triangles}\t{volume:.4}\t{:.5}", off(&made));
}

fn grown(name: &str, solid: &Polyhedron, by: f64, mm: f64) {
    let tolerance = Tolerance::new(mm).expect("positive");
    let field = Polyhedral::new(solid.mesh()).expect("full");
    let off = |made: &Polyhedron| deviation(made.mesh(), &field, by).map_or(0.0, |d| d.most);
    case(name, || offset(solid, by, tolerance).expect("an offset"), off);
}

/// Points asked.
const POINTS: usize = 200_000;

/// The part after the point of a multiple: numbers spread evenly over 0 to 1.
fn part(i: usize, step: f64) -> f64 {
    (i as f64 * step).fract()
}

/// A numbered point.
type Place = fn(usize) -> DVec3;

/// Points about the ring of [`closest`], anywhere.
fn scattered(i: usize) -> DVec3 {
    (dvec3(part(i, 0.819_172_5), part(i, 0.671_043_6), part(i, 0.549_700_4)) - 0.5) * 32.0
}

/// Points within a tenth of a millimetre of it.
fn near(i: usize) -> DVec3 {
    let radius = 4.0 + 0.2 * (part(i, 0.549_700_4) - 0.5);
    let (v_sin, v_cos) = libm::sincos(part(i, 0.671_043_6) * TAU);
    let (u_sin, u_cos) = libm::sincos(part(i, 0.819_172_5) * TAU);
    let out = 10.0 + radius * v_cos;
    dvec3(out * u_cos, out * u_sin, radius * v_sin)
}

/// Millions of closest points a second on a ring of 102400 triangles.
fn closest(name: &str, field: &Polyhedral, place: Place) {
    let points: Vec<DVec3> = (0..POINTS).map(place).collect();
    let ask = || points.iter().map(|p| field.nearest(*p).point.distance(*p)).sum::<f64>();
    let taken = (0..RUNS).map(|_| timed(ask).0).fold(f64::INFINITY, f64::min);
    println!("closest points, {name}\t{:.3}", POINTS as f64 / taken / 1e3);
}

/// The same for points of small cells, with the candidates of a cell at hand, and with finding them.
fn closest_by_cell(name: &str, field: &Polyhedral, place: Place) {
    const CELLS: usize = 2000;
    const EACH: usize = 100;
    const EDGE: f64 = 0.25;
    let cell = |i: usize| {
        let low = place(i * 97) - EDGE / 2.0;
        Bounds { min: low, max: low + EDGE }
    };
    let within = |b: &Bounds, i: usize| b.min + (scattered(i) / 32.0 + 0.5) * (b.max - b.min);
    let cells: Vec<Bounds> = (0..CELLS).map(cell).collect();
    let points = |i: usize| (i..i + EACH).map(move |k| within(&cell(i), k));
    let asked: Vec<Vec<DVec3>> = (0..CELLS).map(|i| points(i).collect()).collect();
    let localized = || cells.iter().map(|c| Local::new(field, c)).collect::<Vec<Local>>();
    let (mut finding, mut asking) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..RUNS {
        let (found, locals) = timed(localized);
        let of = |(local, points): (&Local, &Vec<DVec3>)| {
            points.iter().map(|p| local.nearest(*p).distance.abs()).sum::<f64>()
        };
        let (taken, sum) = timed(|| locals.iter().zip(&asked).map(of).sum::<f64>());
        assert!(sum > 0.0);
        (finding, asking) = (finding.min(found), asking.min(taken));
    }
    let rate = |ms: f64| (CELLS * EACH) as f64 / ms / 1e3;
    println!("closest points by cell, {name}\t{:.3}", rate(asking));
    println!("closest points by cell with its candidates, {name}\t{:.3}", rate(finding + asking));
}

fn main() {
    let ring = Polyhedral::new(torus(10.0, 4.0, 320, 160).mesh()).expect("full");
    let cases: [(&str, Place); 2] = [("scattered", scattered), ("near", near)];
    for (name, place) in cases {
        closest(name, &ring, place);
        closest_by_cell(name, &ring, place);
    }
    if std::env::args().any(|argument| argument == "closest") {
        return;
    }
    println!("case\tms\ttriangles\tvolume\toff");
    let block = cuboid(DVec3::ZERO, dvec3(10.0, 20.0, 30.0));
    grown("hole + 2 at 0.006", &hole(), 2.0, 0.006);
    grown("hole + 2 at 0.019", &hole(), 2.0, 0.019);
    for (name, solid) in [("box", &block), ("lbr", &bracket()), ("hole", &hole())] {
        grown(&format!("{name} + 2 at 0.01"), solid, 2.0, 0.01);
        grown(&format!("{name} + 2 at 0.015"), solid, 2.0, 0.015);
    }
    grown("torus 10/4 + 7 at 0.03", &torus(10.0, 4.0, 48, 32), 7.0, 0.03);
    let (solid, fine) = (stepped(), Tolerance::new(0.01).expect("positive"));
    let before = measure::volume(&solid);
    let change = |made: &Polyhedron| measure::volume(made) - before;
    case("stepped fillet (1, 1.5)", || fillet(&solid, 1.0, 1.5, fine).expect("a fillet"), change);
    let charge = |x: f64| Charge { at: DVec3::X * x, q: 5.0, falloff: Falloff::Inverse };
    let two = [charge(-8.0), charge(8.0)];
    case("two charges at 0.01", || metaball(&two, 1.0, fine).expect("a solid"), |_| 0.0);
}
