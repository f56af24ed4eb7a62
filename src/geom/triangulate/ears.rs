//! Ear cutting, for faces that cross themselves: it always ends and always uses every corner.
//!
//! Source: G. H. Meisters, *Polygons Have Ears*, 1975. Holes are first joined to the outer loop by
//! bridges. Where no ear is left the corner that turns most is cut as if it were one.

use super::PlaneFace;

/// Corners looked at while seeking true ears before the rest is cut by turn alone: bounds the time for
/// large faces that cross themselves everywhere.
const EAR_TESTS: usize = 20_000_000;

/// Corners + 2 holes - 2 triangles over corner numbers.
pub(super) fn triangles(face: &PlaneFace) -> Vec<[u32; 3]> {
    let mut ring = Ring::new(face, bridged(face));
    let mut triangles = Vec::with_capacity(ring.left);
    while ring.left > 3 {
        let ear = ring.ear().unwrap_or_else(|| ring.sharpest());
        triangles.push(ring.cut(ear));
    }
    triangles.push(ring.triangle(ring.at));
    triangles
}

/// One loop through all corners: each hole is entered from the corner nearest to its leftmost one, and
/// left the same way.
fn bridged(face: &PlaneFace) -> Vec<u32> {
    let x = |c: u32| face.plane[c as usize].x;
    let leftmost = |w: &[u32]| (w[0]..w[1]).min_by(|&a, &b| x(a).total_cmp(&x(b)));
    let mut doors: Vec<(u32, u32, u32)> =
        (face.starts.windows(2).skip(1)).filter_map(|w| Some((leftmost(w)?, w[0], w[1]))).collect();
    doors.sort_by(|a, b| x(a.0).total_cmp(&x(b.0)));
    let mut ring: Vec<u32> = (0..face.starts[1]).collect();
    for (door, start, end) in doors {
        let p = face.plane[door as usize];
        let distance = |c: u32| face.plane[c as usize].distance_squared(p);
        let nearest = (0..ring.len())
            .min_by(|&i, &j| distance(ring[i]).total_cmp(&distance(ring[j])))
            .expect("a loop has corners");
        let back = ring[nearest];
        let hole = (door..end).chain(start..door).chain([door, back]);
        ring.splice(nearest + 1..nearest + 1, hole);
    }
    ring
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
}

impl<'a> Ring<'a> {
    fn new(face: &'a PlaneFace, corners: Vec<u32>) -> Ring<'a> {
        let n = corners.len() as u32;
        let next = (0..n).map(|i| (i + 1) % n).collect();
        let prev = (0..n).map(|i| (i + n - 1) % n).collect();
        Ring { face, left: corners.len(), corners, next, prev, at: 0, tests: EAR_TESTS }
    }

    fn triangle(&self, i: u32) -> [u32; 3] {
        [self.prev[i as usize], i, self.next[i as usize]].map(|k| self.corners[k as usize])
    }

    fn turn(&self, i: u32) -> f64 {
        let [a, b, c] = self.triangle(i);
        self.face.turn(a, b, c)
    }

    fn cut(&mut self, i: u32) -> [u32; 3] {
        let triangle = self.triangle(i);
        let (before, after) = (self.prev[i as usize], self.next[i as usize]);
        self.next[before as usize] = after;
        self.prev[after as usize] = before;
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
            if tests < self.left || self.turn(i) <= 0.0 {
                return false;
            }
            tests -= self.left;
            self.is_ear(i)
        });
        self.tests = tests;
        found
    }

    fn is_ear(&self, i: u32) -> bool {
        let [a, b, c] = self.triangle(i);
        let place = |k: u32| self.face.plane[k as usize];
        let is_end = |k: u32| [a, b, c].iter().any(|&e| place(e) == place(k));
        let holds = |k: u32| {
            let sides = [(a, b), (b, c), (c, a)];
            sides.iter().all(|&(p, q)| self.face.turn(p, q, k) >= 0.0)
        };
        !self.around().map(|j| self.corners[j as usize]).any(|k| !is_end(k) && holds(k))
    }

    /// The corner that turns left most.
    fn sharpest(&self) -> u32 {
        let sharper = |best: (f64, u32), i: u32| {
            let [a, b, c] = self.triangle(i);
            // The two ends of a bridge are one corner twice: no triangle there.
            let turn = if a == c { f64::NEG_INFINITY } else { self.face.turn(a, b, c) };
            if turn > best.0 { (turn, i) } else { best }
        };
        self.around().fold((f64::NEG_INFINITY, self.at), sharper).1
    }
}
