//! Curved grids: surfaces given by points in rows, open or closed either way.
//!
//! The surface is the smooth one through the points (`spline`), parted along its contours (`folded`); grid lines are curves
//! on it (`thread`). Heights over a plane, and grids of very many cells, are what a floating horizon takes them for:
//! straight grid lines over cells of two triangles.
//!
//! Source: T. Nishita (METHODS, section 3.6).

use glam::DVec3;

use super::{Body, Camera, Drawing, Options, Scene, Stroke, scene::Kind, visible_lines};
use crate::geom::CurvedGrid;

/// The straight grid lines of a surface: [`Kind::Upper`] where the side is towards the eye from which u turns to v
/// counter-clockwise, and all over a surface that is closed both ways; [`Kind::Lower`] where the other is.
pub fn grid_strokes(grid: &CurvedGrid, camera: &Camera, id: u32) -> Vec<Stroke> {
    let ([nu, nv], [cu, cv]) = (grid.size(), grid.cells());
    let sides = Sides::new(grid, camera);
    let mut strokes = vec![];
    for u in 0..nu {
        add_line(&mut strokes, id, cv, |v| grid.point(u, v), |v| sides.along_v(u, v));
    }
    for v in 0..nv {
        add_line(&mut strokes, id, cu, |u| grid.point(u, v), |u| sides.along_u(u, v));
    }
    strokes
}

/// Adds a grid line of so many edges, a stroke for each run of one kind.
fn add_line(
    strokes: &mut Vec<Stroke>,
    id: u32,
    edges: usize,
    point: impl Fn(usize) -> DVec3,
    kind: impl Fn(usize) -> Kind,
) {
    let mut last = None;
    for edge in 0..edges {
        let (kind, to) = (kind(edge), point(edge + 1));
        match strokes.last_mut() {
            Some(stroke) if last == Some(kind) => stroke.points.push(to),
            _ => {
                let points = vec![point(edge), to];
                strokes.push(Stroke { points, kind, id, round: None, drawn: vec![] });
            }
        }
        last = Some(kind);
    }
}

/// Which side of each triangle of a grid is towards the eye.
struct Sides<'a> {
    grid: &'a CurvedGrid,
    /// Of each cell, whether the upper side of its two triangles is seen.
    upper: Vec<[bool; 2]>,
}

impl<'a> Sides<'a> {
    fn new(grid: &'a CurvedGrid, camera: &Camera) -> Sides<'a> {
        let [cu, cv] = grid.cells();
        let seen = |corners: [u32; 3]| {
            let [a, b, c] = corners.map(|i| grid.points()[i as usize]);
            (b - a).cross(c - a).dot(camera.sight(a)) > 0.0
        };
        let cells = (0..cu).flat_map(|u| (0..cv).map(move |v| (u, v)));
        let upper = cells.map(|(u, v)| grid.halves(u, v).0.map(seen)).collect();
        Sides { grid, upper }
    }

    /// Whether the upper side is seen at a side of a cell: that from corner `side` on; `None` outside the grid.
    fn at(&self, u: usize, v: usize, side: usize) -> Option<bool> {
        let [cu, cv] = self.grid.cells();
        if u >= cu || v >= cv {
            return None;
        }
        let (_, straight) = self.grid.halves(u, v);
        let half = if straight { [0, 0, 1, 1] } else { [0, 1, 1, 0] }[side];
        Some(self.upper[u * cv + v][half])
    }

    /// The cell before number `i` along a way of `n` points.
    fn before(&self, way: usize, i: usize) -> usize {
        let last = self.grid.size()[way] - 1;
        if i > 0 {
            i - 1
        } else if self.grid.closed()[way] {
            last
        } else {
            usize::MAX
        }
    }

    fn along_v(&self, u: usize, v: usize) -> Kind {
        self.kind([self.at(u, v, 3), self.at(self.before(0, u), v, 1)])
    }

    fn along_u(&self, u: usize, v: usize) -> Kind {
        self.kind([self.at(u, v, 0), self.at(u, self.before(1, v), 2)])
    }

    /// The kind of a grid line between two triangles.
    fn kind(&self, beside: [Option<bool>; 2]) -> Kind {
        if self.grid.closed() == [true; 2] || beside.contains(&Some(true)) {
            Kind::Upper
        } else {
            Kind::Lower
        }
    }
}

/// Cells of a grid that is drawn smooth, at most: finer ones are smooth as they are.
const MOST_CELLS: usize = 100_000;

/// Whether a grid is drawn as the smooth surface through its points: unless it is a function of x and y, or of more than
/// 100,000 cells.
pub fn is_drawn_smooth(grid: &CurvedGrid) -> bool {
    let [cu, cv] = grid.cells();
    cu * cv <= MOST_CELLS && grid.places().is_none()
}

/// The grid lines, contours and rims of a curved grid.
///
/// ```
/// use glam::dvec3;
/// use katachi::{geom::CurvedGrid, output::drawing::{Camera, Options, View, grid_lines}};
/// let row = |y: f64| (0..3).map(|x| dvec3(f64::from(x), y, 0.0)).collect();
/// let flat = CurvedGrid::new(&[row(0.0), row(1.0)], false, false).unwrap();
/// let top = grid_lines(&flat, &Camera::view(View::Top), &Options::default(), 0);
/// assert!((top.visible - (2.0 * 2.0 + 3.0 * 1.0)).abs() < 1e-12);
/// ```
pub fn grid_lines(grid: &CurvedGrid, camera: &Camera, options: &Options, id: u32) -> Drawing {
    if is_drawn_smooth(grid) {
        let grids = vec![(grid, id)];
        return visible_lines(&Scene { grids, ..Scene::default() }, camera, options);
    }
    let mesh = grid.mesh();
    let bodies = vec![Body { mesh: &mesh, id, smooth: true }];
    let strokes = grid_strokes(grid, camera, id);
    visible_lines(&Scene { bodies, strokes, ..Scene::default() }, camera, options)
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;
    use crate::output::drawing::{Class, HeightField, View, horizon_lines};

    /// A grid over two angles in 0..1.
    fn around(nu: usize, nv: usize, at: impl Fn(f64, f64) -> DVec3) -> Vec<Vec<DVec3>> {
        let part = |i: usize, n: usize| i as f64 / n as f64;
        (0..nu).map(|u| (0..nv).map(|v| at(part(u, nu), part(v, nv))).collect()).collect()
    }

    #[test]
    fn a_torus_closes_both_ways() {
        let torus = around(48, 24, |u, v| {
            let [(su, cu), (sv, cv)] = [u, v].map(|t| libm::sincos(t * std::f64::consts::TAU));
            dvec3((30.0 + 10.0 * cv) * cu, (30.0 + 10.0 * cv) * su, 10.0 * sv)
        });
        let torus = CurvedGrid::new(&torus, true, true).expect("a grid");
        let mesh = torus.mesh();
        assert_eq!(mesh.face_count(), 2 * 48 * 24);
        let top = grid_lines(&torus, &Camera::view(View::Top), &Options::default(), 0);
        // From above half of the circles across are seen, and the upper half of those around.
        let radius = |v: i32| 30.0 + 10.0 * libm::cos(f64::from(v) / 12.0 * std::f64::consts::PI);
        let rings: f64 = (0..=12).map(|v| std::f64::consts::TAU * radius(v)).sum();
        assert!((top.visible - (48.0 * 20.0 + rings)).abs() < 1e-3, "{}", top.visible);
        assert!(top.hidden < 1e-6, "{}", top.hidden);
    }

    #[test]
    fn poles_are_one_point() {
        let ball = around(9, 16, |u, v| {
            let polar = u * 9.0 / 8.0 * std::f64::consts::PI;
            let (sin, cos) = if u > 0.88 { (0.0, -1.0) } else { libm::sincos(polar) };
            let (s, c) = libm::sincos(v * std::f64::consts::TAU);
            dvec3(sin * c, sin * s, cos) * 10.0 + 0.0
        });
        let ball = CurvedGrid::new(&ball, false, true).expect("a grid");
        let mesh = ball.mesh();
        assert_eq!(mesh.face_count(), 16 * (2 * 8 - 2));
        let front = grid_lines(&ball, &Camera::view(View::Front), &Options::default(), 0);
        assert!(front.lines.iter().all(|l| l.kind != Kind::Border));
    }

    #[test]
    fn a_height_field_is_seen_alike_by_both_methods() {
        let height = |x: f64, y: f64| 3.0 * libm::sin(0.7 * x) * libm::cos(0.5 * y);
        let point = |i: i32, j: i32| {
            let [x, y] = [i, j].map(f64::from);
            dvec3(x, y, height(x, y))
        };
        let row = |i: i32| (-12..=12).map(|j| point(i, j)).collect();
        let rows: Vec<Vec<DVec3>> = (-12..=12).map(row).collect();
        let grid = CurvedGrid::new(&rows, false, false).expect("a grid");
        let field = HeightField::of(&grid).expect("a function of x and y");
        // Beside the surface, over one of its columns, and over a column from the other side.
        let eyes =
            [[-40.0, -30.0, 20.0], [3.4, -40.0, 20.0], [40.0, -30.0, 20.0], [-40.0, 2.3, 20.0]];
        let near = eyes.map(|eye| Camera::perspective(eye.into(), DVec3::ZERO));
        for camera in near.into_iter().chain([Camera::parallel(dvec3(0.4, -1.0, 0.35))]) {
            let camera = camera.expect("a direction");
            let horizon = horizon_lines(&field, &camera, 0).expect("before the eye");
            let general = grid_lines(&grid, &camera, &Options::default(), 0);
            let visible = general.lines.iter().filter(|l| l.class == Class::Visible);
            let seen: f64 = visible.map(|l| l.path.length()).sum();
            // Contours run along diagonals too in the one, cells are bounded by grid lines alone in the other.
            let apart = (seen - horizon.visible).abs() / seen;
            assert!(apart < 0.05, "{camera:?}: {seen} and {}", horizon.visible);
        }
    }
}
