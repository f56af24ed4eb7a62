//! What may be a face: the regions that edges bound in their planes and that no edge pierces.

use glam::{DVec2, DVec3};
use rustc_hash::FxHashSet;

use super::{
    WireframeError,
    graph::Graph,
    plane::{Plane, Ring, rings},
};

/// The most times that an edge is looked at for a plane: about a second.
const MOST_LOOKS: usize = 200_000_000;

/// A region of a plane.
pub struct Region {
    /// Its outer loop and then its holes.
    pub loops: Vec<Vec<u32>>,
    /// The edges of its loops.
    pub edges: Vec<u32>,
    /// Its outer area, mm^2.
    pub area: f64,
    /// Whether all points lie on one side of its plane.
    pub outside: bool,
    plane: Plane,
}

/// All regions that may be faces, in a fixed order.
pub fn regions(graph: &Graph) -> Result<Vec<Region>, WireframeError> {
    let (mut regions, mut seen) = (vec![], FxHashSet::default());
    let most = MOST_LOOKS / graph.edges.len();
    let mut planes = 0;
    for point in 0..graph.points.len() as u32 {
        let around = &graph.around[point as usize];
        for (i, &first) in around.iter().enumerate() {
            for &second in &around[i + 1..] {
                if seen.contains(&[first, second]) {
                    continue;
                }
                let [a, b] = [first, second].map(|e| graph.at(graph.other(e, point)));
                let at = graph.at(point);
                let Some(plane) = Plane::spanned(at, a - at, b - at) else { continue };
                planes += 1;
                if planes > most {
                    return Err(WireframeError::Planes(most));
                }
                regions.extend(in_plane(graph, &plane, &mut seen));
            }
        }
    }
    let mut known = FxHashSet::default();
    regions.retain(|region| known.insert(region.edges.clone()) && !region.is_pierced(graph));
    Ok(regions)
}

/// The regions of a plane; the pairs of edges that span it are noted.
fn in_plane(graph: &Graph, plane: &Plane, seen: &mut FxHashSet<[u32; 2]>) -> Vec<Region> {
    let within = |p: DVec3| plane.height(p).abs() <= graph.flat;
    let all = 0..graph.edges.len() as u32;
    let edges: Vec<u32> = all.filter(|&e| graph.ends(e).into_iter().all(within)).collect();
    let is_in: FxHashSet<u32> = edges.iter().copied().collect();
    for &edge in &edges {
        for end in graph.edges[edge as usize] {
            let others = graph.around[end as usize].iter().filter(|e| is_in.contains(e));
            seen.extend(others.filter(|e| **e != edge).map(|&e| [edge.min(e), edge.max(e)]));
        }
    }
    let outside = [1.0, -1.0]
        .into_iter()
        .any(|side| graph.points.iter().all(|p| plane.height(*p) * side <= graph.flat));
    let (outer, holes): (Vec<Ring>, Vec<Ring>) =
        rings(graph, plane, &edges).into_iter().partition(|ring| ring.area > 0.0);
    let homes: Vec<Option<usize>> = holes.iter().map(|h| home(graph, plane, &outer, h)).collect();
    let region = |(number, ring): (usize, &Ring)| {
        let own = homes.iter().zip(&holes).filter(|(home, _)| **home == Some(number));
        let mut loops = vec![ring.corners.clone()];
        loops.extend(own.map(|(_, hole)| hole.corners.clone()));
        let edges = edges_of(graph, &loops);
        Region { loops, edges, area: ring.area, outside, plane: *plane }
    };
    outer.iter().enumerate().map(region).collect()
}

/// The smallest loop that a hole lies in.
fn home(graph: &Graph, plane: &Plane, outer: &[Ring], hole: &Ring) -> Option<usize> {
    let flat =
        |ring: &[u32]| -> Vec<DVec2> { ring.iter().map(|&c| plane.flat(graph.at(c))).collect() };
    let inner = flat(&hole.corners);
    let middle = (inner[0] + inner[1]) / 2.0;
    let own = edges_of(graph, std::slice::from_ref(&hole.corners));
    // What has an edge with the hole lies in it.
    let around = |ring: &&(usize, &Ring)| {
        let larger = ring.1.area > -hole.area;
        let shared = || edges_of(graph, std::slice::from_ref(&ring.1.corners));
        larger
            && shared().iter().all(|edge| !own.contains(edge))
            && holds(&[flat(&ring.1.corners)], middle)
    };
    let all: Vec<(usize, &Ring)> = outer.iter().enumerate().collect();
    let smallest = all.iter().filter(around).min_by(|a, b| a.1.area.total_cmp(&b.1.area));
    smallest.map(|(number, _)| *number)
}

/// The edges of loops, sorted.
fn edges_of(graph: &Graph, loops: &[Vec<u32>]) -> Vec<u32> {
    let mut edges = vec![];
    for ring in loops {
        let next = ring.iter().cycle().skip(1);
        for (&a, &b) in ring.iter().zip(next) {
            let around = &graph.around[a as usize];
            edges.extend(around.iter().copied().find(|&e| graph.other(e, a) == b));
        }
    }
    edges.sort_unstable();
    edges
}

/// Whether a point is in a region by the even-odd rule.
fn holds(loops: &[Vec<DVec2>], p: DVec2) -> bool {
    let mut inside = false;
    for ring in loops {
        let next = ring.iter().cycle().skip(1);
        for (a, b) in ring.iter().zip(next) {
            let crosses = (a.y > p.y) != (b.y > p.y);
            inside ^= crosses && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y);
        }
    }
    inside
}

/// The distance from a point to a stretch.
fn distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let way = b - a;
    let t = ((p - a).dot(way) / way.length_squared()).clamp(0.0, 1.0);
    p.distance(a + way * t)
}

impl Region {
    /// Whether an edge passes through the inside of the region, lies in it or ends in it.
    fn is_pierced(&self, graph: &Graph) -> bool {
        let flat = |ring: &Vec<u32>| -> Vec<DVec2> {
            ring.iter().map(|&c| self.plane.flat(graph.at(c))).collect()
        };
        let loops: Vec<Vec<DVec2>> = self.loops.iter().map(flat).collect();
        let corners = || loops[0].iter().copied();
        let min = corners().reduce(DVec2::min).unwrap_or_default();
        let max = corners().reduce(DVec2::max).unwrap_or_default();
        (0..graph.edges.len() as u32).any(|edge| {
            self.edges.binary_search(&edge).is_err()
                && self.stabs(graph, edge).is_some_and(|p| {
                    let boxed = p.cmpgt(min).all() && p.cmplt(max).all();
                    boxed && is_within(&loops, p, graph.flat)
                })
        })
    }

    /// Where an edge meets the plane of the region: its middle if it lies in it.
    fn stabs(&self, graph: &Graph, edge: u32) -> Option<DVec2> {
        let [a, b] = graph.ends(edge);
        let [from, to] = [a, b].map(|p| self.plane.height(p));
        let lies = [from, to].map(|height| height.abs() <= graph.flat);
        let at = match lies {
            [true, true] => (a + b) / 2.0,
            [true, false] => a,
            [false, true] => b,
            _ if (from > 0.0) == (to > 0.0) => return None,
            _ => a.lerp(b, from / (from - to)),
        };
        Some(self.plane.flat(at))
    }
}

/// Whether a point is in a region and not on its boundary.
fn is_within(loops: &[Vec<DVec2>], p: DVec2, near: f64) -> bool {
    let beside = |ring: &Vec<DVec2>| {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).any(|(a, b)| distance(p, *a, *b) <= near)
    };
    holds(loops, p) && !loops.iter().any(beside)
}
