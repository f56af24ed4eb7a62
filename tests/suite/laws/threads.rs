//! The same bytes, however many threads work.

use glam::{DMat3, DQuat, DVec3, dvec3};
use katachi::{
    geom::Placement,
    kernel::brep::{
        Polyhedron,
        boolean::{Tree, evaluate},
        primitive::sphere,
    },
};

use super::{
    random::{Random, style, tree},
    solids::*,
};

/// The results of some trees on so many threads.
fn results(threads: usize, trees: &[Tree]) -> Vec<Polyhedron> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| trees.iter().map(|t| evaluate(t).expect("a result").solid).collect())
}

#[track_caller]
fn same_on_any_threads(trees: &[Tree]) {
    let [one, two, many] = [1, 2, 5].map(|threads| results(threads, trees));
    for (number, single) in one.iter().enumerate() {
        for other in [&two[number], &many[number]] {
            let bits = |s: &Polyhedron| {
                let points = s.mesh().points.iter().flat_map(|p| p.to_array());
                points.map(f64::to_bits).collect::<Vec<u64>>()
            };
            assert_eq!(bits(single), bits(other), "tree {number}");
            assert_eq!(single, other, "tree {number}");
        }
    }
}

#[test]
fn random_trees() {
    let random = |seed: u64| tree(&mut Random(seed), &style(seed), 3);
    same_on_any_threads(&(0..60).map(random).collect::<Vec<Tree>>());
}

/// The models that are timed against other kernels, smaller: whole patches, stages, holes and clusters.
#[test]
fn the_models_of_the_benchmark() {
    let mut random = Random(11);
    let mut place = |reach: f64| {
        let [a, b, c, d, x, y, z] = [(); 7].map(|()| 2.0 * random.unit() - 1.0);
        let turn = DQuat::from_xyzw(a, b, c, d + 1.01).normalize();
        Placement::new(DMat3::from_quat(turn), dvec3(x, y, z) * reach)
    };
    let placed = |placement: Placement, part: Tree| Tree::Placed(placement, Box::new(part));
    let ball = |sides: u32| leaf(sphere(1.0, sides));
    let spheres = Tree::Difference(vec![ball(64), moved([0.5, 0.3, 0.2], ball(64))]);
    let bar = || block([-5.0, -3.0, -2.0], [5.0, 3.0, 2.0]);
    let tumbled = Tree::Union((0..25).map(|_| placed(place(8.0), bar())).collect());
    let hole = |i: u32| {
        let at = [i % 10, i / 10].map(|c| f64::from(c) * 10.0);
        leaf(cylinder(at, 4.0, -10.0, 10.0, 32))
    };
    let plate = block([-9.0, -9.0, -2.0], [99.0, 99.0, 2.0]);
    let plate = Tree::Difference(std::iter::once(plate).chain((0..100).map(hole)).collect());
    let chain = (1..30).fold(ball(24), |tree, i| {
        let by = Placement::translation(place(1.2).point(DVec3::ZERO));
        let pair = vec![tree, placed(by, ball(24))];
        if i % 2 == 0 { Tree::Union(pair) } else { Tree::Difference(pair) }
    });
    let apart = (0..20).map(|i| moved([4.0 * f64::from(i), 0.0, 0.0], spheres.clone()));
    let apart = Tree::Union(apart.collect());
    same_on_any_threads(&[spheres, tumbled, plate, chain, apart]);
}
