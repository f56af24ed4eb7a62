//! Round faces and grids by two parameters, lengths on the surface, so that strokes can follow their parameter lines.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, dvec2};

use crate::geom::{CurvedGrid, Surface};

/// A surface by parameters u and v in mm, both from 0 to its size. Where it is widest, lengths along u are true; lengths
/// along v are true everywhere, but for those of grids, where both are means.
pub(super) struct Chart<'a> {
    shape: Shape<'a>,
    /// The end of u and v.
    pub size: DVec2,
    /// The direction of the first strokes, degrees from u towards v.
    pub first: f64,
}

enum Shape<'a> {
    /// A meridian turned about an axis.
    Turned {
        origin: DVec3,
        axes: [DVec3; 3],
        widest: f64,
        meridian: Meridian,
    },
    Grid(&'a CurvedGrid),
}

/// Radius and height over v.
#[derive(Clone, Copy)]
enum Meridian {
    /// Straight, from a radius and height on, growing by so much for each millimetre.
    Straight { from: DVec2, growth: DVec2 },
    /// An arc about a place on the axis or beside it, from an angle on.
    Arc { middle: f64, radius: f64, from: f64 },
}

impl Meridian {
    fn at(self, v: f64) -> DVec2 {
        match self {
            Meridian::Straight { from, growth } => from + growth * v,
            Meridian::Arc { middle, radius, from } => {
                let (sin, cos) = libm::sincos(from + v / radius);
                dvec2(middle + radius * cos, radius * sin)
            }
        }
    }
}

impl<'a> Chart<'a> {
    /// The chart of a round surface, as far along its axis as points of it reach; `None` for those without one.
    pub fn of_surface(surface: Surface, points: &[DVec3]) -> Option<Chart<'a>> {
        let reach = |from: DVec3, axis: DVec3| {
            let heights = points.iter().map(|p| (*p - from).dot(axis));
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), h| (a.min(h), b.max(h)))
        };
        match surface {
            Surface::Cylinder { point, axis, radius } => {
                let (low, high) = reach(point, axis);
                let meridian = Meridian::Straight { from: dvec2(radius, low), growth: DVec2::Y };
                Some(Chart::turned(point, axis, meridian, radius, high - low, 0.0))
            }
            Surface::Cone { apex, axis, slope } => {
                let (low, high) = reach(apex, axis);
                let growth = dvec2(slope, 1.0).normalize();
                let (low, high) = (low.max(0.0), high.max(0.0));
                let meridian = Meridian::Straight { from: dvec2(slope * low, low), growth };
                let (widest, length) = (slope * high, (high - low) / growth.y);
                Some(Chart::turned(apex, axis, meridian, widest, length, 0.0))
            }
            Surface::Sphere { center, radius } => {
                let meridian = Meridian::Arc { middle: 0.0, radius, from: -PI / 2.0 };
                Some(Chart::turned(center, DVec3::Z, meridian, radius, PI * radius, 0.0))
            }
            Surface::Torus { center, axis, major, minor } => {
                let meridian = Meridian::Arc { middle: major, radius: minor, from: 0.0 };
                let around = TAU * minor;
                Some(Chart::turned(center, axis, meridian, major + minor, around, 90.0))
            }
            Surface::Plane | Surface::Smooth | Surface::Facets => None,
        }
        .filter(|chart| chart.size.is_finite() && chart.size.cmpgt(DVec2::ZERO).all())
    }

    fn turned(
        origin: DVec3,
        axis: DVec3,
        meridian: Meridian,
        widest: f64,
        length: f64,
        first: f64,
    ) -> Chart<'a> {
        let (x, y) = axis.any_orthonormal_pair();
        let shape = Shape::Turned { origin, axes: [x, y, axis], widest, meridian };
        Chart { shape, size: dvec2(TAU * widest, length), first }
    }

    /// The chart of a grid; its strokes run along its rows first.
    pub fn of_grid(grid: &'a CurvedGrid) -> Chart<'a> {
        let [cu, cv] = grid.cells();
        let length = |u: bool| {
            let (mut sum, mut count) = (0.0, 0.0);
            for (i, j) in (0..cu).flat_map(|i| (0..cv).map(move |j| (i, j))) {
                let next = if u { grid.point(i + 1, j) } else { grid.point(i, j + 1) };
                sum += grid.point(i, j).distance(next);
                count += 1.0;
            }
            sum / count * if u { cu as f64 } else { cv as f64 }
        };
        let size = dvec2(length(true), length(false));
        Chart { shape: Shape::Grid(grid), size, first: 90.0 }
    }

    /// How much longer than along the parameters the way is on the surface at most. Grids may be longer on the way from a
    /// corner of a cell to the opposite one.
    pub fn most_stretch(&self) -> f64 {
        let Shape::Grid(grid) = &self.shape else { return 1.0 };
        let [cu, cv] = grid.cells();
        let cell = self.size / dvec2(cu as f64, cv as f64);
        let cells = (0..cu).flat_map(|i| (0..cv).map(move |j| (i, j)));
        cells.fold(1.0, |most: f64, (i, j)| {
            let from = grid.point(i, j);
            let ways = [grid.point(i + 1, j), grid.point(i, j + 1)].map(|p| p.distance(from));
            most.max(ways[0] / cell.x).max(ways[1] / cell.y)
        })
    }

    /// The point at parameters from 0 to the size.
    pub fn point(&self, at: DVec2) -> DVec3 {
        match &self.shape {
            Shape::Turned { origin, axes: [x, y, axis], widest, meridian } => {
                let (sin, cos) = libm::sincos(at.x / widest);
                let place = meridian.at(at.y);
                *origin + (*x * cos + *y * sin) * place.x + *axis * place.y
            }
            Shape::Grid(grid) => {
                let [cu, cv] = grid.cells().map(|n| n as f64);
                let cell = at / self.size * dvec2(cu, cv);
                let low = cell.floor().clamp(DVec2::ZERO, dvec2(cu, cv) - 1.0);
                let (u, v, part) = (low.x as usize, low.y as usize, cell - low);
                let row = |u: usize| grid.point(u, v).lerp(grid.point(u, v + 1), part.y);
                row(u).lerp(row(u + 1), part.x)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_on_their_surface() {
        let axis = DVec3::new(1.0, 2.0, 2.0) / 3.0;
        let center = DVec3::new(3.0, -1.0, 4.0);
        let surfaces = [
            Surface::Cylinder { point: center, axis, radius: 2.0 },
            Surface::Cone { apex: center, axis, slope: 0.5 },
            Surface::Sphere { center, radius: 3.0 },
            Surface::Torus { center, axis, major: 5.0, minor: 1.5 },
        ];
        for surface in surfaces {
            let ends = [center, center + axis * 4.0];
            let chart = Chart::of_surface(surface, &ends).expect("round");
            for at in [dvec2(0.1, 0.3), dvec2(0.7, 0.9), dvec2(0.0, 1.0)] {
                let p = chart.point(at * chart.size);
                assert!(surface.slope(p).0.abs() < 1e-12, "{surface:?} {at}");
            }
        }
    }
}
