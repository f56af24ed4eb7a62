//! Rings of points and the bands of facets between them: what round solids are made of.

use glam::DVec3;

use crate::geom::{PolyMesh, trig::unit_circle};

/// Points around the z axis, or one point on it. A ring of n points is closed.
pub(super) type Ring = Vec<u32>;

/// Adds the regular `sides`-gon of radius `r` about the z axis at height `z`, first point on +x; one
/// point if the radius is 0.
pub(super) fn add_ring(mesh: &mut PolyMesh, r: f64, z: f64, sides: u32) -> Ring {
    let count = if r == 0.0 { 1 } else { sides };
    (0..count).map(|i| add_point(mesh, (unit_circle(sides, i) * r).extend(z))).collect()
}

/// Adds a point and gives its index.
pub(super) fn add_point(mesh: &mut PolyMesh, p: DVec3) -> u32 {
    mesh.points.push(p + DVec3::ZERO);
    mesh.points.len() as u32 - 1
}

/// Adds the facets between two closed rings, each in a plane of its own: the outside is to the right of
/// one who goes from `lower` to `upper` with the axis on the left. A ring of one point makes triangles;
/// two such make nothing.
pub(super) fn add_band(mesh: &mut PolyMesh, lower: &[u32], upper: &[u32], origin: u32) {
    let sides = lower.len().max(upper.len());
    add_strip(mesh, lower, upper, if sides > 1 { sides } else { 0 }, origin);
}

/// The same for the first `count` facets only: rings of `count` + 1 points that are not closed.
pub(super) fn add_strip(
    mesh: &mut PolyMesh,
    lower: &[u32],
    upper: &[u32],
    count: usize,
    origin: u32,
) {
    let at = |ring: &[u32], i: usize| ring[i % ring.len()];
    for i in 0..count {
        let corners = [at(lower, i), at(lower, i + 1), at(upper, i + 1), at(upper, i)];
        let plane = mesh.add_plane();
        match (lower.len(), upper.len()) {
            (_, 1) => mesh.push_face(&[&corners[..3]], plane, origin),
            (1, _) => mesh.push_face(&[&[corners[0], corners[2], corners[3]]], plane, origin),
            _ => mesh.push_face(&[&corners[..]], plane, origin),
        }
    }
}

/// Adds the flat end of a ring, facing up or down; nothing if it is one point.
pub(super) fn add_cap(mesh: &mut PolyMesh, ring: &[u32], up: bool, origin: u32) {
    if ring.len() < 3 {
        return;
    }
    let plane = mesh.add_plane();
    let mut corners = ring.to_vec();
    if !up {
        corners.reverse();
    }
    mesh.push_face(&[corners], plane, origin);
}
