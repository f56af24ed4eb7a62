//! Regions of space between cells, and walks from region to region through the cells.

use super::{cells::Complex, union_find::Sets};

/// The regions that the sides of cells face. A region is known by one of its sides.
pub(super) struct Regions<'a> {
    /// The cells.
    pub complex: &'a Complex,
    /// The region of each side.
    of_side: Vec<u32>,
    /// The sides of each region, and one past the last of those before a region.
    members: Vec<u32>,
    member_ends: Vec<u32>,
}

/// What a walk through regions does on its way.
pub(super) trait Visitor {
    /// Goes through the cell of a side, away from the side.
    fn cross(&mut self, side: u32);

    /// Whether a region was not entered before.
    fn is_new(&self, region: u32) -> bool;

    /// Comes to a region; the walk ends where the answer is no.
    fn enter(&mut self, region: u32) -> bool;
}

impl<'a> Regions<'a> {
    /// The regions, given which sides face the same one.
    pub fn of_sets(complex: &'a Complex, sets: &mut Sets) -> Regions<'a> {
        let sides = 2 * complex.cell_count();
        let of_side: Vec<u32> = (0..sides as u32).map(|s| sets.find(s)).collect();
        let mut member_ends = vec![0u32; sides + 1];
        of_side.iter().for_each(|&r| member_ends[r as usize + 1] += 1);
        (0..sides).for_each(|i| member_ends[i + 1] += member_ends[i]);
        let mut fill = member_ends.clone();
        let mut members = vec![0; sides];
        for (side, &r) in (0u32..).zip(&of_side) {
            members[fill[r as usize] as usize] = side;
            fill[r as usize] += 1;
        }
        Regions { complex, of_side, members, member_ends }
    }

    /// The region that a side faces.
    pub fn of(&self, side: u32) -> u32 {
        self.of_side[side as usize]
    }

    /// The sides that face a region.
    pub fn members(&self, region: u32) -> &[u32] {
        let [start, end] = [0, 1].map(|i| self.member_ends[region as usize + i] as usize);
        &self.members[start..end]
    }

    /// Visits all regions of a component from the one that `side` faces, going out and coming back
    /// along a tree of crossings.
    pub fn walk(&self, side: u32, visitor: &mut impl Visitor) {
        let start = self.of(side);
        if !visitor.enter(start) {
            return;
        }
        // The region, its next member to look at, and the side through which it was entered.
        let mut path = vec![(start, self.member_ends[start as usize], u32::MAX)];
        while let Some((region, at, door)) = path.last_mut() {
            if *at == self.member_ends[*region as usize + 1] {
                let door = *door;
                path.pop();
                if door != u32::MAX {
                    visitor.cross(door);
                }
                continue;
            }
            let side = self.members[*at as usize];
            *at += 1;
            let there = self.of(side ^ 1);
            if visitor.is_new(there) {
                visitor.cross(side);
                if !visitor.enter(there) {
                    return;
                }
                path.push((there, self.member_ends[there as usize], side ^ 1));
            }
        }
    }
}
