//! Lines as wide as the tone is dark.

use glam::{DVec2, dvec2};

use super::{average::Average, ink::Mark};
use crate::geom::trig::{cos_deg, sin_deg};

/// Lines are given widths at so many places to a pitch.
const STEPS: f64 = 2.0;

/// Lines narrower than this part of the pitch are left out.
const HAIR: f64 = 1e-3;

/// Lines a pitch apart in mm, at an angle in degrees to the x axis, swelling with the tone.
pub(super) fn lines(tones: &Average, pitch: f64, angle: f64) -> Vec<Mark> {
    let mut marks = vec![];
    let step = pitch / STEPS;
    for row in Rows::of(tones, pitch, angle) {
        let (mut left, mut right): (Vec<DVec2>, Vec<DVec2>) = (vec![], vec![]);
        let count = (row.length / step).ceil() as u64;
        for i in 0..=count {
            let at = row.start + row.along * (i as f64 * step);
            let dark = 1.0 - tones.at(at, pitch);
            if dark > HAIR && i < count {
                let side = row.along.perp() * (pitch * dark / 2.0);
                right.push(at - side);
                left.push(at + side);
            } else if !right.is_empty() {
                if right.len() > 1 {
                    right.extend(left.drain(..).rev());
                    marks.push(Mark::Area(vec![std::mem::take(&mut right)]));
                }
                left.clear();
                right.clear();
            }
        }
    }
    marks
}

/// A row across the paper.
pub(super) struct Row {
    pub start: DVec2,
    /// Unit vector.
    pub along: DVec2,
    pub length: f64,
}

pub(super) struct Rows;

impl Rows {
    /// Parallel rows a pitch apart that cover the paper, from its middle outwards on both sides.
    pub fn of(tones: &Average, pitch: f64, angle: f64) -> impl Iterator<Item = Row> {
        let window = tones.frame().window;
        let (middle, half) = ((window.min + window.max) / 2.0, (window.max - window.min) / 2.0);
        let along = dvec2(cos_deg(angle), sin_deg(angle));
        let across = along.perp();
        let reach = |v: DVec2| half.dot(v.abs());
        let most = (reach(across) / pitch).ceil() as i64;
        (-most..=most).filter_map(move |row| {
            let base = middle + across * (row as f64 * pitch);
            let (from, to) = clip(base - middle, along, half)?;
            Some(Row { start: base + along * from, along, length: to - from })
        })
    }
}

/// Where a line through a point is in a rectangle about the origin, as lengths along it.
pub(super) fn clip(base: DVec2, along: DVec2, half: DVec2) -> Option<(f64, f64)> {
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..2 {
        let (low, high) =
            ((-half[axis] - base[axis]) / along[axis], (half[axis] - base[axis]) / along[axis]);
        if along[axis] == 0.0 {
            if base[axis].abs() > half[axis] {
                return None;
            }
            continue;
        }
        (from, to) = (from.max(low.min(high)), to.min(low.max(high)));
    }
    (from < to).then_some((from, to))
}
