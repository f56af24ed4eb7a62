//! How crossed edges join to loops around leaves.
//!
//! Schaefer, S., Ju, T., Warren, J.: *Manifold dual contouring*, 2007: where the surface passes a cell several
//! times, each of its pieces has a vertex of its own.
//!
//! On a face between two leaves crossed edges are joined in pairs by segments that do not cross. The segments
//! on the faces of a leaf form closed loops; every loop bounds one piece of the surface.

use super::{
    Level,
    edges::Edge,
    lattice::{Corner, edge},
    octree::Octree,
};
use crate::kernel::field::pieces::Pieces;

/// No segment: the leaf stands twice in the ring.
pub(super) const NONE: u32 = u32::MAX;

/// Two crossed edges of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    /// The leaves on both sides.
    pub cells: [u32; 2],
    /// The edges.
    pub ends: [u32; 2],
}

/// The pieces of the surface.
#[derive(Debug)]
pub(super) struct Loops {
    pub segments: Vec<Segment>,
    /// For each edge the segments between the leaves of its ring and the next ones.
    pub sides: Vec<[u32; 4]>,
    /// For each edge and each leaf of its ring the piece.
    pub pieces: Vec<[u32; 4]>,
    /// For each piece its leaf.
    pub cells: Vec<u32>,
    /// The edges of all pieces, piece by piece.
    members: Vec<u32>,
    starts: Vec<u32>,
}

impl Loops {
    pub fn new<L: Level>(tree: &Octree<L>, edges: &[Edge]) -> Loops {
        let (segments, sides) = segments(tree, edges);
        let mut joined = Pieces::new(4 * edges.len());
        let place = |e: u32, cell: u32| {
            let ring = &edges[e as usize].ring;
            4 * e + ring.iter().position(|&c| c == cell).expect("around its edge") as u32
        };
        for segment in &segments {
            for cell in segment.cells {
                joined.join(segment.ends.map(|e| place(e, cell)));
            }
        }
        Loops::numbered(edges, segments, sides, &mut joined)
    }

    /// Numbers the pieces in the order of their first edges.
    fn numbered(
        edges: &[Edge],
        segments: Vec<Segment>,
        sides: Vec<[u32; 4]>,
        joined: &mut Pieces,
    ) -> Loops {
        let (mut cells, mut number) = (vec![], vec![NONE; 4 * edges.len()]);
        let mut pieces = vec![[NONE; 4]; edges.len()];
        let mut counted: Vec<(u32, u32)> = vec![];
        for (e, of) in edges.iter().enumerate() {
            for (k, piece) in pieces[e].iter_mut().enumerate() {
                let same = of.ring.iter().position(|c| *c == of.ring[k]).unwrap_or(k);
                let root = joined.of((4 * e + same) as u32) as usize;
                if number[root] == NONE {
                    number[root] = cells.len() as u32;
                    cells.push(of.ring[k]);
                }
                *piece = number[root];
                if same == k {
                    counted.push((number[root], e as u32));
                }
            }
        }
        counted.sort_unstable();
        let mut starts = vec![0; cells.len() + 1];
        counted.iter().for_each(|(piece, _)| starts[*piece as usize + 1] += 1);
        (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
        let members = counted.into_iter().map(|(_, e)| e).collect();
        Loops { segments, sides, pieces, cells, members, starts }
    }

    /// The edges around a piece.
    pub fn around(&self, piece: u32) -> &[u32] {
        let [from, to] = [0, 1].map(|i| self.starts[piece as usize + i] as usize);
        &self.members[from..to]
    }
}

/// The segments of all faces, and for each edge those at the sides of its ring.
fn segments<L: Level>(tree: &Octree<L>, edges: &[Edge]) -> (Vec<Segment>, Vec<[u32; 4]>) {
    let mut meetings: Vec<([u32; 2], u32, usize)> = vec![];
    for (e, of) in edges.iter().enumerate() {
        for k in 0..4 {
            let (a, b) = (of.ring[k], of.ring[(k + 1) % 4]);
            if a != b {
                meetings.push(([a.min(b), a.max(b)], e as u32, k));
            }
        }
    }
    meetings.sort_unstable();
    let (mut segments, mut sides) = (vec![], vec![[NONE; 4]; edges.len()]);
    for on_face in meetings.chunk_by_mut(|a, b| a.0 == b.0) {
        if on_face.len() > 2 {
            pair_up(tree, edges, on_face);
        }
        for pair in on_face.chunks_exact(2) {
            let ends = [pair[0].1, pair[1].1];
            pair.iter().for_each(|(_, e, k)| sides[*e as usize][*k] = segments.len() as u32);
            segments.push(Segment { cells: pair[0].0, ends });
        }
    }
    (segments, sides)
}

/// The box that two neighbouring leaves have in common: its lower corner, its size and its normal axis.
pub(super) fn shared<L: Level>(tree: &Octree<L>, cells: [u32; 2]) -> (Corner, [u32; 3], usize) {
    let [a, b] = cells.map(|c| &tree.cells[c as usize]);
    let low = [0, 1, 2].map(|i| a.at[i].max(b.at[i]));
    let high = [0, 1, 2].map(|i| (a.at[i] + edge(a.level)).min(b.at[i] + edge(b.level)));
    let size = [0, 1, 2].map(|i| high[i].saturating_sub(low[i]));
    (low, size, (0..3).find(|&i| size[i] == 0).unwrap_or(0))
}

/// Orders the edges of a face with more than two so that neighbours in the order belong together: around the
/// face, those next to each other are joined across the corners on the side that the middle is not on.
fn pair_up<L: Level>(tree: &Octree<L>, edges: &[Edge], on_face: &mut [([u32; 2], u32, usize)]) {
    let (low, size, axis) = shared(tree, on_face[0].0);
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let around = |e: u32| {
        let Edge { from, to, .. } = edges[e as usize];
        // Twice the middle, from the lower corner.
        let at = [u, v].map(|i| u64::from(from[i] - low[i]) + u64::from(to[i] - low[i]));
        let full = [u, v].map(|i| 2 * u64::from(size[i]));
        match at {
            [x, 0] => x,
            [x, y] if x == full[0] => full[0] + y,
            [x, y] if y == full[1] => full[0] + full[1] + (full[0] - x),
            [_, y] => 2 * full[0] + full[1] + (full[1] - y),
        }
    };
    on_face.sort_by_key(|m| around(m.1));
    let [a, b] = [0, 1].map(|i| tree.lattice.point([0, 1, 2].map(|k| low[k] + i * size[k])));
    let inside = tree.cells[on_face[0].0[0] as usize].field.value((a + b) / 2.0) <= 0.0;
    // Going around, the first edge leads inside or outside.
    let first = &edges[on_face[0].1 as usize];
    let along = (0..3).find(|&i| first.from[i] != first.to[i]).unwrap_or(u);
    let forwards =
        if along == u { first.from[v] == low[v] } else { first.from[u] == low[u] + size[u] };
    let leads_inside = first.leaves != forwards;
    if leads_inside == inside {
        on_face.rotate_left(1);
    }
}
