//! Numbers that are not known yet: what a formula computes of a point that runs through space.

use crate::eval::dimension::Dimension;

/// A step of a formula that is being taken down.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Traced {
    /// Its number.
    pub step: u32,
    /// The dimension of a number; none for a truth value.
    pub dimension: Option<Dimension>,
}

impl Traced {
    /// The kind in plain words with an article.
    pub(super) fn words(self) -> String {
        match self.dimension {
            Some(dimension) => {
                format!("{} that depends on the point of a field", dimension.words())
            }
            None => "a condition on the point of a field".into(),
        }
    }
}
