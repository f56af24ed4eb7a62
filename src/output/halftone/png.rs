//! PNG pictures.

use super::picture::Picture;

/// A picture as a PNG file, grey if it is grey all over, 8 bits a sample, with its resolution. A sample is its
/// tone times 255: half of it is half as much light, there is no gamma.
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
    let sample = |tone: f32| (tone.clamp(0.0, 1.0) * 255.0).round() as u8;
    let (color, samples): (_, Vec<u8>) = match picture.is_grey() {
        true => (png::ColorType::Grayscale, picture.tones().into_iter().map(sample).collect()),
        false => {
            let samples = picture.pixels.iter().flatten().map(|&part| sample(part));
            (png::ColorType::Rgb, samples.collect())
        }
    };
    let mut file = vec![];
    let [width, height] = picture.frame.size;
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    let to_metre = (1000.0 / picture.frame.pitch()).round().min(f64::from(u32::MAX)) as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: to_metre,
        yppu: to_metre,
        unit: png::Unit::Meter,
    }));
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&samples));
    written.expect("samples fill the picture, and memory takes them");
    file
}
