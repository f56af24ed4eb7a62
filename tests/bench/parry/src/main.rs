//! Millions of closest points a second by parry3d, of the same points about the same mesh as
//! `cargo bench --bench fields`; one line a case.

use std::{f32::consts::TAU, time::Instant};

use parry3d::{math::Vector, query::PointQuery, shape::TriMesh};

/// Points asked.
const POINTS: usize = 200_000;

/// A ring of radius 10 of a tube of radius 4.
fn torus(around: u32, tube: u32) -> TriMesh {
    let place = |i: u32, j: u32| on_torus(i as f32 / around as f32, j as f32 / tube as f32, 4.0);
    let points = (0..around).flat_map(|i| (0..tube).map(move |j| place(i, j))).collect();
    let at = |i: u32, j: u32| i % around * tube + j % tube;
    let cell = |i: u32, j: u32| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let faces = (0..around).flat_map(|i| (0..tube).flat_map(move |j| cell(i, j))).collect();
    TriMesh::new(points, faces).expect("a mesh")
}

fn on_torus(u: f32, v: f32, radius: f32) -> Vector {
    let out = 10.0 + radius * (v * TAU).cos();
    Vector::new(out * (u * TAU).cos(), out * (u * TAU).sin(), radius * (v * TAU).sin())
}

fn part(i: usize, step: f64) -> f64 {
    (i as f64 * step).fract()
}

fn scattered(i: usize) -> Vector {
    let along = |step: f64| ((part(i, step) - 0.5) * 32.0) as f32;
    Vector::new(along(0.819_172_5), along(0.671_043_6), along(0.549_700_4))
}

fn near(i: usize) -> Vector {
    let radius = 4.0 + 0.2 * (part(i, 0.549_700_4) as f32 - 0.5);
    on_torus(part(i, 0.819_172_5) as f32, part(i, 0.671_043_6) as f32, radius)
}

fn main() {
    let mesh = torus(320, 160);
    let cases: [(&str, fn(usize) -> Vector); 2] = [("scattered", scattered), ("near", near)];
    for (name, place) in cases {
        let points: Vec<Vector> = (0..POINTS).map(place).collect();
        let mut most = 0.0f64;
        for _ in 0..3 {
            let start = Instant::now();
            let away = |p: &Vector| mesh.project_local_point(*p, false).point.distance(*p);
            let sum: f32 = points.iter().map(away).sum();
            assert!(sum > 0.0);
            most = most.max(POINTS as f64 / start.elapsed().as_secs_f64() / 1e6);
        }
        println!("{name}\t{most:.3}");
    }
}
