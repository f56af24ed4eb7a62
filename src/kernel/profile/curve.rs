//! Profiles bounded by a curve.

use std::collections::BTreeMap;

use glam::DVec2;

use super::{ProfileError, polygon};
use crate::geom::{
    Curve, EdgeCurve, Region, Tolerance,
    curve::{Piece, Turn},
    flatten::MOST_CHORDS,
};

/// What a closed curve in the xy plane encloses, by chords that keep within the tolerance. Edges know the circles they stand
/// for, and other pieces that run on smoothly as one smooth curve.
///
/// # Errors
/// A curve that crosses itself, lies on a line, or needs too many chords.
///
/// ```
/// use glam::dvec3;
/// use katachi::{geom::{Curve, Tolerance}, kernel::profile::enclosed};
/// let corners = [dvec3(0., 0., 0.), dvec3(3., 0., 0.), dvec3(0., 4., 0.)];
/// let triangle = Curve::polyline(&corners, true).unwrap();
/// assert_eq!(enclosed(&triangle, Tolerance::DEFAULT).unwrap().area(), 6.0);
/// ```
pub fn enclosed(curve: &Curve, tolerance: Tolerance) -> Result<Region, ProfileError> {
    let needed = curve.pieces().iter().map(|piece| piece.chords(tolerance)).max().unwrap_or(1);
    if needed > MOST_CHORDS {
        return Err(ProfileError::FineCurve { needed });
    }
    let mut points: Vec<DVec2> = vec![];
    let mut curves: Vec<EdgeCurve> = vec![];
    let mut number = 0;
    for (i, piece) in curve.pieces().iter().enumerate() {
        number += u32::from(!curve.is_smooth_at(i));
        let chords = piece.chords(tolerance);
        let known = known(piece).unwrap_or(EdgeCurve::Smooth(number));
        for k in 0..chords {
            points.push(piece.at(f64::from(k) / f64::from(chords)).truncate());
            curves.push(known);
        }
    }
    let mut region = polygon(&points, &[])?;
    let next = points.iter().cycle().skip(1);
    let key = |a: DVec2, b: DVec2| {
        let bits = |p: DVec2| p.to_array().map(f64::to_bits);
        (bits(a).min(bits(b)), bits(a).max(bits(b)))
    };
    let known: BTreeMap<_, _> =
        points.iter().zip(next).zip(&curves).map(|((a, b), curve)| (key(*a, *b), *curve)).collect();
    for piece in &mut region.pieces {
        for contour in std::iter::once(&mut piece.outer).chain(&mut piece.holes) {
            let found: Vec<EdgeCurve> = contour
                .edges()
                .map(|e| known.get(&key(e.from, e.to)).copied().unwrap_or(EdgeCurve::Line))
                .collect();
            contour.curves = found;
        }
    }
    Ok(region)
}

/// A straight edge, or the circle of an arc.
fn known(piece: &Piece) -> Option<EdgeCurve> {
    match piece {
        Piece::Line(_) => Some(EdgeCurve::Line),
        Piece::Turn(turn) if turn.is_circular() => {
            let Turn { center, x, .. } = turn;
            Some(EdgeCurve::Circle { center: center.truncate(), radius: x.length() })
        }
        _ => None,
    }
}
