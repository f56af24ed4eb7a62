//! Which cells bound the result, how they are linked along edges, and which are one polygon.
//!
//! Around an edge where more than two cells are left, those two that bound the same wedge of the
//! inside are linked, so solids that touch in an edge come apart.

use super::{
    cells::Complex,
    classify::{Sides, following_side},
    origins::{Key, Labels},
    patch::Borders,
    space::NONE,
    union_find::Sets,
};

/// The half-edges of the result, numbered as in the complex. Those of cells whose outside is below
/// run the other way. Entries outside the result are [`NONE`].
pub(super) struct Boundary {
    /// Where each half-edge starts.
    pub origin: Vec<u32>,
    /// The place of that point among those of the complex.
    pub at: Vec<u32>,
    /// What follows it around its cell.
    pub next: Vec<u32>,
    /// The half-edge that runs back along the same edge; [`NONE`] where a patch borders.
    pub twin: Vec<u32>,
    /// The merged polygon of each half-edge, known by one of its cells.
    pub polygon: Vec<u32>,
    /// What each cell is made of.
    pub keys: Vec<Option<Key>>,
    /// For each cell whether it is in the result, and then whether the outside is above.
    pub up: Vec<Option<bool>>,
    /// Whether the result touches itself along an edge.
    pub touches: bool,
}

impl Boundary {
    /// The boundary of the result.
    pub fn of(complex: &Complex, sides: &Sides, labels: &mut Labels<'_>) -> Boundary {
        let up: Vec<Option<bool>> = (0..complex.cell_count())
            .map(|c| {
                let at = 2 * c;
                (sides.inside[at] != sides.inside[at + 1]).then_some(sides.inside[at + 1])
            })
            .collect();
        let cells = 0..complex.first_patch;
        let keys: Vec<Option<Key>> =
            cells.map(|c| up[c as usize].map(|up| labels.key(complex, c, up))).collect();
        let (origin, at, next) = directed(complex, &up);
        let (mut twin, crowded) = twins(complex, sides, &up);
        let polygon = polygons(complex, &twin, &keys);
        for around in &crowded {
            link_crowded(around, complex, sides, &polygon, &mut twin);
        }
        Boundary { origin, at, next, twin, polygon, keys, up, touches: !crowded.is_empty() }
    }

    /// Whether something is missing along an edge: what should bound the result is open there.
    pub fn is_open(&self, borders: &Borders) -> bool {
        let mut outer = self.outer().filter(|&half| self.twin[half as usize] == NONE);
        outer.any(|half| borders.patch(self.origin[half as usize]).is_none())
    }

    /// Whether a half-edge runs inside a merged polygon.
    pub fn is_inner(&self, half: u32) -> bool {
        let twin = self.twin[half as usize];
        twin != NONE && self.polygon[half as usize] == self.polygon[twin as usize]
    }

    /// The half-edges that bound merged polygons.
    pub fn outer(&self) -> impl Iterator<Item = u32> + '_ {
        let halves = 0..self.twin.len() as u32;
        halves.filter(|&h| self.origin[h as usize] != NONE && !self.is_inner(h))
    }
}

/// Origins, their places, and successors of half-edges, turned around in cells that face down.
fn directed(complex: &Complex, up: &[Option<bool>]) -> (Vec<u32>, Vec<u32>, Vec<u32>) {
    let count = complex.halves.len();
    let [mut origin, mut at, mut next] = [0; 3].map(|_| vec![NONE; count]);
    for (number, half) in (0u32..).zip(&complex.halves) {
        match up[half.cell as usize] {
            Some(true) => {
                origin[number as usize] = half.origin;
                at[number as usize] = half.at;
                next[number as usize] = half.next;
            }
            Some(false) => {
                let target = &complex.halves[half.next as usize];
                origin[number as usize] = target.origin;
                at[number as usize] = target.at;
                next[half.next as usize] = number;
            }
            None => {}
        }
    }
    (origin, at, next)
}

/// The links along edges with two half-edges of the result, and the half-edges along all others, in
/// radial order.
fn twins(complex: &Complex, sides: &Sides, up: &[Option<bool>]) -> (Vec<u32>, Vec<Vec<u32>>) {
    let mut twin = vec![NONE; complex.halves.len()];
    let mut crowded = vec![];
    let mut radial = sides.radial.iter().peekable();
    let mut kept = vec![];
    for edge in 0..complex.edge_count() {
        let sorted = radial.next_if(|r| r.0 == edge as u32);
        let around = sorted.map_or(complex.around(edge), |r| &r.1).iter().copied();
        kept.clear();
        kept.extend(around.filter(|&h| up[complex.halves[h as usize].cell as usize].is_some()));
        match kept[..] {
            // A patch is on the other side of a single one.
            [] | [_] => {}
            [a, b] => (twin[a as usize], twin[b as usize]) = (b, a),
            _ => crowded.push(kept.clone()),
        }
    }
    (twin, crowded)
}

/// Links the half-edges along an edge where the result touches itself: those that bound the same
/// wedge of the inside, unless a polygon would be slit by that; then those that bound the same wedge
/// of the outside.
fn link_crowded(
    around: &[u32],
    complex: &Complex,
    sides: &Sides,
    polygon: &[u32],
    twin: &mut [u32],
) {
    let pairs = || around.iter().zip(around.iter().cycle().skip(1));
    let before_inside = |half: u32| sides.inside[following_side(complex, half) as usize];
    let slit =
        pairs().any(|(&a, &b)| !before_inside(a) && polygon[a as usize] == polygon[b as usize]);
    for (&a, &b) in pairs().filter(|p| before_inside(*p.0) != slit) {
        (twin[a as usize], twin[b as usize]) = (b, a);
    }
}

/// Joins equal cells across edges where nothing else is. Where the result touches itself an edge
/// stays, so that all that touches there has it.
fn polygons(complex: &Complex, twin: &[u32], keys: &[Option<Key>]) -> Vec<u32> {
    let cell = |half: u32| complex.halves[half as usize].cell;
    let mut sets = Sets::new(complex.cell_count());
    for (half, &back) in (0u32..).zip(twin) {
        if back != NONE && keys[cell(half) as usize] == keys[cell(back) as usize] {
            sets.join(cell(half), cell(back));
        }
    }
    complex.halves.iter().map(|half| sets.find(half.cell)).collect()
}
