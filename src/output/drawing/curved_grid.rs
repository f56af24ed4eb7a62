//! Curved grids: surfaces given by points in rows, open or closed either way.
//!
//! Each cell is two triangles, so a twisted cell, whose corners lie in no plane, has a front and a back of its own:
//! the paper's weak spot. Contours run between triangles in front and behind; grid lines are figures on the surface and
//! hidden by what is before them.
//!
//! Source: T. Nishita (METHODS, section 3.6).

use std::collections::BTreeMap;

use glam::DVec3;
use thiserror::Error;

use super::{
    Body, Camera, Drawing, Options, Scene, Stroke, horizon::HeightField, scene::Kind, visible_lines,
};
use crate::geom::{Origin, PolyMesh, Surface};

/// An angle that no two faces exceed, degrees: a curved grid has no sharp edges.
const SMOOTH: f64 = 180.0;

/// Points of a surface in rows.
#[derive(Clone, PartialEq, Debug)]
pub struct CurvedGrid {
    points: Vec<DVec3>,
    /// The number of each point; those at one place have one number.
    number: Vec<u32>,
    /// Points along u and v.
    size: [usize; 2],
    /// Whether the last point is followed by the first.
    closed: [bool; 2],
}

/// Why points make no grid.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum GridError {
    /// Rows of different lengths.
    #[error("row {row} has {found} points; all need {needed}, as the first row has")]
    Ragged {
        /// The row, from 0.
        row: usize,
        /// Its points.
        found: usize,
        /// Points of the first row.
        needed: usize,
    },
    /// Too few points.
    #[error("the grid has {nu} x {nv} points; an open way needs at least 2, a closed one 3")]
    Few {
        /// Rows.
        nu: usize,
        /// Points in a row.
        nv: usize,
    },
    /// A coordinate that is NaN or infinite.
    #[error("point {v} of row {u} is not finite")]
    NotFinite {
        /// Its row, from 0.
        u: usize,
        /// Its place in the row, from 0.
        v: usize,
    },
}

impl CurvedGrid {
    /// A grid of rows of points, mm; `closed_u` joins the last row to the first, `closed_v` the ends of each row. Fails for
    /// rows of different lengths, fewer than two points an open way or three a closed one, and points that are not finite.
    pub fn new(
        rows: &[Vec<DVec3>],
        closed_u: bool,
        closed_v: bool,
    ) -> Result<CurvedGrid, GridError> {
        let (nu, nv) = (rows.len(), rows.first().map_or(0, Vec::len));
        if let Some(row) = rows.iter().position(|r| r.len() != nv) {
            return Err(GridError::Ragged { row, found: rows[row].len(), needed: nv });
        }
        let enough = |n: usize, closed: bool| n >= if closed { 3 } else { 2 };
        if !enough(nu, closed_u) || !enough(nv, closed_v) {
            return Err(GridError::Few { nu, nv });
        }
        let points: Vec<DVec3> = rows.iter().flatten().copied().collect();
        if let Some(i) = points.iter().position(|p| !p.is_finite()) {
            return Err(GridError::NotFinite { u: i / nv, v: i % nv });
        }
        let number = numbered(&points);
        Ok(CurvedGrid { points, number, size: [nu, nv], closed: [closed_u, closed_v] })
    }

    /// The number of the point u, v, counted around where the grid is closed.
    fn at(&self, u: usize, v: usize) -> u32 {
        let [nu, nv] = self.size;
        self.number[u % nu * nv + v % nv]
    }

    /// Cells along u and v.
    fn cells(&self) -> [usize; 2] {
        [0, 1].map(|i| if self.closed[i] { self.size[i] } else { self.size[i] - 1 })
    }

    /// The surface as triangles: a cell is cut along its shorter diagonal, corners that fall together leave one
    /// triangle or none.
    pub fn mesh(&self) -> PolyMesh {
        let mut mesh = PolyMesh::with_points(self.points.clone());
        let origin = mesh.add_origin(Origin::of(Surface::Facets));
        let [cu, cv] = self.cells();
        for (u, v) in (0..cu).flat_map(|u| (0..cv).map(move |v| (u, v))) {
            let [a, b, c, d] =
                [self.at(u, v), self.at(u + 1, v), self.at(u + 1, v + 1), self.at(u, v + 1)];
            let length =
                |p: u32, q: u32| self.points[p as usize].distance_squared(self.points[q as usize]);
            let straight = length(a, c) <= length(b, d);
            let halves = if straight { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            for [p, q, r] in halves {
                if p != q && q != r && r != p {
                    let plane = mesh.add_plane();
                    mesh.push_face(&[[p, q, r]], plane, origin);
                }
            }
        }
        mesh
    }

    /// The grid lines.
    fn lines(&self, id: u32) -> Vec<Stroke> {
        let [nu, nv] = self.size;
        let [cu, cv] = self.cells();
        let point = |u: usize, v: usize| self.points[self.at(u, v) as usize];
        let rows = (0..nu).map(|u| (0..=cv).map(|v| point(u, v)).collect());
        let columns = (0..nv).map(|v| (0..=cu).map(|u| point(u, v)).collect());
        let stroke = |points: Vec<DVec3>| Stroke { points, kind: Kind::Pattern, id };
        rows.chain(columns).map(stroke).collect()
    }
}

impl From<&HeightField> for CurvedGrid {
    /// A single-valued surface as a grid, for what a horizon cannot do: hidden lines, and other solids in the scene.
    fn from(field: &HeightField) -> CurvedGrid {
        let rows = field.rows();
        let size = [rows.len(), rows[0].len()];
        let points: Vec<DVec3> = rows.into_iter().flatten().collect();
        let number = (0..points.len() as u32).collect();
        CurvedGrid { points, number, size, closed: [false; 2] }
    }
}

/// The number of the first point at the same place, for each point.
fn numbered(points: &[DVec3]) -> Vec<u32> {
    let mut first: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    let key = |p: &DVec3| (*p + DVec3::ZERO).to_array().map(f64::to_bits);
    points.iter().zip(0..).map(|(p, i)| *first.entry(key(p)).or_insert(i)).collect()
}

/// The grid lines ([`Kind::Pattern`]), contours and rims of a curved grid.
///
/// ```
/// use glam::dvec3;
/// use katachi::output::drawing::{Camera, CurvedGrid, Options, View, grid_lines};
/// let row = |y: f64| (0..3).map(|x| dvec3(f64::from(x), y, 0.0)).collect();
/// let flat = CurvedGrid::new(&[row(0.0), row(1.0)], false, false).unwrap();
/// let top = grid_lines(&flat, &Camera::view(View::Top), &Options::default(), 0);
/// assert!((top.visible - (2.0 * 2.0 + 3.0 * 1.0)).abs() < 1e-12);
/// ```
pub fn grid_lines(grid: &CurvedGrid, camera: &Camera, options: &Options, id: u32) -> Drawing {
    let mesh = grid.mesh();
    let scene = Scene { bodies: vec![Body { mesh: &mesh, id }], strokes: grid.lines(id) };
    visible_lines(&scene, camera, &Options { crease: SMOOTH, ..*options })
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;
    use crate::output::drawing::{Class, View, horizon_lines};

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
        let rings: f64 = (0..=12)
            .map(|v| {
                let radius = 30.0 + 10.0 * libm::cos(f64::from(v) / 12.0 * std::f64::consts::PI);
                48.0 * 2.0 * radius * libm::sin(std::f64::consts::PI / 48.0)
            })
            .sum();
        assert!((top.visible - (48.0 * 20.0 + rings)).abs() < 1e-6, "{}", top.visible);
        assert!(top.hidden < 1e-6, "{}", top.hidden);
    }

    #[test]
    fn a_twisted_strip_shows_both_sides() {
        let strip: Vec<Vec<DVec3>> = (0..=20)
            .map(|i| {
                let (sin, cos) = libm::sincos(f64::from(i) * 0.15);
                let across = dvec3(0.0, sin, cos) * 5.0;
                let middle = DVec3::X * f64::from(i) * 2.0;
                vec![middle - across, middle + across]
            })
            .collect();
        let strip = CurvedGrid::new(&strip, false, false).expect("a grid");
        let front = grid_lines(&strip, &Camera::view(View::Front), &Options::default(), 0);
        // It turns by less than half a turn: nothing is in front of anything.
        assert!(front.hidden < 1e-9, "{}", front.hidden);
        let iso = grid_lines(&strip, &Camera::view(View::Iso), &Options::default(), 0);
        assert!(iso.lines.iter().any(|l| l.class == Class::Visible && l.kind == Kind::Contour));
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
        let places: Vec<f64> = (0..25).map(|i| f64::from(i) - 12.0).collect();
        let heights = places.iter().flat_map(|x| {
            places.iter().map(move |y| 3.0 * libm::sin(0.7 * x) * libm::cos(0.5 * y))
        });
        let field = HeightField::new(places.clone(), places.clone(), heights.collect()).unwrap();
        let camera = Camera::parallel(dvec3(0.4, -1.0, 0.35)).expect("a direction");
        let horizon = horizon_lines(&field, &camera, 0).expect("before the eye");
        let general = grid_lines(&CurvedGrid::from(&field), &camera, &Options::default(), 0);
        let grid: f64 = general
            .lines
            .iter()
            .filter(|l| l.class == Class::Visible)
            .map(|l| l.path.length())
            .sum();
        // Contours run along diagonals too in the one, cells are bounded by grid lines alone in the other.
        let apart = (grid - horizon.visible).abs() / grid;
        assert!(apart < 0.1, "{grid} and {}", horizon.visible);
    }

    #[test]
    fn bad_grids_are_told() {
        let made = |rows: &[Vec<DVec3>], closed| CurvedGrid::new(rows, closed, false);
        let row = vec![DVec3::ZERO, DVec3::X];
        let few = [row.clone(), row.clone()];
        assert_eq!(made(&few, true), Err(GridError::Few { nu: 2, nv: 2 }));
        assert_eq!(made(&[], false), Err(GridError::Few { nu: 0, nv: 0 }));
        let ragged = [row.clone(), vec![DVec3::Y]];
        assert_eq!(made(&ragged, false), Err(GridError::Ragged { row: 1, found: 1, needed: 2 }));
        let nan = [row, vec![DVec3::Y, DVec3::NAN]];
        assert_eq!(made(&nan, false), Err(GridError::NotFinite { u: 1, v: 1 }));
    }
}
