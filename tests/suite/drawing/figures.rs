//! Known lengths.

use glam::DVec3;
use katachi::{
    kernel::brep::{Polyhedron, primitive::cuboid},
    output::drawing::{Camera, Method, View},
};

use super::scenes::{boxes, camera, drawn, near, union};

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
