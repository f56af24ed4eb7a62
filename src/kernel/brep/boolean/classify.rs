//! Inside or outside: the two sides of every cell.
//!
//! Around every edge, cells that follow one another share a wedge of space, so their facing sides
//! belong to one region. Crossing a cell changes the winding number of each operand by what covers the
//! cell. So one known region decides a whole connected component; it is the unbounded one, with the
//! winding numbers of the components around it (see `seed`).

use super::{
    cells::Complex,
    expression::Expression,
    expression::State,
    facet::Facets,
    patch::Borders,
    region::{Regions, Visitor},
    seed::Seed,
    space::Space,
    union_find::Sets,
};

/// How the sides of cells hang together. Side 2 c is above cell c, 2 c + 1 below it.
pub(super) struct Links {
    /// Sides that face one region of space.
    pub regions: Sets,
    /// Cells that meet along edges.
    pub components: Sets,
    /// Half-edges in radial order around every edge with more than two of them, by edge.
    pub radial: Vec<(u32, Vec<u32>)>,
}

/// What is known about the sides of cells.
pub(super) struct Sides {
    /// Whether each side belongs to the result.
    pub inside: Vec<bool>,
    /// Half-edges in radial order around every edge with more than two of them, by edge.
    pub radial: Vec<(u32, Vec<u32>)>,
}

impl Sides {
    /// What is known of a closed surface all of whose cells face up.
    pub fn of_surface(complex: &Complex, links: Links) -> Sides {
        let sides = 0..2 * complex.cell_count();
        Sides { inside: sides.map(|side| side & 1 == 1).collect(), radial: links.radial }
    }
}

/// The side that a half-edge's cell turns to the wedge that follows counter-clockwise.
pub(super) fn following_side(complex: &Complex, half: u32) -> u32 {
    2 * complex.halves[half as usize].cell + u32::from(!complex.is_forward(half))
}

impl Links {
    /// Finds what hangs together around edges, and by patches at points.
    pub fn of(
        complex: &Complex,
        borders: &Borders,
        facets: &mut Facets,
        space: &mut Space,
    ) -> Links {
        let (regions, components) =
            (Sets::new(2 * complex.cell_count()), Sets::new(complex.cell_count()));
        let mut links = Links { regions, components, radial: vec![] };
        for edge in 0..complex.edge_count() {
            let around = complex.around(edge);
            match *around {
                // Across the edge is a patch.
                [_] => continue,
                [half, back] => {
                    links.link(half, back, complex);
                    links.link(back, half, complex);
                    continue;
                }
                _ => {}
            }
            let mut around = around.to_vec();
            complex.sort_radially(&mut around, facets, space);
            for (i, &half) in around.iter().enumerate() {
                links.link(half, around[(i + 1) % around.len()], complex);
            }
            links.radial.push((edge as u32, around));
        }
        links.link_patches(complex, borders);
        links
    }

    /// Joins what faces the wedge between a half-edge and the one that follows it around their edge.
    fn link(&mut self, half: u32, next: u32, complex: &Complex) {
        let sides = (following_side(complex, half), following_side(complex, next) ^ 1);
        self.regions.join(sides.0, sides.1);
        let cell = |half: u32| complex.halves[half as usize].cell;
        self.components.join(cell(half), cell(next));
    }

    /// Joins the sides of patches to those of the cells that have corners in them. Nothing else is
    /// near such a corner, so all cells there are pieces of one surface.
    fn link_patches(&mut self, complex: &Complex, borders: &Borders) {
        if complex.first_patch as usize == complex.cell_count() {
            return;
        }
        for half in &complex.halves {
            let Some(patch) = borders.patch(half.origin) else { continue };
            let (cell, patch) = (half.cell, complex.first_patch + patch);
            let faces_down = u32::from(complex.cover(cell)[0].1 < 0);
            self.regions.join(2 * patch, 2 * cell + faces_down);
            self.regions.join(2 * patch + 1, 2 * cell + 1 - faces_down);
            self.components.join(patch, cell);
        }
    }
}

/// Classifies all sides by what is known of one side of every component; `None` if the operands
/// contradict each other, which means that one crosses itself.
pub(super) fn classify(
    regions: &Regions,
    radial: Vec<(u32, Vec<u32>)>,
    seeds: &[Seed],
    expression: &Expression,
    facets: &Facets,
) -> Option<Sides> {
    let sides = 2 * regions.complex.cell_count();
    let mut spread = Spread {
        regions,
        facets,
        state: State::new(expression, facets.owner_count()),
        inside: vec![false; sides],
        here: 0,
        digest: vec![None; sides],
    };
    for seed in seeds {
        spread.flood(seed);
    }
    spread.is_consistent().then(|| Sides { inside: spread.sides(), radial })
}

/// Winding numbers on their way from region to region.
struct Spread<'a> {
    regions: &'a Regions<'a>,
    facets: &'a Facets,
    state: State,
    inside: Vec<bool>,
    /// A number that stands for the winding numbers here.
    here: u64,
    /// The same for each region, once reached.
    digest: Vec<Option<u64>>,
}

impl Visitor for Spread<'_> {
    fn cross(&mut self, side: u32) {
        let down = side & 1 == 0;
        for &(facet, count) in self.regions.complex.cover(side / 2) {
            let owner = self.facets.list()[facet as usize].owner;
            self.change(owner, if down { count } else { -count });
        }
    }

    fn is_new(&self, region: u32) -> bool {
        self.digest[region as usize].is_none()
    }

    fn enter(&mut self, region: u32) -> bool {
        self.digest[region as usize] = Some(self.here);
        self.inside[region as usize] = self.state.inside();
        true
    }
}

impl Spread<'_> {
    fn change(&mut self, owner: u32, delta: i32) {
        self.state.change(owner, delta);
        self.here = self.here.wrapping_add(key(owner).wrapping_mul(delta as i64 as u64));
    }

    /// Visits all regions of a component, going out and coming back along a tree of crossings.
    fn flood(&mut self, seed: &Seed) {
        for &(owner, winding) in &seed.around {
            self.change(owner, winding);
        }
        self.regions.walk(seed.side, self);
        for &(owner, winding) in &seed.around {
            self.change(owner, -winding);
        }
    }

    /// Whether crossing any cell leads from the numbers of one region to those of the other.
    fn is_consistent(&self) -> bool {
        let digest = |side: u32| self.digest[self.regions.of(side) as usize];
        let complex = self.regions.complex;
        (0..complex.cell_count() as u32).all(|cell| {
            let change = complex.cover(cell).iter().fold(0u64, |sum, &(facet, count)| {
                let owner = self.facets.list()[facet as usize].owner;
                sum.wrapping_add(key(owner).wrapping_mul(count as i64 as u64))
            });
            let (above, below) = (digest(2 * cell), digest(2 * cell + 1));
            above.is_some() && above.map(|d| d.wrapping_add(change)) == below
        })
    }

    fn sides(&self) -> Vec<bool> {
        let sides = 0..2 * self.regions.complex.cell_count() as u32;
        sides.map(|side| self.inside[self.regions.of(side) as usize]).collect()
    }
}

/// A random odd number for an operand (SplitMix64): sums of multiples of them stand for vectors of
/// winding numbers.
fn key(owner: u32) -> u64 {
    let mut z = (u64::from(owner) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) | 1
}
