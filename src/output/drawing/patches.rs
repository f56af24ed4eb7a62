//! The surfaces of a mesh: which faces belong to one, and which of them are round.

use glam::DVec3;

use super::{
    field::Field,
    lattice::Plane,
    links::{Link, NONE},
};
use crate::geom::{PolyMesh, Surface, Tolerance};

/// Facets stand for their surface when they are within the tolerance, and this factor of it where set operations
/// cut them across.
const FAITHFUL: f64 = 1.5;

/// A surface and which side of it is outside.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Patch {
    /// The surface.
    pub field: Field,
    /// 1 where the gradient points outwards, else -1.
    pub outward: f64,
}

/// The patches of a mesh.
#[derive(Clone, Debug)]
pub struct Patches {
    /// Each patch once.
    pub list: Vec<Patch>,
    /// The patch of each face.
    pub of_face: Vec<u32>,
    /// The unit normal of each face, outwards.
    pub normals: Vec<DVec3>,
}

/// Which origins are round surfaces that their facets keep to.
pub fn faithful_origins(mesh: &PolyMesh, links: &[Link], tolerance: Tolerance) -> Vec<bool> {
    let most = tolerance.mm() * FAITHFUL;
    let flat = |s: &Surface| matches!(s, Surface::Plane | Surface::Smooth | Surface::Facets);
    let mut round: Vec<bool> = mesh.origins().iter().map(|o| !flat(&o.surface)).collect();
    if !round.contains(&true) {
        return round;
    }
    let fields: Vec<Field> = mesh.origins().iter().map(|o| Field::Round(o.surface)).collect();
    let origin = |face: u32| mesh.face(face as usize).origin_index() as usize;
    for link in links {
        let [p, q] = [link.a, link.b].map(|i| mesh.points[i as usize]);
        let mut check = |origin: usize| {
            round[origin] = round[origin] && fields[origin].slope((p + q) / 2.0).0.abs() <= most;
        };
        let left = origin(link.left);
        check(left);
        if link.right != NONE && origin(link.right) != left {
            check(origin(link.right));
        }
    }
    round
}

impl Patches {
    /// The surfaces of a mesh, numbered: flat faces by their plane, round ones by surface and outside.
    pub fn new(mesh: &PolyMesh, round: &[bool]) -> Patches {
        let mut patches = Patches { list: vec![], of_face: vec![], normals: vec![] };
        let mut of_plane = vec![NONE; mesh.plane_count() as usize];
        let mut of_origin = vec![[NONE; 2]; round.len()];
        for face in mesh.faces() {
            let normal = face.area_vector().normalize_or_zero();
            let corners = face.outer();
            let on = mesh.points[corners[0] as usize];
            let origin = face.origin_index() as usize;
            let patch = if round[origin] {
                let field = Field::Round(face.origin().surface);
                // Between two corners, since the apex of a cone has no normal.
                let across = mesh.points[corners[corners.len() / 2] as usize];
                let inside = field.slope(on.midpoint(across)).1.dot(normal) < 0.0;
                let outward = if inside { -1.0 } else { 1.0 };
                let known = &mut of_origin[origin][usize::from(inside)];
                if *known == NONE {
                    *known = numbered(&mut patches.list, Patch { field, outward });
                }
                *known
            } else {
                let known = &mut of_plane[face.plane() as usize];
                if *known == NONE {
                    let field = Field::Flat(Plane { normal, offset: normal.dot(on) });
                    *known = patches.list.len() as u32;
                    patches.list.push(Patch { field, outward: 1.0 });
                }
                *known
            };
            patches.of_face.push(patch);
            patches.normals.push(normal);
        }
        patches
    }

    /// Whether a patch is round.
    pub fn is_round(&self, patch: u32) -> bool {
        matches!(self.list[patch as usize].field, Field::Round(_))
    }
}

/// The number of a patch, the same for the same surface.
fn numbered(patches: &mut Vec<Patch>, patch: Patch) -> u32 {
    let known = patches.iter().position(|p| *p == patch);
    known.unwrap_or_else(|| {
        patches.push(patch);
        patches.len() - 1
    }) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        geom::{Origin, trig::unit_circle},
        output::drawing::links::links,
    };

    /// A prism in a cylinder of radius 10 about z.
    fn cylinder(sides: u32) -> PolyMesh {
        let ring = |z: f64| (0..sides).map(move |i| (unit_circle(sides, i) * 10.0).extend(z));
        let mut mesh = PolyMesh::with_points(ring(0.0).chain(ring(5.0)).collect());
        let flat = mesh.add_origin(Origin::of(Surface::Plane));
        let side = Surface::Cylinder { point: DVec3::ZERO, axis: DVec3::Z, radius: 10.0 };
        let round = mesh.add_origin(Origin::of(side));
        let [bottom, top] = [mesh.add_plane(), mesh.add_plane()];
        mesh.push_face(&[(0..sides).rev().collect::<Vec<_>>()], bottom, flat);
        mesh.push_face(&[(sides..2 * sides).collect::<Vec<_>>()], top, flat);
        for i in 0..sides {
            let (j, plane) = ((i + 1) % sides, mesh.add_plane());
            mesh.push_face(&[[i, j, sides + j, sides + i]], plane, round);
        }
        mesh
    }

    #[test]
    fn a_cylinder_has_three_surfaces() {
        let mesh = cylinder(32);
        let round = faithful_origins(&mesh, &links(&mesh), Tolerance::DEFAULT);
        assert_eq!(round, [false, true]);
        let patches = Patches::new(&mesh, &round);
        assert_eq!((patches.list.len(), patches.of_face.len()), (3, 34));
        assert_eq!((0..3).filter(|&p| patches.is_round(p)).count(), 1);
        assert!(patches.list.iter().all(|p| p.outward == 1.0));
    }

    #[test]
    fn coarse_facets_stand_for_themselves() {
        let prism = cylinder(6);
        let round = faithful_origins(&prism, &links(&prism), Tolerance::DEFAULT);
        assert_eq!(round, [false, false]);
        let patches = Patches::new(&prism, &round);
        assert_eq!(patches.list.len(), 8);
    }
}
