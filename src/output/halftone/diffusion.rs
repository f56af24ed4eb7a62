//! Error diffusion: every cell is black or white, and what that is wrong by goes to its neighbours.
//!
//! # Sources
//! Floyd and Steinberg, *An adaptive algorithm for spatial greyscale*, 1976; Atkinson's filter from the first
//! Macintosh, which passes on six eighths.

use glam::dvec2;

use super::{average::Average, ink::Mark};

/// What is passed on to whom: columns ahead, rows on, and the share.
pub type Filter = &'static [(i64, usize, f64)];

/// Floyd's and Steinberg's shares.
pub const FLOYD_STEINBERG: Filter =
    &[(1, 0, 7.0 / 16.0), (-1, 1, 3.0 / 16.0), (0, 1, 5.0 / 16.0), (1, 1, 1.0 / 16.0)];

/// Atkinson's shares; light tones come out lighter and dark ones darker.
pub const ATKINSON: Filter = &[
    (1, 0, 1.0 / 8.0),
    (2, 0, 1.0 / 8.0),
    (-1, 1, 1.0 / 8.0),
    (0, 1, 1.0 / 8.0),
    (1, 1, 1.0 / 8.0),
    (0, 2, 1.0 / 8.0),
];

/// Black squares of a side in mm, row by row, to the right and to the left in turn; neighbours in a row are one mark.
pub(super) fn diffusion(tones: &Average, side: f64, filter: Filter) -> Vec<Mark> {
    let window = tones.frame().window;
    let size = (window.max - window.min) / side;
    let [columns, rows] = [size.x, size.y].map(|n| n.floor().max(1.0) as usize);
    let mut owed = vec![vec![0.0; columns]; 3];
    let mut marks = vec![];
    for row in 0..rows {
        let top = window.max.y - row as f64 * side;
        let mut black = vec![false; columns];
        let forward = row % 2 == 0;
        for k in 0..columns {
            let column = if forward { k } else { columns - 1 - k };
            let center = dvec2(window.min.x + (column as f64 + 0.5) * side, top - side / 2.0);
            let tone = tones.at(center, side) + owed[0][column];
            black[column] = tone < 0.5;
            let wrong = tone - if black[column] { 0.0 } else { 1.0 };
            for &(ahead, on, share) in filter {
                let to = column as i64 + if forward { ahead } else { -ahead };
                if let Some(slot) = usize::try_from(to).ok().and_then(|to| owed[on].get_mut(to)) {
                    *slot += wrong * share;
                }
            }
        }
        owed.rotate_left(1);
        owed[2].fill(0.0);
        let mut column = 0;
        for run in black.chunk_by(|a, b| a == b) {
            let x = [column, column + run.len()].map(|c| window.min.x + c as f64 * side);
            column += run.len();
            if run[0] {
                let corners = [(x[0], top - side), (x[1], top - side), (x[1], top), (x[0], top)];
                marks.push(Mark::Area(vec![corners.map(|(x, y)| dvec2(x, y)).to_vec()]));
            }
        }
    }
    marks
}
