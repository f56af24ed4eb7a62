//! PNG pictures.

use super::picture::Picture;
use crate::output::pixels::Pixels;

/// A picture as a PNG file, grey if it is grey all over, 8 bits a sample, with its resolution.
///
/// ```
/// use glam::DVec2;
/// use katachi::output::{drawing::Window, halftone::{Frame, Picture, png}};
/// let window = Window { min: DVec2::ZERO, max: DVec2::splat(25.4) };
/// let frame = Frame::new(window, 2.0).unwrap();
/// let file = png(&Picture { frame, pixels: vec![[0.5; 3]; 4] });
/// assert_eq!(&file[1..4], b"PNG");
/// ```
pub fn png(picture: &Picture) -> Vec<u8> {
    pixels(picture).png(picture.frame.pitch())
}

/// The samples of a picture.
pub(super) fn pixels(picture: &Picture) -> Pixels {
    let sample = |tone: f32| (tone.clamp(0.0, 1.0) * 255.0).round() as u8;
    let is_grey = picture.is_grey();
    let samples = match is_grey {
        true => picture.tones().into_iter().map(sample).collect(),
        false => picture.pixels.iter().flatten().map(|&part| sample(part)).collect(),
    };
    Pixels { size: picture.frame.size, is_grey, samples }
}
