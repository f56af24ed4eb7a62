//! Charges: points with a potential that falls off with the distance.

use glam::DVec3;

/// How a potential falls off with the distance d, mm.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Falloff {
    /// 1 / d.
    Inverse,
    /// 1 / d^2.
    InverseSquare,
    /// 1 - 22/9 u + 17/9 u^2 - 4/9 u^3 with u = (d / r)^2, and 0 beyond r.
    ///
    /// Source: Wyvill, G., McPheeters, C., Wyvill, B.: *Data structure for soft objects*, 1986.
    Wyvill {
        /// How far it reaches, mm.
        r: f64,
    },
    /// exp(-(d / r)^2).
    ///
    /// Source: Blinn, J. F.: *A generalization of algebraic surface drawing*, 1982.
    Blinn {
        /// Where it has fallen to 1 / e, mm.
        r: f64,
    },
}

/// A point charge.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Charge {
    /// Where it is, mm.
    pub at: DVec3,
    /// Its strength; a negative one pushes the surface away.
    pub q: f64,
    /// How its potential falls off.
    pub falloff: Falloff,
}

impl Falloff {
    /// The potential of strength 1 at the square of a distance, and its derivative by that square. Both fall
    /// and rise respectively as the distance grows.
    ///
    /// ```
    /// use katachi::geom::charge::Falloff;
    /// assert_eq!(Falloff::Inverse.at(4.0), [0.5, -0.0625]);
    /// assert_eq!(Falloff::Wyvill { r: 2.0 }.at(4.0), [0.0, 0.0]);
    /// ```
    pub fn at(self, square: f64) -> [f64; 2] {
        match self {
            Falloff::Inverse => {
                let inverse = 1.0 / square.sqrt();
                [inverse, -0.5 * inverse / square]
            }
            Falloff::InverseSquare => [1.0 / square, -1.0 / (square * square)],
            Falloff::Wyvill { r } if square < r * r => {
                let u = square / (r * r);
                let value = 1.0 + u * (-22.0 + u * (17.0 - 4.0 * u)) / 9.0;
                [value, (-22.0 + u * (34.0 - 12.0 * u)) / (9.0 * r * r)]
            }
            Falloff::Wyvill { .. } => [0.0, 0.0],
            Falloff::Blinn { r } => {
                let value = libm::exp(-square / (r * r));
                [value, -value / (r * r)]
            }
        }
    }
}
