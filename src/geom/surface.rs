//! The true surfaces that facets approximate.

use glam::DVec3;

use super::placement::Placement;

/// The surface a face was cut from, in the frame of the mesh that holds it, millimetres.
///
/// Faces keep it through every operation, so that drawings and shading can use the true curve in
/// place of the facets.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Surface {
    /// A plane: the facet is exact.
    Plane,
    /// A circular cylinder about the line through `point` along the unit vector `axis`.
    Cylinder {
        /// A point of the axis.
        point: DVec3,
        /// Unit direction of the axis.
        axis: DVec3,
        /// Radius.
        radius: f64,
    },
    /// A circular cone.
    Cone {
        /// Where the radius would be 0.
        apex: DVec3,
        /// Unit direction of the axis, from the apex into the cone.
        axis: DVec3,
        /// Growth of the radius for each millimetre along the axis.
        slope: f64,
    },
    /// A sphere.
    Sphere {
        /// Centre.
        center: DVec3,
        /// Radius.
        radius: f64,
    },
    /// A torus.
    Torus {
        /// Centre.
        center: DVec3,
        /// Unit direction of the axis.
        axis: DVec3,
        /// Radius of the circle of tube centres.
        major: f64,
        /// Radius of the tube.
        minor: f64,
    },
    /// A curved surface without a closed form here (a twisted extrusion, an imported mesh, a
    /// sphere that was scaled unevenly): the facets stand for themselves.
    Facets,
}

impl Surface {
    /// The surface after a placement. A map that is not a similarity turns round surfaces into
    /// [`Surface::Facets`]; planes stay planes.
    pub fn placed(&self, placement: &Placement) -> Surface {
        let Some(factor) = similarity(placement) else {
            return if *self == Surface::Plane { Surface::Plane } else { Surface::Facets };
        };
        let turn = |v: DVec3| placement.vector(v) / factor;
        match *self {
            Surface::Plane => Surface::Plane,
            Surface::Facets => Surface::Facets,
            Surface::Cylinder { point, axis, radius } => Surface::Cylinder {
                point: placement.point(point),
                axis: turn(axis),
                radius: radius * factor,
            },
            Surface::Cone { apex, axis, slope } => {
                Surface::Cone { apex: placement.point(apex), axis: turn(axis), slope }
            }
            Surface::Sphere { center, radius } => {
                Surface::Sphere { center: placement.point(center), radius: radius * factor }
            }
            Surface::Torus { center, axis, major, minor } => Surface::Torus {
                center: placement.point(center),
                axis: turn(axis),
                major: major * factor,
                minor: minor * factor,
            },
        }
    }
}

/// How far a linear map may be from a similarity, relative to its scale, and still carry round
/// surfaces: products of rotations stay within a few units of 1e-16, an intended distortion is
/// larger by many orders.
const SIMILARITY: f64 = 1e-9;

/// The scale factor of a similarity, `None` for other maps.
fn similarity(placement: &Placement) -> Option<f64> {
    let m = placement.linear();
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    let square = x.length_squared();
    let lengths = [y.length_squared(), z.length_squared()];
    let angles = [x.dot(y), y.dot(z), z.dot(x)];
    let near = lengths.iter().all(|l| (l - square).abs() <= SIMILARITY * square)
        && angles.iter().all(|a| a.abs() <= SIMILARITY * square);
    (near && square > 0.0).then(|| square.sqrt())
}
