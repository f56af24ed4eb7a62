//! Growing and shrinking plane figures by a distance.
//!
//! Every edge moves outwards by d along its normal (an edge of a circle: radially, onto the concentric
//! circle). Where neighbours part, an arc of radius |d| about the corner joins them; where they cross,
//! the way leads back through the corner. Around any point the resulting closed way winds as often as
//! the figure itself, plus once for each strip and each sector swept in growing, or minus once in
//! shrinking. So what it winds around positively is exactly the figure united with all strips and
//! sectors, or the figure less all of them: the set of points within d, or at least d from the boundary.
//!
//! An arc whose strip reaches beyond its centre sweeps a sector on the far side too. The way passes the
//! centre and runs around that sector against its direction, so that it counts like the near side.

use glam::DVec2;

use crate::geom::{
    Contour, EdgeCurve, Region, Tolerance, flatten,
    overlay::{Fill, Rule, overlay},
    trig,
};

/// Turns below this sine are none: the normals of an arc and its tangent differ by rounding only.
const SMOOTH_TURN: f64 = 1e-9;

/// The points of the plane nearer to `region` than `d` millimetres (round corners), or for a negative
/// `d` the points inside that are at least -d from its boundary. Arcs follow `tolerance`.
///
/// ```
/// use glam::dvec2;
/// use katachi::{geom::Tolerance, kernel::profile::{offset, rect}};
/// let square = rect(dvec2(10.0, 10.0)).unwrap();
/// assert_eq!(offset(&square, -2.0, Tolerance::DEFAULT).area(), 36.0);
/// let grown = offset(&square, 1.0, Tolerance::new(1e-5).unwrap());
/// assert!((grown.area() - (140.0 + std::f64::consts::PI)).abs() < 1e-4);
/// ```
pub fn offset(region: &Region, d: f64, tolerance: Tolerance) -> Region {
    if d == 0.0 {
        return region.clone();
    }
    let moved: Vec<Contour> = region.contours().map(|c| moved(c, d, tolerance)).collect();
    overlay(&moved, [], Rule::Union, Fill::Positive)
}

/// An edge with its normals, which point out of the figure.
struct Strip {
    start: DVec2,
    end: DVec2,
    start_normal: DVec2,
    end_normal: DVec2,
    /// The curve it stands for when moved.
    curve: EdgeCurve,
    /// Whether it reaches beyond the centre of its circle.
    inverted: bool,
}

/// The closed way of one contour.
fn moved(contour: &Contour, d: f64, tolerance: Tolerance) -> Contour {
    let mut strips: Vec<Strip> = contour.edges().map(|e| strip(e.from, e.to, e.curve, d)).collect();
    let n = strips.len();
    for i in 0..n {
        let before = (i + n - 1) % n;
        let sum = strips[before].end_normal + strips[i].start_normal;
        if is_smooth(strips[before].end_normal, strips[i].start_normal) {
            strips[before].end_normal = sum.normalize();
            strips[i].start_normal = sum.normalize();
        }
    }
    let mut way = Contour::default();
    for i in 0..n {
        join(&mut way, &strips[(i + n - 1) % n], &strips[i], d, tolerance);
        subdivide(&mut way, &strips[i], d, tolerance);
    }
    way
}

fn is_smooth(before: DVec2, after: DVec2) -> bool {
    before.perp_dot(after).abs() < SMOOTH_TURN && before.dot(after) > 0.0
}

fn strip(start: DVec2, end: DVec2, curve: EdgeCurve, d: f64) -> Strip {
    let normal = -(end - start).perp().normalize();
    let flat =
        Strip { start, end, start_normal: normal, end_normal: normal, curve, inverted: false };
    let EdgeCurve::Circle { center, radius } = curve else { return flat };
    let outwards = if normal.dot(start.midpoint(end) - center) > 0.0 { 1.0 } else { -1.0 };
    let (near, far) = (start.distance(center), end.distance(center));
    if start.distance(end) >= near + far || near.min(far) * 2.0 < radius {
        return Strip { curve: EdgeCurve::Line, ..flat };
    }
    let moved = radius + outwards * d;
    Strip {
        start_normal: (start - center).normalize() * outwards,
        end_normal: (end - center).normalize() * outwards,
        curve: EdgeCurve::Circle { center, radius: moved.abs() },
        inverted: moved <= 0.0,
        ..flat
    }
}

fn push(way: &mut Contour, point: DVec2, curve: EdgeCurve) {
    way.points.push(point);
    way.curves.push(curve);
}

/// The way from the end of one strip to the start of the next, both included.
fn join(way: &mut Contour, before: &Strip, after: &Strip, d: f64, tolerance: Tolerance) {
    let corner = after.start;
    let (from, to) = (before.end_normal, after.start_normal);
    let (start, end) = (corner + from * d, corner + to * d);
    let turn = from.perp_dot(to);
    if from != to && turn * d < 0.0 {
        if let Some(mitre) = mitre(before, after, d) {
            push(way, mitre, after.curve);
            return;
        }
        push(way, start, EdgeCurve::Line);
        push(way, corner, EdgeCurve::Line);
    } else if from != to {
        let angle = libm::atan2(turn, from.dot(to));
        let circle = EdgeCurve::Circle { center: corner, radius: d.abs() };
        let chords = flatten::arc_chords(d, angle, tolerance);
        push(way, start, circle);
        for i in 1..chords {
            let degrees = angle.to_degrees() * f64::from(i) / f64::from(chords);
            let (s, c) = (trig::sin_deg(degrees), trig::cos_deg(degrees));
            push(way, corner + (from * c + from.perp() * s) * d, circle);
        }
    }
    push(way, end, after.curve);
}

/// Where two moved edges that overlap cross, if each is long enough for both its ends.
fn mitre(before: &Strip, after: &Strip, d: f64) -> Option<DVec2> {
    let (from, to) = (before.end_normal, after.start_normal);
    let half_tangent = from.perp_dot(to).abs() / (1.0 + from.dot(to));
    let length = |s: &Strip| s.start.distance(s.end);
    let straight = !before.inverted && !after.inverted;
    let fits = 2.0 * half_tangent * d.abs() <= length(before).min(length(after));
    (straight && fits).then(|| after.start + (from + to) * (d / (1.0 + from.dot(to))))
}

/// The inner corners of a moved arc: those it needs for the tolerance, and the way around an inverted one.
fn subdivide(way: &mut Contour, strip: &Strip, d: f64, tolerance: Tolerance) {
    let EdgeCurve::Circle { center, radius } = strip.curve else { return };
    let from = strip.start + strip.start_normal * d - center;
    let to = strip.end + strip.end_normal * d - center;
    let angle = libm::atan2(from.perp_dot(to), from.dot(to));
    // An edge is a chord already: a cap that no edge within any tolerance reaches.
    let chords = flatten::arc_chords(radius, angle, tolerance).min(flatten::MOST_CHORDS);
    let inner = (1..chords).map(|i| {
        let t = f64::from(i) / f64::from(chords);
        let degrees = angle.to_degrees() * t;
        let (s, c) = (trig::sin_deg(degrees), trig::cos_deg(degrees));
        let length = from.length() * (1.0 - t) + to.length() * t;
        let direction = from.normalize();
        center + (direction * c + direction.perp() * s) * length
    });
    if strip.inverted {
        push(way, center, strip.curve);
        push(way, center + to, strip.curve);
        inner.rev().for_each(|p| push(way, p, strip.curve));
        push(way, center + from, strip.curve);
        push(way, center, strip.curve);
    } else {
        inner.for_each(|p| push(way, p, strip.curve));
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::dvec2;

    use super::*;
    use crate::kernel::profile::{circle, difference, measure::bounds, rect, union};

    fn fine() -> Tolerance {
        Tolerance::new(1e-6).unwrap()
    }

    #[test]
    fn an_l_grows_by_perimeter_and_corners() {
        let l = union(&[rect(dvec2(20., 4.)).unwrap(), rect(dvec2(4., 20.)).unwrap()]);
        // A cross of area 144: 8 convex corners, 4 concave ones.
        let grown = offset(&l, 0.5, fine()).area();
        let expected = 144.0 + 80.0 * 0.5 + 8.0 * PI / 4.0 * 0.25 - 4.0 * 0.25;
        assert!((grown - expected).abs() < 1e-5, "{grown} {expected}");
        let shrunk = offset(&l, -0.5, fine()).area();
        let expected = 144.0 - 80.0 * 0.5 + 8.0 * 0.25 - 4.0 * PI / 4.0 * 0.25;
        assert!((shrunk - expected).abs() < 1e-5, "{shrunk} {expected}");
    }

    #[test]
    fn a_hole_closes_and_a_figure_vanishes() {
        let disc = |r| circle(r, None, Tolerance::DEFAULT).unwrap();
        let ring = difference(&[disc(10.0), disc(2.0)]);
        assert_eq!(ring.pieces[0].holes.len(), 1);
        assert_eq!(offset(&ring, 2.1, Tolerance::DEFAULT).pieces[0].holes.len(), 0);
        assert!(offset(&ring, -4.1, Tolerance::DEFAULT).is_empty());
        assert_eq!(offset(&ring, -3.9, Tolerance::DEFAULT).pieces.len(), 1);
    }

    #[test]
    fn a_circle_stays_a_circle() {
        let disc = circle(10.0, None, Tolerance::DEFAULT).unwrap();
        let grown = offset(&disc, 5.0, Tolerance::DEFAULT);
        let outer = &grown.pieces[0].outer;
        for (p, curve) in outer.points.iter().zip(&outer.curves) {
            assert!((p.length() - 15.0).abs() < 1e-9 || p.length() > 15.0 - 0.05);
            assert_eq!(*curve, EdgeCurve::Circle { center: DVec2::ZERO, radius: 15.0 });
        }
        assert_eq!(bounds(&grown).unwrap().1, dvec2(15.0, 15.0));
    }

    #[test]
    fn a_bump_shrinks_away_beyond_its_centre() {
        let tolerance = Tolerance::new(1e-4).unwrap();
        let map = glam::DAffine2::from_translation(dvec2(0.0, 10.0));
        let bump = crate::kernel::profile::placed(&circle(2.0, None, tolerance).unwrap(), &map);
        let plate = union(&[rect(dvec2(40., 20.)).unwrap(), bump]);
        let shrunk = offset(&plate, -3.0, tolerance);
        for contour in shrunk.contours() {
            for p in &contour.points {
                let edges = plate.contours().flat_map(Contour::edges).map(|e| (e.from, e.to));
                let near = edges.map(|(a, b)| distance_to_segment(*p, a, b));
                let near = near.fold(f64::INFINITY, f64::min);
                assert!((near - 3.0).abs() < 2e-4, "{p} {near}");
            }
        }
        // The figure itself less 3 all round, and below the bump what its two corners take.
        assert_eq!(shrunk.pieces.len(), 1);
        assert!(shrunk.area() > 34.0 * 14.0 && shrunk.area() < 34.0 * 14.0 + 4.0);
    }

    fn distance_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
        let d = b - a;
        let t = ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
        p.distance(a + d * t)
    }

    /// Random points of the plane against the definition: the distance to the figure, or to its boundary
    /// from inside, is compared with d.
    #[test]
    fn points_are_where_their_distance_says() {
        let mut seed = 3_u64;
        let mut random = move || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 40) as f64 / (1 << 24) as f64
        };
        let tolerance = Tolerance::new(1e-3).unwrap();
        for round in 0..60 {
            let mut figures = vec![];
            for _ in 0..4 {
                let at = DVec2::new(random(), random()) * 16.0 - 8.0;
                let map = glam::DAffine2::from_angle_translation(6.3 * random(), at);
                let figure = match round % 2 {
                    0 => rect(dvec2(1.0 + 9.0 * random(), 1.0 + 5.0 * random())).unwrap(),
                    _ => circle(0.5 + 4.0 * random(), None, tolerance).unwrap(),
                };
                figures.push(crate::kernel::profile::placed(&figure, &map));
            }
            let hole = figures.pop().unwrap();
            let figure = difference(&[union(&figures), hole]);
            let d = 4.0 * random() - 2.0;
            let moved = offset(&figure, d, tolerance);
            for _ in 0..200 {
                let p = DVec2::new(random(), random()) * 32.0 - 16.0;
                let edges = figure.contours().flat_map(Contour::edges).map(|e| (e.from, e.to));
                let near = edges.map(|(a, b)| distance_to_segment(p, a, b));
                let near = near.fold(f64::INFINITY, f64::min);
                let signed = if inside(&figure, p) { -near } else { near };
                if (signed - d).abs() > 4e-3 {
                    assert_eq!(
                        inside(&moved, p),
                        signed < d,
                        "round {round}, d {d}, {p}: {signed}"
                    );
                }
            }
        }
    }

    fn inside(region: &Region, p: DVec2) -> bool {
        let edges = region.contours().flat_map(Contour::edges).map(|e| (e.from, e.to));
        let crossed = edges.filter(|&(a, b)| {
            (a.y <= p.y) != (b.y <= p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
        });
        crossed.count() % 2 == 1
    }

    #[test]
    fn a_neck_parts() {
        let dumbbell =
            union(&[rect(dvec2(30., 2.)).unwrap(), union(&[shifted(-12.0), shifted(12.0)])]);
        assert_eq!(offset(&dumbbell, -1.5, Tolerance::DEFAULT).pieces.len(), 2);
    }

    fn shifted(x: f64) -> Region {
        let map = glam::DAffine2::from_translation(dvec2(x, 0.0));
        crate::kernel::profile::placed(&rect(dvec2(8., 8.)).unwrap(), &map)
    }
}
