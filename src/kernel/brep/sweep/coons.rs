//! Surfaces between four curves.

use glam::DVec3;

use super::{SweepError, stations::stations};
use crate::geom::{Curve, CurvedGrid, Tolerance};

/// Ends of curves nearer than this part of their length are one.
const MEETING: f64 = 1e-6;

/// The surface that four curves bound, which follow one another around it, each either way: Coons's patch, the sum of the
/// ruled surfaces between opposite curves less the one that is bilinear in the corners. Opposite curves with as many pieces
/// are matched piece by piece, others by the parts of their length. Rows run along the first and the third curve.
///
/// Fails where the curves do not meet.
///
/// ```
/// use glam::dvec3;
/// use katachi::{geom::{Curve, Tolerance}, kernel::brep::sweep::coons};
/// let line = |a, b| Curve::polyline(&[a, b], false).unwrap();
/// let corners = [dvec3(0., 0., 0.), dvec3(4., 0., 1.), dvec3(4., 4., 0.), dvec3(0., 4., 1.)];
/// let sides: Vec<Curve> = (0..4).map(|i| line(corners[i], corners[(i + 1) % 4])).collect();
/// let saddle = coons([&sides[0], &sides[1], &sides[2], &sides[3]], Tolerance::DEFAULT).unwrap();
/// assert!(saddle.points().iter().all(|p| {
///     let (u, v) = (p.x / 4.0, p.y / 4.0);
///     (p.z - (u * (1.0 - v) + v * (1.0 - u))).abs() < 1e-12
/// }));
/// ```
pub fn coons(curves: [&Curve; 4], tolerance: Tolerance) -> Result<CurvedGrid, SweepError> {
    let patch = Patch::new(curves)?;
    let half = tolerance.half();
    let across = patch.sides[1].breaks(&patch.sides[3]);
    let along = patch.sides[0].breaks(&patch.sides[2]);
    // First the places along the rows, judged on all four curves' own breaks across; then the rows.
    let looks: Vec<Pair> = across_points(&across).map(|v| patch.across(v)).collect();
    let column = |u: f64| {
        let own = patch.along(u);
        Ok(looks.iter().map(|other| patch.blend(&own, other)).collect())
    };
    let columns: Vec<Pair> =
        stations(&along, false, half, &column)?.iter().map(|s| patch.along(s.place)).collect();
    let row = |v: f64| {
        let own = patch.across(v);
        Ok(columns.iter().map(|other| patch.blend(other, &own)).collect())
    };
    let rows = stations(&across, false, half, &row)?;
    let rows: Vec<Vec<DVec3>> = rows.into_iter().map(|station| station.points).collect();
    Ok(CurvedGrid::new(&rows, false, false)?)
}

/// Parts of a step across that are looked at.
const LOOKS: u32 = 8;

fn across_points(breaks: &[f64]) -> impl Iterator<Item = f64> {
    let last = breaks[breaks.len() - 1];
    let steps = breaks.windows(2).flat_map(|pair| {
        let (from, to) = (pair[0], pair[1]);
        (0..LOOKS).map(move |i| from + (to - from) * f64::from(i) / f64::from(LOOKS))
    });
    steps.chain([last])
}

/// A side with its own measure: parts of the pieces, or of the length.
struct Side {
    curve: Curve,
    by_length: bool,
}

impl Side {
    /// The point at a part, 0 to 1.
    fn at(&self, part: f64) -> DVec3 {
        let count = self.curve.pieces().len() as f64;
        match self.by_length {
            true => self.curve.at(self.curve.place(part)),
            false => self.curve.at(part * count),
        }
    }

    /// Where pieces of this side and the opposite one end, and quarters of turns.
    fn breaks(&self, other: &Side) -> Vec<f64> {
        let own = |side: &Side| -> Vec<f64> {
            let count = side.curve.pieces().len();
            let part = |place: f64| match side.by_length {
                true => side.curve.part(place),
                false => place / count as f64,
            };
            let places = side.curve.plain_places();
            places[1..places.len() - 1].iter().map(|place| part(*place)).collect()
        };
        let mut breaks: Vec<f64> =
            [0.0, 1.0].into_iter().chain(own(self)).chain(own(other)).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| *a - *b <= MEETING);
        breaks
    }
}

/// Four sides: the first and the third run one way, the second and the fourth the other.
struct Patch {
    sides: [Side; 4],
    /// Around it, from the start of the first.
    corners: [DVec3; 4],
}

impl Patch {
    fn new(curves: [&Curve; 4]) -> Result<Patch, SweepError> {
        let end = |curve: &Curve| curve.at(curve.pieces().len() as f64);
        let near = MEETING * curves.iter().map(|curve| curve.length()).sum::<f64>();
        let meets = |p: DVec3, curve: &Curve| p.distance(curve.at(0.0)).min(p.distance(end(curve)));
        let first = match meets(end(curves[0]), curves[1]) <= meets(curves[0].at(0.0), curves[1]) {
            true => curves[0].clone(),
            false => curves[0].reversed(),
        };
        let mut around = vec![first];
        for (number, curve) in (1..).zip(&curves[1..]) {
            let at = end(&around[around.len() - 1]);
            let [ahead, back] = [curve.at(0.0), end(curve)].map(|p| p.distance(at));
            if ahead.min(back) > near {
                let start = if ahead <= back { curve.at(0.0) } else { end(curve) };
                return Err(SweepError::Open { number, gap: ahead.min(back), at: start });
            }
            around.push(if ahead <= back { (*curve).clone() } else { curve.reversed() });
        }
        let gap = end(&around[3]).distance(around[0].at(0.0));
        if gap > near {
            return Err(SweepError::Open { number: 0, gap, at: around[0].at(0.0) });
        }
        let (third, fourth) = (around[2].reversed(), around[3].reversed());
        let differ = |a: &Curve, b: &Curve| a.pieces().len() != b.pieces().len();
        let by_length = [differ(&around[0], &third), differ(&around[1], &fourth)];
        let [first, second] = [around[0].clone(), around[1].clone()];
        let side = |curve: Curve, by_length: bool| Side { curve, by_length };
        let sides = [
            side(first, by_length[0]),
            side(second, by_length[1]),
            side(third, by_length[0]),
            side(fourth, by_length[1]),
        ];
        let [low, high] = [0, 2].map(|i: usize| [0.0, 1.0].map(|u| sides[i].at(u)));
        Ok(Patch { sides, corners: [low[0], low[1], high[1], high[0]] })
    }

    /// The points of the first and the third side.
    fn along(&self, u: f64) -> Pair {
        Pair { part: u, points: [self.sides[0].at(u), self.sides[2].at(u)] }
    }

    /// The points of the fourth and the second side.
    fn across(&self, v: f64) -> Pair {
        Pair { part: v, points: [self.sides[3].at(v), self.sides[1].at(v)] }
    }

    /// Coons's sum: u along the first side, v along the second.
    fn blend(&self, along: &Pair, across: &Pair) -> DVec3 {
        let (u, v) = (along.part, across.part);
        let [low, high] = along.points;
        let [left, right] = across.points;
        let [a, b, c, d] = self.corners;
        let ruled = low.lerp(high, v) + left.lerp(right, u);
        ruled - a.lerp(b, u).lerp(d.lerp(c, u), v)
    }
}

/// A part of two opposite sides, and their points there.
struct Pair {
    part: f64,
    points: [DVec3; 2],
}
