//! Measures of what was made.

use glam::{DMat3, DVec3};

use super::Figure;
use crate::{
    kernel::{
        brep::{Polyhedron, measure},
        profile,
    },
    shape::Measures,
};

/// Measures of a solid.
pub fn of_solid(solid: &Polyhedron) -> Measures {
    let moments = measure::moments(solid);
    Measures {
        volume: moments.volume,
        area: measure::area(solid),
        length: 0.0,
        bounds: measure::bounds(solid),
        centroid: moments.centroid,
        inertia: moments.inertia,
        triangles: measure::triangles(solid),
        euler: measure::euler(solid),
        shells: measure::shells(solid),
        closed: true,
    }
}

/// Measures of a plane figure.
pub fn of_figure(figure: &Figure) -> Measures {
    let region = &figure.region;
    let centroid = profile::measure::centroid(region);
    Measures {
        volume: 0.0,
        area: region.area(),
        length: profile::measure::perimeter(region),
        bounds: bounds(figure),
        centroid: centroid.map_or(DVec3::ZERO, |p| figure.frame.point(p.extend(0.0))),
        inertia: DMat3::ZERO,
        triangles: 0,
        euler: 0,
        shells: 0,
        closed: true,
    }
}

fn bounds(figure: &Figure) -> Option<[DVec3; 2]> {
    let points = figure.region.contours().flat_map(|c| &c.points);
    let points = points.map(|p| figure.frame.point(p.extend(0.0)));
    points.map(|p| [p, p]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}
