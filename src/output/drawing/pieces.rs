//! What of a curved grid hides: its pieces as facets, and where the front ends and the back begins.

use glam::DVec3;

use super::{
    cells::around,
    folded::{Folded, Piece},
    lattice::Plane,
    links::NONE,
    model::{Facet, Model, Outline},
};

/// A side of a piece: its ends, the smaller first, the piece, and whether that runs from the smaller one.
pub type Side = ([u32; 2], u32, bool);

/// Which pieces meet at which side.
pub struct Sides(Vec<Side>);

/// Whether two pieces that meet at a side go on into each other: both turn the same side of the surface to the eye. Their
/// upper sides are different ones where the ends of a strip with half a twist meet.
pub fn continues(pieces: &[Piece], one: &Side, other: &Side) -> bool {
    let [a, b] = [one, other].map(|s| pieces[s.1 as usize].front == s.2);
    one.1 != other.1 && a != b
}

impl Sides {
    /// The sides of some pieces.
    pub fn of(pieces: &[Piece]) -> Sides {
        let mut sides = vec![];
        for (number, piece) in pieces.iter().enumerate() {
            let next = piece.corners.iter().cycle().skip(1);
            for (&a, &b) in piece.corners.iter().zip(next) {
                sides.push(([a.min(b), a.max(b)], number as u32, a < b));
            }
        }
        sides.sort_unstable();
        Sides(sides)
    }

    /// The pieces beside a side, and whether they run from its smaller end.
    pub fn at(&self, a: u32, b: u32) -> &[Side] {
        let key = [a.min(b), a.max(b)];
        let from = self.0.partition_point(|s| s.0 < key);
        let count = self.0[from..].partition_point(|s| s.0 == key);
        &self.0[from..from + count]
    }

    /// All sides, each with its pieces.
    pub fn each(&self) -> impl Iterator<Item = &[Side]> {
        self.0.chunk_by(|a, b| a.0 == b.0)
    }
}

/// Where the facets of curved grids come from.
#[derive(Clone, Debug, Default)]
pub struct Homes {
    /// The first facet of a grid in the model.
    pub first: usize,
    /// Of each facet from there on the triangle it is part of, and whether the upper side of its piece is towards the eye.
    pub of_facet: Vec<(u32, bool)>,
    /// Points of the triangles.
    pub triangles: Vec<[u32; 3]>,
}

impl Homes {
    /// The triangle and side of a facet of a grid.
    pub fn of(&self, facet: u32) -> Option<(u32, bool)> {
        (facet as usize).checked_sub(self.first).and_then(|i| self.of_facet.get(i)).copied()
    }

    /// Whether two triangles have a common corner.
    pub fn touch(&self, one: u32, other: u32) -> bool {
        let [a, b] = [one, other].map(|t| self.triangles[t as usize]);
        a.iter().any(|p| b.contains(p))
    }
}

impl Model {
    /// Adds what of a grid hides; its points begin at `base`.
    pub fn add_folded(&mut self, folded: &Folded, sides: &Sides, base: u32) {
        let starts = [self.facets.len(), self.outlines.len(), self.edges.len()];
        let homes = self.homes.triangles.len() as u32;
        let triangles = folded.triangles.iter().map(|t| t.map(|p| base + p));
        self.homes.triangles.extend(triangles);
        for (number, piece) in folded.pieces.iter().enumerate() {
            if folded.hides(piece) {
                self.add_piece(folded, sides, number as u32, base, homes + piece.home);
            }
        }
        let points = base as usize..base as usize + folded.points.len();
        self.add_hull(points, starts, false);
    }

    /// Adds the facets of a piece, a fan, and where it ends.
    fn add_piece(&mut self, folded: &Folded, sides: &Sides, number: u32, base: u32, home: u32) {
        let piece = &folded.pieces[number as usize];
        let mut corners = piece.corners.clone();
        if !piece.front {
            corners.reverse();
        }
        let (first, last) = (self.facets.len() as u32, corners.len() - 1);
        for i in 1..last {
            self.add_triangle([0, i, i + 1].map(|k| base + corners[k]));
            self.homes.of_facet.push((home, piece.front));
        }
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            let beside = sides.at(a, b);
            let own = beside.iter().find(|s| s.1 == number);
            let goes_on =
                own.is_some_and(|own| beside.iter().any(|s| continues(&folded.pieces, own, s)));
            if !goes_on {
                let facet = first + (i.clamp(1, last - 1) - 1) as u32;
                self.outlines.push(Outline { a: base + a, b: base + b, facet, curve: NONE });
            }
        }
    }

    fn add_triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|p| self.space[p as usize]);
        let sight = self.camera.sight(a).normalize_or_zero();
        let normal = (b - a).cross(c - a).try_normalize().unwrap_or(sight);
        let normal: DVec3 = if normal.dot(sight) < 0.0 { -normal } else { normal };
        let first = self.sides.len() as u32;
        for i in 0..3 {
            self.sides.push([corners[i], corners[(i + 1) % 3]]);
        }
        let (min, max) = around(corners.iter().map(|&p| self.at[p as usize]));
        let plane = Plane { normal, offset: normal.dot(a) };
        let sides = [first, first + 3];
        self.facets.push(Facet {
            plane,
            sides,
            min,
            max,
            field: NONE,
            corner: corners[0],
            loose: false,
        });
    }
}
