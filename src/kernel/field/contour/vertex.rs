//! Where the points of the surface lie.

use glam::{DMat3, DVec3};

use super::{Level, octree::Octree};
use crate::geom::Bounds;

/// Evaluations that a root may take.
const ROOT_STEPS: usize = 16;
/// A share of the tolerance that a root may be off: so small that flat faces come out flat.
const ROOT: f64 = 1e-7;
/// Steps towards the surface.
const NEWTON_STEPS: usize = 4;
/// A share of the tolerance that is as good as none.
const NEGLIGIBLE: f64 = 1.0 / 64.0;
/// Directions in which planes disagree by less than this, relative to the main one, are taken for curvature.
const FLAT: f64 = 0.03;
/// Points stay away from the faces of their cell by this share of its size.
const INSET: f64 = 1e-3;

/// A point of the surface with its normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub point: DVec3,
    pub normal: DVec3,
}

/// Where the surface crosses an edge whose ends have values of different sign.
///
/// Regula falsi; an end that stays twice has its value halved (the Illinois rule).
pub(super) fn root<L: Level>(field: &L, ends: [(DVec3, f64); 2], tolerance: f64) -> Sample {
    let [(a, mut fa), (b, mut fb)] = ends;
    let (mut ta, mut tb, mut t) = (0.0, 1.0, 0.5);
    let (mut kept, slope) = (0, (fa - fb).abs() / a.distance(b));
    let enough = ROOT * tolerance * if slope.is_finite() { slope } else { 0.0 };
    for _ in 0..ROOT_STEPS {
        let guess = ta + (tb - ta) * fa / (fa - fb);
        t = if guess.is_finite() { guess } else { (ta + tb) / 2.0 };
        let value = field.value(a.lerp(b, t));
        if value.abs() <= enough || value == 0.0 {
            break;
        }
        if (value <= 0.0) == (fa <= 0.0) {
            fb = if kept == 1 { fb / 2.0 } else { fb };
            (ta, fa, kept) = (t, value, 1);
        } else {
            fa = if kept == 2 { fa / 2.0 } else { fa };
            (tb, fb, kept) = (t, value, 2);
        }
    }
    let point = a.lerp(b, t.clamp(INSET, 1.0 - INSET));
    Sample { point, normal: field.gradient(point).normalize_or_zero() }
}

/// The point of a piece of the surface within a leaf: on the planes of its samples where these meet in an edge
/// or a corner, otherwise on the surface near their middle.
pub(super) fn vertex<L: Level>(
    tree: &Octree<L>,
    cell: u32,
    samples: impl Iterator<Item = Sample> + Clone,
    tolerance: f64,
) -> DVec3 {
    let (field, bounds) = (&tree.cells[cell as usize].field, inset(&tree.bounds(cell)));
    let count = samples.clone().count().max(1) as f64;
    let middle = samples.clone().map(|s| s.point).sum::<DVec3>() / count;
    let meeting = meeting(samples, middle).clamp(bounds.min, bounds.max);
    let allowed = tolerance / 4.0;
    if field.off(meeting) <= NEGLIGIBLE * tolerance {
        return meeting;
    }
    let tried = [meeting, middle].map(|p| towards(field, p, &bounds, tolerance));
    let good = tried.into_iter().find(|&p| field.off(p) <= allowed);
    let nearer = |p: &DVec3, q: &DVec3| field.off(*p).total_cmp(&field.off(*q));
    good.or_else(|| tried.into_iter().min_by(nearer)).unwrap_or(middle)
}

/// The box less a rim.
pub(super) fn inset(b: &Bounds) -> Bounds {
    let rim = (b.max - b.min) * INSET;
    Bounds { min: b.min + rim, max: b.max - rim }
}

/// A point moved to the surface along its gradient, within a box; flat boxes keep it in their plane.
pub(super) fn towards<L: Level>(field: &L, from: DVec3, within: &Bounds, tolerance: f64) -> DVec3 {
    let free = DVec3::from([0, 1, 2].map(|i| f64::from(u8::from(within.max[i] > within.min[i]))));
    let mut p = from.clamp(within.min, within.max);
    for _ in 0..NEWTON_STEPS {
        if field.off(p) <= NEGLIGIBLE * tolerance {
            break;
        }
        let slope = field.gradient(p) * free;
        let step = slope * (field.value(p) / slope.length_squared());
        let next = (p - step).clamp(within.min, within.max);
        if !step.is_finite() || next == p {
            break;
        }
        p = next;
    }
    p
}

/// The point nearest to the planes of some samples; of many such points the one nearest to the middle.
fn meeting(samples: impl Iterator<Item = Sample>, middle: DVec3) -> DVec3 {
    let (mut squares, mut sides) = (DMat3::ZERO, DVec3::ZERO);
    for Sample { point, normal: n } in samples {
        squares += DMat3::from_cols(n * n.x, n * n.y, n * n.z);
        sides += n * n.dot(point - middle);
    }
    let (values, axes) = eigen(squares);
    let largest = values.max_element();
    let along = |i: usize| {
        let axis = axes.col(i);
        if values[i] > FLAT * largest { axis * (axis.dot(sides) / values[i]) } else { DVec3::ZERO }
    };
    middle + along(0) + along(1) + along(2)
}

/// Eigenvalues and eigenvectors of a symmetric matrix, by Jacobi's rotations.
fn eigen(matrix: DMat3) -> (DVec3, DMat3) {
    /// Each sweep squares what is off the diagonal.
    const SWEEPS: usize = 6;
    let (mut m, mut axes) = (matrix, DMat3::IDENTITY);
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = m.col(q)[p];
            if off == 0.0 {
                continue;
            }
            let theta = (m.col(q)[q] - m.col(p)[p]) / (2.0 * off);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(p)[p] = c;
            turn.col_mut(q)[q] = c;
            turn.col_mut(q)[p] = s;
            turn.col_mut(p)[q] = -s;
            m = turn.transpose() * m * turn;
            axes *= turn;
        }
    }
    (DVec3::new(m.col(0).x, m.col(1).y, m.col(2).z), axes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_planes_meet_in_their_corner() {
        let plane = |normal: DVec3, point: DVec3| Sample { point, normal };
        let corner = DVec3::new(0.3, -0.2, 0.7);
        let normals = [DVec3::X, DVec3::new(0.6, 0.8, 0.0), DVec3::new(0.0, 0.6, -0.8)];
        let samples = normals.map(|n| plane(n, corner + n.any_orthonormal_vector() * 0.4));
        let found = meeting(samples.into_iter(), DVec3::ZERO);
        assert!(found.distance(corner) < 1e-12, "{found}");
        let one = meeting([plane(DVec3::Z, corner)].into_iter(), DVec3::ZERO);
        assert!(one.distance(DVec3::Z * 0.7) < 1e-12);
    }
}
