//! Solids grown, shrunk and rounded by distance.

use glam::DVec3;

use super::failure::Coded;
use crate::{
    base::Code,
    convert::{
        contour::LevelSetError,
        offset::{self, OffsetError},
    },
    geom::Tolerance,
    kernel::{
        brep::Polyhedron,
        field::{Test, contour::ContourError},
    },
    shape::SphereTest,
};

impl Coded for OffsetError {
    fn code(&self) -> Code {
        match self {
            OffsetError::NotFinite(_) => Code::Degenerate,
            OffsetError::TooFine { .. } | OffsetError::Crowded { .. } => Code::Limit,
            OffsetError::Boolean(error) => error.code(),
            OffsetError::LevelSet(error) => error.code(),
            OffsetError::Inexact { .. } => Code::Snap,
        }
    }

    fn help(&self) -> Option<String> {
        match self {
            OffsetError::TooFine { fitting, .. } => {
                Some(format!("give a tolerance of {fitting:.3e}mm or more"))
            }
            OffsetError::LevelSet(error) => error.help(),
            OffsetError::Crowded { .. } | OffsetError::Inexact { .. } => {
                Some("give a larger tolerance, or another radius".to_string())
            }
            _ => None,
        }
    }
}

impl Coded for LevelSetError {
    fn code(&self) -> Code {
        match self {
            LevelSetError::Contour(ContourError::TooFine { .. }) => Code::Limit,
            LevelSetError::Contour(ContourError::NotANumber { .. }) => Code::Arithmetic,
            LevelSetError::Contour(ContourError::Unbounded { .. }) => Code::OutOfRange,
            LevelSetError::Contour(ContourError::Crossed { .. }) => Code::Snap,
            LevelSetError::NoZero => Code::Degenerate,
            LevelSetError::Defect(_) => Code::OpenMesh,
            LevelSetError::Boolean(error) => error.code(),
        }
    }

    fn help(&self) -> Option<String> {
        match self {
            LevelSetError::Contour(ContourError::TooFine { fitting, .. }) => {
                Some(format!("give a tolerance of {fitting:.3e}mm or more"))
            }
            LevelSetError::Contour(ContourError::Unbounded { .. }) => Some(
                "give a larger box, or cut the field: `max(f, g)` is inside of both".to_string(),
            ),
            LevelSetError::NoZero => {
                Some("inside is where the formula is 0 or less; `-f` turns it over".to_string())
            }
            _ => None,
        }
    }
}

/// A solid offset by radii along the axes, all positive or all negative. Ellipsoids are tested exactly.
pub fn offset(
    solid: &Polyhedron,
    radii: DVec3,
    by: SphereTest,
    tolerance: Tolerance,
) -> Result<Polyhedron, OffsetError> {
    if radii == DVec3::splat(radii.x) {
        let test = match by {
            SphereTest::Exact => Test::Exact,
            SphereTest::Quadtree => Test::Quadtree,
            SphereTest::MonteCarlo { n, seed } => Test::MonteCarlo { n, seed },
        };
        return offset::tested(solid, radii.x, test, tolerance);
    }
    offset::by_ellipsoid(solid, radii, tolerance)
}
