//! Ten thousand wild trees: spheres, faces that nearly coincide, deep nestings. Nothing panics, every result
//! is sound, the laws hold, and volumes are those of rational arithmetic.

use glam::dvec3;
use katachi::kernel::brep::{
    boolean::{Evaluated, Tree, evaluate},
    primitive::sphere,
};

use super::{oracle, random::Random, solids::*, soundness};

/// How a wild tree is made.
struct Wild {
    random: Random,
    /// How far faces that nearly coincide are apart, mm; 0 if they coincide.
    gap: f64,
    turned: bool,
}

/// The largest coordinate, mm.
const SIZE: u64 = 5;

impl Wild {
    fn new(seed: u64) -> Wild {
        let mut random = Random(seed ^ 0x5eed_0f71_1d00_0000);
        let exponent = [0, 3, 4, 5, 6, 7, 8, 9][random.below(8) as usize];
        let gap = if exponent == 0 { 0.0 } else { SIZE as f64 * 0.1f64.powi(exponent) };
        Wild { gap, turned: random.below(3) == 0, random }
    }

    /// A whole number, give or take a gap.
    fn coordinate(&mut self, low: u64) -> f64 {
        let whole = (low + self.random.below(SIZE - low)) as f64;
        whole + (self.random.below(3) as f64 - 1.0) * self.gap
    }

    fn leaf(&mut self) -> Tree {
        let [x, y, z] = [(); 3].map(|()| self.coordinate(1));
        let solid = match self.random.below(6) {
            0..3 => cuboid([0.0; 3], [x, y, z]),
            3 => cylinder(
                [x / 2.0, y / 2.0],
                x / 2.0,
                0.0,
                z,
                [3, 4, 6, 9][self.random.below(4) as usize],
            ),
            4 => sphere(x / 2.0, [4, 5, 6, 8][self.random.below(4) as usize]),
            _ => {
                let outline = [(0.0, 0.0), (x, 0.0), (x, y), (x / 2.0, y + 1.0)];
                prism(&outline.map(glam::DVec2::from), 0.0, z, katachi::geom::Surface::Plane)
            }
        };
        let place = [(); 3].map(|()| self.coordinate(0));
        let here = moved(place, leaf(solid));
        if !self.turned || self.random.below(2) == 0 {
            return here;
        }
        turned(
            [[17.0, 23.0, 41.0], [0.0, 90.0, 0.0], [0.0, 0.0, 45.0]][self.random.below(3) as usize],
            here,
        )
    }

    /// A tree with so many leaves, nested at random.
    fn tree(&mut self, leaves: u64) -> Tree {
        if leaves == 1 {
            return self.leaf();
        }
        let first = 1 + self.random.below(leaves - 1);
        let mut parts = vec![self.tree(first)];
        let mut left = leaves - first;
        while left > 0 {
            let next = 1 + self.random.below(left);
            parts.push(self.tree(next));
            left -= next;
        }
        match self.random.below(3) {
            0 => Tree::Union(parts),
            1 => Tree::Difference(parts),
            _ => Tree::Intersection(parts),
        }
    }
}

/// What a seed gives: two trees, mostly small ones, and their gap.
fn pair(seed: u64) -> ([Tree; 2], f64) {
    let mut wild = Wild::new(seed);
    let trees = [(); 2].map(|()| {
        let leaves = 1 + wild.random.below(4) * (1 + wild.random.below(3)) / 2;
        wild.tree(leaves)
    });
    (trees, wild.gap)
}

/// What a fault begins with that the result itself states.
const STATED: &str = "stated";

/// A result that is sound.
fn result(tree: &Tree) -> Result<Evaluated, String> {
    let found = evaluate(tree).map_err(|e| e.to_string())?;
    match (soundness::fault(&found.solid), found.crossing) {
        (None, None) => Ok(found),
        (Some(fault), None) => Err(fault),
        (fault, Some(place)) => Err(format!("{STATED} at {place}: {fault:?}")),
    }
}

/// How far the volume of a tree may be off whose leaves have so much area together: corners move by half a
/// step or to where snapped faces meet, which the angles of the leaves keep within a few steps.
fn slack(area: f64, found: &Evaluated) -> f64 {
    4.0 * area * (found.snap + found.step) + 1e-12 * area
}

/// The laws for two trees; what is wrong, if anything.
fn laws([a, b]: &[Tree; 2], gap: f64) -> Result<(), String> {
    let both = || vec![a.clone(), b.clone()];
    let [union, common, less] =
        [Tree::Union(both()), Tree::Intersection(both()), Tree::Difference(both())];
    let (va, area_a) = oracle::volume_and_area(a);
    let (vb, area_b) = oracle::volume_and_area(b);
    let vu = oracle::volume_and_area(&union).0;
    let area = area_a + area_b;
    let expected = [(a, va), (b, vb), (&union, vu), (&common, va + vb - vu), (&less, vu - vb)];
    for (i, (tree, expected)) in expected.into_iter().enumerate() {
        let found = result(tree).map_err(|e| format!("result {i}: {e}"))?;
        let off = volume(&found.solid) - expected;
        if off.abs() > slack(area, &found) {
            return Err(format!("result {i}: volume off by {off}, expected {expected}"));
        }
    }
    let none = result(&Tree::Difference(vec![less.clone(), less]))?;
    if !none.solid.is_empty() {
        return Err("A - A is not empty".to_string());
    }
    turning_changes_nothing(&union, gap)
}

/// Faces that are no more steps of the lattice apart may be rounded into one, here but not there: corners move by
/// half a step along each axis.
const STEPS: f64 = 2.0;

fn turning_changes_nothing(tree: &Tree, gap: f64) -> Result<(), String> {
    let upright = result(tree)?;
    let there = result(&turned([17.0, 23.0, 41.0], tree.clone()));
    let there = there.map_err(|e| format!("turned: {e}"))?;
    let off = volume(&upright.solid) - volume(&there.solid);
    let counts = [&upright, &there].map(|e| e.solid.mesh().triangle_count());
    let fine = gap == 0.0 || gap > STEPS * upright.step.max(there.step);
    let same = match fine {
        true => counts[0] == counts[1] && off.abs() <= 1e-9 * (1.0 + volume(&upright.solid)),
        false => off.abs() <= slack(area(&upright.solid), &there),
    };
    if same { Ok(()) } else { Err(format!("turned: volume off by {off}, triangles {counts:?}")) }
}

/// Tries seeds on both processors; everything that is wrong with any.
fn faults(seeds: Vec<u64>) -> Vec<String> {
    use rayon::prelude::*;
    let tried = seeds.into_par_iter().map(|seed| {
        let (pair, gap) = pair(seed);
        let found = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| laws(&pair, gap)));
        let found = found.unwrap_or_else(|_| Err("panics".to_string()));
        found.err().map(|fault| format!("seed {seed}: {fault}"))
    });
    tried.flatten().collect()
}

#[test]
fn wild_trees_are_sound_and_have_their_volume() {
    let faults = faults((0..100).collect());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
#[ignore = "takes minutes; `.ci/run` runs it"]
fn ten_thousand_wild_trees() {
    let found = faults((100..10_100).collect());
    assert!(found.is_empty(), "{} of them:\n{}", found.len(), found.join("\n"));
}

/// A ball with whole coordinates whose faces are near those of another.
#[test]
fn nearly_equal_spheres() {
    let ball = |r: f64| leaf(sphere(r, 6));
    for exponent in 3..=9 {
        let gap = 0.1f64.powi(exponent);
        for by in [[gap, 0.0, 0.0], [gap, gap / 3.0, -gap]] {
            for parts in [vec![ball(1.0), moved(by, ball(1.0))], vec![ball(1.0), ball(1.0 - gap)]] {
                for tree in [
                    Tree::Union(parts.clone()),
                    Tree::Difference(parts.clone()),
                    Tree::Intersection(parts),
                ] {
                    let (exact, area) = oracle::volume_and_area(&tree);
                    let found = result(&tree).unwrap_or_else(|e| panic!("gap {gap}: {e}"));
                    let off = volume(&found.solid) - exact;
                    assert!(off.abs() <= slack(area, &found), "gap {gap}: off by {off}");
                }
            }
        }
    }
    assert!(evaluate(&Tree::Union(vec![ball(1.0), moved([0.0; 3], ball(1.0))])).is_ok_and(|e| {
        e.solid.mesh().points.iter().all(|p| p.distance(dvec3(0.0, 0.0, 0.0)) < 1.001)
    }));
}
