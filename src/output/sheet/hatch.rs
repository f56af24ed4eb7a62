//! Hatching of cut faces (ISO 128-3).

use glam::{DVec2, dvec2};

use crate::geom::trig::{cos_deg, sin_deg};

/// Directions of the hatch lines of parts that follow one another, degrees.
const ANGLES: [f64; 4] = [45.0, 135.0, 30.0, 120.0];

/// How much the lines of later parts stand closer, once the directions are used up.
const CLOSER: f64 = 0.7;

/// Lines on one area: more would be solid black and cost memory without end.
const MOST_LINES: f64 = 100_000.0;

/// The cut faces of one part on the picture plane, mm at scale 1.
#[derive(Clone, PartialEq, Debug)]
pub struct Cut {
    /// Closed polygons (even-odd).
    pub rings: Vec<Vec<DVec2>>,
    /// The number of the part: it decides direction and distance of the hatch.
    pub body: u32,
    /// How far the polygons may be from their true outlines, mm.
    pub tolerance: f64,
}

impl Cut {
    fn edges(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        self.rings.iter().flat_map(|ring| {
            let next = ring.iter().cycle().skip(1);
            ring.iter().zip(next).map(|(&a, &b)| [a, b])
        })
    }

    /// Whether a point lies on the outline, as far as that is known.
    pub fn has_on_outline(&self, p: DVec2) -> bool {
        self.edges().any(|[a, b]| {
            let along = b - a;
            let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            (a + along * t).distance(p) <= self.tolerance
        })
    }
}

/// The hatch lines of a cut at a scale, with a distance on paper. Lines of all cuts of a part are in step.
pub fn hatched(cut: &Cut, scale: f64, pitch: f64) -> Vec<[DVec2; 2]> {
    let number = cut.body as usize;
    let angle = ANGLES[number % ANGLES.len()];
    let pitch = pitch * libm::pow(CLOSER, (number / ANGLES.len() % 3) as f64);
    let along = dvec2(cos_deg(angle), sin_deg(angle));
    let across = along.perp();
    let height = |p: DVec2| p.dot(across) * scale;
    let heights = || cut.rings.iter().flatten().map(|&p| height(p));
    let (low, high) = (heights().fold(f64::MAX, f64::min), heights().fold(f64::MIN, f64::max));
    if !(low < high && (high - low) / pitch < MOST_LINES) {
        return vec![];
    }
    let row_of = |h: f64| (h / pitch).ceil() as i64;
    let first = row_of(low);
    let mut rows: Vec<Vec<f64>> = vec![vec![]; (row_of(high) - first).max(0) as usize];
    for [a, b] in cut.edges() {
        let (from, to) = (height(a), height(b));
        for row in row_of(from.min(to))..row_of(from.max(to)) {
            let t = (row as f64 * pitch - from) / (to - from);
            rows[(row - first) as usize].push(a.lerp(b, t).dot(along) * scale);
        }
    }
    let mut lines = vec![];
    for (row, places) in (first..).zip(&mut rows) {
        places.sort_by(f64::total_cmp);
        let base = across * (row as f64 * pitch);
        lines.extend(places.chunks_exact(2).map(|ends| [0, 1].map(|i| base + along * ends[i])));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f64, high: f64) -> Vec<DVec2> {
        vec![dvec2(low, low), dvec2(high, low), dvec2(high, high), dvec2(low, high)]
    }

    #[test]
    fn lines_cover_the_area_and_spare_the_hole() {
        let cut =
            Cut { rings: vec![square(0.0, 100.0), square(40.0, 60.0)], body: 0, tolerance: 0.0 };
        let length: f64 = hatched(&cut, 1.0, 0.1).iter().map(|[a, b]| a.distance(*b)).sum();
        assert!((length * 0.1 - 9600.0).abs() < 10.0, "{length}");
        let half: f64 = hatched(&cut, 0.5, 0.1).iter().map(|[a, b]| a.distance(*b)).sum();
        assert!((half * 0.1 - 2400.0).abs() < 5.0, "{half}");
    }

    #[test]
    fn too_fine_a_hatch_is_left_out() {
        let cut = Cut { rings: vec![square(0.0, 1e6)], body: 0, tolerance: 0.0 };
        assert!(hatched(&cut, 1.0, 1e-3).is_empty());
    }
}
