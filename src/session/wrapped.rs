//! Figures laid on round faces: cut at the sides of facets, each part in its facet, so that no face hides what lies in it,
//! and drawn where it is on the face itself.

use glam::{DVec2, DVec3};

use super::outline::Outline;
use crate::geom::{FaceRef, Placement, PolyMesh, Surface, development::Development};

/// Parts that are no farther apart than this part of their coordinates go on into each other.
const JOINED: f64 = 1e-9;

/// Facets that reach farther around a sphere than this part of the way to the other side are laid out too wide to tell
/// what is on them.
const REACH: f64 = 0.9;

/// The facets of a round face, laid flat.
pub struct Wrapped<'a> {
    sheet: &'a Development,
    /// From the frame of the sheet to that of the mesh.
    onto: Placement,
    tiles: Vec<Tile>,
}

/// A facet.
struct Tile {
    /// Its sides on the sheet.
    sides: Vec<[DVec2; 2]>,
    min: DVec2,
    max: DVec2,
    /// Its plane.
    normal: DVec3,
    on: DVec3,
}

/// A part of a segment on one facet.
struct Part {
    from: f64,
    ends: [Laid; 2],
}

/// A point on its facet and on the surface that this stands for.
type Laid = [DVec3; 2];

/// A line in space twice: on facets and on their surface.
pub type Course = (Vec<DVec3>, Vec<DVec3>);

/// A part on one facet is drawn by so many chords: each time the number is doubled they are four times nearer to the
/// surface.
const CHORDS: u32 = 4;

impl<'a> Wrapped<'a> {
    /// The facets of a mesh that lie on a surface after a placement. `None` where the placement stretches it.
    pub fn new(
        sheet: &'a Development,
        surface: Surface,
        onto: Placement,
        mesh: &PolyMesh,
    ) -> Option<Wrapped<'a>> {
        let (back, placed) = (onto.inverse()?, surface.placed(&onto));
        if placed == Surface::Smooth {
            return None;
        }
        let faces = mesh.faces().filter(|face| face.origin().surface.is_same(&placed));
        let tiles = faces.filter_map(|face| Tile::new(sheet, &back, mesh, face)).collect();
        Some(Wrapped { sheet, onto, tiles })
    }

    /// The parts of a line of the xy plane that are on the face, laid on it.
    pub fn parts(&self, line: &Outline) -> Vec<Course> {
        let mut out: Vec<Course> = vec![];
        for ends in line.points.windows(2) {
            let [p, q] = [ends[0].truncate(), ends[1].truncate()];
            let mut parts: Vec<Part> =
                self.tiles.iter().flat_map(|tile| tile.parts(self.sheet, [p, q])).collect();
            parts.sort_by(|a, b| a.from.total_cmp(&b.from));
            for Part { ends: [from, to], .. } in parts {
                let [from, to] = [from, to].map(|laid| laid.map(|p| self.onto.point(p)));
                let size = from[0].abs().max_element().max(1.0);
                match out.last_mut() {
                    Some(last) if last.0[last.0.len() - 1].distance(from[0]) <= JOINED * size => {
                        last.0.push(to[0]);
                        last.1.push(to[1]);
                    }
                    _ => out.push((vec![from[0], to[0]], vec![from[1], to[1]])),
                }
            }
        }
        out
    }
}

impl Tile {
    fn new(sheet: &Development, back: &Placement, mesh: &PolyMesh, face: FaceRef) -> Option<Tile> {
        let at = |corner: u32| back.point(mesh.points[corner as usize]);
        let first = at(face.outer()[0]);
        let mut sides = vec![];
        for corners in face.loops() {
            let places: Vec<DVec2> = corners.iter().map(|&c| sheet.unroll(at(c), first)).collect();
            let before = places.iter().cycle().skip(places.len() - 1);
            sides.extend(before.zip(&places).map(|(a, b)| [*a, *b]));
        }
        let corners = || sides.iter().flatten();
        let far = corners().fold(0.0, |far: f64, p| far.max(p.length()));
        let min = corners().fold(DVec2::MAX, |min, p| min.min(*p));
        let max = corners().fold(DVec2::MIN, |max, p| max.max(*p));
        let outer: Vec<DVec3> = face.outer().iter().map(|&c| at(c)).collect();
        let next = outer.iter().cycle().skip(1);
        let area: DVec3 = outer.iter().zip(next).map(|(p, q)| (*p - first).cross(*q - first)).sum();
        let normal = area.try_normalize()?;
        (far <= REACH * sheet.reach()).then_some(Tile { sides, min, max, normal, on: first })
    }

    /// The parts of a segment on the facet, laid on it.
    fn parts(&self, sheet: &Development, [p, q]: [DVec2; 2]) -> Vec<Part> {
        if (p.min(q).cmpgt(self.max) | self.min.cmpgt(p.max(q))).any() {
            return vec![];
        }
        let along = q - p;
        let crossing = |&[a, b]: &[DVec2; 2]| {
            let (s, t) = (along.perp_dot(a - p), along.perp_dot(b - p));
            let at = a.lerp(b, s / (s - t)) - p;
            ((s > 0.0) != (t > 0.0)).then(|| at.dot(along) / along.length_squared())
        };
        let mut cuts: Vec<f64> = self.sides.iter().filter_map(crossing).collect();
        cuts.sort_by(f64::total_cmp);
        let within = cuts.chunks_exact(2).map(|pair| [pair[0].max(0.0), pair[1].min(1.0)]);
        within
            .filter(|[from, to]| from < to)
            .flat_map(|[from, to]| {
                let at = move |i: u32| from + (to - from) * f64::from(i) / f64::from(CHORDS);
                (0..CHORDS).map(move |i| {
                    let ends = [i, i + 1].map(|k| self.lay(sheet, p.lerp(q, at(k))));
                    Part { from: at(i), ends }
                })
            })
            .collect()
    }

    /// A point of the sheet on the facet and on the surface.
    fn lay(&self, sheet: &Development, p: DVec2) -> Laid {
        let p = sheet.lay(p);
        let normal = sheet.normal(p);
        let facet = p - normal * ((p - self.on).dot(self.normal) / normal.dot(self.normal));
        [facet, p]
    }
}
