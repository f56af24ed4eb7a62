//! A curved grid as the eye has it: pieces of its smooth surface in front and behind, parted along the contours.
//!
//! Every cell is cut into triangles that keep to the surface within the drawing's bound. Where one has corners in front
//! and behind, the contour passes its sides where the surface itself turns away, and cuts it in two: so a twisted cell has
//! a front and a back of its own, which the paper could not draw. What is in front follows from the surface's normals and
//! not from the facets, so a contour is one smooth line whatever facets it runs over.
//!
//! Source: T. Nishita (METHODS, section 3.6), with contours as A. Hertzmann and D. Zorin trace them, Illustrating smooth
//! surfaces, 2000.

use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

use super::{Camera, frustum::cut_loop, pieces::Sides, spline::SplineSurface};
use crate::geom::CurvedGrid;

/// Parts of a cell each way, at most.
const MOST_STEPS: f64 = 24.0;

/// Small cells in all, at most: beyond that all are cut into fewer.
const MOST_CELLS: f64 = 400_000.0;

/// The normal turns by less than this from one end of a small cell to the other, radians.
const TURN: f64 = 0.3;

/// A surface is seen edge-on where the sine of the angle to the sight line is below this.
const EDGE_ON: f64 = 1e-7;

/// Normals around a pole that differ by more than this, a cosine, are those of a cone.
const CONE: f64 = 0.9;

/// How far, in widths of a cell, a surface is looked at along the sight line to tell how it bends.
const PROBE: f64 = 1e-3;

/// A surface does not bend where its normal turns by less than this over that way, a sine.
const EVEN: f64 = 1e-9;

/// Steps of the search for a root, at most.
const STEPS: usize = 60;

/// A part of a triangle that is in front or behind as a whole.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Its corners, counter-clockwise from the upper side.
    pub corners: Vec<u32>,
    /// Whether its upper side, from which u turns to v counter-clockwise, is towards the eye.
    pub front: bool,
    /// Its triangle: a place in [`Folded::triangles`].
    pub home: u32,
}

/// A contour's passage through the side of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Split {
    /// Its place from the smaller to the larger end.
    pub at: f64,
    /// Its point.
    pub point: u32,
    /// The smooth part of the surface whose contour it is.
    region: u32,
}

/// A corner of a triangle: its point and its place in the cell.
type Corner = (u32, [f64; 2]);

/// A triangle of a cell.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [Corner; 3],
    cell: [usize; 2],
}

/// A grid cut into pieces.
pub struct Folded<'a> {
    /// The grid.
    pub grid: &'a CurvedGrid,
    /// The surface through its points.
    pub surface: SplineSurface,
    /// All points, mm.
    pub points: Vec<DVec3>,
    /// The normal at each point.
    pub normals: Vec<DVec3>,
    /// Corners of the small triangles.
    pub triangles: Vec<[u32; 3]>,
    /// What the triangles are cut into.
    pub pieces: Vec<Piece>,
    /// Points of contours, and whether the front is nearer to the eye than the back there.
    pub turning: FxHashMap<u32, bool>,
    /// Points where contours end in a cusp.
    pub cusps: FxHashSet<u32>,
    /// Of a closed surface, whether its upper side is outside.
    outward: Option<bool>,
    camera: &'a Camera,
    /// Parts of each cell along u and v.
    steps: [Vec<usize>; 2],
    /// The smooth part along u and v that each cell belongs to.
    runs: [Vec<u32>; 2],
    /// Points on grid lines: number of the grid's points at both ends, step, way.
    on_lines: FxHashMap<(u32, u32, usize, usize), u32>,
    /// How far the surface is turned to the eye at its points, by smooth part.
    turned: FxHashMap<(u32, u32), f64>,
    /// Poles that are tips of cones.
    tips: FxHashSet<u32>,
    splits: FxHashMap<[u32; 2], Vec<Split>>,
}

impl<'a> Folded<'a> {
    /// Cuts a grid; facets and chords are within `bound` mm of the surface.
    pub fn new(grid: &'a CurvedGrid, camera: &'a Camera, bound: f64) -> Folded<'a> {
        let surface = SplineSurface::new(grid);
        let steps = steps(grid, &surface, bound);
        let runs = [0, 1].map(|way| runs(grid.cells()[way], |i| surface.is_folded(way, i)));
        let mut folded = Folded {
            grid,
            surface,
            points: grid.points().to_vec(),
            normals: vec![DVec3::ZERO; grid.points().len()],
            triangles: vec![],
            pieces: vec![],
            turning: FxHashMap::default(),
            cusps: FxHashSet::default(),
            outward: None,
            camera,
            steps,
            runs,
            on_lines: FxHashMap::default(),
            turned: FxHashMap::default(),
            tips: FxHashSet::default(),
            splits: FxHashMap::default(),
        };
        folded.find_tips();
        let triangles = folded.triangles();
        triangles.iter().for_each(|t| folded.split_sides(t));
        triangles.iter().for_each(|t| folded.cut(t));
        folded.outward = folded.outside();
        folded.cut_off();
        folded
    }

    /// Whether the grid lines across a way close: the last one is the first.
    pub fn is_round(&self, way: usize) -> bool {
        let [cu, cv] = self.grid.cells();
        let same =
            |a: [usize; 2], b: [usize; 2]| self.grid.at(a[0], a[1]) == self.grid.at(b[0], b[1]);
        if way == 0 {
            (0..=cv).all(|v| same([0, v], [cu, v]))
        } else {
            (0..=cu).all(|u| same([u, 0], [u, cv]))
        }
    }

    /// The vector from a point towards the eye.
    pub fn sight(&self, p: DVec3) -> DVec3 {
        self.camera.sight(p)
    }

    /// Whether a piece hides: both sides of an open surface do, the outside of a closed one.
    pub fn hides(&self, piece: &Piece) -> bool {
        self.outward.is_none_or(|outward| piece.front == outward)
    }

    /// Whether the upper side is outside; `None` for a surface that is open.
    fn outside(&self) -> Option<bool> {
        let closed = Sides::of(&self.pieces).each().all(|side| side.len() == 2);
        let corner = |t: &[u32; 3], i: usize| self.points[t[i] as usize];
        let volume = |t: &[u32; 3]| corner(t, 0).dot(corner(t, 1).cross(corner(t, 2)));
        closed.then(|| self.triangles.iter().map(volume).sum::<f64>() > 0.0)
    }

    /// Cuts off what is behind the eye.
    fn cut_off(&mut self) {
        let behind = |p: DVec3| self.camera.ahead(p) < 0.0;
        if !self.points.iter().any(|p| behind(*p)) {
            return;
        }
        let mut pieces = std::mem::take(&mut self.pieces);
        let mut passages = FxHashMap::default();
        for piece in &mut pieces {
            piece.corners = cut_loop(&mut self.points, self.camera, &piece.corners, &mut passages);
        }
        pieces.retain(|piece| piece.corners.len() >= 3);
        self.normals.resize(self.points.len(), DVec3::ZERO);
        self.pieces = pieces;
    }

    /// Parts of a cell along a way.
    pub fn steps(&self, way: usize, cell: usize) -> usize {
        self.steps[way][cell]
    }

    /// The passages of contours through a side, from its smaller end on.
    pub fn splits(&self, a: u32, b: u32) -> &[Split] {
        self.splits.get(&[a.min(b), a.max(b)]).map_or(&[], |s| s)
    }

    /// Whether a point is the tip of a cone.
    pub fn is_tip(&self, point: u32) -> bool {
        self.tips.contains(&point)
    }

    fn add_point(&mut self, cell: [usize; 2], at: [f64; 2]) -> u32 {
        self.points.push(self.surface.spot(cell, at).at);
        self.normals.push(self.surface.normal(cell, at));
        self.points.len() as u32 - 1
    }

    /// The point of a cell so many steps along u and v.
    pub fn point(&mut self, [u, v]: [usize; 2], [i, j]: [usize; 2]) -> u32 {
        let [m, n] = [self.steps[0][u], self.steps[1][v]];
        let at = [i as f64 / m as f64, j as f64 / n as f64];
        let (a, b) = (u + usize::from(i == m), v + usize::from(j == n));
        let (ends, step, way) = match (i % m, j % n) {
            (0, 0) => return self.grid.at(a, b),
            (_, 0) => ([self.grid.at(u, b), self.grid.at(u + 1, b)], [i, m - i], 0),
            (0, _) => ([self.grid.at(a, v), self.grid.at(a, v + 1)], [j, n - j], 1),
            _ => return self.add_point([u, v], at),
        };
        if ends[0] == ends[1] {
            return ends[0];
        }
        let turned = ends[0] > ends[1];
        let key = (ends[0].min(ends[1]), ends[0].max(ends[1]), step[usize::from(turned)], way);
        if let Some(&known) = self.on_lines.get(&key) {
            return known;
        }
        let point = self.add_point([u, v], at);
        self.on_lines.insert(key, point);
        point
    }

    /// Finds the poles around which normals differ, and gives the others theirs.
    fn find_tips(&mut self) {
        let [cu, cv] = self.grid.cells();
        for (u, v) in (0..cu).flat_map(|u| (0..cv).map(move |v| (u, v))) {
            let corners = [(0, 0), (1, 0), (1, 1), (0, 1)];
            let number = corners.map(|(a, b)| self.grid.at(u + a, v + b));
            for (i, (a, b)) in corners.into_iter().enumerate() {
                let at = [a as f64, b as f64];
                let normal = self.surface.normal([u, v], at);
                let slot = &mut self.normals[number[i] as usize];
                let pole = number[i] == number[(i + 1) % 4] || number[i] == number[(i + 3) % 4];
                if *slot == DVec3::ZERO {
                    *slot = normal;
                } else if pole && slot.dot(normal) < CONE {
                    self.tips.insert(number[i]);
                }
            }
        }
    }

    /// All small triangles: cells are cut along the shorter diagonal.
    fn triangles(&mut self) -> Vec<Triangle> {
        let [cu, cv] = self.grid.cells();
        let mut triangles = vec![];
        for (u, v) in (0..cu).flat_map(|u| (0..cv).map(move |v| (u, v))) {
            let [m, n] = [self.steps[0][u], self.steps[1][v]];
            let mut before: Vec<u32> = vec![];
            for i in 0..=m {
                let line: Vec<u32> = (0..=n).map(|j| self.point([u, v], [i, j])).collect();
                for j in 0..n {
                    if i > 0 {
                        let place = |a: usize, b: usize| {
                            [(i - 1 + a) as f64 / m as f64, (j + b) as f64 / n as f64]
                        };
                        let corners = [
                            (before[j], place(0, 0)),
                            (line[j], place(1, 0)),
                            (line[j + 1], place(1, 1)),
                            (before[j + 1], place(0, 1)),
                        ];
                        self.add_halves([u, v], corners, &mut triangles);
                    }
                }
                before = line;
            }
        }
        triangles
    }

    fn add_halves(&mut self, cell: [usize; 2], corners: [Corner; 4], out: &mut Vec<Triangle>) {
        let [a, b, c, d] = corners;
        let length = |p: Corner, q: Corner| {
            self.points[p.0 as usize].distance_squared(self.points[q.0 as usize])
        };
        let straight = length(a, c) <= length(b, d);
        let halves = if straight { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        for corners in halves {
            let [p, q, r] = corners.map(|c| c.0);
            if p != q && q != r && r != p {
                out.push(Triangle { corners, cell });
                self.triangles.push([p, q, r]);
            }
        }
    }

    fn region(&self, [u, v]: [usize; 2]) -> u32 {
        self.runs[0][u] * (self.runs[1].len() as u32 + 1) + self.runs[1][v]
    }

    /// A bit that is set on the last grid line of an open way: it may lie on the first one, turned over.
    fn last_line(&self, cell: [usize; 2], at: [f64; 2]) -> u32 {
        let cells = self.grid.cells();
        let last = |way: usize| cell[way] + 1 == cells[way] && at[way] == 1.0;
        let open = |way: usize| self.surface.is_folded(way, cells[way]);
        u32::from((0..2).any(|way| last(way) && open(way))) << 31
    }

    /// How far the surface is turned to the eye at a place: the sine of an angle, 0 where it is seen edge-on.
    fn turn(&self, cell: [usize; 2], at: [f64; 2]) -> f64 {
        let sight = self.camera.sight(self.surface.spot(cell, at).at).normalize_or_zero();
        self.surface.normal(cell, at).dot(sight)
    }

    /// How far a corner is turned to the eye; `None` for the tip of a cone, which is turned every way.
    fn turned(&mut self, cell: [usize; 2], (point, at): Corner) -> Option<f64> {
        if self.tips.contains(&point) {
            return None;
        }
        let key = (point, self.region(cell) | self.last_line(cell, at));
        if let Some(known) = self.turned.get(&key) {
            return Some(*known);
        }
        let turn = self.turn(cell, at);
        let turn = if turn.abs() < EDGE_ON { 0.0 } else { turn };
        self.turned.insert(key, turn);
        if turn == 0.0 {
            self.note_turning(point, cell, at);
        }
        Some(turn)
    }

    /// Notes which side is nearer at a point of a contour; a flat part that is seen edge-on has no such side.
    fn note_turning(&mut self, point: u32, cell: [usize; 2], at: [f64; 2]) {
        let bend = self.bend(cell, at);
        if bend.abs() > EVEN {
            self.turning.insert(point, bend > 0.0);
        }
    }

    /// How the surface bends along the sight line where it is seen edge-on: positive where the front is nearer.
    fn bend(&self, cell: [usize; 2], at: [f64; 2]) -> f64 {
        let spot = self.surface.spot(cell, at);
        let sight = self.camera.sight(spot.at).normalize_or_zero();
        let (s, t) = (spot.along_s, spot.along_t);
        let (ss, st, tt) = (s.dot(s), s.dot(t), t.dot(t));
        let way = [tt * s.dot(sight) - st * t.dot(sight), ss * t.dot(sight) - st * s.dot(sight)];
        let size = way[0].abs().max(way[1].abs());
        let beside = |by: f64| self.turn(cell, [0, 1].map(|i| at[i] + way[i] / size * by));
        if size > 0.0 { beside(PROBE) - beside(-PROBE) } else { 0.0 }
    }

    /// Finds where contours pass the sides of a triangle.
    fn split_sides(&mut self, triangle: &Triangle) {
        let (cell, region) = (triangle.cell, self.region(triangle.cell));
        let turns = triangle.corners.map(|c| self.turned(cell, c));
        for mut ends in [[0, 1], [1, 2], [2, 0]] {
            ends.sort_by_key(|&k| triangle.corners[k].0);
            let (Some(s), Some(t)) = (turns[ends[0]], turns[ends[1]]) else { continue };
            let [(a, p), (b, q)] = ends.map(|k| triangle.corners[k]);
            let known = self.splits(a, b).iter().any(|s| s.region == region);
            if s * t >= 0.0 || known {
                continue;
            }
            let place = |x: f64| between(p, q, x);
            let at = root(|x| self.turn(cell, place(x)), [s, t]);
            let point = self.add_point(cell, place(at));
            self.note_turning(point, cell, place(at));
            let splits = self.splits.entry([a, b]).or_default();
            splits.push(Split { at, point, region });
            splits.sort_by(|x, y| x.at.total_cmp(&y.at));
        }
    }

    /// Cuts a triangle along the contour.
    fn cut(&mut self, triangle: &Triangle) {
        let home = self.pieces.last().map_or(0, |p| p.home + 1);
        let rim = self.rim(triangle);
        let points = |nodes: &[Node]| nodes.iter().map(|n| n.point).collect::<Vec<u32>>();
        let crossings: Vec<usize> = (0..rim.len()).filter(|&i| rim[i].crossed).collect();
        let front = |nodes: &[Node]| {
            nodes[1..nodes.len().max(2) - 1].iter().find_map(|n| n.front.filter(|_| !n.crossed))
        };
        if let &[i, j] = &crossings[..] {
            let mut one = rim[i..=j].to_vec();
            let mut other = [&rim[j..], &rim[..=i]].concat();
            if let (Some(a), Some(b)) = (front(&one), front(&other))
                && a != b
            {
                if let Some(cusp) = self.cusp(triangle.cell, [rim[i], rim[j]]) {
                    one.push(cusp);
                    other.push(cusp);
                }
                self.pieces.push(Piece { corners: points(&one), front: a, home });
                self.pieces.push(Piece { corners: points(&other), front: b, home });
                return;
            }
        }
        let front = rim.iter().find_map(|n| n.front.filter(|_| !n.crossed)).unwrap_or(true);
        self.pieces.push(Piece { corners: points(&rim), front, home });
    }

    /// The corners of a triangle and the passages between them.
    fn rim(&mut self, triangle: &Triangle) -> Vec<Node> {
        let (cell, region) = (triangle.cell, self.region(triangle.cell));
        let turns = triangle.corners.map(|c| self.turned(cell, c));
        let seen: Vec<bool> =
            turns.iter().flatten().filter(|t| **t != 0.0).map(|t| *t > 0.0).collect();
        let mixed = seen.contains(&true) && seen.contains(&false);
        let mut rim = vec![];
        for (i, turn) in turns.into_iter().enumerate() {
            let [(a, p), (b, q)] = [triangle.corners[i], triangle.corners[(i + 1) % 3]];
            let (crossed, front) = match turn {
                None => (mixed, None),
                Some(turn) => (turn == 0.0, (turn != 0.0).then_some(turn > 0.0)),
            };
            rim.push(Node { point: a, at: p, crossed, front });
            let passage = |s: &Split| {
                let at = between(p, q, if a < b { s.at } else { 1.0 - s.at });
                Node { point: s.point, at, crossed: s.region == region, front: None }
            };
            let splits = self.splits(a, b).iter();
            if a < b {
                rim.extend(splits.map(passage))
            } else {
                rim.extend(splits.rev().map(passage))
            }
        }
        rim
    }

    /// The cusp of the contour between two of its points in a cell, if it has one there: where the surface does not bend
    /// along the sight line.
    fn cusp(&mut self, cell: [usize; 2], ends: [Node; 2]) -> Option<Node> {
        if ends.iter().any(|n| self.is_tip(n.point)) {
            return None;
        }
        let [p, q] = ends.map(|n| n.at);
        let bends = [p, q].map(|at| self.bend(cell, at));
        if bends[0] * bends[1] >= 0.0 {
            return None;
        }
        let across = [p[1] - q[1], q[0] - p[0]];
        let on = |x: f64| {
            let middle = between(p, q, x);
            let beside = |y: f64| [middle[0] + across[0] * y, middle[1] + across[1] * y];
            let turns = [-0.5, 0.5].map(|y| self.turn(cell, beside(y)));
            let y = if turns[0] * turns[1] < 0.0 {
                root(|y| self.turn(cell, beside(y - 0.5)), turns) - 0.5
            } else {
                0.0
            };
            beside(y)
        };
        let at = on(root(|x| self.bend(cell, on(x)), bends));
        let point = self.add_point(cell, at);
        self.cusps.insert(point);
        Some(Node { point, at, crossed: true, front: None })
    }
}

/// A corner or a passage on the rim of a triangle.
#[derive(Clone, Copy)]
struct Node {
    point: u32,
    at: [f64; 2],
    /// Whether the contour passes there.
    crossed: bool,
    /// Whether a corner is in front.
    front: Option<bool>,
}

fn between(p: [f64; 2], q: [f64; 2], x: f64) -> [f64; 2] {
    [0, 1].map(|i| p[i] + (q[i] - p[i]) * x)
}

/// A root of a function in 0..1 from its values at the ends, which differ in sign (regula falsi, Illinois).
fn root(value: impl Fn(f64) -> f64, [mut f, mut g]: [f64; 2]) -> f64 {
    let (mut low, mut high, mut at) = (0.0, 1.0, 0.0);
    let mut stayed = None;
    for _ in 0..STEPS {
        let before = at;
        at = (low * g - high * f) / (g - f);
        let here = value(at);
        if here == 0.0 || (at - before).abs() <= f64::EPSILON {
            break;
        }
        // The value of an end that stays for the second time counts half.
        let moves_high = (here > 0.0) == (g > 0.0);
        let half = if stayed == Some(moves_high) { 0.5 } else { 1.0 };
        if moves_high {
            (high, g, f) = (at, here, f * half);
        } else {
            (low, f, g) = (at, here, g * half);
        }
        stayed = Some(moves_high);
    }
    at
}

/// The smooth part that each cell along a way belongs to.
fn runs(cells: usize, folded: impl Fn(usize) -> bool) -> Vec<u32> {
    let mut run = 0;
    let mut runs: Vec<u32> = (0..cells)
        .map(|i| {
            run += u32::from(i > 0 && folded(i));
            run
        })
        .collect();
    let last = run;
    if !folded(0) {
        // Once around: the last part goes on into the first.
        runs.iter_mut().filter(|r| **r == last).for_each(|r| *r = 0);
    }
    runs
}

/// Into how many parts cells are cut along u and v so that facets are within `bound` mm.
fn steps(grid: &CurvedGrid, surface: &SplineSurface, bound: f64) -> [Vec<usize>; 2] {
    let [cu, cv] = grid.cells();
    let mut wanted = [vec![1.0f64; cu], vec![1.0f64; cv]];
    for (u, v) in (0..cu).flat_map(|u| (0..cv).map(move |v| (u, v))) {
        let [s, t] = cell_steps(surface, [u, v], bound);
        wanted[0][u] = wanted[0][u].max(s);
        wanted[1][v] = wanted[1][v].max(t);
    }
    let all: f64 = wanted.iter().map(|w| w.iter().sum::<f64>()).product();
    let share = (MOST_CELLS / all).sqrt().min(1.0);
    wanted.map(|w| w.iter().map(|n| (n * share).ceil().clamp(1.0, MOST_STEPS) as usize).collect())
}

/// Into how many parts a cell wants to be cut each way.
fn cell_steps(surface: &SplineSurface, cell: [usize; 2], bound: f64) -> [f64; 2] {
    let place = |way: usize, x: f64, y: f64| if way == 0 { [x, y] } else { [y, x] };
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let [a, b, c, d] = corners.map(|at| surface.spot(cell, at).at);
    let twist = (a - b - c + d).length() / 4.0;
    [0, 1].map(|way| {
        let mut steps = (twist / bound).sqrt();
        for y in [0.0, 0.5, 1.0] {
            let on = |x: f64| surface.spot(cell, place(way, x, y)).at;
            let normal = |x: f64| surface.normal(cell, place(way, x, y));
            let (p, q) = (on(0.0), on(1.0));
            for x in [0.25, 0.5, 0.75] {
                steps = steps.max((on(x).distance(p.lerp(q, x)) / bound).sqrt());
            }
            let turn = [[0.0, 0.5], [0.5, 1.0]].map(|[x, z]| normal(x).distance(normal(z)));
            steps = steps.max((turn[0] + turn[1]) / TURN);
        }
        steps.ceil().clamp(1.0, MOST_STEPS)
    })
}
