//! Where the components of a stage stand: the winding numbers around each.
//!
//! Every operand of a stage is a closed surface that winds once around what it encloses. So in front
//! of a facet its operand has the winding number 0, behind it 1. For operands that have no facet in
//! a component, a ray counts crossings; doubles decide only where they are certain, and where no ray
//! from any corner is certain the stage is given up.

use super::{
    cells::Complex,
    classify::Links,
    facet::Facets,
    hierarchy::Bounds,
    polygon,
    region::{Regions, Visitor},
    seed::Seed,
    space::Space,
};
use crate::geom::predicates::Plane;

/// What is known of every component; `None` if a place cannot be told.
pub(super) fn seeds(
    regions: &Regions,
    links: &mut Links,
    operands: &[Facets],
    facets: &Facets,
    space: &Space,
) -> Option<Vec<Seed>> {
    let complex = regions.complex;
    let mut components = Components::of(complex, links, facets);
    // The start is best where several operands meet.
    for (_, around) in links.radial.iter().rev() {
        let cell = complex.halves[around[0] as usize].cell;
        let root = links.components.find(cell) as usize;
        components.start[root] = cell;
    }
    let mut seeds = vec![];
    for (root, owners) in components.owners.iter().enumerate().filter(|o| !o.1.is_empty()) {
        let side = 2 * components.start[root];
        let mut bearings = Bearings::new(regions, facets, owners.len());
        regions.walk(side, &mut bearings);
        let mut around = bearings.found;
        let bases = components.points(root, complex, links);
        for (owner, operand) in (0u32..).zip(operands) {
            if owners.binary_search(&owner).is_err() {
                let winding = i32::from(is_inside(&bases, operand, space)?);
                around.push((owner, winding));
            }
        }
        around.retain(|a| a.1 != 0);
        seeds.push(Seed { side, around });
    }
    Some(seeds)
}

/// The components: which operands have facets in each, and a cell to start from. Known by their
/// least cell.
struct Components {
    owners: Vec<Vec<u32>>,
    start: Vec<u32>,
}

impl Components {
    fn of(complex: &Complex, links: &mut Links, facets: &Facets) -> Components {
        let count = complex.cell_count();
        let mut owners: Vec<Vec<u32>> = vec![vec![]; count];
        for cell in 0..count as u32 {
            let list = &mut owners[links.components.find(cell) as usize];
            for &(facet, _) in complex.cover(cell) {
                let owner = facets.list()[facet as usize].owner;
                if let Err(place) = list.binary_search(&owner) {
                    list.insert(place, owner);
                }
            }
        }
        Components { owners, start: (0..count as u32).collect() }
    }

    /// Some points of a component.
    fn points(&self, root: usize, complex: &Complex, links: &mut Links) -> Vec<u32> {
        let of = |half: &&super::cells::Half| links.components.find(half.cell) as usize == root;
        let mut points: Vec<u32> =
            complex.halves.iter().filter(of).map(|half| half.origin).take(BASES).collect();
        points.sort_unstable();
        points.dedup();
        points
    }
}

/// Corners from which rays are tried.
const BASES: usize = 24;

/// The winding numbers at the start of a walk, found where it comes to facets.
struct Bearings<'a> {
    regions: &'a Regions<'a>,
    facets: &'a Facets,
    wanted: usize,
    /// Winding numbers here less those at the start.
    change: Vec<i32>,
    entered: Vec<bool>,
    found: Vec<(u32, i32)>,
}

impl<'a> Bearings<'a> {
    fn new(regions: &'a Regions<'a>, facets: &'a Facets, wanted: usize) -> Bearings<'a> {
        let change = vec![0; facets.owner_count()];
        let entered = vec![false; 2 * regions.complex.cell_count()];
        Bearings { regions, facets, wanted, change, entered, found: vec![] }
    }

    /// How often each operand covers a cell upwards.
    fn cover(&self, cell: u32) -> impl Iterator<Item = (u32, i32)> + use<'a> {
        let facets = self.facets;
        let cover = self.regions.complex.cover(cell).iter();
        cover.map(|&(facet, count)| (facets.list()[facet as usize].owner, count))
    }
}

impl Visitor for Bearings<'_> {
    fn cross(&mut self, side: u32) {
        let down = side & 1 == 0;
        for &(facet, count) in self.regions.complex.cover(side / 2) {
            let owner = self.facets.list()[facet as usize].owner;
            self.change[owner as usize] += if down { count } else { -count };
        }
    }

    fn is_new(&self, region: u32) -> bool {
        !self.entered[region as usize]
    }

    fn enter(&mut self, region: u32) -> bool {
        self.entered[region as usize] = true;
        for &side in self.regions.members(region) {
            for (owner, _) in self.cover(side / 2) {
                if self.found.iter().any(|f| f.0 == owner) {
                    continue;
                }
                let own = self.cover(side / 2).filter(|c| c.0 == owner);
                let here = match (own.map(|c| c.1).sum::<i32>(), side & 1) {
                    (1, 0) | (-1, 1) => 0,
                    (1, _) | (-1, _) => 1,
                    _ => continue,
                };
                self.found.push((owner, here - self.change[owner as usize]));
            }
        }
        self.found.len() < self.wanted
    }
}

/// Directions of rays, by their slopes in y and z along x.
const SLOPES: [[f64; 2]; 3] = [[0.083_21, 0.047_93], [-0.061_37, 0.092_71], [0.029_83, -0.078_59]];

/// Whether an operand that does not meet a connected surface encloses it, given some of its points.
pub(super) fn is_inside(bases: &[u32], operand: &Facets, space: &Space) -> Option<bool> {
    let around = operand.bounds();
    if bases.iter().any(|&base| !around.meets(&space.bounds(base))) {
        return Some(false);
    }
    let rays = SLOPES.iter().flat_map(|&slope| bases.iter().map(move |&base| Ray { base, slope }));
    let mut decided = rays.filter_map(|ray| ray.winding(operand, space));
    decided.next().and_then(|winding| match winding {
        0 => Some(false),
        1 => Some(true),
        _ => None,
    })
}

/// A ray towards +x, slightly askew.
struct Ray {
    base: u32,
    slope: [f64; 2],
}

/// How far the shadow of a corner along a ray may be from where doubles say it is, in steps:
/// coordinates below 2^30 are known to 2^-20, and slopes are small.
const SHADOW: f64 = 1.0 / (1u64 << 18) as f64;

impl Ray {
    /// The winding number of a surface around the base; `None` where doubles leave it open.
    fn winding(&self, facets: &Facets, space: &Space) -> Option<i32> {
        let base = space.near(self.base);
        let mut winding = 0;
        for (number, facet) in (0u32..).zip(facets.list()) {
            if self.passes(&facet.bounds, base)
                && self.shadow_covers(number, facets, base, space)?
            {
                winding += self.crossing(number, facets, space)?;
            }
        }
        Some(winding)
    }

    /// Whether the ray may meet a box.
    fn passes(&self, bounds: &Bounds, base: [f64; 3]) -> bool {
        let far = f64::from(bounds.max[0]) - base[0];
        far >= -1.0
            && (0..2).all(|i| {
                let (low, high) = (f64::from(bounds.min[i + 1]), f64::from(bounds.max[i + 1]));
                let drift = self.slope[i] * far.max(0.0);
                base[i + 1] + drift.max(0.0) + 1.0 >= low
                    && base[i + 1] + drift.min(0.0) - 1.0 <= high
            })
    }

    /// Where a point is, seen along the ray from its base.
    fn shadow(&self, point: u32, base: [f64; 3], space: &Space) -> [f64; 2] {
        let at = space.near(point);
        let ahead = at[0] - base[0];
        [0, 1].map(|i| (at[i + 1] - base[i + 1]) - self.slope[i] * ahead)
    }

    /// Whether a facet is seen along the ray's line: an odd number of its edges run above.
    fn shadow_covers(
        &self,
        facet: u32,
        facets: &Facets,
        base: [f64; 3],
        space: &Space,
    ) -> Option<bool> {
        let mut odd = false;
        for (a, b) in facets.edges(facet) {
            let [p, q] = [a, b].map(|point| self.shadow(point, base, space));
            if p[0].abs() < SHADOW || q[0].abs() < SHADOW {
                return None;
            }
            if (p[0] > 0.0) == (q[0] > 0.0) {
                continue;
            }
            let turn = p[0] * q[1] - p[1] * q[0];
            let size = p[0].abs() + p[1].abs() + q[0].abs() + q[1].abs();
            if turn.abs() < 2.0 * SHADOW * size {
                return None;
            }
            odd ^= (turn > 0.0) == (p[0] > 0.0);
        }
        Some(odd)
    }

    /// What the winding number changes by where the ray meets a facet that it is seen to cover: 1
    /// where it leaves, -1 where it enters, 0 if the facet is behind.
    fn crossing(&self, facet: u32, facets: &Facets, space: &Space) -> Option<i32> {
        let (side, normal) = match facets.known_plane(facet) {
            Some((plane, turned)) => {
                let sign = if turned { -1 } else { 1 };
                let normal = space.plane(plane).normal.map(|c| c as f64 * f64::from(sign));
                (space.side(self.base, plane) * sign, normal)
            }
            None => {
                let at =
                    |p: u32| space.lattice_point(p).expect("a facet without plane is of a leaf");
                let area = polygon::area_vector(facets.loops(facet), &at);
                let first = facets.loops(facet).next().map_or([0; 3], |l| at(l[0]));
                let (plane, turned) = Plane::through(area, first)?;
                let sign = if turned { -1 } else { 1 };
                (plane.side_of(&space.exact(self.base)) * sign, area.map(|c| c as f64))
            }
        };
        let [x, y, z] = normal;
        let along = x + y * self.slope[0] + z * self.slope[1];
        if side == 0 || along.abs() < (x.abs() + y.abs() + z.abs()) * f64::EPSILON * 16.0 {
            return None;
        }
        let ahead = (side > 0) != (along > 0.0);
        Some(if ahead { along.signum() as i32 } else { 0 })
    }
}
