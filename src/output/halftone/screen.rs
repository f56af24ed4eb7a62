//! Screens: what tones become on paper that is black or white.

use thiserror::Error;

use super::{
    average::Average,
    diffusion::{ATKINSON, FLOYD_STEINBERG, diffusion},
    dots::dots,
    ink::Ink,
    picture::Picture,
    stipple::stipple,
    strokes::{hatch, lines},
};

/// How tones are made of black shapes. Pitches in millimetres, angles in degrees from the x axis.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Screen {
    /// Dots in a lattice, the darker the larger.
    Dots {
        /// From dot to dot.
        pitch: f64,
        /// Of the rows of dots.
        angle: f64,
    },
    /// Lines, the darker the wider.
    Lines {
        /// From line to line.
        pitch: f64,
        /// Of the lines.
        angle: f64,
    },
    /// Strokes of one pen, the darker the more, crossing each other in the dark.
    Hatch {
        /// From stroke to stroke; the pen is half as wide.
        pitch: f64,
        /// Of the first strokes.
        angle: f64,
    },
    /// Equal dots, the darker the more, without an order.
    Stipple {
        /// The least distance of dots.
        pitch: f64,
        /// What spreads them.
        seed: u64,
    },
    /// Black squares.
    Diffusion {
        /// Their side.
        side: f64,
        /// Atkinson's filter in place of Floyd's and Steinberg's.
        atkinson: bool,
    },
}

/// Why a screen makes nothing of a picture.
#[derive(Clone, Copy, PartialEq, Debug, Error)]
pub enum ScreenError {
    /// Finer than the pixels that it is made of.
    #[error("the pitch of the screen is {pitch} mm, below that of the pixels, {pixel:.3} mm")]
    BelowPixels {
        /// The screen's.
        pitch: f64,
        /// The picture's.
        pixel: f64,
    },
    /// More than a file can well hold.
    #[error("the screen has {0} cells; the limit is {CELLS}")]
    TooMany(u64),
}

/// Cells of a screen at most.
pub const CELLS: u64 = 4_000_000;

impl Screen {
    /// From cell to cell, mm.
    pub fn pitch(&self) -> f64 {
        match *self {
            Screen::Dots { pitch, .. }
            | Screen::Lines { pitch, .. }
            | Screen::Hatch { pitch, .. }
            | Screen::Stipple { pitch, .. } => pitch,
            Screen::Diffusion { side, .. } => side,
        }
    }

    /// The tones of a picture in ink. Fails for a screen finer than the picture's pixels, and for one with too many
    /// cells.
    ///
    /// ```
    /// use glam::DVec2;
    /// use katachi::output::{drawing::Window, halftone::{Frame, Picture, Screen}};
    /// let window = Window { min: DVec2::ZERO, max: DVec2::splat(25.4) };
    /// let frame = Frame::new(window, 50.0).unwrap();
    /// let grey = Picture { frame, pixels: vec![[0.75; 3]; 2500] };
    /// let ink = Screen::Dots { pitch: 2.54, angle: 0.0 }.ink(&grey).unwrap();
    /// let pixels = ink.picture().tones();
    /// let mean: f32 = pixels.iter().sum::<f32>() / 2500.0;
    /// assert!((mean - 0.75).abs() < 0.02);
    /// ```
    pub fn ink(&self, picture: &Picture) -> Result<Ink, ScreenError> {
        let (pitch, pixel) = (self.pitch(), picture.frame.pitch());
        if pitch < pixel * (1.0 - SAME) {
            return Err(ScreenError::BelowPixels { pitch, pixel });
        }
        let extent = picture.frame.window.max - picture.frame.window.min;
        let cells = extent.x * extent.y / (pitch * pitch);
        if cells > CELLS as f64 {
            return Err(ScreenError::TooMany(cells as u64));
        }
        let tones = Average::of(picture);
        let marks = match *self {
            Screen::Dots { pitch, angle } => dots(&tones, pitch, angle),
            Screen::Lines { pitch, angle } => lines(&tones, pitch, angle),
            Screen::Hatch { pitch, angle } => hatch(&tones, pitch, angle),
            Screen::Stipple { pitch, seed } => stipple(&tones, pitch, seed),
            Screen::Diffusion { side, atkinson } => {
                diffusion(&tones, side, if atkinson { ATKINSON } else { FLOYD_STEINBERG })
            }
        };
        Ok(Ink { frame: picture.frame, marks })
    }
}

/// Pitches that differ by less than this part of them are the same.
const SAME: f64 = 1e-6;
