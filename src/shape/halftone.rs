//! Half-tones as a model describes them: immutable, plain data.
//!
//! Lengths in millimetres, points in the frame of the model.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{
    drawing::{Place, Projection, StyleSpec},
    node::ShapeId,
};
use crate::geom::CurvedGrid;

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

/// What a picture's tones are made of.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum ScreenSpec {
    /// Grey or coloured pixels.
    Grey,
    /// Dots in a lattice.
    Dots {
        /// From dot to dot, above 0.
        pitch: f64,
        /// Of the rows of dots, degrees from the x axis.
        angle: f64,
    },
    /// Lines that swell.
    Lines {
        /// From line to line, above 0.
        pitch: f64,
        /// Degrees from the x axis.
        angle: f64,
    },
    /// Strokes that cross in the dark.
    Hatch {
        /// From stroke to stroke, above 0.
        pitch: f64,
        /// Of the first strokes, degrees from the x axis.
        angle: f64,
    },
    /// Equal dots without an order.
    Stipple {
        /// Least distance, above 0.
        pitch: f64,
        /// What spreads them.
        seed: u64,
    },
    /// Signs struck over each other.
    Overstrike {
        /// Levels of tone, 2 or more.
        levels: u32,
    },
    /// Black squares.
    Diffusion {
        /// Their side, above 0.
        side: f64,
        /// Atkinson's filter in place of Floyd's and Steinberg's.
        atkinson: bool,
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
