//! Arcs between directions, and caps of spheres inside of arcs.

use glam::DVec3;

use crate::geom::spherical_projection::spherical_triangle;

/// Points of an arc from `a` to `b` about the origin, both included: of a circle if they are of one length,
/// of an ellipse with both on it otherwise. `count` chords of equal angles.
pub(super) fn arc(a: DVec3, b: DVec3, count: u32) -> Vec<DVec3> {
    let angle = a.angle(b);
    let weight = |part: f64| libm::sin(part * angle) / libm::sin(angle);
    (0..=count)
        .map(|i| match i {
            0 => a,
            i if i == count => b,
            i => {
                let t = f64::from(i) / f64::from(count);
                a * weight(1.0 - t) + b * weight(t)
            }
        })
        .collect()
}

/// Moves the inner points of an arc of unit radius outwards, by no more than `most`, so that its chords enclose as
/// much area as the arc: volumes come out right, and chords are nearer to the arc. With a `bulge` other than 1 they
/// move so many times as far.
///
/// With k chords over angles 2 a and inner points at the radius q, twice the area is
/// sin 2 a (2 q + (k - 2) q^2); that of the arc is 2 a k.
pub(super) fn evened(mut points: Vec<DVec3>, bulge: f64, most: f64) -> Vec<DVec3> {
    let count = points.len() - 1;
    if count < 2 {
        return points;
    }
    let (k, step) = (count as f64, points[0].angle(points[count]) / count as f64);
    let needed = step * k / libm::sin(step);
    let radius = match count {
        2 => needed / 2.0,
        _ => ((1.0 + (k - 2.0) * needed).sqrt() - 1.0) / (k - 2.0),
    };
    let factor = (1.0 + (radius - 1.0) * bulge).clamp(1.0, 1.0 + most);
    points[1..count].iter_mut().for_each(|p| *p *= factor);
    points
}

/// Moves the inner points of a cap outwards, by no more than `most`, so that its triangles enclose as much volume
/// as the cap of the sphere. `points` are those of the ring, then `inner` more.
pub(super) fn swollen(
    points: &mut [DVec3],
    inner: std::ops::Range<usize>,
    triangles: &[[u32; 3]],
    most: f64,
) {
    let corners = |points: &[DVec3], t: &[u32; 3]| t.map(|i| points[i as usize]);
    let round = |t: &[u32; 3]| spherical_triangle(corners(points, t).map(DVec3::normalize));
    let wanted = triangles.iter().map(round).sum::<f64>() / 3.0;
    let volume = |points: &[DVec3]| {
        let cone = |t: &[u32; 3]| {
            let [a, b, c] = corners(points, t);
            a.dot(b.cross(c)) / 6.0
        };
        triangles.iter().map(cone).sum::<f64>()
    };
    // The volume grows nearly evenly with the way.
    let (held, mut way) = (volume(points), most);
    for _ in 0..STEPS {
        let mut moved = points.to_vec();
        moved[inner.clone()].iter_mut().for_each(|p| *p *= 1.0 + way);
        let gained = volume(&moved) - held;
        if gained <= 0.0 || wanted <= held {
            return;
        }
        way = (way * (wanted - held) / gained).min(most);
    }
    points[inner].iter_mut().for_each(|p| *p *= 1.0 + way);
}

/// Steps towards the way that makes a volume right.
const STEPS: usize = 3;

/// The angle between two vectors.
pub(super) trait Angle {
    /// In radians.
    fn angle(self, other: Self) -> f64;
}

impl Angle for DVec3 {
    fn angle(self, other: DVec3) -> f64 {
        libm::atan2(self.cross(other).length(), self.dot(other))
    }
}

/// A cap of the unit sphere within a convex ring of its points, counter-clockwise from outside: further
/// points, and triangles by number, first those of the ring, then the further ones. Edges of triangles span
/// about the angle `edge`.
pub(super) fn cap(ring: &[DVec3], edge: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let middle = ring.iter().sum::<DVec3>().normalize_or(ring[0]);
    let angles = || ring.iter().map(|p| p.angle(middle));
    let (far, near) = (angles().fold(0.0, f64::max), angles().fold(f64::INFINITY, f64::min));
    let (mut more, mut triangles) = (vec![], vec![]);
    let ends: Vec<u32> = (0..ring.len() as u32).collect();
    if near < THIN * edge || ring.len() < 4 {
        thin(ring, &ends, &mut triangles);
        return (more, triangles);
    }
    let steps = (far / (edge * STEP)).round().max(1.0) as usize;
    let (mut outer, mut shape) = (ends, ring.to_vec());
    for step in 1..=steps {
        let share = step as f64 / steps as f64;
        let inner: Vec<DVec3> = if step == steps {
            vec![middle]
        } else {
            let count = ((ring.len() as f64) * (1.0 - share)).round().max(3.0) as usize;
            let drawn = |k: usize| {
                let at = k as f64 / count as f64 * ring.len() as f64;
                let (i, t) = (at as usize % ring.len(), at.fract());
                let on = ring[i].lerp(ring[(i + 1) % ring.len()], t).normalize();
                on.lerp(middle, share).normalize()
            };
            (0..count).map(drawn).collect()
        };
        let first = (ring.len() + more.len()) as u32;
        let numbers: Vec<u32> = (first..first + inner.len() as u32).collect();
        between((&shape, &outer), (&inner, &numbers), &mut triangles);
        more.extend(&inner);
        (outer, shape) = (numbers, inner);
    }
    (more, triangles)
}

/// Caps narrower than this many edges need no points inside.
const THIN: f64 = 0.6;
/// The height of an equilateral triangle over its edge.
const STEP: f64 = 0.866;

/// Triangles between an outer and an inner closed ring.
fn between(
    (outer, of_outer): (&[DVec3], &[u32]),
    (inner, of_inner): (&[DVec3], &[u32]),
    out: &mut Vec<[u32; 3]>,
) {
    let (n, m) = (outer.len(), inner.len());
    let (mut i, mut j) = (0, 0);
    let last = if m == 1 { 0 } else { m };
    while i < n || j < last {
        let [a, b] = [i % n, (i + 1) % n];
        let [c, d] = [j % m, (j + 1) % m];
        let outwards = j >= last
            || (i < n
                && outer[b].distance_squared(inner[c]) <= outer[a].distance_squared(inner[d]));
        if outwards {
            out.push([of_outer[a], of_outer[b], of_inner[c]]);
            i += 1;
        } else {
            out.push([of_outer[a], of_inner[d], of_inner[c]]);
            j += 1;
        }
    }
}

/// Triangles of a convex ring without further points: across its narrow side.
fn thin(ring: &[DVec3], numbers: &[u32], out: &mut Vec<[u32; 3]>) {
    let n = ring.len();
    let width = |i: usize, j: usize| ring[i].distance_squared(ring[j]);
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    let Some((low, high)) = pairs.max_by(|a, b| width(a.0, a.1).total_cmp(&width(b.0, b.1))) else {
        return;
    };
    // From the tip `low`, one side forwards and the other backwards, until they meet at `high`.
    let (forwards, backwards) = (high - low, n - (high - low));
    let (left, right) = (|i: usize| (low + i) % n, |j: usize| (low + n - j) % n);
    let (mut i, mut j) = (0, 0);
    while i < forwards || j < backwards {
        let ahead = i < forwards
            && (j >= backwards || width(left(i + 1), right(j)) <= width(left(i), right(j + 1)));
        let third = if ahead { left(i + 1) } else { right(j + 1) };
        if left(i) != right(j) && third != left(i) && third != right(j) {
            out.push([left(i), third, right(j)].map(|k| numbers[k]));
        }
        (i, j) = if ahead { (i + 1, j) } else { (i, j + 1) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_octant_is_closed_and_on_the_sphere() {
        let mut ring = arc(DVec3::X, DVec3::Y, 8);
        ring.extend(&arc(DVec3::Y, DVec3::Z, 8)[1..]);
        ring.extend(&arc(DVec3::Z, DVec3::X, 8)[1..8]);
        let (more, triangles) = cap(&ring, 0.2);
        let all: Vec<DVec3> = ring.iter().chain(&more).copied().collect();
        assert!(all.iter().all(|p| (p.length() - 1.0).abs() < 1e-12));
        let volume: f64 = triangles
            .iter()
            .map(|t| all[t[0] as usize].dot(all[t[1] as usize].cross(all[t[2] as usize])))
            .sum::<f64>()
            / 6.0;
        let whole = 4.0 / 3.0 * std::f64::consts::PI / 8.0;
        // Equilateral triangles of side s in the unit sphere lose 3 s^2 / 8 of its volume.
        let lost = 1.0 - volume / whole;
        assert!((0.0..3.0 * 0.2 * 0.2 / 8.0).contains(&lost), "{volume} {whole}");
        let mut edges: Vec<(u32, u32)> =
            triangles.iter().flat_map(|t| (0..3).map(|k| (t[k], t[(k + 1) % 3]))).collect();
        edges.sort_unstable();
        assert!(edges.windows(2).all(|w| w[0] != w[1]));
        let open = edges.iter().filter(|(a, b)| edges.binary_search(&(*b, *a)).is_err());
        assert_eq!(open.count(), ring.len());
    }

    #[test]
    fn evened_arcs_and_swollen_caps_enclose_what_is_round() {
        let points = evened(arc(DVec3::X, DVec3::Y, 6), 1.0, 0.1);
        let area: f64 = points.windows(2).map(|w| w[0].cross(w[1]).z).sum::<f64>() / 2.0;
        assert!((area - std::f64::consts::PI / 4.0).abs() < 1e-12, "{area}");
        let quarter = |a, b| evened(arc(a, b, 8), 1.0, 0.1)[..8].to_vec();
        let ring: Vec<DVec3> = [(DVec3::X, DVec3::Y), (DVec3::Y, DVec3::Z), (DVec3::Z, DVec3::X)]
            .into_iter()
            .flat_map(|(a, b)| quarter(a, b))
            .collect();
        let (more, triangles) = cap(&ring, 0.2);
        let mut all: Vec<DVec3> = ring.iter().chain(&more).copied().collect();
        let inner = ring.len()..all.len();
        swollen(&mut all, inner, &triangles, 0.1);
        let cone = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| all[i as usize]);
            a.dot(b.cross(c)) / 6.0
        };
        let volume: f64 = triangles.iter().map(cone).sum();
        assert!((volume / (std::f64::consts::PI / 6.0) - 1.0).abs() < 1e-5, "{volume}");
    }

    #[test]
    fn a_thin_cap_is_cut_across() {
        let tilt = DVec3::new(0.0, 1.0, 0.05).normalize();
        let mut ring = arc(DVec3::X, DVec3::Y, 8);
        ring.extend(&arc(tilt, DVec3::X, 8)[..8]);
        let (more, triangles) = cap(&ring, 0.2);
        assert!(more.is_empty());
        assert_eq!(triangles.len(), ring.len() - 2);
    }
}
