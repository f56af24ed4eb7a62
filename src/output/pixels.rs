//! Pixels of 8 bits a sample, and PNG files of them.

/// Rows of grey or coloured samples, the uppermost first. A sample is its tone times 255: half of it is half as much
/// light, there is no gamma.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Pixels {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Whether there is one sample to a pixel; otherwise there are red, green and blue.
    pub is_grey: bool,
    /// The samples.
    pub samples: Vec<u8>,
}

impl Pixels {
    /// A PNG file of pixels with a side in mm.
    ///
    /// ```
    /// use katachi::output::pixels::Pixels;
    /// let file = Pixels { size: [2, 1], is_grey: true, samples: vec![0, 255] }.png(0.1);
    /// assert_eq!(&file[1..4], b"PNG");
    /// ```
    ///
    /// # Panics
    /// When there are more or fewer samples than the size says.
    pub fn png(&self, side: f64) -> Vec<u8> {
        let mut file = vec![];
        let mut encoder = png::Encoder::new(&mut file, self.size[0], self.size[1]);
        let color = if self.is_grey { png::ColorType::Grayscale } else { png::ColorType::Rgb };
        encoder.set_color(color);
        encoder.set_depth(png::BitDepth::Eight);
        let to_metre = (1000.0 / side).round().min(f64::from(u32::MAX)) as u32;
        encoder.set_pixel_dims(Some(png::PixelDimensions {
            xppu: to_metre,
            yppu: to_metre,
            unit: png::Unit::Meter,
        }));
        let written =
            encoder.write_header().and_then(|mut writer| writer.write_image_data(&self.samples));
        written.expect("samples fill the picture, and memory takes them");
        file
    }
}
