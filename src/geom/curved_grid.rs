//! Surfaces given by points in rows, open or closed either way.
//!
//! Source: T. Nishita's curved grids (METHODS, section 3.6).

use glam::DVec3;
use rustc_hash::FxHashMap;
use thiserror::Error;

use super::{Origin, Placement, PolyMesh, Surface};

/// Points that one grid may have: its triangles are twice as many.
pub const MOST_POINTS: usize = 1_000_000;

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
    /// More points than [`MOST_POINTS`].
    #[error("the grid has {nu} x {nv} points; the limit is {MOST_POINTS} in all")]
    Many {
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
    /// rows of different lengths, fewer than two points an open way or three a closed one, more than [`MOST_POINTS`], and
    /// points that are not finite.
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
        if nu.saturating_mul(nv) > MOST_POINTS {
            return Err(GridError::Many { nu, nv });
        }
        let points: Vec<DVec3> = rows.iter().flatten().copied().collect();
        if let Some(i) = points.iter().position(|p| !p.is_finite()) {
            return Err(GridError::NotFinite { u: i / nv, v: i % nv });
        }
        let number = numbered(&points);
        Ok(CurvedGrid { points, number, size: [nu, nv], closed: [closed_u, closed_v] })
    }

    /// Points along u and v.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Whether it is closed along u and v.
    pub fn closed(&self) -> [bool; 2] {
        self.closed
    }

    /// All points, mm, those of a row after one another.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The point u, v, mm, counted around where the grid is closed.
    pub fn point(&self, u: usize, v: usize) -> DVec3 {
        self.points[self.at(u, v) as usize]
    }

    /// The grid after a placement.
    pub fn placed(&self, placement: &Placement) -> CurvedGrid {
        let points: Vec<DVec3> = self.points.iter().map(|p| placement.point(*p)).collect();
        CurvedGrid { number: numbered(&points), points, size: self.size, closed: self.closed }
    }

    /// The places of its rows along x and of its columns along y, mm, if it is a function of both: rows of one x and
    /// columns of one y, both in increasing order.
    ///
    /// ```
    /// use glam::dvec3;
    /// use katachi::geom::CurvedGrid;
    /// let row = |x: f64| vec![dvec3(x, 0.0, x), dvec3(x, 5.0, 1.0)];
    /// let grid = CurvedGrid::new(&[row(1.0), row(2.0)], false, false).unwrap();
    /// assert_eq!(grid.places(), Some([vec![1.0, 2.0], vec![0.0, 5.0]]));
    /// ```
    pub fn places(&self) -> Option<[Vec<f64>; 2]> {
        let [nu, nv] = self.size;
        let x: Vec<f64> = (0..nu).map(|u| self.points[u * nv].x).collect();
        let y: Vec<f64> = (0..nv).map(|v| self.points[v].y).collect();
        let grows = |places: &[f64]| places.windows(2).all(|p| p[0] < p[1]);
        let fits = |(i, p): (usize, &DVec3)| p.x == x[i / nv] && p.y == y[i % nv];
        let function = self.closed == [false; 2] && grows(&x) && grows(&y);
        (function && self.points.iter().enumerate().all(fits)).then_some([x, y])
    }

    /// The number of the point u, v, counted around where the grid is closed.
    pub fn at(&self, u: usize, v: usize) -> u32 {
        let [nu, nv] = self.size;
        self.number[u % nu * nv + v % nv]
    }

    /// Cells along u and v.
    pub fn cells(&self) -> [usize; 2] {
        [0, 1].map(|i| if self.closed[i] { self.size[i] } else { self.size[i] - 1 })
    }

    /// The triangles of a cell, which is cut along its shorter diagonal, and whether that runs from its first corner:
    /// a twisted cell, whose corners lie in no plane, has a front and a back of its own.
    pub fn halves(&self, u: usize, v: usize) -> ([[u32; 3]; 2], bool) {
        let [a, b, c, d] =
            [self.at(u, v), self.at(u + 1, v), self.at(u + 1, v + 1), self.at(u, v + 1)];
        let length =
            |p: u32, q: u32| self.points[p as usize].distance_squared(self.points[q as usize]);
        let straight = length(a, c) <= length(b, d);
        let halves = if straight { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        (halves, straight)
    }

    /// The surface as triangles; corners that fall together leave one triangle of a cell or none.
    pub fn mesh(&self) -> PolyMesh {
        let mut mesh = PolyMesh::with_points(self.points.clone());
        let origin = mesh.add_origin(Origin::of(Surface::Facets));
        let [cu, cv] = self.cells();
        for (u, v) in (0..cu).flat_map(|u| (0..cv).map(move |v| (u, v))) {
            for [p, q, r] in self.halves(u, v).0 {
                if p != q && q != r && r != p {
                    let plane = mesh.add_plane();
                    mesh.push_face(&[[p, q, r]], plane, origin);
                }
            }
        }
        mesh
    }
}

/// The number of the first point at the same place, for each point.
fn numbered(points: &[DVec3]) -> Vec<u32> {
    let mut first: FxHashMap<[u64; 3], u32> = FxHashMap::default();
    let key = |p: &DVec3| (*p + DVec3::ZERO).to_array().map(f64::to_bits);
    points.iter().zip(0..).map(|(p, i)| *first.entry(key(p)).or_insert(i)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_grids_are_told() {
        let made = |rows: &[Vec<DVec3>], closed| CurvedGrid::new(rows, closed, false);
        let row = vec![DVec3::ZERO, DVec3::X];
        let few = [row.clone(), row.clone()];
        assert_eq!(made(&few, true), Err(GridError::Few { nu: 2, nv: 2 }));
        assert_eq!(made(&[], false), Err(GridError::Few { nu: 0, nv: 0 }));
        let ragged = [row.clone(), vec![DVec3::Y]];
        assert_eq!(made(&ragged, false), Err(GridError::Ragged { row: 1, found: 1, needed: 2 }));
        let long = vec![DVec3::ZERO; MOST_POINTS / 2 + 1];
        assert!(matches!(made(&[long.clone(), long], false), Err(GridError::Many { .. })));
        let nan = [row, vec![DVec3::Y, DVec3::NAN]];
        assert_eq!(made(&nan, false), Err(GridError::NotFinite { u: 1, v: 1 }));
    }
}
