use std::collections::BTreeMap;

use glam::dvec3;

use super::*;
use crate::geom::trig::unit_circle;

/// Triangulates loops in the plane z = 0.
fn flat(points: &[[f64; 2]], loops: &[&[u32]]) -> Vec<[u32; 3]> {
    let points: Vec<DVec3> = points.iter().map(|&[x, y]| dvec3(x, y, 0.0)).collect();
    let mut out = vec![];
    triangulate_face(&points, loops, &mut out);
    out
}

/// Inner edges must cancel and what is left must be the loops.
fn assert_closed(triangles: &[[u32; 3]], loops: &[&[u32]]) {
    let mut count = BTreeMap::new();
    for t in triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *count.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
        }
    }
    for corners in loops {
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            *count.entry((a.min(b), a.max(b))).or_insert(0) -= if a < b { 1 } else { -1 };
        }
    }
    assert!(count.values().all(|&n| n == 0), "{count:?}");
}

fn assert_upright(points: &[[f64; 2]], triangles: &[[u32; 3]]) {
    for t in triangles {
        let [a, b, c] = t.map(|k| DVec2::from(points[k as usize]));
        assert!(orient2d(a, b, c) > 0.0, "{t:?}");
    }
}

fn area(points: &[[f64; 2]], triangles: &[[u32; 3]]) -> f64 {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|k| DVec2::from(points[k as usize]));
        (b - a).perp_dot(c - a) / 2.0
    };
    triangles.iter().map(area).sum()
}

#[track_caller]
fn check(points: &[[f64; 2]], loops: &[&[u32]], expected: usize) {
    let triangles = flat(points, loops);
    assert_eq!(triangles.len(), expected);
    assert_closed(&triangles, loops);
    assert_upright(points, &triangles);
}

#[test]
fn simple_polygons() {
    check(&[[0., 0.], [1., 0.], [1., 1.], [0., 1.]], &[&[0, 1, 2, 3]], 2);
    check(&[[0., 0.], [4., 0.], [1., 1.], [0., 4.]], &[&[0, 1, 2, 3]], 2);
    let comb =
        [[0., 0.], [6., 0.], [6., 3.], [5., 1.], [4., 3.], [3., 1.], [2., 3.], [1., 1.], [0., 3.]];
    check(&comb, &[&[0, 1, 2, 3, 4, 5, 6, 7, 8]], 7);
}

#[test]
fn collinear_corners_are_all_used() {
    let points = [[0., 0.], [1., 0.], [2., 0.], [2., 1.], [2., 2.], [1., 2.], [0., 2.], [0., 1.]];
    check(&points, &[&[0, 1, 2, 3, 4, 5, 6, 7]], 6);
    let bar = [[0., 0.], [1., 0.], [2., 0.], [3., 0.], [3., 1.]];
    check(&bar, &[&[0, 1, 2, 3, 4]], 3);
}

#[test]
fn holes() {
    let mut points = vec![[0., 0.], [9., 0.], [9., 9.], [0., 9.]];
    points.extend([[3., 3.], [3., 6.], [6., 6.], [6., 3.]]);
    check(&points, &[&[0, 1, 2, 3], &[4, 5, 6, 7]], 8);
}

#[test]
fn a_hole_that_touches_the_outside_in_a_shared_corner() {
    let points = [[0., 0.], [9., 0.], [9., 9.], [0., 9.], [0., 4.], [3., 6.], [3., 3.]];
    check(&points, &[&[0, 1, 2, 3, 4], &[4, 5, 6]], 6);
    let points = [[0., 0.], [9., 0.], [9., 4.], [9., 9.], [0., 9.], [6., 3.], [6., 6.]];
    check(&points, &[&[0, 1, 2, 3, 4], &[2, 5, 6]], 6);
    // One loop that visits the corner twice.
    check(&points, &[&[0, 1, 2, 5, 6, 2, 3, 4]], 6);
}

#[test]
fn coincident_corners_cost_two_triangles_without_area() {
    let points = [[0., 0.], [9., 0.], [9., 9.], [0., 9.], [0., 4.], [0., 4.], [3., 6.], [3., 3.]];
    let loops: &[&[u32]] = &[&[0, 1, 2, 3, 4], &[5, 6, 7]];
    let triangles = flat(&points, loops);
    assert_eq!(triangles.len(), 8);
    assert_closed(&triangles, loops);
    let solid = triangles.iter().filter(|t| !(t.contains(&4) && t.contains(&5))).count();
    assert_eq!(solid, 6);
    assert_eq!(area(&points, &triangles), 81.0 - 4.5);
}

#[test]
fn holes_that_touch_each_other() {
    let points =
        [[0., 0.], [9., 0.], [9., 9.], [0., 9.], [2., 2.], [2., 6.], [4., 4.], [6., 6.], [6., 2.]];
    check(&points, &[&[0, 1, 2, 3], &[4, 5, 6], &[6, 7, 8]], 10 + 4 - 2 - 2);
}

#[test]
fn faces_that_cross_themselves_are_still_closed() {
    let bow = [[0., 0.], [4., 4.], [4., 0.], [0., 4.], [2., 9.]];
    let loops: &[&[u32]] = &[&[0, 1, 2, 3, 4]];
    let triangles = flat(&bow, loops);
    assert_eq!(triangles.len(), 3);
    assert_closed(&triangles, loops);
    // A hole outside the outer loop, and one point over and over.
    let stray = [[0., 0.], [1., 0.], [0., 1.], [5., 5.], [6., 5.], [5., 6.]];
    let loops: &[&[u32]] = &[&[0, 1, 2], &[3, 4, 5]];
    let triangles = flat(&stray, loops);
    assert_eq!(triangles.len(), 6);
    assert_closed(&triangles, loops);
    assert_eq!(flat(&[[1., 1.]; 6], &[&[0, 1, 2, 3, 4, 5]]).len(), 4);
}

/// A tiny generator, so that the cases are the same on every machine.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

#[test]
fn random_stars_with_holes() {
    let mut seed = 7;
    for n in 3..200u32 {
        let mut points: Vec<[f64; 2]> =
            (0..n).map(|i| (unit_circle(n, i) * (2.0 + 8.0 * random(&mut seed))).into()).collect();
        let inner = 3 + n % 5;
        points.extend((0..inner).map(|i| <[f64; 2]>::from(unit_circle(inner, inner - i) * 0.9)));
        let outer: Vec<u32> = (0..n).collect();
        let hole: Vec<u32> = (n..n + inner).collect();
        if n < 8 {
            check(&points, &[&outer], n as usize - 2);
        } else {
            check(&points, &[&outer, &hole], (n + inner) as usize);
        }
    }
}

#[test]
fn random_rubbish_is_closed() {
    let mut seed = 3;
    for n in 7..120u32 {
        let grid = |s: &mut u64| (random(s) * 6.0).floor();
        let points: Vec<[f64; 2]> = (0..n).map(|_| [grid(&mut seed), grid(&mut seed)]).collect();
        let (outer, hole): (Vec<u32>, Vec<u32>) = ((0..n - 3).collect(), (n - 3..n).collect());
        let loops: &[&[u32]] = &[&outer, &hole];
        assert_closed(&flat(&points, loops), loops);
    }
}

#[test]
fn a_plate_with_a_thousand_holes() {
    let mut points = vec![[0., 0.], [400., 0.], [400., 250.], [0., 250.]];
    let mut loops: Vec<Vec<u32>> = vec![vec![0, 1, 2, 3]];
    for i in 0..1000 {
        let center = DVec2::new(f64::from(i % 40) * 10.0 + 5.0, f64::from(i / 40) * 10.0 + 5.0);
        let first = points.len() as u32;
        points.extend((0..32).map(|k| <[f64; 2]>::from(center + unit_circle(32, 32 - k) * 4.0)));
        loops.push((first..first + 32).collect());
    }
    let loops: Vec<&[u32]> = loops.iter().map(Vec::as_slice).collect();
    check(&points, &loops, 32_004 + 2000 - 2);
}

#[test]
fn thin_triangles_are_flipped_away() {
    let n = 64;
    let mut points: Vec<[f64; 2]> = (0..n).map(|i| (unit_circle(n, i) * 10.0).into()).collect();
    points.extend((0..n).map(|i| <[f64; 2]>::from(unit_circle(n, n - i) * 8.0)));
    let (outer, hole): (Vec<u32>, Vec<u32>) = ((0..n).collect(), (n..2 * n).collect());
    let triangles = flat(&points, &[&outer, &hole]);
    let longest = triangles.iter().flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
    let length = |(a, b): (u32, u32)| {
        DVec2::from(points[a as usize]).distance(DVec2::from(points[b as usize]))
    };
    assert!(longest.map(length).fold(0.0, f64::max) < 2.3);
}

#[test]
fn one_crossing_spoils_little() {
    // A plate with many holes, one corner of which strays over its neighbour.
    let mut points = vec![[0., 0.], [100., 0.], [100., 100.], [0., 100.]];
    let mut loops: Vec<Vec<u32>> = vec![vec![0, 1, 2, 3]];
    for i in 0..100 {
        let center = DVec2::new(f64::from(i % 10) * 10.0 + 5.0, f64::from(i / 10) * 10.0 + 5.0);
        let first = points.len() as u32;
        points.extend((0..16).map(|k| <[f64; 2]>::from(center + unit_circle(16, 16 - k) * 4.0)));
        loops.push((first..first + 16).collect());
    }
    points.swap(4 + 16 * 37, 5 + 16 * 37);
    let loops: Vec<&[u32]> = loops.iter().map(Vec::as_slice).collect();
    let triangles = flat(&points, &loops);
    assert_eq!(triangles.len(), 1604 + 200 - 2);
    assert_closed(&triangles, &loops);
    let upright = triangles.iter().filter(|t| {
        let [a, b, c] = t.map(|k| DVec2::from(points[k as usize]));
        orient2d(a, b, c) > 0.0
    });
    let count = upright.count();
    assert!(count > 1790, "{count}");
}
