//! Surfaces that a curve sweeps on straight and round ways.

use glam::{DVec3, dvec3};

use super::{SweepError, stations::stations};
use crate::geom::{
    Curve, CurvedGrid, Tolerance,
    trig::{cos_deg, sin_deg},
};

/// The surface that a curve sweeps when it is moved by a vector, mm. Rows run along the curve.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::{geom::{Curve, Tolerance}, kernel::brep::sweep::extruded};
/// let bent = Curve::polyline(&[dvec3(0., 0., 0.), dvec3(3., 0., 0.), dvec3(3., 4., 0.)], false).unwrap();
/// assert_eq!(extruded(&bent, DVec3::Z, Tolerance::DEFAULT).unwrap().size(), [2, 3]);
/// ```
pub fn extruded(curve: &Curve, by: DVec3, tolerance: Tolerance) -> Result<CurvedGrid, SweepError> {
    let row = row(curve, tolerance);
    let rows = [row.clone(), row.into_iter().map(|p| p + by).collect()];
    Ok(CurvedGrid::new(&rows, false, curve.is_closed())?)
}

/// The surface that a curve in the xy plane sweeps when its y becomes z and it is turned about the z axis by an angle in
/// degrees, up to 360, counter-clockwise from +x.
///
/// ```
/// use glam::dvec3;
/// use katachi::{geom::{Curve, Tolerance}, kernel::brep::sweep::revolved};
/// let line = Curve::polyline(&[dvec3(3., 0., 0.), dvec3(3., 4., 0.)], false).unwrap();
/// let tube = revolved(&line, 360.0, Tolerance::DEFAULT).unwrap();
/// assert!(tube.points().iter().all(|p| (p.x.hypot(p.y) - 3.0).abs() < 1e-12));
/// ```
pub fn revolved(curve: &Curve, angle: f64, tolerance: Tolerance) -> Result<CurvedGrid, SweepError> {
    let half = tolerance.half();
    let row = row(curve, half);
    let turned = |part: f64| {
        let (s, c) = (sin_deg(angle * part), cos_deg(angle * part));
        Ok(row.iter().map(|p| dvec3(p.x * c, p.x * s, p.y)).collect())
    };
    let is_whole = angle == 360.0;
    let places: Vec<f64> = (0..=QUARTERS).map(|i| f64::from(i) / f64::from(QUARTERS)).collect();
    let all = stations(&places, false, half, &turned)?;
    let rows: Vec<Vec<DVec3>> = all.into_iter().map(|station| station.points).collect();
    let kept = rows.len() - usize::from(is_whole);
    Ok(CurvedGrid::new(&rows[..kept], is_whole, curve.is_closed())?)
}

/// Parts that a turn is cut into at first.
const QUARTERS: u32 = 4;

/// Points along a curve, the first of a closed one once.
fn row(curve: &Curve, tolerance: Tolerance) -> Vec<DVec3> {
    let mut points = curve.points(tolerance);
    if curve.is_closed() {
        points.pop();
    }
    points
}
