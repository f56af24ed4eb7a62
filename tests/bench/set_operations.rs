//! The set operations that are timed against other kernels by `compare.py`: the models, and a
//! process that evaluates one of them each time it is asked to.
//!
//! ```sh
//! cargo bench --bench set_operations -- list
//! cargo bench --bench set_operations -- leaves chain folder   # OFF files and tree.json
//! cargo bench --bench set_operations -- serve chain           # an empty line in, milliseconds out;
//!                                                             # a path in, the result as OFF there
//! cargo bench --bench set_operations -- judge result.off      # is it closed, does it cross itself?
//! ```

use std::{
    fs,
    io::{self, BufRead, Write},
    path::Path,
    sync::Arc,
    time::Instant,
};

use glam::{DMat3, DQuat, DVec3, dvec3};
use katachi::{
    geom::{Bounds, Placement, PolyMesh, triangulate::triangulate},
    input::read_mesh,
    kernel::brep::{
        Polyhedron,
        boolean::{Tree, evaluate},
        crossing::crossings,
        measure::volume,
        primitive::{cone, cuboid, sphere},
    },
    output::mesh::{MeshFormat, NamedMesh, write},
};
use serde_json::{Value, json};

/// A name and what it stands for.
type Model = (&'static str, fn() -> Tree);

const MODELS: &[Model] = &[
    ("spheres24", || spheres(24)),
    ("spheres224", || spheres(224)),
    ("spheres708", || spheres(708)),
    ("cuboids12", || cuboids(12)),
    ("cuboids60", || cuboids(60)),
    ("plate", plate),
    ("menger3", || menger(3)),
    ("menger4", || menger(4)),
    ("cubes512", cubes),
    ("chain", chain),
];

fn main() {
    // Cargo adds `--bench`; without a command there is nothing to do.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["list"] => MODELS.iter().for_each(|m| println!("{}", m.0)),
        ["leaves", name, folder] => leaves(&model(name), Path::new(folder)),
        ["serve", name] => serve(&model(name)),
        ["judge", file] => println!("{}", judge(Path::new(file))),
        _ => println!("list | leaves <model> <folder> | serve <model> | judge <file>"),
    }
}

fn model(name: &str) -> Tree {
    let found = MODELS.iter().find(|m| m.0 == name);
    found.unwrap_or_else(|| panic!("no model `{name}`")).1()
}

/// Evaluates the model for each empty line of the input and answers with the time; writes the last
/// result to the path that any other line gives.
#[allow(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
fn serve(tree: &Tree) {
    let mut solid = Polyhedron::empty();
    for line in io::stdin().lock().lines() {
        let path = line.expect("standard input is text");
        if path.is_empty() {
            let start = Instant::now();
            solid = evaluate(tree).expect("the model is valid").solid;
            let ms = start.elapsed().as_secs_f64() * 1e3;
            println!("{}", json!({ "ms": ms, "peak": peak(), "volume": volume(&solid) }));
        } else {
            off(&solid, Path::new(&path));
            println!("{{}}");
        }
        io::stdout().flush().expect("standard output is open");
    }
}

/// The most memory that this process has held, kilobytes; 0 where the system does not say.
fn peak() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    line.and_then(|l| l.trim().trim_end_matches(" kB").parse().ok()).unwrap_or(0)
}

/// What is right and wrong with the triangles of a file, whoever wrote it.
fn judge(file: &Path) -> Value {
    let bytes = fs::read(file).expect("the file can be read");
    let mesh = read_mesh("result.off", &bytes).expect("the file is OFF");
    json!({
        "triangles": mesh.triangle_count(),
        "closed": Polyhedron::new(mesh.clone()).is_ok(),
        "slivers": slivers(&mesh),
        "crossings": crossings(&mesh).len(),
    })
}

/// A triangle is degenerate if it is less high than this share of the size of its solid.
const DEGENERATE: f64 = 1e-12;

/// The number of degenerate triangles.
fn slivers(mesh: &PolyMesh) -> usize {
    let Bounds { min, max } = Bounds::of(mesh.points.iter().copied());
    let limit = (max - min).length() * DEGENERATE;
    let triangles = triangulate(mesh).corners;
    let corners = triangles.iter().map(|t| t.map(|c| mesh.points[c as usize]));
    corners.filter(|&[a, b, c]| height([a, b, c]) <= limit).count()
}

/// The height of a triangle over its longest side.
fn height([a, b, c]: [DVec3; 3]) -> f64 {
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    (b - a).cross(c - a).length() / longest.max(f64::MIN_POSITIVE)
}

/// Writes every leaf where it stands, as triangles, and the tree over their numbers.
fn leaves(tree: &Tree, folder: &Path) {
    fs::create_dir_all(folder).expect("the folder can be made");
    let mut count = 0;
    let tree = written(tree, &Placement::IDENTITY, folder, &mut count);
    fs::write(folder.join("tree.json"), tree.to_string()).expect("the folder can be written");
}

fn written(tree: &Tree, at: &Placement, folder: &Path, count: &mut u32) -> Value {
    let mut parts = |name: &str, parts: &[Tree]| {
        let parts = parts.iter().map(|part| written(part, at, folder, count));
        Value::Array([json!(name)].into_iter().chain(parts).collect())
    };
    match tree {
        Tree::Union(list) => parts("union", list),
        Tree::Difference(list) => parts("difference", list),
        Tree::Intersection(list) => parts("intersection", list),
        Tree::Placed(inner, child) => written(child, &at.after(inner), folder, count),
        Tree::Leaf(solid) => {
            let number = *count;
            *count += 1;
            off(&solid.placed(at), &folder.join(format!("{number}.off")));
            json!(number)
        }
    }
}

/// Writes a solid as triangles.
fn off(solid: &Polyhedron, file: &Path) {
    let part = [NamedMesh { name: "solid", mesh: solid.mesh() }];
    let bytes = write(MeshFormat::Off, &part).expect("a solid is finite");
    fs::write(file, bytes).expect("the folder exists");
}

fn leaf(solid: Polyhedron) -> Tree {
    Tree::Leaf(Arc::new(solid))
}

fn placed(solid: &Arc<Polyhedron>, placement: Placement) -> Tree {
    Tree::Placed(placement, Box::new(Tree::Leaf(solid.clone())))
}

/// A unit sphere less a moved one.
fn spheres(sides: u32) -> Tree {
    let ball = Arc::new(sphere(1.0, sides));
    let moved = placed(&ball, Placement::translation(dvec3(0.5, 0.3, 0.2)));
    Tree::Difference(vec![Tree::Leaf(ball), moved])
}

/// Random numbers from 0 to 1 (SplitMix64), the same everywhere.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self) -> DVec3 {
        dvec3(self.next(), self.next(), self.next()) * 2.0 - 1.0
    }

    /// A rotation; not uniform, which is no matter here.
    fn rotation(&mut self) -> DMat3 {
        let [axis, turn] = [self.vector(), self.vector()];
        let quaternion = DQuat::from_xyzw(axis.x, axis.y, axis.z, turn.x + 0.01);
        DMat3::from_quat(quaternion.normalize())
    }
}

/// The union of cuboids turned every way about places near the origin.
fn cuboids(count: u32) -> Tree {
    let mut random = Random(11);
    let bar = Arc::new(cuboid(dvec3(-5.0, -3.0, -2.0), dvec3(5.0, 3.0, 2.0)));
    let tumbled = (0..count).map(|_| {
        let linear = random.rotation();
        placed(&bar, Placement::new(linear, random.vector() * 8.0))
    });
    Tree::Union(tumbled.collect())
}

/// A plate less 1000 cylinders.
fn plate() -> Tree {
    let drill = Arc::new(cone(4.0, 4.0, 20.0, 32));
    let mut parts = vec![leaf(cuboid(dvec3(-205., -130., -2.5), dvec3(205., 130., 2.5)))];
    for i in 0..1000 {
        let (x, y) = (f64::from(i / 25), f64::from(i % 25));
        let place = dvec3(x * 10.0 - 195.0, y * 10.0 - 120.0, -10.0);
        parts.push(placed(&drill, Placement::translation(place)));
    }
    Tree::Difference(parts)
}

/// A cube less bars along all axes, level by level.
fn menger(levels: u32) -> Tree {
    const SIDE: f64 = 81.0;
    let mut parts = vec![leaf(cuboid(DVec3::ZERO, DVec3::splat(SIDE)))];
    for level in 1..=levels {
        let count = 3u32.pow(level - 1);
        let (cell, w) = (SIDE / f64::from(count), SIDE / f64::from(3 * count));
        for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (f64::from(i), f64::from(j))))
        {
            let min = dvec3(i * cell + w, j * cell + w, -1.0);
            let max = dvec3(i * cell + 2.0 * w, j * cell + 2.0 * w, SIDE + 1.0);
            let around = |v: DVec3, turns: usize| (0..turns).fold(v, |v, _| dvec3(v.z, v.x, v.y));
            parts.extend((0..3).map(|t| leaf(cuboid(around(min, t), around(max, t)))));
        }
    }
    Tree::Difference(parts)
}

/// Eight by eight by eight cubes that touch.
fn cubes() -> Tree {
    let cube = Arc::new(cuboid(DVec3::ZERO, DVec3::ONE));
    let at = |i: u32| dvec3(f64::from(i % 8), f64::from(i / 8 % 8), f64::from(i / 64));
    Tree::Union((0..512).map(|i| placed(&cube, Placement::translation(at(i)))).collect())
}

/// Spheres near the origin, added and taken away in turn.
fn chain() -> Tree {
    let mut random = Random(7);
    let ball = Arc::new(sphere(5.0, 24));
    let mut next = || placed(&ball, Placement::translation(random.vector() * 6.0));
    let mut tree = next();
    for i in 1..100 {
        let pair = vec![tree, next()];
        tree = if i % 2 == 0 { Tree::Union(pair) } else { Tree::Difference(pair) };
    }
    tree
}
