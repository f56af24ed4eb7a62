//! The guide mesh of isometric drawing: three families of parallel lines and the axes, to sketch over.

use glam::{DVec2, DVec3, dvec2};

use super::{
    lettering::{Anchor, Lettering, write},
    page::{Ink, Mark},
    pen::Layer,
};
use crate::geom::isometric::{SHRINK, image};

/// The most lines of one mesh.
pub const MOST_LINES: f64 = 5000.0;

/// Width and height of a mesh with nothing in it and no window, mm: an A4 sheet with its margins.
const BLANK: DVec2 = dvec2(180.0, 250.0);

/// Pitches of free mesh around what is drawn.
const AROUND: f64 = 2.0;

/// Half the width of an axis, mm.
const AXIS: f64 = 0.15;

/// Length of an arrow, and half its width, in heights of the text.
const ARROW: f64 = 1.0;
const SLOPE: f64 = 0.2;

/// From the tip of an axis to the middle of its letter, along and across, in heights of the text.
const BACK: f64 = 1.6;
const BESIDE: f64 = 0.9;

/// A guide mesh in a view from ISO.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct IsometricGrid {
    /// The image of the origin of the model, mm at scale 1.
    pub origin: DVec2,
    /// From line to line along an axis, mm of the model.
    pub pitch: f64,
    /// Opposite corners of the mesh, mm at scale 1; around all that is drawn if there are none.
    pub window: Option<[DVec2; 2]>,
}

impl IsometricGrid {
    /// What it covers at a scale, given the box around what is drawn.
    fn area(&self, scale: f64, outline: Option<(DVec2, DVec2)>) -> (DVec2, DVec2) {
        let margin = DVec2::splat(AROUND * self.pitch * scale);
        match (self.window, outline) {
            (Some([min, max]), _) => (min * scale, max * scale),
            (None, Some((min, max))) => (min - margin, max + margin),
            (None, None) => (self.origin * scale - BLANK / 2.0, self.origin * scale + BLANK / 2.0),
        }
    }

    /// How many lines it has.
    pub fn lines(&self, scale: f64, outline: Option<(DVec2, DVec2)>) -> f64 {
        let (min, max) = self.area(scale, outline);
        DVec3::AXES.iter().map(|axis| self.family(*axis, scale, (min, max)).1).sum()
    }

    /// The lowest line along an axis that meets an area, counted from the one through the origin, and how many do.
    fn family(&self, axis: DVec3, scale: f64, (min, max): (DVec2, DVec2)) -> (f64, f64) {
        let across = (image(axis) / SHRINK).perp();
        let corners = [min, max, dvec2(min.x, max.y), dvec2(max.x, min.y)];
        let step = self.step(scale);
        let height = |corner: DVec2| (corner - self.origin * scale).dot(across) / step;
        let heights = corners.map(height);
        let low = heights.into_iter().fold(f64::MAX, f64::min).ceil();
        let high = heights.into_iter().fold(f64::MIN, f64::max).floor();
        (low, (high - low + 1.0).max(0.0))
    }

    /// Between two lines of a family, mm on paper: the height of the triangles of the mesh.
    fn step(&self, scale: f64) -> f64 {
        self.pitch * scale * SHRINK * 3f64.sqrt() / 2.0
    }

    /// The mesh and the axes at a scale, `outline` being the box around what is drawn.
    pub fn inks(
        &self,
        scale: f64,
        outline: Option<(DVec2, DVec2)>,
        height: f64,
        lettering: &dyn Lettering,
    ) -> Vec<Ink> {
        let area = self.area(scale, outline);
        let origin = self.origin * scale;
        let mut inks = vec![];
        for (axis, name) in DVec3::AXES.into_iter().zip(["x", "y", "z"]) {
            let along = image(axis) / SHRINK;
            let (low, count) = self.family(axis, scale, area);
            for i in 0..count.min(MOST_LINES) as u32 {
                let at = origin + along.perp() * ((low + f64::from(i)) * self.step(scale));
                let ends = clipped(at, along, area, f64::NEG_INFINITY);
                inks.extend(ends.map(|[from, to]| Ink::stroke(Layer::Grid, from, to)));
            }
            if let Some([from, to]) = clipped(origin, along, area, 0.0) {
                inks.push(arrow(from, to, along, height));
                let middle = to + (along.perp() * BESIDE - along * BACK) * height;
                let place = (middle - DVec2::Y * (height / 2.0), Anchor::Middle, 0.0);
                inks.push(write(lettering, Layer::Grid, name, height, place));
            }
        }
        inks
    }
}

/// An axis as a narrow area that ends in an arrow.
fn arrow(from: DVec2, to: DVec2, along: DVec2, height: f64) -> Ink {
    let (side, neck) = (along.perp(), to - along * (ARROW * height));
    let (thin, wide) = (side * AXIS, side * (SLOPE * ARROW * height));
    let outline =
        vec![from - thin, neck - thin, neck - wide, to, neck + wide, neck + thin, from + thin];
    Ink { layer: Layer::Grid, mark: Mark::Area(vec![outline]), part: None }
}

/// The part of a line in a box, from a place along it on.
fn clipped(at: DVec2, along: DVec2, (min, max): (DVec2, DVec2), start: f64) -> Option<[DVec2; 2]> {
    let (mut from, mut to) = (start, f64::INFINITY);
    for axis in 0..2 {
        let (p, d) = (at[axis], along[axis]);
        if d.abs() < UPRIGHT {
            if p < min[axis] || p > max[axis] {
                return None;
            }
            continue;
        }
        let ends = [(min[axis] - p) / d, (max[axis] - p) / d];
        from = from.max(ends[0].min(ends[1]));
        to = to.min(ends[0].max(ends[1]));
    }
    (from < to).then(|| [at + along * from, at + along * to])
}

/// A direction with a smaller coordinate is along the other axis of the paper: the z axis is.
const UPRIGHT: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::sheet::{DrawingFormat, Figure, Unlettered, bounds, write as file};

    const GRID: IsometricGrid = IsometricGrid {
        origin: DVec2::ZERO,
        pitch: 10.0,
        window: Some([dvec2(-30.0, -20.0), dvec2(40.0, 50.0)]),
    };

    #[test]
    fn the_mesh_fills_its_window_and_passes_through_grid_points() {
        let inks = GRID.inks(1.0, None, 3.5, &Unlettered);
        let (min, max) = bounds(&inks).expect("ink");
        assert!(min.distance(dvec2(-30.0, -20.0)) < 0.3 && max.distance(dvec2(40.0, 50.0)) < 0.3);
        let lines = inks.iter().filter_map(|ink| match &ink.mark {
            Mark::Line(path) => Some([path.start, path.segments[0].end()]),
            _ => None,
        });
        let lines: Vec<[DVec2; 2]> = lines.collect();
        assert_eq!(lines.len() as f64, GRID.lines(1.0, None));
        let through = |p: DVec2| {
            let off = |[a, b]: &[DVec2; 2]| ((p - *a).perp_dot(*b - *a) / a.distance(*b)).abs();
            lines.iter().filter(|line| off(line) < 1e-9).count()
        };
        for point in [DVec3::ZERO, DVec3::X * 10.0, DVec3::new(10.0, 20.0, 30.0)] {
            assert_eq!(through(image(point)), 3);
        }
    }

    #[test]
    fn the_mesh_scales_with_the_view() {
        assert_eq!(GRID.lines(0.1, None), GRID.lines(1.0, None));
        let free = IsometricGrid { window: None, ..GRID };
        assert!(free.lines(1.0, Some((DVec2::ZERO, DVec2::splat(20.0)))) > 10.0);
        assert!(IsometricGrid { pitch: 1e-6, ..GRID }.lines(1.0, None) > MOST_LINES);
    }

    #[test]
    fn every_format_has_the_mesh_in_a_layer_of_its_own() {
        let figure = Figure { grid: Some(GRID), ..Figure::default() };
        let page = figure.page("paper", &Unlettered);
        assert!(page.size.distance(dvec2(80.0, 80.0)) < 1.0);
        for format in DrawingFormat::ALL {
            let bytes = file(format, &page);
            let has = |name: &[u8]| bytes.windows(name.len()).any(|part| part == name);
            assert!(has(b"grid") || has(b"GRID"), "{}", format.name());
        }
    }
}
