//! Hard cases by name: touching, coplanar and nested operands, unrotated and rotated.

use glam::DVec2;
use katachi::{
    geom::Surface,
    kernel::brep::{
        Polyhedron,
        boolean::{Tree, evaluate},
    },
};

use super::{solids::*, soundness};

fn solid(tree: &Tree) -> Polyhedron {
    evaluate(tree).expect("a result").solid
}

/// The angles by which the cases are turned, degrees.
const TURNS: [[f64; 3]; 5] = [
    [17.0, 23.0, 41.0],
    [90.0, 45.0, 30.0],
    [0.0, 0.0, 1e-4],
    [-71.3, 110.0, 5.0],
    [0.0, 60.0, 0.0],
];

/// A case upright, turned as a whole, and with every part turned.
fn in_all_ways(tree: Tree) -> Vec<Tree> {
    let ways = TURNS.map(|turn| [each_turned(turn, &tree), turned(turn, tree.clone())]);
    std::iter::once(tree).chain(ways.into_iter().flatten()).collect()
}

/// What a case must give: volume, triangles, Euler number; upright and turned.
#[track_caller]
fn check(tree: Tree, expected_volume: f64, triangles: usize, euler_number: i64) {
    for tree in in_all_ways(tree) {
        let solid = solid(&tree);
        assert_eq!(soundness::fault(&solid), None);
        let found = volume(&solid);
        assert!(
            (found - expected_volume).abs() <= 1e-9 * expected_volume.abs().max(1.0),
            "volume {found}, expected {expected_volume}"
        );
        assert_eq!(euler(&solid), euler_number, "Euler number");
        assert_eq!(solid.mesh().triangle_count(), triangles, "triangles");
    }
}

fn union(parts: Vec<Tree>) -> Tree {
    Tree::Union(parts)
}

fn less(parts: Vec<Tree>) -> Tree {
    Tree::Difference(parts)
}

#[test]
fn crossing_boxes() {
    let (a, b) = (block([0.0; 3], [2.0; 3]), block([1.0; 3], [3.0; 3]));
    check(union(vec![a.clone(), b.clone()]), 15.0, 36, 2);
    check(less(vec![a.clone(), b.clone()]), 7.0, 24, 2);
    check(Tree::Intersection(vec![a, b]), 1.0, 12, 2);
}

#[test]
fn equal_boxes() {
    let a = block([0.1, 0.2, 0.3], [1.0, 2.0, 3.0]);
    let v = 0.9 * 1.8 * 2.7;
    check(union(vec![a.clone(), a.clone()]), v, 12, 2);
    check(Tree::Intersection(vec![a.clone(), a.clone()]), v, 12, 2);
    check(less(vec![a.clone(), a]), 0.0, 0, 0);
}

#[test]
fn face_to_face() {
    let (a, b) = (block([0.0; 3], [1.0; 3]), block([1.0, 0.0, 0.0], [2.0, 1.0, 1.0]));
    check(union(vec![a.clone(), b.clone()]), 2.0, 12, 2);
    check(less(vec![a.clone(), b.clone()]), 1.0, 12, 2);
    check(Tree::Intersection(vec![a, b]), 0.0, 0, 0);
}

#[test]
fn partial_faces() {
    let (a, b) = (block([0.0; 3], [2.0; 3]), block([2.0, 1.0, 1.0], [3.0, 3.0, 3.0]));
    check(union(vec![a, b]), 12.0, 32, 2);
}

#[test]
fn edge_to_edge() {
    let (a, b) = (block([0.0; 3], [1.0; 3]), block([1.0, 1.0, 0.0], [2.0, 2.0, 1.0]));
    check(union(vec![a, b]), 2.0, 24, 4);
}

#[test]
fn corner_to_corner() {
    let (a, b) = (block([0.0; 3], [1.0; 3]), block([1.0; 3], [2.0; 3]));
    check(union(vec![a, b]), 2.0, 24, 4);
}

#[test]
fn a_post_whose_corner_stands_on_the_rim() {
    let outline = [(2.0, 1.5), (1.0, 2.0), (1.0, 1.0)].map(DVec2::from);
    let post = |low: f64| leaf(prism(&outline, low, 3.0, Surface::Plane));
    let plate = || block([0.0; 3], [2.0, 3.0, 1.0]);
    check(union(vec![plate(), post(1.0)]), 7.0, 24, 2);
    check(union(vec![plate(), post(0.0)]), 7.0, 24, 2);
    for tree in in_all_ways(less(vec![plate(), post(0.5)])) {
        let solid = solid(&tree);
        assert_eq!(soundness::fault(&solid), None);
        assert!((volume(&solid) - 5.75).abs() < 1e-12);
    }
}

#[test]
fn a_ring_that_touches_itself_along_an_edge() {
    let ring = union(vec![
        block([0.0, 0.0, 0.0], [3.0, 1.0, 1.0]),
        block([0.0, 0.0, 0.0], [1.0, 3.0, 1.0]),
        block([0.0, 2.0, 0.0], [2.0, 3.0, 1.0]),
        block([2.0, 0.0, 0.0], [3.0, 2.0, 1.0]),
    ]);
    for tree in in_all_ways(ring) {
        let solid = solid(&tree);
        assert_eq!(soundness::fault(&solid), None);
        assert!((volume(&solid) - 7.0).abs() < 1e-9);
    }
}

/// The pocket has an edge in a side of the plate. The blocks at the other end make a crowd, so that there are
/// stages: what they leave must be as sound where it touches itself as what one arrangement leaves.
#[test]
fn a_pocket_that_touches_a_side_beside_a_crowd() {
    let corners = [(0.0, 2.0), (1.0, 1.0), (1.0, 3.0)].map(DVec2::from);
    let step = |from: f64, to: f64, high: f64| block([from, 0.0, 0.0], [to, 4.0, high]);
    let parts = [(0.0, 12.0, 2.0), (6.0, 9.0, 3.0), (7.0, 10.0, 4.0), (8.0, 11.0, 5.0)];
    let mut parts: Vec<Tree> = parts.map(|(from, to, high)| step(from, to, high)).into();
    parts.push(step(8.0, 12.0, 6.0));
    for (low, deep) in [(-1.0, 1.0), (0.0, 1.5)] {
        let pocket = leaf(prism(&corners, low, deep, Surface::Plane));
        check(less(vec![union(parts.clone()), pocket]), 172.0 - deep, 48, 2);
    }
}

/// Their faces cross at so small angles that snapping makes what lies between them thinner than doubles can tell.
#[test]
fn boxes_nearly_alike_about_a_corner() {
    let cube = || block([0.0; 3], [1.0; 3]);
    for turn in [[1e-6; 3], [1e-6, -1e-6, 3e-6], [23.0, 1e-6, 1e-6], [1e-6, 17.0, 1e-6]] {
        let both = || vec![turned(turn, cube()), cube()];
        let [one, other, common] =
            [union(both()), less(both()), Tree::Intersection(both())].map(|tree| {
                let solid = solid(&tree);
                assert_eq!(soundness::fault(&solid), None);
                volume(&solid)
            });
        assert!((one + common - 2.0).abs() < 1e-5 && (other + common - 1.0).abs() < 1e-5);
    }
}

#[test]
fn flush_notch() {
    let a = block([0.0; 3], [3.0; 3]);
    let notch = block([1.0, 0.0, 2.0], [2.0, 3.0, 3.0]);
    check(less(vec![a, notch]), 24.0, 28, 2);
}

#[test]
fn cavity() {
    let (a, b) = (block([0.0; 3], [3.0; 3]), block([1.0; 3], [2.0; 3]));
    check(less(vec![a, b]), 26.0, 24, 4);
}

#[test]
fn nested_and_disjoint() {
    let (a, b) = (block([0.0; 3], [3.0; 3]), block([1.0; 3], [2.0; 3]));
    check(union(vec![a.clone(), b.clone()]), 27.0, 12, 2);
    check(Tree::Intersection(vec![a.clone(), b]), 1.0, 12, 2);
    let far = block([5.0; 3], [6.0; 3]);
    check(union(vec![a.clone(), far.clone()]), 28.0, 24, 4);
    check(less(vec![a.clone(), far.clone()]), 27.0, 12, 2);
    check(Tree::Intersection(vec![a, far]), 0.0, 0, 0);
}

#[test]
fn through_hole() {
    let (a, b) = (block([0.0; 3], [3.0; 3]), block([1.0, 1.0, 0.0], [2.0, 2.0, 3.0]));
    check(less(vec![a, b]), 24.0, 32, 0);
}

#[test]
fn flush_slot() {
    let a = block([0.0; 3], [3.0; 3]);
    let slot = block([1.0, 1.0, 2.0], [2.0, 2.0, 3.0]);
    check(less(vec![a.clone(), slot]), 26.0, 28, 2);
    let open = block([1.0, 0.0, 1.0], [2.0, 3.0, 2.0]);
    check(less(vec![a.clone(), open.clone()]), 24.0, 32, 0);
    check(union(vec![less(vec![a, open.clone()]), open]), 27.0, 12, 2);
}

#[test]
fn cylinder_flush_in_a_box() {
    let plate = || block([0.0; 3], [4.0, 4.0, 2.0]);
    for sides in [5, 32, 99] {
        let rod = cylinder([2.0, 2.0], 1.0, 0.0, 2.0, sides);
        let (hole, sides) = (volume(&rod), sides as usize);
        let rod = leaf(rod);
        check(union(vec![plate(), rod.clone()]), 32.0, 12, 2);
        let drilled = less(vec![plate(), rod.clone()]);
        for tree in in_all_ways(drilled.clone()) {
            let solid = solid(&tree);
            assert_eq!(soundness::fault(&solid), None);
            assert!((volume(&solid) - (32.0 - hole)).abs() < 1e-6);
            assert_eq!(solid.mesh().triangle_count(), 2 * (4 + sides) + 8 + 2 * sides);
            assert_eq!(euler(&solid), 0);
        }
        check(union(vec![drilled, rod]), 32.0, 12, 2);
    }
}

/// Where on its axis a cylinder is taken hold of is no matter: no ring stays between the two.
#[test]
fn cylinders_end_to_end() {
    let sides = 24;
    let rod = |low: f64, high: f64| leaf(cylinder([2.0, 1.0], 1.5, low, high, sides));
    let length = volume(&cylinder([2.0, 1.0], 1.5, 0.0, 9.0, sides));
    let triangles = 4 * sides as usize - 4;
    check(union(vec![rod(0.0, 4.0), rod(4.0, 9.0)]), length, triangles, 2);
    check(union(vec![rod(0.0, 6.0), rod(3.0, 9.0)]), length, triangles, 2);
    let stack = union((0..9).map(|i| moved([0.0, 0.0, f64::from(i)], rod(0.0, 1.0))).collect());
    check(stack, length, triangles, 2);
}

/// Parts that are flush with each other but stand otherwise than the rest are one part in any frame.
#[test]
fn turned_cylinders_and_bars_end_to_end_among_others() {
    let rod = |low: f64, high: f64| leaf(cylinder([2.0, 1.0], 1.5, low, high, 24));
    let bar = |low: f64, high: f64| block([-1.0, -1.0, low], [1.0, 1.0, high]);
    let rest =
        [[4.0, 2.0, 1.0], [2.0, 4.0, 1.0], [2.0, 2.0, 3.0]].map(|size| block([0.0; 3], size));
    let measured = |parts: Vec<Tree>, turn: [f64; 3]| {
        let turned = parts.into_iter().map(|part| turned(turn, part));
        let solid = solid(&union(rest.clone().into_iter().chain(turned).collect()));
        assert_eq!(soundness::fault(&solid), None);
        (solid.mesh().triangle_count(), volume(&solid))
    };
    for turn in TURNS {
        let one = measured(vec![rod(-9.0, 9.0)], turn);
        assert_eq!(measured(vec![rod(-9.0, 4.0), rod(4.0, 9.0)], turn), one);
        assert_eq!(measured(vec![rod(-9.0, 6.0), rod(3.0, 9.0)], turn), one);
        let one = measured(vec![bar(-9.0, 9.0)], turn);
        assert_eq!(measured(vec![bar(-9.0, 5.0), bar(5.0, 9.0)], turn), one);
    }
}

#[test]
fn a_cylinder_half_in_a_wall() {
    let rod = leaf(cylinder([2.0, 0.0], 1.0, 0.0, 3.0, 24));
    let half = less(vec![rod, block([0.0; 3], [4.0, 2.0, 3.0])]);
    for tree in in_all_ways(half) {
        let solid = solid(&tree);
        assert_eq!(soundness::fault(&solid), None);
        assert_eq!(solid.mesh().triangle_count(), 2 * 11 + 2 * 12 + 2);
    }
}

#[test]
fn touching_cubes() {
    let mut cubes = vec![];
    for i in 0..512u32 {
        let at = [i % 8, i / 8 % 8, i / 64].map(f64::from);
        cubes.push(block(at, at.map(|c| c + 1.0)));
    }
    check(union(cubes), 512.0, 12, 2);
}

#[test]
fn nested_rotations_share_a_frame() {
    let inner = union(vec![block([0.0; 3], [2.0; 3]), block([2.0, 0.0, 0.0], [4.0, 2.0, 2.0])]);
    let tree = union(vec![
        turned([17.0, 23.0, 41.0], inner.clone()),
        turned([17.0, 23.0, 41.0], moved([0.0, 2.0, 0.0], inner)),
    ]);
    check(tree, 32.0, 12, 2);
}

#[test]
fn untouched_corners_keep_their_coordinates() {
    let a = cuboid([0.1, 1.0 / 3.0, -0.7], [2.0 / 3.0, 12.345, 9.9]);
    let before = a.mesh().points.clone();
    let cut = block([-1.0, -1.0, 5.0], [20.0, 20.0, 20.0]);
    let after = solid(&less(vec![leaf(a), cut]));
    for p in &before[..4] {
        assert!(after.mesh().points.contains(p), "{p}");
    }
    assert_eq!(after.mesh().points.iter().filter(|p| p.z == 5.0).count(), 4);
}

#[test]
fn new_corners_stay_on_faces_whose_place_is_no_decimal() {
    let third = 1.0 / 3.0;
    let a = block([third; 3], [10.0 * third; 3]);
    let cut = block([1.0; 3], [20.0; 3]);
    let after = solid(&less(vec![a, cut]));
    let on = |x: f64| after.mesh().points.iter().filter(|p| p.x == x).count();
    assert_eq!((on(third), on(1.0), on(10.0 * third)), (4, 4, 6));
}

#[test]
fn a_result_that_touches_itself_along_part_of_an_edge_is_a_leaf_again() {
    let parts = vec![block([0.0; 3], [1.0, 1.0, 3.0]), block([1.0, 1.0, 1.0], [2.0, 2.0, 5.0])];
    let once = solid(&union(parts));
    let far = block([9.0; 3], [10.0; 3]);
    assert_eq!(volume(&solid(&union(vec![leaf(once.clone())]))), 7.0);
    assert_eq!(volume(&solid(&union(vec![leaf(once.clone()), far]))), 8.0);
    let cut = block([-1.0, 0.5, 2.0], [3.0, 1.5, 4.0]);
    assert_eq!(volume(&solid(&less(vec![leaf(once), cut]))), 7.0 - 0.5 - 1.0);
}

#[test]
fn a_box_that_stands_on_its_edge_is_a_leaf_again() {
    let prism = leaf(prism(
        &[DVec2::new(2.0, 1.0), DVec2::new(3.0, 2.0), DVec2::new(1.0, 2.0)],
        1.0,
        2.0,
        Surface::Plane,
    ));
    let floor = block([0.0; 3], [4.0, 1.0, 3.0]);
    let once = union(vec![floor, prism]);
    check(once.clone(), 13.0, 20, 4);
    let once = leaf(solid(&once));
    let cut = block([1.5, 0.5, -1.0], [2.0, 3.0, 5.0]);
    let both = solid(&less(vec![once, cut]));
    assert!((volume(&both) - (13.0 - 0.75 - 0.375)).abs() < 1e-12);
}

#[test]
fn the_same_tree_gives_the_same_mesh() {
    let rod = leaf(cylinder([2.0, 2.0], 1.3, -1.0, 3.0, 17));
    let tree = less(vec![block([0.0; 3], [4.0, 4.0, 2.0]), turned([5.0, 0.0, 0.0], rod)]);
    let (once, twice) = (solid(&tree), solid(&tree));
    assert_eq!(once, twice);
    assert!(!once.is_empty());
}

#[test]
fn faces_keep_their_origin() {
    let rod = leaf(cylinder([2.0, 2.0], 1.0, -1.0, 3.0, 16));
    let drilled = solid(&moved([5.0, 0.0, 0.0], less(vec![block([0.0; 3], [4.0, 4.0, 2.0]), rod])));
    let on_rod = |f: &katachi::geom::FaceRef<'_>| match f.origin().surface {
        Surface::Cylinder { point, radius, .. } => radius == 1.0 && point.x == 7.0,
        _ => false,
    };
    assert_eq!(drilled.mesh().faces().filter(on_rod).count(), 16);
    assert_eq!(drilled.mesh().face_count(), 16 + 6);
}
