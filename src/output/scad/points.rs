//! Meshes and regions as lists of points.

use std::fmt::Write;

use glam::{DVec2, DVec3};

use crate::{
    geom::{PolyMesh, Region},
    output::{
        mesh::{NamedMesh, part::Part},
        number::Shortest,
    },
};

/// `[x, y]`.
pub(super) fn pair(p: DVec2) -> String {
    format!("[{}, {}]", Shortest(p.x), Shortest(p.y))
}

/// `[x, y, z]`.
pub(super) fn triple(p: DVec3) -> String {
    format!("[{}, {}, {}]", Shortest(p.x), Shortest(p.y), Shortest(p.z))
}

/// `[a, b, c]` of anything that is already text or prints itself.
pub(super) fn list<T: std::fmt::Display>(items: impl IntoIterator<Item = T>) -> String {
    let mut text = String::from("[");
    for (i, item) in items.into_iter().enumerate() {
        let _ = write!(text, "{}{item}", if i == 0 { "" } else { ", " });
    }
    text + "]"
}

/// A `polyhedron`; `faces` run counter-clockwise seen from outside and are turned over for OpenSCAD.
pub(super) fn polyhedron<'a>(
    points: &[DVec3],
    faces: impl IntoIterator<Item = &'a [u32]>,
) -> String {
    let points = list(points.iter().map(|&p| triple(p)));
    let faces = list(faces.into_iter().map(|face| list(face.iter().rev())));
    format!("polyhedron(points = {points}, faces = {faces}, convexity = 10);")
}

/// A mesh as `polyhedron`: convex faces whole, others as triangles.
pub(super) fn mesh(mesh: &PolyMesh) -> String {
    let part = Part::new(&NamedMesh { name: "", mesh });
    let facets: Vec<_> = part.facets().map(|(_, facet)| facet).collect();
    polyhedron(&mesh.points, facets.iter().flat_map(|facet| facet.polygons()))
}

/// A `polygon` with one path a loop; OpenSCAD tells holes from outlines by nesting.
pub(super) fn polygon<'a>(loops: impl IntoIterator<Item = &'a [DVec2]>) -> String {
    let (mut points, mut paths) = (vec![], vec![]);
    for corners in loops {
        paths.push(list(points.len()..points.len() + corners.len()));
        points.extend(corners.iter().map(|&p| pair(p)));
    }
    format!("polygon(points = {}, paths = {});", list(points), list(paths))
}

/// A region as `polygon`.
pub(super) fn region(region: &Region) -> String {
    polygon(region.contours().map(|contour| contour.points.as_slice()))
}
