//! The ellipse through points, if there is one.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DMat2, DVec2, dvec2};

/// The unknowns of a conic with one coefficient fixed by its size.
const UNKNOWNS: usize = 6;

/// An ellipse is told by points that reach over this part of it or more: of less, its size is rounding.
const LARGEST: f64 = 100.0;

/// An ellipse: center + cos(t) major + sin(t) minor.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Ellipse {
    /// Centre.
    pub center: DVec2,
    /// The longer half axis.
    pub major: DVec2,
    /// The shorter half axis, a quarter turn counter-clockwise from `major`.
    pub minor: DVec2,
}

impl Ellipse {
    /// The ellipse through all points up to a tolerance. `None` if there are fewer than five, if they lie on
    /// another conic or on none, if they do not follow each other around it, or if it is too flat or too large
    /// for them to tell it from a line.
    ///
    /// Five of the points, evenly spread in their order, make the conic; the others are held against it.
    pub fn through(points: &[DVec2], tolerance: f64) -> Option<Ellipse> {
        if points.len() < UNKNOWNS - 1 {
            return None;
        }
        let middle = points.iter().sum::<DVec2>() / points.len() as f64;
        let size = points.iter().map(|p| p.distance(middle)).fold(0.0, f64::max);
        let chosen = (0..5).map(|i| (points[i * points.len() / 5] - middle) / size);
        let coefficients = conic(chosen)?;
        let fits = |p: &DVec2| off(&coefficients, (*p - middle) / size) * size <= tolerance;
        if !points.iter().all(fits) {
            return None;
        }
        let ellipse = axes(&coefficients)?;
        let scaled = Ellipse {
            center: ellipse.center * size + middle,
            major: ellipse.major * size,
            minor: ellipse.minor * size,
        };
        let is_told = scaled.minor.length() > tolerance && scaled.major.length() < LARGEST * size;
        let found = is_told && scaled.is_followed_by(points, tolerance);
        found.then(|| scaled.normal(tolerance))
    }

    /// Whether points follow each other around it: each after the one before, by less than a quarter turn.
    /// Points of two lines side by side are on an ellipse too, a very long one.
    fn is_followed_by(&self, points: &[DVec2], tolerance: f64) -> bool {
        let steps = points.windows(2).filter(|pair| pair[0].distance(pair[1]) > tolerance);
        let turns: Vec<f64> = steps
            .map(|pair| {
                let turn = self.parameter(pair[1]) - self.parameter(pair[0]);
                turn - TAU * (turn / TAU).round()
            })
            .collect();
        let forwards = turns.iter().sum::<f64>() > 0.0;
        turns.iter().all(|&turn| (turn > 0.0) == forwards && turn.abs() < FRAC_PI_2)
    }

    /// The same ellipse with axes that do not depend on rounding: a circle along x, others to the right.
    fn normal(self, tolerance: f64) -> Ellipse {
        let (a, b) = (self.major.length(), self.minor.length());
        if a - b <= tolerance {
            let radius = (a + b) / 2.0;
            return Ellipse { major: DVec2::X * radius, minor: DVec2::Y * radius, ..self };
        }
        let upright = self.major.x.abs() <= tolerance;
        let turned = if upright { self.major.y < 0.0 } else { self.major.x < 0.0 };
        let major = if turned { -self.major } else { self.major };
        Ellipse { major, minor: major.perp() * (b / a), ..self }
    }

    /// The parameter of a point near it, -pi to pi.
    pub fn parameter(&self, p: DVec2) -> f64 {
        let v = p - self.center;
        let (x, y) = (v.dot(self.major), v.dot(self.minor));
        libm::atan2(y / self.minor.length_squared(), x / self.major.length_squared())
    }

    /// The point of a parameter.
    pub fn at(&self, t: f64) -> DVec2 {
        let (sin, cos) = libm::sincos(t);
        self.center + self.major * cos + self.minor * sin
    }
}

/// The coefficients of x^2, xy, y^2, x, y, 1 of the conic through five points, the largest of them 1.
fn conic(points: impl Iterator<Item = DVec2>) -> Option<[f64; UNKNOWNS]> {
    let mut rows: Vec<[f64; UNKNOWNS]> =
        points.map(|p| [p.x * p.x, p.x * p.y, p.y * p.y, p.x, p.y, 1.0]).collect();
    // Gauss with full pivoting; the column without a pivot is the free one.
    let mut pivots: Vec<usize> = vec![];
    for step in 0..rows.len() {
        let (row, column) = largest(&rows, step, &pivots)?;
        rows.swap(step, row);
        pivots.push(column);
        let pivot = rows[step];
        for (i, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != step) {
            let factor = row[column] / pivot[column];
            (0..UNKNOWNS).for_each(|k| row[k] -= factor * pivot[k]);
            debug_assert!(i != step);
        }
    }
    let free = (0..UNKNOWNS).find(|c| !pivots.contains(c))?;
    let mut found = [0.0; UNKNOWNS];
    found[free] = 1.0;
    for (row, &column) in rows.iter().zip(&pivots) {
        found[column] = -row[free] / row[column];
    }
    Some(found)
}

/// The place of the largest entry of the rows and columns that are left.
fn largest(rows: &[[f64; UNKNOWNS]], step: usize, used: &[usize]) -> Option<(usize, usize)> {
    let places = (step..rows.len()).flat_map(|r| (0..UNKNOWNS).map(move |c| (r, c)));
    let free = places.filter(|(_, c)| !used.contains(c));
    let best = free.max_by(|a, b| rows[a.0][a.1].abs().total_cmp(&rows[b.0][b.1].abs()))?;
    (rows[best.0][best.1] != 0.0).then_some(best)
}

/// About how far a point is from a conic.
fn off(c: &[f64; UNKNOWNS], p: DVec2) -> f64 {
    let value =
        c[0] * p.x * p.x + c[1] * p.x * p.y + c[2] * p.y * p.y + c[3] * p.x + c[4] * p.y + c[5];
    let slope = dvec2(2.0 * c[0] * p.x + c[1] * p.y + c[3], c[1] * p.x + 2.0 * c[2] * p.y + c[4]);
    value.abs() / slope.length()
}

/// Centre and axes of a conic that is an ellipse.
fn axes(c: &[f64; UNKNOWNS]) -> Option<Ellipse> {
    let matrix = DMat2::from_cols(dvec2(c[0], c[1] / 2.0), dvec2(c[1] / 2.0, c[2]));
    let determinant = matrix.determinant();
    if determinant <= 0.0 {
        return None;
    }
    let center = matrix.inverse() * (dvec2(c[3], c[4]) / -2.0);
    let level = center.dot(matrix * center) - c[5];
    let (half, spread) = ((c[0] + c[2]) / 2.0, dvec2((c[0] - c[2]) / 2.0, c[1] / 2.0));
    let split = spread.length();
    // The direction of the larger eigenvalue in size is the minor axis.
    let [large, small] =
        if half > 0.0 { [half + split, half - split] } else { [half - split, half + split] };
    let turn = libm::atan2(spread.y, spread.x) / 2.0;
    let (sin, cos) = libm::sincos(turn);
    let upper = dvec2(cos, sin);
    let steep = if half > 0.0 { upper } else { upper.perp() };
    let (a, b) = ((level / small).sqrt(), (level / large).sqrt());
    let major = -steep.perp() * a;
    (a.is_finite() && b > 0.0).then(|| Ellipse { center, major, minor: major.perp() * (b / a) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ellipses_are_found_again() {
        let ellipse =
            Ellipse { center: dvec2(30.0, -7.0), major: dvec2(4.0, 3.0), minor: dvec2(-1.2, 1.6) };
        for (from, to) in [(0.0, 6.0), (1.0, 2.0), (3.0, 3.5)] {
            let at = |i: u32| ellipse.at(from + (to - from) * f64::from(i) / 20.0);
            let points: Vec<DVec2> = (0..=20).map(at).collect();
            let found = Ellipse::through(&points, 1e-7).expect("an ellipse");
            assert!(found.center.distance(ellipse.center) < 1e-4, "{found:?}");
            assert!(found.major.distance(ellipse.major) < 1e-4, "{found:?}");
            assert!(found.minor.distance(ellipse.minor) < 1e-4, "{found:?}");
            assert!(found.at(found.parameter(at(7))).distance(at(7)) < 1e-7);
        }
    }

    #[test]
    fn other_curves_are_refused() {
        let points = |f: fn(f64) -> DVec2| -> Vec<DVec2> {
            (0..30).map(|i| f(f64::from(i) / 10.0)).collect()
        };
        assert!(Ellipse::through(&points(|t| dvec2(t, t * t * t)), 1e-6).is_none());
        assert!(Ellipse::through(&points(|t| dvec2(t, t * t)), 1e-6).is_none());
        assert!(Ellipse::through(&points(|t| dvec2(t, 2.0 * t)), 1e-6).is_none());
        // There and back on two lines side by side.
        let hairpin: fn(f64) -> DVec2 =
            |t| dvec2(1.45 - (t - 1.45).abs(), f64::from(t > 1.45) + 1e-9 * t);
        assert!(Ellipse::through(&points(hairpin), 1e-6).is_none());
        let circle = Ellipse::through(&points(|t| dvec2(libm::sin(t), libm::cos(t))), 1e-6);
        assert!(circle.expect("a circle").major.distance(DVec2::X) < 1e-9);
    }
}
