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
    /// A smooth surface without a closed form here (a sphere that was scaled unevenly, the rounded rim of an
    /// uneven face): its facets stand for themselves, but where two of them meet is no edge.
    Smooth,
    /// Any other surface (an imported mesh, a twisted extrusion): the facets stand for themselves, and whether there is
    /// an edge between them their angle tells.
    Facets,
}

impl Surface {
    /// Signed distance from a point to the surface, mm, and the unit normal there, outwards: away from the axis or
    /// the centre. 0 and +z for a plane and for facets, which do not know where they are.
    ///
    /// ```
    /// use glam::DVec3;
    /// use katachi::geom::Surface;
    /// let ball = Surface::Sphere { center: DVec3::ZERO, radius: 2.0 };
    /// assert_eq!(ball.slope(DVec3::X * 5.0), (3.0, DVec3::X));
    /// ```
    pub fn slope(&self, p: DVec3) -> (f64, DVec3) {
        match *self {
            Surface::Cylinder { point, axis, radius } => {
                let (_, r, out) = around_axis(p - point, axis);
                (r - radius, out)
            }
            Surface::Cone { apex, axis, slope } => {
                let (h, r, out) = around_axis(p - apex, axis);
                let secant = (1.0 + slope * slope).sqrt();
                ((r - slope * h) / secant, (out - axis * slope) / secant)
            }
            Surface::Sphere { center, radius } => {
                let v = p - center;
                let r = v.length();
                (r - radius, if r > 0.0 { v / r } else { DVec3::Z })
            }
            Surface::Torus { center, axis, major, minor } => {
                let (h, r, out) = around_axis(p - center, axis);
                let tube = out * (r - major) + axis * h;
                let q = tube.length();
                (q - minor, if q > 0.0 { tube / q } else { out })
            }
            Surface::Plane | Surface::Smooth | Surface::Facets => (0.0, DVec3::Z),
        }
    }

    /// The surface after a placement. A map that is not a similarity turns round surfaces into
    /// [`Surface::Smooth`]; planes stay planes.
    pub fn placed(&self, placement: &Placement) -> Surface {
        let Some(factor) = similarity(placement) else {
            return match self {
                Surface::Plane | Surface::Facets => *self,
                _ => Surface::Smooth,
            };
        };
        let turn = |v: DVec3| placement.vector(v) / factor;
        match *self {
            Surface::Plane | Surface::Smooth | Surface::Facets => *self,
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

impl Surface {
    /// Whether another surface is the same one up to rounding. A cylinder is known by its axis and
    /// radius, wherever on the axis its point is given and whichever way the axis runs. Planes are alike,
    /// and so are facets: they stand for themselves. Of a smooth surface without a form nothing is known.
    ///
    /// ```
    /// use glam::DVec3;
    /// use katachi::geom::Surface;
    /// let rod = |z: f64| Surface::Cylinder { point: DVec3::Z * z, axis: DVec3::Z, radius: 2.0 };
    /// assert!(rod(0.0).is_same(&rod(5.0)));
    /// ```
    pub fn is_same(&self, other: &Surface) -> bool {
        use Surface::{Cone, Cylinder, Facets, Plane, Sphere, Torus};
        let near = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(b.abs());
        let along = |a: DVec3, b: DVec3| (a - b).abs().max_element() <= SAME;
        let across = |a: DVec3, b: DVec3| along(a, b) || along(a, -b);
        let alike = match (*self, *other) {
            (Plane, Plane) | (Facets, Facets) => return true,
            (Cylinder { axis: a, radius: r, .. }, Cylinder { axis: b, radius: s, .. }) => {
                near(r, s) && across(a, b)
            }
            (Cone { axis: a, slope: r, .. }, Cone { axis: b, slope: s, .. }) => {
                near(r, s) && along(a, b)
            }
            (Sphere { radius: r, .. }, Sphere { radius: s, .. }) => near(r, s),
            (
                Torus { axis: a, major: q, minor: r, .. },
                Torus { axis: b, major: s, minor: t, .. },
            ) => near(q, s) && near(r, t) && across(a, b),
            _ => false,
        };
        let ((p, size), (q, _)) = (self.anchor(), other.anchor());
        alike && (p - q).length() <= SAME * (size + p.length())
    }

    /// A point that equal surfaces have in common, and a length to measure its place by, mm. Of planes and
    /// facets nothing is known.
    pub fn anchor(&self) -> (DVec3, f64) {
        match *self {
            Surface::Plane | Surface::Smooth | Surface::Facets => (DVec3::ZERO, 1.0),
            Surface::Cylinder { point, axis, radius } => (point - axis * axis.dot(point), radius),
            Surface::Cone { apex, .. } => (apex, 1.0),
            Surface::Sphere { center, radius } => (center, radius),
            Surface::Torus { center, major, .. } => (center, major),
        }
    }
}

/// How far the measures of one surface may be apart, relative to their size, when it was placed in two ways:
/// rounding stays within a few units of 1e-16 of coordinates, an intended difference is larger by many orders.
const SAME: f64 = 1e-12;

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

/// A vector as its part along an axis, the length of its part across, and the direction of that; any direction
/// across where there is none.
pub fn around_axis(v: DVec3, axis: DVec3) -> (f64, f64, DVec3) {
    let height = v.dot(axis);
    let across = v - axis * height;
    let radius = across.length();
    let outwards = if radius > 0.0 { across / radius } else { axis.any_orthonormal_vector() };
    (height, radius, outwards)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_are_known_by_what_they_are() {
        let rod =
            |point: DVec3, axis: DVec3, radius: f64| Surface::Cylinder { point, axis, radius };
        let here = rod(DVec3::new(1.0, 2.0, 3.0), DVec3::Z, 2.0);
        assert!(here.is_same(&rod(DVec3::new(1.0, 2.0, -70.0), DVec3::NEG_Z, 2.0)));
        assert!(!here.is_same(&rod(DVec3::new(1.0, 2.1, 3.0), DVec3::Z, 2.0)));
        assert!(!here.is_same(&rod(DVec3::new(1.0, 2.0, 3.0), DVec3::X, 2.0)));
        assert!(!here.is_same(&rod(DVec3::new(1.0, 2.0, 3.0), DVec3::Z, 2.1)));
        let ball = |x: f64| Surface::Sphere { center: DVec3::X * x, radius: 2.0 };
        assert!(ball(1.0).is_same(&ball(1.0)) && !ball(1.0).is_same(&ball(1.1)));
        let cone = |axis: DVec3| Surface::Cone { apex: DVec3::ONE, axis, slope: 0.5 };
        assert!(
            cone(DVec3::Z).is_same(&cone(DVec3::Z)) && !cone(DVec3::Z).is_same(&cone(-DVec3::Z))
        );
        assert!(!Surface::Plane.is_same(&Surface::Facets));
        assert!(!Surface::Smooth.is_same(&Surface::Smooth));
    }
}
