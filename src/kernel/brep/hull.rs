//! The convex hull of points in space.
//!
//! Source: C. B. Barber, D. P. Dobkin and H. Huhdanpaa, *The Quickhull Algorithm for Convex Hulls*, 1996.
//!
//! # Departures
//! What a facet sees is decided by exact orientation, so there is no tolerance and no merging on the way; a
//! facet that has a point in its plane does not see it, which leaves every facet with area. Facets of one
//! plane are merged at the end.

use glam::DVec3;
use thiserror::Error;

use super::{Polyhedron, closing};
use crate::geom::{
    FaceRef, Origin, PolyMesh, Surface,
    orient::{orient2d, orient3d},
};

/// Why points have no hull with a volume.
#[derive(Clone, Copy, PartialEq, Debug, Error)]
pub enum HullError {
    /// All points lie in one plane, on one line, in one place, or there are none.
    #[error("the hull's {points} points are {shape}; a solid needs four that are not in one plane")]
    Flat {
        /// Number of points given.
        points: usize,
        /// How they lie.
        shape: Flatness,
    },
    /// A coordinate that is NaN or infinite.
    #[error("point {0} of the hull has a coordinate that is not finite")]
    NotFinite(usize),
}

/// How points lie that enclose nothing.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Flatness {
    /// There are none.
    None,
    /// In one place.
    Point,
    /// On one line.
    Line,
    /// In one plane.
    Plane,
}

impl std::fmt::Display for Flatness {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(match self {
            Flatness::None => "none",
            Flatness::Point => "in one place",
            Flatness::Line => "on one line",
            Flatness::Plane => "in one plane",
        })
    }
}

/// The convex hull of points, in mm. Facets of one plane, up to rounding, are one polygon. Fails when the
/// points are flat.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::kernel::brep::hull::hull;
/// let corners: Vec<DVec3> =
///     (0..27).map(|i| dvec3(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9))).collect();
/// let cube = hull(&corners).unwrap();
/// assert_eq!((cube.mesh().points.len(), cube.mesh().face_count()), (8, 6));
/// ```
pub fn hull(points: &[DVec3]) -> Result<Polyhedron, HullError> {
    if let Some(bad) = points.iter().position(|p| !p.is_finite()) {
        return Err(HullError::NotFinite(bad));
    }
    let mut distinct: Vec<DVec3> = points.iter().map(|p| *p + DVec3::ZERO).collect();
    distinct.sort_unstable_by(|a, b| {
        a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z))
    });
    distinct.dedup();
    let simplex =
        simplex(&distinct).map_err(|shape| HullError::Flat { points: points.len(), shape })?;
    let triangles = Hull::new(&distinct, simplex).finish();
    let mesh = closing::merged(distinct, triangles, Origin::of(Surface::Plane));
    Ok(Polyhedron::trusted(without_straight_corners(&mesh)))
}

/// The place of the point for which `measure` is largest.
fn largest(points: &[DVec3], measure: impl Fn(DVec3) -> f64) -> u32 {
    let best = (0..points.len()).max_by(|&i, &j| measure(points[i]).total_cmp(&measure(points[j])));
    best.unwrap_or(0) as u32
}

/// Whether three points are on one line: on one line in all three projections.
fn collinear(a: DVec3, b: DVec3, c: DVec3) -> bool {
    let views: [fn(DVec3) -> glam::DVec2; 3] =
        [|p| glam::dvec2(p.x, p.y), |p| glam::dvec2(p.y, p.z), |p| glam::dvec2(p.z, p.x)];
    views.iter().all(|view| orient2d(view(a), view(b), view(c)) == 0.0)
}

/// Four points far from one plane, as a tetrahedron whose face 0 1 2 is counter-clockwise from outside.
fn simplex(points: &[DVec3]) -> Result<[u32; 4], Flatness> {
    let &first = points.first().ok_or(Flatness::None)?;
    if points.len() == 1 {
        return Err(Flatness::Point);
    }
    let at = |i: u32| points[i as usize];
    let b = largest(points, |p| p.distance_squared(first));
    let spread = |p: DVec3| {
        if collinear(first, at(b), p) { -1.0 } else { (at(b) - first).cross(p - first).length() }
    };
    let c = largest(points, spread);
    if collinear(first, at(b), at(c)) {
        return Err(Flatness::Line);
    }
    let d = largest(points, |p| orient3d(first, at(b), at(c), p).abs());
    match orient3d(first, at(b), at(c), at(d)) {
        0.0 => Err(Flatness::Plane),
        height if height > 0.0 => Ok([0, b, c, d]),
        _ => Ok([0, c, b, d]),
    }
}

/// A triangle of the hull so far.
struct Facet {
    corners: [u32; 3],
    /// The facet across the edge from corner k to the next.
    across: [u32; 3],
    /// Points that see it, the farthest last.
    outside: Vec<u32>,
    alive: bool,
}

struct Hull<'a> {
    points: &'a [DVec3],
    facets: Vec<Facet>,
    /// Facets that may have points outside.
    open: Vec<u32>,
    /// For a corner of the horizon the new facet that starts there.
    starting: Vec<u32>,
    /// For each facet the last point it was asked about, and whether it sees it.
    asked: Vec<(u32, bool)>,
}

const NOBODY: u32 = u32::MAX;

impl<'a> Hull<'a> {
    fn new(points: &'a [DVec3], [a, b, c, d]: [u32; 4]) -> Hull<'a> {
        let starting = vec![0; points.len()];
        let mut hull = Hull { points, facets: vec![], open: vec![], starting, asked: vec![] };
        hull.add([a, b, c], [1, 2, 3]);
        hull.add([b, a, d], [0, 3, 2]);
        hull.add([c, b, d], [0, 1, 3]);
        hull.add([a, c, d], [0, 2, 1]);
        hull.hand_out(0..points.len() as u32, 0);
        hull
    }

    fn add(&mut self, corners: [u32; 3], across: [u32; 3]) {
        self.open.push(self.facets.len() as u32);
        self.facets.push(Facet { corners, across, outside: vec![], alive: true });
        self.asked.push((NOBODY, false));
    }

    /// How far a point is over a facet, times twice the facet's area; the sign is exact.
    fn height(&self, facet: u32, p: u32) -> f64 {
        let [a, b, c] = self.facets[facet as usize].corners.map(|i| self.points[i as usize]);
        -orient3d(a, b, c, self.points[p as usize])
    }

    /// Gives each point to the first of the facets from `first` on that sees it; points that none sees are
    /// inside.
    fn hand_out(&mut self, points: impl Iterator<Item = u32>, first: u32) {
        let last = self.facets.len() as u32;
        let mut farthest = vec![0.0; (last - first) as usize];
        for p in points {
            let seen = (first..last).find_map(|f| {
                let height = self.height(f, p);
                (height > 0.0).then_some((f, height))
            });
            let Some((facet, height)) = seen else { continue };
            let outside = &mut self.facets[facet as usize].outside;
            outside.push(p);
            let record = &mut farthest[(facet - first) as usize];
            if height > *record {
                *record = height;
            } else {
                let end = outside.len() - 1;
                outside.swap(end, end - 1);
            }
        }
    }

    fn finish(mut self) -> Vec<[u32; 3]> {
        while let Some(facet) = self.open.pop() {
            if self.facets[facet as usize].alive
                && let Some(p) = self.facets[facet as usize].outside.pop()
            {
                self.reach(facet, p);
            }
        }
        self.facets.iter().filter(|f| f.alive).map(|f| f.corners).collect()
    }

    fn sees(&mut self, facet: u32, p: u32) -> bool {
        if self.asked[facet as usize].0 != p {
            self.asked[facet as usize] = (p, self.height(facet, p) > 0.0);
        }
        self.asked[facet as usize].1
    }

    /// Grows the hull to a point that sees a facet: what it sees goes, a cone to the horizon comes.
    fn reach(&mut self, facet: u32, p: u32) {
        let (gone, horizon) = self.horizon(facet, p);
        let first = self.facets.len() as u32;
        for (i, &(a, ..)) in horizon.iter().enumerate() {
            self.starting[a as usize] = first + i as u32;
        }
        let mut ending = vec![0; horizon.len()];
        for (i, &(_, b, _)) in horizon.iter().enumerate() {
            ending[(self.starting[b as usize] - first) as usize] = first + i as u32;
        }
        for (&(a, b, beyond), &before) in horizon.iter().zip(&ending) {
            let new = self.facets.len() as u32;
            self.add([a, b, p], [beyond, self.starting[b as usize], before]);
            let neighbour = &mut self.facets[beyond as usize];
            let side = (0..3).find(|&k| neighbour.corners[k] == b).unwrap_or(0);
            neighbour.across[side] = new;
        }
        let mut freed = vec![];
        for g in gone {
            let old = &mut self.facets[g as usize];
            old.alive = false;
            freed.append(&mut std::mem::take(&mut old.outside));
        }
        self.hand_out(freed.into_iter(), first);
    }

    /// The facets a point sees, and the edges around them: start, end, and the facet beyond.
    fn horizon(&mut self, facet: u32, p: u32) -> (Vec<u32>, Vec<(u32, u32, u32)>) {
        let mut gone = vec![facet];
        let mut horizon = vec![];
        self.asked[facet as usize] = (p, true);
        let mut next = 0;
        while next < gone.len() {
            let Facet { corners, across, .. } = self.facets[gone[next] as usize];
            next += 1;
            for k in 0..3 {
                let fresh = self.asked[across[k] as usize].0 != p;
                if !self.sees(across[k], p) {
                    horizon.push((corners[k], corners[(k + 1) % 3], across[k]));
                } else if fresh {
                    gone.push(across[k]);
                }
            }
        }
        (gone, horizon)
    }
}

/// Leaves out corners where only two faces meet: they lie on a straight edge. All stay if a face, nearly a
/// line itself, would be left with two.
fn without_straight_corners(mesh: &PolyMesh) -> PolyMesh {
    let mut faces_at = vec![0u32; mesh.points.len()];
    mesh.faces().flat_map(|f| f.outer()).for_each(|&c| faces_at[c as usize] += 1);
    let kept = |face: FaceRef| -> Vec<u32> {
        face.outer().iter().copied().filter(|&c| faces_at[c as usize] > 2).collect()
    };
    if mesh.faces().any(|f| kept(f).len() < 3) {
        return mesh.clone();
    }
    let mut result = PolyMesh::with_points(mesh.points.clone());
    mesh.origins().iter().for_each(|o| {
        result.add_origin(o.clone());
    });
    for face in mesh.faces() {
        let plane = result.add_plane();
        result.push_face(&[kept(face)], plane, face.origin_index());
    }
    result.drop_unused_points();
    result
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;
    use crate::{
        geom::Placement,
        kernel::brep::{
            measure,
            primitive::{cuboid, sphere},
        },
    };

    fn random(n: u32) -> Vec<DVec3> {
        let mut state = 17u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        (0..n).map(|_| dvec3(next(), next(), next())).collect()
    }

    #[track_caller]
    fn assert_holds(solid: &Polyhedron, points: &[DVec3]) {
        assert_eq!(measure::euler(solid), 2);
        for face in solid.mesh().faces() {
            let normal = face.area_vector().normalize();
            let base = solid.mesh().points[face.outer()[0] as usize];
            for p in points {
                assert!((*p - base).dot(normal) < 1e-12);
            }
        }
    }

    #[test]
    fn everything_is_inside() {
        for n in [4, 5, 10, 100, 1000] {
            let points = random(n);
            assert_holds(&hull(&points).expect("a hull"), &points);
        }
        let round: Vec<DVec3> = random(500).iter().map(|p| p.normalize()).collect();
        let ball = hull(&round).expect("a hull");
        assert_holds(&ball, &round);
        assert_eq!(ball.mesh().points.len(), 500);
    }

    #[test]
    fn grids_have_flat_faces_and_no_spare_corners() {
        let grid: Vec<DVec3> = (0..1000)
            .map(|i| dvec3(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100)) * 0.1)
            .collect();
        let cube = hull(&grid).expect("a hull");
        assert_eq!((cube.mesh().points.len(), cube.mesh().face_count()), (8, 6));
        let turn = glam::DMat3::from_quat(glam::DQuat::from_xyzw(0.1, 0.7, -0.3, 0.6).normalize());
        let moved = cuboid(DVec3::ZERO, DVec3::ONE).placed(&Placement::new(turn, DVec3::ONE));
        let again = hull(&moved.mesh().points).expect("a hull");
        assert_eq!(again.mesh().face_count(), 6);
    }

    #[test]
    fn convex_solids_are_their_own_hulls() {
        let ball = sphere(7.0, 24);
        let twice: Vec<DVec3> =
            ball.mesh().points.iter().chain(&ball.mesh().points).copied().collect();
        let again = hull(&twice).expect("a hull");
        assert!((measure::volume(&again) - measure::volume(&ball)).abs() < 1e-9);
        assert_eq!(again.mesh().face_count(), ball.mesh().face_count());
    }

    #[test]
    fn flat_points_are_an_error() {
        let shape = |points: &[DVec3]| match hull(points) {
            Err(HullError::Flat { shape, .. }) => shape,
            other => panic!("{other:?}"),
        };
        assert_eq!(shape(&[]), Flatness::None);
        assert_eq!(shape(&[DVec3::ONE; 5]), Flatness::Point);
        assert_eq!(shape(&[DVec3::ZERO, DVec3::ONE, DVec3::ONE * 3.0]), Flatness::Line);
        let plane: Vec<DVec3> = random(50).iter().map(|p| p.with_z(p.x)).collect();
        assert_eq!(shape(&plane), Flatness::Plane);
        assert_eq!(hull(&[DVec3::NAN]), Err(HullError::NotFinite(0)));
    }
}
