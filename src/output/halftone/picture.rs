//! Tones in rows and columns.

use glam::{DVec2, dvec2};
use thiserror::Error;

use super::ink::cover;
use crate::output::drawing::Window;

/// Pixels of one picture at most.
pub const PIXELS: u64 = 100_000_000;

/// Which part of the picture plane is made, and how finely.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Frame {
    /// Lower left and upper right corner on paper, mm.
    pub window: Window,
    /// Columns and rows.
    pub size: [u32; 2],
}

/// Why there is no such picture.
#[derive(Clone, Copy, PartialEq, Debug, Error)]
pub enum FrameError {
    /// Nothing to show.
    #[error("the picture has no pixels: it is {width} x {height} mm with {dpi} pixels to the inch")]
    Empty {
        /// Width, mm.
        width: f64,
        /// Height, mm.
        height: f64,
        /// Pixels to the inch.
        dpi: f64,
    },
    /// More than anybody wants.
    #[error("the picture has {0} pixels; the limit is {PIXELS}")]
    TooLarge(u64),
}

/// Millimetres to the inch.
const INCH: f64 = 25.4;

impl Frame {
    /// A window of the picture plane with so many square pixels to the inch; what is left over of the last ones
    /// is shared out to both borders.
    ///
    /// ```
    /// use glam::dvec2;
    /// use katachi::output::{drawing::Window, halftone::Frame};
    /// let window = Window { min: dvec2(-25.4, 0.0), max: dvec2(25.4, 12.7) };
    /// assert_eq!(Frame::new(window, 100.0).unwrap().size, [200, 50]);
    /// ```
    pub fn new(window: Window, dpi: f64) -> Result<Frame, FrameError> {
        let extent = window.max - window.min;
        let [width, height] = [extent.x, extent.y];
        let count = (extent * dpi / INCH).ceil();
        if !(count.x >= 1.0 && count.y >= 1.0) {
            return Err(FrameError::Empty { width, height, dpi });
        }
        let all = count.x * count.y;
        if all > PIXELS as f64 {
            return Err(FrameError::TooLarge(all as u64));
        }
        let (middle, half) = ((window.min + window.max) / 2.0, count * (INCH / dpi / 2.0));
        let window = Window { min: middle - half, max: middle + half };
        Ok(Frame { window, size: [count.x as u32, count.y as u32] })
    }

    /// The same pixels so many times as large.
    pub fn scaled(&self, scale: f64) -> Frame {
        let Window { min, max } = self.window;
        Frame { window: Window { min: min * scale, max: max * scale }, ..*self }
    }

    /// The side of a pixel, mm.
    pub fn pitch(&self) -> f64 {
        (self.window.max.x - self.window.min.x) / f64::from(self.size[0])
    }

    /// Columns to the right and rows downwards, from the upper left corner, of a place on paper.
    pub fn column_row(&self, at: DVec2) -> DVec2 {
        dvec2(at.x - self.window.min.x, self.window.max.y - at.y) / self.pitch()
    }

    /// The place on paper so many columns and rows from the upper left corner.
    pub fn place(&self, at: DVec2) -> DVec2 {
        let from = at * self.pitch();
        dvec2(self.window.min.x + from.x, self.window.max.y - from.y)
    }
}

/// A picture: red, green and blue of each pixel, 0 black to 1 white, the uppermost row first.
#[derive(Clone, PartialEq, Debug)]
pub struct Picture {
    /// What it shows.
    pub frame: Frame,
    /// The pixels, row by row.
    pub pixels: Vec<[f32; 3]>,
}

/// Shares of red, green and blue in a grey, those of ITU-R BT.709.
const GREY: [f32; 3] = [0.2126, 0.7152, 0.0722];

impl Picture {
    /// The colour of a pixel.
    ///
    /// # Panics
    /// When there is no such pixel.
    pub fn at(&self, column: u32, row: u32) -> [f32; 3] {
        assert!(column < self.frame.size[0]);
        self.pixels[row as usize * self.frame.size[0] as usize + column as usize]
    }

    /// The tone of each pixel, 0 black to 1 white.
    pub fn tones(&self) -> Vec<f32> {
        let tone = |[r, g, b]: &[f32; 3]| {
            if r == g && g == b { *r } else { r * GREY[0] + g * GREY[1] + b * GREY[2] }
        };
        self.pixels.iter().map(tone).collect()
    }

    /// The picture with black polygons on it.
    pub(super) fn covered_by(&self, outlines: &[Vec<DVec2>]) -> Picture {
        if outlines.is_empty() {
            return self.clone();
        }
        let left = cover(&self.frame, outlines.to_vec()).into_iter().map(|share| 1.0 - share);
        let inked = self.pixels.iter().zip(left).map(|(pixel, left)| pixel.map(|part| part * left));
        Picture { frame: self.frame, pixels: inked.collect() }
    }

    /// Whether all its pixels are grey.
    pub fn is_grey(&self) -> bool {
        self.pixels.iter().all(|[r, g, b]| r == g && g == b)
    }
}
