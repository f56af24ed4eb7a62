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
    let mut edges = Edges { face, twin: twins(triangles), triangles };
    let mut open: Vec<u32> = (0..edges.twin.len() as u32).rev().collect();
    let mut left = FLIPS_PER_TRIANGLE * edges.triangles.len();
    while let Some(edge) = open.pop() {
        if left > 0 && edges.should_flip(edge) {
            left -= 1;
            open.extend(edges.flip(edge));
        }
    }
}

/// For each half-edge 3 t + k (corner k to corner k + 1 of triangle t) the one that runs back.
fn twins(triangles: &[[u32; 3]]) -> Vec<u32> {
    let ends = |t: &[u32; 3], k: usize| (t[k], t[(k + 1) % 3]);
    let mut keyed: Vec<(u64, u32)> = Vec::with_capacity(3 * triangles.len());
    for (i, t) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = ends(t, k);
            keyed.push((u64::from(a.min(b)) << 32 | u64::from(a.max(b)), (3 * i + k) as u32));
        }
    }
    keyed.sort_unstable();
    let mut twin = vec![NONE; 3 * triangles.len()];
    for pair in keyed.chunk_by(|a, b| a.0 == b.0) {
        let &[(_, e), (_, f)] = pair else { continue };
        let start = |h: u32| triangles[h as usize / 3][h as usize % 3];
        if start(e) != start(f) {
            (twin[e as usize], twin[f as usize]) = (f, e);
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
