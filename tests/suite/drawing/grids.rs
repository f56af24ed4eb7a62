//! Curved grids: contours against closed forms, and twisted cells against sight lines through the surface they sample.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3, dvec3};
use katachi::{
    geom::CurvedGrid,
    output::drawing::{Camera, Class, Drawing, Kind, Options, View, grid_lines},
};

use super::scenes::near;

/// A surface over two parameters in 0..1.
struct Shape {
    at: fn(f64, f64) -> DVec3,
    /// Cells along both.
    cells: [usize; 2],
    closed: [bool; 2],
}

impl Shape {
    fn grid(&self) -> CurvedGrid {
        let place = |way: usize, i: usize| i as f64 / self.cells[way] as f64;
        let points = |way: usize| self.cells[way] + usize::from(!self.closed[way]);
        let row = |u: usize| (0..points(1)).map(|v| (self.at)(place(0, u), place(1, v))).collect();
        let rows: Vec<Vec<DVec3>> = (0..points(0)).map(row).collect();
        CurvedGrid::new(&rows, self.closed[0], self.closed[1]).expect("a grid")
    }

    fn drawn(&self, camera: &Camera) -> Drawing {
        grid_lines(&self.grid(), camera, &Options::default(), 0)
    }
}

fn turn(u: f64) -> (f64, f64) {
    libm::sincos(u * TAU)
}

fn torus(u: f64, v: f64) -> DVec3 {
    let [(su, cu), (sv, cv)] = [u, v].map(turn);
    dvec3((30.0 + 10.0 * cv) * cu, (30.0 + 10.0 * cv) * su, 10.0 * sv)
}

fn ball(u: f64, v: f64) -> DVec3 {
    let ((sin, cos), (s, c)) = (libm::sincos(u * TAU / 2.0), turn(v));
    let sin = if u == 0.0 || u == 1.0 { 0.0 } else { sin };
    dvec3(sin * c, sin * s, cos) * 10.0 + 0.0
}

fn hyperboloid(u: f64, v: f64) -> DVec3 {
    let ((s, c), z) = (turn(u), 2.0 * v - 1.0);
    dvec3(10.0 * (c - s * z), 10.0 * (s + c * z), 10.0 * z)
}

fn helicoid(u: f64, v: f64) -> DVec3 {
    let ((s, c), r) = (turn(u), 20.0 * (v - 0.5));
    dvec3(r * c, r * s, 25.0 * u)
}

fn saddle(u: f64, v: f64) -> DVec3 {
    let [x, y] = [u, v].map(|t| 2.0 * t - 1.0);
    // Turned, so that it is no function of x and y.
    dvec3(20.0 * x, 20.0 * x * y, 20.0 * y)
}

fn moebius(u: f64, v: f64) -> DVec3 {
    let ((s, c), half) = (turn(u % 1.0), libm::sincos(u * TAU / 2.0));
    let (half, r) = (if u == 1.0 { (0.0, -1.0) } else { half }, 16.0 * (v - 0.5));
    let out = 20.0 + if u == 1.0 { -r } else { r * libm::cos(u * TAU / 2.0) };
    let z = if u == 1.0 { 0.0 } else { r * half.0 };
    dvec3(out * c, out * s, z)
}

fn contours(drawing: &Drawing, class: Class) -> f64 {
    let of = drawing.lines.iter().filter(|l| l.kind == Kind::Contour && l.class == class);
    of.map(|l| l.path.length()).sum()
}

#[test]
fn contours_of_a_torus_come_near_those_of_the_true_one() {
    let (sin, cos) = libm::sincos(30f64.to_radians());
    let camera = Camera::parallel(dvec3(0.0, -cos, sin)).expect("a direction");
    let off = |cells: [usize; 2]| {
        let drawing = Shape { at: torus, cells, closed: [true; 2] }.drawn(&camera);
        let known = drawing.lines.iter().filter(|l| l.kind == Kind::Contour).count();
        assert!(known < 12, "{known} lines");
        // The lengths of the torus by integrating its contour.
        let [seen, hidden] = [Class::Visible, Class::Hidden].map(|c| contours(&drawing, c));
        [(seen - 291.781_271).abs(), (hidden - 5.786_444).abs()]
    };
    let [coarse, fine] = [[24, 12], [48, 24]].map(off);
    assert!(coarse[0] < 0.3 && coarse[1] < 0.3, "{coarse:?}");
    assert!(fine[0] < 0.02 && fine[1] < 0.05, "{fine:?}");
}

#[test]
fn a_ball_of_cells_has_a_round_outline() {
    for (distance, radius) in [(50.0, 10.206_207_3), (15.0, 13.416_407_9)] {
        let camera = Camera::perspective(dvec3(0.48, -0.64, 0.6) * distance, DVec3::ZERO);
        let off = |n: usize| {
            let shape = Shape { at: ball, cells: [n, 2 * n], closed: [false, true] };
            let drawing = shape.drawn(&camera.expect("apart"));
            let lines = drawing.lines.iter().filter(|l| l.kind == Kind::Contour);
            assert!(lines.clone().all(|l| l.class == Class::Visible), "{n} cells");
            (lines.map(|l| l.path.length()).sum::<f64>() / TAU / radius - 1.0).abs()
        };
        let [coarse, fine] = [12, 24].map(off);
        assert!(coarse < 1e-3 && fine < 1e-4, "{coarse} {fine}");
    }
}

#[test]
fn the_outline_of_a_hyperboloid_is_a_hyperbola() {
    let shape = Shape { at: hyperboloid, cells: [48, 6], closed: [true, false] };
    let drawing = shape.drawn(&Camera::view(View::Front));
    let mut length = 0.0;
    for line in drawing.lines.iter().filter(|l| l.kind == Kind::Contour) {
        length += line.path.length();
        for (start, segment) in line.path.pieces() {
            for p in (0..=8).map(|i| segment.at(start, f64::from(i) / 8.0)) {
                let off = p.x.abs() - libm::hypot(10.0, p.y);
                assert!(off.abs() < 2e-3, "{p}");
            }
        }
    }
    // Twice the arc of x^2 - y^2 = 100 between y = -10 and 10.
    assert!(near(length, 2.0 * 10.0 * 2.199_374_8, 2e-3), "{length}");
}

/// Triangles of the true surface in the bins of a picture, and the sight lines they cut.
struct Fine<'a> {
    triangles: Vec<[DVec3; 3]>,
    camera: &'a Camera,
    min: DVec2,
    cell: f64,
    bins: Vec<Vec<u32>>,
}

/// Bins each way.
const BINS: usize = 64;

impl<'a> Fine<'a> {
    fn new(shape: &Shape, camera: &'a Camera) -> Fine<'a> {
        let [m, n] = shape.cells.map(|c| c * 96usize.div_ceil(c));
        let at = |i: usize, j: usize| (shape.at)(i as f64 / m as f64, j as f64 / n as f64);
        let cells = (0..m).flat_map(|i| (0..n).map(move |j| (i, j)));
        let halves = |(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        };
        let triangles: Vec<[DVec3; 3]> = cells.flat_map(halves).collect();
        let image = |p: &DVec3| camera.project(*p).expect("ahead");
        let images: Vec<DVec2> = triangles.iter().flatten().map(image).collect();
        let min = images.iter().copied().fold(DVec2::MAX, DVec2::min);
        let max = images.iter().copied().fold(DVec2::MIN, DVec2::max);
        let cell = (max - min).max_element() / BINS as f64;
        let mut fine = Fine { triangles, camera, min, cell, bins: vec![vec![]; BINS * BINS] };
        for (i, corners) in images.chunks_exact(3).enumerate() {
            let low = fine.bin(corners[0].min(corners[1]).min(corners[2]));
            let high = fine.bin(corners[0].max(corners[1]).max(corners[2]));
            for row in low[1]..=high[1] {
                (low[0]..=high[0]).for_each(|k| fine.bins[row * BINS + k].push(i as u32));
            }
        }
        fine
    }

    fn bin(&self, p: DVec2) -> [usize; 2] {
        ((p - self.min) / self.cell).to_array().map(|x| (x.max(0.0) as usize).min(BINS - 1))
    }

    /// Distances along the sight line of a place, from a point on, where it meets the surface.
    fn met(&self, at: DVec2, p: DVec3, way: DVec3) -> impl Iterator<Item = f64> {
        let [column, row] = self.bin(at);
        self.bins[row * BINS + column].iter().filter_map(move |&i| {
            // Möller and Trumbore.
            let [a, b, c] = self.triangles[i as usize];
            let (u, v, w) = (b - a, c - a, p - a);
            let n = way.cross(v);
            let (det, m) = (u.dot(n), w.cross(u));
            let (s, t) = (w.dot(n) / det, way.dot(m) / det);
            (s >= 0.0 && t >= 0.0 && s + t <= 1.0).then(|| v.dot(m) / det)
        })
    }

    fn hides(&self, p: DVec3) -> bool {
        let sight = self.camera.sight(p);
        let end = self.camera.eye().map_or(f64::INFINITY, |_| sight.length());
        let at = self.camera.project(p).expect("ahead");
        self.met(at, p, sight.normalize()).any(|far| far > CLEAR && far < end)
    }

    fn first(&self, at: DVec2) -> Option<f64> {
        let (p, away) = self.camera.ray(at);
        let from = self.camera.eye().unwrap_or(p - away.normalize() * 1000.0);
        self.met(at, from, away.normalize()).filter(|far| *far > 0.0).reduce(f64::min)
    }
}

/// Points are hidden by what is farther from them than this, mm.
const CLEAR: f64 = 0.4;

/// The surface is seen at a larger angle, its sine, where its points are looked at.
const STEEP: f64 = 0.15;

/// Chords of all visible lines.
fn visible(drawing: &Drawing) -> Vec<[DVec2; 2]> {
    let lines = drawing.lines.iter().filter(|l| l.class == Class::Visible);
    let pieces = lines.flat_map(|l| l.path.pieces());
    pieces
        .flat_map(|(start, segment)| {
            let at = move |i: i32| segment.at(start, f64::from(i) / 8.0);
            (0..8).map(move |i| [at(i), at(i + 1)])
        })
        .collect()
}

/// The distance of a place from the nearest chord that runs along a direction.
fn off(chords: &[[DVec2; 2]], at: DVec2, along: DVec2) -> f64 {
    let parallel = |[p, q]: &&[DVec2; 2]| (*q - *p).perp_dot(along).abs() < 0.05 * p.distance(*q);
    let distance = |[p, q]: &[DVec2; 2]| {
        let t = (at - *p).dot(*q - *p) / (*q - *p).length_squared();
        p.lerp(*q, t.clamp(0.0, 1.0)).distance(at)
    };
    chords.iter().filter(parallel).map(distance).fold(f64::INFINITY, f64::min)
}

/// Points of grid lines that are drawn wrong, of so many.
fn wrong_on_lines(shape: &Shape, fine: &Fine, camera: &Camera, drawing: &Drawing) -> [usize; 2] {
    let chords = visible(drawing);
    let (mut wrong, mut all) = (0, 0);
    for way in 0..2 {
        let other = 1 - way;
        for line in 0..=shape.cells[other] {
            for i in 0..shape.cells[way] * 2 {
                let place = |x: f64| {
                    let across = line as f64 / shape.cells[other] as f64;
                    if way == 0 { (shape.at)(x, across) } else { (shape.at)(across, x) }
                };
                let x = (i as f64 + 0.37) / (shape.cells[way] * 2) as f64;
                let [before, p, after] = [-1e-5, 0.0, 1e-5].map(|d| place(x + d));
                let beside = |d: f64| {
                    let across = (line as f64 / shape.cells[other] as f64 + d).clamp(0.0, 1.0);
                    if way == 0 { (shape.at)(x, across) } else { (shape.at)(across, x) }
                };
                let normal = (after - before).cross(beside(1e-5) - beside(-1e-5)).normalize();
                let sight = camera.sight(p).normalize();
                if normal.dot(sight).abs() < STEEP {
                    continue;
                }
                let hidden = fine.hides(p);
                let aside = [normal * 0.05, (after - before).normalize() * 0.1];
                let moved = aside.iter().flat_map(|d| [p + *d, p - *d]);
                if moved.into_iter().any(|q| fine.hides(q) != hidden) {
                    continue;
                }
                let [a, at, b] = [before, p, after].map(|p| camera.project(p).expect("ahead"));
                let distance = off(&chords, at, (b - a).normalize());
                all += 1;
                wrong += usize::from(if hidden { distance < 1e-3 } else { distance > 0.1 });
            }
        }
    }
    [wrong, all]
}

/// Points of visible contours beside which nothing ends, of so many.
fn wrong_on_contours(fine: &Fine, drawing: &Drawing) -> [usize; 2] {
    let seen =
        drawing.lines.iter().filter(|l| l.kind == Kind::Contour && l.class == Class::Visible);
    let (mut wrong, mut all) = (0, 0);
    for (start, segment) in seen.flat_map(|l| l.path.pieces()) {
        for t in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let [p, q] = [t, t + 1e-4].map(|t| segment.at(start, t));
            let across = (q - p).perp().normalize_or_zero();
            let parted = |by: f64| match [p + across * by, p - across * by].map(|at| fine.first(at))
            {
                [Some(a), Some(b)] => (a - b).abs() > 0.05,
                [a, b] => a.is_some() != b.is_some(),
            };
            all += 1;
            // Beside a border a fold may be thinner than the first step.
            wrong += usize::from(![0.1, 0.02, 0.005].into_iter().any(parted));
        }
    }
    [wrong, all]
}

#[test]
fn twisted_cells_are_drawn_as_the_surface_is_seen() {
    let shapes = [
        Shape { at: helicoid, cells: [24, 4], closed: [false; 2] },
        Shape { at: helicoid, cells: [12, 1], closed: [false; 2] },
        Shape { at: saddle, cells: [6, 6], closed: [false; 2] },
        Shape { at: saddle, cells: [1, 1], closed: [false; 2] },
        Shape { at: moebius, cells: [32, 4], closed: [false; 2] },
        Shape { at: torus, cells: [32, 16], closed: [true; 2] },
    ];
    let mut report = vec![];
    for (number, shape) in shapes.iter().enumerate() {
        let eyes = [[1.0, -1.3, 0.8], [0.2, -1.0, 0.15], [-0.7, 0.4, 0.3], [0.31, 0.2, 1.0]];
        let parallel = eyes.map(|e| Camera::parallel(DVec3::from(e)));
        let near = eyes.map(|e| Camera::perspective(DVec3::from(e) * 60.0, dvec3(1.0, 2.0, 3.0)));
        for camera in parallel.into_iter().chain(near) {
            let camera = camera.expect("a direction");
            let (fine, drawing) = (Fine::new(shape, &camera), shape.drawn(&camera));
            let [wrong, all] = wrong_on_lines(shape, &fine, &camera, &drawing);
            let [false_ends, ends] = wrong_on_contours(&fine, &drawing);
            // Chords of the true surface lie within it: enlarged before a near eye, farther than the first step.
            if wrong * 100 > all || false_ends * 20 > ends {
                let text =
                    format!("{number}: {wrong} of {all}, {false_ends} of {ends}: {camera:?}");
                report.push(text);
            }
        }
    }
    assert!(report.is_empty(), "{}", report.join("\n"));
}
