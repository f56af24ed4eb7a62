//! Cast shadows: where on each face the light does not reach.
//!
//! The sun is the first eye. What is nearer to it than a face, of all faces that it sees, is projected along
//! the rays onto the face; the outline of that is kept with the face. Of what is nearer only the rim counts:
//! edges between two faces that both are nearer run once each way and cancel, and the faces count as many
//! times as the rim winds around a place. So a shadow is as exact as coordinates are, and costs as many
//! edges as it has.

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::{
    facet::Facet,
    light::{Eye, Slope, Sun},
};
use crate::geom::{
    Bounds, Contour, Region,
    bvh::Bvh,
    overlay::{Fill, Rule, overlay},
};

/// A face turned from the sun to less than this (the cosine of its angle with the rays) is in the shade: its
/// tone is that of the shade to a ten-thousandth, and shadows on it would run far out of the picture.
const GRAZING: f64 = 1e-4;

/// Corners are in a plane when they are nearer to it than this part of the scene's size: far above rounding, far
/// below what is seen.
const FLUSH: f64 = 1e-11;

/// Where light of a sun falls on a facet.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Lit {
    /// Everywhere.
    All,
    /// Nowhere.
    None,
    /// Inside these contours, by the number of times they are crossed.
    Part(Vec<Vec<DVec3>>),
}

/// A scene as a sun sees it.
pub(super) struct Shadows<'a> {
    facets: &'a [Facet],
    eye: Eye,
    /// Facets that the sun sees, or would but for others, with their corners as it sees them, counter-clockwise.
    seen: Vec<Seen>,
    tree: Bvh,
    /// How near to a plane a point is in it, mm.
    flush: f64,
}

struct Seen {
    loops: Vec<Vec<DVec3>>,
    bounds: Bounds,
    slope: Slope,
    facet: u32,
}

impl<'a> Shadows<'a> {
    pub fn new(facets: &'a [Facet], sun: &Sun) -> Shadows<'a> {
        let eye = sun.eye();
        let seen = (0u32..).zip(facets).filter_map(|(number, facet)| {
            let cosine = facet.normal.dot(sun.toward());
            let wanted = if facet.open { cosine.abs() } else { cosine };
            (wanted > GRAZING).then(|| Seen::of(number, facet, &eye))
        });
        let seen: Vec<Seen> = seen.collect();
        let boxes: Vec<Bounds> = seen.iter().map(|s| s.bounds).collect();
        let tree = Bvh::new(&boxes);
        let size = (tree.bounds().max - tree.bounds().min).max_element();
        Shadows { facets, eye, seen, tree, flush: FLUSH * size.max(0.0) }
    }

    /// Where the sun shines on each facet; on the side it sees of those that have two.
    pub fn lit(&self) -> Vec<Lit> {
        let found: Vec<Lit> = self.seen.par_iter().map(|seen| self.on(seen)).collect();
        let mut lit = vec![Lit::None; self.facets.len()];
        for (seen, found) in self.seen.iter().zip(found) {
            lit[seen.facet as usize] = found;
        }
        lit
    }

    /// The shadow of everything above a horizontal plane on it.
    pub fn on_ground(&self, z: f64) -> Vec<Vec<DVec3>> {
        let slope = Slope::new(self.eye.see(DVec3::Z * z), self.eye.see(DVec3::Z));
        let mut rim = Rim::default();
        self.seen.iter().for_each(|seen| rim.add(seen, &slope, self.flush));
        let region = overlay(&rim.contours(), [], Rule::Union, Fill::Positive);
        self.lifted(&region, &slope)
    }

    /// The cast shadow on each facet that the sun sees, if there is one.
    pub fn cast(&self) -> Vec<(u32, Vec<Vec<DVec3>>)> {
        let cast = |seen: &Seen| {
            let contours = self.before(seen).contours();
            let own = seen.loops.iter().map(|l| flat(l)).collect::<Vec<_>>();
            let region = overlay(&own, &contours, Rule::Intersection, Fill::Positive);
            (!region.is_empty()).then(|| (seen.facet, self.lifted(&region, &seen.slope)))
        };
        let found: Vec<_> = self.seen.par_iter().map(cast).collect();
        found.into_iter().flatten().collect()
    }

    /// The rim of all that is between a facet and the sun.
    fn before(&self, seen: &Seen) -> Rim {
        let mut rim = Rim::default();
        let query = Bounds { max: seen.bounds.max.with_z(f64::INFINITY), ..seen.bounds };
        self.tree.visit(&query, |other| {
            let other = &self.seen[other as usize];
            if other.facet != seen.facet {
                rim.add(other, &seen.slope, self.flush);
            }
        });
        rim
    }

    fn on(&self, seen: &Seen) -> Lit {
        let rim = self.before(seen);
        if rim.edges.is_empty() {
            return Lit::All;
        }
        let own = seen.loops.iter().map(|l| flat(l)).collect::<Vec<_>>();
        let contours = rim.contours();
        let region = overlay(&own, &contours, Rule::Difference, Fill::Positive);
        match region.is_empty() {
            true => Lit::None,
            false if same_area(&own, &region) => Lit::All,
            false => Lit::Part(self.lifted(&region, &seen.slope)),
        }
    }

    /// A region seen from the sun, on a plane.
    fn lifted(&self, region: &Region, slope: &Slope) -> Vec<Vec<DVec3>> {
        let lift = |contour: &Contour| {
            contour.points.iter().map(|&p| self.eye.place(slope.at(p))).collect()
        };
        region.contours().map(lift).collect()
    }
}

/// Whether nothing is missing of contours.
fn same_area(own: &[Contour], region: &Region) -> bool {
    let area: f64 = own.iter().map(Contour::area).sum();
    region.contours().map(|c| c.points.len()).eq(own.iter().map(|c| c.points.len()))
        && area - region.area() <= area * f64::EPSILON * 16.0
}

fn flat(corners: &[DVec3]) -> Contour {
    Contour::polygon(corners.iter().map(|p| p.truncate()).collect())
}

impl Seen {
    fn of(number: u32, facet: &Facet, eye: &Eye) -> Seen {
        let normal = eye.see(facet.normal);
        let is_back = normal.z < 0.0;
        let mut loops: Vec<Vec<DVec3>> =
            facet.loops.iter().map(|l| l.iter().map(|p| eye.see(*p)).collect()).collect();
        if is_back {
            loops.iter_mut().for_each(|corners| corners.reverse());
        }
        let bounds = Bounds::of(loops.iter().flatten().copied());
        let slope = Slope::new(loops[0][0], normal);
        Seen { loops, bounds, slope, facet: number }
    }
}

/// The rim of what is nearer to the sun than a plane: directed edges as the sun sees them.
#[derive(Default)]
struct Rim {
    edges: Vec<(DVec2, DVec2)>,
}

impl Rim {
    /// Adds the part of a facet that is nearer than a plane.
    fn add(&mut self, seen: &Seen, slope: &Slope, flush: f64) {
        let height = |p: DVec3| {
            let height = slope.height(p);
            if height.abs() <= flush { 0.0 } else { height }
        };
        let heights = || seen.loops.iter().flatten().map(|p| height(*p));
        if heights().all(|h| h <= 0.0) {
            return;
        }
        if heights().all(|h| h >= 0.0) {
            for corners in &seen.loops {
                edges(corners).for_each(|(p, q)| self.edges.push((p.truncate(), q.truncate())));
            }
            return;
        }
        self.add_cut(seen, height);
    }

    /// Adds a facet that the plane cuts: what is above, closed along the cut.
    fn add_cut(&mut self, seen: &Seen, height: impl Fn(DVec3) -> f64) {
        // Where the outline goes below the plane, and where it comes up again.
        let (mut down, mut up) = (vec![], vec![]);
        for (p, q) in seen.loops.iter().flat_map(|corners| edges(corners)) {
            let (s, t) = (height(p), height(q));
            let (from, to) = (p.truncate(), q.truncate());
            match (s >= 0.0, t >= 0.0) {
                (true, true) => self.edges.push((from, to)),
                (false, false) => {}
                (true, false) => {
                    let cut = cut((from, s), (to, t));
                    self.edges.push((from, cut));
                    down.push(cut);
                }
                (false, true) => {
                    let cut = cut((to, t), (from, s));
                    self.edges.push((cut, to));
                    up.push(cut);
                }
            }
        }
        let along = |p: &DVec2| (p.x, p.y);
        let order = |p: &DVec2, q: &DVec2| {
            along(p).partial_cmp(&along(q)).unwrap_or(std::cmp::Ordering::Equal)
        };
        // Any pairing of them has the same edges when what runs both ways cancels.
        down.sort_by(order);
        up.sort_by(order);
        self.edges.extend(down.into_iter().zip(up));
    }

    /// Closed contours of the edges that are left when what runs both ways cancels.
    fn contours(&self) -> Vec<Contour> {
        let key = |p: DVec2| [p.x, p.y].map(|c| (c + 0.0).to_bits());
        let mut numbers: FxHashMap<[u64; 2], u32> = FxHashMap::default();
        let mut points: Vec<DVec2> = vec![];
        let mut number = |p: DVec2| {
            *numbers.entry(key(p)).or_insert_with(|| {
                points.push(p);
                points.len() as u32 - 1
            })
        };
        let mut edges: Vec<(u32, u32)> = self
            .edges
            .iter()
            .map(|&(p, q)| (number(p), number(q)))
            .filter(|e| e.0 != e.1)
            .collect();
        cancel(&mut edges);
        trace(edges)
            .into_iter()
            .map(|walk| Contour::polygon(walk.into_iter().map(|p| points[p as usize]).collect()))
            .filter(|contour| contour.points.len() > 2)
            .collect()
    }
}

/// The point between a corner above and one below where the height is 0.
fn cut((above, s): (DVec2, f64), (below, t): (DVec2, f64)) -> DVec2 {
    if s == 0.0 { above } else { above + (below - above) * (s / (s - t)) }
}

fn edges(corners: &[DVec3]) -> impl Iterator<Item = (DVec3, DVec3)> {
    corners.iter().copied().zip(corners.iter().copied().cycle().skip(1))
}

/// Leaves out pairs of edges that run opposite ways.
fn cancel(edges: &mut Vec<(u32, u32)>) {
    edges.sort_unstable_by_key(|&(a, b)| (a.min(b), a.max(b), a));
    let mut kept = vec![];
    for same in edges.chunk_by(|x, y| (x.0.min(x.1), x.0.max(x.1)) == (y.0.min(y.1), y.0.max(y.1)))
    {
        let forward = same.iter().filter(|e| e.0 < e.1).count();
        let back = same.len() - forward;
        let (low, high) = (same[0].0.min(same[0].1), same[0].0.max(same[0].1));
        kept.extend(std::iter::repeat_n((low, high), forward.saturating_sub(back)));
        kept.extend(std::iter::repeat_n((high, low), back.saturating_sub(forward)));
    }
    *edges = kept;
}

/// Closed walks over edges of which as many leave each point as come to it.
fn trace(mut edges: Vec<(u32, u32)>) -> Vec<Vec<u32>> {
    edges.sort_unstable();
    let mut used = vec![false; edges.len()];
    let mut walks = vec![];
    let mut next: FxHashMap<u32, usize> = FxHashMap::default();
    edges.iter().enumerate().rev().for_each(|(i, edge)| {
        next.insert(edge.0, i);
    });
    for start in 0..edges.len() {
        if used[start] {
            continue;
        }
        let (mut walk, mut at) = (vec![], start);
        loop {
            used[at] = true;
            walk.push(edges[at].0);
            let to = edges[at].1;
            let Some(slot) = next.get_mut(&to) else { break };
            while *slot < edges.len() && edges[*slot].0 == to && used[*slot] {
                *slot += 1;
            }
            if *slot == edges.len() || edges[*slot].0 != to {
                break;
            }
            at = *slot;
        }
        walks.push(walk);
    }
    walks
}
