//! Profiles that do not lie in xy.
//!
//! OpenSCAD's plane figures know no third dimension. A profile in another plane is written as a figure
//! in xy, in a frame of its plane, and the frame is applied to the solid made of it.

use glam::{DMat3, DVec2, DVec3};

use super::{ScadError, Writer};
use crate::{
    geom::Placement,
    shape::{Node, ShapeId, Stretched},
};

/// Whether a placement maps the xy plane onto itself and keeps its upper side up.
pub(super) fn keeps_plane(placement: &Placement) -> bool {
    let m = placement.linear();
    let flat = m.x_axis.z == 0.0 && m.y_axis.z == 0.0 && placement.offset().z == 0.0;
    flat && m.z_axis.z > 0.0
}

/// The rigid frame of the image of xy: a height where the image is parallel to xy, else origin and x
/// direction are those of the placement and z is the normal on the side where the placement takes +z.
/// `None` if the image has no area.
pub(super) fn frame(placement: &Placement) -> Option<Placement> {
    let m = placement.linear();
    if m.x_axis.z == 0.0 && m.y_axis.z == 0.0 && m.z_axis.z > 0.0 {
        return Some(Placement::translation(placement.offset() * DVec3::Z));
    }
    let normal = m.x_axis.cross(m.y_axis).try_normalize()?;
    let z = if normal.dot(m.z_axis) < 0.0 { -normal } else { normal };
    let x = m.x_axis.normalize();
    Some(Placement::new(DMat3::from_cols(x, z.cross(x), z), placement.offset()))
}

/// The inverse of a rigid frame.
pub(super) fn inverse(frame: &Placement) -> Placement {
    let turned = frame.linear().transpose();
    Placement::new(turned, -(turned * frame.offset()))
}

/// The inverse of a rigid frame but for its shift within its plane: how a revolution sees a profile
/// that was turned out of xy and then moved.
pub(super) fn unrolled(frame: &Placement) -> Placement {
    let (m, t) = (frame.linear(), frame.offset());
    let shift = DVec3::new(t.dot(m.x_axis), t.dot(m.y_axis), 0.0);
    Placement::translation(shift).after(&inverse(frame))
}

/// What a placement does within xy, as a placement that leaves z alone.
pub(super) fn within(placement: &Placement) -> Placement {
    let m = placement.linear();
    let axis = |v: DVec3| DVec2::new(v.x, v.y).extend(0.0);
    let linear = DMat3::from_cols(axis(m.x_axis), axis(m.y_axis), DVec3::Z);
    Placement::new(linear, axis(placement.offset()))
}

impl Writer<'_> {
    /// Whether a profile stays in xy all the way down.
    pub(super) fn is_flat(&self, id: ShapeId) -> bool {
        let mut rest = vec![id];
        let mut seen = rustc_hash::FxHashSet::default();
        while let Some(id) = rest.pop() {
            let node = self.graph.node(id);
            if matches!(node, Node::Transform { placement, .. } if !keeps_plane(placement)) {
                return false;
            }
            rest.extend(node.children().iter().filter(|&&child| seen.insert(child)));
        }
        true
    }

    /// The frame of a profile's plane, that of its first figure.
    pub(super) fn frame_of(&self, id: ShapeId) -> Result<Placement, ScadError> {
        let (mut at, mut placement) = (id, Placement::IDENTITY);
        while !self.is_flat(at) {
            let node = self.graph.node(at);
            if let Node::Transform { placement: inner, .. } = node {
                placement = placement.after(inner);
            }
            at = node.children()[0];
        }
        frame(&placement).ok_or(ScadError::Flattened { shape: id })
    }

    /// A profile as a figure in xy after `placement`, which takes its plane there.
    pub(super) fn figure(
        &mut self,
        shape: Stretched,
        placement: &Placement,
        depth: usize,
    ) -> Result<(), ScadError> {
        if self.is_flat(shape.id) {
            let depth = depth + self.place(&within(placement), depth);
            return self.shape(shape, depth);
        }
        match self.graph.node(shape.id).clone() {
            Node::Transform { placement: inner, child } => {
                self.figure(self.graph.part(shape, child), &placement.after(&inner), depth)
            }
            Node::OffsetProfile { profile, .. } | Node::RoundProfile { profile, .. } => {
                let frame = self.frame_of(profile)?;
                let depth = depth + self.place(&within(&placement.after(&frame)), depth);
                let words = self.offsets(shape);
                let deeper = self.prefixes(&words, depth);
                self.figure(self.graph.part(shape, profile), &inverse(&frame), deeper)
            }
            node => {
                self.open(&node, depth);
                for &child in node.children() {
                    self.figure(self.graph.part(shape, child), placement, depth + 1)?;
                }
                self.line(depth, "}");
                Ok(())
            }
        }
    }
}
