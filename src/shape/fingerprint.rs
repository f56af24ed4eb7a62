//! A structural hash of nodes, in step with their equality: equal nodes have equal fingerprints.
//!
//! Numbers are hashed by their bits after negative zero is made positive, children by their number in
//! the graph, lists once from front to back. The value is the same in every run.

use std::hash::{Hash, Hasher};

use glam::{DVec2, DVec3};
use rustc_hash::FxHasher;

use super::{
    drawing::CurveSpec,
    node::{Heal, Node, ShapeId, TextSpec},
    sweep::{SweepAlong, SweepBetween},
};
use crate::geom::{
    Charge, Curve, CurvedGrid, Falloff,
    curve::{Piece, Turn},
    formula::Op,
};

/// The fingerprint of a node.
pub(super) fn fingerprint(node: &Node) -> u64 {
    let mut feed = Feed(FxHasher::default());
    std::mem::discriminant(node).hash(&mut feed.0);
    feed.node(node);
    feed.0.finish()
}

struct Feed(FxHasher);

impl Feed {
    fn real(&mut self, x: f64) {
        self.0.write_u64((x + 0.0).to_bits());
    }

    fn plane(&mut self, v: DVec2) {
        v.to_array().into_iter().for_each(|x| self.real(x));
    }

    fn space(&mut self, v: DVec3) {
        v.to_array().into_iter().for_each(|x| self.real(x));
    }

    fn list(&mut self, ids: &[ShapeId]) {
        ids.hash(&mut self.0);
    }

    fn outline(&mut self, points: &[DVec2]) {
        self.0.write_usize(points.len());
        points.iter().for_each(|&p| self.plane(p));
    }

    fn node(&mut self, node: &Node) {
        match node {
            Node::Empty(kind) => kind.hash(&mut self.0),
            Node::Box { min, max } => [*min, *max].into_iter().for_each(|v| self.space(v)),
            Node::Cone { r1, r2, h, sides } => self.sized(&[*r1, *r2, *h], *sides),
            Node::Sphere { r, sides } => self.sized(&[*r], *sides),
            Node::Torus { major, minor, sides } => self.sized(&[*major, *minor], *sides),
            Node::Polyhedron { points, faces } => {
                self.0.write_usize(points.len());
                points.iter().for_each(|&p| self.space(p));
                faces.hash(&mut self.0);
            }
            Node::Extrude { profile, height, twist, scale } => {
                profile.hash(&mut self.0);
                self.sized(&[*height, *twist, scale.x, scale.y], None);
            }
            Node::Revolve { profile, angle, sides } => {
                profile.hash(&mut self.0);
                self.sized(&[*angle], *sides);
            }
            Node::Thickened { surface, t } => {
                self.surface(surface);
                self.real(*t);
            }
            Node::Figured { figures, child } => {
                (child, &figures.profiles).hash(&mut self.0);
                figures.curves.iter().for_each(|curve| self.lines(curve));
            }
            Node::Outline { curve } => self.curve(curve),
            Node::SweptAlong(sweep) => self.along(sweep),
            Node::SweptBetween(sweep) => self.between(sweep),
            Node::Loft { sections, ruled } => (sections, ruled).hash(&mut self.0),
            Node::Filled { surface, base } => {
                self.surface(surface);
                base.iter().for_each(|z| self.real(*z));
            }
            Node::ImportSolid { file, heal } => {
                file.hash(&mut self.0);
                self.heal(*heal);
            }
            Node::Metaball { charges, threshold } => {
                self.real(*threshold);
                charges.iter().for_each(|charge| self.charge(charge));
            }
            Node::Formula { formula, within } => {
                within.iter().for_each(|&corner| self.space(corner));
                formula.ops().iter().for_each(|&op| self.op(op));
            }
            Node::Hull(list)
            | Node::Union(list)
            | Node::Difference(list)
            | Node::Intersection(list) => self.list(list),
            _ => self.profile_or_wrapper(node),
        }
    }

    fn profile_or_wrapper(&mut self, node: &Node) {
        match node {
            Node::Rect { size } => self.plane(*size),
            Node::Ellipse { radii, sides } => self.sized(&radii.to_array(), *sides),
            Node::Polygon { points, holes } => {
                self.outline(points);
                holes.iter().for_each(|hole| self.outline(hole));
            }
            Node::Text(text) => self.text(text),
            Node::ImportProfile { file } => file.hash(&mut self.0),
            Node::OffsetProfile { profile, d: distance }
            | Node::RoundProfile { profile, r: distance } => {
                profile.hash(&mut self.0);
                self.real(*distance);
            }
            Node::Offset { child, radii, by } => {
                (child, by).hash(&mut self.0);
                self.space(*radii);
            }
            Node::Fillet { child, convex, concave } => {
                child.hash(&mut self.0);
                self.sized(&[*convex, *concave], None);
            }
            Node::Transform { placement, child } => (placement, child).hash(&mut self.0),
            Node::Tag { name, child } => (name, child).hash(&mut self.0),
            Node::Paint { color, child } => (color, child).hash(&mut self.0),
            _ => unreachable!("all other nodes are hashed by `node`"),
        }
    }

    fn charge(&mut self, charge: &Charge) {
        self.space(charge.at);
        self.real(charge.q);
        match charge.falloff {
            Falloff::Inverse => self.0.write_u8(0),
            Falloff::InverseSquare => self.0.write_u8(1),
            Falloff::Wyvill { r } => self.sized(&[2.0, r], None),
            Falloff::Blinn { r } => self.sized(&[3.0, r], None),
        }
    }

    fn op(&mut self, op: Op) {
        match op {
            Op::Axis(axis) => axis.hash(&mut self.0),
            Op::Constant(x) => self.real(x),
            Op::Unary(op, a) => (op, a).hash(&mut self.0),
            Op::Binary(op, a, b) => (op, a, b).hash(&mut self.0),
            Op::Choose(a, b, c) => (a, b, c).hash(&mut self.0),
        }
    }

    fn surface(&mut self, surface: &CurvedGrid) {
        (surface.size(), surface.closed()).hash(&mut self.0);
        surface.points().iter().for_each(|&p| self.space(p));
    }

    fn lines(&mut self, curve: &CurveSpec) {
        match curve {
            CurveSpec::Exact(curve) => self.curve(curve),
            CurveSpec::Hatch { profile, pitch, angle, placement } => {
                (profile, placement).hash(&mut self.0);
                self.sized(&[*pitch, *angle], None);
            }
        }
    }

    fn curve(&mut self, curve: &Curve) {
        for piece in curve.pieces() {
            match piece {
                Piece::Line(ends) => ends.iter().for_each(|&p| self.space(p)),
                Piece::Bezier(points) => points.iter().for_each(|&p| self.space(p)),
                Piece::Turn(turn) => {
                    let Turn { center, x, y, rise, from, to } = *turn;
                    [center, x, y, rise].into_iter().for_each(|v| self.space(v));
                    self.sized(&[from, to], None);
                }
            }
        }
    }

    fn along(&mut self, sweep: &SweepAlong) {
        (sweep.profile, sweep.frame, sweep.corners, sweep.repair).hash(&mut self.0);
        self.curve(&sweep.path);
        self.sized(&[sweep.twist, sweep.scale], None);
    }

    fn between(&mut self, sweep: &SweepBetween) {
        (&sweep.sections, sweep.stations, sweep.repair).hash(&mut self.0);
        sweep.rails.iter().for_each(|rail| self.curve(rail));
    }

    fn sized(&mut self, numbers: &[f64], sides: Option<u32>) {
        numbers.iter().for_each(|&x| self.real(x));
        sides.hash(&mut self.0);
    }

    fn heal(&mut self, heal: Option<Heal>) {
        match heal {
            None => self.0.write_u8(0),
            Some(Heal::Winding) => self.0.write_u8(1),
            Some(Heal::Weld(mm)) => self.real(mm),
        }
    }

    fn text(&mut self, spec: &TextSpec) {
        (&spec.text, &spec.font, spec.halign, spec.valign).hash(&mut self.0);
        self.real(spec.size);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    #[test]
    fn negative_zero_is_zero() {
        let ball = |x: f64| Node::Box { min: DVec3::new(x, -1.0, -1.0), max: DVec3::ONE };
        assert_eq!(ball(0.0), ball(-0.0));
        assert_eq!(fingerprint(&ball(0.0)), fingerprint(&ball(-0.0)));
    }

    #[test]
    fn a_change_anywhere_shows() {
        let outline = |x: f64| Node::Polygon {
            points: Arc::from([DVec2::ZERO, DVec2::X, DVec2::new(x, 1.0)]),
            holes: Arc::from([]),
        };
        assert_ne!(fingerprint(&outline(0.0)), fingerprint(&outline(1e-300)));
        let ids = [ShapeId(0), ShapeId(1)];
        let sum = fingerprint(&Node::Union(Arc::from(ids)));
        assert_ne!(sum, fingerprint(&Node::Hull(Arc::from(ids))));
    }
}
