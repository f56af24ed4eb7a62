//! Edges of the boundary that the tetrahedra lack are split until their pieces are there.

use glam::DVec3;
use rustc_hash::FxHashSet;

use super::{NEW_POINTS, NoTetrahedra, Work, sorted};

/// Two edges at a corner that are closer than this in direction (cosine) keep their first points on common
/// spheres around the corner, or splitting one would call for splitting the other without end.
const ACUTE: f64 = 0.5;

/// How finely an edge is divided by one split, as a power of two: each halving of the lattice is used once.
const SHARE_BITS: u32 = 8;

impl Work {
    /// Splits edges until every piece is an edge of tetrahedra.
    pub(super) fn recover_segments(&mut self) -> Result<(), NoTetrahedra> {
        let mut segments = self.segments();
        let acute = self.acute_corners(&segments);
        loop {
            let mut split = false;
            let mut next = Vec::with_capacity(segments.len());
            let mut open: Vec<[u32; 2]> = segments;
            open.reverse();
            while let Some([a, b]) = open.pop() {
                if self.delaunay.with_corners(a, &[b]).is_some() {
                    next.push([a, b]);
                    continue;
                }
                split = true;
                let middle = self.split(a, b, &acute)?;
                open.extend([[middle, b], [a, middle]]);
            }
            segments = next;
            if !split {
                return Ok(());
            }
        }
    }

    /// The edges of all facets, each once.
    fn segments(&self) -> Vec<[u32; 2]> {
        let mut segments: Vec<[u32; 2]> =
            self.facets.iter().flat_map(|f| f.edges()).map(sorted).collect();
        segments.sort_unstable();
        segments.dedup();
        segments.retain(|[a, b]| a != b);
        segments
    }

    /// The corners at which two edges make a sharp angle.
    fn acute_corners(&self, segments: &[[u32; 2]]) -> FxHashSet<u32> {
        let points = &self.delaunay.points;
        let mut ends: Vec<[u32; 2]> =
            segments.iter().flat_map(|&[a, b]| [[a, b], [b, a]]).collect();
        ends.sort_unstable();
        let sharp = |group: &[[u32; 2]]| {
            let directions: Vec<DVec3> = group
                .iter()
                .map(|&[a, b]| (points[b as usize] - points[a as usize]).normalize_or_zero())
                .collect();
            let pair = |(i, d): (usize, &DVec3)| directions[..i].iter().any(|e| e.dot(*d) > ACUTE);
            // At a corner of very many edges two are sharp without asking.
            directions.len() > 24 || directions.iter().enumerate().any(pair)
        };
        ends.chunk_by(|x, y| x[0] == y[0])
            .filter(|group| sharp(group))
            .map(|group| group[0][0])
            .collect()
    }

    /// Splits an edge at a corner that lies on it, or at a new point.
    fn split(&mut self, a: u32, b: u32, acute: &FxHashSet<u32>) -> Result<u32, NoTetrahedra> {
        let middle = match self.corner_between(a, b) {
            Some(corner) => corner,
            None => {
                let place = self.place_to_split(a, b, acute);
                let place = place.ok_or_else(|| NoTetrahedra::Crossing { place: self.place(a) })?;
                let limit = 1000 + NEW_POINTS * self.places.len();
                if self.splits.len() > limit {
                    let corners = self.places.len();
                    return Err(NoTetrahedra::TooMany { limit, corners, place: self.place(a) });
                }
                self.delaunay.add(place)
            }
        };
        self.splits.insert(sorted([a, b]), middle);
        Ok(middle)
    }

    /// A corner that lies on the inside of an edge: the nearest to its first end is one edge of tetrahedra away.
    fn corner_between(&mut self, a: u32, b: u32) -> Option<u32> {
        let star = self.delaunay.star(a);
        let [p, q] = [a, b].map(|i| self.delaunay.points[i as usize]);
        let corners = star.into_iter().filter(|&t| !self.delaunay.is_ghost(t));
        let mut corners = corners.flat_map(|t| self.delaunay.corners(t));
        corners.find(|&c| {
            let r = self.delaunay.points[c as usize];
            let ahead = (r - p).dot(q - p) > 0.0 && (r - q).dot(p - q) > 0.0;
            c != a && c != b && ahead && on_line(q - p, r - p)
        })
    }

    /// Where to split an edge: in the middle; from an end at a sharp corner at a power of two.
    fn place_to_split(&self, a: u32, b: u32, acute: &FxHashSet<u32>) -> Option<DVec3> {
        let [p, q] = [a, b].map(|i| self.delaunay.points[i as usize]);
        let along = (q - p).to_array().map(|c| c as i64);
        // The edge has 2^parts steps from lattice point to lattice point.
        let parts = along.iter().filter(|&&c| c != 0).map(|c| c.trailing_zeros()).min()?;
        if parts == 0 {
            return None;
        }
        let length = (q - p).length();
        // The power of two nearest to half the length.
        let shell = libm::ldexp(1.0, libm::log2(length / 2.0).round() as i32) / length;
        let share = match (acute.contains(&a), acute.contains(&b)) {
            (true, false) => shell,
            (false, true) => 1.0 - shell,
            _ => 0.5,
        };
        let count = f64::from(1u32 << parts.min(SHARE_BITS));
        Some(p + (q - p) / count * (share * count).round().clamp(1.0, count - 1.0))
    }

    /// A loop of corners with the points by which its edges were split.
    pub(super) fn split_loop(&self, corners: &[u32]) -> Vec<u32> {
        let next = corners.iter().cycle().skip(1);
        let mut whole = vec![];
        for (&a, &b) in corners.iter().zip(next) {
            let mut open = vec![[a, b]];
            while let Some([a, b]) = open.pop() {
                match self.splits.get(&sorted([a, b])) {
                    Some(&middle) => open.extend([[middle, b], [a, middle]]),
                    None => whole.push(a),
                }
            }
        }
        whole
    }
}

/// Whether two integer vectors have one direction, exactly.
fn on_line(p: DVec3, q: DVec3) -> bool {
    let [p, q] = [p, q].map(|v| v.to_array().map(|c| c as i128));
    (0..3).all(|i| {
        let j = (i + 1) % 3;
        p[i] * q[j] == p[j] * q[i]
    })
}
