//! Where the pictures of two curves cross, and which of them is nearer there.

use glam::{DVec2, DVec3};

use super::{Camera, field::Curve, model::Model};

/// Newton's method doubles the digits in each step; a chord gives three to begin with.
const STEPS: usize = 12;

/// Steps shorter than this part of the coordinates are the last: the next would be its square.
const SETTLED: f64 = 1e-9;

/// Pictures that cross at a smaller angle than this (its sine) are left at the crossing of their chords.
const GRAZING: f64 = 1e-6;

/// A piece of a curve between two of its points; straight without a curve.
#[derive(Clone, Copy, Debug)]
pub struct Strand<'a> {
    curve: Option<&'a Curve>,
    ends: [DVec3; 2],
}

impl<'a> Strand<'a> {
    /// The piece between two points of a model.
    pub fn new(model: &'a Model, curve: u32, ends: [u32; 2]) -> Strand<'a> {
        let ends = ends.map(|i| model.space[i as usize]);
        Strand { curve: model.curves.get(curve as usize), ends }
    }

    /// The vector between its ends.
    fn chord(&self) -> DVec3 {
        self.ends[1] - self.ends[0]
    }

    /// The point over a place on the chord, 0 to 1 in space.
    pub fn at(&self, camera: &Camera, s: f64) -> DVec3 {
        self.pulled(camera, self.ends[0].lerp(self.ends[1], s), self.chord())
    }

    /// The place on the chord under a point, a little less than 0 or more than 1 for a point over a neighbouring chord.
    pub fn place(&self, p: DVec3) -> f64 {
        let chord = self.chord();
        ((p - self.ends[0]).dot(chord) / chord.length_squared()).clamp(-0.5, 1.5)
    }

    /// A point near the curve, moved onto it across a direction.
    fn pulled(&self, camera: &Camera, p: DVec3, along: DVec3) -> DVec3 {
        let reach = self.chord().length();
        self.curve.and_then(|c| c.near(camera, p, along, reach)).unwrap_or(p)
    }

    /// The unit tangent at a point, in the direction of the chord.
    pub fn tangent(&self, camera: &Camera, p: DVec3) -> DVec3 {
        let chord = self.chord().normalize_or_zero();
        let tangent = self.curve.and_then(|c| c.tangent(camera, p).try_normalize());
        tangent.map_or(chord, |t| if t.dot(chord) < 0.0 { -t } else { t })
    }
}

/// The points of two strands whose images fall together, from places on their chords where the chords'
/// images cross. Where Newton's method finds none, strands of one surface do not cross, since chords of a
/// contour and of a curve beside it may cross where the curves do not; others cross where their chords do.
pub fn meet(camera: &Camera, one: &Strand, s: f64, other: &Strand, t: f64) -> Option<[DVec3; 2]> {
    let start = [one.at(camera, s), other.at(camera, t)];
    let beside = match (one.curve, other.curve) {
        (Some(a), Some(b)) => a.shares_surface(b),
        _ => false,
    };
    refined(camera, [one, other], start).or((!beside).then_some(start))
}

/// The points near two others where the images of two strands cross.
fn refined(camera: &Camera, strands: [&Strand; 2], start: [DVec3; 2]) -> Option<[DVec3; 2]> {
    let mut points = start;
    for _ in 0..STEPS {
        let tangents = [0, 1].map(|i| strands[i].tangent(camera, points[i]));
        let moves = steps(camera, points, tangents)?;
        let within = (0..2).all(|i| moves[i].abs() <= strands[i].chord().length());
        if !within {
            return None;
        }
        points = [0, 1]
            .map(|i| strands[i].pulled(camera, points[i] + tangents[i] * moves[i], tangents[i]));
        let size = points[0].abs().max_element().max(points[1].abs().max_element());
        if moves[0].abs().max(moves[1].abs()) <= SETTLED * size {
            return Some(points);
        }
    }
    None
}

/// How far to go along each tangent to where their images cross.
fn steps(camera: &Camera, points: [DVec3; 2], tangents: [DVec3; 2]) -> Option<[f64; 2]> {
    let [p, q] = points.map(|p| camera.image(p).0);
    let [u, v]: [DVec2; 2] = [0, 1].map(|i| camera.image_velocity(points[i], tangents[i]));
    let det = u.perp_dot(v);
    if det.abs() <= GRAZING * u.length() * v.length() {
        return None;
    }
    let gap = q - p;
    Some([gap.perp_dot(v) / det, gap.perp_dot(u) / det])
}

/// How much nearer to the eye the second point is, mm, of two on one sight line.
pub fn nearer(camera: &Camera, points: [DVec3; 2]) -> f64 {
    (points[1] - points[0]).dot(camera.sight(points[0]).normalize_or_zero())
}
