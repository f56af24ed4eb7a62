//! The cell complex: every piece of every facet, and how the pieces meet along edges.
//!
//! A cell is a polygon, possibly with holes, in one plane; it has an upper side, where its normal
//! points, and a lower one. The normal is that of its plane, or the facet's own for a facet that
//! nothing touches.

use super::{
    facet::Facets,
    space::{NONE, Space},
};

/// A polygon that no facet crosses.
struct Cell {
    plane: u32,
    /// One past its last entry of `covers`.
    cover_end: u32,
}

/// One step along the boundary of a cell, the cell on its left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Half {
    /// Where it starts.
    pub origin: u32,
    /// The place of that point among those of the complex, once it is finished.
    pub at: u32,
    /// What follows around the cell.
    pub next: u32,
    /// The plane that, with the cell's, holds the line; [`NONE`] between lattice points of untouched
    /// facets.
    pub support: u32,
    /// The cell.
    pub cell: u32,
    /// The edge it runs along, once the complex is finished.
    pub edge: u32,
}

/// All cells of an operation.
#[derive(Default)]
pub(super) struct Complex {
    cells: Vec<Cell>,
    /// Facets over each cell, and how often: positive when the facet faces up.
    covers: Vec<(u32, i32)>,
    /// The half-edges of all cells, a cell's together.
    pub halves: Vec<Half>,
    loop_start: u32,
    /// The number of points met.
    points: usize,
    /// The cell that stands for the first patch; those of the others follow to the end.
    pub first_patch: u32,
    /// The half-edges along every edge: `incident[edge_ends[e-1]..edge_ends[e]]`.
    incident: Vec<u32>,
    edge_ends: Vec<u32>,
}

impl Complex {
    /// The number of points met, once the complex is finished.
    pub fn point_count(&self) -> usize {
        self.points
    }

    /// Adds all cells of another complex that is not finished either.
    pub fn append(&mut self, other: Complex) {
        let [covers, cells, halves] =
            [self.covers.len(), self.cells.len(), self.halves.len()].map(|count| count as u32);
        self.covers.extend(other.covers);
        self.cells
            .extend(other.cells.into_iter().map(|c| Cell { cover_end: c.cover_end + covers, ..c }));
        self.halves.extend(other.halves.into_iter().map(|half| Half {
            next: half.next + halves,
            cell: half.cell + cells,
            ..half
        }));
        self.loop_start = self.halves.len() as u32;
    }

    /// Begins a cell; its loops follow.
    pub fn begin_cell(&mut self, plane: u32, cover: impl Iterator<Item = (u32, i32)>) {
        self.covers.extend(cover);
        self.cells.push(Cell { plane, cover_end: self.covers.len() as u32 });
    }

    /// Adds a step of a loop.
    pub fn push_half(&mut self, origin: u32, support: u32) {
        let (next, cell) = (self.halves.len() as u32 + 1, self.cells.len() as u32 - 1);
        self.halves.push(Half { origin, at: NONE, next, support, cell, edge: 0 });
    }

    /// Closes a loop.
    pub fn end_loop(&mut self) {
        let end = self.halves.len() as u32;
        self.halves[end as usize - 1].next = self.loop_start;
        self.loop_start = end;
    }

    /// Adds cells without a boundary that stand for patches, each given by a facet of its operand.
    pub fn add_patches(&mut self, owners: impl Iterator<Item = u32>) {
        self.first_patch = self.cells.len() as u32;
        owners.for_each(|facet| self.begin_cell(NONE, [(facet, 1)].into_iter()));
    }

    /// The number of cells, those that stand for patches with them.
    pub fn cell_count(&self) -> usize {
        self.cells.len()
    }

    /// The facets over a cell, and how often; positive when the facet faces up.
    pub fn cover(&self, cell: u32) -> &[(u32, i32)] {
        let start = if cell == 0 { 0 } else { self.cells[cell as usize - 1].cover_end };
        &self.covers[start as usize..self.cells[cell as usize].cover_end as usize]
    }

    /// The plane of a cell, [`NONE`] in untouched facets.
    pub fn plane(&self, cell: u32) -> u32 {
        self.cells[cell as usize].plane
    }

    /// A cell's normal: a plane and whether the normal is against the plane's.
    pub fn normal(&self, cell: u32, facets: &mut Facets, space: &mut Space) -> (u32, bool) {
        match self.plane(cell) {
            NONE => facets.plane(self.cover(cell)[0].0, space),
            plane => (plane, false),
        }
    }

    /// Where a half-edge ends.
    pub fn target(&self, half: u32) -> u32 {
        self.halves[self.halves[half as usize].next as usize].origin
    }

    /// The number of edges.
    pub fn edge_count(&self) -> usize {
        self.edge_ends.len()
    }

    /// The half-edges along an edge.
    pub fn around(&self, edge: usize) -> &[u32] {
        let start = if edge == 0 { 0 } else { self.edge_ends[edge - 1] };
        &self.incident[start as usize..self.edge_ends[edge] as usize]
    }

    /// Whether a half-edge runs from the smaller point number to the larger.
    pub fn is_forward(&self, half: u32) -> bool {
        self.halves[half as usize].origin < self.target(half)
    }

    /// Finds the half-edges that run along the same edges: those with the same smaller point are
    /// brought together by counting, and sorted by their larger point. `count` is the number of points
    /// of the space.
    pub fn finish(&mut self, count: usize) {
        self.number_points(count);
        let points = self.points;
        let target = |half: &Half| self.halves[half.next as usize].at;
        let ends = self.halves.iter().map(|half| (half.at, target(half)));
        let ends: Vec<(u32, u32)> = ends.map(|(a, b)| (a.min(b), a.max(b))).collect();
        let mut fill = vec![0u32; points + 1];
        ends.iter().for_each(|&(low, _)| fill[low as usize + 1] += 1);
        (0..points).for_each(|i| fill[i + 1] += fill[i]);
        let starts = fill.clone();
        let mut incident = vec![0u32; ends.len()];
        for (half, &(low, _)) in (0u32..).zip(&ends) {
            let slot = &mut fill[low as usize];
            incident[*slot as usize] = half;
            *slot += 1;
        }
        for range in starts.windows(2) {
            let run = &mut incident[range[0] as usize..range[1] as usize];
            run.sort_unstable_by_key(|&half| (ends[half as usize].1, half));
        }
        for (i, &half) in incident.iter().enumerate() {
            if i > 0 && ends[incident[i - 1] as usize] != ends[half as usize] {
                self.edge_ends.push(i as u32);
            }
            self.halves[half as usize].edge = self.edge_ends.len() as u32;
        }
        if !incident.is_empty() {
            self.edge_ends.push(incident.len() as u32);
        }
        self.incident = incident;
    }

    /// Gives the points met places of their own.
    fn number_points(&mut self, count: usize) {
        // One more than the place of each point.
        let mut places = vec![0; count];
        for half in &mut self.halves {
            let place = &mut places[half.origin as usize];
            if *place == 0 {
                self.points += 1;
                *place = self.points as u32;
            }
            half.at = *place - 1;
        }
    }

    /// Sorts half-edges along one edge by the angle of their cells around it, counter-clockwise seen
    /// against the direction from its smaller point to its larger.
    pub fn sort_radially(&self, around: &mut [u32], facets: &mut Facets, space: &mut Space) {
        let half = around[0];
        let (mut a, mut b) = (self.halves[half as usize].origin, self.target(half));
        if a > b {
            (a, b) = (b, a);
        }
        let (axis, sign) = space.direction(a, b);
        let first = self.spoke(half, facets, space);
        let mut spokes: Vec<(u8, Spoke)> = Vec::with_capacity(around.len());
        for &half in &*around {
            let spoke = self.spoke(half, facets, space);
            spokes.push((first.part(&spoke, axis, sign), spoke));
        }
        spokes.sort_by(|(part, p), (other, q)| {
            part.cmp(other).then_with(|| q.turn(p, axis, sign).cmp(&0))
        });
        for (slot, (_, spoke)) in around.iter_mut().zip(spokes) {
            *slot = spoke.half;
        }
    }

    /// The direction of a cell seen from one of its edges, turned by a right angle about the edge.
    pub fn spoke(&self, half: u32, facets: &mut Facets, space: &mut Space) -> Spoke {
        let (plane, turned) = self.normal(self.halves[half as usize].cell, facets, space);
        let normal = space.plane(plane).normal;
        let against = turned == self.is_forward(half);
        Spoke { half, normal: if against { normal.map(|c| -c) } else { normal } }
    }
}

/// Relative error of a product of two integers converted to doubles, with room for the difference.
const TURN_ERROR: f64 = 4.0 * f64::EPSILON;

/// A cell seen from one of its edges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spoke {
    /// The half-edge.
    pub half: u32,
    /// Its cell lies where this vector, turned by -90 degrees about the edge, points.
    normal: [i64; 3],
}

impl Spoke {
    /// The sign of the turn to another spoke; `sign` is that of the edge's direction along `axis`.
    pub fn turn(&self, other: &Spoke, axis: usize, sign: i32) -> i32 {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let [a, b] = [&self.normal, &other.normal];
        let (x, y) = (a[i] as f64 * b[j] as f64, a[j] as f64 * b[i] as f64);
        if (x - y).abs() > (x.abs() + y.abs()) * TURN_ERROR {
            return if x > y { sign } else { -sign };
        }
        let product = |i: usize, j: usize| i128::from(a[i]) * i128::from(b[j]);
        (product(i, j) - product(j, i)).signum() as i32 * sign
    }

    /// 0 in the same direction, 1 less than half a turn on, 2 opposite, 3 beyond.
    fn part(&self, other: &Spoke, axis: usize, sign: i32) -> u8 {
        match self.turn(other, axis, sign) {
            1 => 1,
            -1 => 3,
            _ if crate::geom::predicates::dot(self.normal, other.normal) > 0 => 0,
            _ => 2,
        }
    }
}
