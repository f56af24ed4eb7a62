//! Edge flips towards the Delaunay triangulation (Lawson 1977), so that slivers go where they can.

use glam::DVec3;

use super::PlaneFace;

/// The cotangents of the two angles over an edge must sum to less than minus this before the edge is
/// flipped: rounding alone never is a reason, so no pair of flips undoes itself.
const CLEARLY: f64 = 1e-9;
/// Flips allowed for each triangle. From a sweep a few suffice; the bound keeps bad cases linear.
const FLIPS_PER_TRIANGLE: usize = 24;

const NONE: u32 = u32::MAX;

/// Whether the edge a-b, seen from c and d on its two sides, should give way to c-d: the angles at c
/// and d sum to more than half a turn.
pub(super) fn wanted(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> bool {
    let cotangent = |apex: DVec3| {
        let (u, v) = (a - apex, b - apex);
        u.dot(v) / u.cross(v).length()
    };
    cotangent(c) + cotangent(d) < -CLEARLY
}

/// Flips inner edges of a face's triangles until all are near Delaunay. Makes no triangle that is not
/// strictly counter-clockwise.
pub(super) fn improve(face: &PlaneFace, triangles: &mut [[u32; 3]]) {
    let mut edges = Edges { face, twin: twins(triangles, face.len()), triangles };
    let count = edges.twin.len() as u32;
    // Both ways along an edge are the same question, and a flip asks anew about all edges around it.
    let is_first = |edge: &u32| (*edge..count).contains(&edges.twin[*edge as usize]);
    let mut open: Vec<u32> = (0..count).rev().filter(is_first).collect();
    let mut left = FLIPS_PER_TRIANGLE * edges.triangles.len();
    while let Some(edge) = open.pop() {
        if left > 0 && edges.should_flip(edge) {
            left -= 1;
            open.extend(edges.flip(edge));
        }
    }
}

/// Faces with no more corners have a table of all pairs.
const FEW: usize = 16;

/// For each half-edge 3 t + k (corner k to corner k + 1 of triangle t) the only one that runs back, if it is the only
/// one that runs forth.
fn twins(triangles: &[[u32; 3]], corners: usize) -> Vec<u32> {
    let mut twin = vec![NONE; 3 * triangles.len()];
    let start = |h: u32| triangles[h as usize / 3][h as usize % 3];
    let mut join = |e: u32, f: u32| {
        if start(e) != start(f) {
            (twin[e as usize], twin[f as usize]) = (f, e);
        }
    };
    let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let sides = (0u32..).zip(sides.map(|side| side.map(|corner| corner as usize)));
    if corners <= FEW {
        // One more than the half-edge, 0 for none, or the highest for several.
        let mut table = [[0u8; FEW]; FEW];
        for (h, [a, b]) in sides.clone() {
            let place = &mut table[a][b];
            *place = if *place == 0 { h as u8 + 1 } else { u8::MAX };
        }
        for (e, [a, b]) in sides.filter(|(_, [a, b])| a < b) {
            let [forth, back] = [table[a][b], table[b][a]].map(u32::from);
            if forth == e + 1 && back != 0 && back != u32::from(u8::MAX) {
                join(e, back - 1);
            }
        }
        return twin;
    }
    let key = |(h, [a, b]): (u32, [usize; 2])| ((a.min(b) as u64) << 32 | a.max(b) as u64, h);
    let mut keyed: Vec<(u64, u32)> = Vec::with_capacity(3 * triangles.len());
    keyed.extend(sides.map(key));
    keyed.sort_unstable();
    for pair in keyed.chunk_by(|a, b| a.0 == b.0) {
        if let &[(_, e), (_, f)] = pair {
            join(e, f);
        }
    }
    twin
}

struct Edges<'a> {
    face: &'a PlaneFace,
    twin: Vec<u32>,
    triangles: &'a mut [[u32; 3]],
}

fn following(edge: u32) -> u32 {
    if edge % 3 == 2 { edge - 2 } else { edge + 1 }
}

fn preceding(edge: u32) -> u32 {
    if edge.is_multiple_of(3) { edge + 2 } else { edge - 1 }
}

impl Edges<'_> {
    fn start(&self, edge: u32) -> u32 {
        self.triangles[edge as usize / 3][edge as usize % 3]
    }

    fn should_flip(&self, edge: u32) -> bool {
        let twin = self.twin[edge as usize];
        if twin == NONE {
            return false;
        }
        let (a, b) = (self.start(edge), self.start(twin));
        let (c, d) = (self.start(preceding(edge)), self.start(preceding(twin)));
        let [pa, pb, pc, pd] = [a, b, c, d].map(|k| self.face.space[k as usize]);
        wanted(pa, pb, pc, pd) && self.face.turn(d, b, c) > 0.0 && self.face.turn(c, a, d) > 0.0
    }

    /// Turns the edge inside its two triangles; gives the four edges around them.
    fn flip(&mut self, edge: u32) -> [u32; 4] {
        let twin = self.twin[edge as usize];
        let (left, right) = (preceding(edge), preceding(twin));
        let (c, d) = (self.start(left), self.start(right));
        self.triangles[edge as usize / 3][edge as usize % 3] = d;
        self.triangles[twin as usize / 3][twin as usize % 3] = c;
        self.join(edge, self.twin[right as usize]);
        self.join(twin, self.twin[left as usize]);
        self.join(left, right);
        [edge, following(edge), twin, following(twin)]
    }

    fn join(&mut self, e: u32, f: u32) {
        self.twin[e as usize] = f;
        if f != NONE {
            self.twin[f as usize] = e;
        }
    }
}
