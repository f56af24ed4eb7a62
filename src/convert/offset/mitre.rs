//! The point at which the offsets of several planes meet.

use glam::DVec3;

/// Directions that add less than this to the others, as a sine, say nothing of their own.
const SPAN: f64 = 1e-7;

/// The shortest m with n m = 1 for all of some unit normals n, in the sense of least squares where they do
/// not agree, and the largest |n m - 1|.
pub(super) fn mitre(normals: &[DVec3]) -> (DVec3, f64) {
    let basis = basis(normals);
    let flat = |n: DVec3| DVec3::from([0, 1, 2].map(|k| basis.get(k).map_or(0.0, |b| b.dot(n))));
    // Normal equations in the span of the normals.
    let (mut rows, mut right) = ([DVec3::ZERO; 3], DVec3::ZERO);
    for n in normals.iter().map(|&n| flat(n)) {
        (0..3).for_each(|k| rows[k] += n * n[k]);
        right += n;
    }
    let (rows, right) = (&rows[..basis.len()], right);
    let solved = solve(rows, right);
    let m = basis.iter().enumerate().map(|(k, b)| *b * solved[k]).sum::<DVec3>();
    // One step of refinement against the normals themselves.
    let rest = normals.iter().fold(DVec3::ZERO, |sum, n| sum + flat(*n) * (1.0 - n.dot(m)));
    let step = solve(rows, rest);
    let m = m + basis.iter().enumerate().map(|(k, b)| *b * step[k]).sum::<DVec3>();
    let off = normals.iter().map(|n| (n.dot(m) - 1.0).abs()).fold(0.0, f64::max);
    (m, off)
}

/// Orthogonal unit directions that span the normals: the first, and those farthest from the span so far.
fn basis(normals: &[DVec3]) -> Vec<DVec3> {
    let mut basis: Vec<DVec3> = normals.first().copied().into_iter().collect();
    while basis.len() < 3 {
        let rest = |n: &DVec3| basis.iter().fold(*n, |rest, b| rest - *b * b.dot(rest));
        let farthest = normals.iter().map(rest).fold(DVec3::ZERO, |best, r| {
            if r.length_squared() > best.length_squared() { r } else { best }
        });
        if farthest.length() <= SPAN {
            break;
        }
        basis.push(farthest.normalize());
    }
    basis
}

/// Solves a symmetric system of up to three equations by elimination; rows are used up to their number.
fn solve(rows: &[DVec3], right: DVec3) -> DVec3 {
    let n = rows.len();
    let (mut a, mut b) = ([DVec3::ZERO; 3], right);
    a[..n].copy_from_slice(rows);
    for k in 0..n {
        for i in k + 1..n {
            let share = a[i][k] / a[k][k];
            let row = a[k];
            a[i] -= row * share;
            b[i] -= b[k] * share;
        }
    }
    let mut x = DVec3::ZERO;
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k][j] * x[j]).sum();
        x[k] = (b[k] - known) / a[k][k];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_meet_where_their_offsets_do() {
        let (m, off) = mitre(&[DVec3::X, DVec3::Y, DVec3::Z]);
        assert!(m.distance(DVec3::ONE) < 1e-15 && off < 1e-15);
        let (m, off) = mitre(&[DVec3::X, DVec3::Y, DVec3::X]);
        assert!(m.distance(DVec3::new(1.0, 1.0, 0.0)) < 1e-15 && off < 1e-15);
        let lean = DVec3::new(1.0, 1e-5, 0.0).normalize();
        let (m, off) = mitre(&[DVec3::X, lean]);
        assert!(off < 1e-15 && (m.length() - 1.0).abs() < 1e-9);
    }
}
