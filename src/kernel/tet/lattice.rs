//! The lattice on which tetrahedra are made.

use glam::DVec3;

use crate::geom::Bounds;

/// Half the extent of the lattice of given points, in steps (27 bits and a sign).
const RANGE: f64 = (1u64 << 27) as f64;
/// How often an edge between lattice points can be halved: new points are on it exactly.
pub(super) const HALVINGS: u32 = 24;
/// What one step of given points is in coordinates of the finer lattice.
const FINE: f64 = (1u64 << HALVINGS) as f64;

/// A cubic lattice around a model: given points are rounded to multiples of 2^24, edges are split at the
/// integers between. Coordinates are integers below 2^51, floats without rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    centre: DVec3,
    /// A step of given points in mm, a power of two.
    step: f64,
}

impl Lattice {
    /// The lattice of a model in these bounds: the finest that holds them, no finer than a float.
    pub(super) fn around(bounds: Bounds) -> Lattice {
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
        let half = (bounds.max - bounds.min).max_element() / 2.0;
        let step = power_of_two_above(half / (RANGE - 1.0))
            .max(power_of_two_above(largest * f64::EPSILON));
        let centre = ((bounds.min + bounds.max) / (2.0 * step)).round() * step;
        Lattice { centre, step }
    }

    /// The lattice point nearest to a place in mm.
    pub(super) fn point(&self, place: DVec3) -> DVec3 {
        ((place - self.centre) / self.step).round() * FINE
    }

    /// The place in mm of a point of the lattice.
    pub(super) fn place(&self, point: DVec3) -> DVec3 {
        point / FINE * self.step + self.centre
    }

    /// The largest coordinate of its middle in mm.
    pub(super) fn reach(&self) -> f64 {
        self.centre.abs().max_element()
    }
}

/// The smallest power of two that is not below; of zero the smallest normal float.
fn power_of_two_above(value: f64) -> f64 {
    let exponent = libm::frexp(value.max(f64::MIN_POSITIVE)).1;
    libm::ldexp(1.0, exponent)
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    #[test]
    fn points_on_the_lattice_are_kept() {
        let corners = [dvec3(-100.0, 3.25, 0.0), dvec3(411.5, 7.0, 2.125)];
        let lattice = Lattice::around(Bounds::of(corners));
        assert!(lattice.step <= 1e-5);
        for corner in corners {
            let point = lattice.point(corner);
            assert!(point.abs().max_element() < 2f64.powi(51) && point == point.round());
            assert_eq!(lattice.place(point), corner);
        }
    }
}
