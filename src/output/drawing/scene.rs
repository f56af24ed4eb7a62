//! What is drawn, and how it is wanted.

use glam::DVec3;

use super::round::Round;
use crate::geom::{CurvedGrid, Hidden, Method, Origin, PolyMesh, Surface, Tolerance};

/// A solid, or an open surface when its mesh has borders; both sides of an open one hide.
#[derive(Clone, Copy, Debug)]
pub struct Body<'a> {
    /// Its boundary, millimetres.
    pub mesh: &'a PolyMesh,
    /// The caller's number for it; lines carry it.
    pub id: u32,
    /// Whether facets of a surface without a closed form meet smoothly at any angle.
    pub smooth: bool,
}

/// A line in space that is no edge: a figure on a face or a free line. It is hidden like an edge; a face it
/// lies in does not hide it.
#[derive(Clone, PartialEq, Debug)]
pub struct Stroke {
    /// Its corners, millimetres.
    pub points: Vec<DVec3>,
    /// What it is drawn as.
    pub kind: Kind,
    /// The caller's number for it; lines carry it.
    pub id: u32,
    /// The circle or ellipse that all its corners lie on, in their order, if it stands for an arc.
    pub round: Option<Round>,
    /// Where its corners are drawn, millimetres, if not where they are hidden: figures lie on facets and are drawn on the
    /// round face that these stand for. Empty otherwise.
    pub drawn: Vec<DVec3>,
}

/// What a line stands for.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Kind {
    /// An edge between two faces that meet at an angle.
    Sharp,
    /// The rim of an open surface.
    Border,
    /// Where a face turns away from the eye.
    Contour,
    /// A figure on a face.
    Pattern,
    /// A grid line of a surface, where its upper side is seen.
    Upper,
    /// A grid line of a surface, where its lower side is seen.
    Lower,
    /// The outline of a shadow, and lines in it.
    Shadow,
    /// A line in space.
    Free,
    /// Where a cutting plane runs.
    Cutting,
    /// A centre line.
    Centre,
}

/// All that stands before the eye.
#[derive(Clone, Debug, Default)]
pub struct Scene<'a> {
    /// Solids and surfaces.
    pub bodies: Vec<Body<'a>>,
    /// Figures on faces and free lines.
    pub strokes: Vec<Stroke>,
    /// Smooth surfaces through points, drawn by their grid lines and contours, each with the caller's number for it.
    pub grids: Vec<(&'a CurvedGrid, u32)>,
}

impl<'a> Scene<'a> {
    /// Solids numbered in their order, and nothing else.
    pub fn of(meshes: impl IntoIterator<Item = &'a PolyMesh>) -> Scene<'a> {
        let bodies = meshes
            .into_iter()
            .zip(0..)
            .map(|(mesh, id)| Body { mesh, id, smooth: false })
            .collect();
        Scene { bodies, ..Scene::default() }
    }
}

impl Scene<'_> {
    /// Numbers of bodies with faces that are not flat, in order: their corners need not be exact.
    pub(super) fn rough(&self) -> Vec<u32> {
        let bent = |o: &Origin| o.surface != Surface::Plane;
        let rough = self.bodies.iter().filter(|b| b.mesh.origins().iter().any(bent));
        let mut numbers: Vec<u32> = rough.map(|b| b.id).collect();
        numbers.sort_unstable();
        numbers
    }
}

/// How a drawing is wanted.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Options {
    /// Which hidden lines are kept.
    pub hidden: Hidden,
    /// How they are found.
    pub method: Method,
    /// The chord error the meshes were made with: faces nearer than this to their true surface are drawn as
    /// that surface, coarser ones as the facets they are.
    pub tolerance: Tolerance,
    /// Facets of a surface without a closed form meet in a sharp edge from this angle on, degrees.
    pub crease: f64,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            hidden: Hidden::Dashed,
            method: Method::Auto,
            tolerance: Tolerance::DEFAULT,
            crease: 20.0,
        }
    }
}
