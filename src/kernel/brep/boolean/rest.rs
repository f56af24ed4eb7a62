//! What of its operands a stage leaves alone.
//!
//! Facets whose boxes meet no box of another operand's facet need no arrangement. Those that hang
//! together at points and border on facets that do take part are a patch: what holds at the border
//! holds for the patch. Those that border on nothing are a shell of their own.

use super::{
    super::threads,
    facet::Facets,
    grid::Grid,
    hierarchy::{Bounds, Hierarchy},
    patch::Borders,
    space::{NONE, Space},
    union_find::Sets,
};

/// Facets of one operand that hang together and rest.
pub(super) struct Resting {
    /// The operand.
    pub owner: u32,
    /// Their numbers there.
    pub facets: Vec<u32>,
}

/// How the facets of operands are shared out.
pub(super) struct Rest {
    /// Facets that take part, as operand and number there, in order.
    pub active: Vec<(u32, u32)>,
    /// Pairs of them whose boxes touch, by their places in that order.
    pub pairs: Vec<(u32, u32)>,
    /// What rests next to facets that take part.
    pub patches: Vec<Resting>,
    /// What rests and borders on nothing.
    pub shells: Vec<Resting>,
    /// The patch that each point borders on.
    pub borders: Borders,
}

impl Rest {
    /// Shares out the facets of the operands, each with one owner.
    pub fn of(operands: &[Facets], space: &Space) -> Rest {
        let touching = touching(operands);
        let mut numbers: Vec<Vec<u32>> =
            operands.iter().map(|o| vec![NONE; o.list().len()]).collect();
        for &[a, b] in &touching {
            numbers[a.0 as usize][a.1 as usize] = 0;
            numbers[b.0 as usize][b.1 as usize] = 0;
        }
        let mut active = vec![];
        for (owner, numbers) in (0u32..).zip(&mut numbers) {
            for (facet, number) in (0u32..).zip(numbers).filter(|n| *n.1 != NONE) {
                *number = active.len() as u32;
                active.push((owner, facet));
            }
        }
        let place = |(owner, facet): (u32, u32)| numbers[owner as usize][facet as usize];
        let pairs = touching.into_iter().map(|[a, b]| (place(a), place(b))).collect();
        let borders = Borders(vec![NONE; space.point_count()]);
        let mut rest = Rest { active, pairs, patches: vec![], shells: vec![], borders };
        for (owner, numbers) in (0u32..).zip(&numbers) {
            rest.share(owner, &operands[owner as usize], numbers);
        }
        rest
    }

    /// Groups the resting facets of an operand.
    fn share(&mut self, owner: u32, facets: &Facets, numbers: &[u32]) {
        // A resting facet at each point, until all are in groups; then the group.
        let holder = &mut self.borders.0;
        let count = numbers.len() as u32;
        let mut sets = Sets::new(numbers.len());
        for facet in (0..count).filter(|&f| numbers[f as usize] == NONE) {
            let mut least = facet;
            for &point in facets.loops(facet).flatten() {
                match &mut holder[point as usize] {
                    slot if *slot == NONE => *slot = least,
                    slot => least = sets.join_least(least, *slot),
                }
            }
        }
        let mut borders = vec![false; numbers.len()];
        for facet in (0..count).filter(|&f| numbers[f as usize] != NONE) {
            for &point in facets.loops(facet).flatten() {
                let held = holder[point as usize];
                if held != NONE {
                    borders[sets.find(held) as usize] = true;
                }
            }
        }
        // The group of each set, by its least facet.
        let mut groups = vec![NONE; numbers.len()];
        for facet in (0..count).filter(|&f| numbers[f as usize] == NONE) {
            let root = sets.find(facet) as usize;
            let list = if borders[root] { &mut self.patches } else { &mut self.shells };
            if groups[root] == NONE {
                groups[root] = list.len() as u32;
                list.push(Resting { owner, facets: vec![] });
            }
            list[groups[root] as usize].facets.push(facet);
        }
        for facet in (0..count).filter(|&f| numbers[f as usize] == NONE) {
            let root = sets.find(facet) as usize;
            let group = if borders[root] { groups[root] } else { NONE };
            facets.loops(facet).flatten().for_each(|&p| holder[p as usize] = group);
        }
    }
}

/// Pairs of facets of different operands, the first with less numbers, whose boxes touch.
fn touching(operands: &[Facets]) -> Vec<[(u32, u32); 2]> {
    let around: Vec<Bounds> = operands.iter().map(Facets::bounds).collect();
    let mut owners = vec![];
    Hierarchy::new(around.iter().copied()).own_pairs(|a, b| owners.push((a, b)));
    let is_large = operands.iter().map(|o| o.list().len()).sum::<usize>() > LARGE;
    let touching = |&(a, b): &(u32, u32)| {
        let mut near_a = near(&operands[a as usize], &around[b as usize]);
        let mut near_b = near(&operands[b as usize], &around[a as usize]);
        if near_a.len().min(near_b.len()) > FEW {
            thin_out(&mut near_a, &near_b, around[b as usize]);
            thin_out(&mut near_b, &near_a, around[a as usize]);
        }
        let tree = |near: &[(Bounds, u32)]| Hierarchy::new(near.iter().map(|n| n.0));
        let (tree_a, tree_b) = match is_large {
            true => threads::both(|| tree(&near_a), || tree(&near_b)),
            false => (tree(&near_a), tree(&near_b)),
        };
        let mut found = vec![];
        tree_a.pairs(&tree_b, |f, g| {
            found.push([(a, near_a[f as usize].1), (b, near_b[g as usize].1)]);
        });
        found
    };
    if !is_large {
        return owners.iter().flat_map(touching).collect();
    }
    threads::each(&owners, touching).concat()
}

/// So many facets of all operands are worth a second thread.
const LARGE: usize = 1500;

/// So few facets are not worth a grid.
const FEW: usize = 48;

/// Leaves out what is not near any of the others, which are in the given box.
fn thin_out(list: &mut Vec<(Bounds, u32)>, others: &[(Bounds, u32)], around: Bounds) {
    let mut grid = Grid::new(around);
    others.iter().for_each(|other| grid.mark(&other.0));
    list.retain(|own| grid.meets(&own.0));
}

/// The facets whose boxes meet a box.
fn near(facets: &Facets, bounds: &Bounds) -> Vec<(Bounds, u32)> {
    let list = facets.list().iter().map(|f| f.bounds).zip(0u32..);
    list.filter(|(own, _)| own.meets(bounds)).collect()
}
