//! Solids from surfaces given by points in rows: a sheet with a thickness, and what lies between a surface and a floor.
//!
//! Offset points go along the mean of the normals of the triangles around a point, weighted by their angles there, so
//! that the thickness does not depend on how cells are cut; creases are mitred.

use glam::{DVec2, DVec3};
use rustc_hash::{FxHashMap, FxHashSet};
use thiserror::Error;

use super::{
    Defect, Polyhedron,
    boolean::{BooleanError, untangled},
    closing,
    crossing::is_hollow,
};
use crate::geom::{CurvedGrid, Origin, PolyMesh, Surface};

/// Why a surface makes no solid.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum SheetError {
    /// A surface that turns over on the way round, or touches itself.
    #[error("the surface cannot be closed: {0}")]
    Defect(#[from] Defect),
    /// It bends more sharply than the sheet is thick.
    #[error(
        "the surface bends too sharply at ({}, {}, {}) for a sheet {t} mm thick; it needs a radius above {} mm there", .at.x, .at.y, .at.z, t / 2.0
    )]
    Bend {
        /// Where.
        at: DVec3,
        /// The thickness.
        t: f64,
    },
    /// A point of the surface is not on one side of the floor with all others.
    #[error(
        "the surface reaches from z = {low} mm to {high} mm; the floor at z = {base} mm must lie below it or above it"
    )]
    Floor {
        /// Its lowest z.
        low: f64,
        /// Its highest z.
        high: f64,
        /// The floor.
        base: f64,
    },
    /// An open surface without a floor whose rim lies in no plane.
    #[error("the surface is open, and its rim at ({}, {}, {}) lies in no plane that could close it", .at.x, .at.y, .at.z)]
    Rim {
        /// A point of the rim.
        at: DVec3,
    },
    /// A surface whose points lie in a plane or on a line.
    #[error("the surface encloses nothing")]
    Flat,
    /// It crosses itself, and what it encloses was not found.
    #[error("the surface crosses itself: {0}")]
    Crossing(#[from] BooleanError),
}

/// A rim lies in a plane when no point of it is farther off than this part of the surface's size.
const FLAT_RIM: f64 = 1e-9;

/// A sheet about a surface, half of its thickness t (mm, above 0) to each side. Where sheets of one surface meet they are
/// united. Fails where the surface bends more sharply than the sheet is thick, and where it has one side only.
///
/// ```
/// use glam::dvec3;
/// use katachi::{geom::CurvedGrid, kernel::brep::{measure::volume, sheet::thickened}};
/// let row = |y: f64| vec![dvec3(0.0, y, 1.0), dvec3(3.0, y, 1.0)];
/// let flat = CurvedGrid::new(&[row(0.0), row(2.0)], false, false).unwrap();
/// assert_eq!(volume(&thickened(&flat, 0.5).unwrap()), 3.0);
/// ```
pub fn thickened(surface: &CurvedGrid, t: f64) -> Result<Polyhedron, SheetError> {
    let triangles = triangles(surface);
    let points = surface.points();
    let rim = rim(points, &triangles)?;
    let normals = normals(points, &triangles);
    let count = points.len() as u32;
    let side = |sign: f64| points.iter().zip(&normals).map(move |(p, n)| *p + *n * (sign * t));
    let mut soup = Soup::new(side(0.5).chain(side(-0.5)).collect());
    for &corners in &triangles {
        let [over, under] = [0, count].map(|first| corners.map(|c| c + first));
        for half in [over, under] {
            let turned = area(&soup.mesh.points, half).dot(area(points, corners)) <= 0.0;
            if turned {
                return Err(SheetError::Bend { at: points[corners[0] as usize], t });
            }
        }
        soup.push(over);
        soup.push([under[2], under[1], under[0]]);
    }
    for [a, b] in rim {
        soup.push([b, a, a + count]);
        soup.push([b, a + count, b + count]);
    }
    soup.closed()
}

/// What lies between a surface and a floor at a height (mm), or without a floor what the surface encloses, each rim of
/// it closed by a plane. Fails where the surface is not on one side of the floor, or a rim lies in no plane.
///
/// ```
/// use glam::dvec3;
/// use katachi::{geom::CurvedGrid, kernel::brep::{measure::volume, sheet::filled}};
/// let row = |y: f64| vec![dvec3(0.0, y, 1.0), dvec3(3.0, y, 2.0)];
/// let ramp = CurvedGrid::new(&[row(0.0), row(2.0)], false, false).unwrap();
/// assert_eq!(volume(&filled(&ramp, Some(0.0)).unwrap()), 9.0);
/// ```
pub fn filled(surface: &CurvedGrid, base: Option<f64>) -> Result<Polyhedron, SheetError> {
    let triangles = triangles(surface);
    let loops = loops(&rim(surface.points(), &triangles)?);
    let mut soup = Soup::new(surface.points().to_vec());
    triangles.iter().for_each(|&corners| soup.push(corners));
    match base {
        Some(base) => soup.add_floor(&loops, base)?,
        None => soup.add_caps(&loops)?,
    }
    soup.closed()
}

/// The triangles of a surface with three different corners.
fn triangles(surface: &CurvedGrid) -> Vec<[u32; 3]> {
    let [cu, cv] = surface.cells();
    let cells = (0..cu).flat_map(|u| (0..cv).map(move |v| (u, v)));
    let halves = cells.flat_map(|(u, v)| surface.halves(u, v).0);
    halves.filter(|[a, b, c]| a != b && b != c && c != a).collect()
}

fn area(points: &[DVec3], [a, b, c]: [u32; 3]) -> DVec3 {
    let [a, b, c] = [a, b, c].map(|i| points[i as usize]);
    (b - a).cross(c - a)
}

/// A crease is mitred up to so many times the distance.
const MITRE: f64 = 2.0;

/// Where each point goes at distance 1: along the mean normal, at a crease so far that its two sides keep the distance.
fn normals(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
    let mut sums = vec![(DVec3::ZERO, 0.0); points.len()];
    for &corners in triangles {
        let normal = area(points, corners).normalize_or_zero();
        for k in 0..3 {
            let [p, q, r] = [0, 1, 2].map(|i| points[corners[(k + i) % 3] as usize]);
            let (u, v) = (q - p, r - p);
            let angle = libm::atan2(u.cross(v).length(), u.dot(v));
            let (sum, angles) = &mut sums[corners[k] as usize];
            *sum += normal * angle;
            *angles += angle;
        }
    }
    let offset = |(sum, angles): (DVec3, f64)| {
        // The length of the sum is the mean cosine between its direction and the normals.
        sum.normalize_or_zero() * (angles / sum.length()).clamp(1.0, MITRE)
    };
    sums.into_iter().map(offset).collect()
}

/// The directed edges that have a triangle on their left and none on their right, in the order of the triangles. Fails
/// where two triangles have an edge on their left.
fn rim(points: &[DVec3], triangles: &[[u32; 3]]) -> Result<Vec<[u32; 2]>, Defect> {
    let sides = || triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut known: FxHashSet<[u32; 2]> = FxHashSet::default();
    if let Some([a, b]) = sides().find(|side| !known.insert(*side)) {
        let [a, b] = [a, b].map(|i| points[i as usize]);
        return Err(Defect::OneSided { at: (a + b) / 2.0 });
    }
    Ok(sides().filter(|[a, b]| !known.contains(&[*b, *a])).collect())
}

/// Rims as loops of points.
fn loops(rim: &[[u32; 2]]) -> Vec<Vec<u32>> {
    let next: FxHashMap<u32, u32> = rim.iter().map(|&[a, b]| (a, b)).collect();
    let mut used = FxHashSet::default();
    let mut loops = vec![];
    for &[first, _] in rim {
        let mut around = vec![];
        let mut at = first;
        while used.insert(at) {
            around.push(at);
            at = next.get(&at).copied().unwrap_or(first);
        }
        if around.len() >= 3 {
            loops.push(around);
        }
    }
    loops
}

/// A boundary while it is put together.
struct Soup {
    mesh: PolyMesh,
    facets: u32,
    flat: u32,
}

impl Soup {
    fn new(points: Vec<DVec3>) -> Soup {
        let mut mesh = PolyMesh::with_points(points);
        let [facets, flat] =
            [Surface::Facets, Surface::Plane].map(|s| mesh.add_origin(Origin::of(s)));
        Soup { mesh, facets, flat }
    }

    fn push(&mut self, corners: [u32; 3]) {
        let plane = self.mesh.add_plane();
        self.mesh.push_face(&[corners], plane, self.facets);
    }

    /// Walls from the rim down to a floor, and the floor.
    fn add_floor(&mut self, loops: &[Vec<u32>], base: f64) -> Result<(), SheetError> {
        let heights = || self.mesh.points.iter().map(|p| p.z);
        let (low, high) = (heights().fold(f64::MAX, f64::min), heights().fold(f64::MIN, f64::max));
        if (low..=high).contains(&base) {
            return Err(SheetError::Floor { low, high, base });
        }
        let mut floor = vec![];
        for around in loops {
            let first = self.mesh.points.len() as u32;
            let below = |&i: &u32| self.mesh.points[i as usize].with_z(base);
            let added: Vec<DVec3> = around.iter().map(below).collect();
            self.mesh.points.extend(added);
            let count = around.len() as u32;
            for i in 0..count {
                let j = (i + 1) % count;
                let (a, b) = (around[i as usize], around[j as usize]);
                self.push([b, a, first + i]);
                self.push([b, first + i, first + j]);
            }
            floor.push((first..first + count).rev().collect::<Vec<u32>>());
        }
        self.add_flat(floor);
        Ok(())
    }

    /// A plane on each rim.
    fn add_caps(&mut self, loops: &[Vec<u32>]) -> Result<(), SheetError> {
        let size = self.mesh.points.iter().fold(0.0, |s: f64, p| s.max(p.abs().max_element()));
        for around in loops {
            let points: Vec<DVec3> = around.iter().map(|&i| self.mesh.points[i as usize]).collect();
            let pairs = points.iter().zip(points.iter().cycle().skip(1));
            let sum: DVec3 = pairs.map(|(p, q)| (*p - points[0]).cross(*q - points[0])).sum();
            let normal = sum.normalize_or_zero();
            let flat = |p: &DVec3| normal.dot(*p - points[0]).abs() <= FLAT_RIM * size;
            if normal == DVec3::ZERO || !points.iter().all(flat) {
                return Err(SheetError::Rim { at: points[0] });
            }
            self.add_flat(vec![around.iter().rev().copied().collect()]);
        }
        Ok(())
    }

    /// A flat face: the largest loop is its outline, the others are holes.
    fn add_flat(&mut self, mut loops: Vec<Vec<u32>>) {
        let points = &self.mesh.points;
        let flat = |i: &u32| -> DVec2 { points[*i as usize].truncate() };
        let size = |around: &Vec<u32>| {
            let pairs = around.iter().zip(around.iter().cycle().skip(1));
            pairs.map(|(i, j)| flat(i).perp_dot(flat(j))).sum::<f64>().abs()
        };
        loops.sort_by(|a, b| size(b).total_cmp(&size(a)));
        if !loops.is_empty() {
            let plane = self.mesh.add_plane();
            self.mesh.push_face(&loops, plane, self.flat);
        }
    }

    /// The solid: what the boundary winds around where it crosses itself.
    fn closed(self) -> Result<Polyhedron, SheetError> {
        let mut mesh = self.mesh;
        mesh.drop_unused_points();
        let solid = untangled(closing::close(&mesh)?)?;
        if is_hollow(&solid) { Err(SheetError::Flat) } else { Ok(solid) }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use glam::dvec3;

    use super::*;
    use crate::kernel::brep::crossing::crossing;
    use crate::kernel::brep::measure::{genus, volume};

    fn grid(nu: usize, nv: usize, closed: [bool; 2], at: impl Fn(f64, f64) -> DVec3) -> CurvedGrid {
        let [cu, cv] = [(nu, closed[0]), (nv, closed[1])]
            .map(|(n, closed)| if closed { n } else { n - 1 } as f64);
        let row = |u: usize| (0..nv).map(|v| at(u as f64 / cu, v as f64 / cv)).collect();
        let rows: Vec<Vec<DVec3>> = (0..nu).map(row).collect();
        CurvedGrid::new(&rows, closed[0], closed[1]).expect("a grid")
    }

    fn tube(u: f64, v: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(u * TAU);
        dvec3(10.0 * cos, 10.0 * sin, 20.0 * v)
    }

    #[test]
    fn a_tube_is_thickened_to_both_sides_and_filled_between_its_rims() {
        let tube = grid(120, 2, [true, false], tube);
        let wall = thickened(&tube, 2.0).expect("a sheet");
        assert!((volume(&wall) / (PI * (121.0 - 81.0) * 20.0) - 1.0).abs() < 1e-3);
        assert_eq!(genus(&wall), 1);
        let rod = filled(&tube, None).expect("a rod");
        assert!((volume(&rod) / (PI * 100.0 * 20.0) - 1.0).abs() < 1e-3);
        assert_eq!(genus(&rod), 0);
        let sharp = thickened(&tube, 21.0).expect_err("too thick");
        assert!(matches!(sharp, SheetError::Bend { .. }), "{sharp}");
    }

    #[test]
    fn a_hill_stands_on_its_floor_or_hangs_from_it() {
        let hill = grid(21, 31, [false; 2], |u, v| {
            dvec3(10.0 * u, 20.0 * v, libm::sin(PI * u) * libm::sin(PI * v))
        });
        let over = filled(&hill, Some(-1.0)).expect("a hill");
        let under = filled(&hill, Some(2.0)).expect("a mould");
        assert!((volume(&over) + volume(&under) - 3.0 * 200.0).abs() < 1e-9);
        assert!((volume(&over) - 200.0 * (1.0 + 4.0 / (PI * PI))).abs() < 0.5);
        let within = filled(&hill, Some(0.5)).expect_err("the floor cuts the hill");
        assert!(matches!(within, SheetError::Floor { .. }), "{within}");
    }

    #[test]
    fn surfaces_that_enclose_nothing_or_have_one_side_are_refused() {
        let flat = grid(3, 3, [false; 2], |u, v| dvec3(u, v, 0.0));
        assert_eq!(filled(&flat, None), Err(SheetError::Flat));
        let saddle = grid(5, 5, [false; 2], |u, v| dvec3(u, v, u * v));
        assert!(matches!(filled(&saddle, None), Err(SheetError::Rim { .. })));
        let moebius = grid(41, 2, [false; 2], |u, v| {
            // At the end of the way the corners are those of its start, exchanged.
            let (u, v) = if u == 1.0 { (0.0, 1.0 - v) } else { (u, v) };
            let ((s, c), (sin, cos)) = (libm::sincos(PI * u), libm::sincos(TAU * u));
            let r = 20.0 + (v - 0.5) * 8.0 * c;
            dvec3(r * cos, r * sin, (v - 0.5) * 8.0 * s)
        });
        assert!(thickened(&moebius, 1.0).is_err());
    }

    #[test]
    fn sheets_that_run_through_each_other_are_united() {
        // A ribbon that crosses its own beginning.
        let ribbon = grid(60, 2, [false; 2], |u, v| {
            let (sin, cos) = libm::sincos(u * 1.5 * PI);
            dvec3(20.0 * sin, 14.0 * sin * cos, 10.0 * v)
        });
        let solid = thickened(&ribbon, 1.0).expect("a solid");
        assert_eq!(crossing(solid.mesh()), Ok(None));
        assert!(volume(&solid) > 100.0);
    }
}
