//! Lines as wide as the tone is dark, and strokes of one pen that cross in the dark.

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
                    marks.push(Mark::Area(std::mem::take(&mut right)));
                }
                left.clear();
                right.clear();
            }
        }
    }
    marks
}

/// The directions that strokes take one after the other as it gets darker, degrees from the first.
const LAYERS: [f64; 5] = [0.0, 90.0, 45.0, 135.0, 22.5];

/// The pen's width as a part of the pitch.
const PEN: f64 = 0.5;

/// The shortest stroke, in pitches.
const SHORTEST: f64 = 2.0;

/// Strokes of a pen half as wide as their pitch in mm, the first at an angle in degrees to the x axis. Where that is
/// not dark enough others cross them; where it is too dark they are broken.
pub(super) fn hatch(tones: &Average, pitch: f64, angle: f64) -> Vec<Mark> {
    let mut marks = vec![];
    for (layer, turn) in LAYERS.into_iter().enumerate() {
        for (number, row) in Rows::of(tones, pitch, angle + turn).enumerate() {
            let first = marks.len();
            strokes(tones, pitch, layer, &row, number, &mut marks);
            if number % 2 == 1 {
                marks[first..].reverse();
                marks[first..].iter_mut().for_each(turn_round);
            }
        }
    }
    marks
}

fn turn_round(mark: &mut Mark) {
    if let Mark::Stroke { from, to, .. } = mark {
        std::mem::swap(from, to);
    }
}

/// The golden section: multiples of it, less whole numbers, are spread evenly.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// Adds the strokes of a layer along one row.
fn strokes(
    tones: &Average,
    pitch: f64,
    layer: usize,
    row: &Row,
    number: usize,
    marks: &mut Vec<Mark>,
) {
    let step = pitch * SHORTEST;
    let shift = (number as f64 * GOLDEN).fract();
    // What is owed to the tone; rows start out of step with each other.
    let (mut owed, mut down) = ((number as f64 * GOLDEN * GOLDEN).fract(), None);
    let count = (row.length / step).ceil() as i64;
    for i in -1..=count {
        let at = row.start + row.along * ((i as f64 + shift) * step);
        let dark = 1.0 - tones.at(at + row.along * (step / 2.0), step);
        owed += share(dark, layer);
        let is_down = owed >= 1.0 && i < count;
        if is_down {
            owed -= 1.0;
        }
        match (is_down, down) {
            (true, None) => down = Some(at),
            (false, Some(from)) => {
                marks.push(Mark::Stroke { from, to: at, width: pitch * PEN });
                down = None;
            }
            _ => {}
        }
    }
}

/// Which part of a layer's rows is drawn, so that all layers up to it leave as much white as the tone has, or as
/// little as they can.
fn share(dark: f64, layer: usize) -> f64 {
    let mut white = 1.0;
    for _ in 0..layer {
        white *= 1.0 - PEN;
    }
    // Layers before this one are full where this one begins.
    let wanted = (1.0 - (1.0 - dark) / white) / PEN;
    wanted.clamp(0.0, 1.0)
}

/// A row across the paper.
struct Row {
    start: DVec2,
    along: DVec2,
    length: f64,
}

struct Rows;

impl Rows {
    /// Parallel rows a pitch apart that cover the paper, from its middle outwards on both sides.
    fn of(tones: &Average, pitch: f64, angle: f64) -> impl Iterator<Item = Row> {
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
fn clip(base: DVec2, along: DVec2, half: DVec2) -> Option<(f64, f64)> {
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
