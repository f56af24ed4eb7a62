//! How close stations stand: facets between them keep within the tolerance of the surface.

use glam::DVec3;

use super::{MAX_FACETS, SweepError};
use crate::geom::Tolerance;

/// A station: its place on the way, and the points there.
#[derive(Clone, Debug)]
pub(super) struct Station {
    pub place: f64,
    pub points: Vec<DVec3>,
}

/// Parts that one step is cut into at most, and how often.
const MOST_PARTS: f64 = 64.0;
const DEEPEST: u32 = 12;

/// Where between two stations the surface is looked at.
const LOOKS: [f64; 3] = [0.5, 0.25, 0.75];

/// Stations from place to place, the first and the last included, so that facets between them keep within the tolerance of
/// the surface. Between two places given the surface must be so plain that it is not on the chord at all quarters of the way
/// unless it is straight. `ring` gives the points at a place, always as many; a closed ring's last point joins its first. Points of
/// one edge lie on a straight line at every place.
pub(super) fn stations(
    places: &[f64],
    is_closed: bool,
    tolerance: Tolerance,
    ring: &dyn Fn(f64) -> Result<Vec<DVec3>, SweepError>,
) -> Result<Vec<Station>, SweepError> {
    let at = |place: f64| ring(place).map(|points| Station { place, points });
    let mut found = vec![at(places[0])?];
    let mut open: Vec<(Station, u32)> = vec![];
    for &place in places[1..].iter().rev() {
        open.push((at(place)?, DEEPEST));
    }
    let mut facets = 0;
    while let Some((next, depth)) = open.pop() {
        let last = &found[found.len() - 1];
        let parts = parts(last, &next, is_closed, tolerance, ring)?;
        if parts <= 1.0 || depth == 0 {
            facets += 2 * next.points.len();
            if facets > MAX_FACETS {
                return Err(SweepError::TooManyFacets);
            }
            found.push(next);
            continue;
        }
        let (from, step) = (last.place, (next.place - last.place) / parts);
        open.push((next, depth - 1));
        for i in (1..parts as u32).rev() {
            open.push((at(from + step * f64::from(i))?, depth - 1));
        }
    }
    Ok(found)
}

/// Parts that the step between two stations needs, judged by what the surface is off by in it.
fn parts(
    a: &Station,
    b: &Station,
    is_closed: bool,
    tolerance: Tolerance,
    ring: &dyn Fn(f64) -> Result<Vec<DVec3>, SweepError>,
) -> Result<f64, SweepError> {
    let mm = tolerance.mm();
    let edges = a.points.len() - usize::from(!is_closed);
    let mut most = 1.0f64;
    for look in LOOKS {
        let between = ring(a.place + (b.place - a.place) * look)?;
        let chord = |j: usize| a.points[j].lerp(b.points[j], look);
        let bend = (0..between.len()).map(|j| between[j].distance(chord(j))).fold(0.0, f64::max);
        let mut off = bend;
        if look == LOOKS[0] {
            for j in 0..edges {
                let k = (j + 1) % a.points.len();
                let corners = [a.points[j], a.points[k], b.points[k], b.points[j]];
                off = off.max(fold(corners, between[j].midpoint(between[k])));
            }
        }
        if off > mm {
            // Bends shrink with the square of the step, what twist there is with the step.
            let twist = (off - bend) / mm;
            most = most.max((bend / mm).sqrt().max(twist).ceil().max(2.0));
            break;
        }
    }
    Ok(most.min(MOST_PARTS))
}

/// How far the middle of a cell is from its two triangles, which share the shorter diagonal.
fn fold([a, b, c, d]: [DVec3; 4], middle: DVec3) -> f64 {
    let straight = a.distance_squared(c) <= b.distance_squared(d);
    let on = if straight { a.midpoint(c) } else { b.midpoint(d) };
    let normal = (c - a).cross(d - b).normalize_or_zero();
    (middle - on).dot(normal).abs()
}
