//! Bodies with round faces: contours of the true surfaces, and edges as their true curves.
//!
//! Points of the mesh are moved onto the surfaces that meet there. Where a surface turns away from the eye is
//! known at every corner of its facets; between a corner in front and one behind, Newton's method finds the
//! point of the contour, and in a facet the contour runs from where it leaves the front to where it comes back.
//! So it is cut off at the borders of the face by itself. Chords are halved until they keep to the bound;
//! what hides is the front part of each facet.

mod contour;
mod course;

use std::collections::BTreeMap;

use glam::DVec3;

use course::Tip;

use super::{
    cells::around,
    field::{Constraint, Curve, Field, on_all},
    frustum::Visible,
    lattice::Plane,
    links::{Link, NONE, each_side},
    mesh_contour::{add_contours, bent_faces, loose_faces, steady_normals},
    model::{CHORD, Edge, FOLDED, Facet, Model, Outline},
    outline::FARTHEST,
    patches::{Patch, Patches},
    scene::Kind,
};
use crate::geom::{FaceRef, PolyMesh, Surface};

/// Faces meet smoothly where the sine of the angle between them is below this.
const TANGENT: f64 = 1e-4;

/// A chord is halved at most so often.
const HALVINGS: u32 = 12;

/// Where a contour passes the side of a face.
#[derive(Clone, Copy, Debug)]
struct Pass {
    face: u32,
    at: u32,
    /// Whether the walk around the face leaves the front part here.
    out: bool,
}

struct Smooth<'a> {
    model: &'a mut Model,
    body: &'a Visible<'a>,
    mesh: &'a PolyMesh,
    base: u32,
    id: u32,
    /// Cosine of the angle from which on facets without a closed form meet in an edge.
    crease: f64,
    patches: Patches,
    /// Whether each flat face is in front.
    front: Vec<bool>,
    /// How far the last patch asked for is turned to the eye at each point of the mesh.
    turns: Vec<(u32, f64)>,
    /// The place of each patch's surface in the model.
    fields: Vec<u32>,
    /// Normals of faces, without those of narrow facets; empty where all are flat or round.
    steady: Vec<DVec3>,
    /// Whether faces are known by their facets alone; empty where none are.
    bent: Vec<bool>,
    /// The same with those that go on smoothly into them.
    loose: Vec<bool>,
    /// Whether the edge at hand is within a surface whose contour is traced by its facets.
    within: bool,
    /// Sides of the front part of faces.
    parts: Vec<(u32, [u32; 2])>,
    passes: Vec<Pass>,
    /// Sides of faces at the apex of their cone.
    tips: Vec<Tip>,
    /// Numbers of curves, by their patches.
    curves: BTreeMap<(u32, u32), u32>,
    /// The face of each outline added, from the first one on.
    outline_faces: Vec<u32>,
}

/// Adds a body if it has round faces; false if all its facets stand for themselves, as those of an open surface do.
pub fn add_body(
    model: &mut Model,
    body: &Visible,
    base: u32,
    (links, round): (&[Link], &[bool]),
) -> bool {
    let mesh = &*body.mesh;
    let open = || links.iter().any(|l| l.right == NONE && !body.is_cut(l.a, l.b));
    if !round.contains(&true) || open() {
        return false;
    }
    let mut smooth = Smooth {
        model,
        body,
        mesh,
        base,
        id: body.id,
        crease: body.crease,
        patches: Patches::new(mesh, round),
        front: vec![],
        turns: vec![(NONE, 0.0); mesh.points.len()],
        fields: vec![],
        steady: vec![],
        bent: vec![],
        loose: vec![],
        within: false,
        parts: vec![],
        passes: vec![],
        tips: vec![],
        curves: BTreeMap::new(),
        outline_faces: vec![],
    };
    smooth.settle_points();
    smooth.find_front();
    let first = smooth.model.outlines.len();
    let inner = smooth.trace_bent(links);
    for (link, inner) in links.iter().zip(inner) {
        smooth.within = inner;
        smooth.add_link(link);
    }
    smooth.pass_tips();
    smooth.close_fronts();
    smooth.add_facets(first);
    true
}

impl Smooth<'_> {
    /// Moves every point onto the surfaces that meet there.
    fn settle_points(&mut self) {
        let mut met = vec![[NONE; 3]; self.mesh.points.len()];
        each_side(self.mesh, |face, a, _| {
            let patch = self.patches.of_face[face as usize];
            let known = &mut met[a as usize];
            if let Some(place) = known.iter().position(|&k| k == patch || k == NONE) {
                known[place] = patch;
            }
        });
        for (point, met) in met.iter().enumerate() {
            let met = &met[..met.iter().position(|&p| p == NONE).unwrap_or(met.len())];
            let start = self.mesh.points[point];
            let rounding = f64::EPSILON * start.abs().max_element();
            let mut fields = [Field::Flat(Plane { normal: DVec3::ZERO, offset: 0.0 }); 3];
            let known = fields.iter_mut().zip(met);
            known.for_each(|(field, &p)| *field = self.patches.list[p as usize].field);
            let fields = &fields[..met.len()];
            let round = fields.iter().any(|f| matches!(f, Field::Round(_)));
            if round && fields.iter().any(|f| f.slope(start).0.abs() > rounding) {
                let moved = on_all(fields, start);
                if moved.distance(start) <= FARTHEST * self.model.bound {
                    self.model.move_point(self.base + point as u32, moved);
                }
            }
        }
    }

    /// Finds the flat faces in front by the sign of their picture's area.
    fn find_front(&mut self) {
        let mut area = vec![0.0; self.mesh.face_count()];
        each_side(self.mesh, |face, a, b| {
            let [p, q] = [a, b].map(|i| self.model.at[(self.base + i) as usize]);
            area[face as usize] += p.x * q.y - p.y * q.x;
        });
        let faces = self.mesh.faces().zip(area).zip(&self.patches.normals);
        let front = |((face, area), normal): ((FaceRef, f64), &DVec3)| {
            area > 0.0 && !self.model.is_edge_on(face, self.base, area, *normal)
        };
        self.front = faces.map(front).collect();
    }

    /// Adds the contours of surfaces that are known by their facets alone, and tells of each link whether it is within one.
    fn trace_bent(&mut self, links: &[Link]) -> Vec<bool> {
        let (normals, tolerance) = (&self.patches.normals, self.model.bound / CHORD);
        let sizes: Vec<f64> = self.mesh.faces().map(|f| f.area_vector().length()).collect();
        let known = (&normals[..], &sizes[..]);
        let bent = bent_faces(self.mesh, links, known, tolerance);
        if !bent.contains(&true) {
            return vec![false; links.len()];
        }
        self.steady = steady_normals(self.mesh, links, known, &bent, tolerance);
        let is_inner = |link: &Link| {
            let bends = |f: u32| bent[f as usize];
            let whole = link.right != NONE && (bends(link.left) || bends(link.right));
            whole && !self.is_sharp(link, self.patches_of(link), self.ends(link))
        };
        let inner: Vec<bool> = links.iter().map(is_inner).collect();
        if inner.contains(&true) {
            let (patches, base) = (&self.patches, self.base);
            let beside = |model: &Model, face: u32, point: u32| {
                let Patch { field, outward } =
                    patches.list[patches.of_face[face as usize] as usize];
                field.slope(model.space[(base + point) as usize]).1 * outward
            };
            let of = (base, self.id);
            add_contours(self.model, self.mesh, of, (links, &inner), (&self.steady, &bent), beside);
        }
        self.loose = loose_faces(links, &inner, &bent);
        self.bent = bent;
        inner
    }

    fn ends(&self, link: &Link) -> [u32; 2] {
        [self.base + link.a, self.base + link.b]
    }

    fn patches_of(&self, link: &Link) -> [u32; 2] {
        let of = |f: u32| if f == NONE { NONE } else { self.patches.of_face[f as usize] };
        [link.left, link.right].map(of)
    }

    fn add_link(&mut self, link: &Link) {
        let (ends, patches) = (self.ends(link), self.patches_of(link));
        if patches[0] == patches[1] && self.patches.is_round(patches[0]) {
            self.add_seam(link, patches[0], ends);
        } else {
            self.add_sharp(link, patches, ends);
        }
    }

    /// A side between facets of one surface: only the contour may pass it or run along it.
    fn add_seam(&mut self, link: &Link, patch: u32, ends: [u32; 2]) {
        self.note_tip(link.right, patch, ends, true);
        let course = self.course(link.left, NONE, ends, false);
        if let Some(at) = course.change.filter(|_| !course.grazed) {
            self.passes.push(Pass { face: link.right, at, out: !course.front });
        }
        for ([a, b], front) in course.stretches(ends) {
            match (course.grazed, front) {
                (true, true) => self.add_border(link.left, [a, b]),
                (true, false) => self.add_border(link.right, [b, a]),
                (false, true) => {
                    self.parts.push((link.left, [a, b]));
                    self.parts.push((link.right, [b, a]));
                }
                (false, false) => {}
            }
        }
    }

    /// An edge between two surfaces, or a border.
    fn add_sharp(&mut self, link: &Link, patches: [u32; 2], ends: [u32; 2]) {
        let courses = [
            self.course(link.left, patches[1], ends, false),
            self.course(link.right, patches[0], ends, true),
        ];
        let mut nodes = vec![(ends[0], courses.map(|c| c.front))];
        let [p, q] = ends.map(|i| self.model.space[i as usize]);
        let along = |at: u32| (q - p).dot(self.model.space[at as usize]);
        let changes = [0, 1].map(|side| courses[side].change.map(|at| (side, at)));
        let mut changes: Vec<(usize, u32)> = changes.into_iter().flatten().collect();
        changes.sort_by(|a, b| along(a.1).total_cmp(&along(b.1)));
        for (side, at) in changes {
            let mut front = nodes[nodes.len() - 1].1;
            front[side] = !front[side];
            nodes.push((at, front));
        }
        let drawn = if link.right == NONE {
            !self.body.is_cut(link.a, link.b)
        } else {
            self.is_sharp(link, patches, ends)
        };
        for i in 0..nodes.len() {
            let (from, front) = nodes[i];
            let to = nodes.get(i + 1).map_or(ends[1], |n| n.0);
            if from == to {
                continue;
            }
            match (front, courses.map(|c| c.grazed)) {
                ([true, false], [true, _]) if !drawn => self.add_border(link.left, [from, to]),
                ([false, true], [_, true]) if !drawn => self.add_border(link.right, [to, from]),
                (_, grazed) => {
                    if front[0] && grazed[0] {
                        self.pass_along(link.left, [from, to]);
                    }
                    if front[1] && grazed[1] {
                        self.pass_along(link.right, [to, from]);
                    }
                    self.add_stretch(link, patches, [from, to], front, drawn);
                }
            }
        }
    }

    /// Whether two patches meet at an angle that is drawn.
    fn is_sharp(&self, link: &Link, patches: [u32; 2], ends: [u32; 2]) -> bool {
        let faces = [link.left, link.right].map(|f| self.mesh.face(f as usize));
        let same = faces[0].origin_index() == faces[1].origin_index();
        let crease = match faces.map(|f| f.origin().surface) {
            [Surface::Smooth, _] if same => Some(FOLDED),
            [Surface::Smooth | Surface::Facets, _] | [_, Surface::Smooth | Surface::Facets] => {
                Some(self.crease)
            }
            _ => None,
        };
        ends.iter().any(|&p| {
            let p = self.model.space[p as usize];
            let [one, other] = patches.map(|patch| self.patches.list[patch as usize]);
            let [m, n] = [one, other].map(|patch| patch.field.slope(p).1 * patch.outward);
            if let Some(crease) = crease {
                let [m, n] = [(link.left, m, one), (link.right, n, other)].map(|(f, n, patch)| {
                    if patch.field.is_flat() { self.steady[f as usize] } else { n }
                });
                return m.dot(n) < crease;
            }
            let sine = m.cross(n).length();
            let turns_back = m.dot(n) <= 0.0;
            turns_back
                || sine > TANGENT
                    && (m.dot(n) < self.crease
                        || !touch([one, other], p, sine, self.model.bound / CHORD))
        })
    }

    /// A stretch of an edge along which both faces keep to the front or the back.
    fn add_stretch(
        &mut self,
        link: &Link,
        patches: [u32; 2],
        ends: [u32; 2],
        [left, right]: [bool; 2],
        drawn: bool,
    ) {
        let round = patches.iter().any(|&p| p != NONE && self.patches.is_round(p));
        let curve = if round && drawn && !patches.contains(&NONE) {
            self.curve(patches[0], patches[1])
        } else {
            NONE
        };
        let kind = if link.right == NONE {
            Kind::Border
        } else if left != right {
            Kind::Contour
        } else {
            Kind::Sharp
        };
        let is_bent = |f: u32| self.bent.get(f as usize).is_some_and(|b| *b);
        let loose = is_bent(link.left) || is_bent(link.right);
        let nodes = self.refined(curve, ends);
        for pair in nodes.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            if left {
                self.parts.push((link.left, [a, b]));
            }
            if right {
                self.parts.push((link.right, [b, a]));
            }
            if left && !right {
                self.add_outline(link.left, [a, b], curve);
            }
            if right && !left {
                self.add_outline(link.right, [b, a], curve);
            }
            if drawn || left != right && link.right != NONE && !self.within {
                let back = !left && !right;
                self.model.edges.push(Edge { a, b, kind, id: self.id, curve, back, loose });
            }
        }
    }

    fn add_outline(&mut self, face: u32, [a, b]: [u32; 2], curve: u32) {
        self.model.outlines.push(Outline { a, b, facet: NONE, curve });
        self.outline_faces.push(face);
    }

    /// The number of the curve where two patches meet, or of the contour of one.
    fn curve(&mut self, one: u32, other: u32) -> u32 {
        let key = (one.min(other), one.max(other));
        let [p, q] = [key.0, key.1].map(|i| self.patches.list[i as usize].field);
        *self.curves.entry(key).or_insert_with(|| {
            let second = if key.0 == key.1 { Constraint::Contour(q) } else { Constraint::On(q) };
            self.model.curves.push(Curve([Constraint::On(p), second]));
            self.model.curves.len() as u32 - 1
        })
    }

    /// The ends of a stretch of a curve and so many points between that chords keep to the bound.
    fn refined(&mut self, curve: u32, [a, b]: [u32; 2]) -> Vec<u32> {
        let mut nodes = vec![a];
        if curve == NONE {
            nodes.push(b);
        } else {
            let curve = self.model.curves[curve as usize];
            self.halve(&curve, [a, b], HALVINGS, &mut nodes);
        }
        nodes
    }

    /// Appends the points after `a`, up to `b`.
    fn halve(&mut self, curve: &Curve, [a, b]: [u32; 2], depth: u32, nodes: &mut Vec<u32>) {
        let [p, q] = [a, b].map(|i| self.model.space[i as usize]);
        let (middle, length) = ((p + q) / 2.0, p.distance(q));
        let found = curve.near(&self.model.camera, middle, q - p, length);
        let off = found.map_or(0.0, |on| on.distance(middle));
        let Some(on) = found.filter(|_| depth > 0 && off > self.model.bound) else {
            return nodes.push(b);
        };
        let middle = self.model.add_point(on);
        // Half a chord is a quarter as far off.
        if off < self.model.bound * 3.0 {
            return nodes.extend([middle, b]);
        }
        self.halve(curve, [a, middle], depth - 1, nodes);
        self.halve(curve, [middle, b], depth - 1, nodes);
    }

    /// Makes a facet of the front part of every face, and tells outlines their facet.
    fn add_facets(&mut self, first_outline: usize) {
        let parts = by_face(std::mem::take(&mut self.parts), self.mesh.face_count());
        self.fields = vec![NONE; self.patches.list.len()];
        let mut facet_of = vec![NONE; self.mesh.face_count()];
        for group in parts.chunk_by(|a, b| a.0 == b.0) {
            let face = group[0].0;
            facet_of[face as usize] = self.model.facets.len() as u32;
            let first = self.model.sides.len() as u32;
            self.model.sides.extend(group.iter().map(|p| p.1));
            let facet = self.facet(face, [first, self.model.sides.len() as u32]);
            self.model.facets.push(facet);
        }
        for (outline, &face) in
            self.model.outlines[first_outline..].iter_mut().zip(&self.outline_faces)
        {
            outline.facet = facet_of[face as usize];
        }
    }

    fn facet(&mut self, face: u32, sides: [u32; 2]) -> Facet {
        let corners = self.model.sides[sides[0] as usize..sides[1] as usize].iter().flatten();
        let (min, max) = around(corners.map(|&c| self.model.at[c as usize]));
        let face_ref = self.mesh.face(face as usize);
        let normal = self.patches.normals[face as usize];
        let on = self.model.space[(self.base + face_ref.outer()[0]) as usize];
        let plane = Plane { normal, offset: normal.dot(on) };
        let patch = self.patches.of_face[face as usize];
        let mut corners =
            self.model.sides[sides[0] as usize..sides[1] as usize].iter().map(|s| s[0]);
        let first = self.model.sides[sides[0] as usize][0];
        let corner = corners.find(|&c| !self.is_apex(patch, c)).unwrap_or(first);
        let loose = self.loose.get(face as usize).is_some_and(|loose| *loose);
        Facet { plane, sides, min, max, field: self.field(patch), corner, loose }
    }

    /// The place in the model of the surface of a patch, or [`NONE`] if it is flat.
    fn field(&mut self, patch: u32) -> u32 {
        if !self.patches.is_round(patch) {
            return NONE;
        }
        let slot = &mut self.fields[patch as usize];
        if *slot == NONE {
            self.model.fields.push(self.patches.list[patch as usize].field);
            *slot = self.model.fields.len() as u32 - 1;
        }
        *slot
    }
}

/// Parts sorted by their face, each face's in their order.
fn by_face(parts: Vec<(u32, [u32; 2])>, faces: usize) -> Vec<(u32, [u32; 2])> {
    let mut starts = vec![0u32; faces + 1];
    parts.iter().for_each(|p| starts[p.0 as usize + 1] += 1);
    (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
    let mut sorted = parts.clone();
    for part in parts {
        let place = &mut starts[part.0 as usize];
        sorted[*place as usize] = part;
        *place += 1;
    }
    sorted
}

/// Whether two surfaces that meet at an angle, given by its sine, are tangent up to a tolerance in mm: moved by that, they
/// would touch along the edge. Rounded edges made of chords meet what they round so.
fn touch(patches: [Patch; 2], p: DVec3, sine: f64, tolerance: f64) -> bool {
    let bend: f64 = patches.iter().map(|patch| 1.0 / patch.field.local(p).radius()).sum();
    sine * sine <= 2.0 * bend * tolerance
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_touch_where_the_tolerance_makes_them_tangent() {
        let radius = 2.0;
        let rod = Surface::Cylinder { point: DVec3::ZERO, axis: DVec3::Z, radius };
        let rod = Patch { field: Field::Round(rod), outward: 1.0 };
        // A plane that cuts a cylinder this deep meets it at an angle whose cosine is 1 - depth / radius.
        let meets = |depth: f64, tolerance: f64| {
            let plane = Plane { normal: DVec3::Y, offset: radius - depth };
            let plane = Patch { field: Field::Flat(plane), outward: 1.0 };
            let sine = (1.0 - (1.0 - depth / radius).powi(2)).sqrt();
            let p = DVec3::new(radius * sine, radius - depth, 0.0);
            touch([plane, rod], p, sine, tolerance)
        };
        assert!(meets(0.04, 0.05) && !meets(0.06, 0.05));
        assert!(meets(0.004, 0.005) && !meets(0.006, 0.005));
        let flat =
            Patch { field: Field::Flat(Plane { normal: DVec3::Y, offset: 0.0 }), outward: 1.0 };
        assert!(!touch([flat, flat], DVec3::ZERO, 1e-3, 0.05));
    }
}
