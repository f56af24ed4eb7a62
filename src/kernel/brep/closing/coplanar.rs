//! Merges neighbouring triangles of one plane into polygons.

use glam::DVec3;

use super::{Soup, following};
use crate::geom::{Origin, PolyMesh};

/// A triangle whose height is this many times the flatness has a plane good enough to grow a face from.
const FIRM: f64 = 64.0;

const NONE: u32 = u32::MAX;

/// The mesh of maximal faces: each one plane, one origin, one polygon with holes. A corner may be off the
/// plane of the triangle that its face grows from by `flatness` times the largest coordinate.
pub(super) fn merge(soup: &Soup, twin: &[u32], origins: &[Origin], flatness: f64) -> PolyMesh {
    let mut merging = Merging {
        soup,
        twin,
        region_of: vec![NONE; soup.triangles.len()],
        seen: vec![false; twin.len()],
        mesh: PolyMesh::with_points(soup.points.clone()),
    };
    origins.iter().for_each(|o| {
        merging.mesh.add_origin(o.clone());
    });
    let reach = soup.points.iter().fold(DVec3::ZERO, |m, p| m.max(p.abs())).max_element();
    let flatness = flatness * reach;
    for least_height in [FIRM * flatness, -1.0] {
        for seed in 0..soup.triangles.len() {
            if merging.region_of[seed] == NONE && height(soup.corners(seed)) > least_height {
                let (region, normal) = merging.grow(seed, flatness);
                merging.push(&region, normal);
            }
        }
    }
    merging.mesh.drop_unused_points();
    merging.mesh
}

/// The smallest height of a triangle.
fn height([a, b, c]: [DVec3; 3]) -> f64 {
    let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    if longest > 0.0 { (b - a).cross(c - a).length() / longest.sqrt() } else { 0.0 }
}

struct Merging<'a> {
    soup: &'a Soup,
    twin: &'a [u32],
    /// For each triangle the first triangle of its face.
    region_of: Vec<u32>,
    /// Half-edges of the outlines traced so far.
    seen: Vec<bool>,
    mesh: PolyMesh,
}

impl Merging<'_> {
    /// The triangles that one reaches from a seed without leaving its plane, its side and its origin.
    fn grow(&mut self, seed: usize, flatness: f64) -> (Vec<u32>, DVec3) {
        let [a, b, c] = self.soup.corners(seed);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        self.region_of[seed] = seed as u32;
        let mut region = vec![seed as u32];
        let mut next = 0;
        while next < region.len() {
            let t = region[next] as usize;
            next += 1;
            for across in self.twin[3 * t..3 * t + 3].iter().map(|h| *h as usize / 3) {
                let free = self.region_of[across] == NONE
                    && self.soup.origin[across] == self.soup.origin[seed];
                if free && fits(self.soup.corners(across), a, normal, flatness) {
                    self.region_of[across] = seed as u32;
                    region.push(across as u32);
                }
            }
        }
        (region, normal)
    }

    /// Adds the face of a region; as single triangles where its outline is not one polygon with holes.
    fn push(&mut self, region: &[u32], normal: DVec3) {
        let plane = self.mesh.add_plane();
        let origin = self.soup.origin[region[0] as usize];
        if region.len() > 1
            && let Some(loops) = self.outline(region, normal)
        {
            return self.mesh.push_face(&loops, plane, origin);
        }
        for (i, &t) in region.iter().enumerate() {
            let plane = if i == 0 { plane } else { self.mesh.add_plane() };
            self.mesh.push_face(&[self.soup.triangles[t as usize]], plane, origin);
        }
    }

    /// The loops around a region, the outer one first.
    fn outline(&mut self, region: &[u32], normal: DVec3) -> Option<Vec<Vec<u32>>> {
        let mut loops = vec![];
        for first in region.iter().flat_map(|t| 3 * t..3 * t + 3) {
            if !self.seen[first as usize] && self.is_border(first) {
                loops.push(self.trace(first));
            }
        }
        let areas: Vec<f64> = loops.iter().map(|l| self.area(l, normal)).collect();
        let outer = areas.iter().position(|&a| a > 0.0)?;
        let single = areas.iter().filter(|&&a| a >= 0.0).count() == 1;
        loops.swap(0, outer);
        (single && loops.iter().all(|l| l.len() > 2)).then_some(loops)
    }

    fn is_border(&self, half_edge: u32) -> bool {
        let across = self.twin[half_edge as usize] as usize / 3;
        self.region_of[across] != self.region_of[half_edge as usize / 3]
    }

    /// The points of the loop that a half-edge of the outline is part of.
    fn trace(&mut self, first: u32) -> Vec<u32> {
        let mut corners = vec![];
        let mut here = first;
        while !self.seen[here as usize] {
            self.seen[here as usize] = true;
            corners.push(self.soup.start(here));
            here = following(here);
            while !self.is_border(here) {
                here = following(self.twin[here as usize]);
            }
        }
        corners
    }

    /// Twice the signed area of a loop seen against the normal.
    fn area(&self, corners: &[u32], normal: DVec3) -> f64 {
        let point = |c: u32| self.soup.points[c as usize];
        let base = point(corners[0]);
        let parts = corners.windows(2).map(|w| (point(w[0]) - base).cross(point(w[1]) - base));
        parts.sum::<DVec3>().dot(normal)
    }
}

/// Whether a triangle lies in a plane and faces its way.
fn fits(corners: [DVec3; 3], base: DVec3, normal: DVec3, flatness: f64) -> bool {
    let [a, b, c] = corners;
    corners.iter().all(|p| (*p - base).dot(normal).abs() <= flatness)
        && (b - a).cross(c - a).dot(normal) > 0.0
}
