//! The planar graph of an arrangement: edges, the fans of half-edges around points, and the walks
//! around cells.

use std::cmp::Ordering;

use super::space::{NEAR, Space, main_axis};
use crate::geom::wide::Wide;

/// An edge of the arrangement, from the point with the smaller number to the other.
pub(super) struct Edge {
    pub a: u32,
    pub b: u32,
    /// The plane that cuts the plane of the arrangement in it.
    pub support: u32,
    /// Facets on its left (1) and right (-1): a range of `crossings`.
    crossings: (u32, u32),
    /// Its direction, nearly, in the plane's two coordinates; the sign of the first coordinate that
    /// is not zero is right.
    near: [f64; 2],
}

/// A plane's arrangement: half-edge 2 e runs from a to b of edge e, 2 e + 1 back.
#[derive(Default)]
pub(super) struct Graph {
    /// The plane.
    pub plane: u32,
    /// The two axes that are the plane's coordinates, in right-handed order.
    pub axes: [usize; 2],
    /// The edges.
    pub edges: Vec<Edge>,
    /// What crossing edges changes.
    pub crossings: Vec<(u32, i32)>,
    /// The half-edge that follows around the cell on the left.
    next: Vec<u32>,
    /// The boundary walk that a half-edge belongs to.
    pub walk: Vec<u32>,
    /// A half-edge of every walk.
    pub walks: Vec<u32>,
    /// The points met, sorted by number; the half-edges from `fan_ends[i-1]` to `fan_ends[i]` leave
    /// point i.
    pub points: Vec<u32>,
    fans: Vec<(u32, u32)>,
    fan_ends: Vec<u32>,
}

/// Relative error of a cross product of directions that were rounded to doubles.
const CROSS_ERROR: f64 = 8.0 * f64::EPSILON;

/// How far a coordinate of a direction between two points may be from where doubles say it is.
const DIRECTION_ERROR: f64 = 4.0 * NEAR;

impl Graph {
    /// An empty arrangement of a plane.
    pub fn of(plane: u32, space: &Space) -> Graph {
        let mut graph = Graph { plane, ..Graph::default() };
        graph.start(space);
        graph
    }

    /// Begins the arrangement of the plane that is set.
    pub fn start(&mut self, space: &Space) {
        let normal = space.plane(self.plane).normal;
        let main = main_axis(normal.map(i128::from));
        let axes = [(main + 1) % 3, (main + 2) % 3];
        self.axes = if normal[main] < 0 { [axes[1], axes[0]] } else { axes };
        self.edges.clear();
        self.crossings.clear();
    }

    /// Adds an edge; its crossings are those from `start` on.
    pub fn add_edge(&mut self, (a, b): (u32, u32), support: u32, start: u32, space: &Space) {
        let crossings = (start, self.crossings.len() as u32);
        let (p, q) = (space.near(a), space.near(b));
        let mut near = self.axes.map(|axis| q[axis] - p[axis]);
        for (near, axis) in near.iter_mut().zip(self.axes) {
            if near.abs() <= DIRECTION_ERROR {
                let sign = f64::from(space.compare(b, a, axis) as i8);
                *near = sign * near.abs().max(f64::MIN_POSITIVE);
            }
        }
        self.edges.push(Edge { a, b, support, crossings, near });
    }

    /// Where a half-edge starts.
    pub fn origin(&self, half: u32) -> u32 {
        let edge = &self.edges[half as usize / 2];
        if half & 1 == 0 { edge.a } else { edge.b }
    }

    /// The half-edges that leave a point, by its place in `points`, in counter-clockwise order.
    pub fn fan(&self, place: usize) -> impl Iterator<Item = u32> + '_ {
        let start = if place == 0 { 0 } else { self.fan_ends[place - 1] };
        self.fans[start as usize..self.fan_ends[place] as usize].iter().map(|f| f.1)
    }

    /// The place of a point in `points`.
    pub fn place(&self, point: u32) -> usize {
        self.points.binary_search(&point).expect("a point of this arrangement")
    }

    /// Calls `visit` with the half-edges of a walk in order.
    pub fn around(&self, walk: u32, mut visit: impl FnMut(u32)) {
        let start = self.walks[walk as usize];
        let mut half = start;
        loop {
            visit(half);
            half = self.next[half as usize];
            if half == start {
                return;
            }
        }
    }

    /// Changes what covers the cell left of a half-edge, which the list holds from `start` on, to what
    /// covers the cell right of it.
    pub fn cross(&self, half: u32, start: usize, cover: &mut Vec<(u32, i32)>) {
        let (from, to) = self.edges[half as usize / 2].crossings;
        let turn = if half & 1 == 0 { -1 } else { 1 };
        for &(facet, left) in &self.crossings[from as usize..to as usize] {
            match cover[start..].binary_search_by_key(&facet, |c| c.0) {
                Ok(i) if cover[start + i].1 + left * turn == 0 => drop(cover.remove(start + i)),
                Ok(i) => cover[start + i].1 += left * turn,
                Err(i) => cover.insert(start + i, (facet, left * turn)),
            }
        }
    }

    /// Sorts the half-edges that leave each point by angle.
    pub fn sort_fans(&mut self, space: &Space) {
        let mut fans = std::mem::take(&mut self.fans);
        fans.clear();
        for (edge, Edge { a, b, .. }) in (0u32..).zip(&self.edges) {
            fans.extend([(*a, 2 * edge), (*b, 2 * edge + 1)]);
        }
        fans.sort_unstable();
        self.points.clear();
        self.fan_ends.clear();
        let mut end = 0;
        for fan in fans.chunk_by_mut(|f, g| f.0 == g.0) {
            self.points.push(fan[0].0);
            end += fan.len() as u32;
            self.fan_ends.push(end);
            if fan.len() > 2 {
                // Two are in order anyway.
                fan.sort_by(|f, g| self.by_angle(f.1, g.1, space));
            }
        }
        self.fans = fans;
    }

    /// Orders half-edges that leave one point by angle, from just above -90 degrees.
    pub fn by_angle(&self, g: u32, h: u32, space: &Space) -> Ordering {
        let (p, q) = (self.near(g), self.near(h));
        let left = |d: [f64; 2]| d[0] < 0.0 || (d[0] == 0.0 && d[1] < 0.0);
        left(p).cmp(&left(q)).then_with(|| {
            let (x, y) = (p[0] * q[1], p[1] * q[0]);
            let value = x - y;
            let size = p[0].abs() + p[1].abs() + q[0].abs() + q[1].abs() + DIRECTION_ERROR;
            if value.abs() > (x.abs() + y.abs()) * CROSS_ERROR + size * DIRECTION_ERROR {
                return 0.0.partial_cmp(&value).unwrap_or(Ordering::Equal);
            }
            let [d, e] = [g, h].map(|half| self.direction(half, space).map(Wide::<4>::from));
            0.cmp(&(d[0] * e[1] - d[1] * e[0]).sign())
        })
    }

    /// Whether an edge runs from a to b along the cross product of the normals of the plane and its
    /// support.
    pub fn is_along(&self, edge: &Edge, space: &Space) -> bool {
        let line = space.line(self.plane, edge.support);
        let axis = main_axis(line);
        (space.compare(edge.b, edge.a, axis) as i128) * line[axis].signum() > 0
    }

    /// The direction of a half-edge in the plane's two coordinates, exactly.
    fn direction(&self, half: u32, space: &Space) -> [i128; 2] {
        let edge = &self.edges[half as usize / 2];
        let line = space.line(self.plane, edge.support);
        let along = self.is_along(edge, space) == (half & 1 == 0);
        self.axes.map(|axis| if along { line[axis] } else { -line[axis] })
    }

    fn near(&self, half: u32) -> [f64; 2] {
        let d = self.edges[half as usize / 2].near;
        if half & 1 == 0 { d } else { [-d[0], -d[1]] }
    }

    /// Around the cell on its left, a half-edge is followed by the one that leaves its end next in
    /// clockwise order from its way back.
    pub fn link(&mut self) {
        self.next.clear();
        self.next.resize(self.fans.len(), 0);
        for fan in self.fans.chunk_by(|f, g| f.0 == g.0) {
            let mut before = fan[fan.len() - 1].1;
            for &(_, back) in fan {
                self.next[back as usize ^ 1] = before;
                before = back;
            }
        }
    }

    /// Numbers the walks around cells.
    pub fn number_walks(&mut self) {
        self.walk.clear();
        self.walk.resize(self.next.len(), u32::MAX);
        self.walks.clear();
        for start in 0..self.next.len() as u32 {
            let mut half = start;
            while self.walk[half as usize] == u32::MAX {
                self.walk[half as usize] = self.walks.len() as u32;
                half = self.next[half as usize];
            }
            if half == start && self.walk[start as usize] == self.walks.len() as u32 {
                self.walks.push(start);
            }
        }
    }
}
