//! The planes that figures lie in.
//!
//! A realised figure is a region in the coordinates of its plane and a *frame*: a rigid motion that
//! takes the xy plane to the figure's plane, +z to its normal. Motions within the xy plane act on the
//! region; the frame stays the identity there, so that set algebra and `revolve` see the coordinates
//! that the modeller sees.

use glam::{DAffine2, DMat2, DMat3, DVec3};

use crate::geom::Placement;

/// How far a map may be from a rigid motion, or two unit normals from each other, and still count as
/// such: products of rotations stay within a few units of 1e-16, an intended tilt is larger by many
/// orders.
const RIGID: f64 = 1e-9;

/// How far apart in mm two planes may be and still be one: rounding of a kilometre is 1e-13 km.
const COPLANAR: f64 = 1e-9;

/// Splits a map of space, applied to the xy plane, into a map within the plane and a frame: the
/// frame's image of the mapped plane is the map's image of the plane. `None` if the map flattens
/// space.
pub fn split(map: &Placement) -> Option<(DAffine2, Placement)> {
    let m = map.linear();
    let normal = m.x_axis.cross(m.y_axis);
    if normal == DVec3::ZERO || !normal.is_finite() || m.determinant() == 0.0 {
        return None;
    }
    if m.x_axis.z == 0.0 && m.y_axis.z == 0.0 && m.z_axis.z > 0.0 {
        return Some((flat(map), Placement::translation(map.offset() * DVec3::Z)));
    }
    if is_rigid(m) {
        return Some((DAffine2::IDENTITY, *map));
    }
    let normal = normal.normalize() * m.z_axis.dot(normal).signum();
    let across = m.x_axis.normalize();
    let up = normal.cross(across);
    let within = DMat2::from_cols(
        glam::dvec2(m.x_axis.length(), 0.0),
        glam::dvec2(m.y_axis.dot(across), m.y_axis.dot(up)),
    );
    let frame = Placement::new(DMat3::from_cols(across, up, normal), map.offset());
    Some((DAffine2::from_mat2(within), frame))
}

/// The map from the coordinates of frame `from` to those of frame `to` if both are of one plane.
pub fn between(from: &Placement, to: &Placement) -> Option<DAffine2> {
    let relative = to.inverse()?.after(from);
    let m = if from.linear() == to.linear() { DMat3::IDENTITY } else { relative.linear() };
    let tilt = m.x_axis.z.abs().max(m.y_axis.z.abs());
    let one = tilt <= RIGID && relative.offset().z.abs() <= COPLANAR;
    one.then(|| flat(&Placement::new(m, relative.offset())))
}

/// The part of a map that acts within xy.
fn flat(map: &Placement) -> DAffine2 {
    let m = map.linear();
    let linear = DMat2::from_cols(m.x_axis.truncate(), m.y_axis.truncate());
    DAffine2::from_mat2_translation(linear, map.offset().truncate())
}

fn is_rigid(m: DMat3) -> bool {
    let product = m.transpose() * m;
    m.determinant() > 0.0 && product.abs_diff_eq(DMat3::IDENTITY, RIGID)
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    /// A quarter turn about x: y becomes z.
    const UPRIGHT: DMat3 = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y);

    #[test]
    fn motions_within_xy_act_on_the_region() {
        let map = Placement::new(DMat3::from_diagonal(DVec3::new(-2.0, 3.0, 1.0)), DVec3::ONE);
        let (within, frame) = split(&map).expect("not flat");
        assert_eq!(within.transform_point2(dvec2(1.0, 1.0)), dvec2(-1.0, 4.0));
        assert_eq!(frame, Placement::translation(DVec3::Z));
    }

    #[test]
    fn a_rigid_motion_out_of_xy_is_the_frame() {
        let map = Placement::new(UPRIGHT, DVec3::ONE);
        assert_eq!(split(&map), Some((DAffine2::IDENTITY, map)));
    }

    #[test]
    fn any_other_map_is_split() {
        let stretch = DMat3::from_diagonal(DVec3::new(2.0, -3.0, 4.0));
        let map = Placement::new(UPRIGHT * stretch, DVec3::X);
        let (within, frame) = split(&map).expect("not flat");
        let p = dvec2(5.0, 7.0);
        let image = frame.point(within.transform_point2(p).extend(0.0));
        assert!(image.distance(map.point(p.extend(0.0))) < 1e-12);
        assert!(frame.vector(DVec3::Z).dot(map.vector(DVec3::Z)) > 0.0);
        assert_eq!(split(&Placement::new(DMat3::ZERO, DVec3::ZERO)), None);
    }

    #[test]
    fn frames_of_one_plane_are_seen() {
        let a = Placement::new(UPRIGHT, DVec3::ZERO);
        let b = Placement::new(UPRIGHT, DVec3::new(3.0, 0.0, 4.0));
        let map = between(&b, &a).expect("both are y = 0");
        assert_eq!(map.transform_point2(dvec2(0.0, 0.0)), dvec2(3.0, 4.0));
        assert_eq!(between(&a, &Placement::new(UPRIGHT, DVec3::Y)), None);
        assert_eq!(between(&a, &Placement::IDENTITY), None);
    }
}
