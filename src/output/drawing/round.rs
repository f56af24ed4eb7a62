//! Free arcs: strokes whose corners lie on a circle or an ellipse of space, drawn as arcs.
//!
//! What hides them is found on their chords; the parts of one order are then put on the ellipse that the whole arc is in
//! the picture. Where it is none, as for a circle seen edge-on, the chords stay.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::{
    COINCIDENT, Camera,
    arcs::ArcPiece,
    conic::Ellipse,
    merge::Mark,
    model::{Edge, Model},
    span::Span,
};

/// A circle or an ellipse in space: center + cos(t) x + sin(t) y.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Round {
    /// Its centre, mm.
    pub center: DVec3,
    /// From the centre to the point of parameter 0, mm.
    pub x: DVec3,
    /// From the centre to the point a quarter turn on, mm.
    pub y: DVec3,
}

impl Round {
    /// The point of a parameter in radians, mm.
    pub fn at(&self, t: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(t);
        self.center + self.x * cos + self.y * sin
    }

    /// The parameter of a point on it, -pi to pi.
    fn parameter(&self, p: DVec3) -> f64 {
        let (x, y, v) = (self.x, self.y, p - self.center);
        let (xx, xy, yy) = (x.dot(x), x.dot(y), y.dot(y));
        libm::atan2(xx * v.dot(y) - xy * v.dot(x), yy * v.dot(x) - xy * v.dot(y))
    }
}

/// A stroke on a round in the model: its edges follow each other.
#[derive(Clone, Debug)]
pub struct Bow {
    round: Round,
    /// Number of its first edge.
    first: usize,
    /// Parameters of its corners, one more than edges, without jumps.
    angles: Vec<f64>,
}

/// Places of the picture that an arc is fitted to.
const SAMPLES: u32 = 24;

impl Bow {
    /// The arc through corners on a round; `first` is the number of its first edge.
    pub fn new(round: Round, points: &[DVec3], first: usize) -> Bow {
        let mut angles: Vec<f64> = Vec::with_capacity(points.len());
        for &p in points {
            let angle = round.parameter(p);
            angles.push(match angles.last() {
                Some(last) => angle + TAU * ((last - angle) / TAU).round(),
                None => angle,
            });
        }
        Bow { round, first, angles }
    }

    /// The numbers of its edges.
    pub fn edges(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.angles.len() - 1
    }

    /// The ellipse that it is in the picture; `None` when it is none or too flat.
    pub fn ellipse(&self, model: &Model) -> Option<Ellipse> {
        let [from, to] = [self.angles[0], self.angles[self.angles.len() - 1]];
        let at = |i| from + (to - from) * f64::from(i) / f64::from(SAMPLES);
        let points: Vec<DVec2> =
            (0..=SAMPLES).map(|i| image(&model.camera, &self.round, at(i))).collect();
        Ellipse::through(&points, model.picture_size() * COINCIDENT)
    }

    /// The parts of the arc with the same order, from what each edge is hidden like.
    pub fn pieces(
        &self,
        model: &Model,
        ellipse: Ellipse,
        mut hide: impl FnMut(&Edge, &mut Vec<Span>),
        mark: impl Fn(&Edge, u32) -> Mark,
        out: &mut Vec<ArcPiece>,
    ) {
        let mut runs: Vec<(f64, f64, u32)> = vec![];
        let mut spans = vec![];
        for (i, edge) in model.edges[self.edges()].iter().enumerate() {
            spans.clear();
            if model.at[edge.a as usize] == model.at[edge.b as usize] {
                continue;
            }
            hide(edge, &mut spans);
            let [from, to] = [self.angles[i], self.angles[i + 1]];
            let angle = |t: f64| from + (to - from) * model.place_in_space([edge.a, edge.b], t);
            for span in &spans {
                let (start, end) = (angle(span.from), angle(span.to));
                match runs.last_mut() {
                    Some(last) if last.2 == span.order => last.1 = end,
                    _ => runs.push((start, end, span.order)),
                }
            }
        }
        let edge = &model.edges[self.first];
        for (from, to, order) in runs {
            let (from, to) = arc(&model.camera, &self.round, &ellipse, [from, to]);
            out.push(ArcPiece { ellipse, from, to, mark: mark(edge, order) });
        }
    }
}

fn image(camera: &Camera, round: &Round, t: f64) -> DVec2 {
    camera.image(round.at(t)).0
}

/// The parameters of an arc on its picture, the second one larger.
fn arc(camera: &Camera, round: &Round, ellipse: &Ellipse, [from, to]: [f64; 2]) -> (f64, f64) {
    // A quarter of the way is less than half a turn in the picture, so that the nearer way around is the right one.
    let at = |i| ellipse.parameter(image(camera, round, from + (to - from) * f64::from(i) / 4.0));
    let start = at(0);
    let mut end = start;
    for angle in (1..=4).map(at) {
        let turn = angle - end;
        end += turn - TAU * (turn / TAU).round();
    }
    (start.min(end), start.max(end))
}
