//! Plane figures turned about the z axis.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use thiserror::Error;

use super::{
    Polyhedron,
    band::{Ring, add_point, add_strip},
    flank::{Origins, encloses},
    primitive::cone_surface,
};
use crate::geom::{
    Contour, PolyMesh, Region, Surface, Tolerance,
    region::{Edge, EdgeCurve},
    sides::turned,
    trig::{cos_deg, sin_deg, unit_circle},
};

/// The most facets that turning may make.
pub const MAX_FACETS: usize = 8_000_000;

/// Why there is no turned solid.
#[derive(Clone, Copy, PartialEq, Debug, Error)]
pub enum RevolveError {
    /// No area to turn: no contour, or one with fewer than three finite corners.
    #[error("the profile is empty or broken; turning needs one with area")]
    EmptyProfile,
    /// A corner left of the axis.
    #[error("the profile reaches x = {} mm at [{}, {}]; it must stay at x >= 0", .0.x, .0.x, .0.y)]
    BeyondAxis(DVec2),
    /// An angle that is no turn.
    #[error("the angle is {0} degrees; it must be above 0 and at most 360")]
    Angle(f64),
    /// Fewer than 3 sides.
    #[error("{0} sides; a full turn needs at least 3")]
    Sides(u32),
    /// Finer than any use.
    #[error("turning makes {0} facets; at most {MAX_FACETS} are made")]
    TooManyFacets(usize),
}

/// Turns a region about the z axis by `angle` degrees counter-clockwise from +x: its y becomes z, its x
/// the radius. Less than a full turn has two flat ends.
///
/// `sides` are those of a full turn; of a part of it OpenSCAD's share is made, sides * angle / 360 rounded
/// down, but facets enough that each turns less than half a turn. Without `sides` the facets keep within
/// `tolerance` of the surface the region's edges sweep: half of it where the region has curved edges, whose own chords come on top.
///
/// Fails for an empty region, one that reaches x < 0, and an angle beyond (0, 360].
///
/// ```
/// use glam::DVec2;
/// use katachi::{geom::{Contour, Region, Tolerance, region::Piece}, kernel::brep::revolve::revolve};
/// let cross = [[2., 0.], [3., 0.], [3., 1.], [2., 1.]].map(DVec2::from).to_vec();
/// let region = Region { pieces: vec![Piece { outer: Contour::polygon(cross), holes: vec![] }] };
/// let ring = revolve(&region, 360.0, Some(16), Tolerance::DEFAULT).unwrap();
/// assert_eq!(ring.mesh().points.len(), 64);
/// ```
pub fn revolve(
    region: &Region,
    angle: f64,
    sides: Option<u32>,
    tolerance: Tolerance,
) -> Result<Polyhedron, RevolveError> {
    check(region, angle, sides)?;
    let count = turned(region, angle, sides, tolerance);
    let corners = region.contours().map(|c| c.points.len()).sum::<usize>();
    let facets = corners.saturating_mul(count as usize);
    if facets > MAX_FACETS {
        return Err(RevolveError::TooManyFacets(facets));
    }
    let mut lathe = Lathe {
        mesh: PolyMesh::default(),
        origins: Origins::default(),
        levels: BTreeMap::new(),
        directions: directions(count, angle),
        closed: angle == 360.0,
    };
    let ends = (!lathe.closed).then(|| [lathe.mesh.add_plane(), lathe.mesh.add_plane()]);
    for piece in &region.pieces {
        let contours = std::iter::once(&piece.outer).chain(&piece.holes);
        let loops: Vec<Vec<Corner>> = contours.map(|c| lathe.contour(c)).collect();
        if let Some(planes) = ends {
            lathe.ends(&loops, planes);
        }
    }
    lathe.mesh.drop_unused_points();
    Ok(Polyhedron::trusted(lathe.mesh))
}

fn check(region: &Region, angle: f64, sides: Option<u32>) -> Result<(), RevolveError> {
    if !encloses(region) {
        return Err(RevolveError::EmptyProfile);
    }
    if !(angle > 0.0 && angle <= 360.0) {
        return Err(RevolveError::Angle(angle));
    }
    if let Some(few) = sides.filter(|&n| n < 3) {
        return Err(RevolveError::Sides(few));
    }
    let beyond = region.contours().flat_map(|c| &c.points).filter(|p| p.x < 0.0);
    let farthest = beyond.min_by(|a, b| a.x.total_cmp(&b.x));
    farthest.map_or(Ok(()), |p| Err(RevolveError::BeyondAxis(*p)))
}

/// The directions of the stations about the axis; the last of a full turn is left out.
fn directions(n: u32, angle: f64) -> Vec<DVec2> {
    if angle == 360.0 {
        return (0..n).map(|i| unit_circle(n, i)).collect();
    }
    let turn = |i: u32| angle * f64::from(i) / f64::from(n);
    (0..=n).map(|i| DVec2::new(cos_deg(turn(i)), sin_deg(turn(i)))).collect()
}

/// A corner of the profile: its stations, as the edge before it and the edge after it see them.
struct Corner {
    before: Ring,
    after: Ring,
}

struct Lathe {
    mesh: PolyMesh,
    origins: Origins,
    /// Planes of the level faces by height and by whether they face up.
    levels: BTreeMap<(u64, bool), u32>,
    directions: Vec<DVec2>,
    closed: bool,
}

impl Lathe {
    fn contour(&mut self, contour: &Contour) -> Vec<Corner> {
        let n = contour.points.len();
        let on_axis = |i: usize| contour.points[i % n].x == 0.0;
        let corners: Vec<Corner> = (0..n)
            .map(|i| {
                let apex = on_axis(i) && !on_axis(i + n - 1) && !on_axis(i + 1);
                self.corner(contour.points[i], self.closed && apex)
            })
            .collect();
        for (i, e) in contour.edges().enumerate() {
            self.flank(&e, &corners[i].after, &corners[(i + 1) % n].before);
        }
        corners
    }

    /// The stations of a corner. One on the axis is one point; where a full turn has two cones meet tip to
    /// tip it is two, so that each is a solid's tip of its own.
    fn corner(&mut self, p: DVec2, double: bool) -> Corner {
        if p.x > 0.0 {
            let place = |d: &DVec2| add_point(&mut self.mesh, (*d * p.x).extend(p.y));
            let ring: Ring = self.directions.iter().map(place).collect();
            return Corner { before: ring.clone(), after: ring };
        }
        let before = vec![add_point(&mut self.mesh, DVec3::Z * p.y)];
        let after =
            if double { vec![add_point(&mut self.mesh, DVec3::Z * p.y)] } else { before.clone() };
        Corner { before, after }
    }

    fn flank(&mut self, e: &Edge, from: &[u32], to: &[u32]) {
        if e.from.x == 0.0 && e.to.x == 0.0 {
            return;
        }
        if e.from.y == e.to.y && e.curve == EdgeCurve::Line {
            return self.level(e, from, to);
        }
        let origin = self.origins.of(&mut self.mesh, e.curve, surface(e));
        let count = self.directions.len() - usize::from(!self.closed);
        add_strip(&mut self.mesh, from, to, count, origin);
    }

    /// The one face of a level edge: a disc, an annulus or a part of one.
    fn level(&mut self, e: &Edge, from: &[u32], to: &[u32]) {
        let up = e.to.x < e.from.x;
        let key = ((e.from.y + 0.0).to_bits(), up);
        let plane = *self.levels.entry(key).or_insert_with(|| self.mesh.add_plane());
        let origin = self.origins.flat(&mut self.mesh);
        let back: Vec<u32> = to.iter().rev().copied().collect();
        let loops = match (self.closed, from.len(), to.len()) {
            (false, ..) => vec![[from, &back].concat()],
            (true, 1, _) => vec![back],
            (true, _, 1) => vec![from.to_vec()],
            (true, ..) if up => vec![from.to_vec(), back],
            (true, ..) => vec![back, from.to_vec()],
        };
        self.mesh.push_face(&loops, plane, origin);
    }

    /// The flat ends of a piece at the first and the last station.
    fn ends(&mut self, loops: &[Vec<Corner>], planes: [u32; 2]) {
        let origin = self.origins.flat(&mut self.mesh);
        let first = |corners: &Vec<Corner>| corners.iter().map(|c| c.before[0]).collect();
        let last = |corners: &Vec<Corner>| {
            corners.iter().rev().map(|c| c.before[c.before.len() - 1]).collect()
        };
        let start: Vec<Vec<u32>> = loops.iter().map(first).collect();
        let end: Vec<Vec<u32>> = loops.iter().map(last).collect();
        self.mesh.push_face(&start, planes[0], origin);
        self.mesh.push_face(&end, planes[1], origin);
    }
}

/// What an edge sweeps about the axis.
fn surface(e: &Edge) -> Surface {
    match e.curve {
        EdgeCurve::Line => cone_surface(e.from.to_array(), e.to.to_array()),
        EdgeCurve::Circle { center, radius } if center.x == 0.0 => {
            Surface::Sphere { center: DVec3::Z * center.y, radius }
        }
        EdgeCurve::Circle { center, radius } if center.x > 0.0 => {
            let middle = DVec3::Z * center.y;
            Surface::Torus { center: middle, axis: DVec3::Z, major: center.x, minor: radius }
        }
        _ => Surface::Facets,
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::{geom::region::Piece, kernel::brep::measure};

    fn region(points: &[[f64; 2]]) -> Region {
        let outer = Contour::polygon(points.iter().copied().map(DVec2::from).collect());
        Region { pieces: vec![Piece { outer, holes: vec![] }] }
    }

    fn turn(points: &[[f64; 2]], angle: f64, sides: u32) -> Polyhedron {
        revolve(&region(points), angle, Some(sides), Tolerance::DEFAULT).expect("turned")
    }

    const TUBE: [[f64; 2]; 4] = [[2., 0.], [3., 0.], [3., 4.], [2., 4.]];
    const CONE: [[f64; 2]; 3] = [[0., 0.], [3., 0.], [0., 5.]];

    fn ngon(n: u32) -> f64 {
        f64::from(n) / 2.0 * sin_deg(360.0 / f64::from(n))
    }

    #[track_caller]
    fn assert_near(found: f64, wanted: f64) {
        assert!((found - wanted).abs() < 1e-10, "{found} is not {wanted}");
    }

    #[test]
    fn full_turns() {
        let tube = turn(&TUBE, 360.0, 24);
        assert_near(measure::volume(&tube), 20.0 * ngon(24));
        assert_eq!((measure::euler(&tube), tube.mesh().face_count()), (0, 50));
        let cone = turn(&CONE, 360.0, 7);
        assert_near(measure::volume(&cone), 15.0 * ngon(7));
        assert_eq!((measure::euler(&cone), cone.mesh().face_count()), (2, 8));
        assert_eq!(cone.mesh().points[0], DVec3::X * 3.0);
    }

    #[test]
    fn parts_of_a_turn() {
        // 16 * 100 / 360 = 4.4: four facets of 25 degrees.
        let part = turn(&TUBE, 100.0, 16);
        assert_eq!(part.mesh().points.len(), 20);
        assert_near(measure::volume(&part), 20.0 * 4.0 * sin_deg(25.0) / 2.0);
        // 49 / 100 of a turn is 49 facets of 100, though the share is rounded.
        assert_eq!(turn(&TUBE, 49.0 * 3.6, 100).mesh().points.len(), 4 * 50);
        let wedge = turn(&CONE, 90.0, 4);
        assert_near(measure::volume(&wedge), 7.5);
        assert_eq!(measure::euler(&wedge), 2);
    }

    #[test]
    fn tips_that_meet_on_the_axis() {
        let diamond = [[0., 0.], [2., -2.], [4., 0.], [2., 2.]];
        let full = turn(&diamond, 360.0, 8);
        assert_eq!(measure::shells(&full), 1);
        assert_near(measure::volume(&full), 2.0 * ngon(8) * 2.0 * 8.0);
        assert_eq!(measure::euler(&turn(&diamond, 180.0, 8)), 2);
    }

    #[test]
    fn surfaces_of_round_edges() {
        let center = dvec2(5.0, 1.0);
        let points = (0..12).map(|i| center + unit_circle(12, i)).collect();
        let curves = vec![EdgeCurve::Circle { center, radius: 1.0 }; 12];
        let outer = Contour { points, curves };
        let ring = Region { pieces: vec![Piece { outer, holes: vec![] }] };
        let solid = revolve(&ring, 360.0, None, Tolerance::DEFAULT).expect("turned");
        let torus = Surface::Torus { center: DVec3::Z, axis: DVec3::Z, major: 5.0, minor: 1.0 };
        assert!(solid.mesh().faces().all(|f| f.origin().surface == torus));
        assert_eq!(solid.mesh().origins().len(), 1);
    }

    #[test]
    fn a_tolerance_beyond_use_is_refused_before_anything_is_made() {
        let fault = revolve(&region(&TUBE), 360.0, None, Tolerance::new(1e-30).expect("positive"));
        assert!(matches!(fault, Err(RevolveError::TooManyFacets(n)) if n > MAX_FACETS));
    }

    #[test]
    fn bad_input_is_an_error() {
        let bad = region(&[[-1., 0.], [3., 0.], [0., 5.]]);
        let fault = revolve(&bad, 360.0, None, Tolerance::DEFAULT);
        assert_eq!(fault, Err(RevolveError::BeyondAxis(dvec2(-1.0, 0.0))));
        for angle in [0.0, -10.0, 361.0, f64::NAN] {
            let fault = revolve(&region(&CONE), angle, None, Tolerance::DEFAULT);
            assert!(matches!(fault, Err(RevolveError::Angle(_))));
        }
    }
}
