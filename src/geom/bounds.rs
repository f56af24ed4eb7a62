//! Boxes along the axes.

use glam::DVec3;

/// A closed box along the axes, millimetres. The empty box has its minimum above its maximum.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The box that holds nothing; joining it changes nothing.
    pub const EMPTY: Bounds = Bounds { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around some points.
    ///
    /// ```
    /// use glam::DVec3;
    /// use katachi::geom::Bounds;
    /// assert_eq!(Bounds::of([DVec3::X, DVec3::Y]).max, DVec3::new(1.0, 1.0, 0.0));
    /// ```
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Bounds {
        let grow = |b: Bounds, p: DVec3| Bounds { min: b.min.min(p), max: b.max.max(p) };
        points.into_iter().fold(Bounds::EMPTY, grow)
    }

    /// The smallest box around both.
    pub fn joined(&self, other: &Bounds) -> Bounds {
        Bounds { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether the boxes have a point in common.
    pub fn meets(&self, other: &Bounds) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Whether a point is in the box.
    pub fn contains(&self, p: DVec3) -> bool {
        self.min.cmple(p).all() && p.cmple(self.max).all()
    }

    /// Whether it is the empty box.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The box with `margin` mm more on every side.
    pub fn grown(&self, margin: f64) -> Bounds {
        Bounds { min: self.min - margin, max: self.max + margin }
    }

    /// Square of the distance to another box; infinite for an empty one.
    pub fn distance_squared(&self, other: &Bounds) -> f64 {
        let gap = (self.min - other.max).max(other.min - self.max).max(DVec3::ZERO);
        gap.length_squared()
    }

    /// The middle.
    pub fn center(&self) -> DVec3 {
        self.min + (self.max - self.min) / 2.0
    }
}
