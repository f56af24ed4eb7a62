//! A bounding hierarchy for nearest-point questions alone: two boxes in a node, halved at medians.

use glam::DVec3;

use crate::geom::Bounds;

/// Items in a leaf.
const LEAF: usize = 4;
/// Deeper than any complete tree over 2^32 items.
const DEPTH: usize = 40;

/// The boxes of a node's two children.
#[derive(Clone, Copy, Debug)]
struct Pair([Bounds; 2]);

/// The hierarchy. Node i has the children 2 i and 2 i + 1; those past the nodes are leaves.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    nodes: Vec<Pair>,
    /// Where the items of each leaf begin, in the order that [`Tree::new`] gives; one more at the end.
    starts: Vec<u32>,
}

impl Tree {
    /// The hierarchy over boxes, and the order in which it holds them.
    pub fn new(boxes: &[Bounds]) -> (Tree, Vec<u32>) {
        let leaves = boxes.len().div_ceil(LEAF).next_power_of_two();
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut starts = vec![0; leaves + 1];
        starts[leaves] = boxes.len() as u32;
        let mut bounds = vec![Bounds::EMPTY; 2 * leaves];
        fill(boxes, &mut order, 1, 0, &mut bounds, &mut starts);
        let nodes = (0..leaves).map(|i| Pair([bounds[2 * i], bounds[2 * i + 1]])).collect();
        (Tree { nodes, starts }, order)
    }

    /// The items of the whole.
    fn leaf(&self, node: usize) -> std::ops::Range<u32> {
        let leaf = node - self.nodes.len();
        self.starts[leaf]..self.starts[leaf + 1]
    }

    /// Goes through the items from near to far: `visit` takes a range of them and the square of the least
    /// distance so far, and gives the square of the least distance.
    #[inline]
    pub fn nearest(
        &self,
        p: DVec3,
        limit: f64,
        mut visit: impl FnMut(std::ops::Range<u32>, f64) -> f64,
    ) {
        let mut open = [(0.0, 0usize); DEPTH];
        let (mut count, mut best, mut node) = (0, limit, 1usize);
        loop {
            if node >= self.nodes.len() {
                best = visit(self.leaf(node), best);
            } else {
                let [l, r] = self.nodes[node].0.map(|b| away(&b, p));
                let (near, far) = if l <= r {
                    ((l, 2 * node), (r, 2 * node + 1))
                } else {
                    ((r, 2 * node + 1), (l, 2 * node))
                };
                if far.0 < best {
                    open[count] = far;
                    count += 1;
                }
                if near.0 < best {
                    node = near.1;
                    continue;
                }
            }
            loop {
                if count == 0 {
                    return;
                }
                count -= 1;
                if open[count].0 < best {
                    node = open[count].1;
                    break;
                }
            }
        }
    }
}

/// The square of the distance from a point to a box.
#[inline]
fn away(b: &Bounds, p: DVec3) -> f64 {
    (b.min - p).max(p - b.max).max(DVec3::ZERO).length_squared()
}

/// Orders the items of a node and below, and fills in the boxes.
fn fill(
    boxes: &[Bounds],
    order: &mut [u32],
    node: usize,
    start: u32,
    bounds: &mut [Bounds],
    starts: &mut [u32],
) {
    let around = order.iter().fold(Bounds::EMPTY, |all, &i| all.joined(&boxes[i as usize]));
    bounds[node] = around;
    let leaves = starts.len() - 1;
    if node >= leaves {
        starts[node - leaves] = start;
        return;
    }
    let middles = Bounds::of(order.iter().map(|&i| boxes[i as usize].center()));
    let axis = if order.is_empty() { 0 } else { (middles.max - middles.min).max_position() };
    let half = order.len() / 2;
    if order.len() > 1 {
        let key = |&i: &u32| boxes[i as usize].center()[axis];
        order.select_nth_unstable_by(half, |i, j| key(i).total_cmp(&key(j)).then(i.cmp(j)));
    }
    let (left, right) = order.split_at_mut(half);
    let middle = start + half as u32;
    fill(boxes, left, 2 * node, start, bounds, starts);
    fill(boxes, right, 2 * node + 1, middle, bounds, starts);
}
