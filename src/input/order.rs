//! The order in which the triangles of a large file are taken.
//!
//! Every pass over a mesh is as fast as its neighbours in space are near in memory. Most files have them near;
//! one whose triangles come in any order is taken along a curve that fills space (G. M. Morton, *A computer
//! oriented geodetic data base*, 1966), once, and every later pass gains.

/// Triangles of a mesh that fits into the caches in any order.
const SMALL: usize = 1 << 16;

/// Pairs of triangles looked at.
const PAIRS: usize = 1 << 10;

/// Bits of a place along each axis.
const BITS: u32 = 10;

/// Corners as they stand in a file.
type Corner = [f32; 3];

/// The numbers of `count` triangles from near to near; `None` where the file has them so, or they are few: most
/// triangles share a corner with the one before. A triangle stands where its first corner does.
pub(super) fn along_curve(
    count: usize,
    corners: impl Fn(usize) -> [Corner; 3],
) -> Option<Vec<u32>> {
    if count < SMALL || is_near(count, &corners) {
        return None;
    }
    let first = |number: usize| corners(number)[0];
    let (mut min, mut max) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for place in (0..count).map(first) {
        for axis in 0..3 {
            (min[axis], max[axis]) = (min[axis].min(place[axis]), max[axis].max(place[axis]));
        }
    }
    let size = (0..3).map(|axis| max[axis] - min[axis]).fold(f32::MIN_POSITIVE, f32::max);
    let scale = ((1 << BITS) - 1) as f32 / size;
    let key = |number: usize| {
        let place = first(number);
        let step = |axis: usize| spread(((place[axis] - min[axis]) * scale) as u32) << axis;
        u64::from(step(0) | step(1) | step(2)) << 32 | number as u64
    };
    let mut keys: Vec<u64> = (0..count).map(key).collect();
    keys.sort_unstable();
    Some(keys.into_iter().map(|key| key as u32).collect())
}

/// Whether most triangles share a corner with the one before.
fn is_near(count: usize, corners: impl Fn(usize) -> [Corner; 3]) -> bool {
    let shares = |number: usize| {
        let before = corners(number - 1);
        corners(number).iter().any(|corner| before.contains(corner))
    };
    2 * (1..=PAIRS).filter(|i| shares(i * (count / (PAIRS + 1)))).count() > PAIRS
}

/// Puts two bits of nothing between the bits of a number of [`BITS`] bits.
fn spread(number: u32) -> u32 {
    let apart = |x: u32, by: u32, mask: u32| (x | x << by) & mask;
    let x = apart(number, 16, 0x0300_00ff);
    let x = apart(x, 8, 0x0300_f00f);
    apart(apart(x, 4, 0x030c_30c3), 2, 0x0924_9249)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangles of a long strip.
    fn strip(number: usize) -> [Corner; 3] {
        [0, 1, 2].map(|k| [(number + k) as f32, (number + k) as f32 % 2.0, 0.0])
    }

    #[test]
    fn what_is_in_order_stays_as_it_is() {
        assert_eq!(along_curve(100_000, strip), None);
        assert_eq!(along_curve(100, |i| strip(i * 37 % 100)), None);
    }

    #[test]
    fn neighbours_come_together() {
        let count = 100_003;
        let mixed = |i: usize| strip(i * 7919 % count);
        let order = along_curve(count, mixed).expect("in disorder");
        let place = |i: u32| mixed(i as usize)[0][0];
        assert!(order.windows(2).all(|w| (place(w[0]) - place(w[1])).abs() < 200.0));
        let mut all = order;
        all.sort_unstable();
        assert!(all.into_iter().eq(0..count as u32));
    }

    #[test]
    fn bits_are_spread() {
        assert_eq!(spread(0b11_1111_1111), 0o1_111_111_111);
        assert_eq!((spread(1), spread(0b10), spread(0b101)), (1, 0b1000, 0b100_0001));
    }
}
