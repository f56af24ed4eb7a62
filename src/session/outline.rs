//! Curves and plane figures as lines in space.

use glam::{DVec2, DVec3};

use crate::{
    geom::{
        Contour, EdgeCurve, Placement, Tolerance,
        trig::{cos_deg, sin_deg},
    },
    output::drawing::Round,
    realize::Figure,
    shape::CurveSpec,
};

/// A line in space.
#[derive(Clone, Debug)]
pub struct Outline {
    /// Its corners.
    pub points: Vec<DVec3>,
    /// The circle or ellipse they lie on, if it is an arc.
    pub round: Option<Round>,
}

impl From<Vec<DVec3>> for Outline {
    fn from(points: Vec<DVec3>) -> Outline {
        Outline { points, round: None }
    }
}

impl Outline {
    /// The line after a placement.
    pub fn placed(&self, placement: &Placement) -> Outline {
        let round = |r: Round| Round {
            center: placement.point(r.center),
            x: placement.vector(r.x),
            y: placement.vector(r.y),
        };
        Outline {
            points: self.points.iter().map(|p| placement.point(*p)).collect(),
            round: self.round.map(round),
        }
    }
}

/// Smallest and largest part of an arc, degrees.
const FINEST: f64 = 0.1;
const COARSEST: f64 = 15.0;

/// A curve as a line; chords of an arc stay within the tolerance.
pub fn line_of(curve: &CurveSpec, tolerance: Tolerance) -> Outline {
    match curve {
        CurveSpec::Polyline { points, closed } => {
            let closing = points.first().filter(|_| *closed);
            points.iter().chain(closing).copied().collect::<Vec<_>>().into()
        }
        CurveSpec::Arc { center, x, y, from, to } => {
            let r = x.length().max(y.length());
            let half = libm::acos((1.0 - tolerance.mm() / r).clamp(0.0, 1.0)).to_degrees();
            let parts = ((to - from).abs() / (2.0 * half).clamp(FINEST, COARSEST)).ceil();
            let point = |i: u32| {
                let angle = from + (to - from) * f64::from(i) / parts;
                *center + *x * cos_deg(angle) + *y * sin_deg(angle)
            };
            let points = (0..=parts as u32).map(point).collect();
            Outline { points, round: Some(Round { center: *center, x: *x, y: *y }) }
        }
    }
}

/// The contours of a plane figure in space, each cut where one of its curves ends.
pub fn outlines(figure: &Figure) -> Vec<Outline> {
    let lines = figure.region.contours().flat_map(contour_lines);
    lines.map(|line| line.placed(&figure.frame)).collect()
}

/// The runs of a contour along one circle, and those between.
fn contour_lines(contour: &Contour) -> Vec<Outline> {
    let edges: Vec<_> = contour.edges().collect();
    let circle = |curve: EdgeCurve| match curve {
        EdgeCurve::Circle { center, radius } => Some((center, radius)),
        _ => None,
    };
    // Begin where a circle begins, so that none is cut in two.
    let changes = |i: usize| {
        let before = edges[(i + edges.len() - 1) % edges.len()].curve;
        circle(before) != circle(edges[i].curve)
    };
    let start = (0..edges.len()).find(|&i| changes(i)).unwrap_or(0);
    let mut lines: Vec<(Option<(DVec2, f64)>, Vec<DVec3>)> = vec![];
    for i in (0..edges.len()).map(|i| (start + i) % edges.len()) {
        let (on, to) = (circle(edges[i].curve), edges[i].to.extend(0.0));
        match lines.last_mut() {
            Some((last, points)) if *last == on => points.push(to),
            _ => lines.push((on, vec![edges[i].from.extend(0.0), to])),
        }
    }
    let outline = |(on, points): (Option<(DVec2, f64)>, _)| {
        let round = on.map(|(center, radius)| Round {
            center: center.extend(0.0),
            x: DVec3::X * radius,
            y: DVec3::Y * radius,
        });
        Outline { points, round }
    };
    lines.into_iter().map(outline).collect()
}
