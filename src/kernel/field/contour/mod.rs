//! The surface on which a function is zero, as triangles within a tolerance.
//!
//! Ju, T., Losasso, F., Schaefer, S., Warren, J.: *Dual contouring of hermite data*, 2002; Schaefer, S., Ju, T.,
//! Warren, J.: *Manifold dual contouring*, 2007; Ju, T., Udeshi, T.: *Intersection-free contouring on an octree
//! grid*, 2006.
//!
//! | papers | here | meaning |
//! |---|---|---|
//! | grid | [`octree`] | cells, halved where the surface is not told apart |
//! | hermite data | `Sample` | a crossed edge's point and normal |
//! | minimal edge | [`edges`] | an edge between four leaves |
//! | vertex cluster | [`loops`] | a piece of the surface in a leaf |
//! | QEF | [`vertex`] | the vertex where tangent planes meet |
//! | hybrid polygon | [`surface`] | triangles around a crossed edge |
//! | edge collapse | [`collapse`] | fewer triangles within the tolerance |
//!
//! # Departures
//! The papers refine by flatness of their data. Here a cell is halved as long as bounds cannot tell that it is
//! clear of the surface or that the surface passes it as one sheet ([`Look`]), and afterwards where a corner,
//! the middle of an edge or of a triangle is farther from the surface than the tolerance. What is thicker than
//! twice the tolerance holds a corner of the smallest cells, and so is found.
//!
//! Polygons are made through vertices alone, and cut at edges and faces only where [`Contour::part`] is told
//! that triangles cross.

mod collapse;
mod edges;
mod lattice;
mod loops;
mod octree;
mod surface;
mod vertex;

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};
use thiserror::Error;

use self::{
    collapse::Collapse,
    octree::Octree,
    surface::{Made, Surface},
};
use super::half_diagonal;
use crate::geom::{self, Bounds, Origin, PolyMesh};

/// What the surface does in a cell.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Look {
    /// It stays away.
    Clear,
    /// It may pass as one sheet: along some direction the function grows everywhere.
    Sheet,
    /// Anything.
    Unknown,
}

/// A function of space whose zeros are a surface, not positive inside.
pub trait Level: Clone + Send + Sync {
    /// Its value; NaN where it has none.
    fn value(&self, p: DVec3) -> f64;

    /// Its derivatives.
    fn gradient(&self, p: DVec3) -> DVec3;

    /// About how far a point near the surface is from it, mm, never negative.
    fn off(&self, p: DVec3) -> f64 {
        let (value, slope) = (self.value(p).abs(), self.gradient(p).length());
        if value == 0.0 { 0.0 } else { value / slope }
    }

    /// What is sure about a cell.
    fn look(&self, cell: &Bounds) -> Look;

    /// A function that gives the same answers for the points of a cell, sooner.
    fn within(&self, cell: &Bounds) -> Self;
}

/// Why a function has no surface.
#[derive(Clone, Debug, Error)]
pub enum ContourError {
    /// The value is not a number.
    #[error("the function has no value at ({}, {}, {}) mm", .at.x, .at.y, .at.z)]
    NotANumber {
        /// Where, mm.
        at: DVec3,
    },
    /// The inside reaches the faces of the box.
    #[error("the solid reaches beyond the box it is sought in, at ({}, {}, {}) mm", .at.x, .at.y, .at.z)]
    Unbounded {
        /// Where, mm.
        at: DVec3,
    },
    /// Too many pieces.
    #[error(
        "a surface this fine needs about {found:.2e} pieces; the limit is {limit}, which a tolerance of {fitting:.3e} mm meets"
    )]
    TooFine {
        /// Triangles or cells needed, about.
        found: f64,
        /// Those allowed.
        limit: usize,
        /// A tolerance that fits, mm.
        fitting: f64,
    },
    /// Triangles that cannot be parted.
    #[error("the surface crosses itself near ({}, {}, {}) mm however finely it is cut", .at.x, .at.y, .at.z)]
    Crossed {
        /// Where, mm.
        at: DVec3,
    },
}

impl ContourError {
    fn too_fine(found: f64, tolerance: f64, fitting: f64) -> ContourError {
        let fitting = fitting.max(tolerance * 1.1);
        ContourError::TooFine { found, limit: octree::CELLS, fitting }
    }
}

/// Triangles that a surface may have.
pub const MOST_TRIANGLES: usize = 3_000_000;
/// Of so many triangles the deviations tell how many there will be.
const TELLING: usize = 40_000;
/// How often triangles are looked at and cells halved.
const ROUNDS: usize = 40;

/// A surface being made.
#[derive(Debug)]
pub struct Contour<L> {
    tree: Octree<L>,
    surface: Surface,
    tolerance: f64,
    /// Leaves whose polygons are cut.
    cut: FxHashSet<u32>,
    /// How far triangles of the round before are off.
    known: FxHashMap<Name, f64>,
    /// Points of earlier rounds.
    made: Made,
}

/// What stays around a place that is kept, in half diagonals of the leaf there.
const KEPT: f64 = 8.0;

/// Triangles as a mesh, with the number of the origin of each.
fn meshed(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    numbers: &[u32],
    origins: &[Origin],
) -> PolyMesh {
    let mut mesh = PolyMesh::with_points(points.to_vec());
    origins.iter().for_each(|o| {
        mesh.add_origin(o.clone());
    });
    for (triangle, &number) in triangles.iter().zip(numbers) {
        let plane = mesh.add_plane();
        mesh.push_face(&[*triangle], plane, number);
    }
    mesh.drop_unused_points();
    mesh
}

/// A triangle by the bits of its corners.
type Name = [[u64; 3]; 3];

impl<L: Level> Contour<L> {
    /// The zeros of a function in a box, within `tolerance` mm. The function must be positive on the faces of
    /// the box, whose sides must be above 0. Fails where it has no value, where the inside reaches the box, and
    /// where there would be more than [`MOST_TRIANGLES`].
    pub fn new(level: L, within: &Bounds, tolerance: f64) -> Result<Contour<L>, ContourError> {
        let tree = Octree::new(level, within, tolerance)?;
        let mut contour = Contour {
            tree,
            surface: Surface::default(),
            tolerance,
            cut: FxHashSet::default(),
            known: FxHashMap::default(),
            made: Made::default(),
        };
        contour.refine()?;
        Ok(contour)
    }

    /// Whether there is no surface.
    pub fn is_empty(&self) -> bool {
        self.surface.triangles.is_empty()
    }

    /// The surface as a mesh of triangles, closed and manifold by index, of one origin.
    pub fn mesh(&self) -> PolyMesh {
        let Surface { points, triangles, .. } = &self.surface;
        let origins = [Origin::of(geom::Surface::Facets)];
        meshed(points, triangles, &vec![0; triangles.len()], &origins)
    }

    /// The surface with fewer triangles, still within the tolerance, closed and manifold by index; nothing moves
    /// near the places `kept`. `origin` tells which of the origins a place of the surface has.
    pub fn collapsed(
        &self,
        kept: &[DVec3],
        origins: &[Origin],
        origin: impl Fn(DVec3) -> u32 + Sync,
    ) -> PolyMesh {
        let Surface { points, triangles, .. } = &self.surface;
        // Origins that are the same have no border between them.
        let first = |o: &Origin| origins.iter().position(|p| p == o).unwrap_or(0) as u32;
        let classes: Vec<u32> = origins.iter().map(first).collect();
        let middle = |t: &[u32; 3]| t.map(|i| points[i as usize]).iter().sum::<DVec3>() / 3.0;
        let label = |t: &[u32; 3]| match classes.iter().all(|c| *c == 0) {
            true => 0,
            false => classes[origin(middle(t)) as usize],
        };
        let labels: Vec<u32> = triangles.par_iter().map(label).collect();
        let reach = |p: DVec3| KEPT * half_diagonal(&self.tree.bounds(self.tree.leaf(p)));
        let around: Vec<(DVec3, f64)> = kept.iter().map(|&p| (p, reach(p))).collect();
        let is_kept = |p: &DVec3| around.iter().any(|(q, r)| p.distance(*q) <= *r);
        let fixed: Vec<bool> = points.par_iter().map(is_kept).collect();
        let left = Collapse::new(&self.tree, self.tolerance, &self.surface, labels, &fixed).run();
        meshed(points, &left.0, &left.1, origins)
    }

    /// Cuts the polygons where triangles cross, given a place of each crossing; where they are cut already,
    /// halves the cells.
    pub fn part(&mut self, places: &[DVec3]) -> Result<(), ContourError> {
        let leaves: Vec<u32> = places.iter().map(|&p| self.tree.leaf(p)).collect();
        let (again, fresh): (Vec<u32>, Vec<u32>) =
            leaves.into_iter().partition(|leaf| self.cut.contains(leaf));
        if let Some(place) =
            again.iter().position(|&c| self.tree.cells[c as usize].level + 1 >= lattice::LEVELS)
        {
            return Err(ContourError::Crossed { at: places[place] });
        }
        self.cut.extend(fresh);
        self.tree.split(again)?;
        self.refine()
    }

    /// Halves cells until the surface is within the tolerance and manifold.
    fn refine(&mut self) -> Result<(), ContourError> {
        for _ in 0..ROUNDS {
            self.surface = Surface::new(&self.tree, self.tolerance, &self.cut, &mut self.made);
            let deviations = self.deviations();
            self.check_size(&deviations)?;
            let coarse = self.coarse(&deviations);
            if coarse.is_empty() && !self.cut_doubled() {
                self.surface.drop_crumbs(2.0 * self.tolerance);
                return Ok(());
            }
            self.tree.split(coarse)?;
        }
        Ok(())
    }

    /// Stops where there are too many triangles, or soon will be: their number grows as their deviation must
    /// shrink.
    fn check_size(&self, deviations: &[f64]) -> Result<(), ContourError> {
        let found = deviations.len();
        let times = |off: &f64| (off / self.tolerance).clamp(1.0, f64::MAX);
        let needed: f64 = deviations.iter().map(times).sum();
        let telling = found >= TELLING && needed > 2.0 * MOST_TRIANGLES as f64;
        if found <= MOST_TRIANGLES && !telling {
            return Ok(());
        }
        Err(ContourError::TooFine {
            found: needed,
            limit: MOST_TRIANGLES,
            fitting: self.tolerance * (needed / MOST_TRIANGLES as f64).max(1.1),
        })
    }

    /// The cells of triangles that are too far from the surface.
    fn coarse(&self, deviations: &[f64]) -> Vec<u32> {
        let mut found = vec![];
        for (t, _) in
            self.surface.triangles.iter().zip(deviations).filter(|t| *t.1 > self.tolerance)
        {
            let cells = t.map(|i| self.surface.cells[i as usize]);
            let level = |c: u32| self.tree.cells[c as usize].level;
            let least = cells.iter().map(|&c| level(c)).min();
            let largest = cells.iter().filter(|&&c| Some(level(c)) == least);
            found.extend(largest.filter(|&&c| self.tree.may_split(c)));
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// How far the corners, the middle and the middles of edges of each triangle are from the surface at most. An
    /// edge counts for one of its triangles.
    fn deviations(&mut self) -> Vec<f64> {
        let Surface { points, triangles, .. } = &self.surface;
        let corners: Vec<f64> = points.par_iter().map(|p| self.tree.off(*p)).collect();
        let deviation = |t: &[u32; 3]| {
            let at = t.map(|i| points[i as usize]);
            let name = at.map(|p| p.to_array().map(f64::to_bits));
            if let Some(&known) = self.known.get(&name) {
                return (name, known);
            }
            let sides = (0..3).filter(|&k| t[k] < t[(k + 1) % 3]);
            let middles = sides.map(|k| (at[k] + at[(k + 1) % 3]) / 2.0);
            let places = middles.chain([(at[0] + at[1] + at[2]) / 3.0]);
            let off = places.map(|p| self.tree.off(p)).chain(t.map(|i| corners[i as usize]));
            (name, off.fold(0.0, f64::max))
        };
        let found: Vec<(Name, f64)> = triangles.par_iter().map(deviation).collect();
        let deviations = found.iter().map(|(_, off)| *off).collect();
        self.known = found.into_iter().collect();
        deviations
    }

    /// Cuts the polygons that share an edge with more than one other. Whether there are such.
    fn cut_doubled(&mut self) -> bool {
        let mut sides: FxHashMap<(u32, u32), u32> = FxHashMap::default();
        for t in &self.surface.triangles {
            (0..3).for_each(|k| *sides.entry((t[k], t[(k + 1) % 3])).or_default() += 1);
        }
        let doubled = sides.iter().filter(|(_, n)| **n > 1).map(|(side, _)| *side);
        let cells: Vec<u32> =
            doubled.flat_map(|(a, b)| [a, b].map(|i| self.surface.cells[i as usize])).collect();
        let before = self.cut.len();
        self.cut.extend(cells);
        self.cut.len() > before
    }
}
