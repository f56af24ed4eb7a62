//! The edges in one plane, and the smallest loops they make there.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3, dvec2};

use super::graph::Graph;

/// A plane with axes of its own.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    pub at: DVec3,
    pub normal: DVec3,
    axis: DVec3,
}

impl Plane {
    /// The plane through a point with two directions; none if they are parallel.
    pub fn spanned(at: DVec3, a: DVec3, b: DVec3) -> Option<Plane> {
        let (a, b) = (a.normalize_or_zero(), b.normalize_or_zero());
        let normal = a.cross(b);
        (normal.length() > PARALLEL).then(|| Plane { at, normal: normal.normalize(), axis: a })
    }

    /// How far a point is above the plane.
    pub fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p - self.at)
    }

    /// A point in the axes of the plane.
    pub fn flat(&self, p: DVec3) -> DVec2 {
        let p = p - self.at;
        dvec2(p.dot(self.axis), p.dot(self.normal.cross(self.axis)))
    }
}

/// The sine of the angle below which two edges span no plane.
const PARALLEL: f64 = 1e-6;

/// Points in order around an area on the left, and that area; negative for the outside of edges that hang together.
pub struct Ring {
    pub corners: Vec<u32>,
    pub area: f64,
}

/// A point's neighbours in a plane, counter-clockwise.
type Star = BTreeMap<u32, Vec<u32>>;

/// The loops of the edges in a plane, turning at each point to the next edge; edges with the same region on both sides left
/// out.
pub fn rings(graph: &Graph, plane: &Plane, edges: &[u32]) -> Vec<Ring> {
    let mut star = star(graph, plane, edges);
    let mut walks = walks(&star);
    let bridges = bridges(&walks);
    if !bridges.is_empty() {
        for [a, b] in bridges {
            star.entry(a).and_modify(|ends| ends.retain(|end| *end != b));
        }
        walks = self::walks(&star);
    }
    let ring = |corners: Vec<u32>| Ring { area: area(graph, plane, &corners), corners };
    walks.into_iter().flat_map(|walk| simple(&walk)).map(ring).collect()
}

fn star(graph: &Graph, plane: &Plane, edges: &[u32]) -> Star {
    let mut star = Star::new();
    for &edge in edges {
        let [a, b] = graph.edges[edge as usize];
        star.entry(a).or_default().push(b);
        star.entry(b).or_default().push(a);
    }
    for (&point, ends) in &mut star {
        let from = plane.flat(graph.at(point));
        let angle = |end: &u32| {
            let way = plane.flat(graph.at(*end)) - from;
            libm::atan2(way.y, way.x)
        };
        ends.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    }
    star
}

/// All walks with an area on the left, each edge once each way.
fn walks(star: &Star) -> Vec<Vec<u32>> {
    let mut next = BTreeMap::new();
    for (&point, ends) in star {
        for (i, &from) in ends.iter().enumerate() {
            next.insert([from, point], ends[(i + ends.len() - 1) % ends.len()]);
        }
    }
    let mut walks = vec![];
    while let Some((&start, _)) = next.first_key_value() {
        let (mut step, mut walk) = (start, vec![]);
        while let Some(end) = next.remove(&step) {
            walk.push(step[0]);
            step = [step[1], end];
        }
        walks.push(walk);
    }
    walks
}

/// Edges, both ways, with the same walk on both sides.
fn bridges(walks: &[Vec<u32>]) -> Vec<[u32; 2]> {
    let mut owner = BTreeMap::new();
    for (number, walk) in walks.iter().enumerate() {
        for (i, &a) in walk.iter().enumerate() {
            owner.insert([a, walk[(i + 1) % walk.len()]], number);
        }
    }
    let same = |&(&[a, b], number): &(&[u32; 2], &usize)| owner.get(&[b, a]) == Some(number);
    owner.iter().filter(same).map(|(edge, _)| *edge).collect()
}

/// A walk as loops that meet no point twice.
fn simple(walk: &[u32]) -> Vec<Vec<u32>> {
    let (mut loops, mut open): (Vec<Vec<u32>>, Vec<u32>) = (vec![], vec![]);
    for &point in walk {
        if let Some(place) = open.iter().position(|known| *known == point) {
            loops.push(open.split_off(place));
        }
        open.push(point);
    }
    loops.push(open);
    loops.retain(|ring| ring.len() > 2);
    loops
}

fn area(graph: &Graph, plane: &Plane, corners: &[u32]) -> f64 {
    let flat: Vec<DVec2> = corners.iter().map(|&c| plane.flat(graph.at(c))).collect();
    let next = flat.iter().cycle().skip(1);
    flat.iter().zip(next).map(|(a, b)| (*a - flat[0]).perp_dot(*b - flat[0])).sum::<f64>() / 2.0
}
