//! The outlines of flat faces as their true curves: what hatching has to keep to, since drawn edges do.

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::{
    field::{Field, on_all},
    lattice::Plane,
    links::{each_side, links},
    model::CHORD,
    patches::faithful_origins,
};
use crate::geom::{FaceRef, PolyMesh, Tolerance};

/// A chord is halved at most so often.
const HALVINGS: u32 = 12;

/// The loops of the flat faces that are wanted, each face's in one list. Corners where round faces begin lie on the
/// true surfaces, and chords along round faces are as near to the true curve as those of a drawing: a quarter of
/// the tolerance. Never fails; where surfaces do not meet near a corner, the corner stays.
///
/// ```
/// use katachi::{geom::Tolerance, kernel::brep::primitive::cone, output::drawing::true_outlines};
/// let pin = cone(10.0, 10.0, 5.0, 32);
/// let flat = |normal: f64| normal > 0.5;
/// let top = true_outlines(pin.mesh(), |face| flat(face.area_vector().z), Tolerance::DEFAULT);
/// assert!(top[0][0].len() > 32 && top[0][0].iter().all(|p| (p.length() - 125f64.sqrt()).abs() < 1e-9));
/// ```
pub fn true_outlines(
    mesh: &PolyMesh,
    wanted: impl Fn(FaceRef) -> bool,
    tolerance: Tolerance,
) -> Vec<Vec<Vec<DVec3>>> {
    let mut beside: FxHashMap<(u32, u32), u32> = FxHashMap::default();
    each_side(mesh, |face, a, b| {
        beside.insert((a, b), face);
    });
    let round = faithful_origins(mesh, &links(mesh), tolerance);
    let border = Border { mesh, beside, round, bound: tolerance.mm() * CHORD };
    let faces = mesh.faces().filter(|face| wanted(*face));
    faces.map(|face| face.loops().map(|corners| border.refined(face, corners)).collect()).collect()
}

struct Border<'a> {
    mesh: &'a PolyMesh,
    /// The face of each directed side.
    beside: FxHashMap<(u32, u32), u32>,
    /// Which origins are round surfaces that their facets keep to.
    round: Vec<bool>,
    /// How far chords may be off, mm.
    bound: f64,
}

impl Border<'_> {
    /// A loop of a flat face with its curves.
    fn refined(&self, face: FaceRef, corners: &[u32]) -> Vec<DVec3> {
        let plane = self.flat(face);
        let count = corners.len();
        let side = |i: usize| [corners[i % count], corners[(i + 1) % count]];
        let across: Vec<Option<Field>> = (0..count).map(|i| self.across(side(i))).collect();
        let settled = |i: usize| {
            let fields: Vec<Field> =
                [across[(i + count - 1) % count], across[i]].into_iter().flatten().collect();
            self.settled(plane, &fields, self.mesh.points[corners[i] as usize])
        };
        let points: Vec<DVec3> = (0..count).map(settled).collect();
        let mut out = vec![];
        for (i, across) in across.iter().enumerate() {
            let ends = [points[i], points[(i + 1) % count]];
            out.push(ends[0]);
            if let Some(curved @ Field::Round(_)) = across {
                self.halve(&[plane, *curved], ends, HALVINGS, &mut out);
            }
        }
        out
    }

    fn flat(&self, face: FaceRef) -> Field {
        let normal = face.area_vector().normalize_or_zero();
        let on = self.mesh.points[face.outer()[0] as usize];
        Field::Flat(Plane { normal, offset: normal.dot(on) })
    }

    /// The surface on the other side of a side.
    fn across(&self, [a, b]: [u32; 2]) -> Option<Field> {
        let face = self.mesh.face(*self.beside.get(&(b, a))? as usize);
        let round = self.round[face.origin_index() as usize];
        Some(if round { Field::Round(face.origin().surface) } else { self.flat(face) })
    }

    /// A corner moved onto the surfaces that meet there, as the model of a drawing moves it.
    fn settled(&self, plane: Field, across: &[Field], corner: DVec3) -> DVec3 {
        if !across.iter().any(|field| matches!(field, Field::Round(_))) {
            return corner;
        }
        let mut fields = vec![plane];
        across.iter().for_each(|field| {
            if !fields.contains(field) {
                fields.push(*field);
            }
        });
        let moved = on_all(&fields, corner);
        if moved.distance(corner) <= FARTHEST * self.bound { moved } else { corner }
    }

    /// Appends points between two, so that chords keep to the bound.
    fn halve(&self, curve: &[Field; 2], [p, q]: [DVec3; 2], depth: u32, out: &mut Vec<DVec3>) {
        let middle = p.midpoint(q);
        let on = on_all(curve, middle);
        let off = on.distance(middle);
        if depth == 0 || off <= self.bound || off > p.distance(q) {
            return;
        }
        self.halve(curve, [p, on], depth - 1, out);
        out.push(on);
        self.halve(curve, [on, q], depth - 1, out);
    }
}

/// Corners are moved by so many bounds at most.
pub const FARTHEST: f64 = 32.0;
