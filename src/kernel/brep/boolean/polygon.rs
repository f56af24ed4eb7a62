//! Polygons with lattice corners: area, flatness, triangles.

use glam::DVec3;

use crate::geom::{
    predicates::{Int3, cross, minus},
    triangulate::triangulate_face,
};

/// The edges of a loop, from each corner to the next.
pub(super) fn edges(corners: &[u32]) -> impl Iterator<Item = (u32, u32)> + '_ {
    let next = corners.iter().cycle().skip(1);
    corners.iter().copied().zip(next.copied())
}

/// Twice the area times the normal (Newell's sum), exactly.
pub(super) fn area_vector<'a>(
    loops: impl Iterator<Item = &'a [u32]>,
    at: &impl Fn(u32) -> Int3,
) -> [i128; 3] {
    let mut sum = [0i128; 3];
    for corners in loops {
        let base = at(corners[0]);
        for pair in corners[1..].windows(2) {
            let part = cross(minus(at(pair[0]), base), minus(at(pair[1]), base));
            (0..3).for_each(|i| sum[i] += part[i]);
        }
    }
    sum
}

/// The same of loops of lattice points.
pub(super) fn area_of(loops: &[Vec<Int3>]) -> [i128; 3] {
    let mut sum = [0i128; 3];
    for corners in loops {
        for pair in corners[1..].windows(2) {
            let part = cross(minus(pair[0], corners[0]), minus(pair[1], corners[0]));
            (0..3).for_each(|i| sum[i] += part[i]);
        }
    }
    sum
}

/// Whether all corners lie in one plane, enclose an area, and none is met twice.
pub(super) fn is_flat(loops: &[Vec<u32>], at: &impl Fn(u32) -> Int3) -> bool {
    let normal = area_vector(loops.iter().map(Vec::as_slice), at);
    if normal == [0; 3] {
        return false;
    }
    if loops.len() == 1 && loops[0].len() == 3 {
        return true;
    }
    let base = at(loops[0][0]);
    let level = |&corner: &u32| {
        let d = minus(at(corner), base);
        (0..3).map(|i| normal[i] * i128::from(d[i])).sum::<i128>() == 0
    };
    let mut corners: Vec<u32> = loops.iter().flatten().copied().collect();
    let count = corners.len();
    corners.sort_unstable();
    corners.dedup();
    corners.len() == count && corners.iter().all(level)
}

/// A polygon with four corners, convex by a good measure, cut along its shorter diagonal.
pub(super) fn quad_triangles(corners: &[u32], at: &impl Fn(u32) -> Int3) -> Option<[[u32; 3]; 2]> {
    /// Sine of the angle that a corner must have at least, squared.
    const SHARP: f64 = 1e-4;
    let &[a, b, c, d] = corners else { return None };
    let places = [a, b, c, d].map(|p| DVec3::from_array(at(p).map(|c| c as f64)));
    let normal = (places[2] - places[0]).cross(places[3] - places[1]);
    for i in 0..4 {
        let (before, after) = (places[(i + 3) % 4] - places[i], places[(i + 1) % 4] - places[i]);
        let turn = after.cross(before);
        let room = after.length_squared() * before.length_squared();
        let along = turn.dot(normal);
        if along <= 0.0 || along * along <= SHARP * room * normal.length_squared() {
            return None;
        }
    }
    let [first, second] =
        [places[2] - places[0], places[3] - places[1]].map(|diagonal| diagonal.length_squared());
    Some(if first <= second { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] })
}

/// A polygon cut into triangles, without new corners. Works on anything that snapping makes of a
/// face: the triangles always have the same boundary as the loops.
pub(super) fn triangles(loops: &[Vec<u32>], at: &impl Fn(u32) -> Int3) -> Vec<[u32; 3]> {
    let loops: Vec<&Vec<u32>> = loops.iter().filter(|l| l.len() > 2).collect();
    if loops.is_empty() {
        return vec![];
    }
    let corners: Vec<u32> = loops.iter().flat_map(|l| l.iter().copied()).collect();
    let place = |&p: &u32| DVec3::from_array(at(p).map(|c| c as f64));
    let points: Vec<DVec3> = corners.iter().map(place).collect();
    let mut start = 0;
    let numbered: Vec<Vec<u32>> = loops
        .iter()
        .map(|l| {
            let range = start..start + l.len() as u32;
            start = range.end;
            range.collect()
        })
        .collect();
    let numbered: Vec<&[u32]> = numbered.iter().map(Vec::as_slice).collect();
    let mut found = vec![];
    triangulate_face(&points, &numbered, &mut found);
    found.into_iter().map(|t| t.map(|i| corners[i as usize])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [Int3; 8] =
        [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0], [3, 3, 0], [3, 6, 0], [6, 6, 0], [6, 3, 0]];

    fn at(p: u32) -> Int3 {
        POINTS[p as usize]
    }

    #[test]
    fn a_square_with_a_hole_falls_into_eight_triangles() {
        let loops = [vec![0, 1, 2, 3], vec![4, 5, 6, 7]];
        assert!(is_flat(&loops, &at));
        assert_eq!(area_vector(loops.iter().map(Vec::as_slice), &at), [0, 0, 144]);
        let found = triangles(&loops, &at);
        assert_eq!(found.len(), 8);
        let area = |t: &[u32; 3]| area_vector([&t[..]].into_iter(), &at)[2];
        assert!(found.iter().all(|t| area(t) > 0));
        assert_eq!(found.iter().map(area).sum::<i128>(), 144);
    }

    #[test]
    fn a_loop_without_area_still_falls_into_triangles() {
        assert_eq!(triangles(&[vec![0, 1, 0, 3]], &at).len(), 2);
        assert!(!is_flat(&[vec![0, 1, 0]], &at));
    }
}
