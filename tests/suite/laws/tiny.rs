//! Operands as small as the lattice: what snaps to nothing, to sheets and to needles.

use katachi::kernel::brep::boolean::{Tree, evaluate, self_union};

use super::{
    random::{Random, style, tree},
    solids::*,
};

/// A random tree shrunk to a few lattice steps, next to one of ordinary size.
fn beside(seed: u64, scale: f64) -> Tree {
    let (style, mut random) = (style(seed), Random(seed));
    let small = scaled(scale, tree(&mut random, &style, 2));
    let place = [(); 3].map(|()| random.unit() * 4.0);
    let large = tree(&mut random, &style, 1);
    let parts = vec![large, moved(place, small.clone()), small];
    if seed.is_multiple_of(2) { Tree::Union(parts) } else { Tree::Difference(parts) }
}

#[test]
fn what_collapses_still_gives_closed_solids() {
    for seed in 0..400 {
        for scale in [3e-8, 1e-7, 1e-6] {
            let found = evaluate(&beside(seed, scale));
            assert!(found.is_ok(), "seed {seed}, scale {scale}: {found:?}");
        }
    }
}

#[test]
fn a_self_overlapping_surface_becomes_the_region_it_winds_around() {
    let mut soup = cuboid([0.0; 3], [2.0; 3]).into_mesh();
    soup.append(cuboid([1.0; 3], [3.0; 3]).mesh());
    soup.append(cuboid([0.0; 3], [2.0; 3]).mesh());
    let soup = katachi::kernel::brep::Polyhedron::new(soup).expect("closed by index");
    let healed = self_union(&soup).expect("a result").solid;
    assert!((volume(&healed) - 15.0).abs() < 1e-12);
    assert_eq!(healed.mesh().triangle_count(), 36);
}

#[test]
fn a_surface_turned_inside_out_encloses_nothing() {
    let mut inside_out = cuboid([0.0; 3], [2.0; 3]).into_mesh();
    inside_out.flip();
    let solid = katachi::kernel::brep::Polyhedron::new(inside_out).expect("closed by index");
    assert!(self_union(&solid).expect("a result").solid.is_empty());
}

#[test]
fn coordinates_that_are_not_finite_are_refused() {
    let far = moved([f64::INFINITY, 0.0, 0.0], block([0.0; 3], [1.0; 3]));
    let found = evaluate(&Tree::Union(vec![far.clone(), far]));
    assert!(found.expect_err("no result").to_string().contains("not finite"));
}
