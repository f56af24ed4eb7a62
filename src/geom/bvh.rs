//! A hierarchy of bounding boxes: which boxes meet, and what is nearest.
//!
//! Items are ordered along a Morton curve through the middles of their boxes, ties by number, and stand in
//! leaves of four at the bottom of a complete binary tree: one flat array, no pointers, n log n to build, the
//! same for the same boxes everywhere. Padding is empty boxes, which meet nothing.

use glam::DVec3;

use super::bounds::Bounds;

/// Items in a leaf.
const LEAF: usize = 4;
/// Bits of each coordinate in a Morton code.
const BITS: u32 = 21;

/// The hierarchy over a list of boxes; items are named by their place in the list.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// Boxes of the tree: the children of node i are 2 i and 2 i + 1, the root is 1.
    nodes: Vec<Bounds>,
    /// Items in leaf order, and their boxes.
    items: Vec<u32>,
    boxes: Vec<Bounds>,
}

impl Bvh {
    /// The hierarchy over boxes.
    ///
    /// ```
    /// use glam::DVec3;
    /// use katachi::geom::{Bounds, bvh::Bvh};
    /// let boxes: Vec<Bounds> =
    ///     (0..100).map(|i| Bounds::of([DVec3::X * f64::from(i)]).grown(0.25)).collect();
    /// assert_eq!(Bvh::new(&boxes).overlapping(&boxes[42].grown(1.0)), [41, 42, 43]);
    /// ```
    pub fn new(list: &[Bounds]) -> Bvh {
        let items = morton_order(list);
        let boxes: Vec<Bounds> = items.iter().map(|&i| list[i as usize]).collect();
        let leaves = items.len().div_ceil(LEAF).next_power_of_two();
        let mut nodes = vec![Bounds::EMPTY; 2 * leaves];
        for (leaf, inside) in boxes.chunks(LEAF).enumerate() {
            nodes[leaves + leaf] = inside.iter().fold(Bounds::EMPTY, |b, x| b.joined(x));
        }
        for i in (1..leaves).rev() {
            nodes[i] = nodes[2 * i].joined(&nodes[2 * i + 1]);
        }
        Bvh { nodes, items, boxes }
    }

    /// The box around everything.
    pub fn bounds(&self) -> Bounds {
        self.nodes[1]
    }

    fn leaves(&self) -> usize {
        self.nodes.len() / 2
    }

    /// The places of a leaf's items.
    fn leaf(&self, node: usize) -> std::ops::Range<usize> {
        let start = (node - self.leaves()) * LEAF;
        start.min(self.items.len())..(start + LEAF).min(self.items.len())
    }

    fn is_leaf(&self, node: usize) -> bool {
        node >= self.leaves()
    }

    /// Calls `found` with every item whose box meets `query`, in a fixed order.
    pub fn visit(&self, query: &Bounds, mut found: impl FnMut(u32)) {
        let mut open = vec![1];
        while let Some(node) = open.pop() {
            if !self.nodes[node].meets(query) {
                continue;
            }
            if self.is_leaf(node) {
                let meeting = self.leaf(node).filter(|&k| self.boxes[k].meets(query));
                meeting.for_each(|k| found(self.items[k]));
            } else {
                open.extend([2 * node + 1, 2 * node]);
            }
        }
    }

    /// A value for each box of the tree, by its number: of one item by `of`, of a group by `joined`.
    pub fn gathered<T: Copy + Default>(
        &self,
        of: impl Fn(u32) -> T,
        joined: impl Fn(&T, &T) -> T,
    ) -> Vec<T> {
        let mut values = vec![T::default(); self.nodes.len()];
        for (leaf, items) in self.items.chunks(LEAF).enumerate() {
            let group = items.iter().map(|&i| of(i)).reduce(|a, b| joined(&a, &b));
            values[self.leaves() + leaf] = group.unwrap_or_default();
        }
        for i in (1..self.leaves()).rev() {
            values[i] = joined(&values[2 * i], &values[2 * i + 1]);
        }
        values
    }

    /// Goes down from the root: past a box where `done` says so of its number and the box, else to its
    /// parts, and at the bottom to `item`. In a fixed order.
    pub fn descend(&self, mut done: impl FnMut(usize, &Bounds) -> bool, mut item: impl FnMut(u32)) {
        let mut open = vec![1];
        while let Some(node) = open.pop() {
            if self.nodes[node].is_empty() || done(node, &self.nodes[node]) {
                continue;
            }
            if self.is_leaf(node) {
                self.leaf(node).for_each(|k| item(self.items[k]));
            } else {
                open.extend([2 * node + 1, 2 * node]);
            }
        }
    }

    /// The items whose boxes meet `query`, in increasing order.
    pub fn overlapping(&self, query: &Bounds) -> Vec<u32> {
        let mut items = vec![];
        self.visit(query, |i| items.push(i));
        items.sort_unstable();
        items
    }

    /// Calls `found` with every pair of an item here and one of `other` whose boxes meet, in a fixed order.
    pub fn pairs(&self, other: &Bvh, mut found: impl FnMut(u32, u32)) {
        let mut open = vec![(1, 1)];
        while let Some((a, b)) = open.pop() {
            if !self.nodes[a].meets(&other.nodes[b]) {
                continue;
            }
            match (self.is_leaf(a), other.is_leaf(b)) {
                (true, true) => self.leaf_pairs(a, other, b, &mut found),
                (false, _) => open.extend([(2 * a + 1, b), (2 * a, b)]),
                (true, false) => open.extend([(a, 2 * b + 1), (a, 2 * b)]),
            }
        }
    }

    fn leaf_pairs(&self, a: usize, other: &Bvh, b: usize, found: &mut impl FnMut(u32, u32)) {
        for i in self.leaf(a) {
            for j in other.leaf(b).filter(|&j| self.boxes[i].meets(&other.boxes[j])) {
                found(self.items[i], other.items[j]);
            }
        }
    }

    /// Calls `found` with every pair of different items here whose boxes meet, smaller number first, each
    /// once, in a fixed order.
    pub fn self_pairs(&self, mut found: impl FnMut(u32, u32)) {
        self.find_pair(|i, j| {
            found(i, j);
            false
        });
    }

    /// The first pair in the order of [`Bvh::self_pairs`] that `is_sought`; those after it are not asked.
    pub fn find_pair(&self, mut is_sought: impl FnMut(u32, u32) -> bool) -> Option<(u32, u32)> {
        let mut open = vec![(1, 1)];
        while let Some((a, b)) = open.pop() {
            if !self.nodes[a].meets(&self.nodes[b]) {
                continue;
            }
            if self.is_leaf(a) {
                let mut first = None;
                self.leaf_pairs(a, self, b, &mut |i, j| {
                    let pair = (i.min(j), i.max(j));
                    if first.is_none() && (a != b || i < j) && is_sought(pair.0, pair.1) {
                        first = Some(pair);
                    }
                });
                if first.is_some() {
                    return first;
                }
                continue;
            }
            let [a0, a1, b0, b1] = [2 * a, 2 * a + 1, 2 * b, 2 * b + 1];
            open.extend([(a1, b1), (a0, b1), (a0, b0)]);
            if a != b {
                open.push((a1, b0));
            }
        }
        None
    }

    /// The item nearest to `query` and the square of its distance: `distance_squared` gives that of an item,
    /// which must not be less than that of its box. `None` if all are at `limit_squared` or farther.
    ///
    /// ```
    /// use glam::DVec3;
    /// use katachi::geom::{Bounds, bvh::Bvh};
    /// let points: Vec<DVec3> = (0..9).map(|i| DVec3::X * f64::from(i)).collect();
    /// let boxes: Vec<Bounds> = points.iter().map(|p| Bounds::of([*p])).collect();
    /// let to = DVec3::X * 6.2;
    /// let found = Bvh::new(&boxes).nearest(&Bounds::of([to]), f64::INFINITY, |i| {
    ///     points[i as usize].distance_squared(to)
    /// });
    /// assert_eq!(found.map(|(i, _)| i), Some(6));
    /// ```
    pub fn nearest(
        &self,
        query: &Bounds,
        limit_squared: f64,
        mut distance_squared: impl FnMut(u32) -> f64,
    ) -> Option<(u32, f64)> {
        let away = |node: usize| self.nodes[node].distance_squared(query);
        let mut best = (None, limit_squared);
        let mut open = vec![(away(1), 1)];
        while let Some((bound, node)) = open.pop() {
            if bound >= best.1 {
                continue;
            }
            if self.is_leaf(node) {
                for k in self.leaf(node) {
                    if self.boxes[k].distance_squared(query) < best.1 {
                        let d = distance_squared(self.items[k]);
                        best = if d < best.1 { (Some(self.items[k]), d) } else { best };
                    }
                }
            } else {
                let [l, r] = [2 * node, 2 * node + 1].map(|child| (away(child), child));
                open.extend(if l.0 <= r.0 { [r, l] } else { [l, r] });
            }
        }
        best.0.map(|item| (item, best.1))
    }

    /// The nearest pair of an item here and one of `other`, and the square of their distance. `None` if all
    /// are at `limit_squared` or farther. Stops at distance 0.
    pub fn nearest_pair(
        &self,
        other: &Bvh,
        limit_squared: f64,
        mut distance_squared: impl FnMut(u32, u32) -> f64,
    ) -> Option<(u32, u32, f64)> {
        let away = |a: usize, b: usize| self.nodes[a].distance_squared(&other.nodes[b]);
        let mut best = (None, limit_squared);
        let mut open = vec![(away(1, 1), 1, 1)];
        while let Some((bound, a, b)) = open.pop() {
            if bound >= best.1 {
                continue;
            }
            let children = match (self.is_leaf(a), other.is_leaf(b)) {
                (true, true) => {
                    self.nearest_in_leaves(a, other, b, &mut best, &mut distance_squared);
                    continue;
                }
                (false, _) => [(2 * a, b), (2 * a + 1, b)],
                (true, false) => [(a, 2 * b), (a, 2 * b + 1)],
            };
            let [l, r] = children.map(|(a, b)| (away(a, b), a, b));
            open.extend(if l.0 <= r.0 { [r, l] } else { [l, r] });
        }
        best.0.map(|(i, j)| (i, j, best.1))
    }

    fn nearest_in_leaves(
        &self,
        a: usize,
        other: &Bvh,
        b: usize,
        best: &mut (Option<(u32, u32)>, f64),
        distance_squared: &mut impl FnMut(u32, u32) -> f64,
    ) {
        for i in self.leaf(a) {
            for j in other.leaf(b) {
                if self.boxes[i].distance_squared(&other.boxes[j]) < best.1 {
                    let pair = (self.items[i], other.items[j]);
                    let d = distance_squared(pair.0, pair.1);
                    *best = if d < best.1 { (Some(pair), d) } else { *best };
                }
            }
        }
    }
}

/// The items in the order in which a Morton curve meets the middles of their boxes.
fn morton_order(boxes: &[Bounds]) -> Vec<u32> {
    let centers = Bounds::of(boxes.iter().map(Bounds::center));
    let size = (centers.max - centers.min).max(DVec3::splat(f64::MIN_POSITIVE));
    let scale = f64::from((1u32 << BITS) - 1);
    let code = |b: &Bounds| {
        let [x, y, z] = ((b.center() - centers.min) / size * scale).to_array().map(|v| v as u64);
        spread(x) << 2 | spread(y) << 1 | spread(z)
    };
    let mut coded: Vec<(u64, u32)> = boxes.iter().map(code).zip(0..).collect();
    coded.sort_unstable();
    coded.into_iter().map(|(_, i)| i).collect()
}

/// Puts two zero bits between the lowest 21 bits.
fn spread(v: u64) -> u64 {
    let steps = [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ];
    steps.iter().fold(v & 0x001f_ffff, |v, (shift, mask)| (v | v << shift) & mask)
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    fn boxes(n: u32, seed: u32) -> Vec<Bounds> {
        let part = |i: u32, k: u32| f64::from((i * 7919 + k * 104_729 + seed * 31) % 1009) / 10.0;
        let place = |i| dvec3(part(i, 1), part(i * i, 2), part(i, 3));
        (0..n).map(|i| Bounds::of([place(i)]).grown(0.5 + part(i, 4) / 40.0)).collect()
    }

    #[test]
    fn overlaps_are_those_of_brute_force() {
        for n in [0, 1, 3, 4, 5, 17, 200] {
            let (a, b) = (boxes(n, 0), boxes(90, 5));
            let (tree, other) = (Bvh::new(&a), Bvh::new(&b));
            let mut found = vec![];
            tree.pairs(&other, |i, j| found.push((i, j)));
            found.sort_unstable();
            let all = |i: u32| (0..b.len() as u32).map(move |j| (i, j));
            let meet = |&(i, j): &(u32, u32)| a[i as usize].meets(&b[j as usize]);
            assert_eq!(found, (0..n).flat_map(all).filter(meet).collect::<Vec<_>>());
            let mut own = vec![];
            tree.self_pairs(|i, j| own.push((i, j)));
            own.sort_unstable();
            let pairs = |i: u32| (i + 1..n).map(move |j| (i, j));
            let meet = |&(i, j): &(u32, u32)| a[i as usize].meets(&a[j as usize]);
            assert_eq!(own, (0..n).flat_map(pairs).filter(meet).collect::<Vec<_>>());
        }
    }

    #[test]
    fn nearest_is_that_of_brute_force() {
        let (a, b) = (boxes(300, 1), boxes(40, 9));
        let shifted: Vec<Bounds> =
            b.iter().map(|x| Bounds { min: x.min + 150.0, max: x.max + 150.0 }).collect();
        let (tree, other) = (Bvh::new(&a), Bvh::new(&shifted));
        for q in &shifted {
            let (_, d) = tree
                .nearest(q, f64::INFINITY, |i| a[i as usize].distance_squared(q))
                .expect("something is nearest");
            let least = a.iter().map(|x| x.distance_squared(q)).fold(f64::INFINITY, f64::min);
            assert_eq!(d, least);
        }
        let exact = |i: u32, j: u32| a[i as usize].distance_squared(&shifted[j as usize]);
        let (.., d) = tree.nearest_pair(&other, f64::INFINITY, exact).expect("a pair");
        let all = a.iter().flat_map(|x| shifted.iter().map(move |y| x.distance_squared(y)));
        assert_eq!(d, all.fold(f64::INFINITY, f64::min));
        assert_eq!(tree.nearest(&shifted[0], 1.0, |_| 1.0), None);
    }
}
