//! Whole set expressions: a subtree of `+ - &` becomes one tree for the kernel.

use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::{
    Realizer, Unwrapped, check_size,
    failure::{At, Coded, Made},
    paint::Paint,
    store::Solid,
    unwrap,
};
use crate::{
    base::Code,
    kernel::brep::{
        Polyhedron,
        boolean::{self, BooleanError, Tree},
    },
    shape::{Node, ShapeGraph, ShapeId},
};

impl Coded for BooleanError {
    fn code(&self) -> Code {
        match self {
            BooleanError::NotFinite => Code::Degenerate,
            BooleanError::NotClosed => Code::OpenMesh,
            BooleanError::TooLarge => Code::Limit,
        }
    }
}

/// Makes the solid of a set operation whose leaves are made.
pub fn make(realizer: &Realizer, graph: &ShapeGraph, id: ShapeId) -> Made<Solid> {
    let mut builder =
        Builder { realizer, graph, painted: FxHashMap::default(), triangles: 0, snap: 0.0 };
    let tree = builder.operation(id, &Paint::default())?;
    check_size(graph, id, builder.triangles)?;
    let evaluated = boolean::evaluate(&tree).at(graph.origin(id))?;
    let snap = evaluated.snap.max(builder.snap);
    Ok(Solid { polyhedron: Arc::new(evaluated.solid), snap })
}

struct Builder<'a> {
    realizer: &'a Realizer<'a>,
    graph: &'a ShapeGraph,
    /// Leaves that bear the same paint are shared.
    painted: FxHashMap<(ShapeId, Paint), Arc<Polyhedron>>,
    triangles: usize,
    snap: f64,
}

impl Builder<'_> {
    /// The tree of a set operation with `paint` on all its faces. Operations of one kind that stand
    /// directly inside one another become one.
    fn operation(&mut self, id: ShapeId, paint: &Paint) -> Made<Tree> {
        let node = self.graph.node(id);
        let list = super::structure::operands(node).unwrap_or_default();
        let mut trees = Vec::with_capacity(list.len());
        for (i, &operand) in list.iter().enumerate() {
            let tree = self.operand(id, operand, paint)?;
            match (node, tree) {
                (Node::Union(_), Tree::Union(inner))
                | (Node::Intersection(_), Tree::Intersection(inner)) => trees.extend(inner),
                (Node::Difference(_), Tree::Difference(inner)) if i == 0 => trees.extend(inner),
                (Node::Difference(_), Tree::Union(inner)) if i > 0 => trees.extend(inner),
                (_, tree) => trees.push(tree),
            }
        }
        Ok(match node {
            Node::Difference(_) => Tree::Difference(trees),
            Node::Intersection(_) => Tree::Intersection(trees),
            _ => Tree::Union(trees),
        })
    }

    fn operand(&mut self, parent: ShapeId, id: ShapeId, paint: &Paint) -> Made<Tree> {
        let Unwrapped { core, placement, paint } = unwrap(self.graph, id, paint.clone())?;
        let inner = self.realizer.structure().takes_in(parent, core);
        let tree = if inner { self.operation(core, &paint)? } else { self.leaf(core, paint)? };
        check_size(self.graph, parent, self.triangles)?;
        Ok(match placement.is_identity() {
            true => tree,
            false => Tree::Placed(placement, Box::new(tree)),
        })
    }

    fn leaf(&mut self, core: ShapeId, paint: Paint) -> Made<Tree> {
        let solid = self.realizer.core_made(core)?;
        self.snap = self.snap.max(solid.snap);
        self.triangles += solid.polyhedron.mesh().triangle_count();
        if paint.is_none() {
            return Ok(Tree::Leaf(solid.polyhedron));
        }
        let painted = self.painted.entry((core, paint)).or_insert_with_key(|(_, paint)| {
            Arc::new(Polyhedron::trusted(paint.applied(solid.polyhedron.mesh())))
        });
        Ok(Tree::Leaf(painted.clone()))
    }
}
