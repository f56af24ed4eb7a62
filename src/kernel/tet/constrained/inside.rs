//! Which tetrahedra are inside the boundary.

use rustc_hash::FxHashMap;

use super::{NoTetrahedra, Work, facets, sorted, wrap::turned};
use crate::{
    geom::{BoundaryTriangle, PolyMesh, TetMesh},
    kernel::tet::{
        complex::{Across, Complex},
        delaunay::{Side, of_side, side},
    },
};

/// The triangles of the boundary by their corners in order: faces, and the triangle as seen from outside.
type Boundary = FxHashMap<[u32; 3], Vec<(u32, [u32; 3])>>;

impl Work {
    /// The tetrahedra around which the boundary winds once.
    pub(super) fn inside(self, solid: &PolyMesh) -> Result<Complex, NoTetrahedra> {
        let boundary = facets::wanted(&self.facets);
        let winding = self.windings(&boundary)?;
        let mut number = vec![u32::MAX; self.delaunay.len()];
        let mut mesh = TetMesh { origins: solid.origins().to_vec(), ..TetMesh::default() };
        for t in self.delaunay.tetrahedra().filter(|&t| winding[t as usize] > 0) {
            number[t as usize] = mesh.tetrahedra.len() as u32;
            mesh.tetrahedra.push(self.delaunay.corners(t));
        }
        let mut across = Vec::with_capacity(mesh.tetrahedra.len());
        for t in self.delaunay.tetrahedra().filter(|&t| winding[t as usize] > 0) {
            across.push(std::array::from_fn(|corner| {
                let here = side(t, corner);
                let (there, opposite) = of_side(self.delaunay.across(here));
                if winding[there as usize] > 0 {
                    return Across::Tetrahedron(number[there as usize], opposite as u8);
                }
                let corners = self.delaunay.face(here);
                let face = boundary[&sorted(corners)][0].0;
                let origin = solid.face(face as usize).origin_index();
                let (tetrahedron, opposite) = (number[t as usize], corner as u8);
                mesh.boundary.push(BoundaryTriangle {
                    corners,
                    tetrahedron,
                    opposite,
                    face,
                    origin,
                });
                Across::Outside(mesh.boundary.len() as u32 - 1)
            }));
        }
        self.placed(mesh, across)
    }

    /// Gives the tetrahedra their points in mm: corners as they were given; where that turns a tetrahedron inside
    /// out, as rounded to the lattice, which turns none unless floats are coarser than the lattice.
    fn placed(&self, mut mesh: TetMesh, across: Vec<[Across; 4]>) -> Result<Complex, NoTetrahedra> {
        let numbers = 0..self.delaunay.points.len() as u32;
        mesh.points = numbers.map(|i| self.place(i)).collect();
        let given = Complex::new(mesh, across);
        if given.check_volumes().is_ok() {
            return Ok(given);
        }
        let (mut mesh, across) = given.into_parts();
        mesh.points = self.delaunay.points.iter().map(|&p| self.lattice.place(p)).collect();
        let rounded = Complex::new(mesh, across);
        match rounded.check_volumes() {
            Ok(()) => Ok(rounded),
            Err(_) => Err(NoTetrahedra::Far { distance: self.lattice.reach() }),
        }
    }

    /// How often the boundary winds around each tetrahedron: once inside, not at all outside.
    fn windings(&self, boundary: &Boundary) -> Result<Vec<i32>, NoTetrahedra> {
        let mut winding = vec![i32::MIN; self.delaunay.len()];
        let mut open: Vec<u32> =
            self.delaunay.tetrahedra().filter(|&t| self.delaunay.is_ghost(t)).collect();
        open.iter().for_each(|&t| winding[t as usize] = 0);
        while let Some(here) = open.pop() {
            for corner in 0..4 {
                let (there, _) = of_side(self.delaunay.across(side(here, corner)));
                let expected = winding[here as usize] + self.step(boundary, side(here, corner));
                let known = &mut winding[there as usize];
                if *known == i32::MIN {
                    *known = expected;
                    open.push(there);
                } else if *known != expected {
                    return Err(NoTetrahedra::Open { place: self.near(there) });
                }
            }
        }
        match self.delaunay.tetrahedra().find(|&t| !(0..=1).contains(&winding[t as usize])) {
            Some(t) => Err(NoTetrahedra::Crossing { place: self.near(t) }),
            None => Ok(winding),
        }
    }

    /// How the winding changes where a side is left.
    fn step(&self, boundary: &Boundary, side: Side) -> i32 {
        let face = self.delaunay.face(side);
        let Some(pieces) = boundary.get(&sorted(face)) else { return 0 };
        pieces.iter().map(|&(_, seen)| if turned(seen) == turned(face) { -1 } else { 1 }).sum()
    }

    /// The place of a corner of a tetrahedron, mm.
    fn near(&self, tetrahedron: u32) -> glam::DVec3 {
        let corners = self.delaunay.corners(tetrahedron);
        self.place(corners.into_iter().min().unwrap_or(0))
    }
}
