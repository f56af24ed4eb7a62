//! Sweeps of the language: random rails and sections, threads in set operations, convergence, and drawings without the edges
//! of facets.

use glam::{DVec3, dvec3};
use katachi::{
    base::{Shelf, watch::Unwatched},
    geom::{
        Contour, Curve, CurvedGrid, EdgeCurve, Piece, Placement, Region, Tolerance,
        sweep::{Repair, Stations},
        trig::unit_circle,
    },
    kernel::brep::{
        crossing::crossing,
        measure::{euler, volume},
        sweep::{Between, Placed, Row, SweepError, between, surface},
    },
    session::Session,
};

use crate::random::Random;

fn tolerance(mm: f64) -> Tolerance {
    Tolerance::new(mm).expect("positive")
}

/// A rail that wanders from x = 0 to 100 about a place in y and z.
fn rail(random: &mut Random, at: DVec3) -> Curve {
    let count = 3 + (random.next() * 4.0) as usize;
    let points: Vec<DVec3> = (0..count)
        .map(|i| {
            let x = 100.0 * i as f64 / (count - 1) as f64;
            at + dvec3(x, 6.0 * random.next() - 3.0, 6.0 * random.next() - 3.0)
        })
        .collect();
    let made = match random.next() {
        x if x < 0.4 => Curve::smooth(&points, false),
        x if x < 0.8 => Curve::spline(&points, false, [None; 2]),
        _ => Curve::polyline(&points, false),
    };
    made.expect("a rail")
}

/// The place of a rail at an x, by halving.
fn at_x(rail: &Curve, x: f64) -> f64 {
    let (mut low, mut high) = (0.0, rail.pieces().len() as f64);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if rail.at(middle).x < x { low = middle } else { high = middle }
    }
    (low + high) / 2.0
}

fn ring(n: u32, rx: f64, ry: f64) -> Region {
    let points = (0..n).map(|i| unit_circle(n, i) * glam::dvec2(rx, ry)).collect();
    let curves = vec![if n < 12 { EdgeCurve::Line } else { EdgeCurve::Smooth(0) }; n as usize];
    Region { pieces: vec![Piece { outer: Contour { points, curves }, holes: vec![] }] }
}

/// Closed and open sections on random rails: solids are closed and positive, surfaces end on their rails.
#[test]
fn three_hundred_random_rails() {
    let mut random = Random(7);
    let mut crossed = 0;
    for case in 0..300 {
        let rails = [rail(&mut random, DVec3::Y * -12.0), rail(&mut random, DVec3::Y * 12.0)];
        let rule = if random.next() < 0.3 { Stations::Mid } else { Stations::Through };
        let least = if rule == Stations::Mid { 4 } else { 2 };
        let count = least + (random.next() * 3.0) as usize;
        let xs: Vec<f64> = (0..count).map(|i| 100.0 * i as f64 / (count - 1) as f64).collect();
        if case % 2 == 0 {
            let regions: Vec<Region> = xs
                .iter()
                .map(|_| {
                    let n = [4, 6, 9, 24, 40][(random.next() * 5.0) as usize];
                    ring(n, 8.0 + 8.0 * random.next(), 3.0 + 6.0 * random.next())
                })
                .collect();
            let linear = glam::DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X);
            let placed: Vec<Placed> = regions
                .iter()
                .zip(&xs)
                .map(|(region, x)| Placed { region, frame: Placement::new(linear, DVec3::X * *x) })
                .collect();
            let way = Between { rails: [&rails[0], &rails[1]], stations: rule, repair: Repair::No };
            match between(&placed, &way, tolerance(0.1)) {
                Ok(solid) => {
                    assert_eq!(euler(&solid), 2, "{case}");
                    assert!(volume(&solid) > 0.0 && crossing(solid.mesh()) == Ok(None), "{case}");
                }
                Err(SweepError::Crossing { .. }) => crossed += 1,
                Err(error) => panic!("{case}: {error}"),
            }
        } else {
            let sections: Vec<Curve> = xs
                .iter()
                .map(|x| {
                    let [p, q] = [0, 1].map(|i| rails[i].at(at_x(&rails[i], *x)));
                    let up = DVec3::Z * (20.0 * random.next() - 10.0);
                    let middle = [p.lerp(q, 0.3) + up, p.lerp(q, 0.7) + up];
                    Curve::smooth(&[p, middle[0], middle[1], q], false).expect("a section")
                })
                .collect();
            let rows: Vec<Row> = sections.iter().collect();
            let made = surface(&rows, [&rails[0], &rails[1]], rule, tolerance(0.1));
            let grid: CurvedGrid = made.unwrap_or_else(|error| panic!("{case}: {error}"));
            let [nu, nv] = grid.size();
            for u in 0..nu {
                for (v, rail) in [(0, &rails[0]), (nv - 1, &rails[1])] {
                    let p = grid.point(u, v);
                    assert!(rail.at(rail.nearest(p)).distance(p) < 1e-9, "{case}: {u}");
                }
            }
        }
    }
    assert_eq!(crossed, 0);
}

/// What `measure` says of the outputs of a model.
fn measured(source: &str) -> Vec<katachi::shape::Measures> {
    let files = [("model.kata", source)];
    let shelf = Shelf(&files);
    let session = Session::new(&shelf, &Unwatched, None);
    let (mut model, diagnostics) = session.compile("model.kata", &[]);
    assert!(diagnostics.is_empty(), "{diagnostics:?}");
    model.measure(&[]).found.into_iter().map(|(_, measures)| (*measures).clone()).collect()
}

/// Threads are closed, fit into each other with their clearance, and have the volume of their profile.
#[test]
fn threads_take_part_in_set_operations() {
    let found = measured(
        "set tolerance = 0.01\n\
         stud = thread(8, 1.25, 20)\n\
         nut = cylinder(d = 15, h = 6.5, sides = 6) - thread(8, 1.25, 6.5, clearance = 0.1)\n\
         part a = stud\n\
         part b = nut\n\
         part c = stud & nut\n",
    );
    assert!(found.iter().all(|m| m.closed), "{found:?}");
    assert_eq!((found[0].genus(), found[1].genus()), (0, 1));
    assert_eq!(found[2].triangles, 0, "stud and nut overlap by {} mm^3", found[2].volume);
    // Area across the axis: the core, and the ridge's trapezium spread over a turn.
    let core = 4.0 - 0.541_266 * 1.25;
    let share = |r: f64| 0.75 - (r - core) / (4.0 - core) * 0.625;
    let steps = 10_000;
    let ridge: f64 = (0..steps)
        .map(|i| {
            let r = core + (4.0 - core) * (f64::from(i) + 0.5) / f64::from(steps);
            std::f64::consts::TAU * r * share(r) * (4.0 - core) / f64::from(steps)
        })
        .sum();
    let area = std::f64::consts::PI * core * core + ridge;
    assert!(
        (found[0].volume / (20.0 * area) - 1.0).abs() < 0.006,
        "{}",
        found[0].volume / (20.0 * area)
    );
}

/// The error of a sweep's volume falls with the tolerance.
#[test]
fn volumes_of_sweeps_converge() {
    let exact = 2.0 * std::f64::consts::PI.powi(2) * 10.0 * 9.0;
    let mut before = f64::INFINITY;
    for mm in [0.1, 0.02, 0.004] {
        let source = format!(
            "set tolerance = {mm}\npart a = circle(3).sweep(along = arc([0, 0], 10, 0deg, 360deg))\n"
        );
        let off = (measured(&source)[0].volume - exact).abs();
        let area = 4.0 * std::f64::consts::PI.powi(2) * 30.0;
        assert!(off < area * mm && off < before / 3.0, "{mm}: {off}");
        before = off;
    }
}
