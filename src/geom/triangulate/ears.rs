//! Ear cutting, for faces that cross themselves: it always ends and always uses every corner.
//!
//! Source: G. H. Meisters, *Polygons Have Ears*, 1975. Holes are first joined to the outer loop by
//! bridges. Where no ear is left the corner that turns most is cut as if it were one.

use glam::{DVec2, dvec2};

use super::PlaneFace;

/// Corners looked at while seeking ears before the rest is cut as a fan: bounds the time for large faces
/// that cross themselves everywhere.
const EAR_TESTS: usize = 30_000_000;

/// Corners + 2 holes - 2 triangles over corner numbers.
pub(super) fn triangles(face: &PlaneFace) -> Vec<[u32; 3]> {
    let mut ring = Ring::new(face, bridged(face));
    let mut triangles = Vec::with_capacity(ring.left);
    while ring.left > 3 {
        let ear = ring.ear().or_else(|| ring.sharpest()).unwrap_or(ring.at);
        triangles.push(ring.cut(ear));
    }
    triangles.push(ring.triangle(ring.at));
    triangles
}

/// One loop through all corners: each hole, from the left, is entered at its leftmost corner and left the
/// same way.
fn bridged(face: &PlaneFace) -> Vec<u32> {
    let x = |c: u32| face.plane[c as usize].x;
    let leftmost = |w: &[u32]| (w[0]..w[1]).min_by(|&a, &b| x(a).total_cmp(&x(b)));
    let mut doors: Vec<(u32, u32, u32)> =
        (face.starts.windows(2).skip(1)).filter_map(|w| Some((leftmost(w)?, w[0], w[1]))).collect();
    doors.sort_by(|a, b| x(a.0).total_cmp(&x(b.0)));
    let mut ring: Vec<u32> = (0..face.starts[1]).collect();
    for (door, start, end) in doors {
        let place = bridge_to(face, &ring, face.plane[door as usize]);
        let back = ring[place];
        let hole = (door..end).chain(start..door).chain([door, back]);
        ring.splice(place + 1..place + 1, hole);
    }
    ring
}

/// The place in the ring of a corner that a point sees to its left: an end of the edge straight to the left,
/// or a corner that stands before it (Eberly, *Triangulation by Ear Clipping*, 2002).
fn bridge_to(face: &PlaneFace, ring: &[u32], p: DVec2) -> usize {
    let at = |i: usize| face.plane[ring[i % ring.len()] as usize];
    let mut hit: Option<(f64, usize)> = None;
    for i in 0..ring.len() {
        let (a, b) = (at(i), at(i + 1));
        if (a.y - p.y) * (b.y - p.y) <= 0.0 && a.y != b.y {
            let x = a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y));
            if x <= p.x && hit.is_none_or(|(most, _)| x > most) {
                hit = Some((x, if a.x > b.x { i } else { (i + 1) % ring.len() }));
            }
        }
    }
    let Some((x, place)) = hit else { return 0 };
    let corners = [p, dvec2(x, p.y), at(place)];
    let sign = super::orient2d(corners[0], corners[1], corners[2]);
    if sign == 0.0 {
        return place;
    }
    let inside = |q: DVec2| {
        let turn = |k: usize| super::orient2d(corners[k], corners[(k + 1) % 3], q) * sign.signum();
        turn(0) >= 0.0 && turn(1) >= 0.0 && turn(2) >= 0.0
    };
    let slope = |i: usize| (at(i).y - p.y).abs() / (p.x - at(i).x).abs();
    let before = (0..ring.len()).filter(|&i| at(i) != p && at(i) != corners[2] && inside(at(i)));
    before.min_by(|&i, &j| slope(i).total_cmp(&slope(j))).unwrap_or(place)
}

/// What is left of the loop.
struct Ring<'a> {
    face: &'a PlaneFace,
    corners: Vec<u32>,
    next: Vec<u32>,
    prev: Vec<u32>,
    at: u32,
    left: usize,
    tests: usize,
    grid: Grid,
}

impl<'a> Ring<'a> {
    fn new(face: &'a PlaneFace, corners: Vec<u32>) -> Ring<'a> {
        let n = corners.len() as u32;
        let next = (0..n).map(|i| (i + 1) % n).collect();
        let prev = (0..n).map(|i| (i + n - 1) % n).collect();
        let places: Vec<DVec2> = corners.iter().map(|&c| face.plane[c as usize]).collect();
        let grid = Grid::new(&places);
        Ring { face, left: corners.len(), corners, next, prev, at: 0, tests: EAR_TESTS, grid }
    }

    fn triangle(&self, i: u32) -> [u32; 3] {
        [self.prev[i as usize], i, self.next[i as usize]].map(|k| self.corners[k as usize])
    }

    fn cut(&mut self, i: u32) -> [u32; 3] {
        let triangle = self.triangle(i);
        let (before, after) = (self.prev[i as usize], self.next[i as usize]);
        self.next[before as usize] = after;
        self.prev[after as usize] = before;
        // A corner that is gone is its own neighbour.
        (self.next[i as usize], self.prev[i as usize]) = (i, i);
        (self.at, self.left) = (after, self.left - 1);
        triangle
    }

    fn around(&self) -> impl Iterator<Item = u32> + '_ {
        std::iter::successors(Some(self.at), |&i| Some(self.next[i as usize])).take(self.left)
    }

    /// The first corner that can be cut off without touching another.
    fn ear(&mut self) -> Option<u32> {
        let mut tests = self.tests;
        let found = self.around().find(|&i| {
            let [a, b, c] = self.triangle(i);
            tests = tests.saturating_sub(1);
            tests > 0 && self.face.turn(a, b, c) > 0.0 && self.is_ear([a, b, c], &mut tests)
        });
        self.tests = tests;
        found
    }

    fn is_ear(&self, [a, b, c]: [u32; 3], tests: &mut usize) -> bool {
        let place = |k: u32| self.face.plane[k as usize];
        let ends = [a, b, c].map(place);
        // Corners on the two edges belong to bridges or to the crossing; one on the cut would be in the way.
        let holds = |k: u32| {
            !ends.contains(&place(k))
                && self.face.turn(a, b, k) > 0.0
                && self.face.turn(b, c, k) > 0.0
                && self.face.turn(c, a, k) >= 0.0
        };
        let free = self.grid.all_in(ends, |i| {
            *tests = tests.saturating_sub(1);
            self.next[i as usize] == i || !holds(self.corners[i as usize])
        });
        free && *tests > 0
    }

    /// The corner that turns left most; `None` when no more tests are left.
    fn sharpest(&mut self) -> Option<u32> {
        if self.tests < self.left {
            return None;
        }
        self.tests -= self.left;
        let sharper = |best: (f64, u32), i: u32| {
            let [a, b, c] = self.triangle(i);
            // The two ends of a bridge are one corner twice: no triangle there.
            let turn = if a == c { f64::NEG_INFINITY } else { self.face.turn(a, b, c) };
            if turn > best.0 { (turn, i) } else { best }
        };
        Some(self.around().fold((f64::NEG_INFINITY, self.at), sharper).1)
    }
}

/// Places sorted into square cells, about one in each.
struct Grid {
    min: DVec2,
    /// Cells in a millimetre.
    scale: DVec2,
    width: usize,
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Grid {
    fn new(places: &[DVec2]) -> Grid {
        let min = places.iter().fold(DVec2::INFINITY, |m, p| m.min(*p));
        let max = places.iter().fold(DVec2::NEG_INFINITY, |m, p| m.max(*p));
        let width = ((places.len() as f64).sqrt() as usize).max(1);
        let scale = width as f64 / (max - min).max(DVec2::splat(f64::MIN_POSITIVE));
        let mut grid =
            Grid { min, scale, width, starts: vec![0; width * width + 1], members: vec![] };
        let cell = |p: &DVec2| grid.cell(*p);
        let mut keyed: Vec<(usize, u32)> =
            places.iter().map(|p| cell(p)[1] * width + cell(p)[0]).zip(0..).collect();
        keyed.sort_unstable();
        keyed.iter().for_each(|(key, _)| grid.starts[key + 1] += 1);
        (1..grid.starts.len()).for_each(|i| grid.starts[i] += grid.starts[i - 1]);
        grid.members = keyed.into_iter().map(|(_, i)| i).collect();
        grid
    }

    fn cell(&self, p: DVec2) -> [usize; 2] {
        let cell = (p - self.min) * self.scale;
        cell.to_array().map(|v| (v as usize).min(self.width - 1))
    }

    /// Whether `test` holds for all places in the cells that a triangle's box meets.
    fn all_in(&self, [a, b, c]: [DVec2; 3], mut test: impl FnMut(u32) -> bool) -> bool {
        let (low, high) = (self.cell(a.min(b).min(c)), self.cell(a.max(b).max(c)));
        (low[1]..=high[1]).all(|row| {
            let from = self.starts[row * self.width + low[0]] as usize;
            let to = self.starts[row * self.width + high[0] + 1] as usize;
            self.members[from..to].iter().all(|&i| test(i))
        })
    }
}
