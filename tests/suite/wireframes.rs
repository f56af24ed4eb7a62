//! Solids from the edges alone: what is taken apart into edges closes to the same solid.

use std::collections::BTreeSet;

use glam::{DMat3, DQuat, DVec3, dvec3};
use katachi::{
    geom::{
        Placement, PolyMesh,
        wireframe::{WireframeError, faces},
    },
    kernel::brep::{
        Polyhedron,
        crossing::crossing,
        faces::polyhedron,
        hull::hull,
        measure::{euler, genus, shells, volume},
        primitive::{cone, cuboid},
    },
};

use crate::random::Random;

type Edges = Vec<[DVec3; 2]>;

/// The edges of a mesh, each once.
fn edges(mesh: &PolyMesh) -> Edges {
    let mut pairs = BTreeSet::new();
    for ring in mesh.faces().flat_map(|face| face.loops()) {
        for (i, &a) in ring.iter().enumerate() {
            let b = ring[(i + 1) % ring.len()];
            pairs.insert([a.min(b), a.max(b)]);
        }
    }
    pairs.into_iter().map(|pair| pair.map(|i| mesh.points[i as usize])).collect()
}

fn solid(edges: &[[DVec3; 2]]) -> Polyhedron {
    let found = faces(edges).unwrap_or_else(|error| panic!("{error}"));
    let solid = polyhedron(&found.points, &found.rings()).expect("closed");
    assert_eq!(crossing(solid.mesh()), Ok(None));
    solid
}

/// The edges of a plane figure pulled up, all sides of the figure given as loops.
fn prism(loops: &[&[[f64; 2]]], height: f64) -> Edges {
    let mut edges = vec![];
    for ring in loops {
        for (i, a) in ring.iter().enumerate() {
            let b = ring[(i + 1) % ring.len()];
            let [a, b] = [*a, b].map(|[x, y]| dvec3(x, y, 0.0));
            let up = DVec3::Z * height;
            edges.extend([[a, b], [a + up, b + up], [a, a + up]]);
        }
    }
    edges
}

const L: [[f64; 2]; 6] = [[0., 0.], [8., 0.], [8., 2.], [2., 2.], [2., 6.], [0., 6.]];

fn square(at: f64, size: f64) -> [[f64; 2]; 4] {
    let end = at + size;
    [[at, at], [end, at], [end, end], [at, end]]
}

#[test]
fn plain_bodies_close() {
    let block = edges(cuboid(DVec3::ZERO, dvec3(3., 4., 5.)).mesh());
    assert_eq!((volume(&solid(&block)), block.len()), (60.0, 12));
    assert_eq!(volume(&solid(&prism(&[&L], 3.0))), 72.0);
    let frustum = cone(4.0, 2.0, 3.0, 4);
    assert!((volume(&solid(&edges(frustum.mesh()))) - volume(&frustum)).abs() < 1e-9);
    let pyramid = cone(4.0, 0.0, 3.0, 7);
    assert!((volume(&solid(&edges(pyramid.mesh()))) - volume(&pyramid)).abs() < 1e-9);
}

#[test]
fn a_house_closes() {
    let mut house = prism(&[&[[0., 0.], [10., 0.], [10., 6.], [0., 6.]]], 4.0);
    let ridge = [dvec3(0., 3., 7.), dvec3(10., 3., 7.)];
    let eaves = [dvec3(0., 0., 4.), dvec3(0., 6., 4.), dvec3(10., 0., 4.), dvec3(10., 6., 4.)];
    house.push(ridge);
    for (i, eave) in eaves.into_iter().enumerate() {
        house.push([eave, ridge[i / 2]]);
    }
    // With the beams at the eaves the gables have a line in them; the attic floor is no face.
    assert_eq!(volume(&solid(&house)), 10.0 * 6.0 * 4.0 + 10.0 * 6.0 * 3.0 / 2.0);
}

#[test]
fn a_loop_in_a_face_is_a_hole() {
    let through = solid(&prism(&[&square(0., 10.), &square(3., 4.)], 5.0));
    assert_eq!((volume(&through), genus(&through)), (5.0 * (100.0 - 16.0), 1));
    let mut pocket = prism(&[&square(0., 10.)], 5.0);
    let up = |edge: [DVec3; 2]| edge.map(|p| p + DVec3::Z * 3.0);
    pocket.extend(prism(&[&square(3., 4.)], 2.0).into_iter().map(up));
    let pocket = solid(&pocket);
    assert_eq!((volume(&pocket), euler(&pocket)), (500.0 - 32.0, 2));
}

#[test]
fn a_cuboid_in_a_cuboid_is_a_cavity() {
    let mut all = edges(cuboid(DVec3::ZERO, DVec3::splat(10.0)).mesh());
    all.extend(edges(cuboid(DVec3::splat(3.0), DVec3::splat(5.0)).mesh()));
    let hollow = solid(&all);
    assert_eq!((volume(&hollow), shells(&hollow)), (992.0, 2));
}

#[test]
fn planes_across_a_body_are_no_faces() {
    // A collar: the outlines of its foot and top run around the shaft.
    let mut shaft = prism(&[&square(3., 4.)], 4.0);
    let lift = |edge: [DVec3; 2], z: f64| edge.map(|p| p + DVec3::Z * z);
    shaft.extend(prism(&[&square(0., 10.)], 2.0).into_iter().map(|e| lift(e, 4.0)));
    shaft.extend(prism(&[&square(3., 4.)], 5.0).into_iter().map(|e| lift(e, 6.0)));
    assert_eq!(volume(&solid(&shaft)), 64.0 + 200.0 + 80.0);
    // Storeys: a line around a box.
    let mut tower = prism(&[&square(0., 4.)], 3.0);
    tower.extend(prism(&[&square(0., 4.)], 3.0).into_iter().map(|e| lift(e, 3.0)));
    assert_eq!(volume(&solid(&tower)), 96.0);
    // A small cube held in a large one by struts from corner to corner.
    let mut held = edges(cuboid(DVec3::ZERO, DVec3::splat(9.0)).mesh());
    held.extend(edges(cuboid(DVec3::splat(3.0), DVec3::splat(6.0)).mesh()));
    let corner = |i: u32| dvec3(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
    held.extend((0..8).map(|i| [corner(i) * 9.0, corner(i) * 3.0 + 3.0]));
    // Each strut bounds two faces: of the six pyramids without tops around the small cube two opposite ones are open.
    let pyramid = (81.0 + 27.0 + 9.0) * 3.0 / 3.0;
    assert!((volume(&solid(&held)) - (729.0 - 27.0 - 2.0 * pyramid)).abs() < 1e-9);
}

#[test]
fn edges_are_cut_where_others_end() {
    let mut marked = prism(&[&L], 3.0);
    // A line on the front from edge to edge.
    marked.push([dvec3(5., 0., 0.), dvec3(5., 0., 3.)]);
    assert_eq!(volume(&solid(&marked)), 72.0);
    // The same edges again in pieces that overlap.
    marked.push([dvec3(1., 0., 0.), dvec3(7., 0., 0.)]);
    assert!(faces(&marked).is_ok());
}

#[test]
fn hulls_of_random_points_come_back() {
    let mut random = Random(7);
    for count in [4, 5, 6, 8, 12, 20, 40] {
        for _ in 0..4 {
            let mut number = || random.next() * 20.0 - 10.0;
            let points: Vec<DVec3> =
                (0..count).map(|_| dvec3(number(), number(), number())).collect();
            let turn = DQuat::from_xyzw(number(), number(), number(), number()).normalize();
            let body = hull(&points).expect("full");
            let body = body.placed(&Placement::new(DMat3::from_quat(turn), points[0] * 3.0));
            let mut wires = edges(body.mesh());
            let half = wires.len() / 2;
            wires.rotate_left(half);
            let found = solid(&wires);
            let (volume, expected) = (volume(&found), volume(&body));
            assert!((volume - expected).abs() <= 1e-9 * expected, "{count} points");
        }
    }
}

#[test]
fn blocks_with_random_notches_come_back() {
    let mut random = Random(3);
    for _ in 0..20 {
        let mut number = |low: f64, high: f64| low + random.next() * (high - low);
        let (x, y, z) = (number(5., 9.), number(5., 9.), number(2., 5.));
        let (a, b) = (number(1., 3.), number(1., 3.));
        let ring = [[0., 0.], [x, 0.], [x, y - b], [x - a, y - b], [x - a, y], [0., y]];
        let found = solid(&prism(&[&ring], z));
        assert!((volume(&found) - z * (x * y - a * b)).abs() < 1e-9);
    }
}

#[test]
fn what_does_not_close_is_named() {
    let block = edges(cuboid(DVec3::ZERO, dvec3(3., 4., 5.)).mesh());
    let missing = faces(&block[1..]).expect_err("open");
    assert!(matches!(missing, WireframeError::Loose { points: 2, edges: 2, .. }), "{missing}");
    assert!(missing.to_string().contains("[0, 0, "), "{missing}");
    let mut fin = block.clone();
    fin.push([DVec3::ZERO, dvec3(-1., -1., 0.)]);
    assert!(matches!(faces(&fin), Err(WireframeError::Loose { points: 1, edges: 1, .. })));
    let mut brace = block.clone();
    brace.push([DVec3::ZERO, dvec3(3., 4., 5.)]);
    let brace = faces(&brace).expect_err("a diagonal bounds no face");
    assert!(matches!(brace, WireframeError::Open { edges: 1, .. }), "{brace}");
    assert!(brace.to_string().contains("from [0, 0, 0] to [3, 4, 5]"), "{brace}");
    assert!(matches!(faces(&block[..3]), Err(WireframeError::Few(3))));
    let many = vec![[DVec3::ZERO, DVec3::X]; 5000];
    assert!(matches!(faces(&many), Err(WireframeError::Many { .. })));
    let broken = vec![[DVec3::NAN, DVec3::X]; 7];
    assert_eq!(faces(&broken), Err(WireframeError::NotFinite(0)));
}
