//! Solids grown, shrunk and rounded by distance.

use glam::DVec3;

use super::failure::Coded;
use crate::{
    base::Code,
    convert::offset::{self, OffsetError},
    geom::Tolerance,
    kernel::brep::Polyhedron,
};

impl Coded for OffsetError {
    fn code(&self) -> Code {
        match self {
            OffsetError::NotFinite(_) => Code::Degenerate,
            OffsetError::TooFine { .. } | OffsetError::Crowded { .. } => Code::Limit,
            OffsetError::Boolean(error) => error.code(),
            OffsetError::Inexact { .. } => Code::Snap,
        }
    }

    fn help(&self) -> Option<String> {
        match self {
            OffsetError::TooFine { fitting, .. } => {
                Some(format!("give a tolerance of {fitting:.3e}mm or more"))
            }
            OffsetError::Crowded { .. } | OffsetError::Inexact { .. } => {
                Some("give a larger tolerance, or another radius".to_string())
            }
            _ => None,
        }
    }
}

/// A solid offset by radii along the axes, all positive or all negative.
pub fn offset(
    solid: &Polyhedron,
    radii: DVec3,
    tolerance: Tolerance,
) -> Result<Polyhedron, OffsetError> {
    if radii == DVec3::splat(radii.x) {
        return offset::offset(solid, radii.x, tolerance);
    }
    offset::by_ellipsoid(solid, radii, tolerance)
}
