//! Patches of the result: faces carried over from their leaves as they stand.

use super::{assemble::Assembly, origins::Labels, patch::Patch, space::NONE};
use crate::geom::PolyMesh;

/// The patches of the result on their way into its mesh.
pub(super) struct Carried<'a> {
    assembly: &'a Assembly<'a>,
    /// Patches of the result, and whether they face as in their leaf.
    patches: Vec<(&'a Patch, bool)>,
    /// For each leaf the mesh points of its points, so far as they have one.
    points: Vec<Vec<u32>>,
    /// For each leaf the mesh planes of its planes, in patches that face as in it and in others.
    planes: Vec<[Vec<u32>; 2]>,
}

impl<'a> Carried<'a> {
    /// Finds the patches of the result. `up` says of each cell whether it is there and its outside
    /// is above, `standing` of each point at a border which mesh point it is.
    pub fn new(assembly: &'a Assembly<'a>, up: &[Option<bool>], standing: &[u32]) -> Carried<'a> {
        let Assembly { plan, complex, patches, places, .. } = *assembly;
        let up = &up[complex.first_patch as usize..];
        let kept = patches.list.iter().zip(up).filter_map(|(patch, up)| Some((patch, (*up)?)));
        let kept: Vec<(&Patch, bool)> = kept.collect();
        let mut points = vec![vec![]; plan.leaves.len()];
        let mut planes: Vec<[Vec<u32>; 2]> = vec![[vec![], vec![]]; plan.leaves.len()];
        for (patch, _) in &kept {
            let (leaf, mesh) = (patch.leaf as usize, plan.leaves[patch.leaf as usize].solid.mesh());
            points[leaf].resize(mesh.points.len(), NONE);
            planes[leaf].iter_mut().for_each(|p| p.resize(mesh.plane_count() as usize, NONE));
        }
        for (&(leaf, corner), &number) in places.sources().iter().zip(standing) {
            if let Some(slot) = points[leaf as usize].get_mut(corner as usize) {
                *slot = number;
            }
        }
        Carried { assembly, patches: kept, points, planes }
    }

    /// The origins of all faces, in order.
    pub fn origins(&self, labels: &mut Labels<'_>) -> Vec<u32> {
        let mut origins = vec![];
        for (patch, _) in &self.patches {
            let mesh = self.assembly.plan.leaves[patch.leaf as usize].solid.mesh();
            // The origin before, there and here: most faces have the same.
            let mut last = (NONE, 0);
            for &face in &patch.faces {
                let there = mesh.face(face as usize).origin_index();
                if last.0 != there {
                    last = (there, labels.origin(patch.leaf, face));
                }
                origins.push(last.1);
            }
        }
        origins
    }

    /// Adds all faces, whose origins are given.
    pub fn add_faces(mut self, origins: &[u32], mesh: &mut PolyMesh) {
        let mut origins = origins.iter();
        // Most faces are quadrilaterals or triangles, with about one point each at most.
        mesh.reserve(origins.len(), 4 * origins.len());
        mesh.points.reserve(origins.len());
        for (patch, straight) in std::mem::take(&mut self.patches) {
            self.add_points(patch, mesh);
            let leaf = &self.assembly.plan.leaves[patch.leaf as usize];
            let turned = leaf.local.mirrors() == straight;
            let numbers = &self.points[patch.leaf as usize];
            let planes = &mut self.planes[patch.leaf as usize][usize::from(straight)];
            for (&face, &origin) in patch.faces.iter().zip(&mut origins) {
                let face = leaf.solid.mesh().face(face as usize);
                let plane = &mut planes[face.plane() as usize];
                if *plane == NONE {
                    *plane = mesh.add_plane();
                }
                let labels = (*plane, origin);
                mesh.push_renamed(face, turned, labels, |corner| numbers[corner as usize]);
            }
        }
    }

    /// Adds the points of a patch that the mesh does not have yet.
    fn add_points(&mut self, patch: &Patch, mesh: &mut PolyMesh) {
        let source = &self.assembly.plan.leaves[patch.leaf as usize];
        let (numbers, from) = (&mut self.points[patch.leaf as usize], source.solid.mesh());
        let faces = patch.faces.iter().map(|&face| from.face(face as usize));
        for &corner in faces.flat_map(|face| face.loops()).flatten() {
            let slot = &mut numbers[corner as usize];
            if *slot == NONE {
                *slot = mesh.points.len() as u32;
                mesh.points.push(source.full.point(from.points[corner as usize]));
            }
        }
    }
}
