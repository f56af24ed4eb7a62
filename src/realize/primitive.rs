//! Solids that no set operation makes: primitives, extrusions, hulls, imports.

use glam::DVec3;

use super::{
    Realizer, check_size,
    failure::{At, Coded, Made, failure},
    figure, import, morphology,
    paint::Paint,
    sweep,
};
use crate::{
    base::{Code, Diagnostic},
    convert::{contour, offset::fillet},
    geom::{Bounds, sides as count},
    kernel::brep::{
        Polyhedron,
        boolean::BooleanError,
        extrude::{ExtrudeError, extrude},
        faces::{self, FacesError},
        hull::{HullError, hull},
        primitive,
        revolve::{RevolveError, revolve},
        sheet::{self, SheetError},
    },
    shape::{Kind, Node, ShapeGraph, ShapeId, Stretched},
};

/// Points that one hull may be made of: about half a gigabyte while it is.
const MOST_HULL_POINTS: usize = 4_000_000;

impl Coded for ExtrudeError {
    fn code(&self) -> Code {
        match self {
            ExtrudeError::TooManySlices(..) => Code::Limit,
            _ => Code::Degenerate,
        }
    }
}

impl Coded for RevolveError {
    fn code(&self) -> Code {
        match self {
            RevolveError::TooManyFacets(_) => Code::Limit,
            _ => Code::Degenerate,
        }
    }
}

impl Coded for HullError {
    fn code(&self) -> Code {
        Code::Degenerate
    }
}

impl Coded for SheetError {
    fn code(&self) -> Code {
        match self {
            SheetError::Floor { .. } => Code::OutOfRange,
            SheetError::Defect(_) | SheetError::Rim { .. } => Code::OpenMesh,
            SheetError::Crossing(BooleanError::Tangled(_)) => Code::Limit,
            SheetError::Crossing(_) => Code::SelfCrossing,
            SheetError::Bend { .. } | SheetError::Flat => Code::Degenerate,
        }
    }

    fn help(&self) -> Option<String> {
        let words = match self {
            SheetError::Rim { .. } => {
                "give `.solid(base = ...)` the height of a floor, or use `.thicken(t)`"
            }
            SheetError::Bend { .. } => "make the sheet thinner, or the surface smoother",
            SheetError::Floor { .. } => "move `base` below the surface",
            SheetError::Flat => {
                "give `.solid(base = ...)` the height of a floor, or use `.thicken(t)`"
            }
            SheetError::Defect(_) | SheetError::Crossing(_) => return None,
        };
        Some(words.into())
    }
}

/// The name of what a node asks of a distance field, if it does.
fn stage(node: &Node) -> Option<&'static str> {
    match node {
        Node::Offset { .. } => Some("offset"),
        Node::Fillet { .. } => Some("fillet"),
        Node::Metaball { .. } => Some("metaball"),
        Node::Formula { .. } => Some("field"),
        _ => None,
    }
}

/// Makes the solid of a node that is no set operation and whose parts are made.
pub fn make(realizer: &Realizer, graph: &ShapeGraph, unit: Stretched) -> Made<Polyhedron> {
    let id = unit.id;
    let origin = graph.origin(id);
    let tolerance = realizer.tolerance_of(unit);
    let figure_of = |profile: ShapeId| realizer.figure_made(graph.part(unit, profile));
    let bent =
        |profile: ShapeId| figure::bent(realizer, graph, graph.part(unit, profile), tolerance);
    stage(graph.node(id)).iter().for_each(|name| realizer.watch.stage(name));
    match graph.node(id) {
        Node::Box { min, max } => Ok(primitive::cuboid(*min, *max)),
        Node::Cone { r1, r2, h, sides } => {
            let sides = sides.unwrap_or_else(|| count::circle(r1.max(*r2), tolerance));
            check_size(graph, id, 4 * sides as usize)?;
            Ok(primitive::cone(*r1, *r2, *h, sides))
        }
        Node::Sphere { r, sides } => {
            let sides = sides.unwrap_or_else(|| count::sphere(*r, tolerance));
            check_size(graph, id, squared(sides, sides.div_ceil(2)).saturating_mul(2))?;
            Ok(primitive::sphere(*r, sides))
        }
        Node::Torus { major, minor, sides } => {
            let both = sides.map(|n| (n, n));
            let (around, tube) = both.unwrap_or_else(|| count::torus(*major, *minor, tolerance));
            check_size(graph, id, squared(around, tube).saturating_mul(2))?;
            Ok(primitive::torus(*major, *minor, around, tube))
        }
        Node::Polyhedron { points, faces } => faces::polyhedron(points, faces).at(origin),
        Node::Extrude { profile, height, twist, scale } => {
            let (figure, tolerance) = match *twist {
                0.0 => (figure_of(*profile)?, tolerance),
                _ => bent(*profile)?,
            };
            let solid = extrude(&figure.region, *height, *twist, *scale, tolerance).at(origin)?;
            Ok(painted(solid, &figure.paint).placed(&figure.frame))
        }
        Node::Revolve { profile, angle, sides } => {
            let (figure, tolerance) = match sides {
                Some(_) => (figure_of(*profile)?, tolerance),
                None => bent(*profile)?,
            };
            let region = figure::upright(&figure);
            let solid = revolve(&region, *angle, *sides, tolerance).at(origin)?;
            Ok(painted(solid, &figure.paint))
        }
        Node::SweptAlong(carried) => sweep::along(realizer, graph, unit, carried),
        Node::SweptBetween(carried) => sweep::between(realizer, graph, unit, carried),
        Node::Loft { sections, ruled } => sweep::loft(realizer, graph, unit, sections, *ruled),
        Node::Hull(list) => hull_of(realizer, graph, unit, list),
        Node::Thickened { surface, t } => sheet::thickened(surface, *t).at(origin),
        Node::Filled { surface, base } => sheet::filled(surface, *base).at(origin),
        Node::Offset { child, radii, by } => {
            let solid = realizer.solid_made(graph, *child, unit.stretch)?;
            morphology::offset(&solid.polyhedron, *radii, *by, tolerance).at(origin)
        }
        Node::Metaball { charges, threshold } => {
            contour::metaball(charges, *threshold, tolerance).at(origin)
        }
        Node::Formula { formula, within } => {
            contour::formula(formula, &Bounds { min: within[0], max: within[1] }, tolerance)
                .at(origin)
        }
        Node::Fillet { child, convex, concave } => {
            let solid = realizer.solid_made(graph, *child, unit.stretch)?;
            fillet(&solid.polyhedron, *convex, *concave, tolerance).at(origin)
        }
        Node::ImportSolid { file, heal } => {
            import::solid(realizer, file, *heal).map_err(|e| figure::placed(e, graph, id))
        }
        node => {
            debug_assert_eq!(
                node,
                &Node::Empty(Kind::Solid),
                "profiles and sets are made elsewhere"
            );
            Ok(Polyhedron::empty())
        }
    }
}

/// The hull of some shapes.
fn hull_of(
    realizer: &Realizer,
    graph: &ShapeGraph,
    unit: Stretched,
    list: &[ShapeId],
) -> Made<Polyhedron> {
    let origin = graph.origin(unit.id);
    let mut points: Vec<DVec3> = vec![];
    for &child in list {
        let made = realizer.solid_made(graph, child, unit.stretch)?;
        points.extend(&made.polyhedron.mesh().points);
        if points.len() > MOST_HULL_POINTS {
            let words = format!("a hull of more than {MOST_HULL_POINTS} points");
            let error = Diagnostic::error(Code::Limit, words).label(origin, "");
            return Err(failure(error.help("give a larger tolerance or fewer shapes")));
        }
    }
    hull(&points).at(origin)
}

fn squared(a: u32, b: u32) -> usize {
    (a as usize).saturating_mul(b as usize)
}

pub fn painted(solid: Polyhedron, paint: &Paint) -> Polyhedron {
    if paint.is_none() { solid } else { Polyhedron::trusted(paint.applied(solid.mesh())) }
}

impl Coded for FacesError {
    fn code(&self) -> Code {
        match self {
            FacesError::NoFaces => Code::Degenerate,
            FacesError::FewCorners { .. } | FacesError::NoSuchPoint { .. } => Code::OutOfRange,
            FacesError::Defect(_) => Code::OpenMesh,
        }
    }
}
