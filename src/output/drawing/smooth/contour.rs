//! Contours of round faces: where they run through facets or along their sides.

use glam::DVec3;

use super::Smooth;
use crate::output::drawing::{
    field::{Constraint, Curve, Field},
    model::Edge,
    scene::Kind,
};

impl Smooth<'_> {
    /// The point of a patch's contour between two points of the patch, one of which is in front; on the curve with
    /// another patch unless it is [`NONE`].
    pub(super) fn contour_point(&mut self, patch: u32, other: u32, [a, b]: [u32; 2]) -> u32 {
        let [s, t] = [a, b].map(|p| self.turned(patch, p));
        if s == 0.0 || t == 0.0 {
            return if s == 0.0 { a } else { b };
        }
        let field = self.patches.list[patch as usize].field;
        let [p, q] = [a, b].map(|i| self.model.space[i as usize]);
        let start = p.lerp(q, s / (s - t));
        let contour = Curve([Constraint::On(field), Constraint::Contour(field)]);
        let (camera, reach) = (&self.model.camera, p.distance(q));
        let found = match self.patches.list.get(other as usize) {
            Some(other) => contour.meeting(Constraint::On(other.field), camera, start, reach),
            None => {
                let across = (q - p).cross(field.slope(start).1);
                contour.near(camera, start, across, reach)
            }
        };
        self.model.add_point(found.unwrap_or(start))
    }

    /// A contour along a side of a face, in the direction of the walk around it.
    pub(super) fn add_border(&mut self, face: u32, ends: [u32; 2]) {
        self.pass_along(face, ends);
        self.add_contour(face, ends);
    }

    /// Closes the front part of every face that a contour runs through, along the contour.
    pub(super) fn close_fronts(&mut self) {
        let mut passes = std::mem::take(&mut self.passes);
        passes.sort_by_key(|p| p.face);
        for group in passes.chunk_by(|a, b| a.face == b.face) {
            let at = |out: bool| group.iter().filter(move |p| p.out == out).map(|p| p.at);
            let mut back: Vec<u32> = at(false).collect();
            // Where the front part goes on at once, no contour begins.
            let leaving: Vec<u32> = at(true)
                .filter(|a| back.iter().position(|b| a == b).map(|i| back.swap_remove(i)).is_none())
                .collect();
            for leaving in leaving {
                let from = self.model.space[leaving as usize];
                let distance = |at: &u32| self.model.space[*at as usize].distance_squared(from);
                let near = (0..back.len())
                    .min_by(|&i, &j| distance(&back[i]).total_cmp(&distance(&back[j])));
                let Some(near) = near else { break };
                let to = back.swap_remove(near);
                self.add_contour(group[0].face, [leaving, to]);
            }
        }
    }

    /// The contour through a face from where it leaves the front to where it comes back.
    pub(super) fn add_contour(&mut self, face: u32, ends: [u32; 2]) {
        let patch = self.patches.of_face[face as usize];
        let curve = self.curve(patch, patch);
        let nodes = self.refined(curve, ends);
        let nodes = self.with_cusps(patch, curve, nodes);
        for pair in nodes.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            self.parts.push((face, [a, b]));
            self.add_outline(face, [a, b], curve);
            let (kind, id) = (Kind::Contour, self.id);
            self.model.edges.push(Edge { a, b, kind, id, curve, back: false, loose: false });
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
}
