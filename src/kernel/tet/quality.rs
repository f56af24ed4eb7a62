//! How well shaped tetrahedra are.

use glam::DVec3;

use super::complex::{Complex, FACES};

/// Classes of angles in the histogram, of 10 degrees each.
pub const CLASSES: usize = 18;

/// The dihedral angles of tetrahedra, in degrees. A regular tetrahedron has six of 70.53.
#[derive(Clone, PartialEq, Debug)]
pub struct Quality {
    /// The smallest of all; 180 when there are none.
    pub smallest: f64,
    /// The largest of all; 0 when there are none.
    pub largest: f64,
    /// How many angles are in [0, 10), [10, 20) and so on up to [170, 180].
    pub histogram: [usize; CLASSES],
}

impl Complex {
    /// The dihedral angles of all tetrahedra that are not flat.
    ///
    /// ```
    /// use glam::DVec3;
    /// use katachi::kernel::{brep::primitive::cuboid, tet::constrained::tetrahedralize};
    /// let cube = tetrahedralize(cuboid(DVec3::ZERO, DVec3::ONE).mesh()).unwrap();
    /// let quality = cube.quality();
    /// assert_eq!(quality.histogram.iter().sum::<usize>(), 36);
    /// assert!((quality.smallest - 35.26438968).abs() < 1e-8);
    /// ```
    pub fn quality(&self) -> Quality {
        let mut quality = Quality { smallest: 180.0, largest: 0.0, histogram: [0; CLASSES] };
        for t in (0..self.mesh().tetrahedra.len()).filter(|&t| self.sign_of(t) > 0.0) {
            for angle in dihedral_angles(self.mesh().corners(t)) {
                quality.smallest = quality.smallest.min(angle);
                quality.largest = quality.largest.max(angle);
                quality.histogram[((angle / 10.0) as usize).min(CLASSES - 1)] += 1;
            }
        }
        quality
    }
}

/// The angles in degrees between the faces of a tetrahedron.
pub fn dihedral_angles(corners: [DVec3; 4]) -> [f64; 6] {
    let normals = FACES.map(|face| {
        let [a, b, c] = face.map(|i| corners[i]);
        (b - a).cross(c - a)
    });
    [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)].map(|(i, j)| {
        let (sine, cosine) = (normals[i].cross(normals[j]).length(), -normals[i].dot(normals[j]));
        libm::atan2(sine, cosine).to_degrees()
    })
}
