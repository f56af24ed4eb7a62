//! One face as a point sees it.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::{ON_PLANE, excess, is_on, spherical_triangle, triangle_area};
use crate::geom::{
    mesh::{FaceRef, PolyMesh},
    triangulate::triangulate_face,
};

/// Areas this near to 2 pi take their sign from the side of the face, and turns this near to pi have none:
/// far above the rounding of a sum of angles, far below what a point off the plane can be mistaken by.
const NEAR_HALF: f64 = 1e-6;

/// Edges below this share of the largest coordinate are as long as the lattice step of a set operation
/// (2^-26 of it, some digits lost on the way through nested frames): their direction is rounding.
const SHORT: f64 = 1e-6;

/// The polygon form is trusted where the face is this many times less bent than it is away from the point
/// and than its edges are long.
const FLAT: f64 = 1e3;

/// A face and a point.
pub(super) struct View<'a> {
    mesh: &'a PolyMesh,
    face: FaceRef<'a>,
    q: DVec3,
    /// Height of the plane over the point, positive when the point sees the back.
    height: f64,
    /// Heights that are rounding.
    rounding: f64,
}

impl<'a> View<'a> {
    pub(super) fn new(mesh: &'a PolyMesh, face: FaceRef<'a>, q: DVec3) -> View<'a> {
        let base = mesh.points[face.outer()[0] as usize];
        let height = (base - q).dot(face.area_vector().normalize_or_zero());
        let rounding = ON_PLANE * base.abs().max(q.abs()).max_element();
        View { mesh, face, q, height, rounding }
    }

    /// The sign of the side that the point is on; 0 on the plane within rounding.
    fn side(&self) -> f64 {
        if self.height.abs() <= self.rounding { 0.0 } else { self.height.signum() }
    }

    /// Whether the point lies on the face within rounding.
    pub(super) fn touches(&self) -> bool {
        let near = self.height.abs() <= self.rounding + self.bend();
        near && self.triangles().any(|t| is_on(t, self.q))
    }

    /// The signed area of the face on the unit sphere about the point.
    pub(super) fn area(&self) -> f64 {
        if let [a, b, c] = self.face.outer()
            && self.face.loops().len() == 1
        {
            let seen = [a, b, c].map(|&i| self.mesh.points[i as usize] - self.q);
            return if self.side() == 0.0 { 0.0 } else { spherical_triangle(seen) };
        }
        if self.is_hazardous() {
            return self.area_of_triangles();
        }
        if self.side() == 0.0 { 0.0 } else { self.area_of_polygon() }
    }

    /// The paper's sum; that of the triangles where a turn is too near to half a circle to have a sign.
    fn area_of_polygon(&self) -> f64 {
        let mut corners = vec![];
        let mut sum = 0.0;
        for (i, indices) in self.face.loops().enumerate() {
            corners.clear();
            corners.extend(indices.iter().map(|&c| self.mesh.points[c as usize] - self.q));
            let (area, sharpest) = excess(&corners);
            if sharpest > PI - NEAR_HALF {
                return self.area_of_triangles();
            }
            let sign = if i == 0 { self.side() } else { -self.side() };
            sum += if area.abs() > TAU - NEAR_HALF { sign * area.abs() } else { area };
        }
        sum
    }

    fn area_of_triangles(&self) -> f64 {
        self.triangles().map(|t| triangle_area(t, self.q)).sum()
    }

    fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> {
        let loops: Vec<&[u32]> = self.face.loops().collect();
        let mut triangles = vec![];
        triangulate_face(&self.mesh.points, &loops, &mut triangles);
        triangles.into_iter().map(|t| t.map(|c| self.mesh.points[c as usize]))
    }

    /// How far a corner is from the plane.
    fn bend(&self) -> f64 {
        if self.face.loops().len() == 1 && self.face.outer().len() == 3 {
            return 0.0;
        }
        let base = self.mesh.points[self.face.outer()[0] as usize];
        let normal = self.face.area_vector().normalize_or_zero();
        self.corners().map(|p| (p - base).dot(normal).abs()).fold(0.0, f64::max)
    }

    /// Whether rounding decides how the face looks from the point: it has edges without direction, or is
    /// bent by as much as its plane is away.
    fn is_hazardous(&self) -> bool {
        let bend = (self.bend() - self.rounding).max(0.0);
        if FLAT * bend > self.height.abs() {
            return true;
        }
        let reach = self.corners().fold(DVec3::ZERO, |m, p| m.max(p.abs())).max_element();
        let least = (SHORT * reach).max(FLAT * bend);
        self.face.loops().any(|indices| {
            let at = |i: u32| self.mesh.points[i as usize];
            let ends = indices.iter().zip(indices.iter().cycle().skip(1));
            ends.into_iter().any(|(&a, &b)| at(a).distance_squared(at(b)) < least * least)
        })
    }

    fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.face.loops().flatten().map(|&c| self.mesh.points[c as usize])
    }
}
