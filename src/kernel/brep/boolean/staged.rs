//! The evaluation of a crowded operation in stages.

use super::{
    super::threads,
    assemble::Assembly,
    cells::Complex,
    classify::{Links, Sides},
    facet::Facets,
    fork::Fork,
    frame::{Plan, deeper},
    hierarchy::Bounds,
    lattice::Lattice,
    patch::{Borders, Patches},
    place::{Places, Sources},
    schedule::{self, Operand, Stage},
    space::Space,
    stage,
    union_find::Sets,
};
use crate::kernel::brep::Polyhedron;
use glam::DVec3;

/// Evaluates an operation in stages ([`Assembly::solid`]); `None` where one stage is as good, or where stages fail.
pub(super) fn evaluate(
    plan: &Plan,
    lattice: &Lattice,
    (facets, sources, patches): (&Facets, &Sources, &Patches),
    space: &mut Space,
) -> Option<(Polyhedron, Option<DVec3>)> {
    if plan.leaves.len() < 3 || facets.has_collapsed || !patches.list.is_empty() {
        return None;
    }
    let boxes: Vec<Bounds> = facets.owner_bounds().collect();
    let list = schedule::stages(&plan.expression, &boxes);
    if list.len() < 2 || !are_shells(facets, space) {
        return None;
    }
    let mut stages = Stages { list, weights: vec![], facets, plan };
    stages.weigh();
    let mut whole = stages.result(stages.list.len() as u32 - 1, space)?;
    assembled(&mut whole, plan, &Places::new(plan, lattice, sources, facets), patches, space)
}

/// The stages of an operation, and what they take up.
struct Stages<'a> {
    list: Vec<Stage>,
    /// How many facets of leaves go into each stage.
    weights: Vec<usize>,
    facets: &'a Facets,
    plan: &'a Plan,
}

/// So many facets are worth a second thread, if they are also this part of all.
const HEAVY: usize = 64;
const PART: usize = 8;

impl Stages<'_> {
    /// Finds the weights.
    fn weigh(&mut self) {
        for stage in &self.list {
            let weight = |operand: &Operand| match *operand {
                Operand::Leaf(leaf) => self.facets.of_owner(leaf as usize).len(),
                Operand::Stage(stage) => self.weights[stage as usize],
            };
            let weight = stage.operands.iter().map(weight).sum();
            self.weights.push(weight);
        }
    }

    /// Whether an operand is worth a thread of its own. There are few such, so the space is copied seldom.
    fn is_heavy(&self, operand: Operand) -> bool {
        let Operand::Stage(stage) = operand else { return false };
        let weight = self.weights[stage as usize];
        weight >= HEAVY && weight * PART >= self.facets.list().len()
    }

    /// What a stage leaves.
    fn result(&self, stage: u32, space: &mut Space) -> Option<Facets> {
        deeper(|| {
            let stage = &self.list[stage as usize];
            let operands = self.operands(&stage.operands, space)?;
            stage::evaluate(&operands, &stage.expression, self.plan, space)
        })
    }

    /// What a stage takes up; several heavy operands at the same time.
    fn operands(&self, list: &[Operand], space: &mut Space) -> Option<Vec<Facets>> {
        let heavy: Vec<Operand> = list.iter().copied().filter(|o| self.is_heavy(*o)).collect();
        if heavy.len() < 2 {
            return list.iter().map(|operand| self.operand(*operand, space)).collect();
        }
        let apart = |operand: &Operand| {
            let mut fork = Fork::of(space);
            self.operand(*operand, &mut fork.space).map(|found| (fork, found))
        };
        let parts = threads::each(&heavy, apart).into_iter().collect::<Option<Vec<_>>>()?;
        let mut parts = parts.into_iter();
        let mut next = |operand: &Operand| {
            if !self.is_heavy(*operand) {
                return self.operand(*operand, space);
            }
            let (fork, mut found) = parts.next()?;
            fork.bring_back(&mut found, space);
            Some(found)
        };
        list.iter().map(&mut next).collect()
    }

    fn operand(&self, operand: Operand, space: &mut Space) -> Option<Facets> {
        match operand {
            Operand::Leaf(leaf) => Some(self.facets.operand(leaf)),
            Operand::Stage(stage) => self.result(stage, space),
        }
    }
}

/// Whether the facets of every leaf hang together, so that it winds once around what it encloses.
fn are_shells(facets: &Facets, space: &Space) -> bool {
    let mut sets = Sets::new(space.point_count());
    (0..facets.owner_count()).all(|leaf| {
        let range = facets.of_owner(leaf).start as u32..facets.of_owner(leaf).end as u32;
        range.clone().flat_map(|facet| facets.edges(facet)).for_each(|(a, b)| sets.join(a, b));
        let corners = || range.clone().flat_map(|facet| facets.loops(facet).flatten().copied());
        let first = corners().next().map(|corner| sets.find(corner));
        let is_one = corners().all(|corner| Some(sets.find(corner)) == first);
        corners().for_each(|corner| sets.part(corner));
        is_one
    })
}

/// The solid that a closed surface bounds, its vertices rounded ([`Assembly::solid`]).
fn assembled(
    facets: &mut Facets,
    plan: &Plan,
    places: &Places<'_>,
    patches: &Patches,
    space: &mut Space,
) -> Option<(Polyhedron, Option<DVec3>)> {
    let mut complex = Complex::default();
    (0..facets.list().len() as u32).for_each(|facet| complex.add_whole(facet, facets, space));
    complex.add_patches(std::iter::empty());
    complex.finish(space.point_count());
    let borders = Borders(vec![]);
    let links = Links::of(&complex, &borders, facets, space);
    let sides = Sides::of_surface(&complex, links);
    let (complex, sides, borders) = (&complex, &sides, &borders);
    let assembly = Assembly { plan, patches, borders, places, facets, space, complex, sides };
    assembly.solid()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{DMat3, DQuat, DVec3, EulerRot, dvec3};

    use super::super::{Tree, arranged, frame::plan};
    use crate::{
        geom::Placement,
        kernel::brep::{Polyhedron, measure, primitive::cuboid, primitive::sphere},
    };

    /// What stages leave is what one arrangement of all leaves.
    #[test]
    fn stages_change_nothing() {
        let bar = Arc::new(cuboid(dvec3(-5.0, -3.0, -2.0), dvec3(5.0, 3.0, 2.0)));
        let ball = Arc::new(sphere(4.0, 12));
        let part = |solid: &Arc<Polyhedron>, i: usize| {
            let turn = |k: usize| (i * k % 23) as f64;
            let turned = DQuat::from_euler(EulerRot::XYZ, turn(3), turn(5), turn(7));
            let offset = dvec3(turn(11), turn(13), turn(17)) / 3.0 - DVec3::splat(3.5);
            let placement = Placement::new(DMat3::from_quat(turned), offset);
            Tree::Placed(placement, Box::new(Tree::Leaf(solid.clone())))
        };
        let solid = |i: usize| part(if i.is_multiple_of(3) { &ball } else { &bar }, i);
        let chain = (1..14).fold(solid(0), |tree, i| match i % 3 {
            0 => Tree::Union(vec![tree, solid(i)]),
            1 => Tree::Difference(vec![Tree::Union(vec![tree, solid(i + 20)]), solid(i)]),
            _ => Tree::Intersection(vec![tree, Tree::Union(vec![solid(i), solid(i + 30)])]),
        });
        let trees = [
            Tree::Union((0..14).map(solid).collect()),
            Tree::Difference((0..10).map(solid).collect()),
            Tree::Intersection(vec![solid(0), Tree::Union((1..9).map(solid).collect())]),
            chain,
        ];
        for tree in trees {
            let plan = plan(&tree, &Placement::IDENTITY).expect("a plan");
            let [stages, once] = [true, false].map(|trusted| {
                let found = arranged(&plan, trusted, false).expect("finite");
                found.expect("the solids do not cross themselves").solid
            });
            let volumes = [&stages, &once].map(measure::volume);
            assert!((volumes[0] - volumes[1]).abs() <= 1e-7 * volumes[1].max(1.0), "{volumes:?}");
            assert_eq!(stages.mesh().triangle_count(), once.mesh().triangle_count());
            assert_eq!(measure::euler(&stages), measure::euler(&once));
        }
    }
}
