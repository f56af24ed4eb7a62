//! How sweeps are carried: words that models, kernels and drawings share.

/// How a profile turns on its way along a curve.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Frame {
    /// As little as it can about the curve.
    #[default]
    RotationMinimising,
    /// Not at all: it is moved without a turn.
    Fixed,
    /// Its x towards the centre of curvature (Frenet's frame).
    Frenet,
    /// Its y as near to +z as it can be.
    Upright,
}

/// Where a sweep along two rails meets its sections.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Stations {
    /// It passes through all of them.
    #[default]
    Through,
    /// It meets the first and the last; between them the means of neighbours, half-way between these (METHODS 4.3).
    Mid,
}

/// How a sweep goes round a corner of its path.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Corners {
    /// Both sides meet in the plane between them.
    #[default]
    Mitred,
    /// The profile is turned about its innermost point.
    Rounded,
}

/// What is done about a sweep that crosses itself.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Repair {
    /// It is an error.
    #[default]
    No,
    /// What it winds around is united.
    Union,
}
