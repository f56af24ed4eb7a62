//! The smooth surface through the points of a curved grid.
//!
//! Along every grid line runs the cubic spline through its points: once around where the grid is closed, with the slope of
//! the cubic through the next four points at an end, and broken where the line is folded. Each way its knots are as far
//! apart as the points are on average, so that a cell is a bicubic patch, and neighbours bend alike where they meet. The
//! error shrinks with the fourth power of the distance of the points.
//!
//! Source: J. Ferguson, Multivariable curve interpolation, 1964, with the twists of the tensor product.

use glam::DVec3;

use crate::geom::CurvedGrid;

/// Grid lines that turn by more than this at a point are folded there, its cosine: an octagon is a coarse circle, a
/// hexagon is a hexagon.
const FOLD: f64 = 0.64;

/// Sweeps of Gauss and Seidel's method: each leaves less than a third of the error.
const SWEEPS: usize = 34;

/// Where the two directions of a patch give no normal, as at a pole, the normal is that so far towards its middle.
const ASIDE: f64 = 1e-3;

/// Two directions that span less than this part of what their lengths could give no normal.
const FLAT: f64 = 1e-9;

/// A bicubic patch: corner, slopes along s and t, and twist at its corners (0, 0), (1, 0), (0, 1), (1, 1).
#[derive(Clone, Copy, Debug)]
struct Patch {
    points: [DVec3; 4],
    along_s: [DVec3; 4],
    along_t: [DVec3; 4],
    twist: [DVec3; 4],
}

/// A smooth surface in patches, one for each cell of a grid.
#[derive(Clone, Debug)]
pub struct SplineSurface {
    cells: [usize; 2],
    patches: Vec<Patch>,
    /// Of the points along u and along v, whether the surface is folded there.
    folds: [Vec<bool>; 2],
}

/// A point of a patch and how it moves with s and t, mm.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// The point.
    pub at: DVec3,
    /// Its derivative by s.
    pub along_s: DVec3,
    /// Its derivative by t.
    pub along_t: DVec3,
}

/// A way along the grid lines of one direction.
struct Way {
    cells: usize,
    /// Whether its last point is its first.
    round: bool,
    /// Mean distances of neighbouring points, mm.
    widths: Vec<f64>,
    /// Whether the lines are folded at each point, one more than cells.
    folds: Vec<bool>,
}

impl Way {
    fn new(cells: usize, round: bool, lines: usize, point: impl Fn(usize, usize) -> DVec3) -> Way {
        let width = |i: usize| {
            let sum: f64 = (0..lines).map(|k| point(k, i).distance(point(k, i + 1))).sum();
            if sum > 0.0 { sum / lines as f64 } else { 1.0 }
        };
        let widths = (0..cells).map(width).collect();
        let mut way = Way { cells, round, widths, folds: vec![false; cells + 1] };
        for i in 0..=cells {
            let end = i == 0 || i == cells;
            way.folds[i] = if end && !round {
                true
            } else {
                let [before, after] = [(i + cells - 1) % cells, i % cells];
                (0..lines).any(|k| {
                    let [p, q] = [before, after].map(|c| point(k, c + 1) - point(k, c));
                    p.dot(q) < FOLD * p.length() * q.length()
                })
            };
        }
        way
    }

    /// The slopes at the start and end of every cell of a line, for a cell of width 1.
    fn slopes(&self, points: &[DVec3]) -> Vec<[DVec3; 2]> {
        let cells = self.cells;
        let chord = |i: usize| (points[i + 1] - points[i]) / self.widths[i];
        let mut inner: Vec<DVec3> =
            (0..=cells)
                .map(|i| {
                    if i == 0 || i == cells { DVec3::ZERO } else { (chord(i - 1) + chord(i)) / 2.0 }
                })
                .collect();
        let ends: Vec<[DVec3; 2]> = (0..=cells)
            .map(|i| {
                if self.folds[i] {
                    [self.end_slope(points, i, false), self.end_slope(points, i, true)]
                } else {
                    [DVec3::ZERO; 2]
                }
            })
            .collect();
        for _ in 0..SWEEPS {
            for i in (0..cells).filter(|&i| !self.folds[i]) {
                let before = (i + cells - 1) % cells;
                let slope = |node: usize, side: usize, inner: &[DVec3]| {
                    if self.folds[node] { ends[node][side] } else { inner[node % cells] }
                };
                let [m, n] = [slope(before, 1, &inner), slope(i + 1, 0, &inner)];
                let [h, k] = [self.widths[before], self.widths[i]];
                let wanted = (chord(before) / h + chord(i) / k) * 3.0 - m / h - n / k;
                inner[i] = wanted / (2.0 * (1.0 / h + 1.0 / k));
            }
        }
        let slope = |node: usize, side: usize| {
            if self.folds[node] { ends[node][side] } else { inner[node % cells] }
        };
        (0..cells).map(|i| [slope(i, 1), slope(i + 1, 0)].map(|m| m * self.widths[i])).collect()
    }

    /// The slope at a fold of the polynomial through up to four points after it or before it.
    fn end_slope(&self, points: &[DVec3], from: usize, after: bool) -> DVec3 {
        let cells = self.cells;
        let (mut places, mut values) = (vec![0.0], vec![points[from]]);
        let mut node = from;
        while places.len() < 4 {
            let at_end = if after { node == cells } else { node == 0 };
            if at_end && !self.round {
                break;
            }
            let (cell, next) = match (after, at_end) {
                (true, false) => (node, node + 1),
                (true, true) => (0, 1),
                (false, false) => (node - 1, node - 1),
                (false, true) => (cells - 1, cells - 1),
            };
            let step = if after { self.widths[cell] } else { -self.widths[cell] };
            places.push(places[places.len() - 1] + step);
            values.push(points[next]);
            node = next;
            if self.folds[node] {
                break;
            }
        }
        // Newton's divided differences; the slope is that at the first place.
        let (mut slope, mut factor) = (DVec3::ZERO, 1.0);
        for order in 1..places.len() {
            for i in 0..places.len() - order {
                values[i] = (values[i + 1] - values[i]) / (places[i + order] - places[i]);
            }
            slope += values[0] * factor;
            factor *= places[0] - places[order];
        }
        slope
    }
}

impl SplineSurface {
    /// The surface through the points of a grid.
    pub fn new(grid: &CurvedGrid) -> SplineSurface {
        let [cu, cv] = grid.cells();
        let round_u = (0..=cv).all(|v| grid.at(0, v) == grid.at(cu, v));
        let round_v = (0..=cu).all(|u| grid.at(u, 0) == grid.at(u, cv));
        let along_u = Way::new(cu, round_u, cv + 1, |v, u| grid.point(u, v));
        let along_v = Way::new(cv, round_v, cu + 1, |u, v| grid.point(u, v));
        let line_u = |v: usize| (0..=cu).map(|u| grid.point(u, v)).collect::<Vec<_>>();
        let line_v = |u: usize| (0..=cv).map(|v| grid.point(u, v)).collect::<Vec<_>>();
        let slopes_u: Vec<_> = (0..=cv).map(|v| along_u.slopes(&line_u(v))).collect();
        let slopes_v: Vec<_> = (0..=cu).map(|u| along_v.slopes(&line_v(u))).collect();
        let mut patches = Vec::with_capacity(cu * cv);
        for v in 0..cv {
            let twists = [0, 1].map(|end| {
                let line: Vec<DVec3> = (0..=cu).map(|u| slopes_v[u][v][end]).collect();
                along_u.slopes(&line)
            });
            for u in 0..cu {
                let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
                patches.push(Patch {
                    points: corners.map(|(a, b)| grid.point(u + a, v + b)),
                    along_s: corners.map(|(a, b)| slopes_u[v + b][u][a]),
                    along_t: corners.map(|(a, b)| slopes_v[u + a][v][b]),
                    twist: corners.map(|(a, b)| twists[b][u][a]),
                });
            }
        }
        SplineSurface { cells: [cu, cv], patches, folds: [along_u.folds, along_v.folds] }
    }

    /// Whether the surface is folded, or ends, along the grid line of a number along u (way 0) or v (way 1).
    pub fn is_folded(&self, way: usize, number: usize) -> bool {
        self.folds[way][number]
    }

    /// The place s, t in 0..1 of a cell.
    pub fn spot(&self, [u, v]: [usize; 2], [s, t]: [f64; 2]) -> Spot {
        let patch = &self.patches[v * self.cells[0] + u];
        let (weights, rates) = (weights(s), rates(s));
        let across = |of: [f64; 4], k: usize, ends: &[DVec3; 4], slopes: &[DVec3; 4]| {
            ends[2 * k] * of[0]
                + ends[2 * k + 1] * of[1]
                + slopes[2 * k] * of[2]
                + slopes[2 * k + 1] * of[3]
        };
        let line = |of: [f64; 4]| {
            let [p, q] = [0, 1].map(|k| across(of, k, &patch.points, &patch.along_s));
            let [m, n] = [0, 1].map(|k| across(of, k, &patch.along_t, &patch.twist));
            [p, q, m, n]
        };
        let mix = |of: [f64; 4], values: [DVec3; 4]| (0..4).map(|i| values[i] * of[i]).sum();
        let (on, moving) = (line(weights), line(rates));
        Spot {
            at: mix(self::weights(t), on),
            along_s: mix(self::weights(t), moving),
            along_t: mix(self::rates(t), on),
        }
    }

    /// The unit normal at a place of a cell, from which s turns to t counter-clockwise; zero where there is none.
    pub fn normal(&self, cell: [usize; 2], place: [f64; 2]) -> DVec3 {
        let across = |place: [f64; 2]| {
            let Spot { along_s, along_t, .. } = self.spot(cell, place);
            let normal = along_s.cross(along_t);
            let flat = normal.length() <= FLAT * self.reach(cell);
            (!flat).then(|| normal.normalize())
        };
        let aside = place.map(|x| x + (0.5 - x) * ASIDE);
        across(place).or_else(|| across(aside)).unwrap_or_default()
    }

    /// The product of the longest ways through a cell along s and t, mm^2.
    fn reach(&self, [u, v]: [usize; 2]) -> f64 {
        let patch = &self.patches[v * self.cells[0] + u];
        let most = |slopes: &[DVec3; 4]| slopes.iter().map(|m| m.length()).fold(0.0, f64::max);
        most(&patch.along_s) * most(&patch.along_t)
    }
}

/// Hermite's weights of two ends and the slopes there.
fn weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    let end = t * t * (3.0 - 2.0 * t);
    [1.0 - end, end, t * s * s, -t * t * s]
}

/// The derivatives of [`weights`].
fn rates(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    let end = 6.0 * t * s;
    [-end, end, s * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::dvec3;

    use super::*;

    fn torus(n: usize) -> CurvedGrid {
        let angle = |i: usize| libm::sincos(i as f64 / n as f64 * TAU);
        let point = |u: usize, v: usize| {
            let [(su, cu), (sv, cv)] = [u, v].map(angle);
            dvec3((30.0 + 10.0 * cv) * cu, (30.0 + 10.0 * cv) * su, 10.0 * sv)
        };
        let rows: Vec<Vec<DVec3>> = (0..n).map(|u| (0..n).map(|v| point(u, v)).collect()).collect();
        CurvedGrid::new(&rows, true, true).expect("a grid")
    }

    /// How far the surface through n x n points of a torus is off in the middle of its cells.
    fn off(n: usize) -> f64 {
        let surface = SplineSurface::new(&torus(n));
        let off = |u: usize, v: usize| {
            let p = surface.spot([u, v], [0.5, 0.5]).at;
            (libm::hypot(p.truncate().length() - 30.0, p.z) - 10.0).abs()
        };
        (0..n).flat_map(|u| (0..n).map(move |v| (u, v))).map(|(u, v)| off(u, v)).fold(0.0, f64::max)
    }

    #[test]
    fn the_error_shrinks_with_the_fourth_power() {
        let [coarse, fine] = [12, 24].map(off);
        assert!(coarse < 0.1 && (12.0..20.0).contains(&(coarse / fine)), "{coarse} {fine}");
    }

    #[test]
    fn open_ends_follow_a_cubic_and_neighbours_meet_smoothly() {
        let cubic = |x: f64, y: f64| dvec3(x, y, (x * x * x / 9.0 - x * y * y / 4.0 + y) / 20.0);
        let row = |i: i32| (0..5).map(|j| cubic(f64::from(i), f64::from(j))).collect();
        let rows: Vec<Vec<DVec3>> = (0..6).map(row).collect();
        let grid = CurvedGrid::new(&rows, false, false).expect("a grid");
        let surface = SplineSurface::new(&grid);
        for (u, v) in (0..4).flat_map(|u| (0..4).map(move |v| (u, v))) {
            let here = surface.normal([u, v], [1.0, 0.3]);
            assert!(here.distance(surface.normal([u + 1, v], [0.0, 0.3])) < 1e-12);
        }
    }

    #[test]
    fn squares_stay_square() {
        let corners = [[1., 1.], [-1., 1.], [-1., -1.], [1., -1.]];
        let row = |c: [f64; 2]| [0.0, 5.0].map(|z| dvec3(c[0], c[1], z)).to_vec();
        let rows: Vec<Vec<DVec3>> = corners.map(row).to_vec();
        let tube = SplineSurface::new(&CurvedGrid::new(&rows, true, false).expect("a grid"));
        let middle = tube.spot([0, 0], [0.25, 0.5]);
        assert!(middle.at.distance(dvec3(0.5, 1.0, 2.5)) < 1e-15 && tube.is_folded(0, 2));
        assert!(tube.normal([0, 0], [0.5, 0.5]).distance(DVec3::Y) < 1e-15);
    }
}
