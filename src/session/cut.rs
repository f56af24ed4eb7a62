//! Solids cut by a plane, for section views.

use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};

use crate::{
    base::{Code, Diagnostic, Span},
    geom::{FaceRef, Origin, Placement, PolyMesh, Tolerance},
    kernel::brep::{
        Polyhedron,
        boolean::{Tree, evaluate},
        primitive::cuboid,
    },
    output::{
        drawing::{Camera, true_outlines},
        sheet::Cut,
    },
    shape::drawing::CutPlane,
};

/// The name by which faces on the cutting plane are known. No tag of a model has it: tags hold no control characters
/// that a person types.
const MARK: &str = "\u{1}section";

/// How much larger than the solid the block is that is taken away, so that its other faces touch nothing.
const CLEARANCE: f64 = 1.5;

/// Outlines of cuts and the edges drawn there are each a quarter of the tolerance off the true curve at most.
const OUTLINE: f64 = 0.5;

/// How far the outline of a cut may seem to be from the edge drawn there, relative to the size of the solid.
const COINCIDENT: f64 = 1e-7;

/// Takes away what lies on the side of the plane's normal, and returns the cut faces that the camera looks at, as they
/// are on paper. Fails in words where a solid cannot be cut.
pub fn cut(
    solids: &mut [Arc<Polyhedron>],
    plane: &CutPlane,
    camera: &Camera,
    tolerance: Tolerance,
) -> Result<Vec<Cut>, String> {
    let normal = plane.normal.normalize();
    let mut cuts = vec![];
    for (body, solid) in (0..).zip(solids.iter_mut()) {
        let (low, high) = reach(solid.mesh(), plane.at, normal);
        if high <= 0.0 || solid.is_empty() {
            continue;
        }
        if low >= 0.0 {
            *solid = Arc::new(Polyhedron::trusted(PolyMesh::default()));
            continue;
        }
        let block = block(solid.mesh(), plane.at, normal, high);
        let tree = Tree::Difference(vec![Tree::Leaf(solid.clone()), block]);
        *solid = Arc::new(evaluate(&tree).map_err(|error| error.to_string())?.solid);
        let size = extent(solid.mesh()).1;
        let rings = rings(solid.mesh(), normal, camera, tolerance);
        let tolerance = (tolerance.mm() * OUTLINE).max(size * COINCIDENT);
        if !rings.is_empty() {
            cuts.push(Cut { rings, body, tolerance });
        }
    }
    Ok(cuts)
}

/// How far a mesh reaches behind and before a plane, mm.
fn reach(mesh: &PolyMesh, at: DVec3, normal: DVec3) -> (f64, f64) {
    let heights = mesh.points.iter().map(|p| (*p - at).dot(normal));
    heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)))
}

/// Centre and diameter of a ball around a mesh.
fn extent(mesh: &PolyMesh) -> (DVec3, f64) {
    let Some(&first) = mesh.points.first() else { return (DVec3::ZERO, 0.0) };
    let (min, max) = mesh.points.iter().fold((first, first), |(a, b), p| (a.min(*p), b.max(*p)));
    ((min + max) / 2.0, (max - min).length())
}

/// A block on the plane that holds all of a mesh on the side of the normal; its faces bear [`MARK`].
fn block(mesh: &PolyMesh, at: DVec3, normal: DVec3, height: f64) -> Tree {
    let (center, size) = extent(mesh);
    let half = size * CLEARANCE;
    let foot = center - normal * (center - at).dot(normal);
    let cuboid =
        cuboid(DVec3::new(-half, -half, 0.0), DVec3::new(half, half, height * CLEARANCE + size));
    let marked = cuboid.mesh().clone().with_origins(|origin| origin.tags.push(MARK.into()));
    // Along an axis of the model the frame is exact, and so is the cut.
    let aside = if normal.x.abs() < 0.5 { DVec3::X } else { DVec3::Y };
    let u = (aside - normal * aside.dot(normal)).normalize();
    let placement = Placement::new(DMat3::from_cols(u, normal.cross(u), normal), foot);
    Tree::Placed(placement, Box::new(Tree::Leaf(Arc::new(Polyhedron::trusted(marked)))))
}

/// The outlines of the cut faces on paper; none when the camera sees the cut from behind.
fn rings(mesh: &PolyMesh, normal: DVec3, camera: &Camera, tolerance: Tolerance) -> Vec<Vec<DVec2>> {
    let marked = |origin: &Origin| origin.tags.iter().any(|tag| **tag == *MARK);
    let seen = |face: FaceRef| {
        let here = mesh.points[face.outer()[0] as usize];
        marked(face.origin())
            && face.area_vector().dot(normal) > 0.0
            && camera.sight(here).dot(normal) > 0.0
    };
    let loops = true_outlines(mesh, seen, tolerance).into_iter().flatten();
    loops.map(|points| points.iter().filter_map(|p| camera.project(*p)).collect()).collect()
}

/// The warning for a plane that cuts nothing.
pub fn misses(solids: &[Arc<Polyhedron>], at: Span) -> Diagnostic {
    let gone = solids.iter().all(|solid| solid.is_empty());
    let words = if gone {
        "the section plane misses the shapes: all of them lie before it and are taken away"
    } else {
        "the section plane misses the shapes: it cuts nothing, or is seen from behind"
    };
    let warning = Diagnostic::warning(Code::EmptyResult, words).label(at, "");
    let kept = solids.iter().find(|solid| !solid.is_empty());
    kept.map_or(warning.clone(), |solid| {
        let (center, size) = extent(solid.mesh());
        let middle = center.to_array().map(super::drafting::short).join(", ");
        let size = super::drafting::short(size);
        warning.note(format!("what is left lies about [{middle}], {size} mm across"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{kernel::brep::primitive::cone, output::drawing::View};

    #[test]
    fn a_cut_beside_the_middle_is_as_wide_as_the_true_cylinder() {
        let plane = CutPlane { at: DVec3::X * 9.9, normal: DVec3::X };
        let mut solids = [Arc::new(cone(10.0, 10.0, 5.0, 32))];
        let camera = Camera::view(View::Right);
        let cuts = cut(&mut solids, &plane, &camera, Tolerance::DEFAULT).expect("a cut");
        let half = cuts[0].rings.iter().flatten().map(|p| p.x).fold(0.0, f64::max);
        assert!((half - (100.0f64 - 9.9 * 9.9).sqrt()).abs() < 1e-6, "{half}");
    }
}
