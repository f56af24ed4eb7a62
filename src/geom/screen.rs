//! Screens: what the tones of a picture become on paper that is black or white.

/// How tones are made of black shapes. Pitches in millimetres, angles in degrees from the x axis.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Screen {
    /// Dots in a lattice, the darker the larger.
    Dots {
        /// From dot to dot, above 0.
        pitch: f64,
        /// Of the rows of dots.
        angle: f64,
        /// Of a dot.
        shape: DotShape,
    },
    /// Lines, the darker the wider.
    Lines {
        /// From line to line, above 0.
        pitch: f64,
        /// Of the lines.
        angle: f64,
    },
    /// Strokes of one pen, the darker the more, crossing each other in the dark.
    Hatch {
        /// From stroke to stroke, above 0; the pen is half as wide.
        pitch: f64,
        /// Of the first strokes on flat faces; on round ones they follow the face.
        angle: f64,
    },
    /// Equal dots, the darker the more, without an order.
    Stipple {
        /// The least distance of dots, above 0.
        pitch: f64,
        /// What spreads them.
        seed: u64,
    },
    /// Black squares.
    Diffusion {
        /// Their side, above 0.
        side: f64,
        /// Atkinson's filter in place of Floyd's and Steinberg's.
        atkinson: bool,
    },
}

/// The shape of the dots of a lattice.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum DotShape {
    /// Discs.
    #[default]
    Round,
    /// Ellipses half as long again as they are wide: in middle tones they touch in one direction before the other.
    Ellipse,
    /// Squares along the lattice.
    Square,
    /// Squares on their corners, which touch at half the tone.
    Diamond,
    /// Bars as long as the pitch along the lattice.
    Line,
}

impl DotShape {
    /// All of them.
    pub const ALL: [DotShape; 5] =
        [DotShape::Round, DotShape::Ellipse, DotShape::Square, DotShape::Diamond, DotShape::Line];
}

impl Screen {
    /// From cell to cell, mm.
    pub fn pitch(&self) -> f64 {
        match *self {
            Screen::Dots { pitch, .. }
            | Screen::Lines { pitch, .. }
            | Screen::Hatch { pitch, .. }
            | Screen::Stipple { pitch, .. } => pitch,
            Screen::Diffusion { side, .. } => side,
        }
    }
}
