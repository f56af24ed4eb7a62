//! Points that lie on a facet without being corners of it: the solid touches itself there.

use glam::DVec3;

use super::facets::{apex, edges};
use crate::{
    geom::{Bounds, bvh::Bvh},
    kernel::tet::sphere::volume_sign,
};

/// All points, found by place.
pub(super) struct Touching {
    hierarchy: Bvh,
}

impl Touching {
    /// Makes points ready to be found.
    pub(super) fn new(points: &[DVec3]) -> Touching {
        let boxes: Vec<Bounds> = points.iter().map(|&p| Bounds::of([p])).collect();
        Touching { hierarchy: Bvh::new(&boxes) }
    }

    /// Makes every point that lies on triangles of one plane a corner of them.
    pub(super) fn insert(&self, points: &[DVec3], triangles: &mut Vec<[u32; 3]>) {
        let Some(&first) = triangles.first() else { return };
        let Some(apex) = apex(first, points) else { return };
        let corners = triangles.iter().flatten().map(|&c| points[c as usize]);
        let mut near = self.hierarchy.overlapping(&Bounds::of(corners));
        let [a, b, c] = first.map(|c| points[c as usize]);
        near.retain(|&p| volume_sign(a, b, c, points[p as usize]) == 0);
        for point in near {
            if !triangles.iter().any(|triangle| triangle.contains(&point)) {
                split(points, triangles, point, apex);
            }
        }
    }
}

/// Splits the triangle that holds a point in its plane, or the two beside an edge that does.
fn split(points: &[DVec3], triangles: &mut Vec<[u32; 3]>, point: u32, apex: DVec3) {
    let p = |i: u32| points[i as usize];
    let mut parts = vec![];
    triangles.retain(|&triangle| {
        let sides = edges(triangle).map(|[a, b]| ([a, b], volume_sign(p(a), p(b), p(point), apex)));
        let holds = sides.iter().all(|&(_, sign)| sign >= 0);
        if holds {
            let seen = sides.iter().filter(|&&(_, sign)| sign > 0);
            parts.extend(seen.map(|&([a, b], _)| [a, b, point]));
        }
        !holds
    });
    triangles.append(&mut parts);
}
