//! The point of a curve that is nearest to a point.

use glam::DVec3;

use super::{Curve, Piece};

/// Parts of a piece that are looked at one by one.
const PARTS: u32 = 32;
/// Steps of Newton's method at most.
const STEPS: usize = 40;
/// A place is found when it moves by less.
const FOUND: f64 = 1e-15;

impl Curve {
    /// The place nearest to a point: the best of those that Newton's method finds from the nearest of each piece's equal
    /// parts and its neighbours.
    ///
    /// ```
    /// use glam::dvec3;
    /// use katachi::geom::Curve;
    /// let line = Curve::polyline(&[dvec3(0., 0., 0.), dvec3(8., 0., 0.)], false).unwrap();
    /// assert_eq!(line.nearest(dvec3(2., 5., 0.)), 0.25);
    /// ```
    pub fn nearest(&self, p: DVec3) -> f64 {
        let distance = |place: f64| self.at(place).distance_squared(p);
        let found = (0..self.pieces.len())
            .flat_map(|i| candidates(&self.pieces[i], p).map(move |s| i as f64 + s));
        found.min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(0.0)
    }
}

/// Places on a piece that may be nearest.
fn candidates(piece: &Piece, p: DVec3) -> impl Iterator<Item = f64> {
    let turns = match piece {
        Piece::Turn(turn) => ((turn.to - turn.from).abs() / 360.0).ceil().clamp(1.0, 1e4) as u32,
        _ => 1,
    };
    let parts = PARTS * turns;
    let part = |i: u32| f64::from(i) / f64::from(parts);
    let distances: Vec<f64> = (0..=parts).map(|i| piece.at(part(i)).distance_squared(p)).collect();
    let is_low = |i: &u32| {
        let i = *i as usize;
        let near = [i.checked_sub(1), Some(i + 1)].into_iter().flatten();
        near.filter_map(|j| distances.get(j)).all(|d| *d >= distances[i])
    };
    let low: Vec<u32> = (0..=parts).filter(is_low).collect();
    let half = 1.0 / f64::from(parts);
    let refined =
        |i: u32| refined(piece, p, [(part(i) - half).max(0.0), (part(i) + half).min(1.0)]);
    let found: Vec<f64> = low.into_iter().map(refined).collect();
    found.into_iter()
}

/// The nearest place within bounds: Newton's method, halving where it leaves them.
fn refined(piece: &Piece, p: DVec3, [mut low, mut high]: [f64; 2]) -> f64 {
    let mut s = (low + high) / 2.0;
    for _ in 0..STEPS {
        let jet = piece.jet(s);
        let away = jet.point - p;
        let slope = away.dot(jet.first);
        if slope > 0.0 {
            high = s
        } else {
            low = s
        }
        let bend = jet.first.length_squared() + away.dot(jet.second);
        let step = s - slope / bend;
        let next =
            if bend > 0.0 && step >= low && step <= high { step } else { (low + high) / 2.0 };
        if (next - s).abs() <= FOUND {
            return next;
        }
        s = next;
    }
    s
}
