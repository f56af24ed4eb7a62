use glam::dvec3;

use super::*;

/// Points of a small generator, on a lattice of so many steps.
fn scattered(count: u32, steps: u64) -> Vec<DVec3> {
    let mut state = 7u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((state >> 33) % steps) as f64 * 1024.0
    };
    let mut points: Vec<DVec3> = (0..count).map(|_| dvec3(next(), next(), next())).collect();
    points.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).expect("finite"));
    points.dedup();
    points
}

/// Neighbours agree, volumes are positive and fill the hull, no sphere holds the corner across a face.
fn check(delaunay: &Delaunay) -> f64 {
    let mut volume = 0.0;
    for t in delaunay.tetrahedra() {
        let corners = delaunay.corners(t);
        for corner in 0..4 {
            let here = side(t, corner);
            let there = delaunay.across(here);
            assert_eq!(delaunay.across(there), here);
            let [mut one, mut other] = [delaunay.face(here), delaunay.face(there)];
            one.sort_unstable();
            other.sort_unstable();
            assert_eq!(one, other);
        }
        if delaunay.is_ghost(t) {
            continue;
        }
        let [a, b, c, d] = corners;
        assert_eq!(delaunay.sign([a, b, c], d), 1);
        let p = corners.map(|i| delaunay.points[i as usize]);
        volume += (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
        for corner in 0..4 {
            let there = delaunay.across(side(t, corner));
            let (beyond, opposite) = of_side(there);
            let apex = delaunay.corners(beyond)[opposite];
            assert!(apex == GHOST || !delaunay.in_sphere(corners, apex));
        }
    }
    volume / 6.0
}

#[test]
fn scattered_points_fill_their_hull() {
    let delaunay = Delaunay::new(scattered(2000, 1 << 29)).expect("a volume");
    check(&delaunay);
    assert!(delaunay.at.iter().all(|&t| t != NOTHING));
}

#[test]
fn points_of_a_grid_fill_the_cube() {
    // Every sphere has eight points and more on it.
    let delaunay = Delaunay::new(scattered(3000, 8)).expect("a volume");
    assert_eq!(delaunay.points.len(), 512);
    let expected = 7.0f64.powi(3) * 1024f64.powi(3);
    assert_eq!(check(&delaunay), expected);
}

#[test]
fn points_in_a_plane_span_nothing() {
    let flat = scattered(50, 100).into_iter().map(|p| dvec3(p.x, p.y, p.x + p.y)).collect();
    assert!(Delaunay::new(flat).is_none());
}

#[test]
fn stars_and_edges_are_closed() {
    let mut delaunay = Delaunay::new(scattered(300, 1 << 20)).expect("a volume");
    let star = delaunay.star(17);
    for &t in &star {
        let corners = delaunay.corners(t);
        let other = corners.into_iter().find(|&c| c != 17).expect("another");
        let around = delaunay.around(t, [17, other]);
        assert!(around.len() >= 3 && around.iter().all(|t| star.contains(t)));
        assert_eq!(
            around.len(),
            star.iter().filter(|&&t| delaunay.corners(t).contains(&other)).count()
        );
    }
}
