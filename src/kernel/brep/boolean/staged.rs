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

/// Evaluates an operation in stages; `None` where one stage is as good, or where stages fail.
pub(super) fn evaluate(
    plan: &Plan,
    lattice: &Lattice,
    (facets, sources, patches): (&Facets, &Sources, &Patches),
    space: &mut Space,
) -> Option<Polyhedron> {
    if plan.leaves.len() < 3 || facets.has_dropped {
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

/// The solid that a closed surface bounds, its vertices rounded.
fn assembled(
    facets: &mut Facets,
    plan: &Plan,
    places: &Places<'_>,
    patches: &Patches,
    space: &mut Space,
) -> Option<Polyhedron> {
    let mut complex = Complex::default();
    (0..facets.list().len() as u32).for_each(|facet| complex.add_whole(facet, facets));
    complex.add_patches(std::iter::empty());
    complex.finish(space.point_count());
    let borders = Borders(vec![]);
    let links = Links::of(&complex, &borders, facets, space);
    let sides = Sides::of_surface(&complex, links);
    let (complex, sides, borders) = (&complex, &sides, &borders);
    let assembly = Assembly { plan, patches, borders, places, facets, space, complex, sides };
    assembly.solid().ok()
}
