use std::f64::consts::PI;

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::*;
use crate::{
    geom::{
        Contour, Curve, EdgeCurve, Piece, Placement, Region, Tolerance,
        curve::Turn,
        sweep::{Corners, Frame, Stations},
        trig::unit_circle,
    },
    kernel::brep::measure::{euler, volume},
};

fn region(points: Vec<DVec2>, curve: EdgeCurve) -> Region {
    let curves = vec![curve; points.len()];
    Region { pieces: vec![Piece { outer: Contour { points, curves }, holes: vec![] }] }
}

fn square(r: f64) -> Region {
    let corners = [(-r, -r), (r, -r), (r, r), (-r, r)].map(|(x, y)| dvec2(x, y));
    region(corners.to_vec(), EdgeCurve::Line)
}

fn disc(radius: f64, n: u32) -> Region {
    let points = (0..n).map(|i| unit_circle(n, i) * radius).collect();
    region(points, EdgeCurve::Circle { center: DVec2::ZERO, radius })
}

fn fine(mm: f64) -> Tolerance {
    Tolerance::new(mm).expect("positive")
}

fn ring(r: f64, rise: f64, degrees: f64) -> Curve {
    let (x, y) = (DVec3::X * r, DVec3::Y * r);
    Curve::turn(Turn { center: DVec3::ZERO, x, y, rise: DVec3::Z * rise, from: 0.0, to: degrees })
}

#[test]
fn a_circle_along_a_circle_is_a_torus() {
    for mm in [0.1, 0.01] {
        let solid = along(&disc(3.0, 128), &Along::path(&ring(10.0, 0.0, 360.0)), fine(mm))
            .expect("a ring");
        let area = 64.0 * 9.0 * libm::sin(PI / 64.0);
        let off = volume(&solid) / (2.0 * PI * 10.0 * area) - 1.0;
        assert!(off < 0.0 && off.abs() < 2.0 * mm / 10.0, "{mm}: {off}");
        assert_eq!(euler(&solid), 0);
        let round = |s: &crate::geom::Surface| matches!(s, crate::geom::Surface::Torus { .. });
        assert!(solid.mesh().faces().all(|f| round(&f.origin().surface)));
    }
}

#[test]
fn corners_are_mitred_or_rounded() {
    let path = [dvec3(0., 0., 0.), dvec3(20., 0., 0.), dvec3(20., 20., 0.), dvec3(20., 20., 20.)];
    let path = Curve::polyline(&path, false).expect("a path");
    let mitred = along(&square(1.0), &Along::path(&path), fine(0.01)).expect("a bar");
    assert!((volume(&mitred) - 240.0).abs() < 1e-9);
    assert_eq!((mitred.mesh().face_count(), euler(&mitred)), (14, 2));
    let way = Along { corners: Corners::Rounded, ..Along::path(&path) };
    let rounded = along(&square(1.0), &way, fine(0.001)).expect("a bar");
    // Of each corner a square of side 2 becomes a quarter of a disc of radius 2, extruded by 2.
    let expected = 240.0 - 2.0 * 2.0 * (4.0 - PI);
    assert!((volume(&rounded) - expected).abs() < 0.02, "{} {expected}", volume(&rounded));
}

#[test]
fn a_helix_keeps_its_area() {
    let path = ring(10.0, 5.0, 1080.0);
    for frame in [Frame::RotationMinimising, Frame::Frenet, Frame::Upright] {
        let way = Along { frame, ..Along::path(&path) };
        let solid = along(&square(1.0), &way, fine(0.002)).expect("a spring");
        assert!(
            (volume(&solid) / (4.0 * path.length()) - 1.0).abs() < 2e-3,
            "{frame:?} {}",
            volume(&solid) / (4.0 * path.length())
        );
        assert_eq!(euler(&solid), 2);
    }
}

#[test]
fn bends_and_crossings_are_told() {
    let narrow = along(&square(3.0), &Along::path(&ring(2.0, 10.0, 360.0)), fine(0.01));
    assert!(matches!(narrow, Err(SweepError::Bend { reach, .. }) if reach >= 3.0), "{narrow:?}");
    let close = along(&square(1.0), &Along::path(&ring(10.0, 1.0, 720.0)), fine(0.1));
    let Err(SweepError::Crossing { parts, .. }) = &close else { panic!("{close:?}") };
    assert_eq!(parts.len(), 2);
    let way = ring(10.0, 1.0, 720.0);
    let repaired = Along { repair: Repair::Union, ..Along::path(&way) };
    let solid = along(&square(1.0), &repaired, fine(0.1)).expect("united");
    assert_eq!(crossing(solid.mesh()), Ok(None));
    let cross = [
        dvec3(0., 0., 0.),
        dvec3(20., 0., 0.),
        dvec3(20., 10., 0.),
        dvec3(10., 10., 0.),
        dvec3(10., -10., 0.),
    ];
    let path = Curve::polyline(&cross, false).expect("a path");
    assert!(matches!(
        along(&square(1.0), &Along::path(&path), fine(0.1)),
        Err(SweepError::Crossing { .. })
    ));
    let way = Along { repair: Repair::Union, ..Along::path(&path) };
    let united = along(&square(1.0), &way, fine(0.1)).expect("united");
    assert!((volume(&united) - (60.0 * 4.0 - 8.0)).abs() < 1e-6, "{}", volume(&united));
    let back = Curve::polyline(&[DVec3::ZERO, DVec3::X * 5.0, DVec3::X], false).expect("a path");
    assert!(matches!(
        along(&square(1.0), &Along::path(&back), fine(0.1)),
        Err(SweepError::TurnsBack(_))
    ));
}

#[test]
fn twisted_and_scaled() {
    let path = Curve::polyline(&[DVec3::ZERO, DVec3::Z * 10.0], false).expect("a path");
    let way = Along { twist: 90.0, ..Along::path(&path) };
    assert!((volume(&along(&square(1.0), &way, fine(0.001)).expect("a bar")) - 40.0).abs() < 0.05);
    let way = Along { scale: 0.5, ..Along::path(&path) };
    let frustum = along(&square(1.0), &way, fine(0.001)).expect("a frustum");
    assert!((volume(&frustum) - 10.0 / 3.0 * (4.0 + 2.0 + 1.0)).abs() < 1e-9);
    // A square bar whose twist makes it meet itself after a quarter turn, and one that does not.
    let circle = ring(10.0, 0.0, 360.0);
    let twisted = |twist| along(&square(1.0), &Along { twist, ..Along::path(&circle) }, fine(0.01));
    assert_eq!(euler(&twisted(90.0).expect("closed")), 0);
    assert!(matches!(twisted(45.0), Err(SweepError::Unclosed { .. })));
}

#[test]
fn closed_space_curves_meet_without_a_step() {
    let knot: Vec<DVec3> = (0..12)
        .map(|i| {
            let a = f64::from(i) * PI / 6.0;
            let r = 20.0 + 6.0 * libm::cos(1.5 * 2.0 * a);
            dvec3(r * libm::cos(a), r * libm::sin(a), 8.0 * libm::sin(3.0 * a))
        })
        .collect();
    let path = Curve::spline(&knot, true, [None; 2]).expect("a loop");
    let solid = along(&square(1.0), &Along::path(&path), fine(0.02)).expect("a ring");
    assert_eq!(euler(&solid), 0);
    assert!((volume(&solid) / (4.0 * path.length()) - 1.0).abs() < 0.01);
}

#[test]
fn lofts_join_any_numbers_of_corners() {
    let (many, few) = (disc(10.0, 200), disc(5.0, 7));
    let few = region(few.pieces[0].outer.points.clone(), EdgeCurve::Line);
    let sections = [
        Placed { region: &many, frame: Placement::IDENTITY },
        Placed { region: &few, frame: Placement::translation(DVec3::Z * 30.0) },
    ];
    let solid = loft(&sections, false, fine(0.05)).expect("a body");
    assert_eq!(euler(&solid), 2);
    // Between a prism of the small one and the hull.
    let (a, b) = (many.area(), few.area());
    assert!(volume(&solid) > 30.0 * b && volume(&solid) < 30.0 * a);
    let prismatoid = 10.0 * (a + b + (a * b).sqrt());
    assert!((volume(&solid) / prismatoid - 1.0).abs() < 0.05);
    let vase = [(0.0, 8.0), (10.0, 12.0), (25.0, 6.0), (30.0, 9.0)];
    let regions: Vec<Region> = vase.iter().map(|(_, r)| disc(*r, 64)).collect();
    let placed: Vec<Placed> = regions
        .iter()
        .zip(vase)
        .map(|(region, (z, _))| Placed { region, frame: Placement::translation(DVec3::Z * z) })
        .collect();
    assert_eq!(euler(&loft(&placed, false, fine(0.05)).expect("a vase")), 2);
    assert_eq!(
        loft(&placed[..1], false, fine(0.05)),
        Err(SweepError::Sections { found: 1, needed: 2 })
    );
}

fn row(points: &[DVec3]) -> Curve {
    Curve::polyline(points, false).expect("a row")
}

#[test]
fn rails_keep_the_ends_of_sections() {
    let rail = |k: f64| {
        Curve::smooth(
            &[
                dvec3(0., k, 0.),
                dvec3(10., 2.0 * k, 3.0 * k),
                dvec3(20., k, 8.),
                dvec3(30., 3.0 * k, 0.),
            ],
            false,
        )
        .expect("a rail")
    };
    let (a, b) = (rail(1.0), rail(-2.0));
    let section = |place: f64, up: f64| {
        let (p, q) = (a.at(place), b.at(place));
        Curve::smooth(&[p, p.lerp(q, 0.3) + DVec3::Z * up, q], false).expect("a section")
    };
    for (rule, sections) in [
        (Stations::Through, vec![section(0.0, 2.0), section(2.0, 5.0)]),
        (Stations::Through, vec![section(0.0, 2.0), section(0.7, -3.0), section(2.0, 5.0)]),
        (
            Stations::Mid,
            vec![section(0.0, 2.0), section(0.5, 1.0), section(1.2, 3.0), section(2.0, 5.0)],
        ),
    ] {
        let rows: Vec<Row> = sections.iter().collect();
        let grid = surface(&rows, [&a, &b], rule, fine(0.01)).expect("a surface");
        let [nu, nv] = grid.size();
        for u in 0..nu {
            for (v, rail) in [(0, &a), (nv - 1, &b)] {
                let p = grid.point(u, v);
                assert!(rail.at(rail.nearest(p)).distance(p) < 1e-9, "{rule:?} {u}");
            }
        }
        let met = if rule == Stations::Through {
            sections.iter().collect()
        } else {
            vec![&sections[0], &sections[3]]
        };
        for section in met {
            let p = section.at(0.4);
            let near = grid
                .points()
                .iter()
                .map(|q| q.distance(section.at(section.nearest(*q))))
                .filter(|d| *d < 1e-9);
            assert!(near.count() >= nv, "{rule:?} {p}");
        }
    }
}

#[test]
fn parallel_sections_on_parallel_rails_are_an_extrusion() {
    let rails = [row(&[DVec3::ZERO, DVec3::Z * 7.0]), row(&[DVec3::X * 4.0, dvec3(4., 0., 7.)])];
    let base = square(2.0);
    let at = |z: f64| Placed { region: &base, frame: Placement::translation(dvec3(2.0, 0.0, z)) };
    let way =
        Between { rails: [&rails[0], &rails[1]], stations: Stations::Through, repair: Repair::No };
    let solid = between(&[at(0.0), at(7.0)], &way, fine(0.01)).expect("a block");
    assert!((volume(&solid) - 112.0).abs() < 1e-9);
    let wrong = between(&[at(7.0), at(0.0)], &way, fine(0.01));
    assert!(matches!(wrong, Err(SweepError::Order { section: 1, .. })), "{wrong:?}");
    let beside = between(&[at(0.0), at(9.0)], &way, fine(0.01));
    assert!(matches!(beside, Err(SweepError::Beside { section: 1, .. })), "{beside:?}");
}

/// Rails turned about an axis sweep the body of revolution, the better the finer the tolerance.
#[test]
fn turned_rails_make_a_body_of_revolution() {
    let rail = |r: f64| ring(r, 0.0, 180.0);
    let (a, b) = (rail(5.0), rail(9.0));
    let base = square(1.0);
    // Upright in the plane of x and z, and the same after half a turn.
    let upright = |side: f64| {
        let linear = glam::DMat3::from_cols(DVec3::X * side, DVec3::Z, DVec3::NEG_Y * side);
        Placed { region: &base, frame: Placement::new(linear, DVec3::X * (7.0 * side)) }
    };
    let way = Between { rails: [&a, &b], stations: Stations::Through, repair: Repair::No };
    let exact = PI * 7.0 * 4.0;
    let area = PI * 7.0 * 8.0;
    let mut before: Option<(f64, usize)> = None;
    for mm in [0.16, 0.04, 0.01, 0.0025, 0.000_625] {
        let solid = between(&[upright(1.0), upright(-1.0)], &way, fine(mm)).expect("half a ring");
        for p in &solid.mesh().points {
            let off = (libm::hypot(p.x, p.y) - 7.0).abs().max(p.z.abs()) - 1.0;
            assert!(off.abs() < 1e-9, "a corner of the square is {off} off its circle");
        }
        let (off, faces) = (exact - volume(&solid), solid.mesh().face_count());
        assert!(off > 0.0 && off < area * mm, "{mm}: {off}");
        // About twice the steps, and an error that falls with their square.
        if let Some((last, count)) = before {
            let (steps, errors) = (faces as f64 / count as f64, last / off);
            assert!((1.5..4.5).contains(&steps), "{mm}: {steps}");
            assert!((errors / (steps * steps) - 1.0).abs() < 0.25, "{mm}: {errors} {steps}");
        }
        before = Some((off, faces));
    }
}

#[test]
fn rails_that_meet_close_to_a_point() {
    let (a, b) = (ring(10.0, 0.0, 180.0), ring(10.0, 0.0, -180.0));
    let half: Vec<DVec3> = (0..=8)
        .map(|i| {
            let angle = f64::from(i) * PI / 8.0;
            dvec3(0.0, 10.0 * libm::cos(angle), -6.0 * libm::sin(angle))
        })
        .collect();
    let section = row(&half);
    let narrow: Vec<DVec3> =
        half.iter().map(|p| dvec3(5.0, p.y * 0.75_f64.sqrt(), p.z * 0.75_f64.sqrt())).collect();
    let front = row(&narrow);
    let hull =
        surface(&[&front, &section], [&a, &b], Stations::Through, fine(0.02)).expect("a hull");
    let [nu, nv] = hull.size();
    for u in [0, nu - 1] {
        assert!((1..nv).all(|v| hull.point(u, v).distance(hull.point(u, 0)) < 1e-9));
    }
}
