//! Nearest points of triangles and segments.

use glam::DVec3;

/// The point of a triangle nearest to `p`.
///
/// Source: C. Ericson, *Real-Time Collision Detection*, 2005, section 5.1.5. A triangle without area is
/// taken as its edges.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::geom::nearest::on_triangle;
/// let corner = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// assert_eq!(on_triangle(corner, dvec3(0.25, 0.25, 3.0)), dvec3(0.25, 0.25, 0.0));
/// ```
pub fn on_triangle([a, b, c]: [DVec3; 3], p: DVec3) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let square = normal.length_squared();
    let within = |u: DVec3, v: DVec3| (v - u).cross(p - u).dot(normal) >= 0.0;
    if square > 0.0 && within(a, b) && within(b, c) && within(c, a) {
        return p - normal * ((p - a).dot(normal) / square);
    }
    let nearer =
        |u: DVec3, v: DVec3| if v.distance_squared(p) < u.distance_squared(p) { v } else { u };
    let candidates = [(a, b), (b, c), (c, a)].map(|(u, v)| on_segment([u, v], p));
    nearer(nearer(candidates[0], candidates[1]), candidates[2])
}

/// The point of a segment nearest to `p`.
pub fn on_segment([a, b]: [DVec3; 2], p: DVec3) -> DVec3 {
    let along = b - a;
    let t = (p - a).dot(along) / along.length_squared();
    if t >= 1.0 {
        b
    } else if t > 0.0 {
        a + along * t
    } else {
        a
    }
}

/// The nearest two points of two segments, the first on `s`.
///
/// Source: Ericson, section 5.1.9.
///
/// ```
/// use glam::dvec3;
/// use katachi::geom::nearest::of_segments;
/// let (s, t) = ([dvec3(-1., 0., 0.), dvec3(1., 0., 0.)], [dvec3(0., -1., 2.), dvec3(0., 1., 2.)]);
/// assert_eq!(of_segments(s, t), [dvec3(0., 0., 0.), dvec3(0., 0., 2.)]);
/// ```
pub fn of_segments(s: [DVec3; 2], t: [DVec3; 2]) -> [DVec3; 2] {
    let (u, v, w) = (s[1] - s[0], t[1] - t[0], s[0] - t[0]);
    let (uu, vv, uv) = (u.length_squared(), v.length_squared(), u.dot(v));
    let denominator = uu * vv - uv * uv;
    let free = (uv * v.dot(w) - vv * u.dot(w)) / denominator;
    let share = if denominator > 0.0 { free.clamp(0.0, 1.0) } else { 0.0 };
    let on_t = on_segment(t, s[0] + u * share);
    let on_s = on_segment(s, on_t);
    [on_s, on_segment(t, on_s)]
}
