//! Plane figures drawn upwards into solids, with twist and taper.

use glam::{DMat2, DVec2, DVec3};
use thiserror::Error;

use super::{
    Polyhedron,
    band::add_point,
    flank::{Origins, encloses, lines},
    primitive::cone_surface,
    ridge::roof,
};
use crate::geom::{
    Contour, PolyMesh, Region, Surface, Tolerance,
    region::{Edge, EdgeCurve, Piece},
    sides,
    trig::{cos_deg, sin_deg},
};

/// The most slices a twist is cut into.
pub const MAX_SLICES: u32 = 20_000;

/// The most facets that a twist is cut into, unless the profile alone has more corners.
pub const MAX_FACETS: u32 = 4_000_000;

/// Why there is no extrusion.
#[derive(Clone, Copy, PartialEq, Debug, Error)]
pub enum ExtrudeError {
    /// No area to draw up: no contour, or one with fewer than three finite corners.
    #[error("the profile is empty or broken; an extrusion needs one with area")]
    EmptyProfile,
    /// Height not positive.
    #[error("the height is {0} mm; it must be positive")]
    Height(f64),
    /// A scale below 0, or not finite.
    #[error("the scale is [{}, {}]; both factors must be 0 or more", .0.x, .0.y)]
    Scale(DVec2),
    /// A twist that would end in a line.
    #[error("the scale is [{}, {}] with a twist; a twisted top must keep its area or shrink to a point", .0.x, .0.y)]
    Ridge(DVec2),
    /// A twist that is not finite.
    #[error("the twist is {0} degrees; it must be finite")]
    Twist(f64),
    /// A profile too fine to be drawn to a ridge.
    #[error(
        "the ridge cuts the profile's edges into more than two million parts; use fewer corners"
    )]
    TooManyParts,
    /// Finer than any use.
    #[error("the twist needs {0} slices at this tolerance; at most {1} are made of this profile")]
    TooManySlices(f64, u32),
}

/// Draws a region from z = 0 up to `height` mm. On the way it turns by `twist` degrees about the z axis,
/// counter-clockwise seen from above (OpenSCAD's `twist` turns the other way), and each coordinate is
/// scaled linearly from 1 to `scale`; a scale of 0 in both gives an apex, in one a ridge
/// (without twist only).
///
/// Circles that turn about a point outside their centre keep their corners' directions and so slide along their edges: the
/// facets of such a thread run upwards, not around it.
///
/// Slices and the split of twisted facets keep within `tolerance` of the surface that the region's edges
/// sweep. Fails for an empty region and for sizes as [`ExtrudeError`] says.
///
/// ```
/// use glam::{DVec2, dvec2};
/// use katachi::{geom::{Contour, Region, Tolerance, region::Piece}, kernel::brep::extrude::extrude};
/// let square = [[0., 0.], [2., 0.], [2., 2.], [0., 2.]].map(DVec2::from).to_vec();
/// let piece = Piece { outer: Contour::polygon(square), holes: vec![] };
/// let region = Region { pieces: vec![piece] };
/// let block = extrude(&region, 5.0, 0.0, dvec2(1.0, 1.0), Tolerance::DEFAULT).unwrap();
/// assert_eq!(block.mesh().face_count(), 6);
/// ```
pub fn extrude(
    region: &Region,
    height: f64,
    twist: f64,
    scale: DVec2,
    tolerance: Tolerance,
) -> Result<Polyhedron, ExtrudeError> {
    let rise = Rise { height, twist, scale };
    rise.check(region)?;
    if rise.has_ridge() {
        return roof(region, height, scale, tolerance).ok_or(ExtrudeError::TooManyParts);
    }
    let slices = rise.slices(region, tolerance)?;
    let mut drawing =
        Drawing { mesh: PolyMesh::default(), origins: Origins::default(), planes: vec![], rise };
    let line_of = lines(region);
    let count = line_of.iter().max().map_or(0, |&most| most + 1);
    drawing.planes = (0..count).map(|_| drawing.mesh.add_plane()).collect();
    let ends = [drawing.mesh.add_plane(), drawing.mesh.add_plane()];
    let mut line_of = line_of.as_slice();
    for piece in &region.pieces {
        drawing.piece(piece, &mut line_of, slices, ends);
    }
    Ok(Polyhedron::trusted(drawing.mesh))
}

/// How the region changes on its way up.
#[derive(Clone, Copy)]
struct Rise {
    height: f64,
    twist: f64,
    scale: DVec2,
}

impl Rise {
    fn check(&self, region: &Region) -> Result<(), ExtrudeError> {
        let Rise { height, twist, scale } = *self;
        if !encloses(region) {
            return Err(ExtrudeError::EmptyProfile);
        }
        if !(height > 0.0 && height.is_finite()) {
            return Err(ExtrudeError::Height(height));
        }
        if !(scale.min_element() >= 0.0 && scale.is_finite()) {
            return Err(ExtrudeError::Scale(scale));
        }
        if self.has_ridge() && twist != 0.0 {
            return Err(ExtrudeError::Ridge(scale));
        }
        if !twist.is_finite() {
            return Err(ExtrudeError::Twist(twist));
        }
        Ok(())
    }

    /// Whether the top shrinks to a line.
    fn has_ridge(&self) -> bool {
        self.scale.min_element() == 0.0 && self.scale != DVec2::ZERO
    }

    /// Whether the flank of an edge is flat.
    fn keeps_flat(&self, e: &Edge) -> bool {
        let along_axis = e.from.x == e.to.x || e.from.y == e.to.y;
        self.twist == 0.0 && (self.scale.x == self.scale.y || along_axis)
    }

    /// Slices for which no facet is off by more than the tolerance.
    fn slices(&self, region: &Region, tolerance: Tolerance) -> Result<u32, ExtrudeError> {
        let slices = if region.contours().all(|c| self.pivot(c) != DVec2::ZERO) {
            self.slices_of_circles(region, tolerance)
        } else {
            sides::slices(region, self.twist, self.scale, tolerance)
        };
        let corners = region.contours().map(|c| c.points.len()).sum::<usize>();
        let most = MAX_SLICES.min(MAX_FACETS / corners as u32).max(1);
        if slices > f64::from(most) {
            return Err(ExtrudeError::TooManySlices(slices, most));
        }
        Ok(slices as u32)
    }

    /// Slices of circles that slide: their flanks are flat across, and the centre farthest out runs along a helix.
    fn slices_of_circles(&self, region: &Region, tolerance: Tolerance) -> f64 {
        let far = region.contours().map(|c| self.pivot(c).length()).fold(0.0, f64::max);
        let angle = self.twist.abs().to_radians();
        let helix = far * self.scale.x.max(1.0) * angle * angle / 8.0;
        (helix / tolerance.mm()).sqrt().ceil().max(1.0)
    }

    /// The point of a contour that turns about the axis, while the rest is moved by it: the centre of a circle beside the
    /// axis, 0 for all that turns.
    fn pivot(&self, contour: &Contour) -> DVec2 {
        let slides = self.twist != 0.0 && self.scale.x == self.scale.y;
        contour.circle().filter(|_| slides).map_or(DVec2::ZERO, |circle| circle.0)
    }

    /// The place of a corner of a contour with a pivot at the share t of the height.
    fn at(&self, p: DVec2, pivot: DVec2, t: f64) -> DVec3 {
        let scale = 1.0 + (self.scale - 1.0) * t;
        let turn = |p: DVec2| {
            let (s, c) = (sin_deg(self.twist * t), cos_deg(self.twist * t));
            DMat2::from_cols_array(&[c, s, -s, c]) * p
        };
        let turned = if self.twist == 0.0 {
            p * scale
        } else if pivot == DVec2::ZERO {
            turn(p * scale)
        } else {
            turn(pivot * scale) + (p - pivot) * scale
        };
        turned.extend(self.height * t)
    }

    /// What an edge sweeps.
    fn surface(&self, e: &Edge) -> Surface {
        match e.curve {
            EdgeCurve::Line if self.keeps_flat(e) => Surface::Plane,
            EdgeCurve::Circle { center, radius } if self.scale.x == self.scale.y => {
                self.round(center, radius)
            }
            _ => Surface::Facets,
        }
    }

    /// What a circle sweeps when it is scaled evenly.
    fn round(&self, center: DVec2, radius: f64) -> Surface {
        let factor = self.scale.x;
        if center == DVec2::ZERO {
            return cone_surface([radius, 0.0], [radius * factor, self.height]);
        }
        if self.twist == 0.0 && factor == 1.0 {
            return Surface::Cylinder { point: center.extend(0.0), axis: DVec3::Z, radius };
        }
        Surface::Smooth
    }
}

struct Drawing {
    mesh: PolyMesh,
    origins: Origins,
    /// The plane of the flat flanks over each line.
    planes: Vec<u32>,
    rise: Rise,
}

impl Drawing {
    fn piece(&mut self, piece: &Piece, line_of: &mut &[u32], slices: u32, ends: [u32; 2]) {
        let (mut floor, mut roof) = (vec![], vec![]);
        for contour in std::iter::once(&piece.outer).chain(&piece.holes) {
            let (numbers, rest) = line_of.split_at(contour.points.len());
            *line_of = rest;
            let rings = self.rings(contour, slices);
            self.flanks(contour, numbers, &rings);
            floor.push(rings[0].iter().rev().copied().collect::<Vec<u32>>());
            roof.extend(rings.last().cloned());
        }
        let flat = self.origins.flat(&mut self.mesh);
        self.mesh.push_face(&floor, ends[0], flat);
        if self.rise.scale != DVec2::ZERO {
            self.mesh.push_face(&roof, ends[1], flat);
        }
    }

    /// The corners of a contour at every slice; an apex is one point.
    fn rings(&mut self, contour: &Contour, slices: u32) -> Vec<Vec<u32>> {
        let pivot = self.rise.pivot(contour);
        let ring = |i: u32| {
            let t = f64::from(i) / f64::from(slices);
            let apex = i == slices && self.rise.scale == DVec2::ZERO;
            let corners = if apex { &contour.points[..1] } else { &contour.points[..] };
            corners.iter().map(|p| add_point(&mut self.mesh, self.rise.at(*p, pivot, t))).collect()
        };
        (0..=slices).map(ring).collect()
    }

    fn flanks(&mut self, contour: &Contour, lines: &[u32], rings: &[Vec<u32>]) {
        for (i, e) in contour.edges().enumerate() {
            let origin = self.origins.of(&mut self.mesh, e.curve, self.rise.surface(&e));
            let flat = self.rise.keeps_flat(&e).then(|| self.planes[lines[i] as usize]);
            let next = (i + 1) % contour.points.len();
            for pair in rings.windows(2) {
                let below = [pair[0][i], pair[0][next]];
                match pair[1][..] {
                    [apex] => self.triangle([below[0], below[1], apex], flat, origin),
                    _ => self.facet(below, [pair[1][i], pair[1][next]], flat, origin),
                }
            }
        }
    }

    fn triangle(&mut self, corners: [u32; 3], plane: Option<u32>, origin: u32) {
        let plane = plane.unwrap_or_else(|| self.mesh.add_plane());
        self.mesh.push_face(&[corners], plane, origin);
    }

    /// The facet between an edge and its image one slice up: one quadrilateral where it is flat, else
    /// split along the shorter diagonal.
    fn facet(&mut self, [a, b]: [u32; 2], [d, c]: [u32; 2], flat: Option<u32>, origin: u32) {
        if let Some(plane) = flat {
            return self.mesh.push_face(&[[a, b, c, d]], plane, origin);
        }
        let point = |i: u32| self.mesh.points[i as usize];
        let along_ac = point(a).distance_squared(point(c)) <= point(b).distance_squared(point(d));
        let pair = if along_ac { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        pair.into_iter().for_each(|corners| self.triangle(corners, None, origin));
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::{geom::trig::unit_circle, kernel::brep::measure};

    fn square(from: f64, to: f64) -> Contour {
        let corners = [[from, from], [to, from], [to, to], [from, to]];
        Contour::polygon(corners.map(DVec2::from).to_vec())
    }

    fn reversed(mut contour: Contour) -> Contour {
        contour.points.reverse();
        contour
    }

    fn frame() -> Region {
        let piece = Piece { outer: square(-5., 5.), holes: vec![reversed(square(-3., 3.))] };
        Region { pieces: vec![piece] }
    }

    fn circle(center: DVec2, radius: f64, n: u32) -> Region {
        let points = (0..n).map(|i| center + unit_circle(n, i) * radius).collect();
        let outer =
            Contour { points, curves: vec![EdgeCurve::Circle { center, radius }; n as usize] };
        Region { pieces: vec![Piece { outer, holes: vec![] }] }
    }

    fn draw(region: &Region, twist: f64, scale: f64) -> Polyhedron {
        extrude(region, 6.0, twist, DVec2::splat(scale), Tolerance::DEFAULT).expect("drawn")
    }

    #[test]
    fn volumes_have_closed_forms() {
        assert_eq!(measure::volume(&draw(&frame(), 0.0, 1.0)), 64.0 * 6.0);
        let frustum = measure::volume(&draw(&frame(), 0.0, 0.5));
        assert!((frustum - 64.0 * 2.0 * 1.75).abs() < 1e-10);
        assert!((measure::volume(&draw(&frame(), 0.0, 0.0)) - 128.0).abs() < 1e-10);
        let twisted = measure::volume(&draw(&frame(), 90.0, 1.0));
        assert!((twisted - 384.0).abs() < 0.01 * 384.0);
        assert_eq!(measure::euler(&draw(&frame(), 90.0, 1.0)), 0);
    }

    #[test]
    fn twist_is_right_handed() {
        let bar = circle(dvec2(4.0, 0.0), 1.0, 12);
        let [min, max] = measure::bounds(&draw(&bar, 90.0, 1.0)).expect("not empty");
        assert!(max.y > 4.9 && min.y > -1.2 && max.x > 4.9);
        let top = draw(&bar, 90.0, 1.0).mesh().points.last().copied().expect("a point");
        assert!(top.y > 3.0 && top.z == 6.0);
    }

    #[test]
    fn uneven_scale() {
        let block = Region { pieces: vec![Piece { outer: square(0., 4.), holes: vec![] }] };
        let solid = extrude(&block, 3.0, 0.0, dvec2(0.5, 2.0), Tolerance::DEFAULT).expect("drawn");
        assert_eq!(solid.mesh().face_count(), 6);
        // The integral of 16 (1 - t / 2) (1 + t) over the height.
        assert!((measure::volume(&solid) - 16.0 * 3.0 * (1.0 + 0.25 - 1.0 / 6.0)).abs() < 1e-10);
    }

    #[test]
    fn faces_know_their_surfaces() {
        let has = |solid: &Polyhedron, wanted: &dyn Fn(&Surface) -> bool| {
            solid.mesh().faces().filter(|f| wanted(&f.origin().surface)).count()
        };
        let post = draw(&circle(dvec2(4.0, 0.0), 1.0, 12), 0.0, 1.0);
        assert_eq!(has(&post, &|s| matches!(s, Surface::Cylinder { .. })), 12);
        assert_eq!(post.mesh().origins().len(), 2);
        let cone = draw(&circle(DVec2::ZERO, 1.0, 12), 0.0, 0.0);
        assert_eq!(has(&cone, &|s| matches!(s, Surface::Cone { .. })), 12);
        assert_eq!(has(&draw(&frame(), 20.0, 1.0), &|s| *s == Surface::Plane), 2);
    }

    #[test]
    fn bad_sizes_are_errors() {
        let try_it = |h, twist, scale| extrude(&frame(), h, twist, scale, Tolerance::DEFAULT).err();
        assert_eq!(try_it(0.0, 0.0, DVec2::ONE), Some(ExtrudeError::Height(0.0)));
        assert!(matches!(try_it(1.0, f64::NAN, DVec2::ONE), Some(ExtrudeError::Twist(_))));
        assert!(matches!(try_it(1.0, 0.0, dvec2(-1.0, 1.0)), Some(ExtrudeError::Scale(_))));
        assert!(matches!(try_it(1.0, 1e9, DVec2::ONE), Some(ExtrudeError::TooManySlices(..))));
        let none = extrude(&Region::default(), 1.0, 0.0, DVec2::ONE, Tolerance::DEFAULT);
        assert_eq!(none, Err(ExtrudeError::EmptyProfile));
    }
}
