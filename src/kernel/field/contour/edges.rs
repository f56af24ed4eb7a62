//! The edges of leaves that the surface crosses, with the leaves around them.
//!
//! Ju, T., Losasso, F., Schaefer, S., Warren, J.: *Dual contouring of hermite data*, 2002: three procedures
//! that call each other, for a cell, a face between two cells and an edge between four, go down to the
//! smallest edges, each of which is met once.

use super::{
    Level, Look,
    lattice::{Corner, edge},
    octree::Octree,
};

/// An edge that the surface crosses once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// Its lower end.
    pub from: Corner,
    /// Its upper end.
    pub to: Corner,
    /// The leaves around it, counter-clockwise seen against the axis; a large one may stand twice in a row.
    pub ring: [u32; 4],
    /// The smallest of them.
    pub smallest: u32,
    /// Whether its lower end is inside.
    pub leaves: bool,
}

/// All edges of leaves whose ends are on different sides, in a fixed order.
pub(super) fn crossed<L: Level>(tree: &Octree<L>) -> Vec<Edge> {
    let mut walk = Walk { tree, found: vec![] };
    walk.cell(0);
    walk.found
}

struct Walk<'a, L> {
    tree: &'a Octree<L>,
    found: Vec<Edge>,
}

/// Going around an edge.
const AROUND: [usize; 4] = [0, 1, 3, 2];

impl<L: Level> Walk<'_, L> {
    fn is_leaf(&self, cell: u32) -> bool {
        self.tree.cells[cell as usize].children == 0
    }

    /// Whether the surface stays away from a cell.
    fn is_clear(&self, cell: u32) -> bool {
        self.is_leaf(cell) && self.tree.cells[cell as usize].look == Look::Clear
    }

    /// The child of a cell on some sides along an axis and the two that follow; a leaf itself.
    fn child(&self, cell: u32, axis: usize, sides: [usize; 3]) -> u32 {
        let first = self.tree.cells[cell as usize].children;
        let place = |i: usize| (sides[i] as u32) << ((axis + i) % 3);
        if first == 0 { cell } else { first + place(0) + place(1) + place(2) }
    }

    fn cell(&mut self, cell: u32) {
        if self.is_leaf(cell) {
            return;
        }
        let first = self.tree.cells[cell as usize].children;
        (first..first + 8).for_each(|child| self.cell(child));
        for axis in 0..3 {
            for q in 0..4 {
                let [low, high] = [0, 1].map(|s| self.child(cell, axis, [s, q & 1, q >> 1]));
                self.face([low, high], axis);
            }
            for half in 0..2 {
                self.edge(
                    [0, 1, 2, 3].map(|q| self.child(cell, axis, [half, q & 1, q >> 1])),
                    axis,
                );
            }
        }
    }

    /// A face between two cells along an axis.
    fn face(&mut self, [low, high]: [u32; 2], axis: usize) {
        let both = self.is_leaf(low) && self.is_leaf(high);
        if both || self.is_clear(low) || self.is_clear(high) {
            return;
        }
        let pair = [low, high];
        for q in 0..4 {
            let side = |s: usize| self.child(pair[s], axis, [1 - s, q & 1, q >> 1]);
            self.face([side(0), side(1)], axis);
        }
        for half in 0..2 {
            // Along the second axis, between the halves along the third.
            let second = |q: usize| self.child(pair[q >> 1], axis, [1 - (q >> 1), half, q & 1]);
            self.edge([0, 1, 2, 3].map(second), (axis + 1) % 3);
            let third = |q: usize| self.child(pair[q & 1], axis, [1 - (q & 1), q >> 1, half]);
            self.edge([0, 1, 2, 3].map(third), (axis + 2) % 3);
        }
    }

    /// An edge between four cells, numbered by their sides along the next axis and the one after it.
    fn edge(&mut self, cells: [u32; 4], axis: usize) {
        if cells.iter().any(|&c| self.is_clear(c)) {
            return;
        }
        if cells.iter().all(|&c| self.is_leaf(c)) {
            return self.smallest(cells, axis);
        }
        for half in 0..2 {
            let towards = |q: usize| self.child(cells[q], axis, [half, 1 - (q & 1), 1 - (q >> 1)]);
            self.edge([0, 1, 2, 3].map(towards), axis);
        }
    }

    /// An edge between four leaves.
    fn smallest(&mut self, cells: [u32; 4], axis: usize) {
        let level = |q: usize| self.tree.cells[cells[q] as usize].level;
        let q = (0..4).rev().max_by_key(|&q| level(q)).unwrap_or(0);
        let cell = &self.tree.cells[cells[q] as usize];
        let (size, [second, third]) = (edge(cell.level), [1, 2].map(|i| (axis + i) % 3));
        let mut from = cell.at;
        from[second] += if q & 1 == 0 { size } else { 0 };
        from[third] += if q >> 1 == 0 { size } else { 0 };
        let mut to = from;
        to[axis] += size;
        let [a, b] = [from, to].map(|corner| self.tree.value(corner) <= 0.0);
        if a != b {
            let (ring, smallest) = (AROUND.map(|q| cells[q]), cells[q]);
            self.found.push(Edge { from, to, ring, smallest, leaves: a });
        }
    }
}
