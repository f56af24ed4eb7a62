//! Solids and surfaces swept along curves.

use std::sync::Arc;

use super::{
    Realizer,
    failure::{At, Coded, Made},
    figure::{self, Figure},
    primitive::painted,
};
use crate::{
    base::Code,
    geom::{CurvedGrid, Tolerance},
    kernel::brep::{
        Polyhedron,
        boolean::BooleanError,
        sweep::{self, Along, Between, Placed, SweepError},
    },
    shape::{
        GeometryError, ShapeGraph, ShapeId, Stretched, SweepAlong, SweepBetween, SweptSurface,
    },
};

impl Coded for SweepError {
    fn code(&self) -> Code {
        match self {
            SweepError::TooManyFacets
            | SweepError::Tangled(_)
            | SweepError::Union(BooleanError::Tangled(_)) => Code::Limit,
            SweepError::Crossing { .. } | SweepError::Union(_) => Code::SelfCrossing,
            _ => Code::Degenerate,
        }
    }

    fn help(&self) -> Option<String> {
        let words = match self {
            SweepError::Bend { .. } => {
                "make the profile smaller or the bend wider, or give `repair = UNION`"
            }
            SweepError::Tangled(_) | SweepError::Union(BooleanError::Tangled(_)) => {
                "a coarser tolerance, less twist or a shorter path makes fewer facets"
            }
            SweepError::Crossing { .. } => "move the parts apart, or give `repair = UNION`",
            SweepError::Order { .. } => {
                "list the sections in the order in which the rails pass them"
            }
            SweepError::Sections { found: 1, needed: 2 } => {
                "repeat the section at the other end, or use `sweep(profile, along = curve)`"
            }
            SweepError::Unclosed { .. } => "give a twist of whole turns and a scale of 1",
            SweepError::OffRail { .. } => "let each section start on one rail and end on the other",
            SweepError::Frameless { .. } | SweepError::Along(_) => {
                "use `frame = ROTATION_MINIMISING`, which every path has"
            }
            _ => return None,
        };
        Some(words.into())
    }
}

/// A profile carried along a curve.
pub fn along(
    realizer: &Realizer,
    graph: &ShapeGraph,
    unit: Stretched,
    carried: &SweepAlong,
) -> Made<Polyhedron> {
    let part = graph.part(unit, carried.profile);
    let (figure, tolerance) = figure::bent(realizer, graph, part, realizer.tolerance_of(unit))?;
    let region = figure::upright(&figure);
    let SweepAlong { path, twist, scale, frame, corners, repair, .. } = carried;
    let way = Along {
        path,
        twist: *twist,
        scale: *scale,
        frame: *frame,
        corners: *corners,
        repair: *repair,
    };
    let solid = sweep::along(&region, &way, tolerance).at(graph.origin(unit.id))?;
    Ok(painted(solid, &figure.paint))
}

/// The figures of sections, and what of the tolerance is left.
fn figures(
    realizer: &Realizer,
    graph: &ShapeGraph,
    unit: Stretched,
    sections: &[ShapeId],
) -> Made<(Vec<Arc<Figure>>, Tolerance)> {
    let mut tolerance = realizer.tolerance_of(unit);
    let mut figures = vec![];
    for &section in sections {
        let part = graph.part(unit, section);
        let (figure, left) = figure::bent(realizer, graph, part, realizer.tolerance_of(unit))?;
        tolerance = if left < tolerance { left } else { tolerance };
        figures.push(figure);
    }
    Ok((figures, tolerance))
}

fn placed(figures: &[Arc<Figure>]) -> Vec<Placed<'_>> {
    figures.iter().map(|f| Placed { region: &f.region, frame: f.frame }).collect()
}

/// Closed sections carried along two rails.
pub fn between(
    realizer: &Realizer,
    graph: &ShapeGraph,
    unit: Stretched,
    carried: &SweepBetween,
) -> Made<Polyhedron> {
    let (figures, tolerance) = figures(realizer, graph, unit, &carried.sections)?;
    let way = Between {
        rails: [&carried.rails[0], &carried.rails[1]],
        stations: carried.stations,
        repair: carried.repair,
    };
    sweep::between(&placed(&figures), &way, tolerance).at(graph.origin(unit.id))
}

/// A body through profiles.
pub fn loft(
    realizer: &Realizer,
    graph: &ShapeGraph,
    unit: Stretched,
    sections: &[ShapeId],
    ruled: bool,
) -> Made<Polyhedron> {
    let (figures, tolerance) = figures(realizer, graph, unit, sections)?;
    sweep::loft(&placed(&figures), ruled, tolerance).at(graph.origin(unit.id))
}

/// The points of a surface. The error has no place yet.
pub fn surface(swept: &SweptSurface, tolerance: Tolerance) -> Result<CurvedGrid, GeometryError> {
    match swept {
        SweptSurface::Between { rails, sections, stations } => {
            let sections: Vec<_> = sections.iter().map(|section| &**section).collect();
            sweep::surface(&sections, [&rails[0], &rails[1]], *stations, tolerance)
        }
        SweptSurface::Extruded { curve, by } => sweep::extruded(curve, *by, tolerance),
        SweptSurface::Revolved { curve, angle } => sweep::revolved(curve, *angle, tolerance),
        SweptSurface::Patch([a, b, c, d]) => sweep::coons([a, b, c, d], tolerance),
    }
    .unplaced()
}
