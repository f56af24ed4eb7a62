//! Windowing: bodies that reach behind the eye are cut off before it, lines that leave the window at its border.
//!
//! A body in front of the eye stays as it is, one behind it is dropped, one between is cut: its faces lose what is
//! behind, and no cap takes its place, so that an eye within walls sees out and an eye within a room sees the
//! room. What the cut leaves open is no edge.

use std::borrow::Cow;

use glam::{DVec2, DVec3};
use rustc_hash::FxHashMap;

use super::{
    Camera, Window,
    merge::Piece,
    scene::{Scene, Stroke},
};
use crate::geom::{PolyMesh, trig::cos_deg};

/// A body as far as it is before the eye.
#[derive(Clone, Debug)]
pub struct Visible<'a> {
    /// What is left of its boundary.
    pub mesh: Cow<'a, PolyMesh>,
    /// The caller's number for it.
    pub id: u32,
    /// Points from this number on lie in the cut.
    pub cut: u32,
    /// The cosine of the angle from which on facets without a closed form meet in an edge.
    pub crease: f64,
}

impl Visible<'_> {
    /// Whether an edge lies in the cut.
    pub fn is_cut(&self, a: u32, b: u32) -> bool {
        a.min(b) >= self.cut
    }
}

/// Coordinates up to this, mm, can be squared and multiplied on; what reaches farther is left out.
const FARTHEST: f64 = 1e60;

/// Whether a point is near enough to count with.
pub fn is_near(p: &DVec3) -> bool {
    p.is_finite() && p.abs().max_element() <= FARTHEST
}

/// The bodies and strokes of a scene as far as they are before the eye; facets meet in an edge from an angle on, degrees.
pub fn before_eye<'a>(
    scene: &Scene<'a>,
    camera: &Camera,
    crease: f64,
) -> (Vec<Visible<'a>>, Vec<Stroke>) {
    let mut bodies = vec![];
    for body in &scene.bodies {
        let (mesh, id, cut) = (body.mesh, body.id, body.mesh.points.len() as u32);
        if !mesh.points.iter().all(is_near) {
            continue;
        }
        let behind = mesh.points.iter().filter(|p| camera.ahead(**p) < 0.0).count();
        let crease = if body.smooth { -1.0 } else { cos_deg(crease) };
        if behind == 0 {
            bodies.push(Visible { mesh: Cow::Borrowed(mesh), id, cut, crease });
        } else if behind < mesh.points.len() {
            let mesh = Cow::Owned(cut_mesh(mesh, camera));
            bodies.push(Visible { mesh, id, cut, crease });
        }
    }
    let near = scene.strokes.iter().filter(|s| s.points.iter().all(is_near));
    let strokes = near.flat_map(|s| cut_stroke(s, camera)).collect();
    (bodies, strokes)
}

/// The point between two where they pass the plane before the eye.
fn passage(camera: &Camera, p: DVec3, q: DVec3) -> DVec3 {
    let (s, t) = (camera.ahead(p), camera.ahead(q));
    p.lerp(q, s / (s - t))
}

/// The faces of a mesh as far as they are before the eye; the points keep their numbers.
fn cut_mesh(mesh: &PolyMesh, camera: &Camera) -> PolyMesh {
    let mut out = PolyMesh::with_points(mesh.points.clone());
    mesh.origins().iter().for_each(|o| {
        out.add_origin(o.clone());
    });
    (0..mesh.plane_count()).for_each(|_| {
        out.add_plane();
    });
    let mut passages: FxHashMap<(u32, u32), u32> = FxHashMap::default();
    for face in mesh.faces() {
        let loops: Vec<Vec<u32>> = face
            .loops()
            .map(|corners| cut_loop(&mut out.points, camera, corners, &mut passages))
            .filter(|corners| corners.len() >= 3)
            .collect();
        if !loops.is_empty() {
            out.push_face(&loops, face.plane(), face.origin_index());
        }
    }
    out
}

/// A loop without what is behind (Sutherland and Hodgman); passages between two points are added once.
pub fn cut_loop(
    points: &mut Vec<DVec3>,
    camera: &Camera,
    corners: &[u32],
    passages: &mut FxHashMap<(u32, u32), u32>,
) -> Vec<u32> {
    let mut kept = vec![];
    let mut before = corners[corners.len() - 1];
    for &corner in corners {
        let [p, q] = [before, corner].map(|c| points[c as usize]);
        let (was, is) = (camera.ahead(p) >= 0.0, camera.ahead(q) >= 0.0);
        if was != is {
            let key = (before.min(corner), before.max(corner));
            let at = *passages.entry(key).or_insert_with(|| {
                let [p, q] = [key.0, key.1].map(|c| points[c as usize]);
                points.push(passage(camera, p, q));
                points.len() as u32 - 1
            });
            kept.push(at);
        }
        if is {
            kept.push(corner);
        }
        before = corner;
    }
    kept
}

/// The parts of a stroke before the eye.
fn cut_stroke(stroke: &Stroke, camera: &Camera) -> Vec<Stroke> {
    let whole = stroke.points.iter().all(|p| camera.ahead(*p) >= 0.0);
    let mut parts: Vec<Vec<DVec3>> = vec![vec![]];
    for (i, &p) in stroke.points.iter().enumerate() {
        let before = i.checked_sub(1).map(|k| stroke.points[k]);
        if let Some(q) = before.filter(|q| (camera.ahead(*q) < 0.0) != (camera.ahead(p) < 0.0)) {
            parts[0].push(passage(camera, q, p));
            if camera.ahead(p) < 0.0 {
                parts.insert(0, vec![]);
            }
        }
        if camera.ahead(p) >= 0.0 {
            parts[0].push(p);
        }
    }
    parts.retain(|points| points.len() > 1);
    let round = stroke.round.filter(|_| whole);
    let drawn = || if whole { stroke.drawn.clone() } else { vec![] };
    let parts = parts.into_iter().rev();
    parts.map(|points| Stroke { points, round, drawn: drawn(), ..*stroke }).collect()
}

/// Places on a curved line that are looked at for where it passes the border of a window.
const SAMPLES: u32 = 64;

impl Window {
    fn contains(&self, p: DVec2) -> bool {
        self.min.cmple(p).all() && p.cmple(self.max).all()
    }

    /// The part of a segment within the window, as parameters in 0..1 (Liang and Barsky).
    pub(super) fn of_segment(&self, p: DVec2, q: DVec2) -> Option<(f64, f64)> {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for axis in 0..2 {
            let (start, way) = (p[axis], q[axis] - p[axis]);
            for (border, inwards) in [(self.min[axis], 1.0), (self.max[axis], -1.0)] {
                let (room, rate) = ((start - border) * inwards, way * inwards);
                if rate == 0.0 && room < 0.0 {
                    return None;
                } else if rate > 0.0 {
                    from = from.max(-room / rate);
                } else if rate < 0.0 {
                    to = to.min(-room / rate);
                }
            }
        }
        (from < to).then_some((from, to))
    }

    /// Cuts a piece off at the border; false if nothing is left of it.
    pub(super) fn cut(&self, piece: &mut Piece) -> bool {
        let Some((from, to)) = self.of_segment(piece.from, piece.to) else { return false };
        let [p, q] = [piece.from, piece.to];
        // An end within stays as it is, to the bit, so that lines go on into each other.
        piece.from = if from > 0.0 { p.lerp(q, from) } else { p };
        piece.to = if to < 1.0 { p.lerp(q, to) } else { q };
        true
    }

    /// The parts of a curve within the window, as parameters in 0..1.
    pub(super) fn of_curve(&self, at: impl Fn(f64) -> DVec2) -> Vec<(f64, f64)> {
        let mut parts: Vec<(f64, f64)> = vec![];
        let mut start = self.contains(at(0.0)).then_some(0.0);
        for i in 0..SAMPLES {
            let [s, t] = [i, i + 1].map(|k| f64::from(k) / f64::from(SAMPLES));
            let (was, is) = (self.contains(at(s)), self.contains(at(t)));
            if was != is {
                let border = self.border(&at, s, t);
                match start.take() {
                    Some(from) => parts.push((from, border)),
                    None => start = Some(border),
                }
            }
        }
        parts.extend(start.map(|from| (from, 1.0)));
        parts
    }

    /// Where a curve passes the border between two parameters, by halving.
    fn border(&self, at: &impl Fn(f64) -> DVec2, mut low: f64, mut high: f64) -> f64 {
        let start = self.contains(at(low));
        for _ in 0..f64::MANTISSA_DIGITS {
            let middle = (low + high) / 2.0;
            if self.contains(at(middle)) == start { low = middle } else { high = middle }
        }
        low
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::output::drawing::Kind;

    #[test]
    fn lines_end_at_the_border() {
        let window = Window { min: dvec2(-1.0, -1.0), max: dvec2(1.0, 1.0) };
        let part = |p: [f64; 2], q: [f64; 2]| window.of_segment(p.into(), q.into());
        assert_eq!(part([-2.0, 0.0], [2.0, 0.0]), Some((0.25, 0.75)));
        assert_eq!(part([0.0, 0.0], [4.0, 0.5]), Some((0.0, 0.25)));
        assert_eq!(part([-2.0, 0.0], [0.0, 3.0]), None);
        assert_eq!(part([2.0, -1.0], [2.0, 1.0]), None);
        let circle = |t: f64| {
            let (sin, cos) = libm::sincos(t * std::f64::consts::TAU);
            dvec2(cos, sin) * 1.25
        };
        // Each corner of the window cuts off what is beyond 1 / 1.25 = cos 36.87 degrees.
        let inside: f64 = window.of_curve(circle).iter().map(|p| p.1 - p.0).sum();
        assert!((inside * 360.0 - (360.0 - 8.0 * 36.869_897_645_844_02)).abs() < 1e-9);
    }

    #[test]
    fn strokes_are_cut_before_the_eye() {
        let camera = Camera::perspective(DVec3::X * 10.0, DVec3::ZERO).expect("apart");
        let points = [0.0, 20.0, 0.0].map(|x| DVec3::new(x, x / 4.0, 0.0)).to_vec();
        let parts = cut_stroke(
            &Stroke { points, kind: Kind::Free, id: 3, round: None, drawn: vec![] },
            &camera,
        );
        assert_eq!(parts.iter().map(|p| p.points.len()).collect::<Vec<_>>(), [2, 2]);
        assert!((parts[0].points[1].x - 9.9).abs() < 1e-12);
        assert_eq!(parts[0].points[1], parts[1].points[0]);
    }
}
