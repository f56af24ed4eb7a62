//! Error diffusion: every cell is black or white, and what that is wrong by goes to its neighbours.
//!
//! # Sources
//! Floyd and Steinberg, *An adaptive algorithm for spatial greyscale*, 1976; Atkinson's filter from the first
//! Macintosh, which passes on six eighths.
//!
//! # Departures
//! Atkinson's filter makes light tones lighter and dark ones darker; here the mean tone is kept.

use glam::dvec2;

use super::{average::Average, ink::Mark};

/// What is passed on to whom: columns ahead, rows on, and the share.
pub type Filter = &'static [(i64, usize, f64)];

/// Floyd's and Steinberg's shares.
pub const FLOYD_STEINBERG: Filter =
    &[(1, 0, 7.0 / 16.0), (-1, 1, 3.0 / 16.0), (0, 1, 5.0 / 16.0), (1, 1, 1.0 / 16.0)];

/// Atkinson's shares: six eighths.
pub const ATKINSON: Filter = &[
    (1, 0, 1.0 / 8.0),
    (2, 0, 1.0 / 8.0),
    (-1, 1, 1.0 / 8.0),
    (0, 1, 1.0 / 8.0),
    (1, 1, 1.0 / 8.0),
    (0, 2, 1.0 / 8.0),
];

/// Goes over the cells of a grid row by row, to the right and to the left in turn. `cell` is told a cell's row and column
/// and what it owes, and says what it is wrong by, which is passed on.
pub(super) fn scan(
    [columns, rows]: [usize; 2],
    filter: Filter,
    mut cell: impl FnMut(usize, usize, f64) -> f64,
) {
    let mut owed = vec![vec![0.0; columns]; 3];
    for row in 0..rows {
        let forward = row % 2 == 0;
        for k in 0..columns {
            let column = if forward { k } else { columns - 1 - k };
            let wrong = cell(row, column, owed[0][column]);
            for &(ahead, on, share) in filter {
                let to = column as i64 + if forward { ahead } else { -ahead };
                if let Some(slot) = usize::try_from(to).ok().and_then(|to| owed[on].get_mut(to)) {
                    *slot += wrong * share;
                }
            }
        }
        owed.rotate_left(1);
        owed[2].fill(0.0);
    }
}

/// Which cells are black, given the tone of each, row by row.
fn black(size: [usize; 2], filter: Filter, tone: impl Fn(usize, usize) -> f64) -> Vec<bool> {
    let mut black = vec![false; size[0] * size[1]];
    scan(size, filter, |row, column, owed| {
        let tone = tone(row, column) + owed;
        let is_black = tone < 0.5;
        black[row * size[0] + column] = is_black;
        tone - if is_black { 0.0 } else { 1.0 }
    });
    black
}

/// The mean tone that a filter makes of even tones in equal steps from black to white. One that passes on less than
/// all makes light tones lighter and dark ones darker.
struct Response(Vec<f64>);

/// Steps of tone that are tried, and the cells along a side of the patches.
const STEPS: usize = 128;
const PATCH: usize = 64;
/// Cells at the border of a patch that are not counted.
const BORDER: usize = 12;

impl Response {
    fn of(filter: Filter) -> Response {
        let inside = BORDER..PATCH - BORDER;
        let mean = |step: usize| {
            let black = black([PATCH; 2], filter, |_, _| step as f64 / STEPS as f64);
            let rows = black.chunks(PATCH).skip(BORDER).take(inside.len());
            let dark: usize = rows
                .map(|row| row[inside.clone()].iter().filter(|is_black| **is_black).count())
                .sum();
            1.0 - dark as f64 / (inside.len() * inside.len()) as f64
        };
        let mut means: Vec<f64> = (0..=STEPS).map(mean).collect();
        for i in 1..means.len() {
            means[i] = means[i].max(means[i - 1]);
        }
        Response(means)
    }

    /// The tone to ask for, so that the mean is this one.
    fn to_ask(&self, tone: f64) -> f64 {
        let above = self.0.partition_point(|mean| *mean < tone).clamp(1, STEPS);
        let [low, high] = [self.0[above - 1], self.0[above]];
        let share = if high > low { (tone - low) / (high - low) } else { 0.0 };
        ((above - 1) as f64 + share.clamp(0.0, 1.0)) / STEPS as f64
    }
}

/// Black squares of a side in mm; neighbours in a row are one mark. A filter that does not pass on all is asked for what
/// makes the mean tone right.
pub(super) fn diffusion(tones: &Average, side: f64, filter: Filter) -> Vec<Mark> {
    let window = tones.frame().window;
    let size = (window.max - window.min) / side;
    let size = [size.x, size.y].map(|n| n.floor().max(1.0) as usize);
    let top = |row: usize| window.max.y - row as f64 * side;
    let passed: f64 = filter.iter().map(|to| to.2).sum();
    let response = (passed < 1.0).then(|| Response::of(filter));
    let black = black(size, filter, |row, column| {
        let x = window.min.x + (column as f64 + 0.5) * side;
        let tone = tones.at(dvec2(x, top(row) - side / 2.0), side);
        response.as_ref().map_or(tone, |response| response.to_ask(tone))
    });
    let mut marks = vec![];
    for (row, black) in black.chunks(size[0]).enumerate() {
        let mut column = 0;
        for run in black.chunk_by(|a, b| a == b) {
            let x = [column, column + run.len()].map(|c| window.min.x + c as f64 * side);
            column += run.len();
            if run[0] {
                let y = [top(row) - side, top(row)];
                let corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])];
                marks.push(Mark::Area(vec![corners.map(|(x, y)| dvec2(x, y)).to_vec()]));
            }
        }
    }
    marks
}
