//! Times sweeps: prints case, milliseconds, triangles and volume, for `compare_sweeps.py`.

use std::{hint::black_box, time::Instant};

use glam::{DMat3, DVec2, DVec3, dvec2, dvec3};
use katachi::{
    geom::{
        Contour, Curve, EdgeCurve, Piece, Placement, Region, Tolerance,
        curve::Turn,
        sweep::{Frame, Repair, Stations},
        trig::unit_circle,
    },
    kernel::brep::{
        Polyhedron,
        boolean::{Tree, evaluate},
        measure,
        primitive::{cone, cuboid},
        sweep::{Along, Between, Placed, along, between, loft},
    },
};

fn region(points: Vec<DVec2>, curve: EdgeCurve) -> Region {
    let curves = vec![curve; points.len()];
    Region { pieces: vec![Piece { outer: Contour { points, curves }, holes: vec![] }] }
}

fn tolerance(mm: f64) -> Tolerance {
    Tolerance::new(mm).expect("positive")
}

/// An ellipse in 64 chords.
fn ellipse(x: f64, y: f64, n: u32) -> Region {
    let points = (0..n).map(|i| unit_circle(n, i) * dvec2(x, y)).collect();
    region(points, EdgeCurve::Smooth(0))
}

/// Five ellipses carried along two rails that bend and part.
fn rails(mm: f64) -> Polyhedron {
    let rail = |side: f64| {
        let points = [
            (0.0, 10.0, 0.0),
            (100.0, 14.0, 30.0),
            (200.0, 22.0, -10.0),
            (300.0, 12.0, 20.0),
            (400.0, 16.0, 0.0),
        ];
        let points: Vec<DVec3> = points.map(|(x, y, z)| dvec3(x, side * y, z)).to_vec();
        Curve::spline(&points, false, [Some(DVec3::X), Some(DVec3::X)]).expect("a rail")
    };
    let (a, b) = (rail(-1.0), rail(1.0));
    let regions: Vec<Region> = [(10.0, 6.0), (14.0, 9.0), (22.0, 8.0), (12.0, 10.0), (16.0, 7.0)]
        .map(|(x, y)| ellipse(x, y, 256))
        .to_vec();
    // Upright across x: the figure's x runs along y, its y along z.
    let linear = DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X);
    let heights = [0.0, 30.0, -10.0, 20.0, 0.0];
    let sections: Vec<Placed> = regions
        .iter()
        .zip(0..)
        .map(|(region, i)| Placed {
            region,
            frame: Placement::new(linear, dvec3(100.0 * f64::from(i), 0.0, heights[i as usize])),
        })
        .collect();
    let way = Between { rails: [&a, &b], stations: Stations::Through, repair: Repair::No };
    between(&sections, &way, tolerance(mm)).expect("a sweep")
}

/// M8 x 1.25, 30 mm long, on a bolt's head.
fn bolt(mm: f64) -> Polyhedron {
    let (pitch, outer) = (1.25, 4.0);
    let core = outer - 0.541_266 * pitch;
    let foot = core - 0.15 * pitch;
    let at = |r: f64, z: f64| dvec2(core - r, z * pitch);
    let ridge = [
        at(foot, -0.375),
        at(foot, 0.375),
        at(core, 0.375),
        at(outer, 0.0625),
        at(outer, -0.0625),
        at(core, -0.375),
    ];
    let helix = Turn {
        center: DVec3::Z * (5.0 - pitch),
        x: DVec3::X * core,
        y: DVec3::Y * core,
        rise: DVec3::Z * pitch,
        from: 0.0,
        to: 360.0 * (30.0 / pitch + 2.0),
    };
    let path = Curve::turn(helix);
    let way = Along { frame: Frame::Upright, ..Along::path(&path) };
    let wound =
        along(&region(ridge.to_vec(), EdgeCurve::Line), &way, tolerance(mm)).expect("a ridge");
    let leaf = |solid: Polyhedron| Tree::Leaf(solid.into());
    let up = Placement::translation(DVec3::Z * 5.0);
    let rod = cone(core, core, 30.0, 32).placed(&up);
    let ends = cuboid(dvec3(-9.0, -9.0, 5.0), dvec3(9.0, 9.0, 35.0));
    let thread = Tree::Intersection(vec![Tree::Union(vec![leaf(rod), leaf(wound)]), leaf(ends)]);
    let head = leaf(cone(7.5, 7.5, 5.0, 6));
    evaluate(&Tree::Union(vec![head, thread])).expect("a bolt").solid
}

/// From a polygon of 200 corners to one of 7.
fn funnel(mm: f64) -> Polyhedron {
    let points =
        |n: u32, r: f64| region((0..n).map(|i| unit_circle(n, i) * r).collect(), EdgeCurve::Line);
    let (many, few) = (points(200, 10.0), points(7, 5.0));
    let sections = [
        Placed { region: &many, frame: Placement::IDENTITY },
        Placed { region: &few, frame: Placement::translation(DVec3::Z * 30.0) },
    ];
    loft(&sections, false, tolerance(mm)).expect("a funnel")
}

#[allow(clippy::disallowed_methods, reason = "timing is its work")]
fn time(case: &str, runs: u32, make: impl Fn() -> Polyhedron) {
    let mut best = f64::INFINITY;
    for _ in 0..runs {
        let start = Instant::now();
        black_box(make());
        best = best.min(start.elapsed().as_secs_f64());
    }
    let solid = make();
    let (triangles, volume) = (solid.mesh().triangle_count(), measure::volume(&solid));
    println!("{case}\t{:.3}\t{triangles}\t{volume:.4}", best * 1e3);
}

fn main() {
    time("two rails, 5 sections at 0.01", 7, || rails(0.01));
    time("two rails, 5 sections at 0.001", 5, || rails(0.001));
    time("bolt M8 x 1.25 x 30 at 0.02", 7, || bolt(0.02));
    time("loft of 200 and 7 corners at 0.05", 9, || funnel(0.05));
}
