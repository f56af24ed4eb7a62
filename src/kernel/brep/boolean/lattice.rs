//! The integer lattice of one operation.
//!
//! Its step is 1, 2 or 5 times a power of ten millimetres, so coordinates that a person writes are
//! lattice points exactly, and a lattice point gives back the very double that the decimal numeral
//! means: it is found by one correctly rounded division of two exact integers.

use glam::DVec3;

use crate::geom::predicates::RANGE;

/// Powers of ten up to this one are exact doubles.
const EXACT_POWER: i32 = 22;

/// A decimal lattice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    /// 1, 2 or 5.
    digit: f64,
    /// The step is `digit` times ten to this power.
    power: i32,
    /// The lattice point that local coordinates count from, in steps.
    center: [f64; 3],
}

impl Lattice {
    /// The finest lattice whose range holds the box; `None` for a box that is not finite.
    pub fn covering(min: DVec3, max: DVec3) -> Option<Lattice> {
        let reach =
            ((max - min).max_element() / 2.0).max(min.abs().max(max.abs()).max_element() * FAR);
        if !reach.is_finite() || reach > 1e200 {
            return None;
        }
        let middle = (min + max) / 2.0;
        let mut lattice = Lattice { digit: 1.0, power: -EXACT_POWER, center: [0.0; 3] };
        while reach / lattice.step() > (RANGE - 4) as f64 {
            lattice = lattice.coarser();
        }
        lattice.center = middle.to_array().map(|c| lattice.count(c).round());
        Some(lattice)
    }

    fn coarser(self) -> Lattice {
        let (digit, power) = match self.digit as i32 {
            1 => (2.0, self.power),
            2 => (5.0, self.power),
            _ => (1.0, self.power + 1),
        };
        Lattice { digit, power, ..self }
    }

    /// The same lattice with a step so many grades coarser; three are a factor of ten.
    pub fn coarsened(&self, grades: u32) -> Lattice {
        let coarse = (0..grades).fold(*self, |lattice, _| lattice.coarser());
        let center = self.place([0.0; 3]).to_array().map(|c| coarse.count(c).round());
        Lattice { center, ..coarse }
    }

    /// The step in millimetres.
    pub fn step(&self) -> f64 {
        self.length(1.0)
    }

    /// A length of so many steps.
    fn length(&self, steps: f64) -> f64 {
        let ten = |power: i32| TENS[power.unsigned_abs().min(EXACT_POWER as u32) as usize];
        if self.power <= 0 {
            steps * self.digit / ten(self.power)
        } else {
            let mut length = steps * self.digit;
            let mut left = self.power;
            while left > 0 {
                length *= ten(left);
                left -= EXACT_POWER;
            }
            length
        }
    }

    /// A coordinate counted in steps, not rounded.
    fn count(&self, coordinate: f64) -> f64 {
        if self.power <= 0 {
            coordinate * TENS[self.power.unsigned_abs() as usize] / self.digit
        } else {
            coordinate / self.step()
        }
    }

    /// The nearest lattice point, counted from the centre.
    pub fn snap(&self, point: DVec3) -> [i32; 3] {
        let p = point.to_array();
        std::array::from_fn(|i| (rounded(self.count(p[i])) - self.center[i]) as i32)
    }

    /// The place of a point given in steps from the centre, mm.
    pub fn place(&self, local: [f64; 3]) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|i| self.length(local[i] + self.center[i])))
    }
}

/// The nearest whole number, away from 0 between two, as `f64::round` has it; of counts, which fit into an
/// integer, it is found faster.
fn rounded(count: f64) -> f64 {
    let cut = count as i64 as f64;
    let beyond = f64::from(u8::from((count - cut).abs() >= 0.5));
    cut + beyond.copysign(count)
}

/// Doubles far from the origin are themselves a lattice of 2^-53 times their size; a finer lattice
/// would bring nothing and its indices would not be exact.
const FAR: f64 = 1.0 / (1u64 << 22) as f64;

const TENS: [f64; EXACT_POWER as usize + 1] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_numbers_are_lattice_points_and_come_back_to_the_bit() {
        let lattice = Lattice::covering(DVec3::splat(-100.0), DVec3::splat(300.0)).expect("finite");
        assert_eq!(lattice.step(), 5e-7);
        for text in ["0.1", "12.345", "-99.999", "0.3", "299.7", "17.0005"] {
            let value: f64 = text.parse().expect("a number");
            let index = lattice.snap(DVec3::splat(value));
            assert_eq!(lattice.place(index.map(f64::from)), DVec3::splat(value), "{text}");
        }
    }

    #[test]
    fn coarser_lattices_are_about_the_same_place() {
        let fine = Lattice::covering(DVec3::splat(100.0), DVec3::splat(300.0)).expect("finite");
        let coarse = fine.coarsened(3);
        assert!((coarse.step() - 10.0 * fine.step()).abs() < 1e-20);
        let point = DVec3::new(101.25, 200.5, 299.0);
        let back = coarse.place(coarse.snap(point).map(f64::from));
        assert_eq!(back, point);
        assert!(coarse.snap(point).iter().all(|&c| i64::from(c).abs() < RANGE / 8));
    }

    #[test]
    fn the_range_holds_far_and_huge_models() {
        for (min, max) in [(1e6, 1e6 + 1.0), (-3e30, 5e30), (0.0, 1e-9), (0.0, 0.0)] {
            let (min, max) = (DVec3::splat(min), DVec3::splat(max));
            let lattice = Lattice::covering(min, max).expect("finite");
            for p in [min, max] {
                assert!(
                    lattice.snap(p).iter().all(|&c| i64::from(c).abs() <= RANGE),
                    "{min} {max}"
                );
                let back = lattice.place(lattice.snap(p).map(f64::from));
                assert!((back - p).abs().max_element() <= lattice.step());
            }
        }
        assert!(Lattice::covering(DVec3::ZERO, DVec3::INFINITY).is_none());
    }
}
