use std::sync::Arc;

use glam::{DVec3, dvec3};

use super::*;
use crate::geom::{BoundaryTriangle, Origin, Surface};

/// Two tetrahedra on one face; the first triangle of the boundary is tagged.
fn pair() -> TetMesh {
    let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, dvec3(1.0, 1.0, 1.0)];
    let plain = Origin::of(Surface::Plane);
    let tagged = Origin { tags: vec![Arc::from("seat")], ..plain.clone() };
    let triangle = |corners, tetrahedron, opposite, origin| BoundaryTriangle {
        corners,
        tetrahedron,
        opposite,
        face: 0,
        origin,
    };
    TetMesh {
        points,
        tetrahedra: vec![[0, 1, 2, 3], [1, 4, 2, 3]],
        boundary: vec![triangle([0, 2, 1], 0, 3, 1), triangle([1, 2, 4], 1, 3, 0)],
        origins: vec![plain, tagged],
    }
}

fn text(format: ElementFormat) -> String {
    let mesh = pair();
    let parts =
        [NamedElements { name: "a part", mesh: &mesh }, NamedElements { name: "b", mesh: &mesh }];
    String::from_utf8(write(format, &parts).expect("finite")).expect("text")
}

#[test]
fn gmsh_gets_named_groups() {
    let text = text(ElementFormat::Msh);
    assert!(text.contains(
        "$PhysicalNames\n6\n2 3 \"a part.seat\"\n2 4 \"a part.boundary\"\n3 1 \"a part\"\n"
    ));
    assert!(text.contains("$Nodes\n2 10 1 10\n3 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n"));
    assert!(text.contains("\n2 5 2 1\n5 6 8 7\n") && text.contains("\n3 2 4 2\n7 6 7 8 9\n"));
}

#[test]
fn abaqus_gets_surfaces_by_the_faces_of_elements() {
    let text = text(ElementFormat::Inp);
    assert!(text.contains("*ELEMENT, TYPE=C3D4, ELSET=a_part\n1, 1, 2, 3, 4\n2, 2, 5, 3, 4\n"));
    assert!(text.contains("*SURFACE, TYPE=ELEMENT, NAME=b.seat\n3, S1\n"));
}

#[test]
fn vtk_and_medit_get_numbers_of_groups() {
    let vtu = text(ElementFormat::Vtu);
    assert!(vtu.contains("NumberOfPoints=\"10\" NumberOfCells=\"8\""));
    assert!(vtu.contains("Name=\"group\" format=\"ascii\">\n1 1 3 4 2 2 5 6\n"));
    let medit = text(ElementFormat::Medit);
    assert!(medit.contains("Triangles\n4\n1 3 2 3\n2 3 5 4\n6 8 7 5\n7 8 10 6\n"));
}

#[test]
fn what_is_no_number_is_refused() {
    let mut mesh = pair();
    mesh.points[0].x = f64::NAN;
    let parts = [NamedElements { name: "a", mesh: &mesh }];
    assert!(write(ElementFormat::Vtu, &parts).is_err());
}
