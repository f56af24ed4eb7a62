//! Bodies with round faces: contours of the true surfaces, and edges as their true curves.
//!
//! Points of the mesh are moved onto the surfaces that meet there. Where a surface turns away from the eye is
//! known at every corner of its facets; between a corner in front and one behind, Newton's method finds the
//! point of the contour, and in a facet the contour runs from where it leaves the front to where it comes back.
//! So it is cut off at the borders of the face by itself. Chords are halved until they keep to the bound;
//! what hides is the front part of each facet.

use std::collections::BTreeMap;

use glam::DVec3;

use super::{
    cells::around,
    field::{Constraint, Curve, Field, on_all},
    frustum::Visible,
    lattice::Plane,
    links::{Link, NONE, each_side},
    model::{CHORD, Edge, Facet, Model, Outline},
    outline::FARTHEST,
    patches::{Patch, Patches},
    scene::Kind,
};
use crate::geom::{FaceRef, PolyMesh, Surface};

/// A surface is seen edge-on where the sine of the angle to the sight line is below this: rounding leaves
/// contours that run along rows of corners that far off.
const EDGE_ON: f64 = 1e-9;

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
    /// Sides of the front part of faces.
    parts: Vec<(u32, [u32; 2])>,
    passes: Vec<Pass>,
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
        parts: vec![],
        passes: vec![],
        curves: BTreeMap::new(),
        outline_faces: vec![],
    };
    smooth.settle_points();
    smooth.find_front();
    let first = smooth.model.outlines.len();
    links.iter().for_each(|link| smooth.add_link(link));
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

    /// How far a round surface is turned to the eye at a point: the sine of an angle, 0 on the contour.
    fn turned(&mut self, patch: u32, point: u32) -> f64 {
        let known = point.checked_sub(self.base).map_or(usize::MAX, |i| i as usize);
        match self.turns.get(known) {
            Some(&(of, turn)) if of == patch => return turn,
            _ => {}
        }
        let turn = self.turn(patch, point);
        if let Some(slot) = self.turns.get_mut(known) {
            *slot = (patch, turn);
        }
        turn
    }

    fn turn(&self, patch: u32, point: u32) -> f64 {
        let Patch { field, outward } = self.patches.list[patch as usize];
        let p = self.model.space[point as usize];
        let sine = field.slope(p).1.dot(self.model.camera.sight(p).normalize()) * outward;
        if sine.abs() < EDGE_ON { 0.0 } else { sine }
    }

    /// Whether each end of a side of a face is in front.
    fn ends_front(&mut self, face: u32, ends: [u32; 2]) -> [bool; 2] {
        if face == NONE {
            return [false; 2];
        }
        let patch = self.patches.of_face[face as usize];
        if self.patches.is_round(patch) {
            ends.map(|p| self.turned(patch, p) > 0.0)
        } else {
            [self.front[face as usize]; 2]
        }
    }

    fn add_link(&mut self, link: &Link) {
        let ends = [self.base + link.a, self.base + link.b];
        let same = link.right != NONE && {
            let [l, r] = [link.left, link.right].map(|f| self.patches.of_face[f as usize]);
            l == r && self.patches.is_round(l)
        };
        let left = self.ends_front(link.left, ends);
        if same {
            self.add_seam(link, ends, left);
        } else {
            let right = self.ends_front(link.right, ends);
            self.add_sharp(link, ends, left, right);
        }
    }

    /// A side between facets of one surface: only the contour may pass it.
    fn add_seam(&mut self, link: &Link, [a, b]: [u32; 2], front: [bool; 2]) {
        let mut part = |ends: [u32; 2]| {
            if ends[0] != ends[1] {
                self.parts.push((link.left, ends));
                self.parts.push((link.right, [ends[1], ends[0]]));
            }
        };
        match front {
            [false, false] => {}
            [true, true] => part([a, b]),
            [leaves, _] => {
                let patch = self.patches.of_face[link.left as usize];
                let at = self.contour_point(patch, None, [a, b]);
                self.parts_at_pass(link, [a, b], at, leaves);
            }
        }
    }

    fn parts_at_pass(&mut self, link: &Link, [a, b]: [u32; 2], at: u32, leaves: bool) {
        let ends = if leaves { [a, at] } else { [at, b] };
        if ends[0] != ends[1] {
            self.parts.push((link.left, ends));
            self.parts.push((link.right, [ends[1], ends[0]]));
        }
        self.passes.push(Pass { face: link.left, at, out: leaves });
        self.passes.push(Pass { face: link.right, at, out: !leaves });
    }

    /// The point of a patch's contour between two points of the patch, one of which is in front; on the curve with
    /// another patch if there is one.
    fn contour_point(&mut self, patch: u32, other: Option<u32>, [a, b]: [u32; 2]) -> u32 {
        let [s, t] = [a, b].map(|p| self.turned(patch, p));
        if s == 0.0 || t == 0.0 {
            return if s == 0.0 { a } else { b };
        }
        let field = self.patches.list[patch as usize].field;
        let [p, q] = [a, b].map(|i| self.model.space[i as usize]);
        let start = p.lerp(q, s / (s - t));
        let contour = Curve([Constraint::On(field), Constraint::Contour(field)]);
        let (camera, reach) = (&self.model.camera, p.distance(q));
        let found = match other {
            Some(other) => {
                let other = Constraint::On(self.patches.list[other as usize].field);
                contour.meeting(other, camera, start, reach)
            }
            None => {
                let across = (q - p).cross(field.slope(start).1);
                contour.near(camera, start, across, reach)
            }
        };
        self.model.add_point(found.unwrap_or(start))
    }

    /// An edge between two surfaces, or a border.
    fn add_sharp(&mut self, link: &Link, ends: [u32; 2], left: [bool; 2], right: [bool; 2]) {
        let patches = [link.left, link.right]
            .map(|f| if f == NONE { NONE } else { self.patches.of_face[f as usize] });
        let mut nodes = vec![(ends[0], left[0], right[0])];
        let passes = [(0, left), (1, right)].map(|(side, front)| {
            (front[0] != front[1]).then(|| {
                let other = patches[1 - side];
                let at = self.contour_point(patches[side], (other != NONE).then_some(other), ends);
                self.passes.push(Pass {
                    face: [link.left, link.right][side],
                    at,
                    out: front[0] == (side == 0),
                });
                (side, at)
            })
        });
        let [p, q] = ends.map(|i| self.model.space[i as usize]);
        let along = |at: u32| (q - p).dot(self.model.space[at as usize]);
        let mut passes: Vec<(usize, u32)> = passes.into_iter().flatten().collect();
        passes.sort_by(|a, b| along(a.1).total_cmp(&along(b.1)));
        for (side, at) in passes {
            let (_, l, r) = nodes[nodes.len() - 1];
            nodes.push(if side == 0 { (at, !l, r) } else { (at, l, !r) });
        }
        let drawn = if link.right == NONE {
            !self.body.is_cut(link.a, link.b)
        } else {
            self.is_sharp(link, patches, ends)
        };
        for i in 0..nodes.len() {
            let (from, l, r) = nodes[i];
            let to = nodes.get(i + 1).map_or(ends[1], |n| n.0);
            if from != to {
                self.add_stretch(link, patches, [from, to], [l, r], drawn);
            }
        }
    }

    /// Whether two patches meet at an angle that is drawn.
    fn is_sharp(&self, link: &Link, patches: [u32; 2], ends: [u32; 2]) -> bool {
        let faces = [link.left, link.right].map(|f| self.mesh.face(f as usize));
        let facets = faces.iter().any(|f| f.origin().surface == Surface::Facets);
        ends.iter().any(|&p| {
            let p = self.model.space[p as usize];
            let [one, other] = patches.map(|patch| self.patches.list[patch as usize]);
            let [m, n] = [one, other].map(|patch| patch.field.slope(p).1 * patch.outward);
            if facets {
                return m.dot(n) < self.crease;
            }
            let sine = m.cross(n).length();
            let turns_back = m.dot(n) <= 0.0;
            turns_back
                || sine > TANGENT && (m.dot(n) < self.crease || !self.touch(one, other, p, sine))
        })
    }

    /// Whether two surfaces that meet at an angle are tangent up to the modeller's tolerance: moved by that, they
    /// would touch along the edge. Rounded edges made of chords meet what they round so.
    fn touch(&self, one: Patch, other: Patch, p: DVec3, sine: f64) -> bool {
        let bend: f64 = [one, other].iter().map(|patch| 1.0 / patch.field.local(p).radius()).sum();
        sine * sine <= 2.0 * bend * self.model.bound / CHORD
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
            if drawn || left != right && link.right != NONE {
                let back = !left && !right;
                self.model.edges.push(Edge { a, b, kind, id: self.id, curve, back });
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

    /// Closes the front part of every face that a contour runs through, along the contour.
    fn close_fronts(&mut self) {
        let mut passes = std::mem::take(&mut self.passes);
        passes.sort_by_key(|p| p.face);
        for group in passes.chunk_by(|a, b| a.face == b.face) {
            let mut back: Vec<u32> = group.iter().filter(|p| !p.out).map(|p| p.at).collect();
            for leaving in group.iter().filter(|p| p.out) {
                let from = self.model.space[leaving.at as usize];
                let distance = |at: &u32| self.model.space[*at as usize].distance_squared(from);
                let near = (0..back.len())
                    .min_by(|&i, &j| distance(&back[i]).total_cmp(&distance(&back[j])));
                let Some(near) = near else { break };
                let to = back.swap_remove(near);
                if to != leaving.at {
                    self.add_contour(leaving.face, [leaving.at, to]);
                }
            }
        }
    }

    /// The contour through a face from where it leaves the front to where it comes back.
    fn add_contour(&mut self, face: u32, ends: [u32; 2]) {
        let patch = self.patches.of_face[face as usize];
        let curve = self.curve(patch, patch);
        let nodes = self.refined(curve, ends);
        let nodes = self.with_cusps(patch, curve, nodes);
        for pair in nodes.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            self.parts.push((face, [a, b]));
            self.add_outline(face, [a, b], curve);
            let (kind, id) = (Kind::Contour, self.id);
            self.model.edges.push(Edge { a, b, kind, id, curve, back: false });
        }
    }

    /// How a surface bends along the sight line at a point: at a cusp of the contour it does not.
    fn bend(&self, field: &Field, p: DVec3) -> f64 {
        field.local(p).bend_along(self.model.camera.sight(p).normalize())
    }

    /// Points of a contour with its cusps between them.
    fn with_cusps(&mut self, patch: u32, curve: u32, nodes: Vec<u32>) -> Vec<u32> {
        let field = self.patches.list[patch as usize].field;
        let curve = self.model.curves[curve as usize];
        let mut out = vec![nodes[0]];
        for pair in nodes.windows(2) {
            let [p, q] = [pair[0], pair[1]].map(|i| self.model.space[i as usize]);
            if self.bend(&field, p) * self.bend(&field, q) < 0.0
                && let Some(cusp) = self.cusp(&field, &curve, p, q)
            {
                let cusp = self.model.add_point(cusp);
                self.model.cusps.push(cusp);
                out.push(cusp);
            }
            out.push(pair[1]);
        }
        out
    }

    /// The cusp between two points of a contour, by halving.
    fn cusp(&self, field: &Field, curve: &Curve, p: DVec3, q: DVec3) -> Option<DVec3> {
        let on = |t: f64| curve.near(&self.model.camera, p.lerp(q, t), q - p, p.distance(q));
        let start = self.bend(field, p);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..f64::MANTISSA_DIGITS {
            let middle = (low + high) / 2.0;
            if self.bend(field, on(middle)?) * start > 0.0 { low = middle } else { high = middle }
        }
        on(low)
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
        let patch = self.patches.list[self.patches.of_face[face as usize] as usize];
        let field = if matches!(patch.field, Field::Round(_)) {
            let slot = &mut self.fields[self.patches.of_face[face as usize] as usize];
            if *slot == NONE {
                self.model.fields.push(patch.field);
                *slot = self.model.fields.len() as u32 - 1;
            }
            *slot
        } else {
            NONE
        };
        Facet { plane, sides, min, max, field }
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
