//! Solids from fields: the surface where a function is zero, closed, manifold and free of crossings.

use glam::DVec3;
use thiserror::Error;

use crate::{
    geom::{Bounds, Charge, Formula, Origin, Surface, Tolerance},
    kernel::{
        brep::{
            Defect, Polyhedron,
            boolean::{self, BooleanError},
            crossing::crossings,
            faces,
        },
        field::{
            Metaball, Zeros,
            contour::{Contour, ContourError, Level},
        },
    },
};

/// Why a function bounds no solid.
#[derive(Clone, Debug, Error)]
pub enum LevelSetError {
    /// The function has no surface, or none within limits.
    #[error(transparent)]
    Contour(#[from] ContourError),
    /// The function is positive everywhere.
    #[error("the field is above 0 in all of its box; a solid is where it is at most 0")]
    NoZero,
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
/// Empty if the function is positive everywhere. Its faces have some of the `origins`: `origin` tells which at a
/// place of the surface.
///
/// ```
/// use glam::DVec3;
/// use katachi::{convert::contour::level_set, geom::{Bounds, Origin, Surface, Tolerance}};
/// use katachi::kernel::{brep::{measure::volume, primitive::cuboid}, field::{Apart, Polyhedral}};
/// let cube = Polyhedral::new(cuboid(DVec3::ZERO, DVec3::splat(4.0)).mesh()).unwrap();
/// let within = Bounds { min: DVec3::splat(-2.0), max: DVec3::splat(6.0) };
/// let fine = Tolerance::new(0.01).unwrap();
/// let round = [Origin::of(Surface::Facets)];
/// let grown = level_set(Apart::new(&cube, 1.0), &within, fine, &round, |_| 0).unwrap();
/// let area = 96.0 + 24.0 * 3.1416 + 4.0 * 3.1416;
/// let true_volume = 64.0 + 96.0 + 12.0 * 3.1416 + 4.0 * 3.1416 / 3.0;
/// assert!((volume(&grown) - true_volume).abs() < area * fine.mm());
/// ```
pub fn level_set<L: Level>(
    level: L,
    within: &Bounds,
    tolerance: Tolerance,
    origins: &[Origin],
    origin: impl Fn(DVec3) -> u32 + Sync,
) -> Result<Polyhedron, LevelSetError> {
    let mut contour = Contour::new(level, within, tolerance.mm())?;
    for _ in 0..ROUNDS {
        if contour.is_empty() {
            return Ok(Polyhedron::empty());
        }
        let crossed = crossings(&contour.mesh());
        if crossed.is_empty() {
            break;
        }
        contour.part(&crossed)?;
    }
    let mut kept = vec![];
    for _ in 0..TRIES {
        let mesh = contour.collapsed(&kept, origins, &origin);
        let crossed = crossings(&mesh);
        if crossed.is_empty() {
            return Ok(faces::from_import(&mesh)?);
        }
        kept.extend(crossed);
    }
    let surface = Polyhedron::new(contour.collapsed(&kept, origins, origin))?;
    Ok(boolean::self_union(&surface)?.solid)
}

/// How often a surface is made of fewer triangles, each time with more places kept where it crossed itself.
const TRIES: usize = 4;

/// The solid that charges bound at a threshold above 0, mm; empty where they do not reach it.
///
/// ```
/// use glam::DVec3;
/// use katachi::{convert::contour::metaball, geom::{Charge, Falloff, Tolerance}};
/// use katachi::kernel::brep::measure::volume;
/// let one = Charge { at: DVec3::ZERO, q: 1.0, falloff: Falloff::Inverse };
/// let ball = metaball(&[one], 0.1, Tolerance::DEFAULT).unwrap();
/// assert!((volume(&ball) / (4.0 / 3.0 * 3.14159 * 1000.0) - 1.0).abs() < 0.01);
/// ```
pub fn metaball(
    charges: &[Charge],
    threshold: f64,
    tolerance: Tolerance,
) -> Result<Polyhedron, LevelSetError> {
    let ball = Metaball::new(charges.to_vec(), threshold);
    let Some(within) = ball.extent() else { return Ok(Polyhedron::empty()) };
    level_set(Zeros::new(ball), &within, tolerance, &[Origin::of(Surface::Smooth)], |_| 0)
}

/// The solid where a formula is at most 0, sought in a box. Fails where it is above 0 in all of the box, where
/// the solid reaches the faces of the box, and where the formula has no value.
pub fn formula(
    formula: &Formula,
    within: &Bounds,
    tolerance: Tolerance,
) -> Result<Polyhedron, LevelSetError> {
    let zeros = Zeros::new(formula.clone());
    let found = level_set(zeros, within, tolerance, &[Origin::of(Surface::Facets)], |_| 0)?;
    if found.is_empty() { Err(LevelSetError::NoZero) } else { Ok(found) }
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;
    use crate::convert::offset::deviation;
    use crate::geom::Falloff;
    use crate::kernel::{
        brep::{
            measure::{bounds, genus, shells, volume},
            primitive::{cuboid, torus},
        },
        field::{Apart, Field, Polyhedral},
    };

    fn grown(solid: &Polyhedron, by: f64, tolerance: f64) -> Polyhedron {
        let field = Polyhedral::new(solid.mesh()).expect("full");
        let extent = field.extent().grown(by.max(0.0) + 1.0);
        let fine = Tolerance::new(tolerance).expect("positive");
        let round = [Origin::of(Surface::Facets)];
        let found =
            level_set(Apart::new(&field, by), &extent, fine, &round, |_| 0).expect("a solid");
        let off = deviation(found.mesh(), &field, by).expect("full");
        assert!(off.most <= tolerance, "off by {} at {}", off.most, off.at);
        found
    }

    #[test]
    fn a_box_grows_and_shrinks() {
        let block = cuboid(DVec3::ZERO, dvec3(10.0, 20.0, 30.0));
        let round = grown(&block, 2.0, 0.02);
        // The tolerance times a third of the area: flat triangles of round parts lie inside.
        assert!((volume(&round) - 11187.492558).abs() < 20.0, "{}", volume(&round));
        let sharp = grown(&block, -2.0, 0.02);
        assert!((volume(&sharp) - 2496.0).abs() < 1e-4, "{}", volume(&sharp));
    }

    fn charge(x: f64, q: f64) -> Charge {
        Charge { at: dvec3(x, 0.0, 0.0), q, falloff: Falloff::Inverse }
    }

    #[test]
    fn charges_merge_below_the_threshold_between_them() {
        use std::f64::consts::PI;
        let fine = Tolerance::new(0.005).expect("positive");
        for threshold in [0.1, 0.5, 2.0] {
            let ball = metaball(&[charge(0.0, 1.0)], threshold, fine).expect("a ball");
            let expected = 4.0 / 3.0 * PI / (threshold * threshold * threshold);
            let slack = 1e-3 * expected + 4.0 * PI / (threshold * threshold) * 0.005;
            assert!((volume(&ball) - expected).abs() < slack);
        }
        let two = [charge(-2.0, 1.0), charge(2.0, 1.0)];
        let pieces = |threshold: f64| {
            let found = metaball(&two, threshold, fine).expect("a solid");
            shells(&found)
        };
        assert_eq!([pieces(0.98), pieces(1.02)], [1, 2]);
        let pushed = [charge(-2.0, 1.0), charge(2.0, -1.0)];
        let half = metaball(&pushed, 0.05, fine).expect("a solid");
        assert!(bounds(&half).expect("full")[1].x < 0.0);
    }

    #[test]
    fn a_torus_closes() {
        let ring = torus(10.0, 4.0, 48, 32);
        assert_eq!(genus(&grown(&ring, 3.0, 0.02)), 1);
        assert_eq!(genus(&grown(&ring, 7.0, 0.02)), 0);
    }
}
