//! The sides of a facet by level strips, for facets of very many sides.

use glam::DVec2;

use super::{lattice::turn, model::Model};

/// Sides in each strip they run through.
#[derive(Clone, Debug)]
pub struct Strips {
    low: f64,
    /// Strips for each step.
    scale: f64,
    strips: Vec<Vec<[u32; 2]>>,
}

impl Strips {
    /// The sides of a facet between two levels.
    pub fn new(model: &Model, sides: &[[u32; 2]], low: f64, high: f64) -> Strips {
        let count = (sides.len() / 4).max(1);
        let scale = count as f64 / (high - low).max(1.0);
        let mut strips = Strips { low, scale, strips: vec![vec![]; count] };
        for &side in sides {
            let [p, q] = side.map(|i| strips.place(model.at[i as usize].y));
            strips.strips[p.min(q)..=p.max(q)].iter_mut().for_each(|s| s.push(side));
        }
        strips
    }

    fn place(&self, y: f64) -> usize {
        (((y - self.low) * self.scale) as usize).min(self.strips.len() - 1)
    }

    /// How often the facet winds around a place.
    pub fn winding(&self, model: &Model, p: DVec2) -> i32 {
        let mut winding = 0;
        for &[a, b] in &self.strips[self.place(p.y)] {
            let [a, b] = [a, b].map(|i| model.at[i as usize]);
            if (a.y > p.y) != (b.y > p.y) {
                let rises = b.y > a.y;
                if (turn(a, b, p) > 0.0) == rises {
                    winding += if rises { 1 } else { -1 };
                }
            }
        }
        winding
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::output::drawing::{Camera, Options, Scene, View};

    #[test]
    fn a_ring_winds_around_what_it_covers() {
        let mut model =
            Model::new(&Scene::default(), &Camera::view(View::Top), &Options::default());
        let mut sides = vec![];
        for (radius, turn) in [(1000.0, 1.0), (500.0, -1.0)] {
            let first = model.at.len() as u32;
            for i in 0..100 {
                let (sin, cos) = libm::sincos(f64::from(i) * turn * std::f64::consts::TAU / 100.0);
                model.at.push((dvec2(cos, sin) * radius).round());
                sides.push([first + i, first + (i + 1) % 100]);
            }
        }
        let strips = Strips::new(&model, &sides, -1000.0, 1000.0);
        for i in 0..200 {
            let p = dvec2(f64::from(i) * 7.3 - 730.0, f64::from(i) * 3.1 - 310.0);
            let inside = (500.0..1000.0).contains(&p.length());
            assert_eq!(strips.winding(&model, p), i32::from(inside), "{p}");
        }
    }
}
