//! The clustered dots of printers: a lattice of dots, each as large as the tone in its cell is dark.
//!
//! Dots that outgrow their cells overlap with their neighbours; what they cover together is known in closed form for
//! each shape, so that the mean tone is the asked one up to black.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, dvec2};

use super::{average::Average, ink::Mark};
use crate::geom::{
    screen::DotShape,
    trig::{cos_deg, sin_deg},
};

/// Dots smaller than this part of their cell are left out.
const SPECK: f64 = 1e-3;

/// Length over width of elliptic dots.
const STRETCH: f64 = 1.5;

/// Corners of an elliptic dot.
const CORNERS: u32 = 36;

/// Dots in a square lattice of a pitch in mm, its rows at an angle in degrees to the x axis.
pub(super) fn dots(tones: &Average, pitch: f64, angle: f64, shape: DotShape) -> Vec<Mark> {
    let cells = lattice(tones, pitch, angle);
    let along = dvec2(cos_deg(angle), sin_deg(angle)) * pitch;
    let dot = |center: DVec2| {
        let dark = 1.0 - tones.at(center, pitch);
        (dark > SPECK).then(|| match outline(shape, dark) {
            None => Mark::Dot { center, radius: pitch * radius(dark, 1.0) },
            Some(corners) => {
                let place = |p: DVec2| center + along * p.x + along.perp() * p.y;
                Mark::Area(vec![corners.into_iter().map(place).collect()])
            }
        })
    };
    cells.filter_map(dot).collect()
}

/// The points of a square lattice about the middle of a picture's paper, as far as their cells are on it, row by row.
pub(super) fn lattice(tones: &Average, pitch: f64, angle: f64) -> impl Iterator<Item = DVec2> {
    let window = tones.frame().window;
    let (middle, half) = ((window.min + window.max) / 2.0, (window.max - window.min) / 2.0);
    let along = dvec2(cos_deg(angle), sin_deg(angle));
    let most = (half.length() / pitch).ceil() as i64 + 1;
    let cell = move |i: i64, j: i64| (along * i as f64 + along.perp() * j as f64) * pitch;
    let reach = half + pitch / 2.0;
    let all = (-most..=most).flat_map(move |j| (-most..=most).map(move |i| cell(i, j)));
    all.filter(move |p| p.abs().cmple(reach).all()).map(move |p| middle + p)
}

/// The polygon about the origin that covers a part of a lattice of cells of side 1, unless it is a disc.
fn outline(shape: DotShape, part: f64) -> Option<Vec<DVec2>> {
    let box_of = |x: f64, y: f64| vec![dvec2(-x, -y), dvec2(x, -y), dvec2(x, y), dvec2(-x, y)];
    Some(match shape {
        DotShape::Round => return None,
        DotShape::Ellipse => {
            // Made round, the cells are narrower in one direction.
            let r = radius(part, STRETCH);
            let step = 360.0 / f64::from(CORNERS);
            // A polygon of the same area, as far as it does not overlap.
            let grown = (2.0 * PI / f64::from(CORNERS) / sin_deg(step)).sqrt() * r;
            let corner = |i: u32| {
                let angle = step * f64::from(i);
                dvec2(cos_deg(angle) * STRETCH, sin_deg(angle)) * grown
            };
            (0..CORNERS).map(corner).collect()
        }
        DotShape::Square => box_of(part.sqrt() / 2.0, part.sqrt() / 2.0),
        DotShape::Line => box_of(0.5, part / 2.0),
        DotShape::Diamond => {
            // Past a half they overlap, and what is left white are diamonds.
            let half = if part <= 0.5 {
                (part / 2.0).sqrt()
            } else {
                1.0 - ((1.0 - part).max(0.0) / 2.0).sqrt()
            };
            vec![dvec2(half, 0.0), dvec2(0.0, half), dvec2(-half, 0.0), dvec2(0.0, -half)]
        }
    })
}

/// The half width of the ellipses, so many times as long as wide, that cover a part of a lattice of cells of side 1.
/// They may overlap.
fn radius(part: f64, stretch: f64) -> f64 {
    // Seen so that ellipses are circles.
    let cell = dvec2(1.0 / stretch, 1.0);
    let apart = (part * cell.element_product() / PI).sqrt();
    if apart <= cell.x / 2.0 {
        return apart;
    }
    let (mut low, mut high) = (0.0, cell.length() / 2.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if covered(middle, cell) < part { low = middle } else { high = middle }
    }
    high
}

/// The part of cells of a size that discs of a radius in them cover together. Discs reach no farther than the corners.
fn covered(r: f64, cell: DVec2) -> f64 {
    // What a disc has beyond a border, which its neighbour covers too.
    let beyond = |half: f64| {
        if r <= half {
            return 0.0;
        }
        r * r * (FRAC_PI_2 - libm::asin(half / r)) - half * (r * r - half * half).sqrt()
    };
    (PI * r * r - 2.0 * beyond(cell.x / 2.0) - 2.0 * beyond(cell.y / 2.0)) / cell.element_product()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_1_SQRT_2;

    use super::*;

    #[test]
    fn dots_cover_what_they_should() {
        assert!((radius(PI / 4.0, 1.0) - 0.5).abs() < 1e-9);
        assert!((radius(1.0, 1.0) - FRAC_1_SQRT_2).abs() < 1e-6);
        for part in [0.05, 0.5, 0.8, 0.95] {
            assert!((covered(radius(part, 1.0), DVec2::ONE) - part).abs() < 1e-12);
        }
        // An ellipse that touches its neighbours at its ends.
        assert!((radius(PI / 6.0, 1.5) - 1.0 / 3.0).abs() < 1e-9);
        let diamond = outline(DotShape::Diamond, 0.5).expect("a polygon");
        assert_eq!(diamond[0], dvec2(0.5, 0.0));
    }
}
