//! Numbers in rows and columns: what a height map holds.

/// Numbers in rows, the uppermost row first; at least 2 x 2, all finite.
#[derive(Clone, PartialEq, Debug)]
pub struct Raster {
    width: usize,
    values: Vec<f64>,
}

impl Raster {
    /// Rows of so many numbers one after another; `None` unless they are at least 2 x 2 and all finite.
    pub fn new(width: usize, values: Vec<f64>) -> Option<Raster> {
        let whole = width >= 2 && values.len() >= 2 * width && values.len().is_multiple_of(width);
        (whole && values.iter().all(|v| v.is_finite())).then_some(Raster { width, values })
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.values.len() / self.width]
    }

    /// The number at a place, from 0, 0 at the upper left to 1, 1 at the lower right, linear between its neighbours.
    ///
    /// ```
    /// use katachi::geom::Raster;
    /// let raster = Raster::new(2, vec![0.0, 1.0, 2.0, 5.0]).unwrap();
    /// assert_eq!((raster.at(1.0, 0.0), raster.at(0.5, 1.0), raster.at(0.5, 0.5)), (1.0, 3.5, 2.0));
    /// ```
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let [width, height] = self.size();
        let cell = |t: f64, n: usize| {
            let place = (t * (n - 1) as f64).clamp(0.0, (n - 1) as f64);
            let first = (place as usize).min(n - 2);
            (first, place - first as f64)
        };
        let ((i, s), (j, t)) = (cell(x, width), cell(y, height));
        let value = |i: usize, j: usize| self.values[j * width + i];
        let across = |j: usize| value(i, j) * (1.0 - s) + value(i + 1, j) * s;
        across(j) * (1.0 - t) + across(j + 1) * t
    }
}
