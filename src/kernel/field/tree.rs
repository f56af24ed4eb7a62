//! A hierarchy for nearest-point questions over triangles: eight boxes in a node, down to single triangles.

use glam::DVec3;

use super::oriented::{Eight, LANES, Oriented, SLACK};
use crate::geom::Bounds;

/// More than can be open at a time: seven of each of eleven levels, and eight more.
const OPEN: usize = 96;
/// Marks a child that is an item.
const ITEM: u32 = 1 << 31;

/// A node: the boxes of its children, and what they are.
#[derive(Clone, Debug)]
struct Node {
    boxes: Eight,
    children: [u32; LANES],
    count: u32,
}

/// The hierarchy.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    /// The root first.
    nodes: Vec<Node>,
    /// The node and the lane of each item.
    places: Vec<u32>,
    /// Boxes are measured from here.
    origin: DVec3,
    /// The size of their coordinates.
    reach: f64,
}

/// A question: a point in the frame of the boxes, and what is too far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Question {
    at: [f32; 3],
    slack: f64,
}

impl Question {
    /// The square of the distance beyond which a box holds nothing nearer than the square root of `best`.
    #[inline]
    pub fn cut(&self, best: f64) -> f32 {
        if best < 0.0 {
            return -1.0; // nothing is so near
        }
        let far = best.sqrt() + self.slack;
        // A trifle more than what rounding to a single number and squaring may take away.
        (far * far) as f32 * (1.0 + 4.0 * f32::EPSILON)
    }

    /// The squares of the distances of eight boxes.
    #[inline]
    pub fn away(&self, boxes: &Eight) -> [f32; LANES] {
        boxes.away(self.at)
    }
}

impl Tree {
    /// The hierarchy over triangles, at least one, and the order in which it holds them.
    pub fn new(triangles: &[[DVec3; 3]]) -> (Tree, Vec<u32>) {
        let around = Bounds::of(triangles.iter().flatten().copied());
        let origin = around.center();
        let shifted: Vec<[DVec3; 3]> = triangles.iter().map(|t| t.map(|p| p - origin)).collect();
        let reach = (around.max - origin).length();
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let mut tree = Tree { nodes: vec![], places: vec![0; triangles.len()], origin, reach };
        tree.fill(&shifted, &mut order, 0);
        (tree, order)
    }

    /// Makes the node over some items, which come to stand in its order from `start` on.
    fn fill(&mut self, triangles: &[[DVec3; 3]], items: &mut [u32], start: u32) -> u32 {
        let number = self.nodes.len() as u32;
        self.nodes.push(Node { boxes: Eight::EMPTY, children: [0; LANES], count: 0 });
        // Children are full but for the last, so that nodes are few.
        let mut size = 1;
        while size * LANES < items.len() {
            size *= LANES;
        }
        part(triangles, items, size);
        for (lane, part) in items.chunks_mut(size).enumerate() {
            let first = start + (lane * size) as u32;
            let around = if size == 1 {
                self.places[first as usize] = number * LANES as u32 + lane as u32;
                Oriented::of_triangle(triangles[part[0] as usize])
            } else {
                around(triangles, part)
            };
            let child = if size == 1 { first | ITEM } else { self.fill(triangles, part, first) };
            let node = &mut self.nodes[number as usize];
            node.boxes.set(lane, &around);
            node.children[lane] = child;
            node.count = lane as u32 + 1;
        }
        number
    }

    /// The box of an item.
    pub fn item(&self, item: u32) -> Oriented {
        let place = self.places[item as usize] as usize;
        self.nodes[place / LANES].boxes.get(place % LANES)
    }

    /// A point as boxes see it.
    #[inline]
    pub fn question(&self, p: DVec3) -> Question {
        let from = p - self.origin;
        let slack = SLACK * (from.abs().element_sum() + self.reach);
        Question { at: from.as_vec3().to_array(), slack }
    }

    /// Goes through the items from near to far: `visit` takes one and the square of the least distance so far,
    /// and gives the square of the least distance.
    #[inline]
    pub fn nearest(&self, p: DVec3, limit: f64, mut visit: impl FnMut(u32, f64) -> f64) {
        let question = self.question(p);
        let mut open = [(0.0f32, 0u32); OPEN];
        let (mut count, mut best, mut cut) = (1, limit, question.cut(limit));
        while count > 0 {
            count -= 1;
            let (away, child) = open[count];
            if away > cut {
                continue;
            }
            if child & ITEM != 0 {
                let found = visit(child & !ITEM, best);
                if found < best {
                    (best, cut) = (found, question.cut(found));
                }
                continue;
            }
            let node = &self.nodes[child as usize];
            let squares = question.away(&node.boxes);
            let (mut least, mut place) = (f32::INFINITY, count);
            for (&square, &child) in squares.iter().zip(&node.children).take(node.count as usize) {
                open[count] = (square, child);
                (least, place) = if square < least { (square, count) } else { (least, place) };
                // What is no number is not known to be far.
                let far = square > cut;
                count += usize::from(!far);
            }
            // The nearest is next; after it the least distance is so small that order hardly matters.
            if place + 1 < count {
                open.swap(place, count - 1);
            }
        }
    }
}

/// A box around some triangles.
fn around(triangles: &[[DVec3; 3]], items: &[u32]) -> Oriented {
    let chosen = || items.iter().map(|&i| triangles[i as usize]);
    let facing = chosen().map(|[a, b, c]| (b - a).cross(c - a)).sum();
    Oriented::of_points(|| chosen().flatten(), facing)
}

/// Orders items so that those that lie together stand in chunks of a size.
fn part(triangles: &[[DVec3; 3]], items: &mut [u32], size: usize) {
    if items.len() <= size {
        return;
    }
    let middle = |i: u32| triangles[i as usize].iter().sum::<DVec3>();
    let middles = Bounds::of(items.iter().map(|&i| middle(i)));
    let axis = (middles.max - middles.min).max_position();
    let key = |i: u32| middle(i)[axis];
    let half = (items.len().div_ceil(size) / 2 * size).max(size);
    items.select_nth_unstable_by(half, |&i, &j| key(i).total_cmp(&key(j)).then(i.cmp(&j)));
    let (left, right) = items.split_at_mut(half);
    part(triangles, left, size);
    part(triangles, right, size);
}
