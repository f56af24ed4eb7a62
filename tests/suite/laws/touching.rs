//! Results that touch themselves are written, read and are the same solids again.

use katachi::{
    input::read_mesh,
    kernel::brep::{
        Polyhedron,
        boolean::{Tree, evaluate},
        faces::from_import,
        primitive::sphere,
    },
    output::mesh::{MeshFormat, NamedMesh, write},
};

use super::solids::*;

/// What a file of a solid holds when it is read again.
fn read_back(solid: &Polyhedron, format: MeshFormat) -> Polyhedron {
    let part = [NamedMesh { name: "solid", mesh: solid.mesh() }];
    let bytes = write(format, &part).expect("a solid is finite");
    let mesh = read_mesh(&format!("solid.{}", format.extension()), &bytes).expect("well formed");
    from_import(&mesh).unwrap_or_else(|defect| panic!("{}: {defect}", format.name()))
}

/// Coordinates in some formats are of single precision.
const SINGLE: f64 = 1e-5;

#[track_caller]
fn comes_back(tree: Tree, expected: f64) {
    for tree in [tree.clone(), turned([17.0, 23.0, 41.0], tree)] {
        let solid = evaluate(&tree).expect("a result").solid;
        assert!((volume(&solid) - expected).abs() < 1e-9 * expected, "{}", volume(&solid));
        for format in MeshFormat::ALL.into_iter().filter(|f| *f != MeshFormat::Glb) {
            let again = read_back(&solid, format);
            let found = volume(&again);
            assert!((found - expected).abs() < SINGLE * expected, "{}: {found}", format.name());
            let far = moved([100.0, 0.0, 0.0], block([0.0; 3], [1.0; 3]));
            let once_more = evaluate(&Tree::Union(vec![leaf(again), far])).expect("a result");
            let found = volume(&once_more.solid) - 1.0;
            assert!((found - expected).abs() < SINGLE * expected, "{}: {found}", format.name());
        }
    }
}

fn union(parts: Vec<Tree>) -> Tree {
    Tree::Union(parts)
}

#[test]
fn edge_on_edge() {
    let cube = || block([0.0; 3], [1.0; 3]);
    comes_back(union(vec![cube(), block([1.0, 1.0, 0.0], [2.0, 2.0, 1.0])]), 2.0);
    comes_back(union(vec![cube(), block([1.0, 1.0, 0.25], [2.0, 2.0, 0.75])]), 1.5);
    comes_back(union(vec![cube(), block([1.0, 1.0, 0.5], [2.0, 2.0, 3.0])]), 3.5);
}

#[test]
fn corner_on_corner_and_on_edge_and_in_a_face() {
    let cube = || block([0.0; 3], [1.0; 3]);
    comes_back(union(vec![cube(), block([1.0; 3], [2.0; 3])]), 2.0);
    let tip =
        || leaf(prism(&[(0.0, 0.0), (1.0, -1.0), (1.0, 1.0)].map(Into::into), 0.0, 1.0, PLANE));
    comes_back(union(vec![cube(), moved([1.0, 0.5, 1.0], tip())]), 2.0);
    let ball = leaf(sphere(1.0, 4));
    let floor = block([-3.0, -3.0, -2.0], [3.0, 3.0, -1.0]);
    let octahedron = volume(&sphere(1.0, 4));
    comes_back(union(vec![floor, ball]), 36.0 + octahedron);
}

/// The wedge touches the floor along a line in the middle of its face.
#[test]
fn edge_in_a_face() {
    let wedge = leaf(prism(&[(2.0, 1.0), (3.0, 2.0), (1.0, 2.0)].map(Into::into), 1.0, 2.0, PLANE));
    comes_back(union(vec![block([0.0; 3], [4.0, 1.0, 3.0]), wedge.clone()]), 13.0);
    comes_back(union(vec![block([2.0, 0.0, 0.5], [3.0, 1.0, 3.0]), wedge]), 3.5);
}

/// One shell that comes back to itself along an edge.
#[test]
fn a_ring_closed_by_an_edge() {
    let ring = union(vec![
        block([0.0, 0.0, 0.0], [3.0, 1.0, 1.0]),
        block([0.0, 0.0, 0.0], [1.0, 3.0, 1.0]),
        block([0.0, 2.0, 0.0], [2.0, 3.0, 1.0]),
        block([2.0, 0.0, 0.0], [3.0, 2.0, 1.0]),
    ]);
    comes_back(ring, 7.0);
}

const PLANE: katachi::geom::Surface = katachi::geom::Surface::Plane;
