//! Where each connected component of the complex stands: its unbounded region, and the winding
//! numbers of the other components around it.
//!
//! The unbounded region is found at the component's first point, where everything lies to one side;
//! the winding numbers by the spherical projection (Nagashima 1986) with exact triple products.
//! Where the point touches the other component, a ray from just beyond the point counts crossings
//! exactly instead.

use std::cmp::Ordering;

use super::{
    cells::Complex,
    classify::{Links, following_side},
    facet::Facets,
    frame::Leaf,
    hierarchy::{Bounds, Hierarchy},
    patch::Patches,
    polygon,
    space::Space,
};
use crate::geom::{
    predicates::{Int3, cross, dot, minus},
    wide::Wide,
};

/// What is known of a component.
pub(super) struct Seed {
    /// A side of a cell that faces the unbounded region.
    pub side: u32,
    /// The winding numbers, by leaf, of what surrounds the component.
    pub around: Vec<(u32, i32)>,
}

/// The facets of one leaf in one component: a closed surface.
struct Shell {
    component: u32,
    leaf: u32,
    facets: Vec<u32>,
    patches: Vec<u32>,
    bounds: Bounds,
}

/// What a component may stand in.
pub(super) struct Surroundings<'a> {
    pub complex: &'a Complex,
    pub leaves: &'a [Leaf],
    pub patches: &'a Patches,
}

impl Surroundings<'_> {
    /// The seeds of all components.
    pub fn seeds(&self, links: &mut Links, facets: &mut Facets, space: &mut Space) -> Vec<Seed> {
        let (complex, Links { components, radial, .. }) = (self.complex, links);
        let of_cell: Vec<u32> =
            (0..complex.cell_count() as u32).map(|cell| components.find(cell)).collect();
        let firsts = first_points(complex, &of_cell, space);
        let shells = self.shells(&of_cell, facets);
        let tree = Hierarchy::new(shells.iter().map(|s| s.bounds));
        let fans = fans(complex, &of_cell, &firsts);
        let mut seeds = vec![];
        for ((component, point), halves) in firsts.into_iter().zip(fans) {
            let side = unbounded_side(complex, point, &halves, radial, facets, space);
            let place = beyond(complex, point, halves[0], facets, space);
            let around = self.around(component, place, (&shells, &tree), facets, space);
            seeds.push(Seed { side, around });
        }
        seeds
    }

    fn shells(&self, of_cell: &[u32], facets: &Facets) -> Vec<Shell> {
        let complex = self.complex;
        // Component, leaf, and a facet, or a patch that stands behind all facets.
        let mut owned: Vec<(u32, u32, bool, u32)> = vec![];
        for cell in 0..complex.first_patch {
            for &(facet, _) in complex.cover(cell) {
                let leaf = facets.list()[facet as usize].source.leaf;
                owned.push((of_cell[cell as usize], leaf, false, facet));
            }
        }
        for (number, patch) in (0u32..).zip(&self.patches.list) {
            let component = of_cell[(complex.first_patch + number) as usize];
            owned.push((component, patch.leaf, true, number));
        }
        owned.sort_unstable();
        owned.dedup();
        let runs = owned.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
        runs.map(|run| self.shell(run, facets)).collect()
    }

    fn shell(&self, run: &[(u32, u32, bool, u32)], facets: &Facets) -> Shell {
        let of = |patches: bool| run.iter().filter(move |o| o.2 == patches).map(|o| o.3);
        let (members, patches): (Vec<u32>, Vec<u32>) = (of(false).collect(), of(true).collect());
        let bounds = members.iter().map(|&f| facets.list()[f as usize].bounds);
        let resting = patches.iter().map(|&p| self.patches.list[p as usize].bounds);
        let bounds = bounds.chain(resting).fold(Bounds::EMPTY, Bounds::with);
        Shell { component: run[0].0, leaf: run[0].1, facets: members, patches, bounds }
    }

    /// The winding numbers of what is around a component.
    fn around(
        &self,
        component: u32,
        place: Beyond,
        (shells, tree): (&[Shell], &Hierarchy),
        facets: &Facets,
        space: &Space,
    ) -> Vec<(u32, i32)> {
        let here = place.point.map(|c| c as i32);
        let mut found = vec![];
        tree.overlapping(&Bounds { min: here, max: here }, |s| {
            let shell = &shells[s as usize];
            if shell.component != component {
                let pieces = self.pieces(shell, facets, space);
                let winding = spherical_winding(place.point, &pieces)
                    .unwrap_or_else(|| ray_winding(place, &pieces));
                if winding != 0 {
                    found.push((shell.leaf, winding));
                }
            }
        });
        found.sort_unstable();
        found
    }

    /// The polygons of a shell.
    fn pieces(&self, shell: &Shell, facets: &Facets, space: &Space) -> Vec<Piece> {
        let at = |p: u32| space.lattice_point(p).expect("a corner is a lattice point");
        let place = |l: &[u32]| l.iter().map(|&p| at(p)).collect();
        let facets = shell.facets.iter().map(|&f| facets.loops(f).map(place).collect());
        let resting = shell.patches.iter().flat_map(|&p| self.patches.triangles(p, self.leaves));
        facets.chain(resting.map(|t| vec![t.to_vec()])).collect()
    }
}

/// A polygon: its loops.
type Piece = Vec<Vec<Int3>>;

/// The first lattice point of every component, by x, then y, then z. It is the first of all its
/// points, since the cells lie within the facets.
fn first_points(complex: &Complex, of_cell: &[u32], space: &Space) -> Vec<(u32, u32)> {
    let mut best: Vec<Option<(Int3, u32)>> = vec![None; of_cell.len()];
    for half in &complex.halves {
        let Some(at) = space.lattice_point(half.origin) else { continue };
        let slot = &mut best[of_cell[half.cell as usize] as usize];
        if slot.is_none_or(|b| at < b.0) {
            *slot = Some((at, half.origin));
        }
    }
    (0u32..).zip(best).filter_map(|(component, b)| Some((component, b?.1))).collect()
}

/// For each component the half-edges of its cells that start or end at its first point.
fn fans(complex: &Complex, of_cell: &[u32], firsts: &[(u32, u32)]) -> Vec<Vec<u32>> {
    let mut place = vec![u32::MAX; of_cell.len()];
    for (i, &(component, _)) in (0u32..).zip(firsts) {
        place[component as usize] = i;
    }
    let mut fans = vec![vec![]; firsts.len()];
    for (number, half) in (0u32..).zip(&complex.halves) {
        let i = place[of_cell[half.cell as usize] as usize] as usize;
        let Some(&(_, first)) = firsts.get(i) else { continue };
        if half.origin == first || complex.target(number) == first {
            fans[i].push(number);
        }
    }
    fans
}

/// The side of a cell at the first point that faces the unbounded region.
///
/// The upright plane through the edge that turns most clockwise in the x-y plane (and falls most)
/// has nothing of the component to its right; the cell next to that empty half-space faces it.
fn unbounded_side(
    complex: &Complex,
    point: u32,
    halves: &[u32],
    radial: &[(u32, Vec<u32>)],
    facets: &mut Facets,
    space: &mut Space,
) -> u32 {
    let base = space.lattice_point(point).expect("a first point is a lattice point");
    let far = |half: u32| {
        let origin = complex.halves[half as usize].origin;
        if origin == point { complex.target(half) } else { origin }
    };
    let rays: Vec<[Wide<4>; 3]> = halves.iter().map(|&h| ray(base, far(h), space)).collect();
    let upright = |r: &[Wide<4>; 3]| r[0].sign() == 0 && r[1].sign() == 0;
    let best = (0..halves.len())
        .filter(|&i| !upright(&rays[i]))
        .min_by(|&i, &j| by_turn(&rays[i], &rays[j]))
        .unwrap_or(0);
    let half = halves[best];
    let edge = complex.halves[half as usize].edge;
    let around = match radial.binary_search_by_key(&edge, |r| r.0) {
        Ok(i) => radial[i].1.clone(),
        Err(_) => complex.around(edge as usize).to_vec(),
    };
    let ahead = point < far(half);
    let (axis, sign) = space.direction(point, far(half));
    let spokes: Vec<_> = around.iter().map(|&h| complex.spoke(h, facets, space)).collect();
    // About the edge's direction away from the point, the first cell has all others to its left.
    let first =
        spokes.iter().position(|s| spokes.iter().all(|t| s.turn(t, axis, sign) >= 0)).unwrap_or(0);
    let following = following_side(complex, around[first]);
    if ahead { following ^ 1 } else { following }
}

/// The direction to another point, times a positive number.
fn ray(from: Int3, to: u32, space: &Space) -> [Wide<4>; 3] {
    let to = space.exact(to);
    std::array::from_fn(|i| to.x[i] - Wide::from(i128::from(from[i])) * to.w)
}

/// Orders directions, none upright and all to the right, clockwise ones first, then falling ones.
fn by_turn(p: &[Wide<4>; 3], q: &[Wide<4>; 3]) -> Ordering {
    let product = |a: Wide<4>, b: Wide<4>| -> Wide<7> { a.resize() * b.resize() };
    let turn = (product(p[0], q[1]) - product(p[1], q[0])).sign();
    // The component along the common direction is positive for both, so this compares slopes.
    let level = if p[0].sign() != 0 { 0 } else { 1 };
    let climb = (product(p[level], q[2]) - product(p[2], q[level])).sign();
    0.cmp(&turn).then(0.cmp(&climb))
}

/// The place just beyond the first point, inside a facet of the component. Nothing else of another
/// component is there: facets that cross are of one component. A leaf may touch itself without its
/// parts being linked, but hardly along a direction as odd as this one.
fn beyond(complex: &Complex, point: u32, half: u32, facets: &Facets, space: &Space) -> Beyond {
    let at = |p: u32| space.lattice_point(p).expect("a corner is a lattice point");
    let cover = complex.cover(complex.halves[half as usize].cell);
    let mut along = [0; 3];
    // What reaches a first point has a convex corner there.
    for (a, b) in cover.iter().take(1).flat_map(|&(facet, _)| facets.edges(facet)) {
        let (far, weight) = match (a == point, b == point) {
            (true, _) => (b, ODD[0]),
            (_, true) => (a, ODD[1]),
            _ => continue,
        };
        let arm = minus(at(far), at(point));
        along = std::array::from_fn(|i| along[i] + weight * arm[i]);
    }
    Beyond { point: at(point), along }
}

/// The shares of two edges in a direction between them.
const ODD: [i64; 2] = [618_034, 1_414_213];

/// How far a sum of solid angles may be from a whole number of spheres and still count as one.
const WHOLE: f64 = 1e-3;

/// The winding number of a shell around a point by the spherical projection; `None` where the point
/// may lie on the shell.
fn spherical_winding(at: Int3, shell: &[Piece]) -> Option<i32> {
    let mut sum = 0.0;
    for piece in shell {
        match solid_angle(at, piece) {
            Some(angle) => sum += angle,
            None if in_box(at, piece) => return None,
            None => {}
        }
    }
    let spheres = sum / (4.0 * std::f64::consts::PI);
    ((spheres - spheres.round()).abs() < WHOLE).then_some(spheres.round() as i32)
}

/// Whether a point is in the box of a polygon.
fn in_box(at: Int3, piece: &Piece) -> bool {
    (0..3).all(|i| {
        let along = || piece[0].iter().map(|c| c[i]);
        along().min().is_some_and(|low| low <= at[i]) && along().max().is_some_and(|c| at[i] <= c)
    })
}

/// The signed solid angle of a polygon, positive seen from behind (van Oosterom and Strackee 1983);
/// `None` for a point in its plane.
fn solid_angle(at: Int3, piece: &Piece) -> Option<f64> {
    let (mut volume, mut angle) = (0i128, 0.0);
    for corners in piece {
        let a = minus(corners[0], at);
        for pair in corners[1..].windows(2) {
            let (b, c) = (minus(pair[0], at), minus(pair[1], at));
            let product = triple(a, b, c);
            volume += product;
            angle += 2.0 * libm::atan2(product as f64, denominator(a, b, c));
        }
    }
    (volume != 0).then_some(angle)
}

fn triple(a: Int3, b: Int3, c: Int3) -> i128 {
    let normal = cross(b, c);
    (0..3).map(|i| normal[i] * i128::from(a[i])).sum()
}

fn denominator(a: Int3, b: Int3, c: Int3) -> f64 {
    let length = |v: Int3| (dot(v, v) as f64).sqrt();
    let (p, q, r) = (length(a), length(b), length(c));
    p * q * r + dot(a, b) as f64 * r + dot(b, c) as f64 * p + dot(c, a) as f64 * q
}

/// The place just beyond a lattice point: moved infinitesimally along a direction, by far less
/// downwards in y, and by still less downwards in z.
#[derive(Clone, Copy)]
struct Beyond {
    point: Int3,
    along: Int3,
}

/// The winding number of a shell around such a place, which is not on the shell: signed crossings of
/// the ray to the left.
fn ray_winding(place: Beyond, shell: &[Piece]) -> i32 {
    let mut winding = 0;
    for piece in shell {
        let normal = polygon::area_of(piece);
        let facing = normal[0].signum();
        if facing == 0 || !shadow_covers(place, piece) {
            continue;
        }
        let along = |v: Int3| (0..3).map(|i| normal[i] * i128::from(v[i])).sum::<i128>();
        let side = first_sign([along(minus(place.point, piece[0][0])), along(place.along)]);
        // The place is to the right of the facet's plane.
        if side * facing > 0 {
            winding -= facing as i32;
        }
    }
    winding
}

/// The sign of a sum whose terms each outweigh all that follow.
fn first_sign<const N: usize>(terms: [i128; N]) -> i128 {
    terms.into_iter().find(|&t| t != 0).unwrap_or(0).signum()
}

/// Whether a polygon, seen along x, covers a place: an odd number of its edges run above.
fn shadow_covers(place: Beyond, piece: &Piece) -> bool {
    let Beyond { point: at, along } = place;
    let is_right = |c: Int3| first_sign([i128::from(c[1] - at[1]), -i128::from(along[1]), 1]) > 0;
    let mut odd = false;
    let edges = piece.iter().flat_map(|l| l.iter().zip(l.iter().cycle().skip(1)));
    for (&a, &b) in edges {
        if is_right(a) == is_right(b) {
            continue;
        }
        let (left, right) = if is_right(a) { (b, a) } else { (a, b) };
        let [dy, dz] = [1, 2].map(|i| i128::from(right[i] - left[i]));
        let [y, z] = [1, 2].map(|i| i128::from(left[i] - at[i]));
        let turn = i128::from(along[1]) * dz - i128::from(along[2]) * dy;
        odd ^= first_sign([z * dy - y * dz, turn, -dz, 1]) > 0;
    }
    odd
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron wound so that its faces look outwards.
    fn tetrahedron() -> Vec<Piece> {
        let corners = [[0, 0, 0], [800, 0, 0], [0, 800, 0], [0, 0, 800]];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        faces.map(|f| vec![f.map(|c: usize| corners[c]).to_vec()]).to_vec()
    }

    #[test]
    fn projection_and_ray_agree() {
        let shell = tetrahedron();
        for code in 0..6 * 6 * 6 {
            let at = [code % 6, code / 6 % 6, code / 36].map(|c| (2 * c - 3) * 100);
            let at = [0, 1, 2].map(|i| at[i] + i as i64);
            let by_ray = ray_winding(Beyond { point: at, along: [1, 2, 3] }, &shell);
            assert_eq!(spherical_winding(at, &shell), Some(by_ray), "{at:?}");
        }
    }

    #[test]
    fn the_ray_decides_at_a_corner() {
        let shell = tetrahedron();
        let point = [0; 3];
        assert_eq!(spherical_winding(point, &shell), None);
        let at = |along: Int3| ray_winding(Beyond { point, along }, &shell);
        assert_eq!(at([1, 1, 1]), 1);
        assert_eq!(at([3, 1, 2]), 1);
        assert_eq!(at([-1, -1, -1]), 0);
        assert_eq!(at([1, 1, -1]), 0);
        assert_eq!(at([-1, 1, 1]), 0);
    }
}
