//! Whole set expressions: a subtree of `+ - &` becomes one tree for the kernel.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use rustc_hash::FxHashMap;

use super::{
    Realizer, Unwrapped, check_size,
    failure::{At, Coded, Made},
    paint::Paint,
    store::Solid,
    structure, unwrap,
};
use crate::{
    base::Code,
    geom::Stretch,
    kernel::brep::{
        Polyhedron,
        boolean::{self, BooleanError, Tree},
    },
    shape::{Node, ShapeGraph, ShapeId, Stretched},
};

impl Coded for BooleanError {
    fn code(&self) -> Code {
        match self {
            BooleanError::NotFinite => Code::Degenerate,
            BooleanError::NotClosed => Code::OpenMesh,
            BooleanError::TooLarge | BooleanError::Tangled(_) => Code::Limit,
        }
    }
}

/// Makes the solid of a set operation whose leaves are made.
pub fn make(realizer: &Realizer, graph: &ShapeGraph, unit: Stretched) -> Made<Solid> {
    let mut builder = Builder {
        realizer,
        graph,
        unit,
        painted: FxHashMap::default(),
        triangles: 0,
        snap: 0.0,
        crossing: None,
    };
    let tree = builder.operation(unit.id, DMat3::IDENTITY, &Paint::default())?;
    check_size(graph, unit.id, builder.triangles)?;
    let evaluated = boolean::evaluate(&tree).at(graph.origin(unit.id))?;
    let snap = evaluated.snap.max(builder.snap);
    let crossing = evaluated.crossing.or(builder.crossing);
    Ok(Solid { polyhedron: Arc::new(evaluated.solid), snap, crossing, lost: None })
}

struct Builder<'a> {
    realizer: &'a Realizer<'a>,
    graph: &'a ShapeGraph,
    unit: Stretched,
    /// Leaves that bear the same paint are shared.
    painted: FxHashMap<(Stretched, Paint), Arc<Polyhedron>>,
    triangles: usize,
    snap: f64,
    crossing: Option<DVec3>,
}

impl Builder<'_> {
    /// The tree of a set operation with `paint` on all its faces. Operations of one kind that stand
    /// directly inside one another become one. `outer` is the linear part of the way from here to the unit.
    fn operation(&mut self, id: ShapeId, outer: DMat3, paint: &Paint) -> Made<Tree> {
        let node = self.graph.node(id);
        let list = structure::operands(node).unwrap_or_default();
        let mut trees = Vec::with_capacity(list.len());
        for (i, &operand) in list.iter().enumerate() {
            let tree = self.operand((id, operand), outer, paint)?;
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

    fn operand(
        &mut self,
        (parent, id): (ShapeId, ShapeId),
        outer: DMat3,
        paint: &Paint,
    ) -> Made<Tree> {
        let Unwrapped { core, placement, paint } = unwrap(self.graph, id, paint.clone())?;
        let linear = outer * placement.linear();
        let tree = match self.realizer.structure().takes_in(parent, core) {
            true => self.operation(core, linear, &paint)?,
            false => self.leaf(core, linear, paint)?,
        };
        check_size(self.graph, parent, self.triangles)?;
        Ok(match placement.is_identity() {
            true => tree,
            false => Tree::Placed(placement, Box::new(tree)),
        })
    }

    fn leaf(&mut self, core: ShapeId, linear: DMat3, paint: Paint) -> Made<Tree> {
        let leaf = structure::leaf(self.graph, self.unit, core, linear);
        let solid = self.realizer.unit_made(leaf)?;
        self.snap = self.snap.max(solid.snap * Stretch::of(linear).factor());
        self.crossing = self.crossing.or(solid.crossing);
        self.triangles += solid.polyhedron.mesh().triangle_count();
        if paint.is_none() {
            return Ok(Tree::Leaf(solid.polyhedron));
        }
        let painted = self.painted.entry((leaf, paint)).or_insert_with_key(|(_, paint)| {
            Arc::new(Polyhedron::trusted(paint.applied(solid.polyhedron.mesh())))
        });
        Ok(Tree::Leaf(painted.clone()))
    }
}
