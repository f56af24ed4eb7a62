//! Volume, centroid and inertia as sums over tetrahedra.

use glam::{DMat3, DVec3};

use super::complex::Complex;

impl Complex {
    /// Volume in mm^3.
    pub fn volume(&self) -> f64 {
        self.mesh().volume()
    }

    /// Centre of gravity in mm; the origin for an empty solid.
    ///
    /// ```
    /// use glam::DVec3;
    /// use katachi::kernel::{brep::primitive::cuboid, tet::constrained::tetrahedralize};
    /// let solid = tetrahedralize(cuboid(DVec3::ZERO, DVec3::new(2.0, 4.0, 6.0)).mesh()).unwrap();
    /// assert_eq!(solid.centroid(), DVec3::new(1.0, 2.0, 3.0));
    /// assert_eq!(solid.inertia().x_axis.x, 48.0 * (16.0 + 36.0) / 12.0);
    /// ```
    pub fn centroid(&self) -> DVec3 {
        let mesh = self.mesh();
        let base = mesh.points.first().copied().unwrap_or(DVec3::ZERO);
        let (mut moment, mut volume) = (DVec3::ZERO, 0.0);
        for t in 0..mesh.tetrahedra.len() {
            let middle = mesh.corners(t).iter().fold(DVec3::ZERO, |sum, p| sum + (*p - base) / 4.0);
            moment += middle * mesh.volume_of(t);
            volume += mesh.volume_of(t);
        }
        if volume > 0.0 { base + moment / volume } else { base }
    }

    /// Inertia about the centroid for density 1, in mm^5.
    pub fn inertia(&self) -> DMat3 {
        let (mesh, centre) = (self.mesh(), self.centroid());
        let mut second = DMat3::ZERO;
        for t in 0..mesh.tetrahedra.len() {
            let corners = mesh.corners(t).map(|p| p - centre);
            let total: DVec3 = corners.iter().sum();
            // The integral of x y over a tetrahedron: V / 20 (sum of x_i y_i + sum x_i . sum y_i).
            let products = corners.iter().fold(outer(total), |sum, p| sum + outer(*p));
            second += products * (mesh.volume_of(t) / 20.0);
        }
        let trace = second.x_axis.x + second.y_axis.y + second.z_axis.z;
        DMat3::from_diagonal(DVec3::splat(trace)) - second
    }
}

fn outer(p: DVec3) -> DMat3 {
    DMat3::from_cols(p * p.x, p * p.y, p * p.z)
}
