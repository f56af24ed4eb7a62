//! How the sides of faces are turned to the eye.
//!
//! A side is in front, behind, or changes once on its way. Two cases need thought. The apex of a cone is turned every
//! way: there a side is turned like the straight line of the cone that it is. And a side may lie in the contour: it
//! belongs to the front part of the face that turns to the eye from there on inwards, which a derivative tells. Where the
//! derivative changes its sign, two branches of the contour cross, as on a torus that is seen from the side.

use glam::DVec3;

use super::{Pass, Smooth};
use crate::output::drawing::{field::on_all, links::NONE, patches::Patch};

/// A surface is seen edge-on where the sine of the angle to the sight line is below this. Rounding leaves contours that
/// run along rows of corners that far off; in the picture they are off by its square.
const EDGE_ON: f64 = 1e-5;

/// A surface does not turn to the eye along a direction where the part of it that does is smaller than this.
const EVEN: f64 = 1e-6;

/// How a side of a face is turned to the eye from one end to the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    /// Whether it is in front at its first end.
    pub front: bool,
    /// Where that changes.
    pub change: Option<u32>,
    /// Whether it lies in the contour; it counts as in front where the face inside is.
    pub grazed: bool,
}

/// A side of a face that begins or ends at the apex of the face's cone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tip {
    face: u32,
    apex: u32,
    /// Whether the side ends there.
    ends: bool,
    front: bool,
}

impl Course {
    /// A side that is turned alike all along.
    fn whole(front: bool) -> Course {
        Course { front, change: None, grazed: false }
    }

    /// The parts of the side between two points, and whether they are in front.
    pub fn stretches(self, [a, b]: [u32; 2]) -> impl Iterator<Item = ([u32; 2], bool)> {
        let middle = self.change.unwrap_or(b);
        let parts = [([a, middle], self.front), ([middle, b], !self.front)];
        parts.into_iter().filter(|(ends, _)| ends[0] != ends[1])
    }
}

impl Smooth<'_> {
    /// How far a round surface is turned to the eye at a point: the sine of an angle, 0 on the contour.
    pub(super) fn turned(&mut self, patch: u32, point: u32) -> f64 {
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

    /// The course of a side of a face; the face is on its left, or on its right if `turned`. Beyond it is a face of
    /// `other`. Where the front ends, the contour passes the side.
    pub(super) fn course(&mut self, face: u32, other: u32, ends: [u32; 2], turned: bool) -> Course {
        if face == NONE {
            return Course::whole(false);
        }
        let patch = self.patches.of_face[face as usize];
        if !self.patches.is_round(patch) {
            return Course::whole(self.front[face as usize]);
        }
        let tip = self.note_tip(face, patch, ends, turned);
        let turns = tip.map_or_else(|| ends.map(|p| self.turned(patch, p)), |turn| [turn; 2]);
        if turns == [0.0; 2] {
            return self.graze(patch, ends, turned);
        }
        let front = turns.map(|t| t > 0.0);
        if front[0] == front[1] {
            return Course::whole(front[0]);
        }
        let at = self.contour_point(patch, other, ends);
        self.passes.push(Pass { face, at, out: front[0] != turned });
        Course { front: front[0], change: Some(at), grazed: false }
    }

    /// The course of a side that lies in the contour.
    fn graze(&mut self, patch: u32, ends: [u32; 2], turned: bool) -> Course {
        let patch = self.patches.list[patch as usize];
        let [p, q] = ends.map(|i| self.model.space[i as usize]);
        let along = if turned { p - q } else { q - p }.normalize_or_zero();
        let lean = |t: f64| self.lean(&patch, p.lerp(q, t), along);
        let (start, end) = match [lean(0.0), lean(1.0)] {
            [0.0, 0.0] => return Course::whole(false),
            [0.0, s] | [s, 0.0] => (s, s),
            [s, t] => (s, t),
        };
        let front = start > 0.0;
        let change = (front != (end > 0.0)).then(|| {
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..f64::MANTISSA_DIGITS {
                let middle = (low + high) / 2.0;
                if (lean(middle) > 0.0) == front { low = middle } else { high = middle }
            }
            on_all(&[patch.field], p.lerp(q, low))
        });
        let change = change.map(|p| self.model.add_point(p));
        Course { front, change, grazed: true }
    }

    /// How a surface turns to the eye on the left of a direction across the sight line, -1 to 1; 0 where it hardly does.
    fn lean(&self, patch: &Patch, p: DVec3, along: DVec3) -> f64 {
        let local = patch.field.local(p);
        let inwards = (local.normal * patch.outward).cross(along);
        let sight = self.model.camera.sight(p).normalize();
        let lean = local.bend(inwards).dot(sight) * patch.outward * local.radius();
        if lean.abs() > EVEN { lean } else { 0.0 }
    }

    /// The contour leaves and comes back at the ends of a side that lies in it, in the direction of the walk around the
    /// face.
    pub(super) fn pass_along(&mut self, face: u32, [from, to]: [u32; 2]) {
        self.passes.push(Pass { face, at: from, out: false });
        self.passes.push(Pass { face, at: to, out: true });
    }

    /// Notes a side that begins or ends at the apex of a cone, and how it is turned.
    pub(super) fn note_tip(
        &mut self,
        face: u32,
        patch: u32,
        ends: [u32; 2],
        turned: bool,
    ) -> Option<f64> {
        let at = ends.iter().position(|&p| self.is_apex(patch, p))?;
        let turn = self.turned(patch, ends[1 - at]);
        let tip = Tip { face, apex: ends[at], ends: (at == 1) != turned, front: turn > 0.0 };
        self.tips.push(tip);
        Some(turn)
    }

    /// Contours of cones run through the apex where the sides of a face there are turned differently.
    pub(super) fn pass_tips(&mut self) {
        self.tips.sort_by_key(|t| (t.face, t.apex, !t.ends));
        for pair in self.tips.windows(2) {
            let [before, after] = [pair[0], pair[1]];
            let corner = before.face == after.face && before.apex == after.apex;
            if corner && before.ends && !after.ends && before.front != after.front {
                self.passes.push(Pass { face: before.face, at: before.apex, out: before.front });
                self.model.cusps.push(before.apex);
            }
        }
    }

    /// Whether a point is the apex of a patch that is a cone.
    pub(super) fn is_apex(&self, patch: u32, point: u32) -> bool {
        let apex = self.patches.list[patch as usize].field.apex();
        apex.is_some_and(|a| a.distance(self.model.space[point as usize]) <= self.model.contact)
    }
}
