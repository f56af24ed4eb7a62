//! The isometric picture: what a point looks like from (1, -1, 1), and what a drawing in it says of space.
//!
//! # Paper
//! METHODS 4.1 (Nakajima): turn about z, tilt by 35.264 degrees (sin = 1 / sqrt 3); the axes meet at equal angles and shrink
//! by sqrt(2/3) = 0.816.

use glam::{DVec2, DVec3, dvec2};

/// How much the axes shrink: sqrt(2/3).
pub const SHRINK: f64 = 0.816_496_580_927_726;

/// The image of a point, mm on paper: x to the right, y up, the origin at the origin.
///
/// ```
/// use glam::DVec3;
/// use katachi::geom::isometric::{SHRINK, image};
/// assert_eq!(image(DVec3::Z).x, 0.0);
/// assert!((image(DVec3::X).length() - SHRINK).abs() < 1e-15);
/// assert!((image(DVec3::Y) - image(DVec3::X) - image(DVec3::Z)).length() < 1e-15);
/// ```
pub fn image(p: DVec3) -> DVec2 {
    let (root2, root6) = (std::f64::consts::SQRT_2, 6f64.sqrt());
    dvec2((p.x + p.y) / root2, (p.y - p.x + 2.0 * p.z) / root6)
}

/// How near the eye a point is, mm: points with the same image differ along (1, -1, 1).
pub fn nearness(p: DVec3) -> f64 {
    (p.x - p.y + p.z) / 3f64.sqrt()
}

/// How the lengths of a drawing are read.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct IsoScale {
    /// The point in space of the first point drawn, mm.
    pub origin: DVec3,
    /// Millimetres of the model for one user unit along an axis; if none, a length on paper is that of the model times
    /// [`SHRINK`].
    pub unit: Option<f64>,
    /// Lengths within a tenth of it of its multiples are those multiples, mm of the model.
    pub snap: Option<f64>,
}

/// A line of a drawing, in space.
#[derive(Clone, PartialEq, Debug)]
pub struct IsoLine {
    /// What it is called in the file.
    pub name: Option<String>,
    /// Its corners, mm.
    pub points: Vec<DVec3>,
    /// Those of them that are marked; all if none is.
    pub marks: Vec<DVec3>,
    /// Whether the last corner joins the first.
    pub closed: bool,
    /// Whether it is an edge; if not it only leads to points.
    pub is_edge: bool,
}

/// A drawing, in space.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct IsoDrawing {
    /// The points it registers, in the order of drawing, mm.
    pub vertices: Vec<DVec3>,
    /// Its lines in the order of drawing.
    pub lines: Vec<IsoLine>,
    /// What was left out or could be read in several ways, one sentence each.
    pub notes: Vec<String>,
}
