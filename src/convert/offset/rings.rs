//! Who is next to whom: the corners around each point of a closed mesh, and how its edges bend.

use glam::DVec3;
use rustc_hash::FxHashMap;

use crate::geom::{PolyMesh, Surface};

/// Directions closer than this, as a sine, are one: faces of one plane differ by rounding alone.
const SAME: f64 = 1e-10;

/// A corner of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub face: u32,
    /// The point it is at, and those before and after it along the face.
    pub point: u32,
    pub before: u32,
    pub after: u32,
}

/// How two faces meet at an edge.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Bend {
    /// In one plane.
    Flat,
    /// The solid has less than half of the space around the edge.
    Convex,
    /// More than half.
    Concave,
}

/// A facet leans away from the surface that it stands for by less than this cosine, or does not stand for it.
const STANDS: f64 = 0.7;

/// The normal of a surface at a point of a facet of it.
fn normal_of(surface: Surface, p: DVec3, facet: DVec3) -> DVec3 {
    let out = match surface {
        Surface::Sphere { center, .. } => p - center,
        Surface::Cylinder { point, axis, .. } => (p - point).reject_from_normalized(axis),
        _ => return facet,
    };
    let normal = out.normalize_or_zero();
    match normal.dot(facet) {
        lean if lean > STANDS => normal,
        lean if lean < -STANDS => -normal,
        _ => facet,
    }
}

/// The corners of a closed mesh, by number in the order of its loops.
pub(super) struct Rings {
    pub corners: Vec<Corner>,
    /// Unit normals of the faces.
    pub normals: Vec<DVec3>,
    /// Unit normals of the surface at the corners.
    at: Vec<DVec3>,
    /// Corners around each point, counter-clockwise from outside; between a corner and the next runs the
    /// edge to the point before the former.
    pub around: Vec<Vec<u32>>,
    /// The corner at the end of each directed edge.
    ends: FxHashMap<(u32, u32), u32>,
}

impl Rings {
    /// The corners of a mesh that is closed by index. Normals at corners are those of the faces, or where
    /// `curved` those of the spheres and cylinders that the faces stand for.
    pub fn of(mesh: &PolyMesh, curved: bool) -> Rings {
        let mut corners = vec![];
        for face in mesh.faces() {
            for ring in face.loops() {
                let n = ring.len();
                corners.extend((0..n).map(|i| Corner {
                    face: face.index() as u32,
                    point: ring[i],
                    before: ring[(i + n - 1) % n],
                    after: ring[(i + 1) % n],
                }));
            }
        }
        let normals: Vec<DVec3> =
            mesh.faces().map(|f| f.area_vector().normalize_or_zero()).collect();
        let at = corners.iter().map(|corner: &Corner| {
            let facet = normals[corner.face as usize];
            let surface = mesh.face(corner.face as usize).origin().surface;
            if curved {
                normal_of(surface, mesh.points[corner.point as usize], facet)
            } else {
                facet
            }
        });
        let at = at.collect();
        let ends = corners.iter().zip(0..).map(|(c, i)| ((c.before, c.point), i)).collect();
        let mut rings = Rings { corners, normals, at, around: vec![], ends };
        rings.around = rings.fans(mesh.points.len());
        rings
    }

    fn fans(&self, points: usize) -> Vec<Vec<u32>> {
        let starts = self.corners.iter().zip(0..).map(|(c, i)| ((c.point, c.after), i));
        let starts: FxHashMap<(u32, u32), u32> = starts.collect();
        let mut fans = vec![vec![]; points];
        for (corner, first) in self.corners.iter().zip(0..) {
            let fan: &mut Vec<u32> = &mut fans[corner.point as usize];
            if !fan.is_empty() {
                continue;
            }
            let mut next = first;
            while fan.is_empty() || next != first {
                fan.push(next);
                next = starts[&(corner.point, self.corners[next as usize].before)];
            }
        }
        fans
    }

    /// The corner at the end of the edge from one point to another.
    pub fn end(&self, from: u32, to: u32) -> u32 {
        self.ends[&(from, to)]
    }

    /// The normal at a corner.
    pub fn normal(&self, corner: u32) -> DVec3 {
        self.at[corner as usize]
    }

    /// How the faces of a corner and of the next around a point meet, the edge between them running along
    /// a direction away from the point.
    pub fn bend(&self, corner: u32, next: u32, along: DVec3) -> Bend {
        let (here, there) = (self.normal(corner), self.normal(next));
        let turn = there.cross(here);
        match turn.dot(along) {
            _ if turn.length() <= SAME && here.dot(there) > 0.0 => Bend::Flat,
            side if side > 0.0 => Bend::Convex,
            _ => Bend::Concave,
        }
    }
}
