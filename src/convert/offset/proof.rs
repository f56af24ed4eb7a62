//! Whether an offset is where it should be.

use std::collections::BTreeSet;

use glam::DVec3;
use rayon::prelude::*;

use crate::{
    geom::{PolyMesh, Tolerance, triangulate::triangulate},
    kernel::{
        brep::Polyhedron,
        field::{Feature, Field, Polyhedral},
    },
};

/// How far a surface is from where it should be.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Deviation {
    /// The largest difference found, mm.
    pub most: f64,
    /// A place where it was found, mm.
    pub at: DVec3,
}

/// The largest difference between `by` mm and the distance of a point of a surface from a solid, over the
/// corners, the middles of the edges and the middles of the triangles of the surface; `None` for the empty
/// surface.
pub fn deviation(surface: &PolyMesh, field: &Polyhedral, by: f64) -> Option<Deviation> {
    let off = |at: DVec3| Deviation { most: (field.distance(at) - by).abs(), at };
    let worse = |a: Deviation, b: Deviation| match a.most.total_cmp(&b.most) {
        std::cmp::Ordering::Less => b,
        std::cmp::Ordering::Greater => a,
        // The same place whichever thread finds it.
        std::cmp::Ordering::Equal => {
            if a.at.to_array() <= b.at.to_array() {
                a
            } else {
                b
            }
        }
    };
    places(surface).into_par_iter().map(off).reduce_with(worse)
}

/// The corners of a surface, the middles of its edges and of its triangles.
fn places(surface: &PolyMesh) -> Vec<DVec3> {
    let mut all = surface.points.clone();
    for [a, b, c] in triangulate(surface).corners {
        let [p, q, r] = [a, b, c].map(|i| surface.points[i as usize]);
        let edges = [(a, b, p, q), (b, c, q, r), (c, a, r, p)];
        all.extend(edges.iter().filter(|e| e.0 < e.1).map(|e| (e.2 + e.3) / 2.0));
        all.push((p + q + r) / 3.0);
    }
    all
}

/// The points of a solid whose balls a surface misses: nearest to places of the surface that are too near.
pub(super) fn missing(
    solid: &Polyhedron,
    surface: &PolyMesh,
    field: &Polyhedral,
    by: f64,
    tolerance: Tolerance,
) -> Vec<DVec3> {
    let near = |p: &DVec3| {
        let found = field.nearest(*p);
        let lack = by.abs() - found.distance * by.signum();
        match found.feature {
            Feature::Vertex(v) if lack > tolerance.mm() => Some(v),
            _ => None,
        }
    };
    let points: BTreeSet<u32> = places(surface).iter().filter_map(near).collect();
    points.into_iter().map(|v| solid.mesh().points[v as usize]).collect()
}
