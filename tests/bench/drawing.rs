//! Hidden lines: the scenes whose times are compared with other systems.
//!
//! `cargo bench --bench drawing` prints a table; only the drawing is timed, not the making of the solids.

use std::{fs, sync::Arc};

use divan::Bencher;
use glam::{DMat3, DVec3, dvec3};
use katachi::{
    geom::{Origin, Placement, PolyMesh, Surface, Tolerance, sides, triangulate::triangulate},
    kernel::brep::{
        Polyhedron,
        boolean::{Tree, evaluate},
        primitive::{cone, cuboid, sphere, torus},
    },
    output::drawing::{Camera, Options, Scene, View, visible_lines},
};
use serde_json::Value;

fn main() {
    divan::main();
}

fn draw(bencher: Bencher, solids: &[Polyhedron], camera: &Camera) {
    let scene = Scene::of(solids.iter().map(Polyhedron::mesh));
    bencher.bench_local(|| visible_lines(&scene, camera, &Options::default()));
}

fn vector(value: &Value) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|i| value[i].as_f64().expect("a number")))
}

fn boxes(name: &str) -> Vec<Polyhedron> {
    let text = fs::read_to_string(format!("tests/scenes/{name}.recipe.json"));
    let recipe: Value = serde_json::from_str(&text.expect("the scene is there")).expect("JSON");
    let placed = |recipe: &Value| {
        let half = vector(&recipe["size"]) / 2.0;
        let rows = [0, 1, 2].map(|i| vector(&recipe["R"][i]));
        let turn = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose();
        cuboid(-half, half).placed(&Placement::new(turn, vector(&recipe["center"])))
    };
    recipe.as_array().expect("a list").iter().map(placed).collect()
}

fn united(solids: impl IntoIterator<Item = Polyhedron>) -> Polyhedron {
    let leaves = solids.into_iter().map(|s| Tree::Leaf(Arc::new(s))).collect();
    evaluate(&Tree::Union(leaves)).expect("the union is a solid").solid
}

/// Numbers in -1..1 by a linear congruence.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

#[divan::bench]
fn city_of_60_cuboids(bencher: Bencher) {
    let camera = Camera::perspective(dvec3(-80., -130., 110.), dvec3(54., 30., 10.));
    draw(bencher, &boxes("city"), &camera.expect("apart"));
}

#[divan::bench]
fn union_of_12_cuboids(bencher: Bencher) {
    let camera = Camera::perspective(dvec3(110., -140., 90.), DVec3::ZERO).expect("apart");
    draw(bencher, &[united(boxes("overlap"))], &camera);
}

/// A grid of 12 x 10 x 8 cuboids, 20 mm apart, turned anyhow.
#[divan::bench]
fn cuboids_960(bencher: Bencher) {
    let mut state = 7;
    let mut solids = vec![];
    for i in 0..960 {
        let [x, y, z] = [i / 80, i / 8 % 10, i % 8].map(|k| f64::from(k) * 20.0);
        let mut three = || DVec3::from_array(std::array::from_fn(|_| random(&mut state)));
        let (half, axis) = (three() * 1.5 + 4.0, three().normalize());
        let turn = DMat3::from_axis_angle(axis, 3.0 * three().x);
        let place = Placement::new(turn, dvec3(x - 120.0, y - 100.0, z - 80.0));
        solids.push(cuboid(-half, half).placed(&place));
    }
    draw(bencher, &solids, &Camera::parallel(dvec3(190., -170., 120.)).expect("a direction"));
}

#[divan::bench]
fn plate_with_100_holes(bencher: Bencher) {
    let slab = cuboid(dvec3(-60., -60., 0.), dvec3(60., 60., 10.));
    let hole = Arc::new(cone(4.0, 4.0, 20.0, 24));
    let at = |i: usize| -54.0 + 12.0 * i as f64;
    let holes = (0..100).map(|i| {
        let place = Placement::translation(dvec3(at(i % 10), at(i / 10), -5.0));
        Tree::Placed(place, Box::new(Tree::Leaf(hole.clone())))
    });
    let tree = [Tree::Leaf(Arc::new(slab))].into_iter().chain(holes).collect();
    let plate = evaluate(&Tree::Difference(tree)).expect("the plate is a solid").solid;
    draw(bencher, &[plate], &Camera::view(View::Iso));
}

#[divan::bench]
fn torus_at_30_degrees(bencher: Bencher) {
    let (around, tube) = sides::torus(30.0, 10.0, Tolerance::DEFAULT);
    let camera = Camera::parallel(dvec3(0.0, -(3f64.sqrt()), 1.0)).expect("a direction");
    draw(bencher, &[torus(30.0, 10.0, around, tube)], &camera);
}

/// Balls of 6 to 12 mm within a cube of 100 mm.
#[divan::bench(sample_count = 10)]
fn union_of_200_spheres(bencher: Bencher) {
    let mut state = 7;
    let balls = (0..200).map(|_| {
        let mut three = || DVec3::from_array(std::array::from_fn(|_| random(&mut state)));
        let (center, radius) = (three() * 50.0, 9.0 + 3.0 * three().x);
        let ball = sphere(radius, sides::sphere(radius, Tolerance::DEFAULT));
        ball.placed(&Placement::translation(center))
    });
    let camera = Camera::parallel(dvec3(100., -130., 80.)).expect("a direction");
    draw(bencher, &[united(balls)], &camera);
}

/// A wavy ring without a closed form.
#[divan::bench(sample_count = 20)]
fn mesh_of_100_000_triangles(bencher: Bencher) {
    let mut ring = torus(30.0, 10.0, 250, 200).into_mesh();
    for p in &mut ring.points {
        let turn = libm::atan2(p.y, p.x);
        *p *= 1.0 + 0.05 * libm::sin(7.0 * turn) + 0.03 * libm::sin(1.3 * p.z);
    }
    let mut mesh = PolyMesh::with_points(ring.points.clone());
    let origin = mesh.add_origin(Origin::of(Surface::Facets));
    for corners in triangulate(&ring).corners {
        let plane = mesh.add_plane();
        mesh.push_face(&[corners], plane, origin);
    }
    let solid = Polyhedron::new(mesh).expect("closed");
    draw(bencher, &[solid], &Camera::parallel(dvec3(0.3, -1.0, 0.6)).expect("a direction"));
}
