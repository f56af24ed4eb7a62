//! Where light comes from.

use glam::{DMat3, DVec2, DVec3};
use thiserror::Error;

/// Parallel light, and what there is of light where it does not reach.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Sun {
    toward: DVec3,
    ambient: f64,
    strength: f64,
}

/// Why there is no such light.
#[derive(Clone, Copy, PartialEq, Debug, Error)]
pub enum LightError {
    /// A direction without a length.
    #[error("the direction towards the sun is {0}; it needs a finite length above 0")]
    NoDirection(DVec3),
    /// A share of ambient light that is no share.
    #[error("the ambient light is {0}; it must be from 0 to 1")]
    Ambient(f64),
    /// A strength that adds nothing or too much.
    #[error("the strength of the light is {0}; it must be a number above 0")]
    Strength(f64),
}

impl Sun {
    /// Light from a direction, given towards the sun; `ambient` is the tone of a white face in the shade,
    /// 0 black to 1 white.
    ///
    /// ```
    /// use glam::DVec3;
    /// use katachi::output::halftone::Sun;
    /// let noon = Sun::new(DVec3::Z * 5.0, 0.2).unwrap();
    /// assert_eq!(noon.toward(), DVec3::Z);
    /// assert!(Sun::new(DVec3::ZERO, 0.2).is_err());
    /// ```
    pub fn new(toward: DVec3, ambient: f64) -> Result<Sun, LightError> {
        let toward = toward.try_normalize().ok_or(LightError::NoDirection(toward))?;
        if !(0.0..=1.0).contains(&ambient) {
            return Err(LightError::Ambient(ambient));
        }
        Ok(Sun { toward, ambient, strength: 1.0 })
    }

    /// The same light so many times as strong, beside others.
    pub fn with_strength(self, strength: f64) -> Result<Sun, LightError> {
        let real = strength.is_finite() && strength > 0.0;
        if real { Ok(Sun { strength, ..self }) } else { Err(LightError::Strength(strength)) }
    }

    /// Unit vector towards the sun.
    pub fn toward(&self) -> DVec3 {
        self.toward
    }

    /// How strong it is beside other lights.
    pub fn strength(&self) -> f64 {
        self.strength
    }

    /// The tone that this light alone gives a white face, Lambert's law: `cosine` of the angle between its
    /// normal and the direction of the sun, not above 0 where the light does not reach.
    pub fn tone(&self, cosine: f64) -> f64 {
        self.ambient + (1.0 - self.ambient) * cosine.max(0.0)
    }

    /// The scene as the sun sees it.
    pub(super) fn eye(&self) -> Eye {
        let across = self.toward.any_orthonormal_vector();
        Eye(DMat3::from_cols(across, self.toward.cross(across), self.toward))
    }
}

/// The sun as the first eye: x and y across its rays, z towards it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eye(DMat3);

impl Eye {
    /// Where a point is, seen from the sun.
    pub fn see(&self, p: DVec3) -> DVec3 {
        self.0.transpose() * p
    }

    /// The point in space that the sun sees so.
    pub fn place(&self, seen: DVec3) -> DVec3 {
        self.0 * seen
    }
}

/// A plane as the sun sees it: how near it is at each place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slope {
    /// Growth along x and y.
    rise: DVec2,
    /// A point of it, as the sun sees it.
    base: DVec3,
}

impl Slope {
    /// The plane through a point with a normal, both as the sun sees them; the normal not across the rays.
    pub fn new(base: DVec3, normal: DVec3) -> Slope {
        Slope { rise: -normal.truncate() / normal.z, base }
    }

    /// The point of the plane that a ray passes.
    pub fn at(&self, place: DVec2) -> DVec3 {
        place.extend(self.base.z + self.rise.dot(place - self.base.truncate()))
    }

    /// How much nearer to the sun than the plane a point is.
    pub fn height(&self, p: DVec3) -> f64 {
        (p.z - self.base.z) - self.rise.dot(p.truncate() - self.base.truncate())
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    #[test]
    fn what_the_sun_sees_comes_back() {
        let sun = Sun::new(dvec3(1.0, -2.0, 3.0), 0.1).expect("a direction");
        let (eye, p) = (sun.eye(), dvec3(4.0, 5.0, -6.0));
        assert!(eye.place(eye.see(p)).distance(p) < 1e-14);
        assert!((eye.see(sun.toward() * 2.0) - dvec3(0.0, 0.0, 2.0)).length() < 1e-14);
        let slope = Slope::new(eye.see(DVec3::ZERO), eye.see(DVec3::Z));
        let shadow = eye.place(slope.at(eye.see(dvec3(0.0, 0.0, 3.0)).truncate()));
        assert!(shadow.distance(dvec3(-1.0, 2.0, 0.0)) < 1e-14);
        assert!(
            (slope.height(eye.see(p + sun.toward())) - slope.height(eye.see(p)) - 1.0).abs()
                < 1e-14
        );
    }

    #[test]
    fn tones_follow_the_cosine() {
        let sun = Sun::new(DVec3::Z, 0.25).expect("a direction");
        assert_eq!([1.0, 0.5, 0.0, -1.0].map(|c| sun.tone(c)), [1.0, 0.625, 0.25, 0.25]);
        assert!(Sun::new(DVec3::Z, 1.5).is_err() && sun.with_strength(0.0).is_err());
    }
}
