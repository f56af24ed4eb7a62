//! Half-tones as a model describes them: immutable, plain data.
//!
//! Lengths in millimetres, points in the frame of the model.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{
    drawing::{Place, Projection, StyleSpec},
    node::ShapeId,
};
use crate::geom::{CurvedGrid, Screen};

/// Parallel light.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct SunSpec {
    /// Towards the sun; not zero.
    pub toward: DVec3,
    /// Tone of a white face in the shade, 0 to 1.
    pub ambient: f64,
    /// How strong it is beside other lights, above 0.
    pub strength: f64,
}

impl SunSpec {
    /// From the upper left before the scene, for who looks along +y.
    pub const DEFAULT: SunSpec =
        SunSpec { toward: DVec3::new(-1.0, -2.0, 3.0), ambient: 0.2, strength: 1.0 };
}

/// What a picture's tones are made of.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum ScreenSpec {
    /// Grey or coloured pixels.
    Grey,
    /// Black shapes.
    Ink(Screen),
    /// Signs struck over each other.
    Overstrike {
        /// Levels of tone, 2 or more.
        levels: u32,
    },
}

/// A picture of shapes in the light.
#[derive(Clone, PartialEq, Debug)]
pub struct ShadeSpec {
    /// Solids, each a body of its own.
    pub shapes: Vec<ShapeId>,
    /// Surfaces.
    pub surfaces: Vec<Arc<CurvedGrid>>,
    /// Where the eye is.
    pub projection: Projection,
    /// The image of this point is the origin of the picture.
    pub target: DVec3,
    /// Lower left and upper right corner of the picture, on paper at scale 1.
    pub window: Option<[DVec2; 2]>,
    /// The lights; at least one.
    pub suns: Vec<SunSpec>,
    /// Height of the plane that shadows fall on.
    pub ground: Option<f64>,
    /// What its tones are made of.
    pub screen: ScreenSpec,
    /// How lines are drawn over it, if they are.
    pub lines: Option<StyleSpec>,
    /// Pixels to the inch, above 0.
    pub dpi: f64,
    /// The call that made it.
    pub place: Place,
}
