//! Closed forms against meshes, cells against the whole, and set operations against their flags.

use std::f64::consts::TAU;

use glam::{DVec3, dvec3};

use super::{triangle::Triangle, *};
use crate::geom::{Origin, PolyMesh, Surface};

/// Numbers in [0, 1), the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn point(&mut self, reach: f64) -> DVec3 {
        (DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0) * reach
    }
}

/// A box as a mesh.
fn block(min: DVec3, max: DVec3) -> PolyMesh {
    let corner =
        |i: usize| DVec3::from([0, 1, 2].map(|k| if i >> k & 1 == 1 { max[k] } else { min[k] }));
    let mut mesh = PolyMesh::with_points((0..8).map(corner).collect());
    let origin = mesh.add_origin(Origin::of(Surface::Plane));
    for face in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
    {
        let plane = mesh.add_plane();
        mesh.push_face(&[face], plane, origin);
    }
    mesh
}

#[test]
fn a_mesh_of_a_box_is_the_box() {
    let (min, max) = (dvec3(-1.0, 0.0, 2.0), dvec3(3.0, 5.0, 4.0));
    let (form, mesh) = (Cuboid::new(min, max), Polyhedral::new(&block(min, max)).expect("full"));
    let mut random = Random(1);
    for _ in 0..2000 {
        let p = random.point(8.0);
        assert!((form.distance(p) - mesh.distance(p)).abs() < 1e-12, "{p}");
        assert!((form.closest(p).distance(p) - form.distance(p).abs()).abs() < 1e-12, "{p}");
    }
}

#[test]
fn closed_forms_keep_their_promises() {
    let mut shapes: Vec<Box<dyn Field>> = vec![
        Box::new(Ball::new(dvec3(1.0, 0.0, -1.0), 3.0)),
        Box::new(Ring::new(4.0, 1.5)),
        Box::new(Lathe::new(3.0, 1.0, 4.0)),
        Box::new(Lathe::new(0.0, 2.0, 3.0)),
    ];
    shapes.push(Box::new(Grown::new(Cuboid::new(DVec3::ZERO, DVec3::ONE), 0.5).expect("exact")));
    let mut random = Random(7);
    for (k, shape) in shapes.iter().enumerate() {
        for _ in 0..500 {
            let (p, q) = (random.point(7.0), random.point(7.0));
            let (d, e) = (shape.distance(p), shape.distance(q));
            assert!((d - e).abs() <= p.distance(q) + 1e-12, "{k}: too steep between {p} and {q}");
            let foot = shape.closest(p);
            if d > 0.0 || k < 4 {
                assert!((foot.distance(p) - d.abs()).abs() < 1e-9, "{k}: {p}");
                assert!(shape.distance(foot).abs() < 1e-9, "{k}: {p}");
            }
            let cell = Bounds { min: p.min(q), max: p.max(q) };
            let [low, high] = shape.bound(&cell);
            let inside = shape.distance(p.lerp(q, random.next()));
            assert!(low <= inside && inside <= high);
        }
    }
}

#[test]
fn a_cell_answers_as_the_whole() {
    let mut two = block(DVec3::ZERO, dvec3(4.0, 3.0, 2.0));
    two.append(&block(dvec3(5.0, 0.0, 0.0), dvec3(6.0, 6.0, 6.0)));
    let whole = Polyhedral::new(&two).expect("full");
    let mut random = Random(3);
    for _ in 0..200 {
        let low = random.point(7.0);
        let size = 0.1 + 3.0 * random.next();
        let cell = Bounds { min: low, max: low + size };
        let local = Local::new(&whole, &cell);
        let inner = Bounds { min: low + size / 4.0, max: low + size / 2.0 };
        let deeper = local.within(&inner);
        assert!(deeper.candidates() <= local.candidates());
        for _ in 0..20 {
            let p = low + (random.point(0.5) + 0.5) * size;
            assert_eq!(local.nearest(p).distance, whole.nearest(p).distance);
            let p = inner.min + (p - low) / 4.0;
            assert!((deeper.nearest(p).distance - whole.nearest(p).distance).abs() < 1e-12);
        }
    }
}

#[test]
fn flags_follow_set_operations() {
    let (a, b) = (Cuboid::new(DVec3::ZERO, DVec3::ONE), Ball::new(DVec3::ZERO, 1.0));
    let flags = |outside, inside| Exact { outside, inside };
    assert_eq!(Union(a, b).exact(), flags(true, false));
    assert_eq!(Intersection(a, b).exact(), flags(false, true));
    assert_eq!(Complement(Union(a, b)).exact(), flags(false, true));
    assert_eq!(Intersection(a, Complement(b)).exact(), flags(false, true));
    assert_eq!(Grown::new(Intersection(a, b), 1.0).unwrap_err(), NotExact::Outside);
    assert!(Grown::new(Intersection(a, b), -0.1).is_ok());
    let grown = Grown::new(a, 0.5).expect("exact");
    assert_eq!((grown.exact(), Grown::new(grown, -0.2).is_err()), (flags(true, false), true));
}

#[test]
fn features_and_signs_at_edges_and_corners() {
    let cube = Polyhedral::new(&block(DVec3::ZERO, DVec3::splat(2.0))).expect("full");
    let feature = |x, y, z| cube.nearest(dvec3(x, y, z)).feature;
    assert_eq!(feature(1.0, 1.0, 3.0), Feature::Face(5));
    assert_eq!(feature(3.0, 3.0, 0.4), Feature::Edge(3, 7));
    assert_eq!(feature(-1.0, -1.0, -1.0), Feature::Vertex(0));
    assert!(cube.distance(dvec3(-1e-9, -1e-9, 0.5)) > 0.0);
}

#[test]
fn the_hierarchy_finds_what_is_nearest() {
    let at = |i: u32, j: u32| {
        let (u, v) = (f64::from(i % 40) * TAU / 40.0, f64::from(j % 24) * TAU / 24.0);
        let out = 100.0 + 9.0 + 3.0 * libm::cos(v);
        dvec3(out * libm::cos(u), out * libm::sin(u), 3.0 * libm::sin(v))
    };
    let mut ring = PolyMesh::with_points((0..40 * 24).map(|k| at(k / 24, k % 24)).collect());
    let origin = ring.add_origin(Origin::of(Surface::Facets));
    for (i, j) in (0..40).flat_map(|i| (0..24).map(move |j| (i, j))) {
        let [a, b, c, d] =
            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| i % 40 * 24 + j % 24);
        for corners in [[a, b, c], [a, c, d]] {
            let plane = ring.add_plane();
            ring.push_face(&[corners], plane, origin);
        }
    }
    let whole = Polyhedral::new(&ring).expect("full");
    let mut random = Random(5);
    for reach in [1.0, 120.0, 1e4, 1e9, 1e25] {
        for _ in 0..200 {
            let p = random.point(reach);
            let away = |t: &Triangle| t.nearest(p).0.distance_squared(p);
            let least =
                (0..1920).map(|i| away(&whole.triangle(i))).fold(f64::INFINITY, f64::min).sqrt();
            assert_eq!(whole.nearest(p).distance.abs(), least, "{p}");
        }
    }
    assert!(whole.nearest(DVec3::NAN).distance.is_nan());
}
