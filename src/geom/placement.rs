//! Where a shape stands: affine maps of space.

use std::hash::{Hash, Hasher};

use glam::{DMat3, DVec3};

/// An affine map p -> M p + t of space, in millimetres.
///
/// Compared and hashed by the bits of its twelve numbers (negative zero is made positive on the way
/// in), so that equal placements are found by identity.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// The linear part M.
    linear: DMat3,
    /// The translation t.
    translation: DVec3,
}

impl Placement {
    /// The map that leaves everything where it is.
    pub const IDENTITY: Placement = Placement { linear: DMat3::IDENTITY, translation: DVec3::ZERO };

    /// The map p -> `linear` p + `translation`.
    pub fn new(linear: DMat3, translation: DVec3) -> Placement {
        let positive = |v: DVec3| v + DVec3::ZERO;
        let linear = DMat3::from_cols(
            positive(linear.x_axis),
            positive(linear.y_axis),
            positive(linear.z_axis),
        );
        Placement { linear, translation: positive(translation) }
    }

    /// A translation by `v` millimetres.
    pub fn translation(v: DVec3) -> Placement {
        Placement::new(DMat3::IDENTITY, v)
    }

    /// The linear part.
    pub fn linear(&self) -> DMat3 {
        self.linear
    }

    /// The translation, in millimetres.
    pub fn offset(&self) -> DVec3 {
        self.translation
    }

    /// The image of a point.
    #[inline]
    pub fn point(&self, p: DVec3) -> DVec3 {
        if self.linear == DMat3::IDENTITY {
            return p + self.translation;
        }
        self.linear * p + self.translation
    }

    /// The image of a direction.
    pub fn vector(&self, v: DVec3) -> DVec3 {
        self.linear * v
    }

    /// The map that does `inner` first and `self` after it.
    ///
    /// ```
    /// use glam::{DMat3, DVec3};
    /// use katachi::geom::Placement;
    /// let turn = Placement::new(DMat3::from_cols(DVec3::Y, -DVec3::X, DVec3::Z), DVec3::ZERO);
    /// let step = Placement::translation(DVec3::X);
    /// assert_eq!(turn.after(&step).point(DVec3::ZERO), DVec3::Y);
    /// ```
    pub fn after(&self, inner: &Placement) -> Placement {
        Placement::new(self.linear * inner.linear, self.point(inner.translation))
    }

    /// The inverse map; `None` if the map flattens space.
    pub fn inverse(&self) -> Option<Placement> {
        let determinant = self.linear.determinant();
        if determinant == 0.0 || !determinant.is_finite() {
            return None;
        }
        let linear = self.linear.inverse();
        Some(Placement::new(linear, -(linear * self.translation)))
    }

    /// Whether the map turns right-handed frames into left-handed ones.
    pub fn mirrors(&self) -> bool {
        self.linear.determinant() < 0.0
    }

    /// Whether this is the identity.
    pub fn is_identity(&self) -> bool {
        *self == Placement::IDENTITY
    }

    fn bits(&self) -> [u64; 12] {
        let (m, t) = (self.linear.to_cols_array(), self.translation);
        std::array::from_fn(|i| if i < 9 { m[i] } else { t[i - 9] }.to_bits())
    }
}

impl PartialEq for Placement {
    fn eq(&self, other: &Placement) -> bool {
        self.bits() == other.bits()
    }
}

impl Eq for Placement {}

impl Hash for Placement {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.bits().hash(state);
    }
}
