//! Curves through and along points.

use glam::DVec3;

use super::{Curve, CurveError, Piece, Turn, check};

impl Curve {
    /// The smooth curve along a control polygon: between the middles of its edges quarters of ellipses that touch the
    /// edges there; an open one starts and ends at its end points.
    ///
    /// # Paper
    /// METHODS 4.2.
    ///
    /// ```
    /// use glam::dvec3;
    /// use katachi::geom::Curve;
    /// let square = [dvec3(5., 5., 0.), dvec3(-5., 5., 0.), dvec3(-5., -5., 0.), dvec3(5., -5., 0.)];
    /// let circle = Curve::smooth(&square, true).unwrap();
    /// assert!((circle.length() / std::f64::consts::TAU - 5.0).abs() < 1e-12);
    /// ```
    pub fn smooth(points: &[DVec3], closed: bool) -> Result<Curve, CurveError> {
        check(points, if closed { 3 } else { 2 }, closed)?;
        let count = points.len();
        let middle = |i: usize, j: usize| points[i].midpoint(points[j]);
        let pieces = if closed {
            let around = |i: usize| {
                let (before, after) = ((i + count - 1) % count, (i + 1) % count);
                conic([middle(before, i), points[i], middle(i, after)])
            };
            (0..count).map(around).collect()
        } else if count == 2 {
            vec![Piece::Line([points[0], points[1]])]
        } else {
            let along = |i: usize| {
                let from = if i == 1 { points[0] } else { middle(i - 1, i) };
                let to = if i + 2 == count { points[count - 1] } else { middle(i, i + 1) };
                conic([from, points[i], to])
            };
            (1..count - 1).map(along).collect()
        };
        Ok(Curve::of(pieces, closed).with_vertices(points.to_vec()))
    }

    /// The cubic spline through points, its second derivative continuous over the lengths of the chords. An open one has
    /// no curvature at its ends, or the directions given there.
    ///
    /// ```
    /// use glam::dvec3;
    /// use katachi::geom::Curve;
    /// let wave = [dvec3(0., 0., 0.), dvec3(10., 5., 0.), dvec3(20., 0., 0.)];
    /// let spline = Curve::spline(&wave, false, [None; 2]).unwrap();
    /// assert_eq!(spline.at(1.0), wave[1]);
    /// assert!(spline.curvature(0.0).length() < 1e-15);
    /// ```
    pub fn spline(
        points: &[DVec3],
        closed: bool,
        directions: [Option<DVec3>; 2],
    ) -> Result<Curve, CurveError> {
        check(points, if closed { 3 } else { 2 }, closed)?;
        let mut points = points.to_vec();
        if closed {
            points.push(points[0]);
        }
        let steps: Vec<f64> = points.windows(2).map(|p| p[0].distance(p[1])).collect();
        let slopes = match closed {
            true => round_slopes(&points, &steps),
            false => slopes(&points, &steps, directions.map(|d| d.map(DVec3::normalize_or_zero))),
        };
        let piece = |i: usize| {
            let (a, b, third) = (points[i], points[i + 1], steps[i] / 3.0);
            Piece::Bezier(vec![a, a + slopes[i] * third, b - slopes[i + 1] * third, b])
        };
        Ok(Curve::of((0..steps.len()).map(piece).collect(), closed))
    }
}

/// The quarter of an ellipse from the first point to the last that touches the lines to the second there; a line if all
/// three are on one.
fn conic([from, control, to]: [DVec3; 3]) -> Piece {
    let (x, y) = (control - to, control - from);
    let center = from + to - control;
    if x.cross(y) == DVec3::ZERO && x.dot(y) <= 0.0 {
        return Piece::Line([from, to]);
    }
    Piece::Turn(Turn { center, x, y, rise: DVec3::ZERO, from: 0.0, to: 90.0 })
}

/// The slope at each point of a cubic spline whose knots are `steps` apart: given at an end, or such that the second
/// derivative is zero there.
pub fn slopes(points: &[DVec3], steps: &[f64], ends: [Option<DVec3>; 2]) -> Vec<DVec3> {
    let last = points.len() - 1;
    let chord = |i: usize| (points[i + 1] - points[i]) / steps[i];
    let mut rows: Vec<Row> = Vec::with_capacity(points.len());
    for i in 0..points.len() {
        rows.push(match i {
            0 => match ends[0] {
                Some(slope) => Row { below: 0.0, here: 1.0, above: 0.0, right: slope },
                None => Row { below: 0.0, here: 2.0, above: 1.0, right: chord(0) * 3.0 },
            },
            _ if i == last => match ends[1] {
                Some(slope) => Row { below: 0.0, here: 1.0, above: 0.0, right: slope },
                None => Row { below: 1.0, here: 2.0, above: 0.0, right: chord(last - 1) * 3.0 },
            },
            _ => inner([steps[i - 1], steps[i]], [chord(i - 1), chord(i)]),
        });
    }
    solved(rows)
}

/// The same for a closed spline whose last point is its first: the slopes are those that agree there. The equations of
/// an open spline are solved for two slopes at its ends, and the one for which the second derivatives agree lies on the
/// line through them (Sherman and Morrison's method, coordinate by coordinate the same).
fn round_slopes(points: &[DVec3], steps: &[f64]) -> Vec<DVec3> {
    let last = points.len() - 1;
    let bend = |slopes: &[DVec3]| {
        let chord = |i: usize| (points[i + 1] - points[i]) / steps[i];
        let start = (chord(0) * 3.0 - slopes[0] * 2.0 - slopes[1]) / steps[0];
        let end = (slopes[last - 1] + slopes[last] * 2.0 - chord(last - 1) * 3.0) / steps[last - 1];
        start - end
    };
    let with = |slope: DVec3| slopes(points, steps, [Some(slope); 2]);
    let [zero, one] = [with(DVec3::ZERO), with(DVec3::ONE)];
    let (b0, b1) = (bend(&zero), bend(&one));
    let share = b0 / (b0 - b1);
    zero.into_iter().zip(one).map(|(a, b)| a + (b - a) * share).collect()
}

/// An equation of a tridiagonal system.
struct Row {
    below: f64,
    here: f64,
    above: f64,
    right: DVec3,
}

/// The second derivatives of both sides agree at an inner point.
fn inner([before, after]: [f64; 2], [left, right]: [DVec3; 2]) -> Row {
    Row {
        below: after,
        here: 2.0 * (before + after),
        above: before,
        right: (left * after + right * before) * 3.0,
    }
}

/// Thomas's algorithm.
fn solved(mut rows: Vec<Row>) -> Vec<DVec3> {
    for i in 1..rows.len() {
        let factor = rows[i].below / rows[i - 1].here;
        rows[i].here -= factor * rows[i - 1].above;
        rows[i].right = rows[i].right - rows[i - 1].right * factor;
    }
    let mut found = vec![DVec3::ZERO; rows.len()];
    for i in (0..rows.len()).rev() {
        let after = found.get(i + 1).copied().unwrap_or(DVec3::ZERO);
        found[i] = (rows[i].right - after * rows[i].above) / rows[i].here;
    }
    found
}
