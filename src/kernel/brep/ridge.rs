//! Extrusions whose top shrinks to a line: a roof with its ridge along one axis.
//!
//! The figure is cut into strips across the ridge at all its corners. In each strip the inside lies between
//! pairs of edges, and both edges of a pair rise to the same piece of the ridge. Pieces of one ridge meet where
//! the inside goes on from strip to strip; two that lie at the same place, over both sides of a hole, stay apart.

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::{Polyhedron, band::add_point, flank::Origins};
use crate::geom::{Contour, PolyMesh, Region, Surface, Tolerance, region::EdgeCurve};

/// Strips between two neighbouring corners, at most.
const MOST_STRIPS: f64 = 256.0;

/// The most parts that strips may cut the edges into.
const MOST_PARTS: usize = 2_000_000;

/// A part of an edge within one strip, or along the border of strips.
struct Part {
    from: u32,
    to: u32,
    curve: EdgeCurve,
    strip: Option<usize>,
    /// Whether it runs towards larger coordinates along the ridge.
    forward: bool,
    /// Coordinates across the ridge at the strip's lower and upper border.
    across: [f64; 2],
    /// The points of the ridge over `from` and `to`.
    over: [u32; 2],
}

/// Draws a region to a ridge at `height`: along x with the factor `scale.x` if `scale.y` is 0, else along y.
/// `None` if that takes more than two million parts of edges.
pub(super) fn roof(
    region: &Region,
    height: f64,
    scale: DVec2,
    tolerance: Tolerance,
) -> Option<Polyhedron> {
    let along_x = scale.y == 0.0;
    let mut roof = Roof {
        mesh: PolyMesh::default(),
        origins: Origins::default(),
        along: if along_x { |p| p.x } else { |p| p.y },
        across: if along_x { |p| p.y } else { |p| p.x },
        levels: vec![],
        parts: vec![],
    };
    roof.levels = roof.strips(region, tolerance);
    let count =
        region.contours().flat_map(Contour::edges).map(|e| roof.crossed(e.from, e.to).len() + 1);
    if count.sum::<usize>() > MOST_PARTS {
        return None;
    }
    let floor: Vec<Vec<Vec<usize>>> = region
        .pieces
        .iter()
        .map(|p| std::iter::once(&p.outer).chain(&p.holes).map(|c| roof.split(c)).collect())
        .collect();
    let factor = scale.max_element();
    let place = |level: f64| {
        if along_x {
            dvec3(level * factor, 0.0, height)
        } else {
            dvec3(0.0, level * factor, height)
        }
    };
    roof.raise(place);
    for loops in floor {
        roof.faces(&loops);
    }
    Some(Polyhedron::trusted(roof.mesh))
}

struct Roof {
    mesh: PolyMesh,
    origins: Origins,
    /// The coordinate along the ridge.
    along: fn(DVec2) -> f64,
    /// The coordinate across it.
    across: fn(DVec2) -> f64,
    /// Borders of the strips, in order.
    levels: Vec<f64>,
    parts: Vec<Part>,
}

/// A pair of edges with the inside between them, and its two points of the ridge as numbers.
struct Pair {
    parts: [usize; 2],
    ends: [usize; 2],
}

impl Roof {
    /// Borders at all corners, and between them so many that no facet leaves the ruled surface by more than
    /// the tolerance; at least one, which keeps ridges with common ends apart.
    fn strips(&self, region: &Region, tolerance: Tolerance) -> Vec<f64> {
        let corners = region.contours().flat_map(|c| &c.points);
        let mut levels: Vec<f64> = corners.map(|p| (self.along)(*p) + 0.0).collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let steepest = region.contours().flat_map(Contour::edges).map(|e| {
            let d = e.to - e.from;
            (self.across)(d).abs() / d.length()
        });
        let lean = steepest.fold(0.0, f64::max);
        let mut all = vec![];
        for pair in levels.windows(2) {
            let width = pair[1] - pair[0];
            let count = (width * lean / 4.0 / tolerance.mm()).ceil().clamp(2.0, MOST_STRIPS);
            all.extend((0..count as u32).map(|i| pair[0] + width * (f64::from(i) / count)));
        }
        all.extend(levels.last());
        all.dedup();
        all
    }

    /// The strips that an edge crosses.
    fn crossed(&self, from: DVec2, to: DVec2) -> std::ops::Range<usize> {
        let (a, b) = ((self.along)(from), (self.along)(to));
        let place = |v: f64| self.levels.partition_point(|l| *l < v);
        place(a.min(b))..place(a.max(b))
    }

    /// Adds the corners of a contour at z = 0, and on its edges those at the borders; gives its parts.
    fn split(&mut self, contour: &Contour) -> Vec<usize> {
        let first = self.parts.len();
        let start = self.mesh.points.len() as u32;
        for e in contour.edges() {
            let (a, b) = ((self.along)(e.from), (self.along)(e.to));
            let mut strips: Vec<Option<usize>> = self.crossed(e.from, e.to).map(Some).collect();
            if a == b {
                strips.push(None);
            } else if a > b {
                strips.reverse();
            }
            for strip in strips {
                let at = |level: f64| {
                    let t = (level - a) / (b - a);
                    (self.across)(e.from) * (1.0 - t) + (self.across)(e.to) * t
                };
                let across =
                    strip.map_or([0.0; 2], |s| [at(self.levels[s]), at(self.levels[s + 1])]);
                let begin = strip.map_or(a, |s| self.levels[s + usize::from(a > b)]);
                let p =
                    if begin == a { e.from } else { self.point(begin, across[usize::from(a > b)]) };
                let here = add_point(&mut self.mesh, p.extend(0.0));
                let (curve, forward) = (e.curve, a < b);
                let part =
                    Part { from: here, to: here + 1, curve, strip, forward, across, over: [0; 2] };
                self.parts.push(part);
            }
        }
        if let Some(last) = self.parts.last_mut() {
            last.to = start;
        }
        (first..self.parts.len()).collect()
    }

    fn point(&self, along: f64, across: f64) -> DVec2 {
        let swapped = (self.along)(DVec2::X) == 0.0;
        if swapped { dvec2(across, along) } else { dvec2(along, across) }
    }

    /// Finds the pairs of each strip and makes the points of the ridge.
    fn raise(&mut self, place: impl Fn(f64) -> DVec3) {
        let mut strips: Vec<Vec<usize>> = vec![vec![]; self.levels.len()];
        for (i, part) in self.parts.iter().enumerate() {
            if let Some(strip) = part.strip {
                strips[strip].push(i);
            }
        }
        let mut before: Vec<Pair> = vec![];
        let mut root: Vec<usize> = vec![];
        let mut level_of = vec![];
        let mut pairs = vec![];
        for (strip, mut parts) in strips.into_iter().enumerate() {
            let middle = |i: &usize| self.parts[*i].across.iter().sum::<f64>();
            parts.sort_by(|i, j| middle(i).total_cmp(&middle(j)));
            let mut here: Vec<Pair> = vec![];
            for two in parts.chunks_exact(2) {
                let ends = [root.len(), root.len() + 1];
                root.extend(ends);
                level_of.extend([self.levels[strip], self.levels[strip + 1]]);
                here.push(Pair { parts: [two[0], two[1]], ends });
            }
            self.join(&before, &here, &mut root);
            pairs.append(&mut before);
            before = here;
        }
        pairs.append(&mut before);
        let mut number = vec![None; root.len()];
        for pair in &pairs {
            let [low, high] = pair.ends.map(|end| {
                let node = find(&root, end);
                let mesh = &mut self.mesh;
                *number[node].get_or_insert_with(|| add_point(mesh, place(level_of[node])))
            });
            for part in pair.parts.map(|i| i as u32) {
                let part = &mut self.parts[part as usize];
                part.over = if part.forward { [low, high] } else { [high, low] };
            }
        }
    }

    /// Joins the ridges of pairs on both sides of a border that share more than a point of it.
    fn join(&self, below: &[Pair], above: &[Pair], root: &mut [usize]) {
        let (mut i, mut j) = (0, 0);
        while i < below.len() && j < above.len() {
            let [a, b] = below[i].parts.map(|p| self.parts[p].across[1]);
            let [c, d] = above[j].parts.map(|p| self.parts[p].across[0]);
            if a.max(c) < b.min(d) {
                let (p, q) = (find(root, below[i].ends[1]), find(root, above[j].ends[0]));
                root[p.max(q)] = p.min(q);
            }
            if b < d { i += 1 } else { j += 1 }
        }
    }

    /// The floor of a piece and the flanks over its contours.
    fn faces(&mut self, loops: &[Vec<usize>]) {
        let flat = self.origins.flat(&mut self.mesh);
        let outline = |l: &Vec<usize>| l.iter().rev().map(|&i| self.parts[i].from).collect();
        let floor: Vec<Vec<u32>> = loops.iter().map(outline).collect();
        let plane = self.mesh.add_plane();
        self.mesh.push_face(&floor, plane, flat);
        for parts in loops {
            // The ridge over a part along a border is that over the end of the part before it.
            let last = parts.iter().rev().find(|&&i| self.parts[i].strip.is_some());
            let mut over = last.map_or(0, |&i| self.parts[i].over[1]);
            for &i in parts {
                let part = &self.parts[i];
                let (from, to) = (part.from, part.to);
                let upright = part.strip.is_none() || part.across[0] == part.across[1];
                let surface = if upright { Surface::Plane } else { Surface::Facets };
                let origin = self.origins.of(&mut self.mesh, part.curve, surface);
                match part.strip {
                    None => self.push(&[from, to, over], origin),
                    Some(_) => {
                        let [over_from, over_to] = part.over;
                        over = over_to;
                        if upright {
                            self.push(&[from, to, over_to, over_from], origin);
                        } else {
                            self.push(&[from, to, over_to], origin);
                            self.push(&[from, over_to, over_from], origin);
                        }
                    }
                }
            }
        }
    }

    fn push(&mut self, corners: &[u32], origin: u32) {
        let plane = self.mesh.add_plane();
        self.mesh.push_face(&[corners], plane, origin);
    }
}

fn find(root: &[usize], mut i: usize) -> usize {
    while root[i] != i {
        i = root[i];
    }
    i
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        geom::region::Piece,
        kernel::brep::{extrude::extrude, measure},
    };

    fn contour(points: &[[f64; 2]]) -> Contour {
        Contour::polygon(points.iter().copied().map(DVec2::from).collect())
    }

    #[test]
    fn roofs_have_half_the_volume() {
        let square = contour(&[[-3., -2.], [3., -2.], [3., 2.], [-3., 2.]]);
        let hole = contour(&[[-1., -1.], [-1., 1.], [1., 1.], [1., -1.]]);
        let ell = contour(&[[0., 0.], [4., 0.], [3., 1.], [1., 2.], [1., 5.], [0., 4.]]);
        let cases = [(square.clone(), vec![]), (square, vec![hole]), (ell, vec![])];
        for (outer, holes) in cases {
            let genus = holes.len() as i64;
            let region = Region { pieces: vec![Piece { outer, holes }] };
            for scale in [dvec2(0.0, 1.0), dvec2(1.0, 0.0)] {
                let fine = Tolerance::new(0.001).expect("positive");
                let roof = extrude(&region, 6.0, 0.0, scale, fine).expect("drawn");
                assert!((measure::volume(&roof) - region.area() * 3.0).abs() < 0.01);
                assert_eq!(measure::genus(&roof), genus);
                Polyhedron::new(roof.into_mesh()).expect("closed");
            }
        }
    }
}
