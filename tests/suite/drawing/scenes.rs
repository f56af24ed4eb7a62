//! Scenes of boxes and round things, and the cameras that look at them.

use std::{fs, sync::Arc};

use glam::{DMat3, DVec3};
use katachi::{
    geom::Placement,
    kernel::brep::{
        Polyhedron,
        boolean::{Tree, evaluate},
        primitive::{cone, cuboid},
    },
    output::drawing::{Camera, Drawing, Method, Options, Scene, visible_lines},
};
use serde_json::Value;

fn json(name: &str) -> Value {
    let text = fs::read_to_string(format!("tests/scenes/{name}.json")).expect("the scene is there");
    serde_json::from_str(&text).expect("the scene is JSON")
}

fn vector(value: &Value) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|i| value[i].as_f64().expect("a number")))
}

/// The boxes of a recipe: centre, size and the rows of a rotation.
pub fn boxes(name: &str) -> Vec<Polyhedron> {
    let recipe = json(&format!("{name}.recipe"));
    recipe.as_array().expect("a list").iter().map(placed_box).collect()
}

fn placed_box(recipe: &Value) -> Polyhedron {
    let half = vector(&recipe["size"]) / 2.0;
    let rows =
        DMat3::from_cols(vector(&recipe["R"][0]), vector(&recipe["R"][1]), vector(&recipe["R"][2]));
    cuboid(-half, half).placed(&Placement::new(rows.transpose(), vector(&recipe["center"])))
}

/// The camera of a scene.
pub fn camera(name: &str) -> Camera {
    let camera = json(&format!("{name}.cam"));
    let (eye, target) = (vector(&camera["eye"]), vector(&camera["target"]));
    match camera["type"].as_str() {
        Some("persp") => Camera::perspective(eye, target).expect("apart"),
        _ => Camera::parallel(eye - target).expect("apart").at(target),
    }
}

/// The union of solids.
pub fn union(solids: Vec<Polyhedron>) -> Polyhedron {
    let leaves = solids.into_iter().map(|s| Tree::Leaf(Arc::new(s))).collect();
    evaluate(&Tree::Union(leaves)).expect("the union is a solid").solid
}

/// A plate with holes along z through it.
pub fn plate(sides: u32) -> Polyhedron {
    let slab = cuboid(DVec3::new(-60.0, -60.0, 0.0), DVec3::new(60.0, 60.0, 10.0));
    let hole = Arc::new(cone(4.0, 4.0, 20.0, sides));
    let at = |i: usize| -54.0 + 12.0 * i as f64;
    let holes = (0..100).map(|i| {
        let placement = Placement::translation(DVec3::new(at(i % 10), at(i / 10), -5.0));
        Tree::Placed(placement, Box::new(Tree::Leaf(hole.clone())))
    });
    let tree = [Tree::Leaf(Arc::new(slab))].into_iter().chain(holes);
    evaluate(&Tree::Difference(tree.collect())).expect("the plate is a solid").solid
}

/// The drawing of solids by one method.
pub fn drawn(solids: &[Polyhedron], camera: &Camera, method: Method) -> Drawing {
    let options = Options { method, ..Options::default() };
    visible_lines(&Scene::of(solids.iter().map(Polyhedron::mesh)), camera, &options)
}

/// Whether two lengths agree relatively.
pub fn near(found: f64, known: f64, relative: f64) -> bool {
    (found - known).abs() <= relative * known.abs().max(1.0)
}
