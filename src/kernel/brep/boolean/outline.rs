//! The outlines of merged polygons: loops, the vertices where they meet, and which of those stay.
//!
//! Around a point every fan of linked polygons gets a vertex of its own, so solids that touch in a
//! point come apart. A vertex where only two polygons meet, along one straight line, is dropped,
//! unless the result touches itself there: a result that is used again shares its points where it
//! touches itself.

use rustc_hash::FxHashMap;

use super::{
    boundary::Boundary,
    cells::Complex,
    origins::Flat,
    patch::Borders,
    space::{NONE, Space},
    union_find::Sets,
};
use crate::geom::predicates::{cross, minus};

/// A loop around a merged polygon.
pub(super) struct Loop {
    /// The polygon.
    pub polygon: u32,
    /// Its half-edges: a range of the outline's.
    from: u32,
    to: u32,
}

/// Loops of half-edges.
pub(super) struct Outline {
    /// All loops; those of one polygon follow each other.
    pub loops: Vec<Loop>,
    /// Their half-edges.
    halves: Vec<u32>,
    /// What follows a half-edge in its loop.
    pub next: Vec<u32>,
    /// What comes before it.
    before: Vec<u32>,
    /// The vertex at its start, known by one of the half-edges that leave it.
    pub vertex: Vec<u32>,
}

impl Outline {
    /// Traces the outlines.
    ///
    /// `borders` are the points at which patches border: only one fan is there, and it stays.
    pub fn of(boundary: &Boundary, borders: &Borders, complex: &Complex) -> Outline {
        let count = boundary.twin.len();
        let (loops, halves) = loops(boundary, complex);
        let mut outline = Outline {
            loops,
            halves,
            next: vec![NONE; count],
            before: vec![NONE; count],
            vertex: vec![NONE; count],
        };
        for edge in &outline.loops {
            let halves = &outline.halves[edge.from as usize..edge.to as usize];
            let mut before = halves[halves.len() - 1];
            for &half in halves {
                outline.next[before as usize] = half;
                outline.before[half as usize] = before;
                before = half;
            }
        }
        let mut sets = Sets::new(count);
        let mut leaving = vec![NONE; complex.point_count()];
        for half in boundary.outer() {
            if borders.patch(boundary.origin[half as usize]).is_some() {
                let slot = &mut leaving[boundary.at[half as usize] as usize];
                *slot = half.min(*slot);
                sets.join(half, *slot);
            } else {
                sets.join(half, outline.next[boundary.twin[half as usize] as usize]);
            }
        }
        for half in boundary.outer() {
            outline.vertex[half as usize] = sets.find(half);
        }
        outline
    }

    /// Whether each vertex is dropped, by the half-edge that stands for it.
    pub fn dropped(
        &self,
        (boundary, borders): (&Boundary, &Borders),
        complex: &Complex,
        space: &Space,
    ) -> Vec<bool> {
        let mut leaving = vec![0u32; boundary.twin.len()];
        for half in boundary.outer() {
            leaving[self.vertex[half as usize] as usize] += 1;
        }
        // Where several vertices stand in one point the result touches itself: all of them stay.
        let mut standing = vec![0u32; complex.point_count()];
        for half in boundary.outer().filter(|&h| self.vertex[h as usize] == h) {
            standing[boundary.at[half as usize] as usize] += 1;
        }
        let alone = |half: u32| {
            let [point, at] = [&boundary.origin, &boundary.at].map(|list| list[half as usize]);
            standing[at as usize] == 1 && borders.patch(point).is_none()
        };
        let mut dropped = vec![false; boundary.twin.len()];
        let straight = Straight { outline: self, boundary, complex, space };
        for half in boundary.outer() {
            let vertex = self.vertex[half as usize];
            if vertex == half
                && leaving[vertex as usize] == 2
                && alone(half)
                && straight.holds(half)
            {
                dropped[vertex as usize] = true;
            }
        }
        self.keep_triangles(&mut dropped);
        dropped
    }

    /// The half-edges of a loop.
    pub fn halves(&self, edge: &Loop) -> &[u32] {
        &self.halves[edge.from as usize..edge.to as usize]
    }

    /// Takes back what would leave a loop with fewer than three corners.
    fn keep_triangles(&self, dropped: &mut [bool]) {
        loop {
            let mut changed = false;
            for halves in self.loops.iter().map(|edge| self.halves(edge)) {
                let vertex = |half: u32| self.vertex[half as usize] as usize;
                let kept = halves.iter().filter(|&&half| !dropped[vertex(half)]).take(3).count();
                if kept < 3 && kept < halves.len() {
                    halves.iter().for_each(|&half| dropped[vertex(half)] = false);
                    changed = true;
                }
            }
            if !changed {
                return;
            }
        }
    }
}

/// The loops around all merged polygons, without a point met twice, and their half-edges.
fn loops(boundary: &Boundary, complex: &Complex) -> (Vec<Loop>, Vec<u32>) {
    let mut done = vec![false; boundary.twin.len()];
    // The walk that met each point last.
    let mut met = vec![NONE; complex.point_count()];
    let (mut loops, mut halves) = (vec![], Vec::with_capacity(boundary.twin.len()));
    for start in boundary.outer() {
        if done[start as usize] {
            continue;
        }
        let (from, mut half, mut is_simple) = (halves.len(), start, true);
        while !done[half as usize] {
            done[half as usize] = true;
            halves.push(half);
            let met = &mut met[boundary.at[half as usize] as usize];
            is_simple &= *met != start;
            *met = start;
            half = boundary.next[half as usize];
            while boundary.is_inner(half) {
                half = boundary.next[boundary.twin[half as usize] as usize];
            }
        }
        let polygon = boundary.polygon[start as usize];
        if is_simple {
            loops.push(Loop { polygon, from: from as u32, to: halves.len() as u32 });
            continue;
        }
        for part in simple(halves.split_off(from), &boundary.at) {
            let from = halves.len() as u32;
            halves.extend(part);
            loops.push(Loop { polygon, from, to: halves.len() as u32 });
        }
    }
    loops.sort_by_key(|l| l.polygon);
    (loops, halves)
}

/// Cuts a walk that meets points more than once into loops that do not.
fn simple(walk: Vec<u32>, at: &[u32]) -> Vec<Vec<u32>> {
    let (mut loops, mut open) = (vec![], Vec::<u32>::new());
    let mut place: FxHashMap<u32, usize> = FxHashMap::default();
    for half in walk {
        let point = at[half as usize];
        if let Some(&from) = place.get(&point) {
            let closed = open.split_off(from);
            for &half in &closed {
                place.remove(&at[half as usize]);
            }
            loops.push(closed);
        }
        place.insert(point, open.len());
        open.push(half);
    }
    loops.push(open);
    loops
}

/// How far, in steps, a corner may be from the straight line that two faces share when snapping has
/// bent one of them: each end of a snapped edge moves by less than one step.
const BENT: f64 = 2.0;

/// The question whether a vertex of two polygons lies on one straight line with its neighbours.
struct Straight<'a> {
    outline: &'a Outline,
    boundary: &'a Boundary,
    complex: &'a Complex,
    space: &'a Space,
}

impl Straight<'_> {
    fn holds(&self, half: u32) -> bool {
        let before = self.outline.before[half as usize];
        let twins = [half, before].map(|h| self.boundary.twin[h as usize]);
        let polygon = |h: u32| self.boundary.polygon[h as usize];
        if polygon(twins[0]) != polygon(twins[1]) {
            return false;
        }
        let flat = |h: u32| {
            let cell = self.complex.halves[h as usize].cell;
            self.boundary.keys[cell as usize].map(|k| k.flat)
        };
        let (mine, other) = (flat(half), flat(twins[0]));
        if mine == other {
            return self.exactly(half, before, twins);
        }
        let exact = |f: Option<Flat>| matches!(f, Some(Flat::Exact(_)));
        (exact(mine) && exact(other)) || self.nearly(half, before)
    }

    /// The points before, at and after a half-edge's start.
    fn points(&self, half: u32, before: u32) -> [u32; 3] {
        let after = self.outline.next[half as usize];
        [before, half, after].map(|h| self.boundary.origin[h as usize])
    }

    /// By the plane that holds one of the edges, or by integers.
    fn exactly(&self, half: u32, before: u32, twins: [u32; 2]) -> bool {
        let [a, b, c] = self.points(half, before);
        for (edges, other) in [([half, twins[0]], a), ([before, twins[1]], c)] {
            for edge in edges {
                let support = self.complex.halves[edge as usize].support;
                if support != NONE {
                    return self.space.side(other, support) == 0;
                }
            }
        }
        match [a, b, c].map(|p| self.space.lattice_point(p)) {
            [Some(a), Some(b), Some(c)] => cross(minus(b, a), minus(c, b)) == [0; 3],
            _ => false,
        }
    }

    fn nearly(&self, half: u32, before: u32) -> bool {
        let [a, b, c] =
            self.points(half, before).map(|p| glam::DVec3::from_array(self.space.near(p)));
        let (arm, chord) = (b - a, c - a);
        arm.dot(chord) > 0.0
            && (c - b).dot(chord) > 0.0
            && arm.cross(chord).length() <= BENT * chord.length()
    }
}
