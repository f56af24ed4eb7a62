//! Distances between points, curves, solids and boundaries, over a hierarchy of the boundary's triangles.

mod boundary;
mod curve;
mod farthest;

use glam::DVec3;

pub use self::{boundary::Boundary, curve::curve};

use self::farthest::{Between, farthest};
use super::Polyhedron;

/// Relative accuracy of [`hausdorff`] and of depths: upper and lower bound differ by less, unless the search
/// ends at its limit of pieces.
pub const ACCURACY: f64 = 1e-3;

/// Distance in mm from a point to the boundary of a solid, negative inside; `None` for the empty solid.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::kernel::brep::{distance::point, primitive::cuboid};
/// let cube = cuboid(DVec3::ZERO, DVec3::splat(2.0));
/// assert_eq!(point(&cube, dvec3(5.0, 6.0, 1.0)), Some(5.0));
/// assert_eq!(point(&cube, dvec3(0.5, 1.0, 1.0)), Some(-0.5));
/// ```
pub fn point(solid: &Polyhedron, p: DVec3) -> Option<f64> {
    (!solid.is_empty()).then(|| -Boundary::new(solid).depth(p))
}

/// Distance in mm between two solids, the exact minimum over their triangles; `None` if one is empty.
///
/// Negative where a part of the boundary of one lies inside the other: then it is the depth, within
/// [`ACCURACY`], of the deepest point of that part. So it is 0 when they touch, and when they are the same
/// solid: a solid moved out of itself is as deep in itself as it has moved, so that the distance changes
/// steadily. Pieces in common whose boundaries are the same do not count for the same reason.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::kernel::brep::{distance::solids, primitive::cuboid};
/// let block = |x: f64| cuboid(dvec3(x, 0., 0.), dvec3(x + 4., 3., 2.));
/// assert_eq!(solids(&block(0.0), &block(6.5)), Some(2.5));
/// assert_eq!(solids(&block(0.0), &block(4.0)), Some(0.0));
/// assert!((solids(&block(0.0), &block(3.5)).unwrap() + 0.5).abs() < 1e-3);
/// ```
pub fn solids(a: &Polyhedron, b: &Polyhedron) -> Option<f64> {
    if a.is_empty() || b.is_empty() {
        return None;
    }
    let (a, b) = (Boundary::new(a), Boundary::new(b));
    let apart = a.distance(&b);
    if apart > 0.0 && !b.contains(a.some_point()) && !a.contains(b.some_point()) {
        return Some(apart);
    }
    let depth = |of: &Boundary, within: &Boundary| {
        farthest(of, within, |p, d| within.signed(p, d)).least.max(0.0)
    };
    Some(0.0 - depth(&a, &b).max(depth(&b, &a)))
}

/// The Hausdorff distance of two boundaries.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Hausdorff {
    /// mm; attained at some point.
    pub least: f64,
    /// mm; no point is farther.
    pub most: f64,
}

/// Hausdorff distance of the boundaries of two solids: the largest distance from a point of either to the
/// nearest point of the other. `None` if one is empty.
///
/// The two bounds close in on each other by branch and bound until they differ by less than [`ACCURACY`],
/// relative, or 1e-9 of the size of the solids; a limit on the pieces looked at can leave them farther apart.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::kernel::brep::{distance::hausdorff, primitive::cuboid};
/// let (a, b) = (DVec3::splat(2.0), dvec3(2.0, 2.0, 2.25));
/// let found = hausdorff(&cuboid(DVec3::ZERO, a), &cuboid(DVec3::ZERO, b)).unwrap();
/// assert_eq!(found.least, 0.25);
/// assert!(found.most < 0.251);
/// ```
pub fn hausdorff(a: &Polyhedron, b: &Polyhedron) -> Option<Hausdorff> {
    if a.is_empty() || b.is_empty() {
        return None;
    }
    let (a, b) = (Boundary::new(a), Boundary::new(b));
    let one_way = |from: &Boundary, to: &Boundary| farthest(from, to, |_, d| d);
    let Between { least, most } = one_way(&a, &b).max(one_way(&b, &a));
    Some(Hausdorff { least, most })
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;
    use crate::{
        geom::Placement,
        kernel::brep::{
            faces,
            primitive::{cone, cuboid, sphere, torus},
        },
    };

    fn moved(solid: &Polyhedron, by: DVec3) -> Polyhedron {
        solid.placed(&Placement::translation(by))
    }

    #[test]
    fn points_have_signed_distances() {
        let ring = torus(10.0, 3.0, 64, 64);
        assert!((point(&ring, DVec3::ZERO).expect("not empty") - 7.0).abs() < 0.02);
        assert!((point(&ring, dvec3(10.0, 0.0, 0.0)).expect("not empty") + 3.0).abs() < 0.02);
        let cube = cuboid(-DVec3::ONE, DVec3::ONE);
        assert_eq!(point(&cube, dvec3(4.0, 5.0, 0.0)), Some(5.0));
        assert_eq!(point(&cube, dvec3(1.0, 0.3, 0.3)), Some(0.0));
        assert_eq!(point(&cube, DVec3::ZERO), Some(-1.0));
        assert_eq!(point(&Polyhedron::empty(), DVec3::ZERO), None);
    }

    #[test]
    fn solids_apart() {
        let ball = sphere(2.0, 48);
        let far = solids(&ball, &moved(&ball, dvec3(10.0, 0.0, 0.0))).expect("not empty");
        assert!((far - 6.0).abs() < 0.02 && far >= 6.0);
        // Edge to edge: two roofs across each other.
        let spike = cone(1.0, 0.0, 1.0, 4);
        let gap = solids(&spike, &moved(&spike, dvec3(0.0, 0.0, 1.5))).expect("not empty");
        assert_eq!(gap, 0.5);
    }

    #[test]
    fn solids_that_overlap_or_nest() {
        let outer = cuboid(DVec3::splat(-5.0), DVec3::splat(5.0));
        let inner = cuboid(DVec3::splat(-1.0), DVec3::splat(1.0));
        assert_eq!(solids(&outer, &inner), Some(-4.0));
        assert_eq!(solids(&outer, &outer), Some(0.0));
        let cross = cuboid(dvec3(-9.0, -1.0, -1.0), dvec3(9.0, 1.0, 1.0));
        let other = cuboid(dvec3(-2.0, -9.0, -2.0), dvec3(2.0, 9.0, 2.0));
        assert!(solids(&cross, &other).expect("not empty") < -0.9);
    }

    #[test]
    fn the_distance_from_itself_is_the_end_of_small_moves() {
        for solid in [cuboid(DVec3::ZERO, dvec3(4., 3., 2.)), torus(5.0, 2.0, 24, 16)] {
            assert_eq!(solids(&solid, &solid), Some(0.0));
            for step in [0.5, 0.1, 0.01] {
                let depth = -solids(&solid, &moved(&solid, dvec3(0., 0., step))).expect("full");
                assert!(depth > 0.9 * step && depth < 1.001 * step, "{step}: {depth}");
            }
        }
        // The same block in both, and one of them has another one.
        let block = cuboid(DVec3::ZERO, DVec3::splat(2.0));
        let mut two = block.mesh().clone();
        two.append(moved(&block, dvec3(9.0, 0.0, 0.0)).mesh());
        assert_eq!(solids(&block, &Polyhedron::new(two).expect("closed")), Some(0.0));
    }

    #[test]
    fn hausdorff_of_like_solids() {
        let ball = sphere(3.0, 32);
        assert_eq!(hausdorff(&ball, &ball).map(|h| h.least), Some(0.0));
        let shifted = hausdorff(&ball, &moved(&ball, dvec3(0.5, 0.0, 0.0))).expect("not empty");
        assert!(shifted.least > 0.49 && shifted.most < 0.501, "{shifted:?}");
        let slab = cuboid(DVec3::ZERO, dvec3(30.0, 20.0, 1.0));
        let wall = cuboid(dvec3(0.0, 0.0, 0.0), dvec3(30.0, 20.0, 4.0));
        let found = hausdorff(&slab, &wall).expect("not empty");
        assert!(found.least == 3.0 && found.most < 3.004, "{found:?}");
    }

    #[test]
    fn triangulation_does_not_count() {
        // The same cube with an extra corner in the middle of each face.
        let cube = cuboid(DVec3::ZERO, DVec3::splat(3.0)).into_mesh();
        let mut points = cube.points.clone();
        let mut triangles = vec![];
        for (i, face) in cube.faces().enumerate() {
            let middle = points.len() as u32;
            let sum: DVec3 = face.outer().iter().map(|&c| cube.points[c as usize]).sum();
            points.push(sum / 4.0 + DVec3::splat(0.0) * i as f64);
            let corners = face.outer();
            triangles.extend((0..4).map(|k| [corners[k], corners[(k + 1) % 4], middle]));
        }
        let fanned = faces::polyhedron(&points, &triangles).expect("closed");
        let plain = cuboid(DVec3::ZERO, DVec3::splat(3.0));
        let found = hausdorff(&fanned, &plain).expect("not empty");
        assert!(found.most < 1e-8);
        let ball = sphere(3.0, 24);
        let cut = hausdorff(&ball, &sphere(3.0, 48)).expect("not empty");
        assert!(cut.most - cut.least <= 1.01e-3 * cut.most, "{cut:?}");
    }
}
