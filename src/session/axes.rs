//! Centre lines: the axes of the round faces of a drawing.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::{
    geom::{PolyMesh, Surface},
    output::drawing::Camera,
};

/// Axes whose places or directions, in millimetres or as parts of a unit vector, differ by less are one.
const STEP: f64 = 1e-6;

/// A round face has a centre line when no part of a turn wider than this is missing from it: fillets and ends of slots
/// have none.
const WIDEST_GAP: f64 = 2.0;

/// The sine of the angle below which an axis counts as parallel to the sight line.
const ALONG_SIGHT: f64 = 1e-6;

/// The round faces about one axis.
#[derive(Debug)]
struct Axis {
    point: DVec3,
    direction: DVec3,
    /// From where to where along the axis.
    low: f64,
    high: f64,
    radius: f64,
    /// Directions of the corners about the axis, radians.
    angles: Vec<f64>,
}

/// The centre lines of all meshes, in an order that depends on the places of the axes alone: a line along each axis,
/// or a cross where the camera looks along it. They end where what they belong to ends; a figure lets them go on.
pub fn center_lines<'a>(
    meshes: impl Iterator<Item = &'a PolyMesh>,
    camera: &Camera,
) -> Vec<[DVec3; 2]> {
    let mut axes: BTreeMap<[i64; 6], Axis> = BTreeMap::new();
    for mesh in meshes {
        for face in mesh.faces() {
            let Some((point, direction)) = axis_of(&face.origin().surface) else { continue };
            let axis =
                axes.entry(key(point, direction)).or_insert_with(|| Axis::new(point, direction));
            let corners = face.loops().flatten();
            corners.for_each(|&corner| axis.take(mesh.points[corner as usize]));
        }
    }
    axes.values_mut().for_each(|axis| axis.angles.sort_by(f64::total_cmp));
    axes.values().filter(|axis| axis.is_round()).flat_map(|axis| axis.lines(camera)).collect()
}

/// The axis of a round surface: its point nearest to the origin, and its direction upwards.
fn axis_of(surface: &Surface) -> Option<(DVec3, DVec3)> {
    let (point, axis) = match *surface {
        Surface::Cylinder { point, axis, .. } => (point, axis),
        Surface::Cone { apex, axis, .. } => (apex, axis),
        Surface::Torus { center, axis, .. } => (center, axis),
        Surface::Sphere { .. } | Surface::Plane | Surface::Smooth | Surface::Facets => return None,
    };
    let turned = [axis.z, axis.y, axis.x].into_iter().find(|c| c.abs() > STEP)? < 0.0;
    let axis = if turned { -axis } else { axis };
    Some((point - axis * point.dot(axis), axis))
}

fn key(point: DVec3, direction: DVec3) -> [i64; 6] {
    let steps = |v: DVec3| v.to_array().map(|x| (x / STEP).round() as i64);
    let ([a, b, c], [d, e, f]) = (steps(direction), steps(point));
    [a, b, c, d, e, f]
}

impl Axis {
    fn new(point: DVec3, direction: DVec3) -> Axis {
        let (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
        Axis { point, direction, low, high, radius: 0.0, angles: vec![] }
    }

    fn take(&mut self, corner: DVec3) {
        let from = corner - self.point;
        let height = from.dot(self.direction);
        let across = from - self.direction * height;
        let (u, v) = self.direction.any_orthonormal_pair();
        (self.low, self.high) = (self.low.min(height), self.high.max(height));
        self.radius = self.radius.max(across.length());
        self.angles.push(libm::atan2(across.dot(v), across.dot(u)));
    }

    /// Whether it is surrounded. The angles must be in order.
    fn is_round(&self) -> bool {
        let (Some(first), Some(last)) = (self.angles.first(), self.angles.last()) else {
            return false;
        };
        let around = first + std::f64::consts::TAU - last;
        let gaps = self.angles.windows(2).map(|pair| pair[1] - pair[0]);
        gaps.fold(around, f64::max) <= WIDEST_GAP
    }

    fn lines(&self, camera: &Camera) -> Vec<[DVec3; 2]> {
        let at = |height: f64| self.point + self.direction * height;
        let middle = at(self.low.midpoint(self.high));
        let sight = camera.sight(middle).normalize();
        if sight.cross(self.direction).length() > ALONG_SIGHT {
            return vec![[at(self.low), at(self.high)]];
        }
        let frame = camera.frame();
        let across = [frame.x_axis, frame.y_axis].map(|d| d * self.radius);
        across.map(|d| [middle - d, middle + d]).to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{kernel::brep::primitive, output::drawing::View};

    #[test]
    fn a_cylinder_has_an_axis_or_a_cross() {
        let pin = primitive::cone(5.0, 5.0, 20.0, 32);
        let lines = |view| center_lines([pin.mesh()].into_iter(), &Camera::view(view));
        assert_eq!(lines(View::Front), [[DVec3::ZERO, DVec3::Z * 20.0]]);
        assert_eq!(lines(View::Top).len(), 2);
        let cuboid = primitive::cuboid(DVec3::ZERO, DVec3::ONE);
        assert!(center_lines([cuboid.mesh()].into_iter(), &Camera::view(View::Top)).is_empty());
    }
}
