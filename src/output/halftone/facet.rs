//! The faces of a scene as light and eye see them.

use glam::DVec3;
use rustc_hash::FxHashMap;

use crate::{
    geom::{FaceRef, PolyMesh, Surface, mesh::Color, triangulate::triangulate_face, trig},
    output::drawing::Body,
};

/// Faces of a surface without a closed form that meet at less than so many degrees are shaded smoothly.
const CREASE: f64 = 30.0;

/// A flat face.
#[derive(Clone, Debug)]
pub(super) struct Facet {
    /// Its body's place in the scene and its face's in the mesh; the largest numbers for the ground.
    pub face: (u32, u32),
    /// Its outline and holes, counter-clockwise seen from outside.
    pub loops: Vec<Vec<DVec3>>,
    /// Unit normal, outwards.
    pub normal: DVec3,
    /// How its normals run.
    pub bend: Bend,
    /// Its own colour, red, green and blue from 0 to 1.
    pub color: [f64; 3],
    /// Whether it is seen and takes light from both sides: it is no boundary of a solid.
    pub open: bool,
}

/// Normals over a facet.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bend {
    /// The facet's own everywhere.
    Flat,
    /// Those of a true surface, turned over if they run against the facet's.
    Surface { surface: Surface, flipped: bool },
    /// Of a triangle, those at its corners and between them.
    Corners { at: [DVec3; 3], normals: [DVec3; 3] },
}

impl Facet {
    /// Shadows on the ground: a white face that looks up.
    pub fn ground(loops: Vec<Vec<DVec3>>) -> Facet {
        Facet {
            face: (u32::MAX, u32::MAX),
            loops,
            normal: DVec3::Z,
            bend: Bend::Flat,
            color: [1.0; 3],
            open: false,
        }
    }

    /// Unit normal at a point of it.
    pub fn normal_at(&self, p: DVec3) -> DVec3 {
        match &self.bend {
            Bend::Flat => self.normal,
            Bend::Surface { surface, flipped } => {
                let normal = surface.slope(p).1;
                if *flipped { -normal } else { normal }
            }
            Bend::Corners { at: [a, b, c], normals } => {
                let weight = |q: DVec3, r: DVec3| (q - p).cross(r - p).dot(self.normal);
                let weights = [weight(*b, *c), weight(*c, *a), weight(*a, *b)];
                let sum: DVec3 = normals.iter().zip(weights).map(|(n, w)| *n * w.max(0.0)).sum();
                sum.try_normalize().unwrap_or(self.normal)
            }
        }
    }
}

/// The faces of bodies; those without an area are left out.
pub(super) fn facets(bodies: &[Body]) -> Vec<Facet> {
    (0u32..).zip(bodies).flat_map(|(number, body)| of_body(number, body)).collect()
}

fn of_body(number: u32, body: &Body) -> Vec<Facet> {
    let mesh = body.mesh;
    let open = is_open(mesh);
    let normals = Normals::of(mesh);
    let mut facets = vec![];
    for face in mesh.faces() {
        let Some(normal) = face.area_vector().try_normalize() else { continue };
        let color = color(face.origin().color);
        let place = |corners: &[u32]| corners.iter().map(|&c| mesh.points[c as usize]).collect();
        let number = (number, face.index() as u32);
        let facet = |loops, bend| Facet { face: number, loops, normal, bend, color, open };
        match face.origin().surface {
            Surface::Smooth | Surface::Facets => {
                facets.extend(triangles(mesh, face).into_iter().filter_map(|triangle| {
                    let at = triangle.map(|c| mesh.points[c as usize]);
                    let normal = (at[1] - at[0]).cross(at[2] - at[0]).try_normalize()?;
                    let normals = triangle.map(|corner| normals.at(corner, face.index(), normal));
                    let bend = Bend::Corners { at, normals };
                    Some(Facet {
                        face: number,
                        loops: vec![at.to_vec()],
                        normal,
                        bend,
                        color,
                        open,
                    })
                }))
            }
            Surface::Plane => facets.push(facet(face.loops().map(place).collect(), Bend::Flat)),
            surface => {
                let inside = mesh.points[face.outer()[0] as usize];
                let flipped = surface.slope(inside).1.dot(normal) < 0.0;
                let bend = Bend::Surface { surface, flipped };
                facets.push(facet(face.loops().map(place).collect(), bend));
            }
        }
    }
    facets
}

/// What a white face or a coloured one is, without light.
fn color(color: Option<Color>) -> [f64; 3] {
    color.map_or([1.0; 3], |c| [c.r, c.g, c.b].map(|part| f64::from(part) / 255.0))
}

fn triangles(mesh: &PolyMesh, face: FaceRef<'_>) -> Vec<[u32; 3]> {
    let loops: Vec<&[u32]> = face.loops().collect();
    let mut triangles = vec![];
    triangulate_face(&mesh.points, &loops, &mut triangles);
    triangles
}

/// Whether a mesh has an edge with a face on one side only.
fn is_open(mesh: &PolyMesh) -> bool {
    let mut edges: FxHashMap<(u32, u32), i32> = FxHashMap::default();
    for corners in mesh.faces().flat_map(|face| face.loops()) {
        let next = corners.iter().cycle().skip(1);
        for (&a, &b) in corners.iter().zip(next) {
            *edges.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
        }
    }
    edges.values().any(|&count| count != 0)
}

/// Whether facets stand for a surface themselves.
fn is_rough(surface: Surface) -> bool {
    matches!(surface, Surface::Smooth | Surface::Facets)
}

/// The directions of the faces around each corner, for faces of surfaces without a closed form.
struct Normals {
    /// Of every face: its area times its normal, twice.
    areas: Vec<DVec3>,
    /// The faces around each corner.
    around: FxHashMap<u32, Vec<u32>>,
}

impl Normals {
    fn of(mesh: &PolyMesh) -> Normals {
        let mut around: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
        let areas = mesh.faces().map(|face| face.area_vector()).collect();
        for face in mesh.faces().filter(|f| is_rough(f.origin().surface)) {
            for &corner in face.loops().flatten() {
                around.entry(corner).or_default().push(face.index() as u32);
            }
        }
        Normals { areas, around }
    }

    /// The mean direction at a corner of the faces that meet a face there smoothly.
    fn at(&self, corner: u32, face: usize, normal: DVec3) -> DVec3 {
        let own = self.areas[face].try_normalize().unwrap_or(normal);
        let least = trig::cos_deg(CREASE);
        let near = self.around.get(&corner).into_iter().flatten();
        let near = near.map(|&face| self.areas[face as usize]);
        let sum: DVec3 = near.filter(|area| area.dot(own) >= least * area.length()).sum();
        sum.try_normalize().unwrap_or(normal)
    }
}
