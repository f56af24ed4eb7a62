//! What is drawn, and how it is wanted.

use glam::DVec3;

use super::round::Round;
use crate::geom::{Hidden, Method, PolyMesh, Tolerance};

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
}

impl<'a> Scene<'a> {
    /// Solids numbered in their order, and nothing else.
    pub fn of(meshes: impl IntoIterator<Item = &'a PolyMesh>) -> Scene<'a> {
        let bodies = meshes
            .into_iter()
            .zip(0..)
            .map(|(mesh, id)| Body { mesh, id, smooth: false })
            .collect();
        Scene { bodies, strokes: vec![] }
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
