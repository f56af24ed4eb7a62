//! Points and the edges between them.

use glam::DVec3;
use rustc_hash::FxHashSet;

use super::{FLAT, MOST_EDGES, SAME, WireframeError};
use crate::geom::Bounds;

/// Points and the edges between them, each once.
pub struct Graph {
    pub points: Vec<DVec3>,
    pub edges: Vec<[u32; 2]>,
    /// For each point its edges.
    pub around: Vec<Vec<u32>>,
    /// How far a point may be from a plane that it lies in, mm.
    pub flat: f64,
}

impl Graph {
    /// Joins equal points and cuts edges at points that lie on them.
    pub fn new(edges: &[[DVec3; 2]]) -> Result<Graph, WireframeError> {
        many(edges.len())?;
        let size = Bounds::of(edges.iter().flatten().copied());
        let size = (size.max - size.min).length().max(f64::MIN_POSITIVE);
        let (points, number) = welded(edges, size * SAME);
        let pairs = number.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
        let mut graph = Graph { points, edges: vec![], around: vec![], flat: size * FLAT };
        let whole: Vec<[u32; 2]> = pairs.filter(|[a, b]| a != b).collect();
        let mut known = FxHashSet::default();
        for edge in whole {
            let cut = graph.cut(edge, size * SAME);
            let new = |pair: &[u32; 2]| known.insert([pair[0].min(pair[1]), pair[0].max(pair[1])]);
            graph.edges.extend(cut.into_iter().filter(new));
            many(graph.edges.len())?;
        }
        graph.around = vec![vec![]; graph.points.len()];
        for (edge, number) in graph.edges.iter().zip(0..) {
            edge.iter().for_each(|&end| graph.around[end as usize].push(number));
        }
        Ok(graph)
    }

    /// An edge from point to point of those that lie on it.
    fn cut(&self, [a, b]: [u32; 2], near: f64) -> Vec<[u32; 2]> {
        let (from, way) = (self.at(a), self.at(b) - self.at(a));
        let on = |i: u32| {
            let p = self.at(i) - from;
            let t = p.dot(way) / way.length_squared();
            let within = t > 0.0 && t < 1.0 && (p - way * t).length() <= near;
            (within && i != a && i != b).then_some((t, i))
        };
        let mut stops: Vec<(f64, u32)> = (0..self.points.len() as u32).filter_map(on).collect();
        stops.sort_by(|s, t| s.0.total_cmp(&t.0));
        let mut ends = vec![a];
        ends.extend(stops.into_iter().map(|(_, i)| i));
        ends.push(b);
        ends.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }

    /// The place of a point.
    pub fn at(&self, point: u32) -> DVec3 {
        self.points[point as usize]
    }

    /// The places of the ends of an edge.
    pub fn ends(&self, edge: u32) -> [DVec3; 2] {
        self.edges[edge as usize].map(|end| self.at(end))
    }

    /// The other end of an edge.
    pub fn other(&self, edge: u32, end: u32) -> u32 {
        let [a, b] = self.edges[edge as usize];
        if a == end { b } else { a }
    }

    /// Whether every point has edges enough to be a corner of a solid, or a point on an edge or a face.
    pub fn check(&self) -> Result<(), WireframeError> {
        if self.edges.len() < 6 {
            return Err(WireframeError::Few(self.edges.len()));
        }
        let loose = |&p: &u32| match self.around[p as usize][..] {
            [a, b] => {
                let way = |edge| (self.at(self.other(edge, p)) - self.at(p)).normalize_or_zero();
                way(a).dot(way(b)) > -STRAIGHT
            }
            ref edges => edges.len() == 1,
        };
        let all: Vec<u32> = (0..self.points.len() as u32).filter(loose).collect();
        let Some(&first) = all.first() else { return Ok(()) };
        let edges = self.around[first as usize].len();
        Err(WireframeError::Loose { at: self.at(first), edges, points: all.len() })
    }
}

/// The cosine of the angle below which two edges are in line: what [`SAME`] leaves of edges a thousandth of the size.
const STRAIGHT: f64 = 1.0 - 1e-8;

fn many(found: usize) -> Result<(), WireframeError> {
    if found <= MOST_EDGES {
        return Ok(());
    }
    Err(WireframeError::Many { found, limit: MOST_EDGES })
}

/// The different points of edges in their order, and the number of each end among them.
fn welded(edges: &[[DVec3; 2]], near: f64) -> (Vec<DVec3>, Vec<u32>) {
    let ends: Vec<DVec3> = edges.iter().flatten().copied().collect();
    let mut order: Vec<usize> = (0..ends.len()).collect();
    order.sort_by(|&i, &j| ends[i].x.total_cmp(&ends[j].x).then(i.cmp(&j)));
    let mut first: Vec<usize> = (0..ends.len()).collect();
    for (place, &i) in order.iter().enumerate() {
        let beside = order[place + 1..].iter().take_while(|&&j| ends[j].x - ends[i].x <= near);
        for &j in beside.filter(|&&j| ends[j].distance(ends[i]) <= near) {
            let (a, b) = (root(&first, i), root(&first, j));
            first[a.max(b)] = a.min(b);
        }
    }
    let (mut points, mut number) = (vec![], vec![0; ends.len()]);
    for i in 0..ends.len() {
        let own = root(&first, i);
        if own == i {
            number[i] = points.len() as u32;
            points.push(ends[i]);
        }
        number[i] = number[own];
    }
    (points, number)
}

/// The first of the points that are one with a point.
fn root(first: &[usize], mut i: usize) -> usize {
    while first[i] != i {
        i = first[i];
    }
    i
}
