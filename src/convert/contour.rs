//! Solids from fields: the surface where a function is zero, closed, manifold and free of crossings.

use thiserror::Error;

use crate::{
    geom::{Bounds, Origin, Tolerance},
    kernel::{
        brep::{
            Defect, Polyhedron,
            boolean::{self, BooleanError},
            crossing::crossings,
            faces,
        },
        field::contour::{Contour, ContourError, Level},
    },
};

/// Why a function bounds no solid.
#[derive(Clone, Debug, Error)]
pub enum LevelSetError {
    /// The function has no surface, or none within limits.
    #[error(transparent)]
    Contour(#[from] ContourError),
    /// The triangles are not closed.
    #[error(transparent)]
    Defect(#[from] Defect),
    /// The set operation that frees the surface of its last crossings failed.
    #[error(transparent)]
    Boolean(#[from] BooleanError),
}

/// How often triangles that cross are parted before a set operation does it.
const ROUNDS: usize = 12;

/// The solid in which a function is not positive, within a box on whose faces it is positive. Its surface is
/// within the tolerance of the function's zeros; walls and gaps thicker than twice the tolerance are kept.
/// Empty if the function is positive everywhere.
///
/// ```
/// use glam::DVec3;
/// use katachi::{convert::contour::level_set, geom::{Bounds, Origin, Surface, Tolerance}};
/// use katachi::kernel::{brep::{measure::volume, primitive::cuboid}, field::{Apart, Polyhedral}};
/// let cube = Polyhedral::new(cuboid(DVec3::ZERO, DVec3::splat(4.0)).mesh()).unwrap();
/// let within = Bounds { min: DVec3::splat(-2.0), max: DVec3::splat(6.0) };
/// let fine = Tolerance::new(0.01).unwrap();
/// let round = Origin::of(Surface::Facets);
/// let grown = level_set(Apart::new(&cube, 1.0), &within, fine, round).unwrap();
/// assert!((volume(&grown) - (64.0 + 96.0 + 12.0 * 3.1416 + 4.0 * 3.1416 / 3.0)).abs() < 0.5);
/// ```
pub fn level_set<L: Level>(
    level: L,
    within: &Bounds,
    tolerance: Tolerance,
    origin: Origin,
) -> Result<Polyhedron, LevelSetError> {
    let mut contour = Contour::new(level, within, tolerance.mm())?;
    for _ in 0..ROUNDS {
        if contour.is_empty() {
            return Ok(Polyhedron::empty());
        }
        let mesh = contour.mesh(origin.clone());
        let crossed = crossings(&mesh);
        if crossed.is_empty() {
            return Ok(faces::from_import(&mesh)?);
        }
        contour.part(&crossed)?;
    }
    let surface = Polyhedron::new(contour.mesh(origin))?;
    Ok(boolean::self_union(&surface)?.solid)
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, dvec3};

    use super::*;
    use crate::{
        geom::Surface,
        kernel::{
            brep::{
                measure::{genus, triangles, volume},
                primitive::{cuboid, torus},
            },
            field::{Apart, Polyhedral},
        },
    };

    fn grown(solid: &Polyhedron, by: f64, tolerance: f64) -> Polyhedron {
        let field = Polyhedral::new(solid.mesh()).expect("full");
        let extent = crate::kernel::field::Field::extent(&field).grown(by.max(0.0) + 1.0);
        let tolerance = Tolerance::new(tolerance).expect("positive");
        let start = std::time::Instant::now();
        let found = level_set(Apart::new(&field, by), &extent, tolerance, Origin::of(Surface::Facets))
            .expect("a solid");
        eprintln!(
            "by {by}: {} triangles, volume {}, {:?}, deviation {:?}",
            triangles(&found),
            volume(&found),
            start.elapsed(),
            crate::convert::offset::deviation(found.mesh(), &field, by),
        );
        found
    }

    #[test]
    fn a_box_grows_and_shrinks() {
        let block = cuboid(DVec3::ZERO, dvec3(10.0, 20.0, 30.0));
        let round = grown(&block, 2.0, 0.015);
        assert!((volume(&round) - 11187.492558).abs() < 12.0);
        let sharp = grown(&block, -2.0, 0.015);
        assert!((volume(&sharp) - 2496.0).abs() < 1e-6);
    }

    #[test]
    fn a_torus_closes() {
        let ring = torus(10.0, 4.0, 48, 32);
        assert_eq!(genus(&grown(&ring, 3.0, 0.02)), 1);
        assert_eq!(genus(&grown(&ring, 7.0, 0.02)), 0);
    }
}
