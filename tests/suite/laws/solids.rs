//! Solids for the tests of set operations, and what is measured of them.

use std::{collections::BTreeMap, sync::Arc};

use glam::{DMat3, DVec2, DVec3};
use katachi::{
    geom::{Origin, Placement, PolyMesh, Surface},
    kernel::brep::{Polyhedron, boolean::Tree},
};

/// A prism over a convex counter-clockwise polygon.
pub fn prism(outline: &[DVec2], low: f64, high: f64, side: Surface) -> Polyhedron {
    let n = outline.len() as u32;
    let points = [low, high].into_iter().flat_map(|z| outline.iter().map(move |p| p.extend(z)));
    let mut mesh = PolyMesh::with_points(points.collect());
    let end = mesh.add_origin(Origin::of(Surface::Plane));
    let flank = mesh.add_origin(Origin::of(side));
    let [bottom, top] = [mesh.add_plane(), mesh.add_plane()];
    mesh.push_face(&[(0..n).rev().collect::<Vec<_>>()], bottom, end);
    mesh.push_face(&[(n..2 * n).collect::<Vec<_>>()], top, end);
    for i in 0..n {
        let j = (i + 1) % n;
        let plane = mesh.add_plane();
        mesh.push_face(&[[i, j, n + j, n + i]], plane, flank);
    }
    Polyhedron::new(mesh).expect("a prism is closed")
}

/// A box between two corners.
pub fn cuboid(min: [f64; 3], max: [f64; 3]) -> Polyhedron {
    let corner = |x: f64, y: f64| DVec2::new(x, y);
    let outline = [
        corner(min[0], min[1]),
        corner(max[0], min[1]),
        corner(max[0], max[1]),
        corner(min[0], max[1]),
    ];
    prism(&outline, min[2], max[2], Surface::Plane)
}

/// A cylinder with so many sides about a line along z.
pub fn cylinder(center: [f64; 2], radius: f64, low: f64, high: f64, sides: u32) -> Polyhedron {
    let outline: Vec<DVec2> = (0..sides)
        .map(|i| {
            let turn = std::f64::consts::TAU * f64::from(i) / f64::from(sides);
            DVec2::from_array(center) + radius * DVec2::new(libm::cos(turn), libm::sin(turn))
        })
        .collect();
    let point = DVec3::new(center[0], center[1], low);
    prism(&outline, low, high, Surface::Cylinder { point, axis: DVec3::Z, radius })
}

/// A leaf.
pub fn leaf(solid: Polyhedron) -> Tree {
    Tree::Leaf(Arc::new(solid))
}

/// A box as a leaf.
pub fn block(min: [f64; 3], max: [f64; 3]) -> Tree {
    leaf(cuboid(min, max))
}

/// A tree turned by three angles in degrees, about x, then y, then z.
pub fn turned(degrees: [f64; 3], tree: Tree) -> Tree {
    let [x, y, z] = degrees.map(f64::to_radians);
    let about = |i: usize, j: usize, angle: f64| {
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        let mut m = DMat3::IDENTITY;
        m.col_mut(i)[i] = c;
        m.col_mut(i)[j] = s;
        m.col_mut(j)[i] = -s;
        m.col_mut(j)[j] = c;
        m
    };
    let linear = about(0, 1, z) * about(2, 0, y) * about(1, 2, x);
    Tree::Placed(Placement::new(linear, DVec3::ZERO), Box::new(tree))
}

/// A tree all of whose parts are turned one by one, as a modeller turns them.
pub fn each_turned(degrees: [f64; 3], tree: &Tree) -> Tree {
    let all = |parts: &[Tree]| parts.iter().map(|part| each_turned(degrees, part)).collect();
    match tree {
        Tree::Union(parts) => Tree::Union(all(parts)),
        Tree::Difference(parts) => Tree::Difference(all(parts)),
        Tree::Intersection(parts) => Tree::Intersection(all(parts)),
        part => {
            let Tree::Placed(turn, part) = turned(degrees, part.clone()) else {
                return part.clone();
            };
            match *part {
                Tree::Placed(inner, part) => Tree::Placed(turn.after(&inner), part),
                part => Tree::Placed(turn, Box::new(part)),
            }
        }
    }
}

/// A tree moved.
pub fn moved(by: [f64; 3], tree: Tree) -> Tree {
    Tree::Placed(Placement::translation(DVec3::from_array(by)), Box::new(tree))
}

/// Volume by the divergence theorem.
pub fn volume(solid: &Polyhedron) -> f64 {
    let mesh = solid.mesh();
    let Some(&base) = mesh.points.first() else { return 0.0 };
    let part = |f: katachi::geom::FaceRef<'_>| {
        f.area_vector().dot(mesh.points[f.outer()[0] as usize] - base)
    };
    mesh.faces().map(part).sum::<f64>() / 6.0
}

/// Area of the boundary.
pub fn area(solid: &Polyhedron) -> f64 {
    solid.mesh().faces().map(|f| f.area_vector().length() / 2.0).sum()
}

/// Points less edges plus faces, a hole counting as a bridge: 2 for each shell less 2 per handle.
pub fn euler(solid: &Polyhedron) -> i64 {
    let mesh = solid.mesh();
    let mut edges = BTreeMap::new();
    let mut used = BTreeMap::new();
    let mut faces = 0i64;
    for face in mesh.faces() {
        faces += 2 - face.loops().len() as i64;
        for corners in face.loops() {
            for (i, &a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()];
                edges.insert((a.min(b), a.max(b)), ());
                used.insert(a, ());
            }
        }
    }
    used.len() as i64 - edges.len() as i64 + faces
}

/// A tree scaled about the origin.
pub fn scaled(factor: f64, tree: Tree) -> Tree {
    let linear = DMat3::from_diagonal(DVec3::splat(factor));
    Tree::Placed(Placement::new(linear, DVec3::ZERO), Box::new(tree))
}
