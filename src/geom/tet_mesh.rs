//! Tetrahedral meshes: what the tetrahedral kernel hands to outputs.

use glam::DVec3;

use super::mesh::Origin;

/// A triangle of the boundary of a tetrahedral mesh.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct BoundaryTriangle {
    /// Point numbers, counter-clockwise seen from outside.
    pub corners: [u32; 3],
    /// The tetrahedron it is a face of.
    pub tetrahedron: u32,
    /// Which corner of that is opposite.
    pub opposite: u8,
    /// The face of the solid it is part of.
    pub face: u32,
    /// Its origin, a number of [`TetMesh::origins`].
    pub origin: u32,
}

/// Tetrahedra over shared points, millimetres. The corners of each are so ordered that the fourth is on the side
/// of the first three from which they turn counter-clockwise.
///
/// ```
/// use glam::DVec3;
/// use katachi::geom::TetMesh;
/// let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TetMesh { points, tetrahedra: vec![[0, 1, 2, 3]], ..TetMesh::default() };
/// assert_eq!(mesh.volume_of(0), 1.0 / 6.0);
/// ```
#[derive(Clone, PartialEq, Debug, Default)]
pub struct TetMesh {
    /// The corners.
    pub points: Vec<DVec3>,
    /// Four point numbers each.
    pub tetrahedra: Vec<[u32; 4]>,
    /// The boundary.
    pub boundary: Vec<BoundaryTriangle>,
    /// Where faces of the boundary come from.
    pub origins: Vec<Origin>,
}

impl TetMesh {
    /// The corners of a tetrahedron, mm.
    pub fn corners(&self, tetrahedron: usize) -> [DVec3; 4] {
        self.tetrahedra[tetrahedron].map(|i| self.points[i as usize])
    }

    /// The volume of a tetrahedron in mm^3, rounded.
    pub fn volume_of(&self, tetrahedron: usize) -> f64 {
        self.sixfold_volume_of(tetrahedron) / 6.0
    }

    /// The volume of all tetrahedra in mm^3; without rounding where coordinates are small integers.
    pub fn volume(&self) -> f64 {
        (0..self.tetrahedra.len()).map(|t| self.sixfold_volume_of(t)).sum::<f64>() / 6.0
    }

    fn sixfold_volume_of(&self, tetrahedron: usize) -> f64 {
        let [a, b, c, d] = self.corners(tetrahedron);
        (b - a).cross(c - a).dot(d - a)
    }
}
