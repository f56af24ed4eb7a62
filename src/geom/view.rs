//! How a scene is looked at: from which side, and what becomes of hidden lines.

use glam::DVec3;

/// The usual directions of view.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum View {
    /// Along +y, x to the right.
    Front,
    /// Along -y, x to the left.
    Back,
    /// From -x along +x, y to the left.
    Left,
    /// From +x along -x, y to the right.
    Right,
    /// From above, y up.
    Top,
    /// From below, y down.
    Bottom,
    /// From (1, -1, 1): all three axes shrink to sqrt(2/3).
    Iso,
    /// From (1, -sqrt 7, 1): the axes shrink as 1 : 1/2 : 1.
    Dimetric,
}

impl View {
    /// The direction towards the eye, not a unit vector.
    pub fn direction(self) -> DVec3 {
        match self {
            View::Front => DVec3::NEG_Y,
            View::Back => DVec3::Y,
            View::Left => DVec3::NEG_X,
            View::Right => DVec3::X,
            View::Top => DVec3::Z,
            View::Bottom => DVec3::NEG_Z,
            View::Iso => DVec3::new(1.0, -1.0, 1.0),
            View::Dimetric => DVec3::new(1.0, -(7.0f64.sqrt()), 1.0),
        }
    }
}

/// Which hidden lines are kept.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Hidden {
    /// None.
    Off,
    /// All, as hidden lines: how many faces they are behind is not told.
    Dashed,
    /// Those behind at most so many front faces, as visible lines.
    Depth(u32),
}

/// How hidden lines are found.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Method {
    /// Convex sets when all bodies are convex polyhedra, the count otherwise.
    Auto,
    /// Nishita's count: how many faces are in front, changed where lines cross contours. Edges of bodies that
    /// reach into each other, and strokes, may run through faces, which contours do not tell; they are clipped.
    Count,
    /// Every straight edge is clipped against every face in front of it; curved ones are counted.
    Clip,
}
