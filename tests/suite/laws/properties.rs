//! Laws that hold for all solids, tried on random construction trees.

use glam::DVec3;
use katachi::{
    geom::Placement,
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
fn volumes_add_up() {
    try_all(|seed| {
        let (a, b) = pair(seed);
        let both = vec![a.clone(), b.clone()];
        let union = result(&Tree::Union(both.clone()));
        let back = result(&Tree::Union(vec![b.clone(), a.clone()]));
        let common = result(&Tree::Intersection(both.clone()));
        let rest = result(&Tree::Difference(both));
        let none = result(&Tree::Difference(vec![a.clone(), a.clone()]));
        let (a, b) = (result(&a), result(&b));
        let v = |e: &Evaluated| volume(&e.solid);
        let off = v(&a) + v(&b) - v(&union) - v(&common);
        assert!(off.abs() <= slack(&[&a, &b, &union, &common]), "seed {seed}: union off by {off}");
        let off = v(&a) - v(&common) - v(&rest);
        assert!(off.abs() <= slack(&[&a, &rest, &common]), "seed {seed}: difference off by {off}");
        let off = v(&union) - v(&back);
        assert!(off.abs() <= slack(&[&union, &back]), "seed {seed}: order changes {off}");
        assert!(none.solid.is_empty(), "seed {seed}: A - A");
    });
}

#[test]
fn a_rotation_changes_neither_volume_nor_triangles() {
    try_all(|seed| {
        let (a, b) = pair(seed);
        let upright = Tree::Difference(vec![a, b]);
        let there = result(&upright).solid;
        let turned = result(&turned([17.0, 23.0, 41.0], upright)).solid;
        let off = volume(&there) - volume(&turned);
        assert!(off.abs() <= 1e-9 * (1.0 + volume(&there)), "seed {seed}: off by {off}");
        assert_eq!(there.mesh().triangle_count(), turned.mesh().triangle_count(), "seed {seed}");
    });
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

/// The winding number of a solid around a point, by solid angles of fans.
fn winding(solid: &Polyhedron, point: DVec3) -> f64 {
    let mesh = solid.mesh();
    let mut sum = 0.0;
    for corners in mesh.faces().flat_map(|f| f.loops()) {
        let arm = |i: usize| mesh.points[corners[i] as usize] - point;
        for i in 1..corners.len() - 1 {
            let (a, b, c) = (arm(0), arm(i), arm(i + 1));
            let (p, q, r) = (a.length(), b.length(), c.length());
            let below = p * q * r + a.dot(b) * r + b.dot(c) * p + c.dot(a) * q;
            sum += 2.0 * libm::atan2(a.dot(b.cross(c)), below);
        }
    }
    sum / (4.0 * std::f64::consts::PI)
}

#[test]
fn points_inside_are_those_the_tree_holds() {
    try_all(|seed| {
        let (a, b) = pair(seed);
        let tree = Tree::Union(vec![a, b]);
        let solid = result(&tree).solid;
        let mut random = Random(seed ^ 0xabcd);
        for _ in 0..20 {
            let point = DVec3::from_array([(); 3].map(|()| random.unit() * 10.0 - 1.0));
            if let Some(expected) = holds(&tree, point) {
                let found = winding(&solid, point);
                let off = (found - f64::from(u8::from(expected))).abs();
                assert!(off < 1e-6, "seed {seed}: {point} winds {found}, expected {expected}");
            }
        }
    });
}

#[test]
fn results_are_leaves_again() {
    try_all(|seed| {
        let (a, b) = pair(seed);
        let (first, second) = (result(&a).solid, result(&b).solid);
        let once = result(&Tree::Difference(vec![a, b]));
        let twice = result(&Tree::Difference(vec![leaf(first.clone()), leaf(second)]));
        let again = Tree::Placed(Placement::IDENTITY, Box::new(leaf(once.solid.clone())));
        let off = volume(&once.solid) - volume(&twice.solid);
        assert!(off.abs() <= slack(&[&once, &twice]), "seed {seed}: off by {off}");
        let none = result(&Tree::Difference(vec![again.clone(), again]));
        assert!(none.solid.is_empty(), "seed {seed}");
    });
}
