//! Screens: what tones become on paper that is black or white.

use thiserror::Error;

use super::{
    average::Average,
    diffusion::{ATKINSON, FLOYD_STEINBERG, diffusion},
    dots::dots,
    guide::Guide,
    hatch::hatch,
    ink::Ink,
    picture::Picture,
    stipple::stipple,
    strokes::lines,
};
use crate::geom::Screen;

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
    /// The tones of a picture in ink. Fails for a screen finer than the picture's pixels, and for one with too many
    /// cells.
    ///
    /// ```
    /// use glam::DVec2;
    /// use katachi::output::{drawing::Window, halftone::{DotShape, Frame, Picture, Screen}};
    /// let window = Window { min: DVec2::ZERO, max: DVec2::splat(25.4) };
    /// let frame = Frame::new(window, 50.0).unwrap();
    /// let grey = Picture { frame, pixels: vec![[0.75; 3]; 2500] };
    /// let ink = Screen::Dots { pitch: 2.54, angle: 0.0, shape: DotShape::Round }.ink(&grey).unwrap();
    /// let pixels = ink.picture().tones();
    /// let mean: f32 = pixels.iter().sum::<f32>() / 2500.0;
    /// assert!((mean - 0.75).abs() < 0.02);
    /// ```
    pub fn ink(&self, picture: &Picture) -> Result<Ink, ScreenError> {
        self.ink_along(picture, None)
    }

    /// The same, strokes of a hatch along the parameter lines of the faces that the picture shows.
    pub fn ink_along(
        &self,
        picture: &Picture,
        guide: Option<&Guide<'_>>,
    ) -> Result<Ink, ScreenError> {
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
            Screen::Dots { pitch, angle, shape } => dots(&tones, pitch, angle, shape),
            Screen::Lines { pitch, angle } => lines(&tones, pitch, angle),
            Screen::Hatch { pitch, angle } => hatch(&tones, pitch, angle, guide),
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
