//! A hierarchy for nearest-point questions over triangles: eight boxes in a node, down to leaves of a few.
//!
//! It is full: nodes of a level stand one after the other, and child k of node i is number 8 i + k of the level
//! below, so that nothing has to say where children are.

use std::ops::Range;

use glam::DVec3;

use super::{
    lanes::{LANES, Lanes},
    oriented::{Boxes, fitting},
    question::Question,
};
use crate::geom::Bounds;

/// Levels of nodes over all triangles that numbers of 32 bits can tell apart.
const LEVELS: usize = 10;

/// Triangles in a leaf: what they are takes a line of a cache, and boxes around each would take more.
const LEAF: usize = 4;

/// The hierarchy.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    /// Those over leaves first, the root last.
    nodes: Vec<Boxes>,
    /// Where nodes of each level begin.
    levels: Vec<u32>,
    /// The number of items.
    count: u32,
    /// Boxes are measured from here.
    origin: DVec3,
    /// The size of their coordinates.
    reach: f64,
}

/// Children of a node that are still to be looked at.
#[derive(Clone, Copy)]
struct Open {
    /// The number of the first one.
    first: u32,
    /// Those left, one bit each.
    left: u32,
    squares: Lanes,
}

impl Open {
    const NONE: Open = Open { first: 0, left: 0, squares: Lanes::ZERO };

    /// Takes the next child that is not too far.
    #[inline]
    fn next(&mut self, cut: f32) -> Option<u32> {
        self.left &= self.squares.below(cut);
        let lane = self.left.trailing_zeros();
        self.left &= self.left.wrapping_sub(1);
        (lane < LANES as u32).then_some(self.first + lane)
    }
}

impl Tree {
    /// The hierarchy over triangles, at least one, and the order in which it holds them.
    pub fn new(triangles: &[[DVec3; 3]]) -> (Tree, Vec<u32>) {
        let around = Bounds::of(triangles.iter().flatten().copied());
        let origin = around.center();
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let mut size = LEAF;
        while size * LANES < order.len() {
            size *= LANES;
        }
        arrange(triangles, &mut order, size);
        let shifted: Vec<[DVec3; 3]> =
            order.iter().map(|&i| triangles[i as usize].map(|p| p - origin)).collect();
        let (count, reach) = (order.len() as u32, (around.max - origin).length());
        let mut tree = Tree { nodes: vec![], levels: vec![], count, origin, reach };
        let mut each = LEAF;
        while tree.levels.is_empty() || each < shifted.len() {
            tree.levels.push(tree.nodes.len() as u32);
            let node = |t: &[[DVec3; 3]]| Boxes::new(t, each, reach);
            tree.nodes.extend(shifted.chunks(each * LANES).map(node));
            each *= LANES;
        }
        (tree, order)
    }

    /// Goes through the leaves from near to far: `visit` takes the items of one and the square of the least distance
    /// so far, and gives the square of the least distance.
    #[inline]
    pub fn nearest(&self, p: DVec3, limit: f64, mut visit: impl FnMut(Range<u32>, f64) -> f64) {
        let question = Question::new(p - self.origin, self.reach);
        if !question.is_near() {
            visit(0..self.count, limit);
            return;
        }
        let mut open = [Open::NONE; LEVELS];
        let (mut best, mut cut) = (limit, question.cut(limit));
        let (mut level, mut place) = (self.levels.len(), 0);
        loop {
            // Down to the nearest leaf below a node, if there is a near one.
            while level > 0 {
                let node = &self.nodes[(self.levels[level - 1] + place) as usize];
                let squares = node.away(question.at);
                let (near, least) = (squares.below(cut) & node.present, squares.least());
                if near >> least & 1 == 0 {
                    break;
                }
                level -= 1;
                let first = place * LANES as u32;
                open[level] = Open { first, left: near & !(1 << least), squares };
                place = first + least;
            }
            if level == 0 {
                let first = place * LEAF as u32;
                let found = visit(first..(first + LEAF as u32).min(self.count), best);
                if found < best {
                    (best, cut) = (found, question.cut(found));
                }
            }
            // Up to the next child that is left.
            place = loop {
                let Some(open) = open[..self.levels.len()].get_mut(level) else { return };
                match open.next(cut) {
                    Some(child) => break child,
                    None => level += 1,
                }
            }
        }
    }
}

/// Orders items so that those that lie together stand in chunks of a size, and in each of these again, down to
/// leaves. Cuts are along the frame in which there will be boxes, which so hardly overlap.
fn arrange(triangles: &[[DVec3; 3]], items: &mut [u32], size: usize) {
    let axes = fitting(|| items.iter().map(|&i| triangles[i as usize])).transpose();
    let middle = |i: u32| axes * triangles[i as usize].iter().sum::<DVec3>();
    part(&mut items.iter().map(|&i| (middle(i), i)).collect::<Vec<_>>(), size, items);
    if size > LEAF {
        items.chunks_mut(size).for_each(|chunk| arrange(triangles, chunk, size / LANES));
    }
}

/// Orders items by their middles so that those that lie together stand in chunks of a size.
fn part(middles: &mut [(DVec3, u32)], size: usize, items: &mut [u32]) {
    if items.len() <= size {
        items.iter_mut().zip(middles).for_each(|(item, middle)| *item = middle.1);
        return;
    }
    let around = Bounds::of(middles.iter().map(|m| m.0));
    let axis = (around.max - around.min).max_position();
    let half = (items.len().div_ceil(size) / 2 * size).max(size);
    middles
        .select_nth_unstable_by(half, |(p, i), (q, j)| p[axis].total_cmp(&q[axis]).then(i.cmp(j)));
    let ((left, right), (first, last)) = (middles.split_at_mut(half), items.split_at_mut(half));
    part(left, size, first);
    part(right, size, last);
}
