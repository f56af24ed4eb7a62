//! How finely a shape must be made so that the output keeps the tolerance.

use glam::{DMat3, DVec3};

use super::{
    graph::ShapeGraph,
    node::{Kind, Node, ShapeId},
};
use crate::geom::{Placement, Stretch, curve::Piece};

/// A shape with more curves than this, each counted as often as it stands in it, is made for few stretches: the
/// next greater of a row. A graph shares nodes, and a shape that holds two scaled copies of one that holds two
/// scaled copies, and so on, would have its leaves made for too many.
const MOST_CURVES: u32 = 1 << 8;

/// A shape and how much it is stretched on its way to the output: its curves are made with the output's
/// tolerance divided by that.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Stretched {
    /// The shape.
    pub id: ShapeId,
    /// The stretch; one where the shape has no curves, so that it is made once for all, and rounded up where it
    /// has hundreds.
    pub stretch: Stretch,
}

impl ShapeGraph {
    /// A shape under a stretch.
    ///
    /// ```
    /// use katachi::{base::Span, geom::Stretch, shape::{Node, ShapeGraph}};
    /// let mut graph = ShapeGraph::default();
    /// let ball = graph.add(Node::Sphere { r: 2.0, sides: None }, Span::default());
    /// let rock = graph.add(Node::Sphere { r: 2.0, sides: Some(8) }, Span::default());
    /// assert_eq!(graph.stretched(ball, Stretch::by(2.0)).stretch.factor(), 2.0);
    /// assert_eq!(graph.stretched(rock, Stretch::by(2.0)).stretch, Stretch::ONE);
    /// ```
    pub fn stretched(&self, id: ShapeId, stretch: Stretch) -> Stretched {
        let stretch = match self.curves(id) {
            0 => Stretch::ONE,
            1..=MOST_CURVES => stretch,
            _ => stretch.rounded_up(),
        };
        Stretched { id, stretch }
    }

    /// Whether the tolerance decides how a shape is made: a curve is somewhere in it.
    pub fn is_curved(&self, id: ShapeId) -> bool {
        self.curves(id) > 0
    }

    /// A child of a shape, with what the shape itself stretches it by.
    pub fn part(&self, whole: Stretched, child: ShapeId) -> Stretched {
        let own = match self.node(whole.id) {
            Node::Transform { placement, .. } => self.stretch_of(placement, child),
            Node::Extrude { scale, .. } => Stretch::by(scale.max_element().max(1.0)),
            Node::SweptAlong(sweep) => Stretch::by(sweep.scale.max(1.0)),
            _ => Stretch::ONE,
        };
        self.stretched(child, whole.stretch.times(own))
    }

    /// How much a placement stretches a shape: a profile that lies level is not stretched along z.
    fn stretch_of(&self, placement: &Placement, child: ShapeId) -> Stretch {
        let m = placement.linear();
        match self.kind(child) == Kind::Profile && self.is_level(child) {
            true => Stretch::of(DMat3::from_cols(m.x_axis, m.y_axis, DVec3::ZERO)),
            false => Stretch::of(m),
        }
    }
}

/// How often something that is made with the tolerance stands in a node, given how often in its children.
pub(super) fn curves(node: &Node, child: impl Fn(ShapeId) -> u32) -> u32 {
    let own = match node {
        Node::Cone { sides, .. }
        | Node::Sphere { sides, .. }
        | Node::Torus { sides, .. }
        | Node::Ellipse { sides, .. }
        | Node::Revolve { sides, .. } => sides.is_none(),
        Node::Extrude { twist, scale, .. } => *twist != 0.0 || scale.x != scale.y,
        Node::Outline { curve } => curve.pieces().iter().any(|p| !matches!(p, Piece::Line(_))),
        Node::Text(_)
        | Node::SweptAlong(_)
        | Node::SweptBetween(_)
        | Node::Loft { .. }
        | Node::ImportProfile { .. }
        | Node::OffsetProfile { .. }
        | Node::RoundProfile { .. }
        | Node::Metaball { .. }
        | Node::Formula { .. }
        | Node::Offset { .. }
        | Node::Fillet { .. } => true,
        _ => false,
    };
    node.children().iter().map(|&id| child(id)).fold(u32::from(own), u32::saturating_add)
}

/// Whether a profile stays parallel to the xy plane, given whether its children do.
pub(super) fn level(node: &Node, child: impl Fn(ShapeId) -> bool) -> bool {
    let stays = match node {
        Node::Transform { placement, .. } => {
            let m = placement.linear();
            m.x_axis.z == 0.0 && m.y_axis.z == 0.0
        }
        _ => true,
    };
    stays && node.children().iter().all(|&id| child(id))
}
