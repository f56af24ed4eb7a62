use glam::dvec3;

use super::*;
use crate::geom::{Tolerance, sides, triangulate::triangulate};

/// Volume by the divergence theorem over triangles.
fn volume(solid: &Polyhedron) -> f64 {
    let mesh = solid.mesh();
    let triple = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|k| mesh.points[k as usize]);
        a.dot(b.cross(c)) / 6.0
    };
    triangulate(mesh).corners.iter().map(triple).sum()
}

#[track_caller]
fn assert_near(found: f64, wanted: f64) {
    assert!((found - wanted).abs() <= 1e-12 * wanted.abs(), "{found} is not {wanted}");
}

/// Area of the regular n-gon in the unit circle.
fn ngon(n: u32) -> f64 {
    f64::from(n) / 2.0 * sin_deg(360.0 / f64::from(n))
}

#[test]
fn volumes_follow_the_ngon_formulas() {
    assert_eq!(volume(&cuboid(dvec3(-1., -2., -3.), dvec3(4., 5., 6.))), 5. * 7. * 9.);
    for n in [3, 4, 5, 8, 31, 64] {
        assert_near(volume(&cone(2., 2., 7., n)), 28. * ngon(n));
        assert_near(volume(&cone(2., 1., 6., n)), 2. * (4. + 2. + 1.) * ngon(n));
        assert_near(volume(&cone(0., 3., 5., n)), 15. * ngon(n));
        assert_near(volume(&cone(3., 0., 5., n)), 15. * ngon(n));
    }
    for (n, m) in [(3, 3), (8, 6), (16, 5)] {
        let cross = 4.0 * ngon(m);
        // By frusta over the tube's edges; Pappus with the n-gon in place of the circle.
        assert_near(volume(&torus(9., 2., n, m)), 2. * 9. * cross * ngon(n));
    }
}

#[test]
fn a_sphere_is_a_stack_of_frusta() {
    for n in [3u32, 4, 5, 6, 7, 30] {
        let k = n.div_ceil(2);
        let at = |i: u32| (f64::from(i) + 0.5) * 180. / f64::from(k);
        let frusta = (1..k).map(|i| {
            let (a, b) = (sin_deg(at(i - 1)), sin_deg(at(i)));
            (cos_deg(at(i - 1)) - cos_deg(at(i))) / 3. * (a * a + a * b + b * b)
        });
        let wanted = 1000. * ngon(n) * frusta.sum::<f64>();
        assert_near(volume(&sphere(10., n)), wanted);
    }
    assert!((volume(&sphere(1., 400)) - 4.0 / 3.0 * std::f64::consts::PI).abs() < 1e-3);
}

#[test]
fn first_corner_is_on_the_x_axis_and_extremes_are_exact() {
    let p = &cone(5., 5., 1., 12).mesh().points.clone();
    assert_eq!(p[0], dvec3(5., 0., 0.));
    assert_eq!((p[3], p[6]), (dvec3(0., 5., 0.), dvec3(-5., 0., 0.)));
    assert_eq!(torus(9., 2., 8, 8).mesh().points[0], dvec3(11., 0., 0.));
}

#[test]
fn sides_are_flat_and_outside_is_outside() {
    for solid in [sphere(3., 9), torus(5., 2., 7, 5), cone(3., 1., 2., 5)] {
        let mesh = solid.mesh();
        for face in mesh.faces() {
            let normal = face.area_vector().normalize();
            let base = mesh.points[face.outer()[0] as usize];
            let off = |c: &u32| (mesh.points[*c as usize] - base).dot(normal).abs();
            assert!(face.outer().iter().map(off).fold(0., f64::max) < 1e-14);
        }
    }
}

#[test]
fn sizes_that_enclose_nothing_are_empty() {
    assert!(cuboid(DVec3::ZERO, dvec3(1., 0., 1.)).is_empty());
    assert!(cone(0., 0., 1., 8).is_empty() && cone(1., f64::NAN, 1., 8).is_empty());
    assert!(sphere(f64::INFINITY, 8).is_empty() && torus(1., 1., 8, 8).is_empty());
}

/// Largest distance of the triangles' points, corners and middles to a surface.
fn error(solid: &Polyhedron, distance: impl Fn(DVec3) -> f64) -> f64 {
    let mesh = solid.mesh();
    let steps: Vec<(f64, f64)> = (0..=8)
        .flat_map(|i| (0..=8 - i).map(move |j| (f64::from(i) / 8., f64::from(j) / 8.)))
        .collect();
    let mut worst = 0.0f64;
    for t in triangulate(mesh).corners {
        let [a, b, c] = t.map(|k| mesh.points[k as usize]);
        for (u, v) in &steps {
            worst = worst.max(distance(a + (b - a) * *u + (c - a) * *v).abs());
        }
    }
    worst
}

#[test]
fn tolerance_is_kept_everywhere() {
    for (r, mm) in [(1., 0.05), (20., 0.05), (3., 0.01), (100., 0.5), (0.02, 0.05)] {
        let tolerance = Tolerance::new(mm).expect("positive");
        let ball = sphere(r, sides::sphere(r, tolerance));
        assert!(error(&ball, |p| p.length() - r) <= mm);
        let (n, m) = sides::torus(2. * r, r, tolerance);
        let to_tube = |p: DVec3| dvec2(p.truncate().length() - 2. * r, p.z).length() - r;
        assert!(error(&torus(2. * r, r, n, m), to_tube) <= mm);
    }
}
