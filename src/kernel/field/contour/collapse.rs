//! A surface with fewer triangles, still within the tolerance.
//!
//! Hoppe, H., DeRose, T., Duchamp, T., McDonald, J., Stuetzle, W.: *Mesh optimization*, 1993 (edge collapse and when
//! it keeps a manifold); Klein, R., Liebich, G., Straßer, W.: *Mesh reduction with error control*, 1996 (points that
//! were left out are remembered by the triangles that stand for them).
//!
//! A point moves onto one of its neighbours if then the middles of the triangles around and of their edges are
//! within the tolerance of the surface, and all points that were left out are within it of these triangles. So
//! the surface is near the triangles, and the triangles are near it. Points on sharp edges move along these only.

use std::{cmp::Reverse, collections::BinaryHeap};

use glam::DVec3;

use super::{Level, octree::Octree, surface::Surface};
use crate::kernel::field::triangle::Triangle;

/// Triangles that turn by more than this in a step fold; cosine.
const TURN: f64 = 0.5;
/// Edges between triangles that turn by more than this are sharp; cosine.
const SHARP: f64 = 0.8;
/// A share of the tolerance by which points on sharp edges may leave the planes around.
const EXACT: f64 = 1e-3;
/// Times the tolerance by which points of round parts may leave them: where a neighbour is off by more, the surface
/// between cannot be near.
const ROUND: f64 = 3.0;
/// The height of a triangle that is too thin, relative to its longest side.
const THIN: f64 = 0.02;
/// What short steps are preferred by.
const SHORT: f64 = 1e-3;
/// So many neighbours are tried, nearest to the planes around first.
const TRIED: usize = 3;

/// A point that may move, by how far from the planes around it its target is; then by its number.
#[derive(Clone, Copy, PartialEq)]
struct Step {
    cost: f64,
    point: u32,
    stamp: u32,
}

impl Eq for Step {}

impl PartialOrd for Step {
    fn partial_cmp(&self, other: &Step) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Step {
    fn cmp(&self, other: &Step) -> std::cmp::Ordering {
        let by_cost = self.cost.total_cmp(&other.cost);
        by_cost.then(self.point.cmp(&other.point)).then(self.stamp.cmp(&other.stamp))
    }
}

/// Triangles in the making.
pub(super) struct Collapse<'a, L> {
    tree: &'a Octree<L>,
    tolerance: f64,
    points: &'a [DVec3],
    triangles: Vec<[u32; 3]>,
    /// What the triangles belong to; borders between labels stay.
    labels: Vec<u32>,
    /// The triangles around each point.
    around: Vec<Vec<u32>>,
    /// The points for which each triangle stands.
    lost: Vec<Vec<DVec3>>,
    /// Points that stay.
    fixed: &'a [bool],
    stamps: Vec<u32>,
    open: BinaryHeap<Reverse<Step>>,
}

impl<'a, L: Level> Collapse<'a, L> {
    /// A closed surface as it is. `fixed` points stay, and so do borders between labels of triangles.
    pub fn new(
        tree: &'a Octree<L>,
        tolerance: f64,
        surface: &'a Surface,
        labels: Vec<u32>,
        fixed: &'a [bool],
    ) -> Collapse<'a, L> {
        let (points, triangles) = (&surface.points, surface.triangles.clone());
        let mut around = vec![vec![]; points.len()];
        for (i, t) in triangles.iter().enumerate() {
            t.iter().for_each(|&p| around[p as usize].push(i as u32));
        }
        let (lost, stamps) = (vec![vec![]; triangles.len()], vec![0; points.len()]);
        let open = BinaryHeap::new();
        Collapse { tree, tolerance, points, triangles, labels, around, lost, fixed, stamps, open }
    }

    /// Moves points while any may move; the triangles that are left and their labels.
    pub fn run(mut self) -> (Vec<[u32; 3]>, Vec<u32>) {
        (0..self.points.len() as u32).for_each(|p| self.push(p));
        while let Some(Reverse(step)) = self.open.pop() {
            if step.stamp == self.stamps[step.point as usize] {
                self.try_step(step.point);
            }
        }
        let left = self.triangles.iter().zip(&self.labels).filter(|(t, _)| t[0] != t[1]);
        left.map(|(t, label)| (*t, *label)).unzip()
    }

    fn at(&self, p: u32) -> DVec3 {
        self.points[p as usize]
    }

    fn corners(&self, t: [u32; 3]) -> [DVec3; 3] {
        t.map(|p| self.at(p))
    }

    fn normal(&self, t: [u32; 3]) -> DVec3 {
        let [a, b, c] = self.corners(t);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// The neighbours of a point, each once.
    fn ring(&self, p: u32) -> Vec<u32> {
        let corners = self.around[p as usize].iter().flat_map(|&t| self.triangles[t as usize]);
        let mut ring: Vec<u32> = corners.filter(|&q| q != p).collect();
        ring.sort_unstable();
        ring.dedup();
        ring
    }

    /// Neighbours onto which a point may move, the one nearest to the planes around first.
    fn targets(&self, p: u32) -> Vec<(f64, u32)> {
        if self.fixed[p as usize] || self.around[p as usize].is_empty() {
            return vec![];
        }
        let planes: Vec<DVec3> = self.around[p as usize]
            .iter()
            .map(|&t| self.normal(self.triangles[t as usize]))
            .collect();
        let sharp = planes.iter().any(|n| planes.iter().any(|m| n.dot(*m) < SHARP));
        let most = if sharp { EXACT } else { ROUND } * self.tolerance;
        let cost = |q: u32| {
            let way = self.at(q) - self.at(p);
            let off = planes.iter().map(|n| n.dot(way).abs()).fold(0.0, f64::max);
            (off <= most).then_some((off + SHORT * way.length(), q))
        };
        let mut targets: Vec<(f64, u32)> = self.ring(p).into_iter().filter_map(cost).collect();
        targets.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        targets.truncate(TRIED);
        targets
    }

    fn push(&mut self, point: u32) {
        self.stamps[point as usize] += 1;
        if let Some(&(cost, _)) = self.targets(point).first() {
            let stamp = self.stamps[point as usize];
            self.open.push(Reverse(Step { cost, point, stamp }));
        }
    }

    fn try_step(&mut self, from: u32) {
        for (_, to) in self.targets(from) {
            if let Some(lost) = self.allowed(from, to) {
                return self.take(from, to, lost);
            }
        }
    }

    /// The triangles of a point that stay when it moves onto a neighbour, by number and with new corners.
    fn moved(&self, from: u32, to: u32) -> Vec<(u32, [u32; 3])> {
        let of = |&t: &u32| (t, self.triangles[t as usize]);
        let staying = self.around[from as usize].iter().map(of).filter(|(_, c)| !c.contains(&to));
        staying.map(|(t, c)| (t, c.map(|p| if p == from { to } else { p }))).collect()
    }

    /// Whether a point may move onto a neighbour; then the points left out, for each triangle that stays.
    fn allowed(&self, from: u32, to: u32) -> Option<Vec<Vec<DVec3>>> {
        let moved = self.moved(from, to);
        let good = self.is_manifold(from, to, &moved)
            && self.keeps_borders(from, to)
            && moved
                .iter()
                .all(|(t, corners)| self.is_sound(self.triangles[*t as usize], *corners));
        if !good {
            return None;
        }
        let lost = self.shared_out(from, &moved)?;
        self.is_near(to, &moved).then_some(lost)
    }

    /// Whether the surface stays a manifold: the two points have just the two neighbours of their edge in common, and
    /// no triangle comes to lie on another.
    fn is_manifold(&self, from: u32, to: u32, moved: &[(u32, [u32; 3])]) -> bool {
        let (a, b) = (self.ring(from), self.ring(to));
        let common = a.iter().filter(|p| b.binary_search(p).is_ok()).count();
        let same = |s: &[u32; 3], t: &[u32; 3]| s.iter().all(|p| t.contains(p));
        let doubled = |t: &[u32; 3]| {
            self.around[to as usize].iter().any(|&s| same(&self.triangles[s as usize], t))
        };
        common == 2 && !moved.is_empty() && !moved.iter().any(|(_, t)| doubled(t))
    }

    /// Whether borders between labels stay where they are.
    fn keeps_borders(&self, from: u32, to: u32) -> bool {
        let around = &self.around[from as usize];
        let first = self.labels[around[0] as usize];
        if around.iter().all(|&t| self.labels[t as usize] == first) {
            return true;
        }
        // Neighbours along borders stand in two triangles of different labels.
        let is_border = |q: u32| {
            let mut labels = around
                .iter()
                .filter(|&&t| self.triangles[t as usize].contains(&q))
                .map(|&t| self.labels[t as usize]);
            labels.next() != labels.next()
        };
        let ends: Vec<u32> = self.ring(from).into_iter().filter(|&q| is_border(q)).collect();
        let [a, b] = ends[..] else { return false };
        let other = if a == to { b } else { a };
        let edge = Triangle::new([self.at(to), self.at(other), self.at(other)]);
        (a == to || b == to)
            && edge.nearest(self.at(from)).0.distance(self.at(from)) <= self.tolerance
    }

    /// Whether a triangle neither turns over nor becomes thin.
    fn is_sound(&self, before: [u32; 3], after: [u32; 3]) -> bool {
        let height = |t: [u32; 3]| {
            let [a, b, c] = self.corners(t);
            let longest = (b - a).length_squared().max((c - b).length_squared());
            (b - a).cross(c - a).length() / longest.max((a - c).length_squared())
        };
        let turn = self.normal(before).dot(self.normal(after));
        turn >= TURN && (height(after) >= THIN || height(after) >= height(before))
    }

    /// What was left out and the point itself, each given to the triangle that is nearest to it; `None` if that
    /// is too far.
    fn shared_out(&self, from: u32, moved: &[(u32, [u32; 3])]) -> Option<Vec<Vec<DVec3>>> {
        let triangles: Vec<Triangle> =
            moved.iter().map(|(_, t)| Triangle::new(self.corners(*t))).collect();
        let mut lost = vec![vec![]; moved.len()];
        let before = self.around[from as usize].iter().flat_map(|&t| &self.lost[t as usize]);
        for p in before.copied().chain([self.at(from)]) {
            let away = |t: &Triangle| t.nearest(p).0.distance_squared(p);
            let distances = triangles.iter().map(away).enumerate();
            let (nearest, square) = distances.min_by(|a, b| a.1.total_cmp(&b.1))?;
            if square > self.tolerance * self.tolerance {
                return None;
            }
            lost[nearest].push(p);
        }
        Some(lost)
    }

    /// Whether the middles of triangles and of the edges that become new are near the surface.
    fn is_near(&self, to: u32, moved: &[(u32, [u32; 3])]) -> bool {
        let near = |p: DVec3| self.tree.off(p) <= self.tolerance;
        moved.iter().all(|(_, t)| {
            let [a, b, c] = self.corners(*t);
            let k = t.iter().position(|&p| p == to).unwrap_or(0);
            // Each new edge leaves the target in one triangle, and comes back to it in another.
            let next = self.at(t[(k + 1) % 3]);
            near((a + b + c) / 3.0) && near((self.at(to) + next) / 2.0)
        })
    }

    /// Moves a point onto a neighbour.
    fn take(&mut self, from: u32, to: u32, lost: Vec<Vec<DVec3>>) {
        let (moved, ring) = (self.moved(from, to), self.ring(from));
        for t in std::mem::take(&mut self.around[from as usize]) {
            let corners = std::mem::replace(&mut self.triangles[t as usize], [from; 3]);
            self.lost[t as usize] = vec![];
            for p in corners.iter().filter(|&&p| p != from) {
                self.around[*p as usize].retain(|&s| s != t);
            }
        }
        for ((t, corners), lost) in moved.into_iter().zip(lost) {
            (self.triangles[t as usize], self.lost[t as usize]) = (corners, lost);
            corners.iter().for_each(|&p| self.around[p as usize].push(t));
        }
        self.stamps[from as usize] += 1;
        ring.into_iter().for_each(|p| self.push(p));
    }
}
