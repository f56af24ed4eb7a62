//! Known lengths.

use glam::{DVec3, dvec2};
use katachi::{
    kernel::brep::{
        Polyhedron,
        primitive::{cone, cuboid, sphere, torus},
    },
    output::drawing::{Camera, Method, View, Window},
};

use super::scenes::{boxes, camera, drawn, near, plate, union};

const METHODS: [Method; 3] = [Method::Auto, Method::Count, Method::Clip];

/// Checks visible and, where it is known, hidden length by every method.
fn check(solids: &[Polyhedron], camera: &Camera, visible: f64, hidden: Option<f64>, relative: f64) {
    for method in METHODS {
        let found = drawn(solids, camera, method);
        let lengths = (found.visible, found.hidden);
        assert!(near(found.visible, visible, relative), "{method:?}: {lengths:?}, not {visible}");
        if let Some(hidden) = hidden {
            assert!(near(found.hidden, hidden, relative), "{method:?}: {lengths:?}, not {hidden}");
        }
    }
}

#[test]
fn a_city_in_perspective() {
    // The figures are known to six decimals.
    check(&boxes("city"), &camera("city"), 2419.507501, Some(5352.400266), 1e-9);
}

#[test]
fn a_city_in_parallel_projection() {
    check(&boxes("city"), &camera("city_o"), 2381.888045, None, 1e-9);
}

#[test]
fn twelve_boxes_united() {
    let solids = [union(boxes("overlap"))];
    check(&solids, &camera("overlap"), 876.460554, Some(1118.142933), 1e-7);
}

#[test]
fn stairs_whose_edges_coincide_with_their_corners() {
    let step = |i: i32| {
        let (x, z) = (10.0 * f64::from(i), 10.0 * f64::from(i + 1));
        cuboid(DVec3::new(x, 0.0, 0.0), DVec3::new(x + 10.0, 30.0, z))
    };
    let stairs = union((0..5).map(step).collect());
    let visible = 390.0 * (2.0f64 / 3.0).sqrt();
    check(&[stairs], &Camera::view(View::Iso), visible, None, 1e-7);
}

#[test]
fn a_plate_whose_far_side_lies_under_its_near_side() {
    check(&[plate(24)], &Camera::view(View::Front), 260.0, Some(200.0), 1e-7);
}

#[test]
fn a_plate_with_a_hundred_holes() {
    // The ellipses of the holes are true curves, whatever the facets of the mesh.
    for sides in [24, 48] {
        let found = drawn(&[plate(sides)], &Camera::view(View::Iso), Method::Auto);
        assert!(near(found.visible, 2630.270, 1e-6), "{}", found.visible);
    }
}

/// The camera of a torus seen from so many degrees above its plane.
fn above(degrees: f64) -> Camera {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    Camera::parallel(DVec3::new(0.0, -cos, sin)).expect("a direction")
}

#[test]
fn a_torus_is_a_handful_of_curves() {
    let torus = [torus(30.0, 10.0, 80, 32)];
    let found = drawn(&torus, &above(30.0), Method::Auto);
    // By integrating the contour: between its cusps, and on the farther branch up to the crossing, it is hidden.
    assert!(near(found.visible, 291.781_271, 1e-6), "{}", found.visible);
    assert!(near(found.hidden, 5.786_444, 2e-5), "{}", found.hidden);
    assert!(found.lines.len() < 10, "{} lines", found.lines.len());
    let steep = drawn(&torus, &above(60.0), Method::Auto);
    assert!(near(steep.visible, 352.191, 1e-6) && steep.hidden == 0.0, "{}", steep.visible);
}

#[test]
fn a_sphere_in_perspective_is_larger_than_its_radius() {
    for (distance, radius) in [(50.0, 10.206_207_3), (15.0, 13.416_407_9)] {
        let eye = DVec3::new(0.6, -0.8, 0.0) * distance;
        let camera = Camera::perspective(eye, DVec3::ZERO).expect("apart");
        let found = drawn(&[sphere(10.0, 64)], &camera, Method::Auto);
        let outline = found.visible / std::f64::consts::TAU;
        assert!(near(outline, radius, 1e-8) && found.lines.len() == 1, "{outline}");
    }
}

#[test]
fn a_cylinder_is_drawn_by_its_rims_and_two_generators() {
    let cylinder = [cone(10.0, 10.0, 30.0, 32)];
    let front = drawn(&cylinder, &Camera::view(View::Front), Method::Auto);
    assert!(near(front.visible, 100.0, 1e-9) && front.hidden < 1e-9);
    let top = drawn(&cylinder, &Camera::view(View::Top), Method::Auto);
    assert!(near(top.visible, 20.0 * std::f64::consts::PI, 1e-9) && top.hidden < 1e-9);
    // What is asked for with few sides is a prism.
    let prism = drawn(&[cone(10.0, 10.0, 30.0, 6)], &Camera::view(View::Top), Method::Auto);
    assert!(near(prism.visible, 60.0, 1e-9), "{}", prism.visible);
}

#[test]
fn a_camera_among_the_solids_sees_what_is_before_it() {
    let room = |x: f64| cuboid(DVec3::new(x, -1.0, -1.0), DVec3::new(x + 2.0, 1.0, 1.0));
    let eye = Camera::perspective(DVec3::new(-1.0, 0.0, 0.0), DVec3::X * 9.0).expect("apart");
    let before = drawn(&[room(8.0)], &eye, Method::Auto);
    for method in METHODS {
        // One box is behind the eye, and the eye is inside another.
        let found = drawn(&[room(-9.0), room(-2.0), room(8.0)], &eye, method);
        let inside = found.lines.iter().filter(|l| l.id == 1).count();
        let seen: f64 = found.lines.iter().filter(|l| l.id == 2).map(|l| l.path.length()).sum();
        assert!(near(seen, before.visible + before.hidden, 1e-9), "{method:?}: {seen}");
        assert!(inside > 0 && found.lines.iter().all(|l| l.id != 0));
    }
}

#[test]
fn an_eye_on_a_face_sees_what_is_before_it() {
    let cube = |x: f64| cuboid(DVec3::new(x, -1.0, -1.0), DVec3::new(x + 2.0, 1.0, 1.0));
    let eye = Camera::perspective(DVec3::new(0.0, 0.2, 0.1), DVec3::X * 9.0).expect("apart");
    let before = drawn(&[cube(8.0)], &eye, Method::Auto);
    for method in METHODS {
        // The eye is on the face of the box behind it, and on that of the box around the way.
        for near_box in [cube(-2.0), cube(0.0)] {
            let found = drawn(&[near_box, cube(8.0)], &eye, method);
            let seen = found.lines.iter().filter(|l| l.id == 1 && l.order == 0);
            let seen: f64 = seen.map(|l| l.path.length()).sum();
            assert!(near(seen, before.visible, 1e-9), "{method:?}: {seen} {}", before.visible);
        }
    }
}

#[test]
fn lines_end_at_the_window() {
    let camera = Camera::view(View::Front);
    let half = Window { min: dvec2(-100.0, -100.0), max: dvec2(0.0, 100.0) };
    let camera = camera.with_window(half).expect("it has area");
    let found = drawn(&[plate(24)], &camera, Method::Auto);
    assert!(near(found.visible, 130.0, 1e-7) && near(found.hidden, 100.0, 1e-7));
    let round = drawn(&[sphere(10.0, 64)], &camera, Method::Auto);
    assert!(near(round.visible, 10.0 * std::f64::consts::PI, 1e-7), "{}", round.visible);
}

#[test]
fn the_far_rim_is_seen_through_a_hole() {
    let direction = DVec3::new(0.2, -0.1, 1.0);
    let camera = Camera::parallel(direction).expect("a direction");
    let image = |p: DVec3| camera.project(p).expect("parallel");
    // Edges of the slab, of which three are hidden, and the rims: what is seen of the lower one is over it in the
    // upper circle.
    let [x, y, z] = DVec3::AXES.map(|axis| image(axis).length());
    let edges = 3.0 * (120.0 * x + 120.0 * y + 10.0 * z);
    let count = 20_000;
    let (mut upper, mut lower) = (0.0, 0.0);
    for i in 0..count {
        let at = |k: i32| {
            let (sin, cos) = libm::sincos(f64::from(k) * std::f64::consts::TAU / f64::from(count));
            DVec3::new(cos, sin, 0.0) * 4.0
        };
        let length = image(at(i)).distance(image(at(i + 1)));
        let over = (at(i) + at(i + 1)) / 2.0 + direction * 10.0;
        upper += length;
        lower += if over.truncate().length() < 4.0 { length } else { 0.0 };
    }
    let found = drawn(&[plate(24)], &camera, Method::Auto);
    let known = edges + 100.0 * (upper + lower);
    assert!(lower > 1.0 && near(found.visible, known, 2e-5), "{} not {known}", found.visible);
}
