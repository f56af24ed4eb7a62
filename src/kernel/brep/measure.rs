//! Measures of solids, from their faces; sums run in face order and are compensated.

use glam::{DMat3, DVec3};

use super::Polyhedron;
use crate::geom::{FaceRef, PolyMesh, sum::Sum, triangulate::triangulate_face};

/// Volume in mm^3 by the divergence theorem over the faces. Never fails: a [`Polyhedron`] is closed.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::kernel::brep::{measure::volume, primitive::cuboid};
/// assert_eq!(volume(&cuboid(DVec3::ZERO, dvec3(2.0, 3.0, 4.0))), 24.0);
/// ```
pub fn volume(solid: &Polyhedron) -> f64 {
    let mesh = solid.mesh();
    let center = middle(solid);
    let cone = |f: FaceRef| (mesh.points[f.outer()[0] as usize] - center).dot(f.area_vector());
    mesh.faces().map(cone).collect::<Sum>().value() / 6.0
}

/// Area of the boundary in mm^2.
///
/// ```
/// use katachi::kernel::brep::{measure::area, primitive::cone};
/// assert!((area(&cone(2.0, 2.0, 5.0, 4)) - (16.0 + 20.0 * 8f64.sqrt())).abs() < 1e-12);
/// ```
pub fn area(solid: &Polyhedron) -> f64 {
    let sizes = solid.mesh().faces().map(|f| f.area_vector().length());
    sizes.collect::<Sum>().value() / 2.0
}

/// Smallest and largest coordinates in mm; `None` for the empty solid.
pub fn bounds(solid: &Polyhedron) -> Option<[DVec3; 2]> {
    let mesh = solid.mesh();
    let corners = mesh.faces().flat_map(|f| f.outer()).map(|&c| mesh.points[c as usize]);
    corners.fold(None, |bounds, p| {
        let [min, max] = bounds.unwrap_or([p, p]);
        Some([p.min(min), p.max(max)])
    })
}

/// The middle of the bounds: sums are taken about it, so that a solid far out loses no digits.
fn middle(solid: &Polyhedron) -> DVec3 {
    bounds(solid).map_or(DVec3::ZERO, |[min, max]| min + (max - min) / 2.0)
}

/// Volume, centroid and inertia in one pass.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Moments {
    /// mm^3.
    pub volume: f64,
    /// Centre of volume, mm; the origin for the empty solid.
    pub centroid: DVec3,
    /// Inertia about the centroid for density 1, mm^5.
    pub inertia: DMat3,
}

/// Volume, centroid and inertia by tetrahedra from one point to the faces.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::kernel::brep::{measure::moments, primitive::cuboid};
/// let found = moments(&cuboid(DVec3::ZERO, dvec3(2.0, 4.0, 6.0)));
/// assert_eq!(found.centroid, dvec3(1.0, 2.0, 3.0));
/// assert!((found.inertia.x_axis.x - 48.0 * (16.0 + 36.0) / 12.0).abs() < 1e-10);
/// ```
pub fn moments(solid: &Polyhedron) -> Moments {
    let mesh = solid.mesh();
    let center = middle(solid);
    let mut sums = MomentSums::default();
    for face in mesh.faces() {
        let point = |&c: &u32| mesh.points[c as usize] - center;
        let base = point(&face.outer()[0]);
        for corners in face.loops() {
            let last = point(&corners[corners.len() - 1]);
            corners.iter().map(point).fold(last, |before, here| {
                sums.add([base, before, here]);
                here
            });
        }
    }
    sums.about(center)
}

/// Centre of volume in mm; the origin for the empty solid.
pub fn centroid(solid: &Polyhedron) -> DVec3 {
    moments(solid).centroid
}

/// Inertia about the centroid for density 1, mm^5.
pub fn inertia(solid: &Polyhedron) -> DMat3 {
    moments(solid).inertia
}

/// Integrals of 1, x and x x^T over tetrahedra with a corner at the origin.
#[derive(Default)]
struct MomentSums {
    volume: Sum,
    first: [Sum; 3],
    second: [[Sum; 3]; 3],
}

impl MomentSums {
    fn add(&mut self, corners: [DVec3; 3]) {
        let [a, b, c] = corners;
        let six_volumes = a.dot(b.cross(c));
        if six_volumes == 0.0 {
            return;
        }
        let all = a + b + c;
        self.volume.add(six_volumes / 6.0);
        for i in 0..3 {
            self.first[i].add(six_volumes * all[i] / 24.0);
            for j in 0..3 {
                let squares = a[i] * a[j] + b[i] * b[j] + c[i] * c[j];
                self.second[i][j].add(six_volumes * (squares + all[i] * all[j]) / 120.0);
            }
        }
    }

    fn about(&self, center: DVec3) -> Moments {
        let volume = self.volume.value();
        if volume == 0.0 {
            return Moments { volume, centroid: DVec3::ZERO, inertia: DMat3::ZERO };
        }
        let shift = DVec3::from_array(self.first.map(|s| s.value())) / volume;
        let raw = self.second.map(|row| row.map(|s| s.value()));
        let own = |i: usize, j: usize| raw[i][j] - volume * shift[i] * shift[j];
        let trace = own(0, 0) + own(1, 1) + own(2, 2);
        let entry = |i, j| if i == j { trace - own(i, j) } else { -own(i, j) };
        let column = |j| DVec3::new(entry(0, j), entry(1, j), entry(2, j));
        let inertia = DMat3::from_cols(column(0), column(1), column(2));
        Moments { volume, centroid: center + shift, inertia }
    }
}

/// Triangles of the boundary.
pub fn triangles(solid: &Polyhedron) -> usize {
    let mesh = solid.mesh();
    mesh.faces().map(|f| face_triangles(mesh, f)).sum()
}

/// The number of triangles of a face. Loops that share a point count once less: they are one loop.
fn face_triangles(mesh: &PolyMesh, face: FaceRef) -> usize {
    if face.loops().len() == 1 {
        return face.triangle_count();
    }
    let mut corners: Vec<u32> = face.loops().flatten().copied().collect();
    corners.sort_unstable();
    if corners.windows(2).all(|w| w[0] != w[1]) {
        return face.triangle_count();
    }
    let mut found = vec![];
    triangulate_face(&mesh.points, &face.loops().collect::<Vec<_>>(), &mut found);
    found.len()
}

/// Euler number of the closed boundary, vertices - edges + faces of any triangulation: 2 for each shell
/// without handles, 2 less for each handle.
///
/// ```
/// use katachi::kernel::brep::{measure::euler, primitive::torus};
/// assert_eq!(euler(&torus(5.0, 1.0, 8, 8)), 0);
/// ```
pub fn euler(solid: &Polyhedron) -> i64 {
    let mut used = vec![false; solid.mesh().points.len()];
    let corners = solid.mesh().faces().flat_map(|f| f.loops()).flatten();
    corners.for_each(|&c| used[c as usize] = true);
    let vertices = used.iter().filter(|&&u| u).count() as i64;
    // A closed triangulation has three edges for every two triangles.
    vertices - triangles(solid) as i64 / 2
}

/// Number of connected components of the boundary.
pub fn shells(solid: &Polyhedron) -> usize {
    let mut forest: Vec<u32> = (0..solid.mesh().points.len() as u32).collect();
    let mut used = vec![false; forest.len()];
    for face in solid.mesh().faces() {
        let first = face.outer()[0];
        for &corner in face.loops().flatten() {
            used[corner as usize] = true;
            let (a, b) = (root(&mut forest, first), root(&mut forest, corner));
            forest[a.max(b) as usize] = a.min(b);
        }
    }
    (0..forest.len()).filter(|&i| used[i] && forest[i] == i as u32).count()
}

fn root(forest: &mut [u32], mut i: u32) -> u32 {
    while forest[i as usize] != i {
        forest[i as usize] = forest[forest[i as usize] as usize];
        i = forest[i as usize];
    }
    i
}

/// Handles of the boundary: shells - euler / 2.
pub fn genus(solid: &Polyhedron) -> i64 {
    shells(solid) as i64 - euler(solid) / 2
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::{DQuat, dvec3};

    use super::*;
    use crate::{
        geom::Placement,
        kernel::brep::primitive::{cone, cuboid, sphere, torus},
    };

    #[track_caller]
    fn assert_near(found: f64, wanted: f64, relative: f64) {
        assert!((found - wanted).abs() <= relative * wanted.abs(), "{found} is not {wanted}");
    }

    #[test]
    fn round_solids_come_near_their_closed_forms() {
        let ball = moments(&sphere(3.0, 200));
        assert_near(ball.volume, 36.0 * PI, 1e-3);
        assert_near(ball.inertia.z_axis.z, 0.4 * 36.0 * PI * 9.0, 2e-3);
        assert_near(area(&sphere(3.0, 200)), 36.0 * PI, 1e-3);
        let spike = moments(&cone(2.0, 0.0, 8.0, 400));
        assert_near(spike.centroid.z, 2.0, 1e-12);
        assert_near(spike.volume, 32.0 * PI / 3.0, 1e-4);
        let ring = torus(5.0, 1.0, 200, 100);
        assert_near(volume(&ring), 10.0 * PI * PI, 1e-3);
        assert_near(area(&ring), 20.0 * PI * PI, 1e-3);
    }

    #[test]
    fn rigid_motion_changes_nothing_that_should_stay() {
        let block = cuboid(DVec3::ZERO, dvec3(1.0, 2.0, 3.0));
        let turn = glam::DMat3::from_quat(DQuat::from_xyzw(0.5, 0.5, 0.5, 0.5));
        let moved = block.placed(&Placement::new(turn, dvec3(1e4, -2e4, 3e4)));
        let found = moments(&moved);
        assert_near(found.volume, 6.0, 1e-13);
        assert_near(found.centroid.y, -2e4 + 0.5, 1e-14);
        assert_near(found.inertia.x_axis.x, 6.0 * (1.0 + 4.0) / 12.0, 1e-10);
        assert_eq!(
            bounds(&moved),
            Some([dvec3(1e4, -2e4, 3e4), dvec3(1e4 + 3.0, -2e4 + 1.0, 3e4 + 2.0)])
        );
    }

    #[test]
    fn topology() {
        let ring = torus(5.0, 1.0, 8, 6);
        assert_eq!((euler(&ring), shells(&ring), genus(&ring)), (0, 1, 1));
        let mut two = ring.mesh().clone();
        two.append(sphere(1.0, 8).mesh());
        let two = Polyhedron::new(two).expect("closed");
        assert_eq!((euler(&two), shells(&two), genus(&two)), (2, 2, 1));
        let none = Polyhedron::empty();
        assert_eq!((euler(&none), shells(&none), volume(&none)), (0, 0, 0.0));
        assert_eq!((bounds(&none), centroid(&none)), (None, DVec3::ZERO));
    }
}
