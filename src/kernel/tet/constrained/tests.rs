use std::f64::consts::TAU;

use glam::dvec3;

use super::*;
use crate::{
    geom::{Origin, Surface, trig},
    kernel::tet::complex::Across,
};

/// A mesh of triangles over points.
fn mesh(points: Vec<DVec3>, faces: &[Vec<u32>]) -> PolyMesh {
    let mut mesh = PolyMesh::with_points(points);
    let origin = mesh.add_origin(Origin::of(Surface::Plane));
    for face in faces {
        let plane = mesh.add_plane();
        mesh.push_face(&[face], plane, origin);
    }
    mesh
}

/// A box between two corners.
fn cuboid(min: DVec3, max: DVec3) -> PolyMesh {
    let at = |i: u32| {
        let pick = |bit: u32, low: f64, high: f64| if i >> bit & 1 == 1 { high } else { low };
        dvec3(pick(0, min.x, max.x), pick(1, min.y, max.y), pick(2, min.z, max.z))
    };
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    mesh((0..8).map(at).collect(), &faces.map(|face| face.to_vec()))
}

fn filled(boundary: &PolyMesh) -> Complex {
    let complex = tetrahedralize(boundary).expect("sound");
    assert_eq!(complex.check(), Ok(()));
    complex
}

#[test]
fn a_cuboid_is_six_tetrahedra() {
    let complex = filled(&cuboid(DVec3::ZERO, dvec3(1.0, 2.0, 3.0)));
    assert_eq!((complex.mesh().tetrahedra.len(), complex.mesh().boundary.len()), (6, 12));
    assert_eq!((complex.volume(), complex.flat_count()), (6.0, 0));
    let outside = (0..6u32).flat_map(|t| (0..4).map(move |c| (t, c)));
    let outside = outside.filter(|&(t, c)| matches!(complex.across(t, c), Across::Outside(_)));
    assert_eq!(outside.count(), 12);
}

#[test]
fn a_twisted_prism_needs_points_of_its_own() {
    // Schoenhardt's polyhedron has no tetrahedra over its six corners alone.
    let ring = |z: f64, turn: f64| {
        (0..3).map(move |i| {
            let angle = (f64::from(i) / 3.0 * TAU + turn).to_degrees();
            dvec3(trig::cos_deg(angle), trig::sin_deg(angle), z)
        })
    };
    let points: Vec<DVec3> = ring(0.0, 0.0).chain(ring(1.0, TAU / 12.0)).collect();
    let mut faces = vec![vec![2, 1, 0], vec![3, 4, 5]];
    for i in 0..3 {
        let j = (i + 1) % 3;
        // The reflex diagonal of each side.
        faces.extend([vec![i, j, 3 + i], vec![j, 3 + j, 3 + i]]);
    }
    let reflex = mesh(points, &faces);
    let complex = filled(&reflex);
    let exact: f64 = reflex
        .faces()
        .map(|f| {
            let p = |k: usize| reflex.points[f.outer()[k] as usize];
            p(0).cross(p(1)).dot(p(2)) / 6.0
        })
        .sum();
    assert!((complex.volume() - exact).abs() < 1e-6, "{} of {exact}", complex.volume());
}

#[test]
fn solids_that_touch_are_filled() {
    let cube = |at: DVec3| cuboid(at, at + DVec3::ONE);
    // Along an edge, in a corner, with a corner on an edge, and with a corner in the middle of a face.
    for by in [dvec3(1.0, 1.0, 0.0), DVec3::ONE, dvec3(1.0, 1.0, 0.5)] {
        let mut two = cube(DVec3::ZERO);
        two.append(&cube(by));
        assert_eq!(filled(&two).volume(), 2.0);
    }
    let mut stood = cuboid(DVec3::splat(-4.0), dvec3(4.0, 4.0, 0.0));
    let tip = vec![DVec3::ZERO, dvec3(1.0, 0.0, 2.0), dvec3(0.0, 1.0, 2.0), dvec3(-1.0, -1.0, 2.0)];
    stood.append(&mesh(tip, &[vec![0, 2, 1], vec![0, 3, 2], vec![0, 1, 3], vec![1, 2, 3]]));
    assert_eq!(filled(&stood).volume(), 256.0 + 1.0);
}

#[test]
fn far_from_the_origin_nothing_is_turned_unsaid() {
    for distance in [1e3, 1e6, 1e9, 1e12, 1e15] {
        let by = DVec3::splat(distance);
        let mut plates = cuboid(by, by + dvec3(40.0, 30.0, 1.0));
        plates.append(&cuboid(by + dvec3(1.0, 1.0, 1.0), by + dvec3(3.0, 3.0, 2.0)));
        match tetrahedralize(&plates) {
            Ok(complex) => assert_eq!(complex.check(), Ok(()), "{distance}"),
            Err(why) => assert!(distance > 1e9, "{distance}: {why}"),
        }
    }
}

#[test]
fn a_hollow_stays_empty() {
    let mut hollow = cuboid(DVec3::splat(-2.0), DVec3::splat(2.0));
    let mut inner = cuboid(DVec3::NEG_ONE, DVec3::ONE);
    inner.flip();
    hollow.append(&inner);
    let complex = filled(&hollow);
    assert_eq!(complex.volume(), 64.0 - 8.0);
    assert!(crate::kernel::tet::walk::Walk::new(&complex).locate(DVec3::ZERO).is_none());
}

#[test]
fn what_cannot_be_filled_is_told() {
    let flat = mesh(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[vec![0, 1, 2], vec![0, 2, 1]]);
    assert!(matches!(tetrahedralize(&flat), Err(NoTetrahedra::Flat { corners: 3 })));
    let whole = cuboid(DVec3::ZERO, DVec3::ONE);
    let faces: Vec<Vec<u32>> = whole.faces().skip(1).map(|f| f.outer().to_vec()).collect();
    let open = mesh(whole.points.clone(), &faces);
    assert!(matches!(tetrahedralize(&open), Err(NoTetrahedra::Open { .. })));
    let mut crossing = whole;
    crossing.append(&cuboid(DVec3::splat(0.25), dvec3(0.75, 0.75, 2.0)));
    let found = tetrahedralize(&crossing);
    assert!(matches!(found, Err(NoTetrahedra::Crossing { .. } | NoTetrahedra::TooMany { .. })));
}
