use glam::{DQuat, dvec3};

use super::*;
use crate::geom::{Origin, Placement, Surface, triangulate::triangulate, trig::unit_circle};

/// A prism over plane loops, the outer counter-clockwise first, from z = 0 to `h`; flanks point outwards.
fn prism(loops: &[Vec<[f64; 2]>], h: f64) -> PolyMesh {
    let mut mesh = PolyMesh::default();
    let (plane, origin) = (mesh.add_plane(), mesh.add_origin(Origin::of(Surface::Plane)));
    let (mut floor, mut roof) = (vec![], vec![]);
    for corners in loops {
        let (n, first) = (corners.len() as u32, mesh.points.len() as u32);
        mesh.points.extend(corners.iter().map(|p| dvec3(p[0], p[1], 0.0)));
        mesh.points.extend(corners.iter().map(|p| dvec3(p[0], p[1], h)));
        floor.push((first..first + n).rev().collect::<Vec<u32>>());
        roof.push((first + n..first + 2 * n).collect::<Vec<u32>>());
        for i in 0..n {
            let j = (i + 1) % n;
            let quad = [first + i, first + j, first + n + j, first + n + i];
            mesh.push_face(&[quad], plane, origin);
        }
    }
    mesh.push_face(&floor, plane, origin);
    mesh.push_face(&roof, plane, origin);
    mesh
}

fn rect(x0: f64, y0: f64, x1: f64, y1: f64) -> Vec<[f64; 2]> {
    vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
}

fn reversed(mut corners: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    corners.reverse();
    corners
}

/// Solids with whole coordinates within [0, 16]: box, L-prism, star, frame with a hole, plate with two
/// holes, cavity, sheared block of triangles.
fn solids() -> Vec<PolyMesh> {
    let ell = vec![[0., 0.], [12., 0.], [12., 4.], [4., 4.], [4., 12.], [0., 12.]];
    let star =
        vec![[8., 0.], [10., 6.], [16., 8.], [10., 10.], [8., 16.], [6., 10.], [0., 8.], [6., 6.]];
    let frame = [rect(0., 0., 16., 16.), reversed(rect(4., 4., 12., 13.))];
    let triangle = vec![[2., 2.], [2., 9.], [7., 3.]];
    let plate = [rect(0., 0., 16., 16.), triangle, reversed(rect(9., 9., 14., 15.))];
    let mut cavity = prism(&[rect(0., 0., 16., 16.)], 16.);
    let mut void = prism(&[rect(4., 4., 9., 10.)], 7.);
    void.flip();
    void.points.iter_mut().for_each(|p| p.z += 3.);
    cavity.append(&void);
    vec![
        prism(&[rect(1., 2., 15., 14.)], 9.),
        prism(&[ell], 10.),
        prism(&[star], 7.),
        prism(&frame, 5.),
        prism(&plate, 11.),
        cavity,
        tetrahedron(),
    ]
}

fn tetrahedron() -> PolyMesh {
    let corners = [[1., 1., 1.], [15., 3., 2.], [4., 14., 3.], [5., 6., 15.]];
    let mut mesh = PolyMesh::with_points(corners.map(DVec3::from).to_vec());
    let (plane, origin) = (mesh.add_plane(), mesh.add_origin(Origin::of(Surface::Facets)));
    for face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
        mesh.push_face(&[face], plane, origin);
    }
    mesh
}

/// Whole numbers in [0, 2^26), the same on every machine.
fn random(state: &mut u64) -> i64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 38) as i64
}

/// Whole-number units in a millimetre.
const UNITS: i64 = 1 << 20;

type Whole = [i128; 3];

fn whole(p: DVec3) -> Whole {
    p.to_array().map(|v| (v * UNITS as f64) as i128)
}

/// Twice the signed area of a triangle seen along x, exactly.
fn area_yz(a: Whole, b: Whole, c: Whole) -> i128 {
    (b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1])
}

fn volume(a: Whole, b: Whole, c: Whole, d: Whole) -> i128 {
    let [u, v, w] = [a, b, c].map(|p| [p[0] - d[0], p[1] - d[1], p[2] - d[2]]);
    u[0] * (v[1] * w[2] - v[2] * w[1])
        + u[1] * (v[2] * w[0] - v[0] * w[2])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
}

/// Exact parity of the ray from q along +x; `None` when it meets an edge.
fn parity(triangles: &[[Whole; 3]], q: Whole) -> Option<bool> {
    let mut inside = false;
    for &[a, b, c] in triangles {
        let signs = [area_yz(a, b, q), area_yz(b, c, q), area_yz(c, a, q)].map(i128::signum);
        let one_sided = signs.iter().all(|&s| s >= 0) || signs.iter().all(|&s| s <= 0);
        if one_sided && signs.contains(&0) && signs != [0; 3] {
            return None;
        }
        if signs == [1; 3] || signs == [-1; 3] {
            // In front of q along +x: q is behind a triangle whose normal has positive x.
            inside ^= volume(a, b, c, q).signum() == signs[0];
        }
    }
    Some(inside)
}

#[test]
fn agrees_with_exact_ray_parity() {
    let mut seed = 11;
    let mut asked = 0;
    for mesh in solids() {
        let projection = Projection::new(&mesh);
        let corners = triangulate(&mesh).corners;
        let triangles: Vec<[Whole; 3]> =
            corners.iter().map(|t| t.map(|c| whole(mesh.points[c as usize]))).collect();
        for _ in 0..15_000 {
            let q: [i64; 3] = std::array::from_fn(|_| random(&mut seed) % (18 * UNITS) - UNITS);
            let Some(wanted) = parity(&triangles, q.map(i128::from)) else { continue };
            let q = DVec3::from_array(q.map(|v| v as f64)) / UNITS as f64;
            assert_eq!(inside(&mesh, q), wanted, "{q}");
            assert_eq!(projection.inside(q), wanted, "{q} by the expansion");
            asked += 1;
        }
    }
    assert!(asked > 100_000, "{asked}");
}

#[test]
fn four_pi_inside_and_nothing_outside() {
    let mut seed = 5;
    let turn = glam::DMat3::from_quat(DQuat::from_xyzw(0.1, 0.7, -0.3, 0.6).normalize());
    let placement = Placement::new(turn, dvec3(3.3, -7.1, 100.7));
    for mesh in solids() {
        let moved = mesh.placed(&placement);
        for _ in 0..2000 {
            let q = DVec3::from_array(std::array::from_fn(|_| random(&mut seed) as f64)) / 3.5e6;
            let wanted = if inside(&mesh, q) { 4.0 * PI } else { 0.0 };
            assert!((solid_angle(&mesh, q) - wanted).abs() < 1e-9, "{q}");
            assert!((solid_angle(&moved, placement.point(q)) - wanted).abs() < 1e-9, "{q}");
        }
    }
}

#[test]
fn on_the_boundary() {
    let frame = prism(&[rect(0., 0., 16., 16.), reversed(rect(4., 4., 12., 13.))], 5.);
    let cases = [
        (dvec3(2., 3., 5.), TAU),
        (dvec3(4., 8., 2.), TAU),
        (dvec3(0., 3., 5.), PI),
        (dvec3(4., 4., 2.), 3.0 * PI),
        (dvec3(4., 6., 5.), PI),
        (dvec3(0., 0., 0.), PI / 2.0),
        (dvec3(4., 4., 5.), 1.5 * PI),
        // In the plane of the roof, but over the hole or beside the frame.
        (dvec3(8., 8., 5.), 0.0),
        (dvec3(20., 8., 5.), 0.0),
    ];
    let turn = glam::DMat3::from_quat(DQuat::from_xyzw(0.1, 0.7, -0.3, 0.6).normalize());
    let placement = Placement::new(turn, DVec3::ZERO);
    for (q, wanted) in cases {
        assert!((solid_angle(&frame, q) - wanted).abs() < 1e-12, "{q}");
        assert_eq!(inside(&frame, q), wanted > 0.0, "{q}");
        assert_eq!(Projection::new(&frame).inside(q), wanted > 0.0, "{q}");
        let (moved, q) = (frame.placed(&placement), placement.point(q));
        assert!((solid_angle(&moved, q) - wanted).abs() < 1e-9, "{q} turned");
        assert_eq!(inside(&moved, q), wanted > 0.0, "{q} turned");
    }
}

#[test]
fn edges_show_their_dihedral_angle() {
    for n in [3, 5, 8] {
        let corners = (0..n).map(|i| <[f64; 2]>::from(unit_circle(n, i) * 6.0)).collect();
        let post = prism(&[corners], 4.0);
        let dihedral = PI - TAU / f64::from(n);
        assert!((solid_angle(&post, dvec3(6.0, 0.0, 1.0)) - 2.0 * dihedral).abs() < 1e-12);
    }
}

#[test]
fn very_close_to_a_face() {
    let cube = prism(&[rect(0., 0., 1., 1.)], 1.0);
    for gap in [1e-3, 1e-9, 1e-14] {
        let angle = |z: f64| solid_angle(&cube, dvec3(0.3, 0.6, z));
        assert!((angle(1.0 - gap) - 4.0 * PI).abs() < 1e-9, "{gap}");
        assert!(angle(1.0 + gap).abs() < 1e-9, "{gap}");
    }
}

/// A box whose roof has three more corners, 7e-9 mm from one of its own, in an order that curls, each
/// pushed off the plane.
fn curled() -> PolyMesh {
    let near = 7e-9;
    let corner = [[10., 0.], [10., 10.], [10. - near, 10. + near], [10. + near, 10. - near]];
    let corner = [&corner[..], &[[10., 10. + near], [0., 10.], [0., 0.]]].concat();
    let mut mesh = prism(&[corner], 10.0);
    mesh.points.iter_mut().zip(0..).for_each(|(p, i)| p.z += near * f64::from(i % 3));
    mesh
}

#[test]
fn corners_that_rounding_brings_together_change_nothing() {
    let mesh = curled();
    let (projection, turn) = (Projection::new(&mesh), DQuat::from_xyzw(0.1, 0.7, -0.3, 0.6));
    let placement = Placement::new(glam::DMat3::from_quat(turn.normalize()), dvec3(3., 4., 5.));
    let moved = mesh.placed(&placement);
    let mut seed = 7;
    for _ in 0..20_000 {
        let q = DVec3::from_array(std::array::from_fn(|_| random(&mut seed) as f64)) / 5e6 - 1.5;
        let wanted = q.cmpgt(DVec3::ZERO).all() && q.cmplt(DVec3::splat(10.0)).all();
        assert_eq!(inside(&mesh, q), wanted, "{q}");
        assert_eq!(projection.inside(q), wanted, "{q} by the expansion");
        assert_eq!(inside(&moved, placement.point(q)), wanted, "{q} turned");
    }
}

#[test]
fn near_the_plane_of_a_bent_face() {
    let mesh = curled();
    for gap in [1e-3, 1e-6, 1e-7] {
        for (x, y) in [(3.3, 4.4), (9.999, 9.999), (11.0, 10.0), (10.0, 12.0), (-4.0, 10.0)] {
            for (z, within) in [(10.0 + gap, false), (10.0 - gap, x > 0.0 && x < 10.0)] {
                let q = dvec3(x, y, z);
                let within = within && y < 10.0;
                assert_eq!(inside(&mesh, q), within, "{q}");
                assert_eq!(Projection::new(&mesh).inside(q), within, "{q} by the expansion");
            }
        }
    }
}

#[test]
fn the_expansion_of_a_fine_drum() {
    let rim = (0..2000).map(|i| <[f64; 2]>::from(unit_circle(2000, i) * 5.0)).collect();
    let (mesh, mut seed) = (prism(&[rim], 4.0), 3);
    let projection = Projection::new(&mesh);
    for i in 0..1000 {
        let q = DVec3::from_array(std::array::from_fn(|_| random(&mut seed) as f64)) / 6.7e6 - 5.0;
        // One in two close to the surface.
        let q = if i % 2 == 0 { q } else { q.with_z(0.0).normalize() * 4.995 + DVec3::Z };
        assert_eq!(projection.inside(q), solid_angle(&mesh, q) > TAU, "{q}");
    }
}
