//! Means of tones over rectangles.

use glam::DVec2;

use super::picture::{Frame, Picture};

/// Sums of the tones above and to the left of each pixel's corner (Crow 1984), so that a mean over any rectangle
/// takes four of them.
pub(super) struct Average {
    frame: Frame,
    sums: Vec<f64>,
}

impl Average {
    /// The means of a picture.
    pub fn of(picture: &Picture) -> Average {
        let frame = picture.frame;
        let width = frame.size[0] as usize;
        let mut sums = vec![0.0; (width + 1) * (frame.size[1] as usize + 1)];
        for (row, tones) in picture.tones().chunks(width).enumerate() {
            let mut across = 0.0;
            for (column, tone) in tones.iter().enumerate() {
                across += f64::from(*tone);
                let place = (row + 1) * (width + 1) + column + 1;
                sums[place] = sums[place - width - 1] + across;
            }
        }
        Average { frame, sums }
    }

    /// The picture's frame.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The mean tone of a square with so long a side about a place on paper, as far as it is in the picture's frame;
    /// white outside.
    pub fn at(&self, center: DVec2, side: f64) -> f64 {
        self.over(center, DVec2::splat(side))
    }

    /// The mean tone of a rectangle about a place on paper, as far as it is in the picture's frame; white outside.
    pub fn over(&self, center: DVec2, size: DVec2) -> f64 {
        let [width, height] = self.frame.size.map(f64::from);
        let (middle, half) = (self.frame.column_row(center), size / self.frame.pitch() / 2.0);
        let clamp = |p: DVec2| p.clamp(DVec2::ZERO, DVec2::new(width, height));
        let (low, high) = (clamp(middle - half), clamp(middle + half));
        let sum = self.sum(high.x, high.y) - self.sum(low.x, high.y) - self.sum(high.x, low.y)
            + self.sum(low.x, low.y);
        let area = (high - low).element_product();
        if area > 0.0 { (sum / area).clamp(0.0, 1.0) } else { 1.0 }
    }

    /// The sum of the tones above and to the left of a place in columns and rows, linear within pixels.
    fn sum(&self, x: f64, y: f64) -> f64 {
        let [width, height] = self.frame.size.map(|n| n as usize);
        let (column, row) = ((x as usize).min(width - 1), (y as usize).min(height - 1));
        let (s, t) = (x - column as f64, y - row as f64);
        let at = |i: usize, j: usize| self.sums[(row + j) * (width + 1) + column + i];
        let across = |j: usize| at(0, j) * (1.0 - s) + at(1, j) * s;
        across(0) * (1.0 - t) + across(1) * t
    }
}
