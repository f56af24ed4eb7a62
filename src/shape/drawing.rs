//! Drawings and pages as a model describes them: immutable, plain data. Nothing is drawn yet.
//!
//! Lengths in millimetres, angles in degrees, points in the frame of the model.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{halftone::ShadeSpec, node::ShapeId};
use crate::{
    base::Span,
    geom::{Curve, CurvedGrid, Hidden, Method, Placement, View, mesh::Color},
};

/// A place in the source. Two descriptions made in different places are equal all the same.
#[derive(Clone, Copy, Debug, Default)]
pub struct Place(pub Span);

impl PartialEq for Place {
    fn eq(&self, _: &Place) -> bool {
        true
    }
}

/// A curve in space, or several lines.
#[derive(Clone, PartialEq, Debug)]
pub enum CurveSpec {
    /// One curve.
    Exact(Curve),
    /// Parallel lines that fill a plane figure.
    Hatch {
        /// The figure.
        profile: ShapeId,
        /// From line to line, above 0.
        pitch: f64,
        /// Their direction from the x axis of the figure's plane.
        angle: f64,
        /// Where the lines stand.
        placement: Placement,
    },
}

impl CurveSpec {
    /// The name that it was given.
    pub fn tag(&self) -> Option<&Arc<str>> {
        match self {
            CurveSpec::Exact(curve) => curve.tag(),
            CurveSpec::Hatch { .. } => None,
        }
    }

    /// The curve after a placement.
    pub fn placed(&self, placement: &Placement) -> CurveSpec {
        match self {
            CurveSpec::Exact(curve) => CurveSpec::Exact(curve.placed(placement)),
            CurveSpec::Hatch { profile, pitch, angle, placement: inner } => CurveSpec::Hatch {
                profile: *profile,
                pitch: *pitch,
                angle: *angle,
                placement: placement.after(inner),
            },
        }
    }
}

/// A face of a solid.
#[derive(Clone, PartialEq, Debug)]
pub enum FaceSpec {
    /// The outermost one towards a side.
    Side(View),
    /// The largest one with a tag.
    Tag(Arc<str>),
    /// The one in a plane.
    Plane {
        /// A point of the plane.
        at: DVec3,
        /// Outwards; not zero.
        normal: DVec3,
    },
    /// The one nearest to a point, flat or round; figures start there.
    Near(DVec3),
}

/// Figures drawn on a face: their x and y run to the right and upwards seen from outside, from the middle of the face or
/// the point it is named by. They are laid on round faces as a label is.
#[derive(Clone, PartialEq, Debug)]
pub struct FiguresSpec {
    /// The face.
    pub face: FaceSpec,
    /// Plane figures, whose outlines are drawn.
    pub profiles: Vec<ShapeId>,
    /// Lines.
    pub curves: Vec<Arc<CurveSpec>>,
    /// The call.
    pub place: Place,
}

/// Where the eye is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Projection {
    /// One of the usual parallel ones.
    Side(View),
    /// Parallel; a direction towards the eye that is not zero.
    Direction(DVec3),
    /// From an eye that is not at the target.
    Perspective {
        /// The eye.
        eye: DVec3,
        /// Full vertical angle, above 0 and below 180.
        fov: Option<f64>,
    },
}

/// The classes of line that a style sets.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum PenName {
    /// What is seen.
    Visible,
    /// What is behind something.
    Hidden,
    /// Axes and centres.
    Center,
    /// Where a section is cut.
    Cutting,
    /// Outlines of cut faces.
    Section,
    /// Hatching of cut faces.
    Hatch,
    /// Dimensions.
    Dimension,
    /// Figures on faces.
    Pattern,
    /// Lines in space.
    Free,
    /// Grid lines of a surface seen on its upper side.
    Upper,
    /// Grid lines of a surface seen on its lower side.
    Lower,
    /// Outlines of cast shadows and lines in them.
    Shadow,
    /// The guide mesh of isometric drawing.
    Grid,
}

impl PenName {
    /// All of them with the words of the language.
    pub const ALL: [(PenName, &'static str); 13] = [
        (PenName::Visible, "visible"),
        (PenName::Hidden, "hidden"),
        (PenName::Center, "center"),
        (PenName::Cutting, "cutting"),
        (PenName::Section, "section"),
        (PenName::Hatch, "hatch"),
        (PenName::Dimension, "dimension"),
        (PenName::Pattern, "pattern"),
        (PenName::Free, "free"),
        (PenName::Upper, "upper"),
        (PenName::Lower, "lower"),
        (PenName::Shadow, "shadow"),
        (PenName::Grid, "grid"),
    ];
}

/// What a style changes about one class of line.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct PenSpec {
    /// Width, above 0.
    pub width: Option<f64>,
    /// Lengths of dashes and gaps in turn; empty for a full line.
    pub dash: Option<Vec<f64>>,
    /// Colour.
    pub color: Option<Color>,
}

/// What a drawing changes about the standard style.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct StyleSpec {
    /// Pens in the order they were given.
    pub pens: Vec<(PenName, PenSpec)>,
    /// Facets of a surface without a closed form meet in a drawn edge from this angle on.
    pub crease: Option<f64>,
    /// Distance of hatch lines.
    pub hatch_pitch: Option<f64>,
    /// Height of capitals in dimensions.
    pub text_height: Option<f64>,
}

/// A cutting plane. What lies on the side of its normal is taken away.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CutPlane {
    /// A point of it.
    pub at: DVec3,
    /// Towards what is taken away; not zero.
    pub normal: DVec3,
}

/// What a dimension measures.
#[derive(Clone, PartialEq, Debug)]
pub enum Measured {
    /// Distances between neighbouring points, along a direction or along the line through them.
    Linear {
        /// At least two.
        points: Vec<DVec3>,
        /// The direction, if one is given; not zero.
        along: Option<DVec3>,
        /// Distance of the dimension line from the first point, to its left seen along the line; negative to
        /// the right.
        offset: f64,
    },
    /// A radius or diameter.
    Round {
        /// Centre.
        center: DVec3,
        /// Radius.
        r: f64,
        /// Whether the diameter is written.
        diameter: bool,
        /// Direction of the leader on paper, from +x counter-clockwise.
        angle: f64,
    },
    /// An angle.
    Angle {
        /// Where its legs meet.
        apex: DVec3,
        /// A point on the first leg; the angle is counter-clockwise from it.
        from: DVec3,
        /// A point on the second leg.
        to: DVec3,
        /// Radius of the dimension line.
        r: f64,
    },
}

/// A dimension of a view.
#[derive(Clone, PartialEq, Debug)]
pub struct DimSpec {
    /// What it measures.
    pub measured: Measured,
    /// What is written in place of the measured number; `<>` in it is the number.
    pub text: Option<Arc<str>>,
    /// The call.
    pub place: Place,
}

/// The line of a cutting plane in the view that a section is taken from.
#[derive(Clone, PartialEq, Debug)]
pub struct CuttingSpec {
    /// The plane.
    pub plane: CutPlane,
    /// The letter of the section.
    pub name: Arc<str>,
    /// The call.
    pub place: Place,
}

/// Cast shadows in a view.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CastSpec {
    /// Towards the sun; not zero.
    pub toward: DVec3,
    /// Height of the plane that shadows fall on beside the shapes, if there is one.
    pub ground: Option<f64>,
}

/// A view of shapes.
#[derive(Clone, PartialEq, Debug)]
pub struct ViewSpec {
    /// Solids, each a body of its own.
    pub shapes: Vec<ShapeId>,
    /// Plane figures, whose outlines are lines in space.
    pub profiles: Vec<ShapeId>,
    /// Surfaces.
    pub surfaces: Vec<Arc<CurvedGrid>>,
    /// Lines in space.
    pub curves: Vec<Arc<CurveSpec>>,
    /// Where the eye is.
    pub projection: Projection,
    /// The image of this point is the origin of the drawing.
    pub target: DVec3,
    /// Lower left and upper right corner of what is drawn, on paper at scale 1.
    pub window: Option<[DVec2; 2]>,
    /// Which hidden lines are drawn.
    pub hidden: Hidden,
    /// How they are found.
    pub method: Method,
    /// Line widths and more.
    pub style: StyleSpec,
    /// Which shadows are drawn, if any are.
    pub shadow: Option<CastSpec>,
    /// Where the shapes are cut.
    pub section: Option<CutPlane>,
    /// Whether holes and round bodies get centre lines.
    pub center_lines: bool,
    /// Dimensions in the order they were given.
    pub dims: Vec<DimSpec>,
    /// Lines of cutting planes in the order they were given.
    pub cuttings: Vec<CuttingSpec>,
    /// From line to line of the isometric guide mesh, if it is drawn; above 0.
    pub grid: Option<f64>,
    /// What is written above it.
    pub caption: Option<Arc<str>>,
    /// The call that made it.
    pub place: Place,
}

/// Where a view stands on a page.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Position {
    /// The middle of the view, from the lower left corner of the page.
    At(DVec2),
    /// Beside another view, where its direction belongs in the page's projection.
    Beside {
        /// Number of the other view on the page.
        other: usize,
        /// Between the two.
        gap: f64,
    },
}

/// What is put on a page.
#[derive(Clone, PartialEq, Debug)]
pub enum Subject {
    /// A view.
    View(Arc<ViewSpec>),
    /// A half-tone.
    Shade(Arc<ShadeSpec>),
}

impl Subject {
    /// Where the eye is.
    pub fn projection(&self) -> Projection {
        match self {
            Subject::View(view) => view.projection,
            Subject::Shade(shade) => shade.projection,
        }
    }
}

/// A view or picture on a page.
#[derive(Clone, PartialEq, Debug)]
pub struct Placed {
    /// The view or picture.
    pub subject: Subject,
    /// Where.
    pub position: Position,
    /// Its own scale.
    pub scale: Option<f64>,
    /// The call.
    pub place: Place,
}

/// What stands in the title block.
#[derive(Clone, PartialEq, Debug)]
pub struct TitleSpec {
    /// The title.
    pub title: Arc<str>,
    /// Further fields: what they are and what they say.
    pub fields: Vec<(Arc<str>, Arc<str>)>,
}

/// A page with views on it.
#[derive(Clone, PartialEq, Debug)]
pub struct PageSpec {
    /// Width and height.
    pub size: DVec2,
    /// `A4`, if it is of a named size.
    pub name: Option<Arc<str>>,
    /// Of all views that have none of their own: paper over model.
    pub scale: f64,
    /// First-angle projection: the view from above stands below. Otherwise third-angle.
    pub first_angle: bool,
    /// Whether a frame is drawn.
    pub frame: bool,
    /// The title block.
    pub title: Option<TitleSpec>,
    /// The views in the order they were placed.
    pub views: Vec<Placed>,
    /// The call that made it.
    pub place: Place,
}
