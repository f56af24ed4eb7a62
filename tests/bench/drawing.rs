//! The drawings that are timed against other systems by `compare_drawings.py`: the scenes, and a process
//! that draws one of them each time it is asked to. Only the drawing is timed, not the making of the solids.
//!
//! ```sh
//! cargo bench --bench drawing -- list
//! cargo bench --bench drawing -- serve torus   # a line in, milliseconds and lengths out
//! ```

use std::{
    fs,
    io::{self, BufRead, Write},
    sync::Arc,
    time::Instant,
};

use glam::{DMat3, DVec3, dvec3};
use katachi::{
    geom::{Origin, Placement, PolyMesh, Surface, Tolerance, sides, triangulate::triangulate},
    kernel::brep::{
        Polyhedron,
        boolean::{Tree, evaluate},
        primitive::{cone, cuboid, sphere, torus},
    },
    output::drawing::{Camera, Drawing, HeightField, Options, Scene, horizon_lines, visible_lines},
};
use serde_json::{Value, json};

/// What is drawn.
enum Subject {
    Solids(Vec<Polyhedron>),
    Graph(HeightField),
}

/// A name, and what it stands for.
type Drawn = (&'static str, fn() -> (Subject, Camera));

const SCENES: &[Drawn] = &[
    ("city", || (solids(boxes("city")), camera("city"))),
    ("overlap", || (solids([united(boxes("overlap"))]), camera("overlap"))),
    ("scale960", || (solids(boxes("scale960")), camera("scale960"))),
    ("plate", || (solids([plate()]), camera("plate"))),
    ("torus", || (solids([ring()]), camera("torus"))),
    ("spheres200", || (solids([united(balls())]), camera("spheres200"))),
    ("triangles", || (solids([wavy_ring()]), toward(0.3, -1.0, 0.6))),
    ("graph", || (Subject::Graph(waves()), toward(0.5, -0.866, 0.577))),
];

fn main() {
    // Cargo adds `--bench`; without a command there is nothing to do.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["list"] => SCENES.iter().for_each(|scene| println!("{}", scene.0)),
        ["serve", name] => serve(name),
        _ => println!("list | serve <scene>"),
    }
}

/// Draws the scene for each line of the input.
#[allow(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
fn serve(name: &str) {
    let found = SCENES.iter().find(|scene| scene.0 == name);
    let (subject, camera) = found.unwrap_or_else(|| panic!("no scene `{name}`")).1();
    for _ in io::stdin().lock().lines() {
        let start = Instant::now();
        let drawing = draw(&subject, &camera);
        let ms = start.elapsed().as_secs_f64() * 1e3;
        let Drawing { visible, hidden, segments, .. } = drawing;
        println!(
            "{}",
            json!({ "ms": ms, "visible": visible, "hidden": hidden, "segments": segments })
        );
        io::stdout().flush().expect("standard output is open");
    }
}

fn draw(subject: &Subject, camera: &Camera) -> Drawing {
    match subject {
        Subject::Solids(solids) => {
            let scene = Scene::of(solids.iter().map(Polyhedron::mesh));
            visible_lines(&scene, camera, &Options::default())
        }
        Subject::Graph(field) => horizon_lines(field, camera, 0).expect("seen from above"),
    }
}

fn solids(list: impl IntoIterator<Item = Polyhedron>) -> Subject {
    Subject::Solids(list.into_iter().collect())
}

fn toward(x: f64, y: f64, z: f64) -> Camera {
    Camera::parallel(dvec3(x, y, z)).expect("a direction")
}

fn read(name: &str) -> Value {
    let text = fs::read_to_string(format!("tests/scenes/{name}.json"));
    serde_json::from_str(&text.expect("the scene is there")).expect("JSON")
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

fn vector(value: &Value) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|i| value[i].as_f64().expect("a number")))
}

fn camera(name: &str) -> Camera {
    let camera = read(&format!("{name}.cam"));
    let (eye, target) = (vector(&camera["eye"]), vector(&camera["target"]));
    if camera["type"] == "persp" {
        Camera::perspective(eye, target).expect("apart")
    } else {
        Camera::parallel(eye - target).expect("apart").at(target)
    }
}

fn boxes(name: &str) -> Vec<Polyhedron> {
    let placed = |recipe: &Value| {
        let half = vector(&recipe["size"]) / 2.0;
        let rows = [0, 1, 2].map(|i| vector(&recipe["R"][i]));
        let turn = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose();
        cuboid(-half, half).placed(&Placement::new(turn, vector(&recipe["center"])))
    };
    list(&read(&format!("{name}.recipe"))).iter().map(placed).collect()
}

fn balls() -> Vec<Polyhedron> {
    let placed = |recipe: &Value| {
        let radius = recipe[3].as_f64().expect("a number");
        let ball = sphere(radius, sides::sphere(radius, Tolerance::DEFAULT));
        ball.placed(&Placement::translation(vector(recipe)))
    };
    list(&read("spheres200.recipe")).iter().map(placed).collect()
}

fn united(solids: impl IntoIterator<Item = Polyhedron>) -> Polyhedron {
    let leaves = solids.into_iter().map(|s| Tree::Leaf(Arc::new(s))).collect();
    evaluate(&Tree::Union(leaves)).expect("the union is a solid").solid
}

fn plate() -> Polyhedron {
    let slab = cuboid(dvec3(-60., -60., 0.), dvec3(60., 60., 10.));
    let hole = Arc::new(cone(4.0, 4.0, 20.0, sides::circle(4.0, Tolerance::DEFAULT)));
    let at = |i: u32| -54.0 + 12.0 * f64::from(i);
    let holes = (0..100).map(|i| {
        let place = Placement::translation(dvec3(at(i % 10), at(i / 10), -5.0));
        Tree::Placed(place, Box::new(Tree::Leaf(hole.clone())))
    });
    let tree = [Tree::Leaf(Arc::new(slab))].into_iter().chain(holes).collect();
    evaluate(&Tree::Difference(tree)).expect("the plate is a solid").solid
}

fn ring() -> Polyhedron {
    let (around, tube) = sides::torus(30.0, 10.0, Tolerance::DEFAULT);
    torus(30.0, 10.0, around, tube)
}

/// 100,000 triangles of a wavy ring without a closed form.
fn wavy_ring() -> Polyhedron {
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
    Polyhedron::new(mesh).expect("closed")
}

/// 3 sin r / r over 200 x 200 points, r the distance from the middle.
fn waves() -> HeightField {
    let axis: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.1 - 9.95).collect();
    let height = |x: f64, y: f64| {
        let r = libm::hypot(x, y);
        3.0 * libm::sin(r) / r
    };
    let z = axis.iter().flat_map(|&x| axis.iter().map(move |&y| height(x, y))).collect();
    HeightField::new(axis.clone(), axis, z).expect("a grid")
}
