//! Solids and surfaces swept along curves.
//!
//! # Paper
//! METHODS 4.3 (Nakajima): surfaces from two rails and sections.
//!
//! A *station* is a place on the way where points of all sections stand: a ring of points, or a row of them if the section is
//! open. Stations are put so close that the surface between them keeps within the tolerance ([`stations`]), and rings are
//! joined by facets ([`rings`]).

mod along;
mod between;
mod coons;
mod frames;
mod loft;
mod rings;
mod sections;
mod stations;
#[cfg(test)]
mod tests;
mod turned;

use glam::DVec3;
use thiserror::Error;

pub use self::{
    along::{Along, along},
    between::{Between, Rails, Row, between, surface},
    coons::coons,
    loft::loft,
    sections::Placed,
    turned::{extruded, revolved},
};
use super::{
    Polyhedron,
    boolean::{BooleanError, untangled},
    crossing::{Tangled, crossing},
};
use crate::geom::{GridError, sweep::Repair};

/// The most facets that a sweep makes.
pub const MAX_FACETS: usize = 2_000_000;

/// Why there is no sweep.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum SweepError {
    /// No area to carry.
    #[error("the profile is empty or broken; a sweep needs one with area")]
    EmptyProfile,
    /// A scale that is not above 0, or not finite.
    #[error("the scale is {0}; it must be above 0")]
    Scale(f64),
    /// A closed path on which the profile comes back in another way.
    #[error(
        "the path is closed, but the profile does not meet itself after {twist} degrees and a scale of {scale}"
    )]
    Unclosed {
        /// The twist, degrees.
        twist: f64,
        /// The scale.
        scale: f64,
    },
    /// A path that stands still.
    #[error("the path has a cusp at ({}, {}, {}): it has no direction there", .0.x, .0.y, .0.z)]
    Cusp(DVec3),
    /// A path that comes back on itself.
    #[error("the path turns back at ({}, {}, {}); no profile goes round there", .0.x, .0.y, .0.z)]
    TurnsBack(DVec3),
    /// A bend narrower than the profile is wide.
    #[error("the profile reaches {reach} mm to the inside of a bend with a radius of {radius} mm, at {part:.4} of the path, ({}, {}, {})", .at.x, .at.y, .at.z)]
    Bend {
        /// How far the profile reaches inwards, mm.
        reach: f64,
        /// The radius of curvature, mm.
        radius: f64,
        /// The part of the path's length.
        part: f64,
        /// The place, mm.
        at: DVec3,
    },
    /// A frame that is not defined somewhere.
    #[error("the path is {what} at ({}, {}, {}), where this frame has no direction", .at.x, .at.y, .at.z)]
    Frameless {
        /// Straight or upright.
        what: &'static str,
        /// The place, mm.
        at: DVec3,
    },
    /// A path that runs within the plane of a profile that does not turn.
    #[error("the path runs along the plane of the fixed profile, or back, at ({}, {}, {})", .0.x, .0.y, .0.z)]
    Along(DVec3),
    /// A sweep through itself.
    #[error("the sweep crosses itself at ({}, {}, {}), {}", .at.x, .at.y, .at.z, stations_words(.parts))]
    Crossing {
        /// The place, mm.
        at: DVec3,
        /// The parts of the way that meet there.
        parts: Vec<f64>,
    },
    /// Too few sections.
    #[error("{found} section; a sweep along rails and a loft need at least {needed}")]
    Sections {
        /// How many there are.
        found: usize,
        /// How many are needed.
        needed: usize,
    },
    /// Sections that are made of different numbers of contours.
    #[error(
        "section {section} has {found} contours, the first one {first}; all need the same number"
    )]
    Unlike {
        /// Its number, from 0.
        section: usize,
        /// Its contours.
        found: usize,
        /// Those of the first.
        first: usize,
    },
    /// A rail of no length.
    #[error("rail {0} has no length")]
    Rail(usize),
    /// A section that does not run from rail to rail.
    #[error("section {section} ends at ({}, {}, {}), {distance} mm from rail {rail}", .at.x, .at.y, .at.z)]
    OffRail {
        /// Its number, from 0.
        section: usize,
        /// The rail, 0 or 1.
        rail: usize,
        /// The distance, mm.
        distance: f64,
        /// The end, mm.
        at: DVec3,
    },
    /// A rail that does not go through the plane of a section.
    #[error("rail {rail} does not pass through the plane of section {section}")]
    Beside {
        /// The section, from 0.
        section: usize,
        /// The rail, 0 or 1.
        rail: usize,
    },
    /// Sections out of order.
    #[error(
        "section {section} does not come after the one before it: it stands at {part:.4} of rail {rail}, the one before at {before:.4}"
    )]
    Order {
        /// Its number, from 0.
        section: usize,
        /// The rail, 0 or 1.
        rail: usize,
        /// Where it stands on the rail, as a part of its length.
        part: f64,
        /// Where the one before stands.
        before: f64,
    },
    /// Curves that bound no patch.
    #[error("the four curves do not meet end to end: curve {number} begins {gap} mm away, at ({}, {}, {})", .at.x, .at.y, .at.z)]
    Open {
        /// The curve, from 0.
        number: usize,
        /// The distance, mm.
        gap: f64,
        /// Where it begins.
        at: DVec3,
    },
    /// Finer than any use.
    #[error("the sweep needs more than {MAX_FACETS} facets at this tolerance")]
    TooManyFacets,
    /// A surface that is no grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// Whether it crosses itself is not found out.
    #[error("whether the sweep crosses itself would take too long to find out: {0}")]
    Tangled(#[from] Tangled),
    /// What crosses itself could not be united.
    #[error("the sweep crosses itself: {0}")]
    Union(#[from] BooleanError),
}

/// Parts of a way in words.
fn stations_words(parts: &[f64]) -> String {
    match parts {
        [] => "where its sections meet".into(),
        [one] => format!("near {one:.4} of its way"),
        [a, b, ..] => format!("where {a:.4} and {b:.4} of its way meet"),
    }
}

/// The solid as it is if it does not cross itself, or what it winds around. `way` are points along the way of the sweep and
/// the parts they stand at.
fn sound(
    solid: Polyhedron,
    repair: Repair,
    way: impl Iterator<Item = (f64, DVec3)>,
) -> Result<Polyhedron, SweepError> {
    match repair {
        Repair::Union => Ok(untangled(solid)?),
        Repair::No => match crossing(solid.mesh())? {
            Some(at) => Err(SweepError::Crossing { at, parts: nearest_parts(way, at) }),
            None => Ok(solid),
        },
    }
}

/// The two parts of a way that come nearest to a point, with a part farther away between them; one if there is no such.
fn nearest_parts(way: impl Iterator<Item = (f64, DVec3)>, at: DVec3) -> Vec<f64> {
    let way: Vec<(f64, f64)> = way.map(|(part, p)| (p.distance(at), part)).collect();
    let is_low = |i: usize| {
        let near = [i.checked_sub(1), Some(i + 1)].into_iter().flatten();
        near.filter_map(|j| way.get(j)).all(|other| other.0 > way[i].0)
    };
    let mut low: Vec<(f64, f64)> = (0..way.len()).filter(|&i| is_low(i)).map(|i| way[i]).collect();
    low.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut parts: Vec<f64> = low.into_iter().take(2).map(|(_, part)| part).collect();
    parts.sort_by(f64::total_cmp);
    parts
}
