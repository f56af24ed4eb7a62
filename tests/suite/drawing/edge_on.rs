//! Faces that are seen as lines: rounding folds their pictures over, and their planes do not tell what is behind them.

use std::collections::BTreeSet;

use glam::{DMat3, DVec3, dvec3};
use katachi::{
    geom::{Placement, Tolerance},
    kernel::brep::{
        Polyhedron,
        primitive::{cone, cuboid},
    },
    output::drawing::{Camera, Method, Options, Scene, View, visible_lines},
};

use super::scenes::{drawn, near};

/// Towards the eye of an isometric view.
const EYE: DVec3 = DVec3::new(1.0, -1.0, 1.0);

/// The length in the picture of all sides of the faces of a convex solid that are towards the eye.
fn seen(solid: &Polyhedron) -> f64 {
    let (mesh, sight) = (solid.mesh(), EYE.normalize());
    let mut edges = BTreeSet::new();
    for face in mesh.faces() {
        if face.area_vector().normalize().dot(sight) > 1e-6 {
            let corners = face.outer();
            let next = corners.iter().cycle().skip(1);
            edges.extend(corners.iter().zip(next).map(|(a, b)| (*a.min(b), *a.max(b))));
        }
    }
    let length = |(a, b): (u32, u32)| {
        (mesh.points[b as usize] - mesh.points[a as usize]).reject_from(sight).length()
    };
    edges.into_iter().map(length).sum()
}

#[test]
fn outlines_beside_faces_that_are_edge_on_are_drawn() {
    // Along y, with two facets of 36 in the direction of the sight lines.
    let lying = DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y);
    for i in 0..12 {
        let at = dvec3(75.0 - 7.3 * f64::from(i), 1.7 * f64::from(i), 2.5);
        let prism = cone(2.5, 2.5, 70.0, 36).placed(&Placement::new(lying, at));
        for method in [Method::Count, Method::Clip] {
            let tolerance = Tolerance::new(0.001).expect("positive");
            let options = Options { method, tolerance, ..Options::default() };
            let scene = Scene::of([prism.mesh()]);
            let found = visible_lines(&scene, &Camera::view(View::Iso), &options).visible;
            assert!(near(found, seen(&prism), 1e-7), "{i} {method:?}: {found} {}", seen(&prism));
        }
    }
}

#[test]
fn lines_across_faces_that_are_edge_on_are_counted_right() {
    let quarter = DMat3::from_rotation_z(std::f64::consts::FRAC_PI_4);
    for i in 0..12 {
        let shift = 0.137 * f64::from(i);
        let tower = cuboid(DVec3::splat(-5.0), dvec3(5.0, 5.0, 20.0))
            .placed(&Placement::new(quarter, dvec3(shift, 0.31 * shift, 0.0)));
        let turn = DMat3::from_rotation_x(0.2 + shift) * DMat3::from_rotation_y(shift);
        let bar = |at: DVec3| {
            cuboid(dvec3(-30.0, -0.5, -0.5), dvec3(30.0, 0.5, 0.5))
                .placed(&Placement::new(turn, at))
        };
        let solids = [tower, bar(EYE * 40.0), bar(EYE * -40.0)];
        let camera = Camera::view(View::Iso);
        let [auto, count, clip] =
            [Method::Auto, Method::Count, Method::Clip].map(|m| drawn(&solids, &camera, m));
        for other in [count, clip] {
            assert!(near(other.visible, auto.visible, 1e-7), "{i}: {}", other.visible);
            assert!(near(other.hidden, auto.hidden, 1e-7), "{i}: {}", other.hidden);
        }
    }
}
