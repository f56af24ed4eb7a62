//! What evaluation may ask of shapes and files, without seeing a kernel or a reader.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::{
    graph::ShapeGraph,
    node::{ShapeId, TextSpec},
    sweep::SweptSurface,
};
use crate::{
    base::{Diagnostic, FileError},
    geom::{
        Curve, CurvedGrid, Raster,
        isometric::{IsoDrawing, IsoScale},
    },
};

/// Measures of a solid's closed boundary, or of a profile's region.
#[derive(Clone, PartialEq, Debug)]
pub struct Measures {
    /// mm^3; 0 for a profile.
    pub volume: f64,
    /// mm^2: of the boundary of a solid, of the region of a profile.
    pub area: f64,
    /// Perimeter of a profile in mm; 0 for a solid.
    pub length: f64,
    /// Smallest and largest corner; `None` when empty.
    pub bounds: Option<[DVec3; 2]>,
    /// Centre of volume, or of area for a profile; the origin when empty.
    pub centroid: DVec3,
    /// Inertia about the centroid for density 1, mm^5.
    pub inertia: DMat3,
    /// Triangles of the boundary.
    pub triangles: usize,
    /// Euler number of the closed boundary (vertices - edges + faces of a triangulation).
    pub euler: i64,
    /// Number of connected components of the boundary.
    pub shells: usize,
    /// Whether every edge borders exactly two faces.
    pub closed: bool,
}

impl Measures {
    /// Handles of the boundary: shells - euler / 2.
    pub fn genus(&self) -> i64 {
        self.shells as i64 - self.euler / 2
    }
}

/// Why a shape could not be made or measured: an inner error, without a place in the source. The
/// caller adds the span.
#[derive(Clone, PartialEq, Debug)]
pub struct GeometryError {
    /// The diagnostic; where it has no label, the caller adds its own place.
    pub diagnostic: Box<Diagnostic>,
}

/// What a file brought in.
#[derive(Clone, PartialEq, Debug)]
pub enum Imported {
    /// A mesh file: the evaluator makes a [`Node::ImportSolid`](super::Node::ImportSolid) of it.
    Solid,
    /// A plane figure: a [`Node::ImportProfile`](super::Node::ImportProfile).
    Profile,
    /// JSON or CSV.
    Data(Data),
}

/// Plain values from a JSON or CSV file. A CSV file is a list of records keyed by its header.
#[derive(Clone, PartialEq, Debug)]
pub enum Data {
    /// JSON `null`.
    Null,
    /// A truth value.
    Bool(bool),
    /// A bare number.
    Number(f64),
    /// A string.
    Text(Arc<str>),
    /// A list.
    List(Vec<Data>),
    /// A record in file order.
    Record(Vec<(Arc<str>, Data)>),
}

/// How `inside` decides.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum InsideMethod {
    /// The spherical projection (Nagashima).
    Sphere,
    /// The signed distance from the boundary (Tatehara et al.).
    Field,
    /// A walk through tetrahedra (Arakawa).
    Tetrahedra,
}

/// What tetrahedra a solid is filled with.
#[derive(Clone, PartialEq, Debug)]
pub struct TetrahedraCount {
    /// How many.
    pub count: usize,
    /// How many of them have no volume.
    pub flat: usize,
    /// The smallest dihedral angle in degrees.
    pub smallest: f64,
    /// The largest.
    pub largest: f64,
    /// How many angles are in [0, 10), [10, 20) and so on up to [170, 180] degrees.
    pub histogram: Vec<usize>,
}

/// Answers about shapes. `session` hands one in; `realize` implements it. Results are kept by node.
pub trait Geometry {
    /// The model sets the chord error, in mm, before anything is measured. Ignored where one holds
    /// already, or by those who mesh nothing.
    fn settle_tolerance(&self, _mm: f64) {}

    /// Measures of a shape.
    fn measures(&self, graph: &ShapeGraph, shape: ShapeId) -> Result<Arc<Measures>, GeometryError>;

    /// Whether a point is in a solid; a boundary point counts as inside.
    fn inside(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
        point: DVec3,
        by: InsideMethod,
    ) -> Result<bool, GeometryError>;

    /// The solid angle in steradians under which the boundary is seen from a point: 4 pi inside.
    fn solid_angle(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
        point: DVec3,
    ) -> Result<f64, GeometryError>;

    /// The tetrahedra that fill a solid.
    fn tetrahedra(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
    ) -> Result<TetrahedraCount, GeometryError>;

    /// Distance in mm from a point to a solid, negative inside.
    fn distance_to_point(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
        point: DVec3,
    ) -> Result<f64, GeometryError>;

    /// Least distance in mm of a point of a curve from a solid, negative inside.
    fn distance_to_curve(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
        curve: &Curve,
    ) -> Result<f64, GeometryError>;

    /// Distance in mm between two solids; negative (the depth of the deepest point) where a part of the
    /// boundary of one lies inside the other, 0 where they touch or are the same.
    fn distance(&self, graph: &ShapeGraph, a: ShapeId, b: ShapeId) -> Result<f64, GeometryError>;

    /// Hausdorff distance of the boundaries in mm.
    fn hausdorff(&self, graph: &ShapeGraph, a: ShapeId, b: ShapeId) -> Result<f64, GeometryError>;

    /// The points of a swept surface, as close as the tolerance asks.
    fn surface(&self, surface: &SweptSurface) -> Result<CurvedGrid, GeometryError>;

    /// Advance width of a text in mm.
    fn text_width(&self, text: &TextSpec) -> Result<f64, GeometryError>;

    /// Looks into a file (path relative to the project root) far enough to say what it holds.
    fn import(&self, file: &str) -> Result<Imported, GeometryError>;

    /// The numbers of a height map (path relative to the project root).
    fn heights(&self, file: &str) -> Result<Raster, GeometryError>;

    /// The lines of an isometric drawing (path relative to the project root).
    fn isometric(&self, file: &str, scale: &IsoScale) -> Result<IsoDrawing, GeometryError>;

    /// The bytes of a file, for goldens and snapshots.
    fn read(&self, file: &str) -> Result<Vec<u8>, FileError>;
}
