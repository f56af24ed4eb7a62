//! The order in which a plotter draws strokes.

use glam::DVec2;

use crate::output::drawing::Window;

/// Strokes in an order in which the pen is always put down at the nearest end that is left, the first time near the
/// lower left corner. Strokes may be turned round.
pub(super) fn sorted(strokes: Vec<Vec<DVec2>>, window: Window) -> Vec<Vec<DVec2>> {
    let mut left: Vec<Option<Vec<DVec2>>> =
        strokes.into_iter().map(|stroke| (stroke.len() > 1).then_some(stroke)).collect();
    let mut ends = Ends::of(&left, window);
    let mut sorted = Vec::with_capacity(left.len());
    let mut at = window.min;
    while let Some(end) = ends.nearest(at, &left) {
        let Some(mut stroke) = left[(end / 2) as usize].take() else { break };
        if end % 2 == 1 {
            stroke.reverse();
        }
        at = stroke[stroke.len() - 1];
        sorted.push(stroke);
    }
    sorted
}

/// Ends of strokes in square cells: number 2 i is the start of stroke i, 2 i + 1 its end.
struct Ends {
    low: DVec2,
    side: f64,
    size: [i64; 2],
    cells: Vec<Vec<(u32, DVec2)>>,
}

impl Ends {
    fn of(strokes: &[Option<Vec<DVec2>>], window: Window) -> Ends {
        let extent = window.max - window.min;
        let area = extent.element_product() / (strokes.len() + 1) as f64;
        let side = area.sqrt().max(extent.max_element() / MOST_CELLS);
        let size = [extent.x, extent.y].map(|length| (length / side).ceil().max(1.0) as i64);
        let cells = vec![vec![]; (size[0] * size[1]) as usize];
        let mut ends = Ends { low: window.min, side, size, cells };
        for (number, stroke) in (0u32..).zip(strokes) {
            let Some([first, .., last]) = stroke.as_deref() else { continue };
            for (end, p) in [(2 * number, *first), (2 * number + 1, *last)] {
                let [x, y] = ends.cell(p);
                ends.cells[(y * ends.size[0] + x) as usize].push((end, p));
            }
        }
        ends
    }

    fn cell(&self, p: DVec2) -> [i64; 2] {
        let at = ((p - self.low) / self.side).floor();
        [(at.x as i64).clamp(0, self.size[0] - 1), (at.y as i64).clamp(0, self.size[1] - 1)]
    }

    /// The nearest end of strokes that are left; of equally near ones that of the lowest number.
    fn nearest(&mut self, from: DVec2, left: &[Option<Vec<DVec2>>]) -> Option<u32> {
        let middle = self.cell(from);
        let mut best: Option<(f64, u32)> = None;
        for ring in 0..=self.size[0].max(self.size[1]) {
            // All that is nearer than this was looked at.
            let sure = (ring - 1).max(0) as f64 * self.side;
            if best.is_some_and(|(far, _)| far <= sure * sure) {
                break;
            }
            for cell in cells_of_ring(middle, ring, self.size) {
                let list = &mut self.cells[cell];
                list.retain(|(end, _)| left[(end / 2) as usize].is_some());
                for (end, p) in list.iter() {
                    let found = (p.distance_squared(from), *end);
                    if best.is_none_or(|best| found < best) {
                        best = Some(found);
                    }
                }
            }
        }
        best.map(|(_, end)| end)
    }
}

/// Cells along a side at most.
const MOST_CELLS: f64 = 2000.0;

/// The cells so many away from one, as far as they exist.
fn cells_of_ring([x, y]: [i64; 2], ring: i64, size: [i64; 2]) -> impl Iterator<Item = usize> {
    let rows = (y - ring).max(0)..=(y + ring).min(size[1] - 1);
    rows.flat_map(move |row| {
        let step = if (row - y).abs() == ring { 1 } else { (2 * ring).max(1) };
        let columns = (x - ring..=x + ring).step_by(step as usize);
        columns.filter(move |c| (0..size[0]).contains(c)).map(move |c| (row * size[0] + c) as usize)
    })
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn the_pen_goes_to_what_is_near() {
        let stroke = |x: f64, y: f64| vec![dvec2(x, y), dvec2(x + 1.0, y)];
        let strokes = vec![stroke(0.0, 2.0), stroke(0.0, 0.0), stroke(0.0, 1.0)];
        let window = Window { min: DVec2::ZERO, max: DVec2::splat(3.0) };
        let heights: Vec<DVec2> = sorted(strokes, window).iter().map(|s| s[0]).collect();
        assert_eq!(heights, [dvec2(0.0, 0.0), dvec2(1.0, 1.0), dvec2(0.0, 2.0)]);
    }
}
