//! The nodes of the shape graph. Lengths in millimetres, angles in degrees.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{
    drawing::FiguresSpec,
    sweep::{SweepAlong, SweepBetween},
};
use crate::geom::{Charge, Curve, CurvedGrid, Formula, Placement, mesh::Color};

/// Names a node of one [`ShapeGraph`](super::ShapeGraph).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct ShapeId(pub u32);

/// Whether a node is a solid or a plane figure.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Kind {
    /// A body in space.
    Solid,
    /// A figure in the xy plane of its frame; [`Node::Transform`] may take it out of xy.
    Profile,
}

/// How a broken mesh is mended on import.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Heal {
    /// Points closer than this many millimetres become one.
    Weld(f64),
    /// The solid is where the generalised winding number is at least one half.
    Winding,
}

/// Where a text stands along its base line.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum HorizontalAlign {
    /// Starts at x = 0.
    Left,
    /// Its advance width is centred on x = 0.
    Center,
    /// Ends at x = 0.
    Right,
}

/// Where a text stands across its base line.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum VerticalAlign {
    /// Its top at y = 0.
    Top,
    /// Its middle at y = 0.
    Center,
    /// Its base line at y = 0.
    Baseline,
    /// Its bottom at y = 0.
    Bottom,
}

/// How a point is told to be in a solid grown or shrunk: by what its sphere meets.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum SphereTest {
    /// By the nearest point of the boundary.
    #[default]
    Exact,
    /// By halving the unrolled sphere.
    Quadtree,
    /// By random points of the sphere.
    MonteCarlo {
        /// How many.
        n: u32,
        /// Where the random numbers begin.
        seed: u64,
    },
}

/// What a text profile is made of.
#[derive(Clone, PartialEq, Debug)]
pub struct TextSpec {
    /// The characters.
    pub text: Arc<str>,
    /// Size in millimetres, as OpenSCAD's `size`: about the height of a capital letter.
    pub size: f64,
    /// A font file relative to the project root; the embedded font if none.
    pub font: Option<Arc<str>>,
    /// Along the base line.
    pub halign: HorizontalAlign,
    /// Across the base line.
    pub valign: VerticalAlign,
}

/// A construction step. `sides: None` means a true curve that is faceted by tolerance when realised.
#[derive(Clone, PartialEq, Debug)]
pub enum Node {
    /// Nothing: the neutral element of the union.
    Empty(Kind),

    /// An axis-parallel box.
    Box {
        /// Smallest corner.
        min: DVec3,
        /// Largest corner.
        max: DVec3,
    },
    /// A cylinder or truncated cone about the z axis, base on z = 0; one radius may be 0.
    Cone {
        /// Radius at z = 0.
        r1: f64,
        /// Radius at z = `h`.
        r2: f64,
        /// Height.
        h: f64,
        /// Number of sides of the inscribed polygon.
        sides: Option<u32>,
    },
    /// A sphere about the origin.
    Sphere {
        /// Radius.
        r: f64,
        /// Sides of its largest ring.
        sides: Option<u32>,
    },
    /// A torus about the z axis, centred.
    Torus {
        /// Radius of the circle of tube centres.
        major: f64,
        /// Radius of the tube.
        minor: f64,
        /// Sides both ways.
        sides: Option<u32>,
    },
    /// A closed polyhedron given by points and faces (counter-clockwise from outside).
    Polyhedron {
        /// Its corners.
        points: Arc<[DVec3]>,
        /// For each face its corners' indices.
        faces: Arc<[Arc<[u32]>]>,
    },
    /// A profile moved along its plane's normal.
    Extrude {
        /// The profile.
        profile: ShapeId,
        /// Height along the normal of the profile's plane.
        height: f64,
        /// Right-handed turn from bottom to top, degrees.
        twist: f64,
        /// Size of the top relative to the bottom, along x and y of the profile's plane.
        scale: DVec2,
    },
    /// A profile turned about the y axis of its plane, which becomes z.
    Revolve {
        /// The profile; all of it at x >= 0.
        profile: ShapeId,
        /// Turn in degrees, counter-clockwise from +x.
        angle: f64,
        /// Sides of a full turn.
        sides: Option<u32>,
    },
    /// The convex hull of solids, or of profiles.
    Hull(Arc<[ShapeId]>),
    /// A profile carried along a curve.
    SweptAlong(Arc<SweepAlong>),
    /// Closed sections carried along two curves.
    SweptBetween(Arc<SweepBetween>),
    /// A body through profiles.
    Loft {
        /// The profiles, at least two.
        sections: Arc<[ShapeId]>,
        /// Whether it runs straight from one to the next.
        ruled: bool,
    },
    /// A sheet about a surface, half of its thickness to each side.
    Thickened {
        /// The surface.
        surface: Arc<CurvedGrid>,
        /// The thickness, above 0.
        t: f64,
    },
    /// What lies between a surface and a floor.
    Filled {
        /// The surface.
        surface: Arc<CurvedGrid>,
        /// z of the floor; none for what the surface encloses, its rims closed by planes.
        base: Option<f64>,
    },
    /// A mesh from a file (path relative to the project root).
    ImportSolid {
        /// The file.
        file: Arc<str>,
        /// How to mend it, if asked to.
        heal: Option<Heal>,
    },

    /// A rectangle centred on the origin.
    Rect {
        /// Its size.
        size: DVec2,
    },
    /// An ellipse about the origin; a circle when the radii are equal.
    Ellipse {
        /// Its radii along x and y.
        radii: DVec2,
        /// Sides of the inscribed polygon, the first corner on +x.
        sides: Option<u32>,
    },
    /// A polygon with holes.
    Polygon {
        /// Its corners, either way round.
        points: Arc<[DVec2]>,
        /// The corners of its holes.
        holes: Arc<[Arc<[DVec2]>]>,
    },
    /// What a closed curve in the xy plane encloses.
    Outline {
        /// The curve.
        curve: Arc<Curve>,
    },
    /// The outlines of a text.
    Text(Arc<TextSpec>),
    /// Figures from an SVG or DXF file.
    ImportProfile {
        /// The file, relative to the project root.
        file: Arc<str>,
    },
    /// A profile grown (d > 0, rounded corners) or shrunk (d < 0) by a distance.
    OffsetProfile {
        /// The profile.
        profile: ShapeId,
        /// The distance.
        d: f64,
    },
    /// A profile whose convex and concave corners are rounded by a radius.
    RoundProfile {
        /// The profile.
        profile: ShapeId,
        /// The radius.
        r: f64,
    },

    /// A solid grown by a ball or an ellipsoid (all radii positive), or shrunk (all negative).
    Offset {
        /// The solid.
        child: ShapeId,
        /// The radii along the axes.
        radii: DVec3,
        /// How points are told to be in it.
        by: SphereTest,
    },
    /// A solid or a profile whose edges or corners are rounded.
    Fillet {
        /// The shape.
        child: ShapeId,
        /// The radius of what was convex.
        convex: f64,
        /// The radius of what was concave.
        concave: f64,
    },

    /// Where the potentials of charges together reach a threshold.
    Metaball {
        /// The charges.
        charges: Arc<[Charge]>,
        /// The threshold, above 0.
        threshold: f64,
    },
    /// Where a formula is not positive.
    Formula {
        /// The formula.
        formula: Arc<Formula>,
        /// Two corners of the box that it is sought in.
        within: [DVec3; 2],
    },

    /// The union of solids, or of profiles in one plane.
    Union(Arc<[ShapeId]>),
    /// The first less all others; at least one.
    Difference(Arc<[ShapeId]>),
    /// What all have in common; at least one.
    Intersection(Arc<[ShapeId]>),
    /// A shape in another place.
    Transform {
        /// The map.
        placement: Placement,
        /// The shape.
        child: ShapeId,
    },
    /// A shape all of whose faces bear a name.
    Tag {
        /// The name.
        name: Arc<str>,
        /// The shape.
        child: ShapeId,
    },
    /// A solid with figures drawn on a face.
    Figured {
        /// The figures.
        figures: Arc<FiguresSpec>,
        /// The solid.
        child: ShapeId,
    },
    /// A shape in a colour; faces that have one keep it.
    Paint {
        /// The colour.
        color: Color,
        /// The shape.
        child: ShapeId,
    },
}

impl Node {
    /// The shapes it is made of.
    pub fn children(&self) -> &[ShapeId] {
        match self {
            Node::Union(list)
            | Node::Difference(list)
            | Node::Intersection(list)
            | Node::Hull(list) => list,
            Node::Loft { sections, .. } => sections,
            Node::SweptBetween(sweep) => &sweep.sections,
            Node::SweptAlong(sweep) => std::slice::from_ref(&sweep.profile),
            Node::Extrude { profile: child, .. }
            | Node::Revolve { profile: child, .. }
            | Node::OffsetProfile { profile: child, .. }
            | Node::RoundProfile { profile: child, .. }
            | Node::Offset { child, .. }
            | Node::Fillet { child, .. }
            | Node::Transform { child, .. }
            | Node::Tag { child, .. }
            | Node::Figured { child, .. }
            | Node::Paint { child, .. } => std::slice::from_ref(child),
            _ => &[],
        }
    }
}
