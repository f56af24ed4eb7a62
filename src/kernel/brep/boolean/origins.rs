//! What a piece of boundary is made of: the plane it lies in and the source it came from.

use rustc_hash::FxHashMap;

use super::{cells::Complex, facet::Facets, frame::Plan, space::NONE};
use crate::geom::{Origin, Surface};

/// The plane of a piece.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Flat {
    /// A plane of the lattice.
    Exact(u32),
    /// The plane of a source face, by leaf and number there: snapping has bent it, or it was never
    /// needed.
    Source(u32, u32),
}

/// The source of a piece.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
enum Patch {
    /// A true plane: all pieces with the same origin are alike.
    Plane(u32),
    /// A facet of a curved surface, by leaf and face.
    Face(u32, u32),
}

/// Pieces with equal keys that share an edge are one polygon.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) struct Key {
    /// Its plane.
    pub flat: Flat,
    /// Whether the outside is where that plane's normal points.
    up: bool,
    patch: Patch,
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
    /// The exact plane of a source plane, and whether it faces against it.
    planes: FxHashMap<(u32, u32), (u32, bool)>,
    numbers: FxHashMap<(u32, u32), u32>,
    /// The origins of the result.
    pub origins: Vec<Origin>,
}

impl<'a> Labels<'a> {
    pub fn new(plan: &'a Plan, facets: &'a Facets) -> Labels<'a> {
        let mut labels = Labels {
            plan,
            facets,
            planes: FxHashMap::default(),
            numbers: FxHashMap::default(),
            origins: vec![],
        };
        for (number, facet) in (0u32..).zip(facets.list()) {
            if let (true, Some(plane)) = (facet.flat, facets.known_plane(number)) {
                let source = labels.source_plane(facet.leaf, facet.face);
                labels.planes.entry(source).or_insert(plane);
            }
        }
        labels
    }

    fn source_plane(&self, leaf: u32, face: u32) -> (u32, u32) {
        let mesh = self.plan.leaves[leaf as usize].solid.mesh();
        (leaf, mesh.face(face as usize).plane())
    }

    /// The key of a cell whose outside is above (`up`) or below.
    pub fn key(&mut self, complex: &Complex, cell: u32, up: bool) -> Key {
        let cover = complex.cover(cell);
        let fitting = cover.iter().find(|c| (c.1 > 0) == up);
        let (number, count) = *fitting.unwrap_or(&cover[0]);
        let facet = &self.facets.list()[number as usize];
        let (leaf, face) = (facet.leaf, facet.face);
        let source = self.source_plane(leaf, face);
        let exact = self.planes.get(&source).filter(|_| facet.flat);
        let (flat, up) = match (exact, complex.plane(cell)) {
            (Some(&(plane, turned)), NONE) => (Flat::Exact(plane), up != turned),
            (Some(_), plane) => (Flat::Exact(plane), up),
            (None, _) => (Flat::Source(source.0, source.1), up == (count > 0)),
        };
        let origin = self.origin(leaf, face);
        let patch = match self.origins[origin as usize].surface {
            Surface::Plane => Patch::Plane(origin),
            _ => Patch::Face(leaf, face),
        };
        Key { flat, up, patch, origin }
    }

    /// The number of a face's origin in the result; equal origins get one number.
    pub fn origin(&mut self, leaf: u32, face: u32) -> u32 {
        let source = &self.plan.leaves[leaf as usize];
        let face = source.solid.mesh().face(face as usize);
        let origins = &mut self.origins;
        *self.numbers.entry((leaf, face.origin_index())).or_insert_with(|| {
            let mut origin = face.origin().clone();
            origin.surface = origin.surface.placed(&source.full);
            let known = match origin.surface {
                Surface::Plane => origins.iter().position(|o| *o == origin),
                _ => None,
            };
            known.unwrap_or_else(|| {
                origins.push(origin);
                origins.len() - 1
            }) as u32
        })
    }
}
