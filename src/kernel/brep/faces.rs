//! Solids from points and faces: the modeller's own, and meshes from files.

use glam::DVec3;
use rustc_hash::FxHashMap;
use thiserror::Error;

use super::{Defect, Polyhedron, closing};
use crate::geom::{Origin, PolyMesh, Surface};

/// Why points and faces make no solid.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum FacesError {
    /// Nothing to enclose.
    #[error("no faces; a polyhedron needs at least 4")]
    NoFaces,
    /// A face with fewer than three different corners.
    #[error("face {face} has {corners} different corners; it needs at least 3")]
    FewCorners {
        /// Its place in the list, from 0.
        face: usize,
        /// Different corners found.
        corners: usize,
    },
    /// An index that is no point.
    #[error("face {face} names point {index}; there are {points} points, counted from 0")]
    NoSuchPoint {
        /// Its place in the list, from 0.
        face: usize,
        /// The index.
        index: u32,
        /// Number of points.
        points: usize,
    },
    /// The faces do not close.
    #[error(transparent)]
    Defect(#[from] Defect),
}

/// The solid whose boundary is given by points (mm) and faces as lists of point indices. Equal points
/// count as one. Faces may run either way round as long as they close: each shell is turned outwards, and
/// shells inside shells are cavities. A face that is not flat is cut into triangles; neighbouring faces of
/// one plane are merged.
///
/// ```
/// use glam::DVec3;
/// use katachi::kernel::brep::{faces::polyhedron, measure::volume};
/// let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let solid = polyhedron(&points, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
/// assert_eq!(volume(&solid), 1.0 / 6.0);
/// ```
pub fn polyhedron<F: AsRef<[u32]>>(
    points: &[DVec3],
    faces: &[F],
) -> Result<Polyhedron, FacesError> {
    if faces.is_empty() {
        return Err(FacesError::NoFaces);
    }
    let first = first_equal(points);
    let mut mesh = PolyMesh::with_points(points.to_vec());
    let origin = mesh.add_origin(Origin::of(Surface::Plane));
    for (face, corners) in faces.iter().enumerate() {
        let corners = corners.as_ref();
        if let Some(&index) = corners.iter().find(|&&c| c as usize >= points.len()) {
            return Err(FacesError::NoSuchPoint { face, index, points: points.len() });
        }
        let mut corners: Vec<u32> = corners.iter().map(|&c| first[c as usize]).collect();
        corners.dedup();
        if corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() < 3 {
            return Err(FacesError::FewCorners { face, corners: corners.len() });
        }
        let plane = mesh.add_plane();
        mesh.push_face(&[corners], plane, origin);
    }
    Ok(closing::close(&mesh)?)
}

/// For each point the first one equal to it.
fn first_equal(points: &[DVec3]) -> Vec<u32> {
    let mut known: FxHashMap<[u64; 3], u32> = FxHashMap::default();
    let bits = |p: &DVec3| (*p + DVec3::ZERO).to_array().map(f64::to_bits);
    points.iter().zip(0..).map(|(p, i)| *known.entry(bits(p)).or_insert(i)).collect()
}

/// The solid of a mesh read from a file, its points welded. As [`polyhedron`], and: triangles with a
/// corner twice are left out; where more than two faces meet at an edge the solid is taken apart there, so
/// that each piece is a manifold; a point where several fans meet becomes several points.
///
/// Faces are merged where they are flat within one unit in the last place of single precision at the
/// largest coordinate, since that is how STL files round. Origins stay, and bound merging.
///
/// Fails with the number of open edges and one place. Four million triangles take a few seconds.
pub fn from_import(mesh: &PolyMesh) -> Result<Polyhedron, Defect> {
    closing::close(mesh)
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, dvec3};

    use super::*;
    use crate::{
        geom::{Placement, triangulate::triangulate},
        kernel::brep::{
            measure,
            primitive::{cuboid, sphere, torus},
        },
    };

    /// The triangles of solids as one soup with single-precision points, welded.
    fn soup(solids: &[Polyhedron]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let mut all = PolyMesh::default();
        solids.iter().for_each(|s| all.append(s.mesh()));
        let points: Vec<DVec3> = all.points.iter().map(|p| p.as_vec3().as_dvec3()).collect();
        let first = first_equal(&points);
        let triangles = triangulate(&all).corners;
        (points, triangles.iter().map(|t| t.map(|c| first[c as usize])).collect())
    }

    fn close(solids: &[Polyhedron]) -> Result<Polyhedron, FacesError> {
        let (points, faces) = soup(solids);
        polyhedron(&points, &faces)
    }

    fn block(at: [f64; 3], size: f64) -> Polyhedron {
        cuboid(DVec3::from(at), DVec3::from(at) + size)
    }

    #[test]
    fn triangles_of_one_plane_become_one_face() {
        let cube = close(&[block([0.; 3], 10.)]).expect("closed");
        assert_eq!((cube.mesh().face_count(), measure::volume(&cube)), (6, 1000.0));
        let turn = glam::DMat3::from_quat(DQuat::from_xyzw(0.1, 0.7, -0.3, 0.6).normalize());
        let moved = block([0.; 3], 10.).placed(&Placement::new(turn, dvec3(1., 2., 3.)));
        let moved = close(&[moved]).expect("closed");
        assert_eq!(moved.mesh().face_count(), 6);
        assert!((measure::volume(&moved) - 1000.0).abs() < 1e-3);
        let ring = close(&[torus(9., 3., 24, 12)]).expect("closed");
        assert_eq!((ring.mesh().face_count(), measure::genus(&ring)), (24 * 12, 1));
    }

    #[test]
    fn inside_out_and_mixed_faces_are_turned() {
        let (points, mut faces) = soup(&[sphere(5., 16)]);
        let wanted = measure::volume(&polyhedron(&points, &faces).expect("closed"));
        assert!(wanted > 0.0);
        faces.iter_mut().for_each(|f| f.reverse());
        assert_eq!(measure::volume(&polyhedron(&points, &faces).expect("closed")), wanted);
        faces.iter_mut().step_by(3).for_each(|f| f.reverse());
        assert!(
            (measure::volume(&polyhedron(&points, &faces).expect("closed")) - wanted).abs() < 1e-9
        );
    }

    #[test]
    fn shells_inside_shells_are_cavities_whichever_way_they_come() {
        let nested =
            [block([0.; 3], 10.), block([2.; 3], 5.), block([3.; 3], 2.), block([20.; 3], 1.)];
        let solid = close(&nested).expect("closed");
        assert_eq!(measure::volume(&solid), 1000.0 - 125.0 + 8.0 + 1.0);
        assert_eq!(measure::shells(&solid), 4);
    }

    #[test]
    fn cubes_that_share_an_edge_or_a_point_are_taken_apart() {
        for at in [[1., 1., 0.], [1., 1., 1.]] {
            let two = close(&[block([0.; 3], 1.), block(at, 1.)]).expect("closed");
            assert_eq!((measure::volume(&two), measure::shells(&two)), (2.0, 2));
            assert_eq!(measure::euler(&two), 4);
        }
    }

    /// Two blocks that meet in one edge, between two that hold both: the surface touches itself along the
    /// edge, and is one fan around either end.
    #[test]
    fn a_surface_that_touches_itself_along_an_edge_is_taken_apart() {
        let floors = [[-1., 0.], [0., 1.], [1., 2.]];
        let mut cubes = vec![];
        for (level, [z, _]) in floors.into_iter().enumerate() {
            for (x, y) in [(0., 0.), (0., 1.), (1., 0.), (1., 1.)] {
                if level != 1 || x == y {
                    cubes.push(block([x, y, z], 1.));
                }
            }
        }
        let (points, faces) = soup(&cubes);
        let across = |f: &[u32; 3], g: &[u32; 3]| f.iter().all(|c| g.contains(c));
        let inner = |f: &[u32; 3]| faces.iter().filter(|g| across(f, g)).count() > 1;
        let outer: Vec<[u32; 3]> = faces.iter().filter(|f| !inner(f)).copied().collect();
        let tower = polyhedron(&points, &outer).expect("closed");
        assert_eq!((measure::volume(&tower), measure::shells(&tower)), (10.0, 1));
        assert!(tower.mesh().points.contains(&dvec3(1.0, 1.0, 0.5)));
        assert!(Polyhedron::new(tower.into_mesh()).is_ok());
    }

    #[test]
    fn faces_with_holes_are_found() {
        let plate = |z: f64| cuboid(dvec3(-9., -9., z), dvec3(9., 9., z + 1.));
        let (points, mut faces) = soup(&[plate(0.), block([-2., -2., 0.], 1.)]);
        // Cut the hole: the inner block's floor and roof go, and the plate's with them.
        let level =
            |f: &[u32; 3]| f.iter().all(|&c| points[c as usize].z == points[f[0] as usize].z);
        faces.retain(|f| !level(f));
        let ring = |z: f64, list: [[f64; 2]; 4]| {
            list.map(|[x, y]| {
                points.iter().position(|p| *p == dvec3(x, y, z)).expect("a point") as u32
            })
        };
        let outer = [[-9., -9.], [9., -9.], [9., 9.], [-9., 9.]];
        let inner = [[-2., -2.], [-1., -2.], [-1., -1.], [-2., -1.]];
        for z in [0., 1.] {
            let (o, i) = (ring(z, outer), ring(z, inner));
            for k in 0..4 {
                let n = (k + 1) % 4;
                faces.extend([[o[k], o[n], i[n]], [o[k], i[n], i[k]]]);
            }
        }
        let frame = polyhedron(&points, &faces).expect("closed");
        assert_eq!((frame.mesh().face_count(), measure::volume(&frame)), (10, 323.0));
        assert_eq!(measure::genus(&frame), 1);
    }

    #[test]
    fn faults_are_named() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let open = polyhedron(&points, &[[0, 2, 1], [0, 1, 3], [1, 2, 3]]);
        assert!(matches!(
            open,
            Err(FacesError::Defect(Defect::OpenEdge { edges: 3, faces: 1, .. }))
        ));
        let far = polyhedron(&points, &[[0, 1, 7]]);
        assert_eq!(far, Err(FacesError::NoSuchPoint { face: 0, index: 7, points: 4 }));
        let thin = polyhedron(&points, &[vec![0, 1, 1]]);
        assert_eq!(thin, Err(FacesError::FewCorners { face: 0, corners: 2 }));
        let moebius: Vec<[u32; 3]> = (0..5).map(|i| [i, (i + 1) % 5, (i + 2) % 5]).collect();
        let pentagon: Vec<DVec3> =
            (0..5).map(|i| dvec3(f64::from(i * i), f64::from(i), 1.)).collect();
        assert!(matches!(polyhedron(&pentagon, &moebius), Err(FacesError::Defect(_))));
        assert_eq!(polyhedron::<[u32; 3]>(&points, &[]), Err(FacesError::NoFaces));
    }

    #[test]
    fn bent_quadrilaterals_are_cut() {
        let mut points = block([0.; 3], 2.).into_mesh().points;
        points[7].z = 3.0;
        let faces =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let solid = polyhedron(&points, &faces).expect("closed");
        assert_eq!(solid.mesh().face_count(), 7);
    }
}
