//! Triangles that rounding has made flat.

use glam::DVec3;

use crate::geom::{PolyMesh, triangulate::triangulate_face};

/// A triangle is flat if it is not higher than this share of the largest of its coordinates: such a height is
/// the rounding of its corners.
const FLAT: f64 = 2.0 * f64::EPSILON;

/// Faces with more corners are triangulated at once: comparing them with all edges would take longer.
const MANY: usize = 48;

/// A place in mm where a face has a triangle without area; `None` if none of the given ones has.
///
/// `points` says of each corner which point it is, so far as it has one: where corners are one point, the result
/// touches itself, and there may be a triangle between them.
pub(super) fn flat_triangle(mesh: &PolyMesh, faces: &[u32], points: &[u32]) -> Option<DVec3> {
    let at = |corner: u32| mesh.points[corner as usize];
    let point = |corner: u32| points.get(corner as usize).copied();
    let touches =
        |a: u32, b: u32| point(a) == point(b) || at(a) == at(b) && point(a.max(b)).is_none();
    let is_lost = |&[a, b, c]: &[u32; 3]| {
        is_flat([a, b, c].map(at)) && !touches(a, b) && !touches(b, c) && !touches(c, a)
    };
    let mut triangles = vec![];
    faces.iter().find_map(|&face| {
        let loops: Vec<&[u32]> = mesh.face(face as usize).loops().collect();
        if !may_be_flat(&mesh.points, &loops) {
            return None;
        }
        triangles.clear();
        triangulate_face(&mesh.points, &loops, &mut triangles);
        triangles.iter().find(|t| is_lost(t)).map(|t| at(t[0]))
    })
}

/// Whether a triangle has no area, up to the rounding of its corners.
fn is_flat([a, b, c]: [DVec3; 3]) -> bool {
    let longest =
        (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    let reach = a.length_squared().max(b.length_squared()).max(c.length_squared());
    (b - a).cross(c - a).length_squared() <= FLAT * FLAT * longest * reach
}

/// Corners at the ends of an edge that is so small a share of its face can be in line with a third far away.
const SHORT: f64 = 1.0 / (1u64 << 20) as f64;

/// Whether a face may have a flat triangle: an edge is very short, a corner is in line with its neighbours, or one
/// that turns inwards is on another edge. No others make a polygon so thin.
fn may_be_flat(points: &[DVec3], loops: &[&[u32]]) -> bool {
    if loops.len() > 1 || loops[0].len() > MANY {
        return true;
    }
    let corners = loops[0];
    let n = corners.len();
    let at = |i: usize| points[corners[i % n] as usize];
    let base = at(0);
    let normal: DVec3 = (1..n).map(|i| (at(i) - base).cross(at(i + 1) - base)).sum();
    let extent = (1..n).map(|i| at(i).distance_squared(base)).fold(0.0, f64::max);
    (0..n).any(|i| {
        let [before, here, after] = [at(i + n - 1), at(i), at(i + 1)];
        let turns_in = (here - before).cross(after - here).dot(normal) <= 0.0;
        let on_edge = |j: usize| is_flat([here, at(i + j), at(i + j + 1)]);
        let is_short = here.distance_squared(after) <= SHORT * SHORT * extent;
        is_short || is_flat([before, here, after]) || (turns_in && (1..n - 1).any(on_edge))
    })
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;
    use crate::geom::{Origin, Surface};

    fn found(corners: &[DVec3]) -> bool {
        let mut mesh = PolyMesh::with_points(corners.to_vec());
        let (plane, origin) = (mesh.add_plane(), mesh.add_origin(Origin::of(Surface::Plane)));
        let numbers: Vec<u32> = (0..corners.len() as u32).collect();
        mesh.push_face(&[&numbers[..]], plane, origin);
        flat_triangle(&mesh, &[0], &numbers).is_some()
    }

    #[test]
    fn needles_and_straight_corners() {
        let far = dvec3(9.0, 5.0, 1.0);
        assert!(!found(&[DVec3::ZERO, dvec3(1.0, 0.0, 0.0), far]));
        assert!(found(&[DVec3::ZERO, dvec3(9.0, 5.0, 1.0) * 0.3, far]));
        assert!(found(&[DVec3::X, dvec3(1.0, 1e-16, 0.0), far]));
        // A corner on a straight edge needs no flat triangle while there is a fourth.
        assert!(!found(&[DVec3::ZERO, dvec3(1.0, 0.0, 0.0), dvec3(2.0, 0.0, 0.0), far]));
    }
}
