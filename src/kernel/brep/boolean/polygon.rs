//! Polygons with lattice corners: area, flatness, triangles.

use crate::geom::predicates::{Int3, cross, minus};

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

/// A polygon cut into triangles, without new corners. It is seen along the axis its normal is
/// nearest to; holes are joined to the outer loop by bridges, then ears are cut.
///
/// Works on anything: where no ear is left (a polygon that snapping has spoilt) any corner is cut,
/// so that the triangles always have the same boundary as the loops.
pub(super) fn triangles(loops: &[Vec<u32>], at: &impl Fn(u32) -> Int3) -> Vec<[u32; 3]> {
    let loops: Vec<&[u32]> = loops.iter().map(Vec::as_slice).filter(|l| l.len() > 1).collect();
    if loops.is_empty() {
        return vec![];
    }
    let normal = area_vector(loops.iter().copied(), at);
    let axis = super::space::main_axis(normal);
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let (i, j) = if normal[axis] < 0 { (j, i) } else { (i, j) };
    let flat = |p: u32| {
        let p = at(p);
        [p[i], p[j]]
    };
    let joined = bridged(&loops, &flat);
    cut_ears(joined, &flat)
}

type Int2 = [i64; 2];

/// Positive when c lies left of the line from a to b.
fn turn(a: Int2, b: Int2, c: Int2) -> i128 {
    let d = |p: Int2, q: Int2, i: usize| i128::from(q[i] - p[i]);
    d(a, b, 0) * d(a, c, 1) - d(a, b, 1) * d(a, c, 0)
}

/// One loop that runs along the outer loop and, by bridges, along every hole.
fn bridged(loops: &[&[u32]], flat: &impl Fn(u32) -> Int2) -> Vec<u32> {
    let mut outer = loops[0].to_vec();
    let rightmost = |l: &[u32]| {
        let best = (0..l.len()).max_by_key(|&i| flat(l[i])).unwrap_or(0);
        (flat(l[best]), best)
    };
    let mut holes: Vec<_> = loops[1..].iter().map(|l| (rightmost(l), *l)).collect();
    holes.sort_by_key(|h| std::cmp::Reverse(h.0.0));
    for ((_, start), hole) in holes {
        let at = bridge_end(&outer, flat(hole[start]), flat);
        let back = outer[at];
        let around = (0..=hole.len()).map(|k| hole[(start + k) % hole.len()]);
        let insert: Vec<u32> = around.chain([back]).collect();
        outer.splice(at + 1..at + 1, insert);
    }
    outer
}

/// The place in the loop that a point can be joined to without crossing the loop: the nearest such
/// corner to the right, else any nearest one.
fn bridge_end(outer: &[u32], from: Int2, flat: &impl Fn(u32) -> Int2) -> usize {
    let distance = |p: Int2| {
        let d = [i128::from(p[0] - from[0]), i128::from(p[1] - from[1])];
        d[0] * d[0] + d[1] * d[1]
    };
    let mut order: Vec<usize> = (0..outer.len()).collect();
    order.sort_by_key(|&k| (distance(flat(outer[k])), k));
    let clear = |k: &usize| {
        let to = flat(outer[*k]);
        let n = outer.len();
        let (before, after) = (flat(outer[(*k + n - 1) % n]), flat(outer[(*k + 1) % n]));
        in_corner(before, to, after, from)
            && edges(outer).all(|(a, b)| !crosses(from, to, flat(a), flat(b)))
    };
    order.iter().copied().find(clear).unwrap_or(order[0])
}

/// Whether p lies in the interior angle at corner b of a counter-clockwise loop a, b, c.
fn in_corner(a: Int2, b: Int2, c: Int2, p: Int2) -> bool {
    if turn(a, b, c) >= 0 {
        turn(a, b, p) >= 0 && turn(b, c, p) >= 0
    } else {
        turn(a, b, p) >= 0 || turn(b, c, p) >= 0
    }
}

/// Whether the segments p q and a b cross at a point that is an end of neither, or an end of a b
/// lies inside p q.
fn crosses(p: Int2, q: Int2, a: Int2, b: Int2) -> bool {
    let inside = |c: Int2| turn(p, q, c) == 0 && c != p && c != q && between(p, q, c);
    let (s, t) = (turn(p, q, a).signum(), turn(p, q, b).signum());
    let (u, v) = (turn(a, b, p).signum(), turn(a, b, q).signum());
    (s * t < 0 && u * v < 0) || inside(a) || inside(b)
}

fn between(p: Int2, q: Int2, c: Int2) -> bool {
    (0..2).all(|i| c[i] >= p[i].min(q[i]) && c[i] <= p[i].max(q[i]))
}

fn cut_ears(mut corners: Vec<u32>, flat: &impl Fn(u32) -> Int2) -> Vec<[u32; 3]> {
    let mut found = vec![];
    let mut at = 0;
    while corners.len() > 3 {
        let n = corners.len();
        let ear = (0..n).map(|k| (at + k) % n).find(|&k| is_ear(&corners, k, flat));
        let spike = || (0..n).find(|&k| flat_corner(&corners, k, flat));
        let k = ear.or_else(spike).unwrap_or(0);
        found.push([corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]]);
        corners.remove(k);
        at = if k >= corners.len() { 0 } else { k };
    }
    if let [a, b, c] = corners[..] {
        found.push([a, b, c]);
    }
    found
}

fn flat_corner(corners: &[u32], k: usize, flat: &impl Fn(u32) -> Int2) -> bool {
    let n = corners.len();
    let [a, b, c] = [(k + n - 1) % n, k, (k + 1) % n].map(|i| flat(corners[i]));
    turn(a, b, c) == 0
}

/// Whether the corner is convex and no other corner lies in its triangle.
fn is_ear(corners: &[u32], k: usize, flat: &impl Fn(u32) -> Int2) -> bool {
    let n = corners.len();
    let [p, q, r] = [(k + n - 1) % n, k, (k + 1) % n].map(|i| corners[i]);
    let (a, b, c) = (flat(p), flat(q), flat(r));
    if turn(a, b, c) <= 0 {
        return false;
    }
    corners.iter().filter(|&&s| s != p && s != q && s != r).all(|&s| {
        let s = flat(s);
        turn(a, b, s) < 0 || turn(b, c, s) < 0 || turn(c, a, s) < 0
    })
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
