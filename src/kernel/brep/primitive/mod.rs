//! The primitive solids, facet for facet what OpenSCAD's `$fn = n` makes.
//!
//! Lengths in millimetres. Sizes are the caller's promise: what is not positive and finite gives the
//! empty solid, fewer than three sides count as three. The number of sides is not bounded here, and facets
//! grow with it (a sphere's and a torus's with its square): whoever asks sets the limit. How many a tolerance
//! needs says [`geom::sides`](crate::geom::sides).

use glam::{DVec3, dvec2};

use super::{
    Polyhedron,
    band::{Ring, add_band, add_cap, add_ring},
};
use crate::geom::{
    Origin, PolyMesh, Surface,
    trig::{cos_deg, sin_deg, unit_circle},
};

/// The least number of sides that encloses anything.
const FEWEST: u32 = 3;

/// The box between two opposite corners.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::kernel::brep::primitive::cuboid;
/// let slab = cuboid(DVec3::ZERO, dvec3(4.0, 3.0, 0.5));
/// assert_eq!((slab.mesh().points.len(), slab.mesh().face_count()), (8, 6));
/// ```
pub fn cuboid(min: DVec3, max: DVec3) -> Polyhedron {
    if !are_sizes(&(max - min).to_array()) {
        return Polyhedron::empty();
    }
    let corner = |i: usize| {
        DVec3::from_array(std::array::from_fn(|k| if i >> k & 1 == 1 { max[k] } else { min[k] }))
    };
    let mut mesh = PolyMesh::with_points((0..8).map(corner).collect());
    let origin = mesh.add_origin(Origin::of(Surface::Plane));
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    for corners in faces {
        let plane = mesh.add_plane();
        mesh.push_face(&[corners], plane, origin);
    }
    Polyhedron::trusted(mesh)
}

/// The cone frustum on z = 0 about the z axis: radius `r1` below and `r2` at height `h`, one of which
/// may be 0; a cylinder when they are equal. An inscribed prism or pyramid with a corner on +x.
///
/// ```
/// use katachi::kernel::brep::primitive::cone;
/// assert_eq!(cone(2.0, 2.0, 1.0, 6).mesh().face_count(), 8);
/// assert_eq!(cone(2.0, 0.0, 1.0, 6).mesh().triangle_count(), 6 + 4);
/// ```
pub fn cone(r1: f64, r2: f64, h: f64, sides: u32) -> Polyhedron {
    let are_radii = r1 >= 0.0 && r2 >= 0.0 && are_sizes(&[r1 + r2, h]);
    if !are_radii {
        return Polyhedron::empty();
    }
    let sides = sides.max(FEWEST);
    let mut mesh = PolyMesh::default();
    let flat = mesh.add_origin(Origin::of(Surface::Plane));
    let side = mesh.add_origin(Origin::of(cone_surface([r1, 0.0], [r2, h])));
    let (lower, upper) = (add_ring(&mut mesh, r1, 0.0, sides), add_ring(&mut mesh, r2, h, sides));
    add_cap(&mut mesh, &lower, false, flat);
    add_band(&mut mesh, &lower, &upper, side);
    add_cap(&mut mesh, &upper, true, flat);
    Polyhedron::trusted(mesh)
}

/// The surface that a segment between two points (radius, height) sweeps about the z axis.
pub(super) fn cone_surface([r1, z1]: [f64; 2], [r2, z2]: [f64; 2]) -> Surface {
    if r1 == r2 {
        return Surface::Cylinder { point: DVec3::ZERO, axis: DVec3::Z, radius: r1 };
    }
    if z1 == z2 {
        return Surface::Plane;
    }
    let growth = (r2 - r1) / (z2 - z1);
    let apex = DVec3::Z * (z1 - r1 / growth);
    Surface::Cone { apex, axis: DVec3::Z * growth.signum(), slope: growth.abs() }
}

/// The ball about the origin: k = (`sides` + 1) / 2 rings of `sides` points at the polar angles
/// (i + 1/2) 180 / k, with flat ends, as OpenSCAD's `sphere($fn = sides)`.
///
/// ```
/// use katachi::kernel::brep::primitive::sphere;
/// assert_eq!(sphere(5.0, 12).mesh().triangle_count(), 2 * 12 * 5 + 2 * 10);
/// ```
pub fn sphere(r: f64, sides: u32) -> Polyhedron {
    if !are_sizes(&[r]) {
        return Polyhedron::empty();
    }
    let sides = sides.max(FEWEST);
    let count = sides.div_ceil(2);
    let mut mesh = PolyMesh::default();
    let round = mesh.add_origin(Origin::of(Surface::Sphere { center: DVec3::ZERO, radius: r }));
    let ring = |i: u32| {
        let polar = (f64::from(i) + 0.5) * 180.0 / f64::from(count);
        add_ring(&mut mesh, r * sin_deg(polar), r * cos_deg(polar), sides)
    };
    let rings: Vec<Ring> = (0..count).map(ring).collect();
    add_cap(&mut mesh, &rings[0], true, round);
    for pair in rings.windows(2) {
        add_band(&mut mesh, &pair[1], &pair[0], round);
    }
    add_cap(&mut mesh, &rings[rings.len() - 1], false, round);
    Polyhedron::trusted(mesh)
}

/// The torus about the z axis at the origin: tube radius `minor` about a circle of radius `major`, which
/// must be larger. A `sides_minor`-gon with a corner outwards at each of `sides_major` places, the first
/// on +x.
///
/// ```
/// use katachi::kernel::brep::primitive::torus;
/// assert_eq!(torus(10.0, 3.0, 16, 8).mesh().face_count(), 16 * 8);
/// ```
pub fn torus(major: f64, minor: f64, sides_major: u32, sides_minor: u32) -> Polyhedron {
    if !are_sizes(&[minor, major - minor]) {
        return Polyhedron::empty();
    }
    let (around, tube) = (sides_major.max(FEWEST), sides_minor.max(FEWEST));
    let mut mesh = PolyMesh::default();
    let surface = Surface::Torus { center: DVec3::ZERO, axis: DVec3::Z, major, minor };
    let origin = mesh.add_origin(Origin::of(surface));
    let ring = |i: u32| {
        let p = dvec2(major, 0.0) + unit_circle(tube, i) * minor;
        add_ring(&mut mesh, p.x, p.y, around)
    };
    let rings: Vec<Ring> = (0..tube).map(ring).collect();
    for (i, ring) in rings.iter().enumerate() {
        add_band(&mut mesh, ring, &rings[(i + 1) % rings.len()], origin);
    }
    Polyhedron::trusted(mesh)
}

fn are_sizes(lengths: &[f64]) -> bool {
    lengths.iter().all(|l| *l > 0.0 && l.is_finite())
}

#[cfg(test)]
mod tests;
