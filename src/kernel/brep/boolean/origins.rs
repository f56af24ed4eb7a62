//! What a piece of boundary is made of: the plane it lies in and the source it came from.

use rustc_hash::{FxHashMap, FxHashSet};

use super::{
    cells::Complex,
    facet::{Facets, Source},
    frame::Plan,
    space::NONE,
};
use crate::geom::{Origin, Surface};

/// The plane of a piece.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Flat {
    /// A plane of the lattice.
    Exact(u32),
    /// The plane of a source face, by leaf and number there: snapping has bent it, or it was never
    /// needed.
    Source(u32, u32),
    /// That of a cell, by its number: a piece for itself.
    Piece(u32),
}

/// Pieces with equal keys that share an edge are one polygon.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) struct Key {
    /// Its plane.
    pub flat: Flat,
    /// Whether the outside is where that plane's normal points.
    up: bool,
    /// The number of its origin in the result.
    pub origin: u32,
}

impl Key {
    /// Its plane and which way it faces.
    pub fn plane(&self) -> (Flat, bool) {
        (self.flat, self.up)
    }
}

/// Gives pieces their keys and collects the origins of the result.
pub(super) struct Labels<'a> {
    plan: &'a Plan,
    facets: &'a Facets,
    exact: bool,
    /// Cells that stay pieces for themselves.
    apart: FxHashSet<u32>,
    /// The exact plane of a source plane, and whether it faces against it.
    planes: FxHashMap<(u32, u32), (u32, bool)>,
    numbers: FxHashMap<(u32, u32), u32>,
    /// The origins by where their surfaces are.
    near: FxHashMap<[i64; 3], Vec<u32>>,
    /// The origins of the result.
    pub origins: Vec<Origin>,
}

impl<'a> Labels<'a> {
    pub fn new(plan: &'a Plan, facets: &'a Facets) -> Labels<'a> {
        let mut labels = Labels {
            plan,
            facets,
            exact: false,
            apart: FxHashSet::default(),
            planes: FxHashMap::default(),
            numbers: FxHashMap::default(),
            near: FxHashMap::default(),
            origins: vec![],
        };
        for (number, facet) in (0u32..).zip(facets.list()) {
            if let (true, Some((plane, turned))) = (facet.source.flat, facets.known_plane(number)) {
                let source = labels.source_plane(facet.source.leaf, facet.source.face);
                labels.planes.entry(source).or_insert((plane, turned != facet.source.flipped));
            }
        }
        labels
    }

    fn source_plane(&self, leaf: u32, face: u32) -> (u32, u32) {
        let mesh = self.plan.leaves[leaf as usize].solid.mesh();
        (leaf, mesh.face(face as usize).plane())
    }

    /// Labels that hold pieces apart unless they lie in exactly one plane. The planes of all facets
    /// must be known.
    pub fn exact(plan: &'a Plan, facets: &'a Facets) -> Labels<'a> {
        let (planes, numbers) = (FxHashMap::default(), FxHashMap::default());
        let (apart, near) = (FxHashSet::default(), FxHashMap::default());
        Labels { plan, facets, exact: true, apart, planes, numbers, near, origins: vec![] }
    }

    /// The same labels, but some cells are merged with no other.
    pub fn holding_apart(self, apart: FxHashSet<u32>) -> Labels<'a> {
        Labels { apart, ..self }
    }

    /// The key of a cell whose outside is above (`up`) or below.
    pub fn key(&mut self, complex: &Complex, cell: u32, up: bool) -> Key {
        let cover = complex.cover(cell);
        let fitting = cover.iter().find(|c| (c.1 > 0) == up);
        let (number, count) = *fitting.unwrap_or(&cover[0]);
        let Source { leaf, face, flipped, .. } = self.facets.list()[number as usize].source;
        let (flat, up) = match (complex.plane(cell), self.exact_plane(number)) {
            (NONE, Some((plane, turned))) => (Flat::Exact(plane), up != turned),
            (plane, Some(_)) => (Flat::Exact(plane), up),
            (_, None) => {
                let (leaf, plane) = self.source_plane(leaf, face);
                (Flat::Source(leaf, plane), up == ((count > 0) != flipped))
            }
        };
        let flat = if self.apart.contains(&cell) { Flat::Piece(cell) } else { flat };
        let origin = self.origin(leaf, face);
        Key { flat, up, origin }
    }

    /// The plane of a facet and whether it faces against it, where that counts.
    fn exact_plane(&self, facet: u32) -> Option<(u32, bool)> {
        if self.exact {
            return self.facets.known_plane(facet);
        }
        let Source { leaf, face, flat, flipped } = self.facets.list()[facet as usize].source;
        let known = self.planes.get(&self.source_plane(leaf, face)).filter(|_| flat);
        known.map(|&(plane, turned)| (plane, turned != flipped))
    }

    /// The number of a face's origin in the result; equal origins get one number, wherever a surface was
    /// taken hold of.
    pub fn origin(&mut self, leaf: u32, face: u32) -> u32 {
        let source = &self.plan.leaves[leaf as usize];
        let face = source.solid.mesh().face(face as usize);
        let origins = &mut self.origins;
        *self.numbers.entry((leaf, face.origin_index())).or_insert_with(|| {
            let origin = face.origin().placed(&source.full);
            if origin.surface == Surface::Smooth {
                origins.push(origin);
                return origins.len() as u32 - 1;
            }
            let near = self.near.entry(cell(&origin.surface)).or_default();
            let known = near.iter().copied().find(|&n| is_alike(&origins[n as usize], &origin));
            known.unwrap_or_else(|| {
                near.push(origins.len() as u32);
                origins.push(origin);
                origins.len() as u32 - 1
            })
        })
    }
}

fn is_alike(a: &Origin, b: &Origin) -> bool {
    a.color == b.color && a.tags == b.tags && a.surface.is_same(&b.surface)
}

/// The cell of a grid, as wide as the surface, in which it is looked for. Shifted, so that whole places, the
/// most frequent ones, are far from the borders of cells; a surface that is not found there anew is only not
/// merged with itself.
fn cell(surface: &Surface) -> [i64; 3] {
    const SHIFT: f64 = 0.317;
    let (anchor, size) = surface.anchor();
    (anchor / size + SHIFT).floor().to_array().map(|c| c as i64)
}
