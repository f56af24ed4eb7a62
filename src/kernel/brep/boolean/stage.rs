//! Stages: a part of an operation evaluated to a surface that further stages take up.
//!
//! In one arrangement of everything, most of what is cut in a crowd of solids is hidden in others.
//! So a crowded operation is evaluated in [stages](super::schedule). What a stage leaves is a closed
//! surface whose corners are still points where planes meet, so nothing is rounded in between.

use super::{
    arrange,
    boundary::Boundary,
    cells::Complex,
    classify::{Links, Sides, classify},
    expression::{Expression, State},
    facet::{Facets, Source},
    frame::Plan,
    locate,
    origins::{Flat, Labels},
    outline::{Once, Outline},
    patch::Borders,
    region::Regions,
    rest::{Rest, Resting},
    space::{NONE, Space},
};

/// Evaluates an expression over operands that each wind once around what they enclose. `None` where
/// a place could not be told, or they contradict themselves.
pub(super) fn evaluate(
    operands: &[Facets],
    expression: &Expression,
    plan: &Plan,
    space: &mut Space,
) -> Option<Facets> {
    let rest = Rest::of(operands, space);
    let mut result = Facets::default();
    keep_shells(&rest.shells, operands, expression, space, &mut result)?;
    if rest.active.is_empty() {
        result.end_owner();
        return Some(result);
    }
    let mut facets = active(&rest, operands, space);
    let patches: Vec<u32> =
        rest.patches.iter().map(|p| facets.of_owner(p.owner as usize).start as u32).collect();
    let complex = arrange::complex(&mut facets, &rest.pairs, &patches, space, true);
    let mut links = Links::of(&complex, &rest.borders, &mut facets, space);
    let regions = Regions::of_sets(&complex, &mut links.regions);
    let seeds = locate::seeds(&regions, &mut links, operands, &facets, space)?;
    let sides = classify(&regions, links.radial, &seeds, expression, &facets)?;
    for (cell, patch) in (complex.first_patch as usize..).zip(&rest.patches) {
        let inside = [sides.inside[2 * cell], sides.inside[2 * cell + 1]];
        keep(patch, inside, operands, &mut result);
    }
    add_cells(&complex, &sides, &rest.borders, (plan, &facets, space), &mut result)?;
    result.end_owner();
    Some(result)
}

/// The facets that take part, with their planes.
fn active(rest: &Rest, operands: &[Facets], space: &mut Space) -> Facets {
    let mut facets = Facets::default();
    facets.reserve(rest.active.len());
    let mut active = rest.active.iter().peekable();
    for (owner, operand) in (0u32..).zip(operands) {
        while let Some(&&(_, facet)) = active.peek().filter(|a| a.0 == owner) {
            facets.push_copy(operand, facet, false);
            active.next();
        }
        facets.end_owner();
    }
    facets.find_planes(0..facets.list().len() as u32, space);
    facets
}

/// Keeps the shells that meet nothing and are in the result.
fn keep_shells(
    shells: &[Resting],
    operands: &[Facets],
    expression: &Expression,
    space: &Space,
    result: &mut Facets,
) -> Option<()> {
    if shells.is_empty() {
        return Some(());
    }
    let mut state = State::new(expression, operands.len());
    for shell in shells {
        let own = &operands[shell.owner as usize];
        let corners = shell.facets.iter().flat_map(|&f| own.loops(f).flatten().copied());
        let bases: Vec<u32> = corners.take(BASES).collect();
        let mut around = vec![];
        for (owner, operand) in (0u32..).zip(operands).filter(|o| o.0 != shell.owner) {
            if locate::is_inside(&bases, operand, space)? {
                around.push(owner);
            }
        }
        around.iter().for_each(|&owner| state.change(owner, 1));
        let before = state.inside();
        state.change(shell.owner, 1);
        let behind = state.inside();
        state.change(shell.owner, -1);
        around.iter().for_each(|&owner| state.change(owner, -1));
        keep(shell, [before, behind], operands, result);
    }
    Some(())
}

/// Corners of a shell from which rays are tried.
const BASES: usize = 16;

/// Keeps resting facets whose sides differ: the front, then the back.
fn keep(resting: &Resting, inside: [bool; 2], operands: &[Facets], result: &mut Facets) {
    if inside[0] != inside[1] {
        result.reserve(resting.facets.len());
        for &facet in &resting.facets {
            result.push_copy(&operands[resting.owner as usize], facet, inside[0]);
        }
    }
}

/// Adds the cells whose sides differ, merged where they are of one source in one plane. `None` where
/// that leaves an edge open.
fn add_cells(
    complex: &Complex,
    sides: &Sides,
    borders: &Borders,
    (plan, facets, space): (&Plan, &Facets, &Space),
    result: &mut Facets,
) -> Option<()> {
    let mut labels = Labels::exact(plan, facets);
    let boundary = Boundary::of(complex, sides, &mut labels);
    if boundary.is_open(borders) {
        return None;
    }
    let outline = Outline::of(&boundary, borders, complex, Once::Point);
    let dropped = outline.dropped((&boundary, borders), complex, space);
    let mut corners: Vec<(u32, u32)> = vec![];
    for run in outline.loops.chunk_by(|a, b| a.polygon == b.polygon) {
        for edge in run {
            let halves = outline.halves(edge);
            let is_kept = |half: u32| !dropped[outline.vertex[half as usize] as usize];
            let first = halves.iter().position(|&half| is_kept(half)).unwrap_or(0);
            let turned = || halves[first..].iter().chain(&halves[..first]).copied();
            corners.clear();
            for half in turned() {
                let support = complex.halves[half as usize].support;
                match corners.last_mut() {
                    Some(last) if !is_kept(half) && last.1 == NONE => last.1 = support,
                    Some(_) if !is_kept(half) => {}
                    _ => corners.push((boundary.origin[half as usize], support)),
                }
            }
            result.push_loop(corners.iter().copied());
        }
        let key = boundary.keys[run[0].polygon as usize].expect("a polygon is made of cells");
        let (flat, up) = key.plane();
        let plane = match flat {
            Flat::Exact(plane) => Some((plane, !up)),
            Flat::Source(..) | Flat::Piece(_) => None,
        };
        let source = source(run[0].polygon, &boundary, complex, facets);
        result.push(source, run.len(), plane, space);
    }
    Some(())
}

/// The face that a cell of the result is made of.
fn source(cell: u32, boundary: &Boundary, complex: &Complex, facets: &Facets) -> Source {
    let up = boundary.up[cell as usize].expect("a cell of the result has its outside on one side");
    let cover = complex.cover(cell);
    let &(facet, count) = cover.iter().find(|c| (c.1 > 0) == up).unwrap_or(&cover[0]);
    let source = facets.list()[facet as usize].source;
    Source { flipped: source.flipped != ((count > 0) != up), ..source }
}
