//! What a model says of a sweep: immutable, plain data.

use std::sync::Arc;

use glam::DVec3;

use super::node::ShapeId;
use crate::geom::{
    Curve,
    sweep::{Corners, Frame, Repair, Stations},
};

/// A profile carried along a curve. It stands across it, its origin on the curve.
#[derive(Clone, PartialEq, Debug)]
pub struct SweepAlong {
    /// The profile.
    pub profile: ShapeId,
    /// The curve.
    pub path: Arc<Curve>,
    /// Right-handed turn from start to end, degrees, beside what the frame does.
    pub twist: f64,
    /// Size at the end relative to the start.
    pub scale: f64,
    /// How the profile turns on its way.
    pub frame: Frame,
    /// How it goes round corners.
    pub corners: Corners,
    /// What is done where it crosses itself.
    pub repair: Repair,
}

/// Closed sections carried along two curves.
#[derive(Clone, PartialEq, Debug)]
pub struct SweepBetween {
    /// The two curves.
    pub rails: [Arc<Curve>; 2],
    /// The sections: profiles.
    pub sections: Arc<[ShapeId]>,
    /// Where they are met.
    pub stations: Stations,
    /// What is done where it crosses itself.
    pub repair: Repair,
}

/// A surface swept by open curves.
#[derive(Clone, PartialEq, Debug)]
pub enum SweptSurface {
    /// Sections carried along two rails.
    Between {
        /// The two curves.
        rails: [Arc<Curve>; 2],
        /// Curves from one rail to the other.
        sections: Vec<Arc<Curve>>,
        /// Where they are met.
        stations: Stations,
    },
    /// A curve moved by a vector, mm.
    Extruded {
        /// The curve.
        curve: Arc<Curve>,
        /// The vector.
        by: DVec3,
    },
    /// A curve of the xy plane, its y becoming z, turned about the z axis.
    Revolved {
        /// The curve.
        curve: Arc<Curve>,
        /// The angle, degrees, above 0 and at most 360.
        angle: f64,
    },
    /// Coons's patch between four curves.
    Patch([Arc<Curve>; 4]),
}
