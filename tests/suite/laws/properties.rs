//! Laws that hold for all solids, tried on random construction trees.

use glam::DVec3;
use katachi::{
    geom::{
        parity::is_below,
        spherical_projection::{Projection, inside},
        triangulate::triangulate,
    },
    kernel::brep::{
        Polyhedron,
        boolean::{Evaluated, Tree, evaluate},
    },
};

use super::{
    random::{Random, style, tree},
    solids::*,
};

/// The trees that are tried.
const SEEDS: std::ops::Range<u64> = 0..2000;

/// Trees are tried on this many threads.
const THREADS: u64 = 2;

fn try_all(check: impl Fn(u64) + Sync) {
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..THREADS)
            .map(|first| {
                let check = &check;
                scope.spawn(move || {
                    for seed in SEEDS.filter(|s| s % THREADS == first) {
                        let result =
                            std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| check(seed)));
                        assert!(result.is_ok(), "seed {seed}");
                    }
                })
            })
            .collect();
        for worker in workers {
            assert!(worker.join().is_ok());
        }
    });
}

fn result(tree: &Tree) -> Evaluated {
    evaluate(tree).expect("a result")
}

/// Two trees of one seed.
fn pair(seed: u64) -> (Tree, Tree) {
    let (style, mut random) = (style(seed), Random(seed));
    let mut part = || {
        let levels = 1 + u32::from(random.below(3) == 0);
        tree(&mut random, &style, levels)
    };
    (part(), part())
}

/// How far a volume may be off: corners move by the snap distance.
fn slack(parts: &[&Evaluated]) -> f64 {
    let snapped = parts.iter().map(|e| area(&e.solid) * (e.snap + e.step)).sum::<f64>();
    let rounded = parts.iter().map(|e| volume(&e.solid).abs()).sum::<f64>() * 1e-9;
    4.0 * snapped + rounded + 1e-9
}

#[test]
fn the_laws_hold() {
    try_all(|seed| {
        let (a, b) = pair(seed);
        let both = vec![a.clone(), b.clone()];
        let union = Tree::Union(both.clone());
        let difference = Tree::Difference(both.clone());
        let there = result(&union);
        volumes_add_up(seed, (&a, &b), &there);
        rotation_changes_nothing(seed, &difference);
        points_inside_are_those_the_tree_holds(seed, &union, &there.solid);
        if seed.is_multiple_of(4) {
            results_are_leaves_again(seed, (&a, &b), &difference);
        }
        let none = result(&Tree::Difference(vec![a.clone(), a]));
        assert!(none.solid.is_empty(), "seed {seed}: A - A");
    });
}

fn volumes_add_up(seed: u64, (a, b): (&Tree, &Tree), union: &Evaluated) {
    let back = result(&Tree::Union(vec![b.clone(), a.clone()]));
    let common = result(&Tree::Intersection(vec![a.clone(), b.clone()]));
    let rest = result(&Tree::Difference(vec![a.clone(), b.clone()]));
    let (a, b) = (result(a), result(b));
    let v = |e: &Evaluated| volume(&e.solid);
    let off = v(&a) + v(&b) - v(union) - v(&common);
    assert!(off.abs() <= slack(&[&a, &b, union, &common]), "seed {seed}: union off by {off}");
    let off = v(&a) - v(&common) - v(&rest);
    assert!(off.abs() <= slack(&[&a, &rest, &common]), "seed {seed}: difference off by {off}");
    let off = v(union) - v(&back);
    assert!(off.abs() <= slack(&[union, &back]), "seed {seed}: order changes {off}");
}

fn rotation_changes_nothing(seed: u64, upright: &Tree) {
    let there = result(upright).solid;
    let turned = result(&turned([17.0, 23.0, 41.0], upright.clone())).solid;
    let off = volume(&there) - volume(&turned);
    assert!(off.abs() <= 1e-9 * (1.0 + volume(&there)), "seed {seed}: off by {off}");
    assert_eq!(there.mesh().triangle_count(), turned.mesh().triangle_count(), "seed {seed}");
}

/// How near a point may be to a face of a leaf and still be asked about, mm.
const CLEAR: f64 = 1e-5;

/// Whether a tree holds a point, by the half-spaces of its convex leaves; `None` near a face.
fn holds(tree: &Tree, point: DVec3) -> Option<bool> {
    let all = |parts: &[Tree]| parts.iter().map(|p| holds(p, point)).collect::<Option<Vec<_>>>();
    Some(match tree {
        Tree::Leaf(solid) => {
            let mesh = solid.mesh();
            let heights = mesh.faces().map(|f| {
                f.area_vector().normalize().dot(point - mesh.points[f.outer()[0] as usize])
            });
            let highest = heights.fold(f64::NEG_INFINITY, f64::max);
            if highest.abs() < CLEAR {
                return None;
            }
            highest < 0.0
        }
        Tree::Placed(placement, inner) => {
            holds(inner, placement.inverse().expect("a rigid motion").point(point))?
        }
        Tree::Union(parts) => all(parts)?.contains(&true),
        Tree::Intersection(parts) => !all(parts)?.contains(&false),
        Tree::Difference(parts) => {
            let parts = all(parts)?;
            parts[0] && !parts[1..].contains(&true)
        }
    })
}

/// Whether an odd number of triangles lies above a point, exactly.
fn parity(triangles: &[[DVec3; 3]], point: DVec3) -> bool {
    triangles.iter().filter(|t| is_below(point, **t)).count() % 2 == 1
}

fn points_inside_are_those_the_tree_holds(seed: u64, tree: &Tree, solid: &Polyhedron) {
    let mesh = solid.mesh();
    let corners = triangulate(mesh).corners;
    let triangles: Vec<_> = corners.iter().map(|t| t.map(|i| mesh.points[i as usize])).collect();
    let projection = Projection::new(mesh);
    let mut random = Random(seed ^ 0xabcd);
    for _ in 0..20 {
        let point = DVec3::from_array([(); 3].map(|()| random.unit() * 10.0 - 1.0));
        if let Some(expected) = holds(tree, point) {
            assert_eq!(inside(mesh, point), expected, "seed {seed}: projection at {point}");
            assert_eq!(projection.inside(point), expected, "seed {seed}: expansion at {point}");
            assert_eq!(parity(&triangles, point), expected, "seed {seed}: ray at {point}");
        }
    }
}

fn results_are_leaves_again(seed: u64, (a, b): (&Tree, &Tree), difference: &Tree) {
    let (first, second) = (result(a).solid, result(b).solid);
    let once = result(difference);
    let twice = result(&Tree::Difference(vec![leaf(first), leaf(second)]));
    let off = volume(&once.solid) - volume(&twice.solid);
    assert!(off.abs() <= slack(&[&once, &twice]), "seed {seed}: off by {off}");
    let none = result(&Tree::Difference(vec![leaf(once.solid.clone()), leaf(once.solid)]));
    assert!(none.solid.is_empty(), "seed {seed}");
}
