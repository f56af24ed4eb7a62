//! A hierarchy of bounding boxes with lattice corners.

/// A box of lattice points, both corners included.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Bounds {
    /// Least coordinates.
    pub min: [i32; 3],
    /// Greatest coordinates.
    pub max: [i32; 3],
}

impl Bounds {
    /// The box of nothing.
    pub const EMPTY: Bounds = Bounds { min: [i32::MAX; 3], max: [i32::MIN; 3] };

    /// The smallest box around both.
    pub fn with(self, other: Bounds) -> Bounds {
        Bounds {
            min: std::array::from_fn(|i| self.min[i].min(other.min[i])),
            max: std::array::from_fn(|i| self.max[i].max(other.max[i])),
        }
    }

    /// Whether the boxes have a point in common.
    pub fn meets(&self, other: &Bounds) -> bool {
        (0..3).all(|i| self.min[i] <= other.max[i] && other.min[i] <= self.max[i])
    }

    /// Whether the boxes have a volume in common.
    pub fn overlaps(&self, other: &Bounds) -> bool {
        (0..3).all(|i| self.min[i] < other.max[i] && other.min[i] < self.max[i])
    }

    /// What is in both boxes.
    pub fn common(self, other: Bounds) -> Bounds {
        Bounds {
            min: std::array::from_fn(|i| self.min[i].max(other.min[i])),
            max: std::array::from_fn(|i| self.max[i].min(other.max[i])),
        }
    }

    /// Twice the middle along an axis.
    pub fn middle(&self, axis: usize) -> i64 {
        i64::from(self.min[axis]) + i64::from(self.max[axis])
    }
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    /// A leaf holds `items[start..end]`; an inner node has its children at `start` and `start + 1`.
    start: u32,
    end: u32,
}

impl Node {
    fn is_leaf(&self) -> bool {
        self.end > 0
    }
}

/// Boxes sorted into a binary tree.
pub(super) struct Hierarchy {
    nodes: Vec<Node>,
    items: Vec<(Bounds, u32)>,
}

/// Boxes in a leaf of the tree.
const LEAF: usize = 4;

/// So few boxes are not worth sorting: the tree is one leaf.
const SMALL: usize = 12;

impl Hierarchy {
    /// Sorts boxes into a tree; an item is known by its place in the list.
    pub fn new(boxes: impl Iterator<Item = Bounds>) -> Hierarchy {
        let mut items: Vec<_> = boxes.zip(0u32..).collect();
        let mut nodes = vec![Node { bounds: Bounds::EMPTY, start: 0, end: 0 }];
        let mut open = vec![(0usize, 0usize, items.len())];
        while let Some((at, start, end)) = open.pop() {
            let range = &mut items[start..end];
            let bounds = range.iter().fold(Bounds::EMPTY, |all, item| all.with(item.0));
            nodes[at].bounds = bounds;
            if range.len() <= if at == 0 { SMALL } else { LEAF } {
                (nodes[at].start, nodes[at].end) = (start as u32, end as u32);
                continue;
            }
            let axis = widest(range.iter().map(|item| item.0));
            let half = range.len() / 2;
            range.select_nth_unstable_by_key(half, |item| (item.0.middle(axis), item.1));
            let first = nodes.len();
            nodes[at].start = first as u32;
            nodes.extend([Node { bounds, start: 0, end: 0 }; 2]);
            open.push((first + 1, start + half, end));
            open.push((first, start, start + half));
        }
        Hierarchy { nodes, items }
    }

    /// Calls `found` with every item whose box meets the given one.
    pub fn overlapping(&self, bounds: &Bounds, mut found: impl FnMut(u32)) {
        let mut open = vec![0u32];
        while let Some(at) = open.pop() {
            let node = &self.nodes[at as usize];
            if !node.bounds.meets(bounds) {
                continue;
            }
            if node.is_leaf() {
                let items = &self.items[node.start as usize..node.end as usize];
                items.iter().filter(|item| item.0.meets(bounds)).for_each(|item| found(item.1));
            } else if !self.items.is_empty() {
                open.extend([node.start + 1, node.start]);
            }
        }
    }

    /// Calls `found` with every pair of items, one of each tree, whose boxes meet.
    pub fn pairs(&self, other: &Hierarchy, mut found: impl FnMut(u32, u32)) {
        if self.items.is_empty() || other.items.is_empty() {
            return;
        }
        let mut open = vec![(0u32, 0u32)];
        while let Some((a, b)) = open.pop() {
            let (p, q) = (&self.nodes[a as usize], &other.nodes[b as usize]);
            if !p.bounds.meets(&q.bounds) {
                continue;
            }
            match (p.is_leaf(), q.is_leaf()) {
                (true, true) => self.leaf_pairs(p, other, q, &mut found),
                (false, true) => open.extend([(p.start + 1, b), (p.start, b)]),
                (true, false) => open.extend([(a, q.start + 1), (a, q.start)]),
                (false, false) => open.extend([
                    (p.start + 1, q.start + 1),
                    (p.start + 1, q.start),
                    (p.start, q.start + 1),
                    (p.start, q.start),
                ]),
            }
        }
    }

    fn leaf_pairs(&self, p: &Node, other: &Hierarchy, q: &Node, found: &mut impl FnMut(u32, u32)) {
        for a in &self.items[p.start as usize..p.end as usize] {
            for b in &other.items[q.start as usize..q.end as usize] {
                if a.0.meets(&b.0) {
                    found(a.1, b.1);
                }
            }
        }
    }

    /// Calls `found` with every pair of different items of this tree whose boxes meet, once.
    pub fn own_pairs(&self, mut found: impl FnMut(u32, u32)) {
        self.pairs(self, |a, b| {
            if a < b {
                found(a, b);
            }
        });
    }
}

/// The axis along which the middles of boxes spread most.
pub(super) fn widest(boxes: impl Iterator<Item = Bounds> + Clone) -> usize {
    let spread = |axis: usize| {
        let middles = boxes.clone().map(|item| item.middle(axis));
        let (low, high) = middles.fold((i64::MAX, i64::MIN), |r, m| (r.0.min(m), r.1.max(m)));
        high.saturating_sub(low)
    };
    (0..3).max_by_key(|&axis| (spread(axis), 2 - axis)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_agree_with_trying_all() {
        let mut state = 1u32;
        let mut next = |n: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % n
        };
        let boxes: Vec<Bounds> = (0..150)
            .map(|_| {
                let min: [i32; 3] = std::array::from_fn(|_| next(100) as i32 - 50);
                Bounds { min, max: min.map(|c| c + next(20) as i32) }
            })
            .collect();
        let tree = Hierarchy::new(boxes.iter().copied());
        let mut found = vec![];
        tree.own_pairs(|a, b| found.push((a, b)));
        found.sort_unstable();
        let mut all = vec![];
        for a in 0..boxes.len() {
            all.extend(
                (a + 1..boxes.len())
                    .filter(|&b| boxes[a].meets(&boxes[b]))
                    .map(|b| (a as u32, b as u32)),
            );
        }
        assert_eq!(found, all);
        let mut over = vec![];
        tree.overlapping(&boxes[7], |i| over.push(i));
        assert_eq!(over.len(), boxes.iter().filter(|b| b.meets(&boxes[7])).count());
    }

    #[test]
    fn an_empty_tree_has_no_pairs() {
        let tree = Hierarchy::new(std::iter::empty());
        tree.own_pairs(|_, _| panic!("no pair"));
        tree.overlapping(&Bounds { min: [0; 3], max: [0; 3] }, |_| panic!("no item"));
    }
}
