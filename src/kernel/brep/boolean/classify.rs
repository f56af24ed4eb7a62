//! Inside or outside: the two sides of every cell.
//!
//! Around every edge, cells that follow one another share a wedge of space, so their facing sides
//! belong to one region. Crossing a cell changes the winding number of each leaf by what covers the
//! cell. So one known region decides a whole connected component; it is the unbounded one, with the
//! winding numbers of the components around it (see `seed`).

use super::{
    cells::Complex, expression::Expression, expression::State, facet::Facets, frame::Leaf,
    patch::Patches, seed, space::Space, union_find::Sets,
};

/// What is known about the sides of cells. Side 2 c is above cell c, 2 c + 1 below it.
pub(super) struct Sides {
    /// Whether each side belongs to the result.
    pub inside: Vec<bool>,
    /// Half-edges in radial order around every edge with more than two of them, by edge.
    pub radial: Vec<(u32, Vec<u32>)>,
}

/// The side that a half-edge's cell turns to the wedge that follows counter-clockwise.
pub(super) fn following_side(complex: &Complex, half: u32) -> u32 {
    2 * complex.halves[half as usize].cell + u32::from(!complex.is_forward(half))
}

/// Classifies all sides; `None` if the leaves contradict each other, which means that one crosses
/// itself.
pub(super) fn classify(
    complex: &Complex,
    expression: &Expression,
    (leaves, patches): (&[Leaf], &Patches),
    facets: &mut Facets,
    space: &mut Space,
) -> Option<Sides> {
    let mut regions = Sets::new(2 * complex.cell_count());
    let mut components = Sets::new(complex.cell_count());
    let mut radial = vec![];
    for edge in 0..complex.edge_count() {
        let around = complex.around(edge);
        match *around {
            // Across the edge is a patch.
            [_] => continue,
            [half, back] => {
                link(half, back, complex, &mut regions, &mut components);
                link(back, half, complex, &mut regions, &mut components);
                continue;
            }
            _ => {}
        }
        let mut around = around.to_vec();
        complex.sort_radially(&mut around, facets, space);
        for (i, &half) in around.iter().enumerate() {
            let next = around[(i + 1) % around.len()];
            link(half, next, complex, &mut regions, &mut components);
        }
        radial.push((edge as u32, around));
    }
    link_patches(complex, patches, facets, &mut regions, &mut components);
    let surroundings = seed::Surroundings { complex, leaves, patches, radial: &radial };
    let seeds = surroundings.seeds(&mut components, facets, space);
    let mut spread = Spread::new(complex, regions, expression, leaves.len(), facets);
    for seed in &seeds {
        spread.flood(seed);
    }
    spread.is_consistent().then(|| Sides { inside: spread.sides(), radial })
}

/// Joins what faces the wedge between a half-edge and the one that follows it around their edge.
fn link(half: u32, next: u32, complex: &Complex, regions: &mut Sets, components: &mut Sets) {
    regions.join(following_side(complex, half), following_side(complex, next) ^ 1);
    components.join(complex.halves[half as usize].cell, complex.halves[next as usize].cell);
}

/// Joins the sides of patches to those of the cells that have corners in them. Nothing else is near
/// such a corner, so all cells there are pieces of one surface.
fn link_patches(
    complex: &Complex,
    patches: &Patches,
    facets: &Facets,
    regions: &mut Sets,
    components: &mut Sets,
) {
    if patches.list.is_empty() {
        return;
    }
    for half in &complex.halves {
        let Some(patch) = facets.patch(half.origin, patches) else { continue };
        let (cell, patch) = (half.cell, complex.first_patch + patch);
        let faces_down = u32::from(complex.cover(cell)[0].1 < 0);
        regions.join(2 * patch, 2 * cell + faces_down);
        regions.join(2 * patch + 1, 2 * cell + 1 - faces_down);
        components.join(patch, cell);
    }
}

/// Winding numbers on their way from region to region.
struct Spread<'a> {
    complex: &'a Complex,
    facets: &'a Facets,
    /// The region of each side.
    region: Vec<u32>,
    /// The sides of each region.
    members: Vec<u32>,
    member_ends: Vec<u32>,
    state: State,
    inside: Vec<bool>,
    /// A number that stands for the winding numbers of a region, once reached.
    digest: Vec<Option<u64>>,
}

impl<'a> Spread<'a> {
    fn new(
        complex: &'a Complex,
        mut sets: Sets,
        expression: &Expression,
        leaves: usize,
        facets: &'a Facets,
    ) -> Spread<'a> {
        let sides = 2 * complex.cell_count();
        let region: Vec<u32> = (0..sides as u32).map(|s| sets.find(s)).collect();
        let mut member_ends = vec![0u32; sides + 1];
        region.iter().for_each(|&r| member_ends[r as usize + 1] += 1);
        (0..sides).for_each(|i| member_ends[i + 1] += member_ends[i]);
        let mut fill = member_ends.clone();
        let mut members = vec![0; sides];
        for (side, &r) in (0u32..).zip(&region) {
            members[fill[r as usize] as usize] = side;
            fill[r as usize] += 1;
        }
        let state = State::new(expression, leaves);
        let (inside, digest) = (vec![false; sides], vec![None; sides]);
        Spread { complex, facets, region, members, member_ends, state, inside, digest }
    }

    /// Crosses the cell of a side, away from the side; returns the change of the digest.
    fn cross(&mut self, side: u32) -> u64 {
        let down = side & 1 == 0;
        let mut digest = 0u64;
        for &(facet, count) in self.complex.cover(side / 2) {
            let leaf = self.facets.list()[facet as usize].leaf;
            let delta = if down { count } else { -count };
            self.state.change(leaf, delta);
            digest = digest.wrapping_add(key(leaf).wrapping_mul(delta as i64 as u64));
        }
        digest
    }

    /// Visits all regions of a component, going out and coming back along a tree of crossings.
    fn flood(&mut self, seed: &seed::Seed) {
        let mut digest = 0u64;
        for &(leaf, winding) in &seed.around {
            self.state.change(leaf, winding);
            digest = digest.wrapping_add(key(leaf).wrapping_mul(winding as i64 as u64));
        }
        self.visit(self.region[seed.side as usize], digest);
        for &(leaf, winding) in &seed.around {
            self.state.change(leaf, -winding);
        }
    }

    fn visit(&mut self, start: u32, digest: u64) {
        self.enter(start, digest);
        // The region, its next member to look at, and the side through which it was entered.
        let mut path = vec![(start, self.member_ends[start as usize], u32::MAX)];
        while let Some((region, at, door)) = path.last_mut() {
            if *at == self.member_ends[*region as usize + 1] {
                let door = *door;
                path.pop();
                if door != u32::MAX {
                    self.cross(door);
                }
                continue;
            }
            let side = self.members[*at as usize];
            *at += 1;
            let (here, there) = (*region, self.region[side as usize ^ 1]);
            if self.digest[there as usize].is_none() {
                let before = self.digest[here as usize].unwrap_or(0);
                let digest = before.wrapping_add(self.cross(side));
                self.enter(there, digest);
                path.push((there, self.member_ends[there as usize], side ^ 1));
            }
        }
    }

    fn enter(&mut self, region: u32, digest: u64) {
        self.digest[region as usize] = Some(digest);
        self.inside[region as usize] = self.state.inside();
    }

    /// Whether crossing any cell leads from the numbers of one region to those of the other.
    fn is_consistent(&mut self) -> bool {
        let digest =
            |spread: &Spread<'_>, side: u32| spread.digest[spread.region[side as usize] as usize];
        (0..self.complex.cell_count() as u32).all(|cell| {
            let change = self.complex.cover(cell).iter().fold(0u64, |sum, &(facet, count)| {
                let leaf = self.facets.list()[facet as usize].leaf;
                sum.wrapping_add(key(leaf).wrapping_mul(count as i64 as u64))
            });
            let (above, below) = (digest(self, 2 * cell), digest(self, 2 * cell + 1));
            above.is_some() && above.map(|d| d.wrapping_add(change)) == below
        })
    }

    fn sides(&self) -> Vec<bool> {
        self.region.iter().map(|&r| self.inside[r as usize]).collect()
    }
}

/// A random odd number for a leaf (SplitMix64): sums of multiples of them stand for vectors of
/// winding numbers.
fn key(leaf: u32) -> u64 {
    let mut z = (u64::from(leaf) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) | 1
}
