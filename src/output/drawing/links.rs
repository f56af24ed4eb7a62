//! Which faces meet at which edge.

use crate::geom::PolyMesh;

/// No face.
pub const NONE: u32 = u32::MAX;

/// An edge and the faces beside it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Link {
    /// Its ends; the face on the left runs from `a` to `b`.
    pub a: u32,
    /// See `a`.
    pub b: u32,
    /// The face that runs from `a` to `b`.
    pub left: u32,
    /// The face that runs from `b` to `a`, or [`NONE`].
    pub right: u32,
}

/// A side of a face at the smaller of its two points.
#[derive(Clone, Copy, Default)]
struct Side {
    other: u32,
    face: u32,
    /// Whether it runs from the smaller to the larger point.
    up: bool,
}

/// All edges of a mesh, by their smaller point, each once. Sides that find no partner are edges with one
/// face.
pub fn links(mesh: &PolyMesh) -> Vec<Link> {
    let (starts, mut sides) = gathered(mesh);
    let mut links = Vec::with_capacity(sides.len() / 2);
    for (point, range) in starts.windows(2).enumerate() {
        let here = &mut sides[range[0] as usize..range[1] as usize];
        sort_few(here);
        let mut i = 0;
        while i < here.len() {
            let paired = here.get(i + 1).is_some_and(|s| s.other == here[i].other && !s.up);
            links.push(link(point as u32, here[i], paired.then(|| here[i + 1])));
            i += 1 + usize::from(paired && here[i].up);
        }
    }
    links
}

/// The sides of all faces sorted by their smaller point, and where each point's begin.
fn gathered(mesh: &PolyMesh) -> (Vec<u32>, Vec<Side>) {
    let mut starts = vec![0u32; mesh.points.len() + 2];
    each_side(mesh, |_, a, b| starts[a.min(b) as usize + 2] += 1);
    (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
    let mut sides = vec![Side::default(); starts[starts.len() - 1] as usize];
    each_side(mesh, |face, a, b| {
        let place = &mut starts[a.min(b) as usize + 1];
        sides[*place as usize] = Side { other: a.max(b), face, up: a < b };
        *place += 1;
    });
    starts.pop();
    (starts, sides)
}

/// Calls with every side of every face: the face, start and end.
pub fn each_side(mesh: &PolyMesh, mut found: impl FnMut(u32, u32, u32)) {
    for face in mesh.faces() {
        for corners in face.loops() {
            let mut before = corners[corners.len() - 1];
            for &corner in corners {
                found(face.index() as u32, before, corner);
                before = corner;
            }
        }
    }
}

/// Sorts by the other point, sides that run up first: insertion, since a point has few.
fn sort_few(sides: &mut [Side]) {
    let key = |s: &Side| (s.other, !s.up, s.face);
    if sides.len() > 16 {
        return sides.sort_unstable_by_key(key);
    }
    for i in 1..sides.len() {
        let mut k = i;
        while k > 0 && key(&sides[k - 1]) > key(&sides[k]) {
            sides.swap(k - 1, k);
            k -= 1;
        }
    }
}

fn link(point: u32, side: Side, partner: Option<Side>) -> Link {
    match (side.up, partner) {
        (true, Some(other)) => Link { a: point, b: side.other, left: side.face, right: other.face },
        (true, None) => Link { a: point, b: side.other, left: side.face, right: NONE },
        (false, _) => Link { a: side.other, b: point, left: side.face, right: NONE },
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::geom::{Origin, Surface};

    fn mesh(faces: &[&[u32]]) -> PolyMesh {
        let mut mesh = PolyMesh::with_points(vec![DVec3::ZERO; 4]);
        let (plane, origin) = (mesh.add_plane(), mesh.add_origin(Origin::of(Surface::Plane)));
        faces.iter().for_each(|f| mesh.push_face(&[f], plane, origin));
        mesh
    }

    #[test]
    fn every_edge_of_a_tetrahedron_has_two_faces() {
        let all = links(&mesh(&[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]]));
        assert_eq!(all.len(), 6);
        assert!(all.iter().all(|l| l.left != l.right && l.right != NONE));
        assert_eq!(all[0], Link { a: 0, b: 1, left: 1, right: 0 });
    }

    #[test]
    fn rims_have_one_face() {
        let all = links(&mesh(&[&[0, 1, 2], &[2, 1, 3]]));
        assert_eq!(all.iter().filter(|l| l.right == NONE).count(), 4);
        let turned = links(&mesh(&[&[0, 1, 2], &[1, 2, 3]]));
        assert_eq!(turned.iter().filter(|l| l.right == NONE).count(), 6);
    }
}
