//! The field of a closed mesh: nearest point through a hierarchy, sign by pseudo-normals.
//!
//! Baerentzen, J. A., Aanaes, H.: *Signed distance computation using the angle weighted pseudonormal*, 2005.
//! The nearest point lies on a face, an edge or a corner; a point is outside if it is on the side of the
//! normal there, which is that of the face, the sum of those of two faces, or the sum of those around the
//! corner weighted by their angles.
//!
//! # Departures
//! Where a triangle without area touches the nearest feature its normal says nothing; there the solid angle
//! decides (Nagashima 1986).

use std::f64::consts::TAU;

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::{
    Field, Local,
    near::ROUNDING,
    pieces::Pieces,
    tree::Tree,
    triangle::{Feature, Part, Triangle},
};
use crate::geom::{
    Bounds, PolyMesh, spherical_projection::spherical_triangle, triangulate::triangulate,
};

/// The nearest point of a boundary.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Nearest {
    /// The point itself.
    pub point: DVec3,
    /// Its distance, mm; negative where the asking point is inside.
    pub distance: f64,
    /// What it lies on, by numbers of the mesh.
    pub feature: Feature,
    /// A face of the mesh that it lies on.
    pub face: u32,
    /// The direction that tells the sides apart there; not of unit length, zero where it says nothing.
    pub normal: DVec3,
}

/// What a triangle knows of the mesh.
#[derive(Clone, Copy, Debug)]
struct Facet {
    face: u32,
    corners: [u32; 3],
    /// Normals of the triangle, and of its three edges; corners have theirs in a list.
    normal: DVec3,
    edges: [DVec3; 3],
    /// Whether each edge lies between two faces of the mesh.
    ridges: [bool; 3],
}

/// The distance field of a solid bounded by a closed mesh, which must have a face.
#[derive(Clone, Debug)]
pub struct Polyhedral {
    pub(super) tree: Tree,
    /// In the order of the tree.
    pub(super) triangles: Vec<Triangle>,
    facets: Vec<Facet>,
    /// Angle-weighted normals of the points.
    corners: Vec<DVec3>,
    points: Vec<DVec3>,
    extent: Bounds,
}

impl Polyhedral {
    /// The field of a closed mesh; `None` if it has no face.
    ///
    /// ```
    /// use glam::{DVec3, dvec3};
    /// use katachi::kernel::{brep::primitive::cuboid, field::{Feature, Field, Polyhedral}};
    /// let cube = Polyhedral::new(cuboid(DVec3::ZERO, DVec3::splat(2.0)).mesh()).unwrap();
    /// assert_eq!(cube.distance(dvec3(5.0, 6.0, 1.0)), 5.0);
    /// assert!(matches!(cube.nearest(dvec3(5.0, 6.0, 1.0)).feature, Feature::Edge(..)));
    /// ```
    pub fn new(mesh: &PolyMesh) -> Option<Polyhedral> {
        if mesh.is_empty() {
            return None;
        }
        let cut = triangulate(mesh);
        let at = |corners: &[u32; 3]| corners.map(|c| mesh.points[c as usize]);
        let places: Vec<[DVec3; 3]> = cut.corners.iter().map(at).collect();
        let (tree, order) = Tree::new(&places);
        let of = |i: &u32| (cut.corners[*i as usize], cut.face[*i as usize]);
        let ordered: Vec<([u32; 3], u32)> = order.iter().map(of).collect();
        let triangles: Vec<Triangle> = ordered.iter().map(|(t, _)| Triangle::new(at(t))).collect();
        let facets = facets(&ordered, &triangles);
        let corners = corner_normals(&mesh.points, &facets);
        let extent = Bounds::of(places.into_iter().flatten());
        Some(Polyhedral { tree, triangles, facets, corners, points: mesh.points.clone(), extent })
    }

    /// The nearest point of the boundary and what it lies on.
    pub fn nearest(&self, p: DVec3) -> Nearest {
        let (mut found, mut limit) = (0, f64::INFINITY);
        self.tree.nearest(p, f64::INFINITY, |i, best| {
            let square = self.triangles[i as usize].nearest(p).0.distance_squared(p);
            if square < best {
                (limit, found) = (square, i);
            }
            limit
        });
        debug_assert!(
            limit.is_finite() || !p.is_finite(),
            "a mesh with a face has a nearest point"
        );
        self.on_triangle(found, p)
    }

    /// Whether a point is inside or, as far as rounding lets tell, on the boundary.
    ///
    /// ```
    /// use glam::{DVec3, dvec3};
    /// use katachi::kernel::{brep::primitive::cuboid, field::Polyhedral};
    /// let cube = Polyhedral::new(cuboid(DVec3::ZERO, DVec3::splat(2.0)).mesh()).unwrap();
    /// assert!(cube.holds(dvec3(2.0, 1.0, 1.0)) && !cube.holds(dvec3(2.0 + 1e-9, 1.0, 1.0)));
    /// ```
    pub fn holds(&self, p: DVec3) -> bool {
        let size = self.extent.min.abs().max(self.extent.max.abs()).max_element();
        self.distance(p) <= ROUNDING * size
    }

    /// The nearest point, known to lie on a triangle.
    pub(super) fn on_triangle(&self, i: u32, p: DVec3) -> Nearest {
        let (point, part) = self.triangles[i as usize].nearest(p);
        let facet = &self.facets[i as usize];
        let (feature, normal) = match part {
            Part::Inside => (Feature::Face(facet.face), facet.normal),
            Part::Corner(k) => {
                let corner = facet.corners[k];
                (Feature::Vertex(corner), self.corners[corner as usize])
            }
            Part::Edge(k) if !facet.ridges[k] => (Feature::Face(facet.face), facet.edges[k]),
            Part::Edge(k) => {
                let (a, b) = (facet.corners[k], facet.corners[(k + 1) % 3]);
                (Feature::Edge(a.min(b), a.max(b)), facet.edges[k])
            }
        };
        let apart = p.distance(point);
        let outside = match normal == DVec3::ZERO {
            true => !self.surrounds(p),
            false => (p - point).dot(normal) >= 0.0,
        };
        Nearest {
            point,
            distance: if outside { apart } else { -apart },
            feature,
            face: facet.face,
            normal,
        }
    }

    /// A point of every piece of the boundary, in the order of the triangles.
    pub(super) fn pieces(&self) -> Vec<DVec3> {
        let mut pieces = Pieces::new(self.points.len());
        self.facets.iter().for_each(|f| pieces.join(f.corners));
        let mut roots: Vec<u32> = self.facets.iter().map(|f| pieces.of(f.corners[0])).collect();
        roots.sort_unstable();
        roots.dedup();
        roots.into_iter().map(|i| self.points[i as usize]).collect()
    }

    /// Whether the boundary surrounds a point, by its solid angle.
    fn surrounds(&self, p: DVec3) -> bool {
        let seen = |f: &Facet| spherical_triangle(f.corners.map(|c| self.points[c as usize] - p));
        self.facets.iter().map(seen).sum::<f64>() >= TAU
    }

    /// The triangles, by their places, at most so far from a point; `None` if they are more than `most`.
    pub(super) fn within(&self, p: DVec3, reach: f64, most: usize) -> Option<Vec<u32>> {
        let (mut near, square) = (vec![], reach * reach);
        self.tree.nearest(p, square.next_up(), |i, best| {
            let found = self.triangles[i as usize].nearest(p).0.distance_squared(p);
            if found <= square {
                near.push(i);
            }
            // Nothing is nearer than this: the search ends.
            if near.len() > most { f64::NEG_INFINITY } else { best }
        });
        (near.len() <= most).then_some(near)
    }
}

/// Every triangle with its neighbours' normals.
fn facets(ordered: &[([u32; 3], u32)], triangles: &[Triangle]) -> Vec<Facet> {
    let normals: Vec<DVec3> = triangles.iter().map(Triangle::normal).collect();
    let mut sides: FxHashMap<(u32, u32), u32> = FxHashMap::default();
    for (i, (t, _)) in ordered.iter().enumerate() {
        sides.extend((0..3).map(|k| ((t[k], t[(k + 1) % 3]), i as u32)));
    }
    let facet = |(i, &(corners, face)): (usize, &([u32; 3], u32))| {
        let across = |k: usize| sides.get(&(corners[(k + 1) % 3], corners[k])).map(|&j| j as usize);
        let between = |k: usize| match across(k) {
            Some(j) if normals[j] != DVec3::ZERO && normals[i] != DVec3::ZERO => {
                normals[i] + normals[j]
            }
            _ => DVec3::ZERO,
        };
        let ridge = |k: usize| across(k).is_none_or(|j| ordered[j].1 != face);
        let (edges, ridges) = ([0, 1, 2].map(between), [0, 1, 2].map(ridge));
        Facet { face, corners, normal: normals[i], edges, ridges }
    };
    ordered.iter().enumerate().map(facet).collect()
}

/// The angle-weighted normal of every point; zero where a triangle without area meets it.
fn corner_normals(points: &[DVec3], facets: &[Facet]) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; points.len()];
    let mut doubtful = vec![false; points.len()];
    for facet in facets {
        let at = facet.corners.map(|c| points[c as usize]);
        for k in 0..3 {
            let (u, v) = (at[(k + 1) % 3] - at[k], at[(k + 2) % 3] - at[k]);
            let angle = libm::atan2(u.cross(v).length(), u.dot(v));
            normals[facet.corners[k] as usize] += facet.normal * angle;
            doubtful[facet.corners[k] as usize] |= facet.normal == DVec3::ZERO;
        }
    }
    let trusted = |(normal, doubtful): (DVec3, bool)| if doubtful { DVec3::ZERO } else { normal };
    normals.into_iter().zip(doubtful).map(trusted).collect()
}

impl Field for Polyhedral {
    fn distance(&self, p: DVec3) -> f64 {
        self.nearest(p).distance
    }

    fn closest(&self, p: DVec3) -> DVec3 {
        self.nearest(p).point
    }

    fn extent(&self) -> Bounds {
        self.extent
    }

    fn localize<'a>(&'a self, cell: &Bounds) -> Box<dyn Field + 'a> {
        Box::new(Local::new(self, cell))
    }
}
