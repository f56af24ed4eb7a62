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

/// No triangle.
const NONE: u32 = u32::MAX;

/// What a triangle knows of the mesh.
#[derive(Clone, Copy, Debug)]
struct Facet {
    corners: [u32; 3],
    face: u32,
}

/// The nearest of the triangles that were looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Visited {
    triangle: u32,
    point: DVec3,
    part: Part,
    square: f64,
    /// Its distance, mm.
    apart: f64,
}

impl Visited {
    /// None was; this one is the answer if no distance is finite.
    pub fn none_but(triangle: u32) -> Visited {
        let (square, apart) = (f64::INFINITY, f64::INFINITY);
        Visited { triangle, point: DVec3::NAN, part: Part::Inside, square, apart }
    }

    /// Looks at a triangle; gives the least distance.
    #[inline(always)]
    pub fn visit(&mut self, whole: &Polyhedral, triangle: u32, p: DVec3) -> f64 {
        let (point, part) = whole.triangle(triangle).nearest(p);
        let square = point.distance_squared(p);
        if square < self.square {
            *self = Visited { triangle, point, part, square, apart: square.sqrt() };
        }
        self.apart
    }
}

/// The distance field of a solid bounded by a closed mesh, which must have a face.
///
/// What every question reads is kept small: points asked at random wait for memory more than for numbers.
#[derive(Clone, Debug)]
pub struct Polyhedral {
    pub(super) tree: Tree,
    /// In the order of the tree.
    facets: Vec<Facet>,
    /// The triangles across the edges of each.
    across: Vec<[u32; 3]>,
    /// In the order in which triangles come upon them.
    points: Vec<DVec3>,
    /// Their numbers in the mesh.
    names: Vec<u32>,
    /// Their angle-weighted normals.
    corners: Vec<DVec3>,
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
        let extent = Bounds::of(places.iter().flatten().copied());
        let (tree, order) = Tree::new(&places);
        let (mut numbers, mut names) = (vec![NONE; mesh.points.len()], vec![]);
        let mut renamed = |name: u32| {
            let number = &mut numbers[name as usize];
            if *number == NONE {
                *number = names.len() as u32;
                names.push(name);
            }
            *number
        };
        let mut facet = |&i: &u32| {
            let corners = cut.corners[i as usize].map(&mut renamed);
            Facet { corners, face: cut.face[i as usize] }
        };
        let facets: Vec<Facet> = order.iter().map(&mut facet).collect();
        let across = across(&facets);
        let points: Vec<DVec3> = names.iter().map(|&i| mesh.points[i as usize]).collect();
        let corners = corner_normals(&points, &facets);
        Some(Polyhedral { tree, facets, across, points, names, corners, extent })
    }

    /// A triangle, by its place in the tree.
    #[inline]
    pub(super) fn triangle(&self, i: u32) -> Triangle {
        Triangle::new(self.places(i))
    }

    /// The corners of a triangle.
    #[inline]
    pub(super) fn places(&self, i: u32) -> [DVec3; 3] {
        self.facets[i as usize].corners.map(|c| self.points[c as usize])
    }

    /// The nearest point of the boundary and what it lies on.
    pub fn nearest(&self, p: DVec3) -> Nearest {
        let mut best = Visited::none_but(0);
        self.tree.nearest(p, f64::INFINITY, |leaf, _| {
            leaf.for_each(|i| _ = best.visit(self, i, p));
            best.square
        });
        debug_assert!(
            best.square.is_finite() || !p.is_finite(),
            "a mesh with a face has a nearest point"
        );
        self.at_visited(&best, p)
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

    /// The nearest point, found on a triangle.
    pub(super) fn at_visited(&self, found: &Visited, p: DVec3) -> Nearest {
        let &Visited { triangle, mut point, mut part, mut apart, .. } = found;
        if apart == f64::INFINITY {
            (point, part) = self.triangle(triangle).nearest(p);
            apart = p.distance(point);
        }
        let facet = &self.facets[triangle as usize];
        let (feature, normal) = match part {
            Part::Inside => (Feature::Face(facet.face), self.triangle(triangle).normal()),
            Part::Corner(k) => {
                let corner = facet.corners[k] as usize;
                (Feature::Vertex(self.names[corner]), self.corners[corner])
            }
            Part::Edge(k) => self.on_edge(triangle, k),
        };
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

    /// What a point on an edge of a triangle lies on, and the normal there.
    fn on_edge(&self, i: u32, k: usize) -> (Feature, DVec3) {
        let (facet, across) = (&self.facets[i as usize], self.across[i as usize][k]);
        let other = self.facets.get(across as usize);
        let normals = [
            self.triangle(i).normal(),
            other.map_or(DVec3::ZERO, |other| triangle(&self.points, other).normal()),
        ];
        let normal =
            if normals.contains(&DVec3::ZERO) { DVec3::ZERO } else { normals[0] + normals[1] };
        if other.is_some_and(|other| other.face == facet.face) {
            return (Feature::Face(facet.face), normal);
        }
        let [a, b] = [k, (k + 1) % 3].map(|k| self.names[facet.corners[k] as usize]);
        (Feature::Edge(a.min(b), a.max(b)), normal)
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
        self.tree.nearest(p, square.next_up(), |leaf, best| {
            let away = |i: u32| self.triangle(i).nearest(p).0.distance_squared(p);
            near.extend(leaf.filter(|&i| away(i) <= square));
            // Nothing is nearer than this: the search ends.
            if near.len() > most { f64::NEG_INFINITY } else { best }
        });
        (near.len() <= most).then_some(near)
    }
}

fn triangle(points: &[DVec3], facet: &Facet) -> Triangle {
    Triangle::new(facet.corners.map(|c| points[c as usize]))
}

/// The triangles across the edges of each.
fn across(facets: &[Facet]) -> Vec<[u32; 3]> {
    let mut sides: FxHashMap<(u32, u32), u32> = FxHashMap::default();
    for (i, Facet { corners, .. }) in facets.iter().enumerate() {
        sides.extend((0..3).map(|k| ((corners[k], corners[(k + 1) % 3]), i as u32)));
    }
    let other = |a: u32, b: u32| sides.get(&(b, a)).copied().unwrap_or(NONE);
    let of =
        |Facet { corners: [a, b, c], .. }: &Facet| [other(*a, *b), other(*b, *c), other(*c, *a)];
    facets.iter().map(of).collect()
}

/// The angle-weighted normal of every point; zero where a triangle without area meets it.
fn corner_normals(points: &[DVec3], facets: &[Facet]) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; points.len()];
    let mut doubtful = vec![false; points.len()];
    for facet in facets {
        let normal = triangle(points, facet).normal();
        let at = facet.corners.map(|c| points[c as usize]);
        for k in 0..3 {
            let (u, v) = (at[(k + 1) % 3] - at[k], at[(k + 2) % 3] - at[k]);
            let angle = libm::atan2(u.cross(v).length(), u.dot(v));
            normals[facet.corners[k] as usize] += normal * angle;
            doubtful[facet.corners[k] as usize] |= normal == DVec3::ZERO;
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
