//! In which order points are inserted.

use glam::{DVec3, Vec3Swizzles};

use super::super::sphere::volume_sign;
use crate::geom::{Bounds, orient::orient2d};

/// Bits of each coordinate on the curve.
const BITS: u32 = 16;

/// The numbers of points along a Hilbert curve through their bounds: neighbours in the order are neighbours in
/// space.
pub(super) fn hilbert(points: &[DVec3]) -> Vec<u32> {
    let bounds = Bounds::of(points.iter().copied());
    let size = (bounds.max - bounds.min).max_element().max(1.0);
    let cells = f64::from((1u32 << BITS) - 1);
    let mut keyed: Vec<(u64, u32)> = (0..)
        .zip(points)
        .map(|(i, p)| {
            let cell = (*p - bounds.min) / size * cells;
            (along_curve(cell.to_array().map(|c| c as u32)), i)
        })
        .collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, i)| i).collect()
}

/// How far along the curve a cell is (J. Skilling, *Programming the Hilbert curve*, 2004).
fn along_curve(mut cell: [u32; 3]) -> u64 {
    let mut bit = 1 << (BITS - 1);
    while bit > 1 {
        let low = bit - 1;
        for i in 0..3 {
            if cell[i] & bit != 0 {
                cell[0] ^= low;
            } else {
                let swapped = (cell[0] ^ cell[i]) & low;
                cell[0] ^= swapped;
                cell[i] ^= swapped;
            }
        }
        bit >>= 1;
    }
    cell[1] ^= cell[0];
    cell[2] ^= cell[1];
    let flip = (0..BITS - 1)
        .rev()
        .fold(0, |flip, k| flip ^ if cell[2] >> (k + 1) & 1 == 1 { (1 << (k + 1)) - 1 } else { 0 });
    let cell = cell.map(|c| c ^ flip);
    (0..BITS)
        .rev()
        .fold(0, |key, k| cell.iter().fold(key, |key, c| key << 1 | u64::from(c >> k & 1)))
}

/// The first four points in an order that span a volume; `None` when all lie in one plane.
pub(super) fn spanning(points: &[DVec3], order: &[u32]) -> Option<[u32; 4]> {
    let p = |i: u32| points[i as usize];
    let mut rest = order.iter().copied();
    let a = rest.next()?;
    let b = rest.find(|&b| p(b) != p(a))?;
    let c = order.iter().copied().find(|&c| !on_line(p(a), p(b), p(c)))?;
    let d = order.iter().copied().find(|&d| volume_sign(p(a), p(b), p(c), p(d)) != 0)?;
    Some([a, b, c, d])
}

/// Whether three points are on one line.
fn on_line(a: DVec3, b: DVec3, c: DVec3) -> bool {
    [DVec3::truncate, |p: DVec3| p.yz(), |p: DVec3| p.zx()]
        .iter()
        .all(|flat| orient2d(flat(a), flat(b), flat(c)) == 0.0)
}
