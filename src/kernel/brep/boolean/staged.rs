//! The evaluation of a crowded operation in stages.

use super::{
    assemble::Assembly,
    cells::Complex,
    classify::{Links, Sides},
    facet::Facets,
    frame::Plan,
    lattice::Lattice,
    patch::{Borders, Patches},
    place::{Places, Sources},
    schedule::{self, Operand},
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
    if plan.leaves.len() < 3 || facets.has_collapsed {
        return None;
    }
    let leaves: Vec<Facets> =
        (0..plan.leaves.len()).map(|leaf| facets.operand(leaf as u32)).collect();
    let boxes: Vec<_> = leaves.iter().map(Facets::bounds).collect();
    let stages = schedule::stages(&plan.expression, &boxes);
    if stages.len() < 2
        || !patches.list.is_empty()
        || !leaves.iter().all(|l| is_one_shell(l, space))
    {
        return None;
    }
    let mut leaves: Vec<Option<Facets>> = leaves.into_iter().map(Some).collect();
    let mut done: Vec<Option<Facets>> = vec![];
    for stage in &stages {
        let mut take = |operand: &Operand| match operand {
            Operand::Leaf(leaf) => leaves[*leaf as usize].take(),
            Operand::Stage(stage) => done[*stage as usize].take(),
        };
        let operands = stage.operands.iter().map(&mut take).collect::<Option<Vec<Facets>>>()?;
        let result = stage::evaluate(&operands, &stage.expression, plan, space)?;
        done.push(Some(result));
    }
    let mut whole = done.pop()??;
    assembled(&mut whole, plan, &Places::new(plan, lattice, sources, facets), patches, space)
}

/// Whether the facets of an operand hang together, so that it winds once around what it encloses.
fn is_one_shell(facets: &Facets, space: &Space) -> bool {
    let mut sets = Sets::new(space.point_count());
    for facet in 0..facets.list().len() as u32 {
        facets.edges(facet).for_each(|(a, b)| sets.join(a, b));
    }
    let mut corners = (0..facets.list().len() as u32).flat_map(|f| facets.loops(f).flatten());
    let first = corners.next().map(|&c| sets.find(c));
    corners.all(|&corner| Some(sets.find(corner)) == first)
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
