//! Drawings of surfaces that are known by their facets alone, against those of the true ones.

use std::f64::consts::TAU;

use glam::DVec3;
use katachi::{
    geom::{Origin, PolyMesh, Surface},
    kernel::brep::primitive::{sphere, torus},
    output::drawing::{Camera, Drawing, Options, Scene, visible_lines},
};

/// A drawing of a mesh whose surfaces are forgotten.
fn drawn(mesh: &PolyMesh, camera: &Camera) -> Drawing {
    let forgotten = |o: &mut Origin| o.surface = Surface::Smooth;
    let mesh = mesh.clone().with_origins(forgotten);
    visible_lines(&Scene::of([&mesh]), camera, &Options::default())
}

#[test]
fn the_outline_of_a_ball_of_facets_is_one_circle() {
    for (distance, radius) in [(50.0, 10.206_207), (15.0, 13.416_408)] {
        let eye = DVec3::new(0.48, -0.6, 0.64) * distance;
        let camera = Camera::perspective(eye, DVec3::ZERO).expect("apart");
        let found = drawn(sphere(10.0, 48).mesh(), &camera);
        assert_eq!((found.lines.len(), found.hidden), (1, 0.0));
        let outline = found.visible / TAU;
        assert!((outline / radius - 1.0).abs() < 2e-4, "{outline}");
    }
}

#[test]
fn contours_of_a_torus_of_facets_end_in_cusps() {
    let camera = Camera::parallel(DVec3::new(0.0, -(3.0f64.sqrt()), 1.0)).expect("a direction");
    let found = drawn(torus(30.0, 10.0, 80, 32).mesh(), &camera);
    assert!((found.visible - 291.781_271).abs() < 0.06, "{}", found.visible);
    assert!((found.hidden - 5.786_444).abs() < 0.12, "{}", found.hidden);
    assert!(found.lines.len() < 20, "{} lines", found.lines.len());
}
