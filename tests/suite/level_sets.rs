//! Solids of charges and formulas, and offsets that are contoured, against closed forms.

use std::f64::consts::PI;

use glam::DVec3;
use katachi::{
    base::{Shelf, watch::Unwatched},
    convert::{contour::metaball, offset::tested},
    geom::{Charge, Falloff, Tolerance},
    kernel::{
        brep::{
            Polyhedron,
            crossing::crossings,
            measure,
            primitive::{cuboid, torus},
        },
        field::{Metaball, Test, smooth::Smooth},
    },
    session::Session,
    shape::Measures,
};

use crate::{fields::grown, random::Random};

fn tolerance(mm: f64) -> Tolerance {
    Tolerance::new(mm).expect("positive")
}

fn measured(source: &str, mm: f64) -> Measures {
    let shelf = Shelf(&[("model.kata", source)]);
    let session = Session::new(&shelf, &Unwatched, Some(tolerance(mm)));
    let (mut model, diagnostics) = session.compile("model.kata", &[]);
    assert!(diagnostics.is_empty(), "{source}: {diagnostics:?}");
    let found = model.measure(&[]);
    (*found.found[0].1).clone()
}

/// Whether a volume is the expected one within 0.1 % and what the tolerance times the area allows.
fn assert_volume(source: &str, expected: f64) {
    let found = measured(source, 0.01);
    let slack = 1e-3 * expected + found.area * 0.01;
    assert!(found.closed, "{source}");
    assert!((found.volume - expected).abs() <= slack, "{source}: {}, {expected}", found.volume);
}

#[test]
fn one_charge_is_a_sphere() {
    let ball = |r: f64| 4.0 / 3.0 * PI * r.powi(3);
    assert_volume("metaball([{ at = [1, 2, 3] }], threshold = 0.2)", ball(5.0));
    assert_volume("metaball([{ at = [0, 0, 0], q = 4 }])", ball(4.0));
    let square = "metaball([{ at = [0, 0, 0], q = 8, falloff = INVERSE_SQUARE }], threshold = 0.5)";
    assert_volume(square, ball(4.0));
    // exp(-(d / r)^2) = 1 / e at d = r.
    let blinn = "metaball([{ at = [0, 0, 0], falloff = BLINN, r = 5 }], threshold = 0.36787944)";
    assert_volume(blinn, ball(5.0));
    // 1 - 22/9 u + 17/9 u^2 - 4/9 u^3 = 1/2 at u = 1/4.
    let wyvill = "metaball([{ at = [0, 0, 0], falloff = WYVILL, r = 8 }], threshold = 0.5)";
    assert_volume(wyvill, ball(4.0));
}

#[test]
fn two_charges_merge_below_the_threshold_between_them() {
    let two = |t: f64| {
        format!("metaball([{{ at = [-2, 0, 0] }}, {{ at = [2, 0, 0] }}], threshold = {t})")
    };
    assert_eq!(measured(&two(0.99), 0.01).shells, 1);
    assert_eq!(measured(&two(1.01), 0.01).shells, 2);
    let pushed =
        "metaball([{ at = [-2, 0, 0], q = 2 }, { at = [2, 0, 0], q = -1 }], threshold = 0.1)";
    let bounds = measured(pushed, 0.01).bounds.expect("full");
    assert!(bounds[1].x < 8.0 && bounds[0].x < -14.0, "{bounds:?}");
}

#[test]
fn formulas_are_solids() {
    let box20 = "within = [[-10, -10, -10], [10, 10, 10]]";
    assert_volume(&format!("field(p => norm(p) - 6, {box20})"), 288.0 * PI);
    let cube = "max([abs(p.x), abs(p.y), abs(p.z)]) - 5";
    assert_volume(&format!("field(p => {cube}, {box20})"), 1000.0);
    let ring = "norm([norm([p.x, p.y]) - 6, p.z]) - 2";
    assert_volume(&format!("field(p => {ring}, {box20})"), 48.0 * PI * PI);
    // Two overlapping balls of radius 4, 4 apart: two caps of height 2 count once.
    let two = "(if p.x < 0 { norm(p + [2, 0, 0]) } else { norm(p - [2, 0, 0]) }) - 4";
    let expected = 2.0 * (4.0 / 3.0 * PI * 64.0) - 2.0 * PI * 4.0 * (12.0 - 2.0) / 3.0;
    assert_volume(&format!("field(p => {two}, {box20})"), expected);
    let sum = "1 - sum(for c in [[-3, 0, 0], [3, 0, 0]] { 16mm^2 / dot(p - c, p - c) })";
    assert_eq!(measured(&format!("field(p => {sum}, {box20})"), 0.02).shells, 1);
}

#[test]
fn sharp_edges_of_formulas_stay_sharp() {
    let cube = "max([abs(p.x), abs(p.y), abs(p.z)]) - 5";
    let found =
        measured(&format!("field(p => {cube}, within = [[-10, -10, -10], [10, 10, 10]])"), 0.05);
    assert!((found.volume - 1000.0).abs() < 1e-6, "{}", found.volume);
    assert!(found.triangles < 200, "{}", found.triangles);
}

#[test]
fn few_triangles_are_within_the_tolerance() {
    // A ball of 6 mm within 0.01 mm: at best some 4 pi / (0.77 * 4 * 0.01 / 6) triangles.
    let ball = measured("field(p => norm(p) - 6, within = [[-10, -10, -10], [10, 10, 10]])", 0.01);
    assert!(ball.triangles < 7_000, "{}", ball.triangles);
    let pill = "metaball([{ at = [-8, 0, 0], q = 5 }, { at = [8, 0, 0], q = 5 }])";
    let pill = measured(pill, 0.01);
    assert!(pill.triangles < 10_000, "{}", pill.triangles);
}

#[test]
fn what_folds_at_many_places_is_contoured() {
    let ring = grown(&torus(10.0, 4.0, 48, 32), 7.0, 0.03);
    assert_eq!(measure::genus(&ring), 0);
    let cube = cuboid(DVec3::ZERO, DVec3::splat(10.0));
    let back = grown(&grown(&cube, 1.0, 0.01), -2.0, 0.03);
    // Chords of the first offset lie inside, so the second one rounds edges by a trifle.
    assert!((measure::volume(&back) - 512.0).abs() < 2.0, "{}", measure::volume(&back));
}

impl Random {
    fn point(&mut self, reach: f64) -> DVec3 {
        (DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0) * reach
    }

    fn charge(&mut self) -> Charge {
        let r = 3.0 + 3.0 * self.next();
        let falloff = match (self.next() * 4.0) as usize {
            0 => Falloff::Inverse,
            1 => Falloff::InverseSquare,
            2 => Falloff::Wyvill { r },
            _ => Falloff::Blinn { r },
        };
        let strength = 1.0 + 3.0 * self.next();
        let q = if self.next() < 0.25 { -strength } else { strength };
        Charge { at: self.point(5.0), q, falloff }
    }
}

/// Random blobs are closed, free of crossings, and everywhere within the tolerance by their own function.
#[test]
fn random_charges_bound_solids() {
    let mut random = Random(3);
    for i in 0..12 {
        let charges: Vec<Charge> = (0..2 + i % 4).map(|_| random.charge()).collect();
        let threshold = 0.5 + random.next();
        let found = metaball(&charges, threshold, tolerance(0.05)).expect("a solid");
        assert_eq!(crossings(found.mesh()).len(), 0, "{charges:?}");
        assert!(Polyhedron::new(found.mesh().clone()).is_ok());
        let function = Metaball::new(charges.clone(), threshold);
        for p in &found.mesh().points {
            let off = function.value(*p).abs() / function.gradient(*p).length();
            assert!(off <= 0.1, "{charges:?} {threshold}: off by {off} at {p}");
        }
    }
}

#[test]
fn the_hypersphere_tests_agree() {
    let grain = cuboid(DVec3::ZERO, DVec3::splat(0.5));
    let block = cuboid(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.0));
    for (solid, by, expected) in [(&grain, 2.0, 55.485), (&block, 1.0, 108.462)] {
        let found = |test: Test| tested(solid, by, test, tolerance(0.15)).expect("an offset");
        let [exact, halved] = [Test::Exact, Test::Quadtree].map(found);
        let [a, b] = [&exact, &halved].map(measure::volume);
        assert!((a / expected - 1.0).abs() < 0.01, "{a}");
        // Areas are halved down to half of the tolerance, and triangles lie inside by as much as it allows.
        assert!((b - a).abs() < 0.15 * measure::area(&exact), "{b} {a}");
        // No hole in the middle, where the solid lies inside of the sphere.
        assert_eq!(measure::shells(&halved), 1);
    }
    let random = Test::MonteCarlo { n: 1000, seed: 7 };
    let sampled = tested(&block, 1.0, random, tolerance(0.15)).expect("an offset");
    assert!(
        (measure::volume(&sampled) / 108.462 - 1.0).abs() < 0.1,
        "{}",
        measure::volume(&sampled)
    );
    let shrunk = tested(&block, -0.5, Test::Quadtree, tolerance(0.1)).expect("an offset");
    assert!((measure::volume(&shrunk) - 6.0).abs() < 1.0, "{}", measure::volume(&shrunk));
}

#[test]
fn fields_tell_distances() {
    let source = "s = box(10, 10, 10)
assert near(s.field().at([0, 0, 15]), 5mm)
assert near(s.field().at([0, 0, 4]), -4mm)
assert near(distance(s, [8, 0, 5]), 3mm)
assert inside(s, [0, 0, 4], by = FIELD) and inside(s, [5, 0, 10], by = FIELD)
assert not inside(s, [5.001, 0, 4], by = FIELD)
assert inside(s.rotate(z = 17deg).rotate(x = 40deg), [0, 0, 0], by = FIELD)
assert not inside(s & box(1, 1, 1).move(x = 50), [0, 0, 0], by = FIELD)
part p = s";
    assert!((measured(source, 0.1).volume - 1000.0).abs() < 1e-9);
}

#[test]
fn the_same_bytes_come_from_one_and_two_threads() {
    let ring = torus(10.0, 4.0, 24, 16);
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| grown(&ring, 7.0, 0.1))
    };
    assert_eq!(of(1).mesh(), of(2).mesh());
}
