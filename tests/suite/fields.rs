//! Offsets, fillets and shells against closed forms, and against the distance field on random solids.

use std::{f64::consts::PI, sync::Arc};

use glam::{DMat3, DQuat, DVec3, dvec3};
use katachi::{
    base::{Shelf, watch::Unwatched},
    convert::offset::{by_ellipsoid, deviation, fillet, offset},
    geom::{Placement, Tolerance},
    kernel::{
        brep::{
            Polyhedron,
            boolean::{Tree, evaluate},
            crossing::crossings,
            measure,
            primitive::{cone, cuboid, sphere, torus},
        },
        field::Polyhedral,
    },
    session::Session,
};

use crate::random::Random;

fn tolerance(mm: f64) -> Tolerance {
    Tolerance::new(mm).expect("positive")
}

fn block(from: [f64; 3], to: [f64; 3]) -> Polyhedron {
    cuboid(DVec3::from(from), DVec3::from(to))
}

fn moved(solid: Polyhedron, by: [f64; 3]) -> Polyhedron {
    solid.placed(&Placement::translation(DVec3::from(by)))
}

fn leaves(list: Vec<Polyhedron>) -> Vec<Tree> {
    list.into_iter().map(|solid| Tree::Leaf(Arc::new(solid))).collect()
}

fn union(list: Vec<Polyhedron>) -> Polyhedron {
    evaluate(&Tree::Union(leaves(list))).expect("closed").solid
}

fn difference(list: Vec<Polyhedron>) -> Polyhedron {
    evaluate(&Tree::Difference(leaves(list))).expect("closed").solid
}

/// A cube of 20 with a hole of radius 5.
fn hole(sides: u32) -> Polyhedron {
    let drill = moved(cone(5.0, 5.0, 30.0, sides), [10.0, 10.0, -5.0]);
    difference(vec![block([0.0; 3], [20.0; 3]), drill])
}

/// Two arms of 30, 5 wide and 10 high.
fn bracket() -> Polyhedron {
    union(vec![block([0.0; 3], [30.0, 5.0, 10.0]), block([0.0; 3], [5.0, 30.0, 10.0])])
}

/// Grows a solid, and checks that the result is closed, does not cross itself and is where it should be.
pub fn grown(solid: &Polyhedron, by: f64, allowed: f64) -> Polyhedron {
    let found = offset(solid, by, tolerance(allowed)).expect("an offset");
    assert_eq!(crossings(found.mesh()).len(), 0, "by {by}");
    assert!(Polyhedron::new(found.mesh().clone()).is_ok());
    assert!(by < 0.0 || !found.is_empty(), "what grows by {by} is not empty");
    let field = Polyhedral::new(solid.mesh()).expect("full");
    if let Some(off) = deviation(found.mesh(), &field, by) {
        assert!(off.most <= allowed, "by {by}: off by {} at {}", off.most, off.at);
    }
    found
}

/// Whether a volume is the expected one within 0.1 % and what the tolerance times the area allows.
fn assert_volume(solid: &Polyhedron, expected: f64, allowed: f64) {
    let slack = 1e-3 * expected + measure::area(solid) * allowed;
    let found = measure::volume(solid);
    assert!((found - expected).abs() <= slack, "{found}, expected {expected}");
}

#[test]
fn offsets_have_the_volumes_of_closed_forms() {
    let fine = 0.005;
    let case = |solid: &Polyhedron, by: f64, expected: f64| {
        let found = grown(solid, by, fine);
        assert_volume(&found, expected, fine);
        found
    };
    case(&block([0.0; 3], [10.0, 20.0, 30.0]), 2.0, 11187.492558);
    case(&bracket(), 2.0, 7152.283105);
    case(&bracket(), -1.0, 1273.716815);
    assert_eq!(measure::genus(&case(&hole(64), 2.0, 12871.728382)), 1);
    let half =
        difference(vec![block([0.0; 3], [10.0; 3]), block([5.0, -1.0, -1.0], [15.0, 11.0, 11.0])]);
    let half = case(&half, 4.0, 3624.719635);
    assert_eq!(measure::bounds(&half).expect("full")[1].x, 9.0);
    let slab = |axis: usize| {
        let mut reach = DVec3::splat(40.0);
        reach[axis] = 5.0;
        cuboid(-reach, reach)
    };
    let slabs = Tree::Intersection(leaves((0..3).map(slab).collect()));
    case(&evaluate(&slabs).expect("closed").solid, 2.0, 2610.501440);
    case(&block([0.0; 3], [0.5; 3]), 5.0, 649.033500);
}

#[test]
fn a_union_is_shrunk_from_its_own_boundary() {
    let two = union(vec![block([0.0; 3], [6.0; 3]), block([4.0, 0.0, 0.0], [10.0, 6.0, 6.0])]);
    let shrunk = grown(&two, -1.5, 0.01);
    assert!((measure::volume(&shrunk) - 63.0).abs() < 1e-9);
    assert_eq!(measure::shells(&shrunk), 1);
}

#[test]
fn nothing_is_left_of_what_is_too_thin() {
    for (size, by) in [([10.0, 10.0, 1.0], -0.6), ([1.0, 1.0, 10.0], -0.6), ([1.0; 3], -7.0)] {
        assert!(grown(&block([0.0; 3], size), by, 0.01).is_empty());
    }
}

#[test]
fn radii_that_are_none_or_too_large_are_told() {
    use katachi::convert::offset::OffsetError;
    let cube = block([0.0; 3], [10.0; 3]);
    for by in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let found = offset(&cube, by, tolerance(0.01));
        assert!(matches!(found, Err(OffsetError::NotFinite(_))), "{by}");
    }
    assert!(offset(&cube, -1e9, tolerance(0.01)).expect("nothing").is_empty());
    let Err(OffsetError::TooFine { found, limit, fitting }) = offset(&cube, 1e9, tolerance(0.01))
    else {
        panic!("a ball of a million kilometres at a hundredth of a millimetre")
    };
    assert!(found > limit as f64 && fitting > 0.01);
    assert!(fillet(&cube, 100.0, 0.0, tolerance(0.01)).expect("nothing").is_empty());
}

/// The figures of the library's promises: triangles, and a true surface within the tolerance.
#[test]
fn few_triangles_do() {
    let count =
        |solid: &Polyhedron, by: f64, allowed: f64| measure::triangles(&grown(solid, by, allowed));
    assert!(count(&hole(64), 2.0, 0.006) < 12_500 / 3 * 2);
    // One and a half of what Open CASCADE has.
    assert!(count(&block([0.0; 3], [10.0, 20.0, 30.0]), 2.0, 0.015) < 892 / 2 * 3);
    assert!(count(&bracket(), 2.0, 0.015) < 1160 / 2 * 3);
    assert!(count(&hole(64), 2.0, 0.015) < 2336 / 2 * 3);
    assert!(count(&hole(64), 2.0, 0.01) < 105_000 / 8);
}

#[test]
fn flat_faces_stay_flat() {
    let round = grown(&block([0.0; 3], [10.0, 20.0, 30.0]), 2.0, 0.05);
    let mesh = round.mesh();
    let large = mesh.faces().filter(|f| f.area_vector().length() / 2.0 > 150.0);
    assert_eq!(large.clone().count(), 6);
    for face in large {
        assert_eq!(face.outer().len(), 4);
        let axis = face.area_vector().abs().max_position();
        let levels: Vec<f64> =
            face.outer().iter().map(|&c| mesh.points[c as usize][axis]).collect();
        assert!(levels.iter().all(|z| *z == levels[0]), "{levels:?}");
    }
}

#[test]
fn holes_close_and_parts_join() {
    let drill = moved(cone(1.0, 1.0, 30.0, 32), [5.0, 5.0, -1.0]);
    let narrow = difference(vec![block([0.0; 3], [10.0; 3]), drill]);
    assert_eq!(measure::genus(&grown(&narrow, 0.5, 0.02)), 1);
    assert_eq!(measure::genus(&grown(&narrow, 2.0, 0.02)), 0);
    let mut apart = block([0.0; 3], [4.0; 3]).into_mesh();
    apart.append(block([7.0, 1.0, 1.0], [9.0, 3.0, 3.0]).mesh());
    let apart = Polyhedron::new(apart).expect("closed");
    assert_eq!(measure::shells(&grown(&apart, 1.0, 0.02)), 2);
    assert_eq!(measure::shells(&grown(&apart, 2.0, 0.02)), 1);
}

#[test]
fn round_solids_are_offset_too() {
    for by in [2.0, -2.0] {
        grown(&sphere(10.0, 32), by, 0.03);
        grown(&torus(10.0, 4.0, 32, 24), by / 2.0, 0.03);
    }
    grown(&cone(10.0, 0.0, 12.0, 48), 1.0, 0.02);
    grown(&cone(10.0, 0.0, 12.0, 48), -1.0, 0.02);
}

#[test]
fn an_ellipsoid_reaches_as_far_as_its_radii() {
    let cube = block([0.0; 3], [4.0; 3]);
    let found = by_ellipsoid(&cube, dvec3(1.0, 2.0, 0.5), tolerance(0.005)).expect("an offset");
    let expected = [dvec3(-1.0, -2.0, -0.5), dvec3(5.0, 6.0, 4.5)];
    assert_eq!(measure::bounds(&found), Some(expected));
    // Steiner's formula in the scaled space: sides 4, 2 and 8 there.
    let (a, b, c) = (4.0, 2.0, 8.0);
    let steiner = a * b * c + 2.0 * (a * b + b * c + c * a) + PI * (a + b + c) + 4.0 / 3.0 * PI;
    assert_volume(&found, steiner, 0.005);
}

fn filleted(solid: &Polyhedron, convex: f64, concave: f64, allowed: f64) -> Polyhedron {
    let found = fillet(solid, convex, concave, tolerance(allowed)).expect("a fillet");
    assert_eq!(crossings(found.mesh()).len(), 0);
    assert!(Polyhedron::new(found.mesh().clone()).is_ok());
    found
}

#[test]
fn fillets_have_the_volumes_of_closed_forms() {
    let fine = 0.005;
    let brick = filleted(&block([0.0; 3], [10.0, 20.0, 30.0]), 2.0, 0.0, fine);
    assert_volume(&brick, 5804.696111, fine);
    let ball = filleted(&block([0.0; 3], [10.0; 3]), 5.0, 0.0, fine);
    assert_volume(&ball, 523.598776, fine);
    assert_eq!(measure::shells(&ball), 1);
    let inner = filleted(&bracket(), 0.0, 2.0, fine);
    assert_volume(&inner, 2750.0 + (1.0 - PI / 4.0) * 4.0 * 10.0, fine);
    assert!(measure::volume(&inner) > 2758.5);
    let foot = cone(20.0, 20.0, 5.0, 128);
    let stepped = union(vec![foot, moved(cone(10.0, 10.0, 8.0, 128), [0.0, 0.0, 5.0])]);
    let change = |allowed: f64| {
        measure::volume(&filleted(&stepped, 1.0, 1.5, allowed)) - measure::volume(&stepped)
    };
    for allowed in [0.01, 0.005] {
        let found = change(allowed);
        assert!((found + 35.16).abs() < 0.001 * 35.16, "{found} at {allowed}");
    }
}

#[test]
fn cores_that_shrink_to_a_face_or_a_line_carry_their_ball() {
    let plate = filleted(&block([0.0; 3], [20.0, 20.0, 2.0]), 1.0, 0.0, 0.01);
    assert_volume(&plate, 18.0 * 18.0 * 2.0 + 18.0 * 2.0 * PI + 4.0 / 3.0 * PI, 0.01);
    let bar = filleted(&block([0.0; 3], [4.0, 4.0, 20.0]), 2.0, 0.0, 0.01);
    assert_volume(&bar, 16.0 * 4.0 * PI + 4.0 / 3.0 * PI * 8.0, 0.01);
}

#[test]
fn fillets_that_others_refuse() {
    let plate = || block([-20.0, -20.0, 0.0], [20.0, 20.0, 5.0]);
    let boss = |x: f64| moved(cone(5.0, 5.0, 10.0, 48), [x, 0.0, 0.0]);
    let drill = moved(cone(5.0, 5.0, 10.0, 48), [0.0, 0.0, -1.0]);
    let pipe = |r: f64, axis: DVec3| {
        let turn = DMat3::from_quat(DQuat::from_rotation_arc(DVec3::Z, axis));
        cone(r, r, 30.0, 48).placed(&Placement::new(turn, axis * -15.0))
    };
    let cases = [
        ("half the thickness", difference(vec![plate(), drill.clone()]), 2.5, 0.0),
        ("a hole through", difference(vec![plate(), drill]), 1.0, 1.0),
        ("a boss near an edge", union(vec![plate(), boss(14.0)]), 1.0, 2.0),
        ("a cylinder tangent to a face", union(vec![plate(), boss(15.0)]), 1.0, 2.0),
        (
            "a concave radius as large as the step",
            union(vec![plate(), block([-10.0, -10.0, 5.0], [10.0, 10.0, 7.0])]),
            0.5,
            2.0,
        ),
        (
            "a hole within the radius of a boss",
            difference(vec![
                union(vec![plate(), boss(0.0)]),
                moved(cone(3.0, 3.0, 10.0, 32), [9.0, 0.0, -1.0]),
            ]),
            0.0,
            2.5,
        ),
        ("cylinders that cross", union(vec![pipe(6.0, DVec3::Z), pipe(6.0, DVec3::X)]), 1.0, 2.0),
        (
            "a slot narrower than the ball",
            difference(vec![plate(), block([-1.0, -10.0, 2.0], [1.0, 10.0, 8.0])]),
            1.0,
            1.5,
        ),
        ("the point of a pyramid", cone(10.0, 0.0, 12.0, 4), 1.0, 0.0),
    ];
    for (name, solid, convex, concave) in cases {
        let found = filleted(&solid, convex, concave, 0.02);
        assert!(measure::shells(&found) == 1, "{name}");
    }
}

impl Random {
    fn solid(&mut self) -> Polyhedron {
        let parts = (0..2 + (self.next() * 2.0) as usize).map(|_| self.part()).collect();
        if self.next() < 0.5 { union(parts) } else { difference(parts) }
    }

    fn part(&mut self) -> Polyhedron {
        let mut size = || 2.0 + 6.0 * self.next();
        let (a, b, c) = (size(), size(), size());
        let part = match (self.next() * 3.0) as u32 {
            0 => block([0.0; 3], [a, b, c]),
            1 => cone(a / 2.0, b / 2.0, c, 8 + (self.next() * 8.0) as u32),
            _ => cone(a / 2.0, a / 2.0, c, 16),
        };
        let turn = DQuat::from_xyzw(self.next() - 0.5, self.next() - 0.5, self.next() - 0.5, 1.0);
        let turned = if self.next() < 0.5 { DQuat::IDENTITY } else { turn.normalize() };
        let at = dvec3(self.next(), self.next(), self.next()) * 6.0;
        part.placed(&Placement::new(DMat3::from_quat(turned), at))
    }
}

fn offset_of_many(seed: u64, count: usize) {
    let (mut random, mut empty) = (Random(seed), 0);
    for _ in 0..count {
        let solid = random.solid();
        if solid.is_empty() {
            continue;
        }
        let by = 1.5 * random.next() - 0.6;
        empty += usize::from(grown(&solid, by, 0.03).is_empty());
    }
    assert!(empty < count / 2);
}

#[test]
fn random_solids_are_offset() {
    offset_of_many(11, 40);
}

#[test]
#[ignore = "takes minutes; the gate runs it"]
fn five_hundred_random_solids_are_offset() {
    offset_of_many(2026, 500);
}

fn volume_of(source: &str) -> f64 {
    let shelf = Shelf(&[("model.kata", source)]);
    let session = Session::new(&shelf, &Unwatched, Some(tolerance(0.01)));
    let (mut model, diagnostics) = session.compile("model.kata", &[]);
    assert!(diagnostics.is_empty(), "{diagnostics:?}");
    model.measure(&[]).found[0].1.volume
}

#[test]
fn the_language_offsets_fillets_and_shells() {
    let near = |source: &str, expected: f64| {
        let found = volume_of(source);
        assert!((found / expected - 1.0).abs() < 4e-3, "{source}: {found}, expected {expected}");
    };
    near("box(10, 20, 30).offset(2)", 11187.492558);
    near("box(10, 20, 30).offset(2) & box(10, 20, 30)", 6000.0);
    near("box(10, 20, 30).fillet(convex = 2)", 5804.696111);
    near("box(10, 10, 10).shell(1)", 1000.0 - 512.0);
    near("rect(10, 10).shell(1).extrude(2)", 72.0);
    near("rect(10, 10).fillet(convex = 1).extrude(2)", 2.0 * (100.0 - (4.0 - PI)));
    near("box(4, 4, 4).offset([1, 2, 0.5])", 224.171087);
}
