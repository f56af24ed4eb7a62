//! A mesh made ready for the writers: cut into triangles, its faces in order.

use glam::{DVec2, DVec3};

use super::NamedMesh;
use crate::geom::{
    FaceRef, PolyMesh,
    mesh::Color,
    triangulate::{Triangles, triangulate},
};

/// What stands in for the colour of a face without one, in formats where all faces must have one if
/// any has: the light grey of most viewers.
pub(in crate::output) const PLAIN: Color = Color { r: 200, g: 200, b: 200 };

/// A part and its triangles.
pub(in crate::output) struct Part<'a> {
    pub name: &'a str,
    pub mesh: &'a PolyMesh,
    /// Ascending by face.
    pub triangles: Triangles,
}

/// A face as it is written where polygons are allowed: as one polygon, or as triangles.
pub(in crate::output) enum Facet<'a> {
    Polygon(&'a [u32]),
    Triangles(&'a [[u32; 3]]),
}

impl<'a> Facet<'a> {
    /// The polygons to write, one or several.
    pub fn polygons(&self) -> impl Iterator<Item = &'a [u32]> + use<'a> {
        let (whole, cut): (Option<&'a [u32]>, &'a [[u32; 3]]) = match *self {
            Facet::Polygon(corners) => (Some(corners), &[]),
            Facet::Triangles(triangles) => (None, triangles),
        };
        whole.into_iter().chain(cut.iter().map(|t| t.as_slice()))
    }
}

impl<'a> Part<'a> {
    pub fn new(part: &NamedMesh<'a>) -> Part<'a> {
        Part { name: part.name, mesh: part.mesh, triangles: triangulate(part.mesh) }
    }

    /// The faces, each with its triangles.
    pub fn faces(&self) -> impl Iterator<Item = (FaceRef<'a>, &[[u32; 3]])> {
        let mut start = 0;
        self.mesh.faces().map(move |face| {
            let rest = &self.triangles.face[start..];
            let count = rest.iter().take_while(|&&f| f as usize == face.index()).count();
            let triangles = &self.triangles.corners[start..start + count];
            start += count;
            (face, triangles)
        })
    }

    /// The faces as polygons where a fan reader gets them right.
    pub fn facets(&self) -> impl Iterator<Item = (FaceRef<'a>, Facet<'_>)> {
        self.faces().map(move |(face, triangles)| {
            let triangle = face.outer().len() == 3;
            let whole = face.loops().len() == 1 && (triangle || is_convex(self.mesh, face));
            let facet =
                if whole { Facet::Polygon(face.outer()) } else { Facet::Triangles(triangles) };
            (face, facet)
        })
    }

    /// Whether any face has a colour.
    pub fn is_coloured(&self) -> bool {
        self.mesh.origins().iter().any(|origin| origin.color.is_some())
    }
}

/// Whether a face without holes turns left (or goes straight on) at every corner. What rounding does
/// to this only decides how the face is written, never its shape.
fn is_convex(mesh: &PolyMesh, face: FaceRef) -> bool {
    let flat = flattening(face.area_vector());
    let corners = face.outer();
    let at = |i: usize| flat(mesh.points[corners[i % corners.len()] as usize]);
    let turn = |i: usize| (at(i + 1) - at(i)).perp_dot(at(i + 2) - at(i + 1));
    let backwards = |i: usize| (at(i + 1) - at(i)).dot(at(i + 2) - at(i + 1)) < 0.0;
    // A spike folds back on itself with turn 0, which a fan would overlap.
    (0..corners.len()).all(|i| turn(i) > 0.0 || (turn(i) == 0.0 && !backwards(i)))
}

/// The projection along the longest component of a normal, keeping the sense of rotation.
fn flattening(normal: DVec3) -> impl Fn(DVec3) -> DVec2 {
    let size = normal.abs();
    let (u, v, sign) = if size.z >= size.x && size.z >= size.y {
        (0, 1, normal.z)
    } else if size.x >= size.y {
        (1, 2, normal.x)
    } else {
        (2, 0, normal.y)
    };
    let (u, v) = if sign >= 0.0 { (u, v) } else { (v, u) };
    move |p| DVec2::new(p[u], p[v])
}
