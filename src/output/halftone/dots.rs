//! The clustered dots of printers: a lattice of dots, each as large as the tone in its cell is dark.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use glam::{DVec2, dvec2};

use super::{average::Average, ink::Mark};
use crate::geom::trig::{cos_deg, sin_deg};

/// Dots smaller than this part of their cell are left out.
const SPECK: f64 = 1e-3;

/// Dots in a square lattice of a pitch in mm, its rows at an angle in degrees to the x axis.
pub(super) fn dots(tones: &Average, pitch: f64, angle: f64) -> Vec<Mark> {
    let cells = lattice(tones, pitch, angle);
    let dot = |center: DVec2| {
        let dark = 1.0 - tones.at(center, pitch);
        (dark > SPECK).then(|| Mark::Dot { center, radius: pitch * radius(dark) })
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

/// The radius of the dots that cover a part of their cells of side 1. From a half on they overlap.
fn radius(part: f64) -> f64 {
    let (mut low, mut high) = (0.0, FRAC_1_SQRT_2);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if covered(middle) < part { low = middle } else { high = middle }
    }
    high
}

/// What dots of a radius cover of cells of side 1.
fn covered(r: f64) -> f64 {
    let disc = PI * r * r;
    if r <= 0.5 {
        return disc;
    }
    let segment = r * r * libm::acos(0.5 / r) - 0.5 * (r * r - 0.25).sqrt();
    disc - 4.0 * segment
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_cover_what_they_should() {
        assert!((radius(PI / 4.0) - 0.5).abs() < 1e-9);
        assert!((radius(1.0) - FRAC_1_SQRT_2).abs() < 1e-6);
        for part in [0.05, 0.5, 0.8, 0.95] {
            assert!((covered(radius(part)) - part).abs() < 1e-12);
        }
    }
}
