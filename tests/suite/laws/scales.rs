//! Operands of very different sizes, far apart, and far from the origin.

use glam::DVec3;
use katachi::kernel::brep::{
    boolean::{Evaluated, Tree, evaluate},
    primitive::sphere,
};

use super::{oracle, solids::*, soundness};

fn result(tree: &Tree) -> Evaluated {
    let found = evaluate(tree).expect("a result");
    assert_eq!(soundness::fault(&found.solid), None);
    found
}

#[test]
fn an_operand_far_away_coarsens_nothing() {
    let speck = || block([0.0; 3], [0.0033, 0.000_003_3, 0.0033]);
    let far = || moved([0.0, 1e5, 0.0], block([0.0; 3], [1.0; 3]));
    let corner = || block([-1.0; 3], [0.001, 0.001, 0.001]);
    let exact = 0.0033 * 0.000_003_3 * 0.0033;
    let less = Tree::Difference(vec![speck(), far()]);
    for tree in [less.clone(), turned([17.0, 23.0, 41.0], less)] {
        let found = volume(&result(&tree).solid);
        assert!((found - exact).abs() < 1e-6 * exact, "{found}, expected {exact}");
    }
    let both = || Tree::Union(vec![speck(), far()]);
    assert_eq!(result(&both()).solid.mesh().triangle_count(), 24);
    let cut = result(&Tree::Difference(vec![both(), corner(), far()]));
    let (found, exact) = (volume(&cut.solid), exact - 0.001 * 0.000_003_3 * 0.001);
    assert!((found - exact).abs() < 1e-6 * exact, "{found}, expected {exact}");
}

#[test]
fn what_is_not_near_stays_as_it_was() {
    let ball = sphere(1.0, 12);
    let apart = Tree::Union(vec![leaf(ball.clone()), moved([3.0, 0.0, 0.0], leaf(ball.clone()))]);
    let found = result(&apart);
    assert_eq!(found.snap, 0.0);
    assert_eq!(found.solid.mesh().points[..ball.mesh().points.len()], ball.mesh().points);
    let nothing = Tree::Intersection(vec![leaf(ball.clone()), moved([3.0, 0.0, 0.0], leaf(ball))]);
    assert!(result(&nothing).solid.is_empty());
}

/// A millionth of the size, and still a ball: as many triangles as at full size, and its volume.
#[test]
fn a_small_part_of_a_large_one_keeps_its_shape() {
    let large = || block([-500.0; 3], [500.0; 3]);
    let bead = |r: f64| moved([10.0, 20.0, 500.0], leaf(sphere(r, 12)));
    let common = |r: f64| Tree::Intersection(vec![large(), bead(r)]);
    let (small, ordinary) = (result(&common(0.001)), result(&common(100.0)));
    let counts = [&small, &ordinary].map(|e| e.solid.mesh().triangle_count());
    assert_eq!(counts[0], counts[1]);
    let ratio = volume(&small.solid) * 1e15 / volume(&ordinary.solid);
    assert!((ratio - 1.0).abs() < 1e-2, "{ratio}");
    let dented = result(&Tree::Difference(vec![large(), bead(0.001)]));
    let bumped = result(&Tree::Union(vec![large(), bead(0.001)]));
    assert_eq!(dented.solid.mesh().triangle_count(), bumped.solid.mesh().triangle_count());
}

#[test]
fn small_features_far_from_the_origin() {
    for reach in [1e3, 1e5, 1e6] {
        let at = [reach, -reach, reach / 3.0];
        let size = 1e-3;
        let (a, b) = (
            block([0.0; 3], [4.0 * size; 3]),
            block([size; 3], [3.0 * size, 5.0 * size, 2.0 * size]),
        );
        let ball = scaled(size, leaf(sphere(2.0, 12)));
        for parts in [vec![a.clone(), b], vec![a, ball]] {
            for operation in [Tree::Union, Tree::Difference, Tree::Intersection] {
                // Written near the origin and moved as a whole: nothing is lost.
                let tree = operation(parts.clone());
                let found = [result(&tree), result(&moved(at, tree.clone()))];
                let [near, far] = found.each_ref().map(|e| e.solid.mesh().triangle_count());
                assert_eq!(near, far);
                // Every part far out: what doubles can say there.
                let tree = operation(parts.iter().map(|p| moved(at, p.clone())).collect());
                let (exact, area) = oracle::volume_and_area(&tree);
                let off = volume(&result(&tree).solid) - exact;
                let ulp = f64::EPSILON * reach;
                assert!(off.abs() <= 16.0 * area * ulp, "{reach}: off by {off} of {exact}");
            }
        }
    }
}

/// Distances between clusters that only rounding makes are closed as before.
#[test]
fn rounding_keeps_nothing_apart() {
    let third = 0.1 + 0.2;
    let pair =
        Tree::Union(vec![block([0.0; 3], [0.3; 3]), block([third, 0.0, 0.0], [1.0, 0.3, 0.3])]);
    assert_eq!(result(&pair).solid.mesh().triangle_count(), 12);
    let far = DVec3::splat(1e6).to_array();
    assert_eq!(result(&moved(far, pair)).solid.mesh().triangle_count(), 12);
}

/// A slab of 1e-12 mm at 200 m, where coordinates are 3e-11 mm apart, has no inside left, and says so.
#[test]
fn what_coordinates_cannot_hold_is_stated() {
    let [thick, less] = [1.000_001, 1.0].map(|top| block([0.0; 3], [1.0, 1.0, top]));
    let slab = scaled(1e-6, Tree::Difference(vec![thick, less]));
    let says_so = |tree: Tree| evaluate(&tree).expect("a result").crossing.is_some();
    for slab in [slab.clone(), turned([17.0, 23.0, 41.0], slab)] {
        let at = |z: f64, tree: &Tree| moved([0.0, 0.0, z], tree.clone());
        assert!(!says_so(slab.clone()));
        assert!(!says_so(at(1.0, &slab)));
        assert!(says_so(at(2e5, &slab)));
        let cube = at(3e5, &block([0.0; 3], [1.0; 3]));
        assert!(!says_so(cube.clone()));
        assert!(says_so(Tree::Union(vec![at(2e5, &slab), cube])));
    }
}
