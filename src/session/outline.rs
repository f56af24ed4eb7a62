//! Curves and plane figures as lines in space.

use glam::{DVec2, DVec3};

use crate::{
    base::{Code, Diagnostic},
    geom::{
        Contour, Curve, EdgeCurve, Placement, Region, Tolerance,
        curve::{Piece, Turn},
        trig::{cos_deg, sin_deg},
    },
    output::drawing::Round,
    realize::{Figure, Realizer},
    shape::{CurveSpec, ShapeGraph, ShapeId},
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

/// Largest part of an arc, degrees.
const COARSEST: f64 = 15.0;

/// Chords of one curve at most.
const MOST_CHORDS: u64 = 1_000_000;

/// Lines of one hatching at most.
const MOST_LINES: f64 = 20_000.0;

/// Makes lines of curves and plane figures.
pub struct Tracer<'a> {
    pub realizer: &'a Realizer<'a>,
    pub graph: &'a ShapeGraph,
}

impl Tracer<'_> {
    /// The outlines of a plane figure.
    pub fn profile(&self, profile: ShapeId) -> Result<Vec<Outline>, Diagnostic> {
        let figure = self.realizer.figure(self.graph, profile);
        figure.map(|figure| outlines(&figure)).map_err(|error| *error.diagnostic)
    }

    /// The lines of a curve; their chords stay within the tolerance. Fails for more than [`MOST_CHORDS`] of them.
    pub fn curve(&self, curve: &CurveSpec) -> Result<Vec<Outline>, Diagnostic> {
        match curve {
            CurveSpec::Exact(curve) => {
                let tolerance = self.realizer.tolerance();
                let needed = curve.chords(tolerance);
                if needed > MOST_CHORDS {
                    let words = format!(
                        "a curve needs {needed} chords at this tolerance; the limit is {MOST_CHORDS}"
                    );
                    return Err(Diagnostic::error(Code::Limit, words));
                }
                Ok(exact(curve, tolerance))
            }
            CurveSpec::Hatch { profile, pitch, angle, placement } => {
                let figure = self.realizer.figure(self.graph, *profile);
                let figure = figure.map_err(|error| *error.diagnostic)?;
                let lines = hatching(&figure.region, *pitch, *angle).map_err(|count| {
                    let words =
                        format!("this hatching has {count} lines; the limit is {MOST_LINES}");
                    Diagnostic::error(Code::Limit, words)
                        .label(self.graph.origin(*profile), "")
                        .help("give it a larger `pitch`")
                })?;
                let frame = placement.after(&figure.frame);
                let place = |line: [DVec2; 2]| line.map(|p| frame.point(p.extend(0.0))).to_vec();
                Ok(lines.into_iter().map(|line| place(line).into()).collect())
            }
        }
    }
}

/// Parts that a piece has at least.
fn least(piece: &Piece) -> u32 {
    match piece {
        Piece::Turn(turn) => ((turn.to - turn.from).abs() / COARSEST).ceil() as u32,
        _ => 1,
    }
}

/// The lines of a curve: each arc of an ellipse by itself, what is between them in one.
fn exact(curve: &Curve, tolerance: Tolerance) -> Vec<Outline> {
    let mut lines: Vec<Outline> = vec![];
    for piece in curve.pieces() {
        let round = match piece {
            Piece::Turn(Turn { center, x, y, rise: DVec3::ZERO, .. }) => {
                Some(Round { center: *center, x: *x, y: *y })
            }
            _ => None,
        };
        let parts = piece.chords(tolerance).max(least(piece));
        let points = (0..=parts).map(|i| piece.at(f64::from(i) / f64::from(parts)));
        match lines.last_mut() {
            Some(line) if line.round.is_none() && round.is_none() => {
                line.points.extend(points.skip(1))
            }
            _ => lines.push(Outline { points: points.collect(), round }),
        }
    }
    lines
}

/// Lines at an angle, a pitch apart, one of them through the origin, as far as they are in a region; their number if
/// they are too many.
fn hatching(region: &Region, pitch: f64, angle: f64) -> Result<Vec<[DVec2; 2]>, f64> {
    let along = DVec2::new(cos_deg(angle), sin_deg(angle));
    let across = along.perp();
    let edges: Vec<_> = region.contours().flat_map(|contour| contour.edges()).collect();
    let heights = || edges.iter().map(|edge| across.dot(edge.from) / pitch);
    let (low, high) = (heights().fold(f64::MAX, f64::min), heights().fold(f64::MIN, f64::max));
    if edges.is_empty() {
        return Ok(vec![]);
    }
    if high - low > MOST_LINES {
        return Err((high - low).ceil());
    }
    let (mut lines, mut at) = (vec![], low.ceil());
    while at <= high {
        let mut cuts: Vec<f64> = edges
            .iter()
            .filter_map(|edge| {
                let [s, t] = [edge.from, edge.to].map(|p| across.dot(p) / pitch - at);
                let crosses = (s > 0.0) != (t > 0.0);
                crosses.then(|| along.dot(edge.from.lerp(edge.to, s / (s - t))))
            })
            .collect();
        cuts.sort_by(f64::total_cmp);
        let line = |pair: &[f64]| [pair[0], pair[1]].map(|x| along * x + across * (at * pitch));
        lines.extend(cuts.chunks_exact(2).filter(|pair| pair[0] < pair[1]).map(line));
        at += 1.0;
    }
    Ok(lines)
}

/// The contours of a plane figure in space, each cut where one of its curves ends.
fn outlines(figure: &Figure) -> Vec<Outline> {
    let lines = figure.region.contours().flat_map(contour_lines);
    lines.map(|line| line.placed(&figure.frame)).collect()
}

/// Centre and radius.
type Circle = (DVec2, f64);

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
    let mut lines: Vec<(Option<Circle>, Vec<DVec3>)> = vec![];
    for i in (0..edges.len()).map(|i| (start + i) % edges.len()) {
        let (on, to) = (circle(edges[i].curve), edges[i].to.extend(0.0));
        match lines.last_mut() {
            Some((last, points)) if *last == on => points.push(to),
            _ => lines.push((on, vec![edges[i].from.extend(0.0), to])),
        }
    }
    let outline = |(on, points): (Option<Circle>, _)| {
        let round = on.map(|(center, radius)| Round {
            center: center.extend(0.0),
            x: DVec3::X * radius,
            y: DVec3::Y * radius,
        });
        Outline { points, round }
    };
    lines.into_iter().map(outline).collect()
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::geom::Piece;

    #[test]
    fn hatching_fills_a_square_and_leaves_its_hole() {
        let square = |r: f64| {
            Contour::polygon(
                [(-r, -r), (r, -r), (r, r), (-r, r)].map(|(x, y)| dvec2(x, y)).to_vec(),
            )
        };
        let outer = square(5.0);
        let region = Region { pieces: vec![Piece { outer, holes: vec![square(2.0)] }] };
        let lines = hatching(&region, 3.0, 0.0).expect("few lines");
        let length: f64 = lines.iter().map(|[p, q]| p.distance(*q)).sum();
        assert_eq!((lines.len(), length), (4, 10.0 + 10.0 + 6.0));
        assert_eq!(hatching(&region, 1e-4, 0.0), Err(100_000.0));
    }

    #[test]
    fn runs_of_a_contour_along_a_circle_are_arcs() {
        let circle = EdgeCurve::Circle { center: DVec2::ZERO, radius: 5.0 };
        let points = [(5.0, 0.0), (4.0, 3.0), (3.0, 4.0), (0.0, 5.0), (0.0, 0.0)];
        let contour = Contour {
            points: points.map(|(x, y)| dvec2(x, y)).to_vec(),
            curves: vec![circle, circle, circle, EdgeCurve::Line, EdgeCurve::Line],
        };
        let lines = contour_lines(&contour);
        let sizes: Vec<_> = lines.iter().map(|l| (l.points.len(), l.round.is_some())).collect();
        assert_eq!(sizes, [(4, true), (3, false)]);
    }
}
