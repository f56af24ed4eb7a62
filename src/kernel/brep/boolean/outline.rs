//! The outlines of merged polygons: loops, the vertices where they meet, and which of those stay.
//!
//! Around a point every fan of linked polygons gets a vertex of its own, so solids that touch in a
//! point come apart. A polygon that touches itself in a point is in the fan there twice. A vertex where only two polygons meet, along one straight line, is dropped,
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

/// What a loop meets only once: polygons whose outlines meet it again are cut there.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Once {
    /// Every point.
    Point,
    /// Every vertex; vertices of several fans may stand in one point.
    Vertex,
}

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
    pub fn of(boundary: &Boundary, borders: &Borders, complex: &Complex, once: Once) -> Outline {
        let count = boundary.twin.len();
        let walks = Walks::of(boundary);
        let vertex = walks.vertices(boundary, borders, complex);
        let (loops, halves) = match once {
            Once::Point => walks.cut(&boundary.at, complex.point_count()),
            Once::Vertex => walks.cut(&vertex, count),
        };
        let [next, before] = [0; 2].map(|_| vec![NONE; count]);
        let mut outline = Outline { loops, halves, next, before, vertex };
        for edge in &outline.loops {
            let halves = &outline.halves[edge.from as usize..edge.to as usize];
            let mut before = halves[halves.len() - 1];
            for &half in halves {
                outline.next[before as usize] = half;
                outline.before[half as usize] = before;
                before = half;
            }
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

/// The way around every merged polygon, the polygon on its left.
struct Walks {
    list: Vec<Loop>,
    halves: Vec<u32>,
}

impl Walks {
    fn of(boundary: &Boundary) -> Walks {
        let mut done = vec![false; boundary.twin.len()];
        let (mut list, mut halves) = (vec![], Vec::with_capacity(boundary.twin.len()));
        for start in boundary.outer() {
            if done[start as usize] {
                continue;
            }
            let (from, mut half) = (halves.len() as u32, start);
            while !done[half as usize] {
                done[half as usize] = true;
                halves.push(half);
                half = boundary.next[half as usize];
                while boundary.is_inner(half) {
                    half = boundary.next[boundary.twin[half as usize] as usize];
                }
            }
            let polygon = boundary.polygon[start as usize];
            list.push(Loop { polygon, from, to: halves.len() as u32 });
        }
        Walks { list, halves }
    }

    fn halves(&self, walk: &Loop) -> &[u32] {
        &self.halves[walk.from as usize..walk.to as usize]
    }

    /// The vertex at the start of each half-edge: one for every fan of polygons, known by one of the
    /// half-edges that leave it.
    fn vertices(&self, boundary: &Boundary, borders: &Borders, complex: &Complex) -> Vec<u32> {
        let mut next = vec![NONE; boundary.twin.len()];
        for halves in self.list.iter().map(|walk| self.halves(walk)) {
            let mut before = halves[halves.len() - 1];
            for &half in halves {
                next[before as usize] = half;
                before = half;
            }
        }
        let mut sets = Sets::new(next.len());
        let mut leaving = vec![NONE; complex.point_count()];
        for half in boundary.outer() {
            if borders.patch(boundary.origin[half as usize]).is_some() {
                let first = &mut leaving[boundary.at[half as usize] as usize];
                *first = half.min(*first);
                sets.join(half, *first);
            } else {
                sets.join(half, next[boundary.twin[half as usize] as usize]);
            }
        }
        let mut vertex = vec![NONE; next.len()];
        boundary.outer().for_each(|half| vertex[half as usize] = sets.find(half));
        vertex
    }

    /// Loops that meet nothing twice, and their half-edges; `at` says what each half-edge meets.
    fn cut(&self, at: &[u32], count: usize) -> (Vec<Loop>, Vec<u32>) {
        // The walk that met each thing last.
        let mut met = vec![NONE; count];
        let (mut loops, mut all) = (vec![], Vec::with_capacity(self.halves.len()));
        for (number, walk) in (0u32..).zip(&self.list) {
            let halves = self.halves(walk);
            let mut is_simple = true;
            for &half in halves {
                let met = &mut met[at[half as usize] as usize];
                is_simple &= *met != number;
                *met = number;
            }
            let mut add = |part: &[u32]| {
                let from = all.len() as u32;
                all.extend_from_slice(part);
                loops.push(Loop { polygon: walk.polygon, from, to: all.len() as u32 });
            };
            match is_simple {
                true => add(halves),
                false => simple(halves.to_vec(), at).iter().for_each(|part| add(part)),
            }
        }
        loops.sort_by_key(|l| l.polygon);
        (loops, all)
    }
}

/// Cuts a walk that meets something more than once into loops that do not.
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
        let is_piece = |f: Option<Flat>| matches!(f, Some(Flat::Piece(_)));
        if mine == other || is_piece(mine) || is_piece(other) {
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
