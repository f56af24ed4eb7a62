//! Pictures as characters on a terminal: one in each cell, by how much ink it has.

use glam::{DVec2, dvec2};

use super::{
    average::Average,
    overstrike::{signs, single_levels},
    picture::Picture,
};
use crate::output::{drawing::Window, sheet::Lettering};

/// A cell of a terminal is so many times as high as wide.
const TALL: f64 = 2.0;

/// Pixels along the width of a cell.
const PIXELS: f64 = 4.0;

/// Levels of tone, as many as the line printer's.
const LEVELS: usize = 20;

/// The width of a cell, mm, with which a window of paper fills a terminal of so many columns and rows as far as it can.
///
/// ```
/// use glam::{DVec2, dvec2};
/// use katachi::output::{drawing::Window, halftone::cell_width};
/// let window = Window { min: DVec2::ZERO, max: dvec2(40.0, 30.0) };
/// assert_eq!((cell_width(&window, [80, 40]), cell_width(&window, [80, 10])), (0.5, 1.5));
/// ```
pub fn cell_width(window: &Window, [columns, rows]: [u32; 2]) -> f64 {
    let size = window.max - window.min;
    (size.x / f64::from(columns)).max(size.y / f64::from(rows) / TALL)
}

/// Pixels to the inch that a picture needs for cells of a width in mm.
pub fn cell_dpi(width: f64) -> f64 {
    25.4 * PIXELS / width
}

/// A picture in rows of characters, cells of a width in mm; blanks at the ends of rows are left out.
pub fn preview(picture: &Picture, lettering: &dyn Lettering, width: f64) -> String {
    let levels = single_levels(&signs(lettering), LEVELS);
    let tones = Average::of(picture);
    let window = picture.frame.window;
    let cell = dvec2(width, width * TALL);
    let size = ((window.max - window.min) / cell - DVec2::splat(SLIVER)).ceil();
    let mut text = String::new();
    for row in 0..size.y as u32 {
        let mut line = String::new();
        for column in 0..size.x as u32 {
            let middle = dvec2(f64::from(column) + 0.5, -f64::from(row) - 0.5) * cell;
            let dark = 1.0 - tones.over(window.min.with_y(window.max.y) + middle, cell);
            let level = &levels[(dark * (levels.len() - 1) as f64).round() as usize];
            line.push(level.signs.first().copied().unwrap_or(' '));
        }
        text += line.trim_end();
        text.push('\n');
    }
    text
}

/// What is left over of a cell at the border and gets none of its own, as a part of it: pixels there are made whole.
const SLIVER: f64 = 0.3;
