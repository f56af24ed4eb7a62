//! Filling a polyhedral cavity with Delaunay tetrahedra over given corners by gift wrapping.

use glam::DVec3;
use rustc_hash::FxHashSet;

use crate::kernel::tet::{complex::FACES, delaunay::Delaunay};

/// A cavity that is being filled.
pub(super) struct Wrap<'a> {
    delaunay: &'a Delaunay,
    /// What may be a corner.
    corners: Vec<u32>,
    /// The faces of the front, counter-clockwise seen from the inside, the least corner first.
    open: FxHashSet<[u32; 3]>,
    /// The same in the order in which they came; some are no longer open.
    queue: Vec<[u32; 3]>,
}

impl<'a> Wrap<'a> {
    /// A cavity between faces, counter-clockwise seen from inside.
    pub(super) fn new(
        delaunay: &'a Delaunay,
        fronts: Vec<[u32; 3]>,
        corners: Vec<u32>,
    ) -> Wrap<'a> {
        let queue: Vec<[u32; 3]> = fronts.into_iter().map(turned).collect();
        Wrap { delaunay, corners, open: queue.iter().copied().collect(), queue }
    }

    /// The tetrahedra that fill it, all of positive volume and side to side: by that they are its filling and
    /// nothing else. `None` where no corner fits a face any more.
    pub(super) fn fill(mut self) -> Option<Vec<[u32; 4]>> {
        // A filling has about three tetrahedra for each face of the front; many more are an endless one.
        let limit = 64 + 16 * (self.queue.len() + self.corners.len());
        let mut filling = vec![];
        while let Some(face) = self.queue.pop() {
            if !self.open.remove(&face) {
                continue;
            }
            let corners = [face[0], face[1], face[2], self.apex(face)?];
            filling.push(corners);
            if filling.len() > limit {
                return None;
            }
            for [a, b, c] in FACES[..3].iter().map(|face| face.map(|i| corners[i])) {
                if !self.open.remove(&turned([a, c, b])) {
                    self.open.insert(turned([a, b, c]));
                    self.queue.push(turned([a, b, c]));
                }
            }
        }
        self.open.is_empty().then_some(filling)
    }

    /// The corner over a face whose sphere holds no other that can be seen.
    fn apex(&self, face: [u32; 3]) -> Option<u32> {
        let mut candidates: Vec<u32> = self
            .corners
            .iter()
            .copied()
            .filter(|&c| !face.contains(&c) && self.delaunay.sign(face, c) > 0)
            .collect();
        while !candidates.is_empty() {
            let best = (1..candidates.len()).fold(0, |best, i| {
                let sphere = [face[0], face[1], face[2], candidates[best]];
                if self.delaunay.in_sphere(sphere, candidates[i]) { i } else { best }
            });
            let apex = candidates.swap_remove(best);
            if self.fits(face, apex) {
                return Some(apex);
            }
        }
        None
    }

    /// Whether the tetrahedron over a face does not cross the front.
    fn fits(&self, [a, b, c]: [u32; 3], apex: u32) -> bool {
        let sides = [[a, b, apex], [b, c, apex], [c, a, apex]];
        let edges = [[a, apex], [b, apex], [c, apex]];
        let reach = Reach::of(self.delaunay, &[a, b, c, apex]);
        self.open.iter().all(|front| {
            reach.is_apart(&Reach::of(self.delaunay, front)) || {
                let borders = [[front[0], front[1]], [front[1], front[2]], [front[2], front[0]]];
                !edges.iter().any(|&edge| self.pierces(edge, *front))
                    && !sides
                        .iter()
                        .any(|&side| borders.iter().any(|&edge| self.pierces(edge, side)))
            }
        })
    }

    /// Whether an edge passes through a triangle with which it shares no corner.
    fn pierces(&self, [p, q]: [u32; 2], triangle: [u32; 3]) -> bool {
        if triangle.contains(&p) || triangle.contains(&q) {
            return false;
        }
        let [a, b, c] = triangle;
        let sign = |face, point| self.delaunay.sign(face, point);
        if sign(triangle, p) * sign(triangle, q) >= 0 {
            return false;
        }
        let signs = [[a, b, p], [b, c, p], [c, a, p]].map(|face| sign(face, q));
        signs.iter().all(|&s| s >= 0) || signs.iter().all(|&s| s <= 0)
    }
}

/// A box around corners.
struct Reach {
    min: DVec3,
    max: DVec3,
}

impl Reach {
    fn of(delaunay: &Delaunay, corners: &[u32]) -> Reach {
        let points = corners.iter().map(|&c| delaunay.points[c as usize]);
        let empty = Reach { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
        points.fold(empty, |r, p| Reach { min: r.min.min(p), max: r.max.max(p) })
    }

    fn is_apart(&self, other: &Reach) -> bool {
        self.min.cmpgt(other.max).any() || other.min.cmpgt(self.max).any()
    }
}

/// The same triangle with its least corner first.
pub(super) fn turned([a, b, c]: [u32; 3]) -> [u32; 3] {
    match a.min(b).min(c) {
        first if first == a => [a, b, c],
        first if first == b => [b, c, a],
        _ => [c, a, b],
    }
}
