//! Small scenes, one thing each.

use glam::{DMat3, DVec3, dvec3};
use katachi::{
    geom::{Origin, Placement, PolyMesh, Surface, Tolerance, sides},
    kernel::brep::{
        Polyhedron,
        primitive::{cone, cuboid, sphere, torus},
    },
    output::drawing::{
        Camera, Class, Drawing, Hidden, Kind, Method, Options, Scene, Stroke, View, visible_lines,
    },
};

use super::scenes::{boxes, camera, drawn, near, plate, union};

const METHODS: [Method; 3] = [Method::Auto, Method::Count, Method::Clip];

fn cube() -> Polyhedron {
    cuboid(dvec3(-5.0, -5.0, -5.0), dvec3(5.0, 5.0, 5.0))
}

fn stroke(kind: Kind, points: &[[f64; 3]]) -> Stroke {
    let points = points.iter().copied().map(DVec3::from).collect();
    Stroke { points, kind, id: 7, round: None, drawn: vec![] }
}

fn strokes(drawing: &Drawing, class: Class) -> f64 {
    let of = drawing.lines.iter().filter(|l| l.id == 7 && l.class == class);
    of.map(|l| l.path.length()).sum()
}

#[test]
fn nothing_gives_an_empty_drawing() {
    for method in METHODS {
        assert_eq!(drawn(&[], &Camera::view(View::Iso), method), Drawing::default());
        assert_eq!(drawn(&[Polyhedron::empty()], &camera("city"), method), Drawing::default());
    }
    assert_eq!(Drawing::default().bounds(), None);
    let behind = Camera::perspective(DVec3::Y * 100.0, DVec3::Y * 200.0).expect("apart");
    assert_eq!(drawn(&[cube()], &behind, Method::Auto), Drawing::default());
}

#[test]
fn free_lines_are_hidden_where_they_run_through_and_behind() {
    let cube = cube();
    let mut scene = Scene::of([cube.mesh()]);
    // From before the cube, through it, out at the side, and behind it.
    let points = [[0.0, -10.0, 0.0], [10.0, 0.0, 1.0], [-10.0, 20.0, 1.0], [-10.0, 20.0, 9.0]];
    scene.strokes.push(stroke(Kind::Free, &points));
    for method in METHODS {
        let options = Options { method, ..Options::default() };
        let found = visible_lines(&scene, &Camera::view(View::Front), &options);
        // Inside from x = 5 only up to the face x = 5, y = -5: it touches the edge there.
        assert!(near(strokes(&found, Class::Hidden), 10.0, 1e-9), "{method:?}");
        assert!(near(found.visible, 40.0 + 10.0 + 101f64.sqrt() + 8.0, 1e-9), "{}", found.visible);
    }
}

#[test]
fn patterns_lie_on_their_face() {
    let cube = cube();
    let mut scene = Scene::of([cube.mesh()]);
    scene.strokes.push(stroke(Kind::Pattern, &[[-3.0, -5.0, -3.0], [3.0, -5.0, 3.0]]));
    scene.strokes.push(stroke(Kind::Pattern, &[[-3.0, 5.0, 3.0], [3.0, 5.0, -3.0]]));
    scene.strokes.push(stroke(Kind::Centre, &[[-9.0, 0.0, 0.0], [9.0, 0.0, 0.0]]));
    let found = visible_lines(&scene, &Camera::view(View::Front), &Options::default());
    let diagonal = 72f64.sqrt();
    assert!(near(strokes(&found, Class::Visible), diagonal, 1e-12));
    assert!(near(strokes(&found, Class::Hidden), diagonal, 1e-12));
    assert!(near(strokes(&found, Class::Centre), 18.0, 1e-12));
    assert!(near(found.visible, 40.0 + diagonal, 1e-12));
}

#[test]
fn an_open_surface_hides_from_both_sides() {
    let corners = [[-9.0, 0.0, -9.0], [9.0, 0.0, -9.0], [9.0, 0.0, 9.0], [-9.0, 0.0, 9.0]];
    let mut sheet = PolyMesh::with_points(corners.map(DVec3::from).to_vec());
    let (plane, origin) = (sheet.add_plane(), sheet.add_origin(Origin::of(Surface::Plane)));
    sheet.push_face(&[[0, 1, 2, 3]], plane, origin);
    let cube = cube().placed(&Placement::translation(DVec3::Y * 20.0));
    for view in [View::Front, View::Back] {
        for method in METHODS {
            let camera = Camera::view(view);
            let options = Options { method, ..Options::default() };
            let found = visible_lines(&Scene::of([&sheet, cube.mesh()]), &camera, &options);
            let seen = if view == View::Front { 72.0 } else { 72.0 + 40.0 };
            assert!(near(found.visible, seen, 1e-9), "{view:?} {method:?}: {}", found.visible);
        }
    }
}

#[test]
fn hidden_lines_are_kept_as_wanted() {
    let wall = cuboid(dvec3(-9.0, -20.0, -9.0), dvec3(9.0, -19.0, 9.0));
    let solids = [wall, cube()];
    let scene = Scene::of(solids.iter().map(Polyhedron::mesh));
    let camera = Camera::parallel(dvec3(0.1, -1.0, 0.2)).expect("a direction");
    let with = |hidden| visible_lines(&scene, &camera, &Options { hidden, ..Options::default() });
    let [off, all, one] = [Hidden::Off, Hidden::Dashed, Hidden::Depth(1)].map(with);
    assert!(off.lines.iter().all(|l| l.class == Class::Visible && l.order == 0));
    assert!(one.lines.iter().all(|l| l.class == Class::Visible && l.order <= 1));
    assert!(off.lines.len() < one.lines.len() && one.lines.len() < all.lines.len());
    assert_eq!((off.visible, off.hidden), (all.visible, all.hidden));
}

#[test]
fn threads_do_not_change_the_drawing() {
    let solids = [plate(24), torus(50.0, 20.0, 80, 32)];
    let camera = Camera::parallel(dvec3(0.3, -1.0, 0.7)).expect("a direction");
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| drawn(&solids, &camera, Method::Auto))
    };
    assert_eq!(on(1), on(2));
    let city = boxes("city");
    assert_eq!(drawn(&city, &camera, Method::Auto), drawn(&city, &camera, Method::Auto));
}

/// Three round or square solids, turned anyhow and united, with the facets a tolerance asks for.
fn mixture(scene: u64, tolerance: Tolerance) -> (Polyhedron, Camera) {
    let mut state = scene.wrapping_mul(7919).wrapping_add(13);
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut part = || {
        let (kind, a, b) = (next(), 4.0 + 6.0 * next(), 5.0 + 20.0 * next());
        let solid = match (kind * 5.0) as u32 {
            0 => cuboid(-dvec3(a, 4.0, b / 2.0), dvec3(a, 4.0, b / 2.0)),
            1 => cone(a, a, b, sides::circle(a, tolerance)),
            2 => cone(a, a / 4.0, b, sides::circle(a, tolerance)),
            3 => sphere(a, sides::sphere(a, tolerance)),
            _ => {
                let (around, tube) = sides::torus(a + 3.0, a * 0.4, tolerance);
                torus(a + 3.0, a * 0.4, around, tube)
            }
        };
        let mut vector = || DVec3::from_array(std::array::from_fn(|_| 2.0 * next() - 1.0));
        let turn = DMat3::from_axis_angle(vector().normalize(), 3.0 * vector().x);
        solid.placed(&Placement::new(turn, vector() * 9.0))
    };
    let solid = union((0..3).map(|_| part()).collect());
    let direction = DVec3::from_array(std::array::from_fn(|_| 2.0 * next() - 1.0)).normalize();
    let camera = if next() < 0.5 {
        Camera::parallel(direction)
    } else {
        Camera::perspective(direction * 80.0, DVec3::ZERO)
    };
    (solid, camera.expect("a direction"))
}

#[test]
fn round_solids_look_the_same_from_coarse_and_fine_meshes() {
    let mut apart = 0;
    for scene in 0..24 {
        let [coarse, fine] = [0.05, 0.01].map(|mm| {
            let tolerance = Tolerance::new(mm).expect("positive");
            let (solid, camera) = mixture(scene, tolerance);
            let options = Options { tolerance, ..Options::default() };
            visible_lines(&Scene::of([solid.mesh()]), &camera, &options)
        });
        // Where surfaces touch nearly, facets decide what sticks out.
        assert!(near(coarse.visible, fine.visible, 2e-2), "{scene}: {}", coarse.visible);
        apart += usize::from(!near(coarse.visible, fine.visible, 1e-4));
    }
    assert!(apart <= 6, "{apart} drawings depend on their facets");
}

#[test]
fn few_sides_are_edges() {
    let prism = [cone(10.0, 10.0, 30.0, 6)];
    let front = drawn(&prism, &Camera::view(View::Front), Method::Auto);
    // Seen across a side: four upright edges, of which two pairs coincide with those behind, and the ends.
    assert!(near(front.visible, 4.0 * 30.0 + 2.0 * 20.0, 1e-9), "{}", front.visible);
    let ball = drawn(&[sphere(10.0, 8)], &Camera::view(View::Front), Method::Auto);
    assert!(ball.segments > 12, "{} segments", ball.segments);
}

#[test]
fn what_is_not_finite_does_not_stop_the_drawing() {
    let mut mesh = cube().into_mesh();
    mesh.points[3] = dvec3(f64::NAN, 0.0, 0.0);
    mesh.points[5] = dvec3(1e300, f64::INFINITY, -1e300);
    for method in METHODS {
        for camera in [Camera::view(View::Iso), camera("city")] {
            let options = Options { method, ..Options::default() };
            let found = visible_lines(&Scene::of([&mesh]), &camera, &options);
            assert_eq!(found, Drawing::default());
        }
    }
}

#[test]
fn many_layers_do_not_fill_the_grid() {
    let layer = |i: i32| {
        let y = f64::from(i);
        cuboid(dvec3(-50.0, y, -50.0), dvec3(50.0, y + 0.5, 50.0))
    };
    let solids: Vec<Polyhedron> = (0..400).map(layer).collect();
    let camera = Camera::parallel(dvec3(0.001, -1.0, 0.001)).expect("a direction");
    let found = drawn(&solids, &camera, Method::Count);
    assert!(found.visible > 400.0 && found.hidden > 0.0);
}

#[test]
fn outlines_of_balls_end_where_they_run_into_other_solids() {
    let visible = |solids: &[Polyhedron], camera: &Camera, id: u32| -> f64 {
        let found = drawn(solids, camera, Method::Auto);
        let of = found.lines.iter().filter(|l| l.id == id && l.class == Class::Visible);
        of.map(|l| l.path.length()).sum()
    };
    let ball = || sphere(10.0, 60);
    // Half of the ball stands out of the box.
    let block = cuboid(dvec3(-20.0, -20.0, -20.0), dvec3(20.0, 20.0, 0.0));
    let steep = Camera::parallel(dvec3(0.0, -1.0, 1.0)).expect("a direction");
    let found = visible(&[block, ball()], &steep, 1);
    assert!(near(found, 10.0 * std::f64::consts::PI, 1e-6), "{found}");
    // Two balls, each outline within the other one where the cosine is below -0.4.
    let solids = [ball(), ball().placed(&Placement::translation(DVec3::X * 8.0))];
    let known = 20.0 * (std::f64::consts::PI - libm::acos(0.4));
    for id in 0..2 {
        let found = visible(&solids, &Camera::view(View::Front), id);
        assert!(near(found, known, 1e-5), "{id}: {found} {known}");
    }
}
